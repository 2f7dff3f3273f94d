#pragma once
// The street of lesson 22, and the light that many distant lights shed in it, each with hard shadows.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/pixel.h"
#include "core/scene.h"
#include "core/sky/sky_directions.h"
#include "lessons/exact_scene.h"

namespace obscura {

/// From wall to wall, and of the walls, metres. The street runs along z, its middle at x = 0.
constexpr double street_width = 10, wall_height = 10;

/// Nothing but the ground and two walls, 400 m long.
Mesh plain_street();

/// Materials: 0 ground, 1 walls, 2 awning, 3 ball, 4 windows.
struct StreetScene {
    Mesh mesh;
    Camera camera;
};
StreetScene street_scene();

/// Share of an even sky's light that reaches the ground between two endless walls: (sin a + sin b) / 2, a and
/// b the angles from the zenith to the walls' upper edges. T. Oke, "Canyon geometry and the nocturnal urban
/// heat island", Journal of Climatology 1, 1981.
double sky_view_factor(double x);

/// The ground at these x of the street's middle; filled up to a multiple of sixteen by points that ask
/// nothing.
SeenPoints ground_points(const Mesh& street, const std::vector<double>& xs);

/// Whether light from direction k reaches point i, and faces it.
struct Arrivals {
    std::size_t words = 0;
    std::vector<std::uint32_t> lit;
    bool operator()(std::size_t k, std::size_t i) const {
        return (lit[k * words + i / 16] >> (i % 16) & 1u) != 0;
    }
};
Arrivals arrivals(const Mesh& mesh, const Camera& camera, const SeenPoints& seen,
                  std::span<const SkyDirection> suns, const Exec& exec);

/// How many of the first `suns` directions reach point i.
int count_arrivals(const Arrivals& arrive, std::size_t suns, std::size_t i);

/// What they shed on each point, W/m2 per channel: with the shadows, or as if there were none.
std::vector<Vec3d> irradiance(const SeenPoints& seen, std::span<const SkyDirection> suns,
                              const Arrivals& arrive);
std::vector<Vec3d> irradiance(const SeenPoints& seen, std::span<const SkyDirection> suns);

/// What an even sky sheds on points that lie level, by so many suns, as a share of what the open ground gets.
std::vector<double> even_sky_shares(const Mesh& mesh, const Camera& camera, const SeenPoints& seen, int suns,
                                    SkyImportance importance, const Exec& exec);

/// What a sun and a sky shed on the ground of a street at these x.
std::vector<Vec3d> sun_and_sky(const Mesh& street, const Camera& camera, const std::vector<double>& xs,
                               const SkyDirection& sun, std::span<const SkyDirection> sky, const Exec& exec);

/// Radiance to its colour, under the exposure of all pictures of the lesson.
Rgb8 exposed(Vec3d radiance);

/// What a camera shows of the street in this light, and of the sky where there is nothing.
Image<Rgb8> street_picture(const StreetScene& street, const SeenPoints& seen, const std::vector<Vec3d>& light,
                           const std::function<Vec3f(Vec3d)>& sky, int width, int height);

}  // namespace obscura
