#pragma once
// What is wrong with an edited disparity map: order of objects turned round, objects cut by the picture's
// sides in front of the screen, disparity outside of the comfort zone, surfaces that fold over in one eye.
//
// Scandolo, Bauszat, Eisemann, "Gradient-Guided Local Disparity Editing", CGF 2018 (thesis, section 4.3.3):
// inversions by the sign of gradients, window violations by the distance to the border. Ours: the same
// detectors read D~ before the solve and the optimised map after it, so that a report tells what was found
// and what is left; they name objects; folds are a kind of their own.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "stereo/comfort.h"
#include "stereo/middle_view.h"

namespace obscura {

enum class ConflictKind {
    depth_inversion,   ///< across a border of objects, the nearer one got the smaller disparity
    window_violation,  ///< in front of the screen by more than the distance to the nearer side of the picture
    comfort,           ///< outside of the comfort zone
    fold,              ///< inside one object, |horizontal gradient| >= 2: one eye's columns run backwards
};
constexpr int conflict_kinds = 4;
/// Bit of a kind in conflict_pixels.
constexpr std::uint8_t conflict_bit(ConflictKind kind) {
    return static_cast<std::uint8_t>(1u << static_cast<unsigned>(kind));
}
/// "depth inversion", "window violation", "outside comfort zone", "fold".
std::string_view conflict_name(ConflictKind kind);

/// All conflicts of a kind between two objects, or of one object.
struct Conflict {
    ConflictKind kind = ConflictKind::depth_inversion;
    std::int64_t pixels = 0;     ///< pixels of the map; of inversions and folds, pairs of neighbours
    std::int64_t inherited = 0;  ///< of these, as bad in the unedited map
    double worst_px = 0;         ///< how far wrong, pixels of disparity (of the full picture)
    std::string what;  ///< "sphere in front of wall": the order that should be; "sphere at the left"
    std::uint32_t object = nothing_seen;  ///< the one in front, or the only one
    std::uint32_t behind = nothing_seen;  ///< inversions only
};

struct ConflictLimits {
    ComfortZone comfort;
    double meaningful_px = 0.05;  ///< what is wrong by less is no conflict
};

struct Conflicts {
    std::vector<Conflict> list;  ///< most pixels first
    Image<std::uint8_t> pixels;  ///< conflict_bit() of each kind found there; inversions mark both sides
    std::int64_t count(ConflictKind kind) const;
    double worst(ConflictKind kind) const;
};

/// 1 where something with a finite disparity is seen.
Image<std::uint8_t> valid_pixels(const MiddleView& view);

/// Distance in pixels from the middle of a column of the map to the nearer side of the picture, >= 0. Columns
/// in the margin count too: what either eye sees of them there is cut.
double border_distance(const MiddleView& view, int column);

/// Conflicts of `map`, which is of the view's size: D~, or an optimised map. Objects are named by index into
/// `object_names`, or "object 7" beyond its end.
Conflicts find_conflicts(const MiddleView& view, const DisparityMap& map, const ConflictLimits& limits,
                         const std::vector<std::string>& object_names, const Exec& exec = {});

/// True when a step of `edited` across a border contradicts the original step (both from p to q).
inline bool inverted(double original, double edited, double meaningful_px) {
    const double certain_px = 1.0 / 1024;  // above the rounding of disparities
    return original * edited < 0 && (original < 0 ? -original : original) >= certain_px &&
           (edited < 0 ? -edited : edited) >= meaningful_px;
}
/// Horizontal steps between neighbours of a map at 1 : reduction from which on an eye's columns run back.
inline double fold_step(int reduction) {
    return 2.0 * reduction;
}

}  // namespace obscura
