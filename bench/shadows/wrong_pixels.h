#pragma once
// Shadows of a map against the truth, pixel by pixel, and why they differ.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/shadows/exact_rays.h"
#include "core/types.h"

namespace obscura {

/// Why a pixel is wrong. The first that applies.
enum class Wrong : std::uint8_t {
    open,      ///< its surface is open or inside out: no solid hides the map's error, and a bias is at work
    grazing,   ///< light meets it at less than 3 degrees: a texel reaches far along it
    outline,   ///< the map answers rightly for the middle of its texel, but the shadow's edge runs between
               ///< that and the pixel: resolution
    interval,  ///< wrong in the texel's middle too: what was tested lies inside the solid that the texel
               ///< sees there (a curved surface, a corner), where any stored depth will do
};
inline constexpr std::size_t wrong_kinds = 4;
/// "open surface", "grazing light", "outline", "inside".
const char* wrong_name(Wrong kind);

/// Counts of pixels.
struct WrongPixels {
    std::size_t covered = 0, facing = 0;  ///< see a surface; see one that faces the light
    std::size_t wrong = 0;
    std::size_t leaks = 0;  ///< of the wrong ones: shown lit
    std::array<std::size_t, wrong_kinds> by_kind{};
    double fraction() const {
        return covered == 0 ? 0.0 : static_cast<double>(wrong) / static_cast<double>(covered);
    }
};

/// "12 outline, 3 inside": the kinds that occur.
std::string kinds_text(const WrongPixels& wrong);

/// Visibility of a block's samples, 0 or 1: a map looked up with a kernel of one texel.
using BlockLookup = std::function<void(const SurfaceBlock& surface, float* visibility)>;

/// A picture's points, the light, and what is so.
struct TrueShadows {
    const Mesh* mesh = nullptr;
    const VisiblePoints* points = nullptr;
    const ExactRays* rays = nullptr;
    Vec3d to_light;  ///< unit
    std::vector<Truth> truth;
};
TrueShadows true_shadows_of(const Scene& scene, const VisiblePoints& points, const ExactRays& rays,
                            const Exec& exec);

/// What a map shows at every pixel that faces the light, row by row (0 elsewhere).
std::vector<std::uint8_t> shown_shadows(const VisiblePoints& points, const BlockLookup& lookup,
                                        const Exec& exec);

/// Compares; `view` is the map's, and tells which texel a pixel asked. `kinds`, when given, becomes one entry
/// per pixel, row by row: 0 where it is right, else 1 + its kind.
WrongPixels wrong_pixels(const TrueShadows& scene, const std::vector<std::uint8_t>& shown,
                         const LightView& view, const Exec& exec, std::vector<std::uint8_t>* kinds = nullptr);

}  // namespace obscura
