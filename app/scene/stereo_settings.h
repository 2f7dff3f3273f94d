#pragma once
// What [stereo] and [[stereo.edit]] of a scene come to at one frame: everything that a pair is made from
// beside the scene itself.

#include <string>
#include <vector>

#include "app/models/file_access.h"
#include "app/scene/scene.h"
#include "app/scene/scene_file.h"
#include "stereo/edit.h"
#include "stereo/moved_mesh.h"
#include "stereo/solver/solver.h"
#include "stereo/stereo_rig.h"
#include "stereo/thesis/range_remap.h"

namespace obscura {

constexpr int auto_margin = -1;

/// Whose view of a surface its shading is of: mirrored sky, highlights, what Fresnel takes from the rest.
enum class EyeShading {
    eyes,    ///< each eye's own: highlights float behind or before surfaces, as those of two cameras do
    middle,  ///< the middle camera's for both: they lie on surfaces, as on a print
};

struct StereoSettings {
    StereoRig rig;
    EyeShading shading = EyeShading::eyes;
    int margin_px = auto_margin;    ///< columns that the middle view has on either side of the picture; >= 0
    int map_scale = 1;              ///< the system is solved at 1 : 1, 2, 4 or 8
    bool warm_start = false;        ///< a frame is solved from the one before: faster, within the tolerance
                                    ///< of what it is alone, but not to the bit
    std::vector<StereoEdit> edits;  ///< weights with fades and keyframes of this frame
    EditParams edit;
    RangeRemap remap;  ///< of any kind but none: instead of edits, one curve for all, for comparison
    SolverParams solver;
    ReprojectParams reproject;
    RangeRemap compare_remap;     ///< what [stereo] says of the comparison: `remap` of such a pair
    bool middle_picture = false;  ///< also render what the middle camera sees, margins included: for warping
    std::vector<std::string> notes;  ///< what one would want to know: edits that do nothing in this frame
};

/// What `document` says of two eyes at `frame`; defaults where it has no [stereo]. `scene` was built from it
/// and set to that frame. Where scene.render is of another size than the document says, pixels that keys
/// count are scaled along. Reads masks. Throws InputError: objects and material slots that the scene does not
/// have, masks that cannot be read; LimitError for large ones.
StereoSettings stereo_settings(const SceneDocument& document, const Scene& scene, double frame,
                               const FileAccess& access);

/// What `check` tells of them: lines of text.
std::string stereo_text(const StereoSettings& settings, const Scene& scene);

}  // namespace obscura
