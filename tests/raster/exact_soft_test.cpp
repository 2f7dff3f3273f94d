// Shadows of lights with a size: the same bits as those of each of their parts alone, on drawn scenes.

#include "raster/exact/exact_soft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "core/isa.h"
#include "core/num.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"
#include "raster/exact/soft_casters.h"
#include "raster/light_samples.h"
#include "raster/lighting.h"
#include "tests/raster/exact_points.h"
#include "tests/raster/exact_scenes.h"

namespace obscura {
namespace {

using namespace exact_scenes;

Vec3d draw_direction(Source& source) {
    // Along an axis, level, or any.
    Vec3d d = source.in(-1, 1);
    const int kind = source.below(4);
    if (kind == 0) d = {0, source.below(2) == 0 ? -1.0 : 1.0, 0};
    if (kind == 1) d.y = -0.001;
    return normalize(d);
}

struct Drawn {
    Mesh mesh;
    Light light;
    Vec3d eye;
    CameraRays rays;
    Points points;
};

Drawn draw(unsigned seed, int count) {
    Source source(seed);
    const double unit = std::pow(10, source.between(-2, 3));
    const Vec3d origin = source.in(-3, 3) * unit;
    Drawn d;
    d.mesh = draw_mesh(source, unit, origin);
    do {
        d.light = draw_light(source, d.mesh, unit, origin);
    } while (!is_parallel(d.light.kind));
    // From a twentieth of the sun to half of the sky.
    d.light.angular_diameter_deg = 90 * std::pow(10, source.between(-3.5, 0));
    d.eye = origin + source.in(-4, 7) * unit;
    d.rays = rays_from(d.eye, std::pow(10, source.between(-4, -2)));
    d.points = draw_points(source, d.mesh, d.eye, count);
    // Of what casts none, up to a thousand times as far off as all that does.
    for (int i = 0; i < 32; ++i) {
        const Vec3d p = origin + source.in(-1, 1) * (unit * std::pow(10, source.between(0, 3)));
        d.points.add(p, to_float(normalize(d.eye - p)), 0xffffffffu, 0, source.below(2) == 0);
    }
    d.points.fill_up();
    return d;
}

/// lit[part] of every word of points, as parts of one light.
std::vector<std::uint32_t> together(const Drawn& d, const std::vector<Light>& parts, Isa isa,
                                    ExactCounts& counts) {
    CasterScratch scratch;
    const Exec exec{isa, 1};
    const auto casters = build_casters(d.mesh, d.light, exec, scratch);
    const ExactLight middle = exact_light(d.light, casters, d.mesh, d.rays);
    const SoftParts seen = soft_parts(d.mesh, parts, exec);
    const ExactSoft soft = exact_soft_light(d.light, middle, seen, d.mesh);
    const std::size_t words = d.points.covered.size();
    // What was there before must not matter.
    std::vector<std::uint32_t> lit(words * parts.size(), 0xabcdu);
    ExactWork work(words * 16);
    work.shadows(d.points.view(), soft, isa, lit.data(), words, counts);
    return lit;
}

std::vector<std::uint32_t> one_by_one(const Drawn& d, const std::vector<Light>& parts, Isa isa) {
    std::vector<std::uint32_t> lit;
    const std::size_t words = d.points.covered.size();
    ExactWork work(words * 16);
    for (const Light& part : parts) {
        CasterScratch scratch;
        ExactCounts counts;
        const auto casters = build_casters(d.mesh, part, Exec{isa, 1}, scratch);
        const ExactLight light = exact_light(part, casters, d.mesh, d.rays);
        std::vector<std::uint32_t> of_part(words);
        work.shadows(d.points.view(), light, isa, of_part.data(), counts);
        lit.insert(lit.end(), of_part.begin(), of_part.end());
    }
    return lit;
}

TEST(ExactSoft, PartsOfALightAreLitAsIfTheyShoneAlone) {
    const Isa best = best_isa();
    std::int64_t mixed = 0, words = 0;
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    const unsigned scenes = slow != nullptr ? static_cast<unsigned>(std::max(3000, std::atoi(slow))) : 240;
    for (unsigned seed = 1; seed <= scenes; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Drawn d = draw(seed, 160);
        // Numbers that do not fill groups of sixteen, too.
        const auto parts = light_samples(d.light, 1 + static_cast<int>(seed % 37));
        ExactCounts counts;
        const auto lit = together(d, parts, best, counts);
        ASSERT_EQ(lit, one_by_one(d, parts, best));
        for (std::size_t w = 0; w < d.points.covered.size(); ++w) {
            ++words;
            for (std::size_t p = 1; p < parts.size(); ++p)
                mixed += lit[p * d.points.covered.size() + w] != lit[w] ? 1 : 0;
        }
    }
    // The scenes have penumbrae.
    EXPECT_GT(mixed, words);
}

TEST(ExactSoft, EveryIsaSaysTheSame) {
    for (unsigned seed = 1000; seed < 1030; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Drawn d = draw(seed, 64);
        const auto parts = light_samples(d.light, 20);
        ExactCounts of_ref;
        const auto ref = together(d, parts, Isa::ref, of_ref);
        std::optional<ExactCounts> first;
        for (const Isa isa : {Isa::sse2, Isa::avx2, Isa::avx512bw}) {
            if (!isa_supported(isa)) continue;
            ExactCounts counts;
            EXPECT_EQ(together(d, parts, isa, counts), ref);
            if (first) {
                EXPECT_EQ(counts.samples, first->samples);
                EXPECT_EQ(counts.groups, first->groups);
                EXPECT_EQ(counts.triangles, first->triangles);
            }
            first = counts;
        }
    }
}

TEST(ExactSoft, PenumbraeAreAsWideAsTheyAre) {
    // A square 3 m above a floor, the light straight above: its penumbra on the floor is 3 m times the
    // light's angle wide.
    Source source(7);
    for (int n = 0; n < 50; ++n) {
        const double height = std::pow(10, source.between(-1, 2)),
                     angle = std::pow(10, source.between(-1, 1));
        Mesh mesh;
        add_quad(mesh, {-10, 0, -10}, {-10, 0, 10}, {10, 0, 10}, {10, 0, -10});
        add_quad(mesh, {-1, height, -1}, {-1, height, 1}, {1, height, 1}, {1, height, -1});
        analyse_topology(mesh);
        Light light;
        light.direction = {0, -1, 0};
        light.angular_diameter_deg = angle;
        const Vec3d eye{0.3, 0.5 * height, 0.2};
        const double pixel = 1e-3;
        const CameraRays rays = rays_from(eye, pixel);
        Points points;
        // Along the floor, out to the right, below the square's edge.
        for (int i = 0; i < 16; ++i)
            points.add({0.99 + 0.001 * i, 0, 0}, {0, 1, 0}, mesh.face[0], 0, false);
        CasterScratch scratch;
        const auto casters = build_casters(mesh, light, Exec{}, scratch);
        const ExactLight middle = exact_light(light, casters, mesh, rays);
        const double tangent = num::tan(0.5 * angle * num::pi / 180);
        const double away = length(Vec3d{1, 0, 0} - eye), expected = 2 * height * tangent / (pixel * away);
        for (const Isa isa : {Isa::ref, Isa::sse2, best_isa()}) {
            ExactWork work(16);
            ExactCounts counts;
            const float px =
                work.widest_penumbra(points.view(), middle, exact_spread(light, middle), 1e9f, isa, counts);
            EXPECT_NEAR(px, expected, 0.02 * expected + 1e-3) << height << " m, " << angle << " degrees";
        }
    }
}

TEST(LightSamples, AddUpToTheLight) {
    Source source(3);
    for (int n = 0; n < 200; ++n) {
        Light light;
        light.kind = static_cast<LightKind>(source.below(5));
        light.direction = draw_direction(source);
        light.across = normalize(cross(light.direction, Vec3d{0.3, 0.5, 0.8}));
        light.position = source.in(-5, 5);
        light.color = {1, 2, 3};
        light.angular_diameter_deg = source.between(0.01, 90);
        light.radius_m = source.between(0.01, 2);
        light.width_m = source.between(0.1, 3);
        light.height_m = source.between(0.1, 3);
        light.shape = source.below(2) == 0 ? AreaShape::disc : AreaShape::rectangle;
        const int count = 1 << (2 * (1 + source.below(4)));
        const auto samples = light_samples(light, count);
        ASSERT_EQ(samples.size(), static_cast<std::size_t>(count));
        // From straight before it, unshadowed, they shed what it sheds.
        double power = 0;
        Vec3d middle{};
        for (const Light& s : samples) {
            EXPECT_FALSE(has_size(s));
            if (is_parallel(light.kind)) {
                power += static_cast<double>(s.color.x) * dot(s.direction, light.direction);
                EXPECT_LE(std::acos(std::min(dot(s.direction, light.direction), 1.0)),
                          0.5 * light.angular_diameter_deg * num::pi / 180 + 1e-9);
            } else {
                power += static_cast<double>(s.color.x) * (light.kind == LightKind::area ? s.part : 1.0);
                middle = middle + (s.position - light.position) * (1.0 / count);
                const double size = light.kind == LightKind::area
                                        ? 0.5 * std::hypot(light.width_m, light.height_m)
                                        : light.radius_m;
                EXPECT_LE(length(s.position - light.position), size + 1e-9);
            }
        }
        EXPECT_NEAR(power, 1.0, 1e-4 + 0.01 / count);
        if (is_parallel(light.kind)) continue;
        const double size =
            light.kind == LightKind::area ? std::max(light.width_m, light.height_m) : light.radius_m;
        EXPECT_LT(length(middle), 1.2 * size / std::sqrt(count));
    }
}

TEST(LightSamples, ABallLooksLikeADisc) {
    // Seen along any axis, as many points within each ring of equal area.
    Light light;
    light.kind = LightKind::point;
    light.radius_m = 1;
    const auto samples = light_samples(light, 1024);
    Source source(5);
    for (int n = 0; n < 20; ++n) {
        const Vec3d axis = normalize(source.in(-1, 1));
        int ring[4] = {};
        for (const Light& s : samples) {
            const double along = dot(s.position, axis);
            ++ring[std::min(static_cast<int>(4 * (dot(s.position, s.position) - along * along)), 3)];
        }
        for (const int in : ring)
            EXPECT_NEAR(in, 256, 40);
    }
}

}  // namespace
}  // namespace obscura
