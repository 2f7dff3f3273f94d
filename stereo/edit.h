#pragma once
// What an artist asks for (thesis 4.3.2), and its translation into a system for the solver.

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/image.h"
#include "core/vec.h"
#include "stereo/disparity_system.h"
#include "stereo/middle_view.h"
#include "stereo/stereo_rig.h"

namespace obscura {

/// Objects and materials whose pixels an edit is about, as indices into Mesh::objects and Scene::materials.
struct EditTarget {
    std::vector<std::uint32_t> objects, materials;
};

/// Scales disparity about the target's centre (4.2): 0 flattens, 1 changes nothing.
struct RoundnessEdit {
    EditTarget target;
    double roundness = 1;  ///< >= 0
};
/// Holds the target at its disparity, roundness included, plus an offset (4.3).
struct AnchorEdit {
    EditTarget target;
    double offset_px = 0;  ///< of the full picture; positive towards the viewer
};
/// Keeps the original gradient where two targets meet, or under a mask.
struct InterfaceEdit {
    EditTarget first, second;  ///< borders between these; both empty: the mask's
    Image<float> mask;         ///< [0, 1] over the picture without margins, any size; stretched to it
};
/// Pixels around a destination follow a source (4.4). Points are in pixels of the picture (0,0 = its upper
/// left corner; centres at .5), or world positions that are projected.
struct MatchEdit {
    Vec2d source_px, destination_px;
    double offset_px = 0;
    double radius_px = 0;  ///< 0: the destination's object
};

/// Factors of an edit's weight that follow the camera; each ends are where the factor is 1 and where it is 0,
/// with a smoothstep between.
struct WeightFade {
    std::optional<std::array<double, 2>> angle_deg;  ///< between the view axis and `direction`
    Vec3d direction{0, 0, -1};
    std::optional<std::array<double, 2>> distance_m;  ///< of the eye from `position_m`
    Vec3d position_m{0, 0, 0};
};

struct StereoEdit {
    std::string name;   ///< "[[stereo.edit]] id"
    double weight = 1;  ///< >= 0, fades and keyframes included. Gradient edits: share of the edit, to 1
    std::variant<RoundnessEdit, AnchorEdit, InterfaceEdit, MatchEdit> what;
};

/// Pixels, or in percent of width or degrees where the name says so.
struct ComfortZone {
    double nearest_px = 1e9;    ///< largest disparity
    double farthest_px = -1e9;  ///< smallest
};

struct EditParams {
    double gradient_weight = 1, anchor_weight = 1, match_weight = 1, epsilon = 1e-4;  ///< c1, c2, c3, epsilon
    ComfortZone comfort;
    double comfort_weight = 1;  ///< anchors of pixels outside of the zone; 0: leave them
    double window_weight = 1;   ///< anchors of pixels that the frame's side borders cut; 0: leave them
    bool reset_inversions = true;
};

enum class ConflictKind { depth_inversion, window_violation, comfort };
/// A kind of conflict of one edit or pair of objects, before the solve.
struct Conflict {
    ConflictKind kind = ConflictKind::depth_inversion;
    std::int64_t pixels = 0;
    double worst_px = 0;  ///< how far wrong, pixels of disparity
    std::string what;     ///< "sphere in front of wall"
};

struct EditedSystem {
    DisparitySystem system;
    std::vector<Conflict> conflicts;      ///< most pixels first
    Image<std::uint8_t> conflict_pixels;  ///< bit 1 << kind per pixel
};

/// Applies `edits` to the view: D~, target gradients, anchors, matching sets; then finds and resolves
/// conflicts. The result does not depend on the order of edits. Throws InputError-free: names were
/// resolved before; an edit whose target is not seen does nothing.
EditedSystem edited_system(const MiddleView& view, const std::vector<StereoEdit>& edits,
                           const EditParams& params, const std::vector<std::string>& object_names);

/// Fade factor in [0, 1].
double fade_factor(const WeightFade& fade, const Vec3d& eye, const Vec3d& forward);

}  // namespace obscura
