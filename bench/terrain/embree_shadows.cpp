#include <cmath>
#include <vector>

#include "bench/terrain/terrain_peers.h"
#include "core/stopwatch.h"
#include "core/vec.h"
#include "raster/heights/height_mesh.h"

#ifdef OBSCURA_HAS_EMBREE
#include "bench/embree/embree_scene.h"
#endif

namespace obscura {

#ifdef OBSCURA_HAS_EMBREE
namespace {

/// Towards the sun as shadows have it, rounding included.
Vec3f direction_of(const HeightField& field, const HeightSun& sun) {
    const double slope = static_cast<double>(sun.slope_q20) / static_cast<double>(cell_q20);
    const double across = sun.step_line, along = slope * sun.step_along;
    const double rise_m = std::ldexp(static_cast<double>(sun.rise_q36), -rise_fraction_bits);
    const double x = (sun.lines_are_columns ? across : along) * field.cell_x_m;
    const double z = (sun.lines_are_columns ? along : across) * field.cell_y_m;
    return to_float(normalize(Vec3d{x, rise_m, z}));
}

}  // namespace

std::optional<std::vector<TracedMap>> embree_shadows(const HeightField& field,
                                                     std::span<const HeightSun> suns) {
    const Mesh mesh = height_mesh(field, {});
    const EmbreeDevice device(1);
    const EmbreeScene scene(device, mesh, RTC_SCENE_FLAG_ROBUST);
    // As far as the triangles around a sample are its own.
    const auto beyond_m = static_cast<float>(1e-4 * std::min(field.cell_x_m, field.cell_y_m));
    std::vector<TracedMap> traced;
    for (const HeightSun& sun : suns) {
        TracedMap& t = traced.emplace_back(TracedMap{ShadowBits(field.width(), field.height())});
        const Vec3f direction = direction_of(field, sun);
        RTCIntersectContext context = coherent_context();
        const Stopwatch watch;
        for (int y = 0; y < field.height(); ++y) {
            for (int x = 0; x < field.width(); ++x) {
                const Vec3f p =
                    mesh.positions[static_cast<std::size_t>(y) * static_cast<std::size_t>(field.width()) +
                                   static_cast<std::size_t>(x)];
                RTCRay ray{};
                ray.org_x = p.x, ray.org_y = p.y, ray.org_z = p.z;
                ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
                ray.tnear = beyond_m;
                ray.tfar = 1e30f;
                ray.mask = ~0u;
                rtcOccluded1(scene.handle(), &context, &ray);
                if (ray.tfar < 0) t.map.set(x, y);
            }
        }
        t.seconds = watch.seconds();
    }
    return traced;
}

#else

std::optional<std::vector<TracedMap>> embree_shadows(const HeightField&, std::span<const HeightSun>) {
    return {};
}

#endif

}  // namespace obscura
