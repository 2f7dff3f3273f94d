#pragma once
// What an artist asks for, and its translation into a system for the solver.
//
// Scandolo, Bauszat, Eisemann, "Gradient-Guided Local Disparity Editing", CGF 2018 (thesis, sections 4.3.2
// and 4.3.3, equations 4.2 to 4.4). Where the text is silent or says two things we chose:
//
// - D_m, the centre of 4.3, is the interquartile mean of the object's visible disparities: the mean of those
//   of its pixels in the middle half. Parts that come into sight or vanish at either end do not count, and it
//   has no jumps as a median has. (The law of disparity is monotone: it is the disparity of a middling
//   depth.)
// - 4.3.3 takes gradients between objects from D~, 4.4 says that interfaces are maintained by default. Both
//   are here, as EditParams::interfaces; the default is 4.4's, with which all results of the paper were made.
// - D~ has matching points in it, too: members stand where their source is in D~, plus the target.
// - Several edits on one pixel: roundness multiplies; anchors' values are averaged by weight, weights add.
// - Reduced maps have fewer pixels: anchors, matches and epsilon weigh reduction^2 times as much there, so
//   that the minimiser stays the same up to sampling. (Squared differences of a smooth map do not change.)

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "stereo/comfort.h"
#include "stereo/conflict.h"
#include "stereo/disparity_system.h"
#include "stereo/middle_view.h"
#include "stereo/stereo_rig.h"

namespace obscura {

/// Objects and materials whose pixels an edit is about, as indices into Mesh::objects and Scene::materials.
struct EditTarget {
    std::vector<std::uint32_t> objects, materials;
};

/// Scales disparity about the centre (4.2): 0 flattens, 1 changes nothing. Inside one object gradients are
/// scaled; where pixels of one object differ in roundness (materials), by the mean of both.
struct RoundnessEdit {
    EditTarget target;
    double roundness = 1;   ///< >= 0
    bool together = false;  ///< the target is one thing of several objects: one centre, borders inside scaled
};
/// Holds the target at its disparity, roundness included, plus an offset (4.3).
struct AnchorEdit {
    EditTarget target;
    double offset_px = 0;  ///< of the full picture; positive towards the viewer
};
/// Keeps the original gradient where two targets meet, in either order, and under a mask; or lets it go.
struct InterfaceEdit {
    EditTarget first, second;  ///< borders between these; one of them empty: of the other with anything
    Image<float> mask;  ///< [0, 1] over the picture without margins, any size; stretched to it. With targets
                        ///< it limits these; alone it keeps gradients inside objects too. May be empty
    bool keep = true;   ///< false: gradients of D~, where InterfaceGradients::original would keep them
};
/// Pixels around a destination follow a source (4.4). Points are in pixels of the picture (0,0 = its upper
/// left corner; centres at .5); in the margins and beyond, coordinates go on.
struct MatchEdit {
    Vec2d source_px, destination_px;
    double offset_px = 0;
    double radius_px = 0;     ///< around the destination; 0: all of the destination's object
    bool any_object = false;  ///< with a radius: other objects within it follow too
    /// What is around the source, as far as the edit reaches around its destination, keeps its distance to
    /// it. Without, the cheapest way to match is to draw the source's one pixel out like a needle.
    bool hold_source = false;
};

/// Factors of an edit's weight that follow the camera: each is 1 at the first number and 0 at the second,
/// with a smoothstep between; the first may be the larger one.
struct WeightFade {
    std::optional<std::array<double, 2>> angle_deg;  ///< between the view axis and `direction`
    Vec3d direction{0, 0, -1};
    std::optional<std::array<double, 2>> distance_m;  ///< of the eye from `position_m`
    Vec3d position_m{0, 0, 0};
};

struct StereoEdit {
    std::string name;  ///< "[[stereo.edit]] id"
    /// >= 0, fades and keyframes included; 0: no edit. Roundness, interface: its share, to 1.
    double weight = 1;
    std::variant<RoundnessEdit, AnchorEdit, InterfaceEdit, MatchEdit> what;
};

/// Where gradients between different objects come from.
enum class InterfaceGradients {
    original,  ///< the unedited map (thesis 4.4, "by default object interfaces are maintained")
    edited,    ///< D~ (4.3.3); interface edits revert to the original
};

struct EditParams {
    double gradient_weight = 1, anchor_weight = 1, match_weight = 1, epsilon = 1e-4;  ///< c1, c2, c3, epsilon
    InterfaceGradients interfaces = InterfaceGradients::original;
    ComfortZone comfort;
    double comfort_weight = 1;      ///< anchors of pixels outside of the zone; 0: leave them
    double window_weight = 1;       ///< anchors of pixels that the frame's side borders cut; 0: leave them
    bool window_inherited = false;  ///< also where the unedited picture is cut as badly
    bool reset_inversions = true;
    bool limit_folds = true;
    double meaningful_px = 0.05;  ///< what is wrong by less is no conflict
};

/// Something an artist should hear: an edit without effect, and why.
struct EditNotice {
    std::string edit, text;
};

struct EditedSystem {
    DisparitySystem system;
    /// Of D~ as the edits alone make it, whether or not it was resolved.
    std::vector<Conflict> conflicts;      ///< most pixels first
    Image<std::uint8_t> conflict_pixels;  ///< conflict_bit() of each kind
    std::vector<EditNotice> notices;      ///< in the order of the edits' names
};

/// Applies `edits` to the view: D~, target gradients, anchors, matching sets; then finds conflicts and
/// resolves them: inverted and folded gradients are reset or limited, pixels cut by the window or outside of
/// the comfort zone are anchored at its limit (which D~ and other anchors then obey too). The same bits for
/// any order of edits and any exec. No edits and no comfort zone: the unedited system. An edit whose target
/// is not seen does nothing.
EditedSystem edited_system(const MiddleView& view, const std::vector<StereoEdit>& edits,
                           const EditParams& params, const std::vector<std::string>& object_names,
                           const Exec& exec = {});

/// D~ alone: the edits pixel by pixel, not solved, conflicts and all. For figures and tests.
DisparityMap edited_disparity(const MiddleView& view, const std::vector<StereoEdit>& edits,
                              const Exec& exec = {});

/// Fade factor in [0, 1]; `forward` is the unit view axis.
double fade_factor(const WeightFade& fade, const Vec3d& eye, const Vec3d& forward);

}  // namespace obscura
