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
    // Of exact shadows, which have no texels (exact_wrong.h):
    off,          ///< the sample lies beyond its own triangle's edges, where cameras' corners are snapped: it
                  ///< is on no surface, and what is so there is a matter of taste
    edge,         ///< the rays agree about a place on its plane as near as its place is uncertain
    beside,       ///< they agree about a place as near off its plane, or when they leave out what is as near
    unexplained,  ///< neither
};
inline constexpr std::size_t wrong_kinds = 8;
/// "open surface", "grazing light", "outline", "inside", "off its triangle", "edge", "beside", "unexplained".
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

/// Why sample `at` of a block is wrong; `shown` is what is shown there, which the truth is not.
using KindOfWrong = std::function<Wrong(std::size_t block, int at, Truth shown)>;

/// Compares. `kinds`, when given, becomes one entry per pixel, row by row: 0 where it is right, else 1 + its
/// kind.
WrongPixels count_wrong(const TrueShadows& scene, const std::vector<std::uint8_t>& shown,
                        const KindOfWrong& kind_of, const Exec& exec,
                        std::vector<std::uint8_t>* kinds = nullptr);

/// The same for a map; `view` is the map's, and tells which texel a pixel asked.
WrongPixels wrong_pixels(const TrueShadows& scene, const std::vector<std::uint8_t>& shown,
                         const LightView& view, const Exec& exec, std::vector<std::uint8_t>* kinds = nullptr);

}  // namespace obscura
