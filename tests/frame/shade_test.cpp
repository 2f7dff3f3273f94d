// Radiance against closed forms and numerical integrals, in double.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "raster/lighting.h"
#include "raster/shade_terms.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;
using num::pi;

// --- the surface model as the textbooks write it
// -------------------------------------------------------------

struct Surface {
    double base = 1, roughness = 1, metallic = 0;
};

double schlick(double f0, double cosine) {
    return f0 + (1 - f0) * std::pow(1 - cosine, 5);
}

/// One channel of the BRDF for unit l, v and normal n.
double textbook_brdf(const Surface& m, Vec3d n, Vec3d l, Vec3d v) {
    const double a2 = std::pow(m.roughness, 4), nl = dot(n, l), nv = dot(n, v);
    const Vec3d h = normalize(l + v);
    const double nh = dot(n, h), vh = dot(v, h);
    const double D = a2 / (pi * std::pow(nh * nh * (a2 - 1) + 1, 2));
    const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1 + a2 * (1 - c * c) / (c * c)) - 1); };
    const double G = 1 / (1 + lambda(nl) + lambda(nv));
    const double F = schlick(0.04 + (m.base - 0.04) * m.metallic, vh);
    const auto let_in = [&](double c) {
        return 1 - (0.04 + (std::max(1 - m.roughness, 0.04) - 0.04) * std::pow(1 - c, 5));
    };
    const double diffuse = m.base * (1 - m.metallic) / pi * let_in(nl) * let_in(nv);
    return diffuse + D * G * F / (4 * nl * nv);
}

Material material_of(const Surface& m) {
    Material material;
    const auto base = static_cast<float>(m.base);
    material.base_color = {base, base, base};
    material.roughness = static_cast<float>(m.roughness);
    material.metallic = static_cast<float>(m.metallic);
    return material;
}

/// One sample with normal +Y at the origin's neighbourhood, seen from direction v, ready for lights.
struct Bench {
    std::unique_ptr<SurfaceBlock> surface = std::make_unique<SurfaceBlock>();
    std::unique_ptr<ShadeBlock> shade = std::make_unique<ShadeBlock>();
    Bench(const Surface& m, Vec3d v, const ShadeSky& sky = {}) {
        *surface = SurfaceBlock{};
        *shade = ShadeBlock{};
        const Vec3f p = to_float(-v * 2.0);
        surface->px[0] = p.x;
        surface->py[0] = p.y;
        surface->pz[0] = p.z;
        surface->ny[0] = surface->gy[0] = 1;
        surface->covered[0] = 1;
        for (int i = 1; i < block_samples; ++i)
            surface->pz[i] = -1;
        CameraRays rays{};
        rays.perspective = true;
        ref::shade_begin(*surface, shade_materials({material_of(m)}).data(), sky, rays, *shade);
    }
    /// BRDF times cosine.
    double response(Vec3d l) const {
        ShadeLight light;
        const Vec3f d = to_float(l);
        light.to_light[0] = d.x;
        light.to_light[1] = d.y;
        light.to_light[2] = d.z;
        const ref::LightTerms terms = ref::light_terms(*surface, light, *shade, 0);
        return static_cast<double>(terms.diffuse.x) + static_cast<double>(terms.specular.x);
    }
};

Vec3d direction(double cosine, double phi) {
    const double s = std::sqrt(1 - cosine * cosine);
    return {s * std::cos(phi), cosine, s * std::sin(phi)};
}

const Surface surfaces[] = {{1, 1, 0}, {0.5, 0.5, 0}, {1, 0.3, 1}, {0.7, 0.15, 0.5}, {0.9, 0.08, 1}};

TEST(Shade, SurfaceModelIsTheTextbooks) {
    for (const Surface& m : surfaces) {
        for (const double cv : {0.05, 0.3, 0.8, 1.0}) {
            const Vec3d v = direction(cv, 0.4);
            const Bench bench(m, v);
            for (const double cl : {0.02, 0.2, 0.6, 0.95}) {
                for (const double phi : {0.4 + pi, 0.4, 1.7, 3.4}) {
                    const Vec3d l = direction(cl, phi);
                    const double expected = textbook_brdf(m, {0, 1, 0}, l, v) * cl;
                    EXPECT_NEAR(bench.response(l), expected, 1e-4 * expected + 1e-6)
                        << "roughness " << m.roughness << " cv " << cv << " cl " << cl << " phi " << phi;
                }
            }
        }
    }
}

TEST(Shade, SurfaceModelIsReciprocal) {
    for (const Surface& m : surfaces) {
        const Vec3d a = direction(0.3, 0.2), b = direction(0.85, 2.0);
        const double ab = Bench(m, a).response(b) / b.y, ba = Bench(m, b).response(a) / a.y;
        EXPECT_NEAR(ab, ba, 1e-5 * ab);
    }
}

/// Light given back to direction v out of a uniform white furnace.
double albedo(const Surface& m, Vec3d v) {
    const Bench bench(m, v);
    constexpr int cosines = 300, turns = 300;
    double sum = 0;
    for (int i = 0; i < cosines; ++i) {
        // Denser where the mirror direction of a grazing view lies.
        const double t = (i + 0.5) / cosines, cosine = t * t;
        for (int j = 0; j < turns; ++j) {
            sum += bench.response(direction(cosine, 2 * pi * (j + 0.5) / turns)) * 2 * t;
        }
    }
    return sum * 2 * pi / (cosines * turns);
}

TEST(Shade, GivesBackNoMoreLightThanArrives) {
    for (const double roughness : {0.2, 0.4, 0.7, 1.0}) {
        for (const double metallic : {0.0, 0.5, 1.0}) {
            for (const double cosine : {0.1, 0.4, 1.0}) {
                const double a = albedo({1, roughness, metallic}, direction(cosine, 0));
                EXPECT_LE(a, 1.003) << roughness << " " << metallic << " " << cosine;
                EXPECT_GT(a, 0.3);
            }
        }
    }
    // A rough white wall stays white when seen along itself: no dark rims.
    EXPECT_GT(albedo({1, 1, 0}, direction(0.05, 0)), 0.9);
    // And a polished white metal gives back nearly all of it: the lobe is normalised.
    EXPECT_GT(albedo({1, 0.2, 1}, direction(0.8, 0)), 0.985);
}

TEST(Shade, SkyIrradianceIsTheIntegralOfSkyRadiance) {
    Sky s;
    s.zenith = {0.2f, 1, 0};
    s.horizon = {0.7f, 0, 1};
    s.ground = {0.1f, 0, 0};
    const ShadeSky sky = shade_sky(s);
    for (const double ny : {-1.0, -0.7, -0.1, 0.0, 0.4, 0.9, 1.0}) {
        const Vec3d n = direction(ny, 0);
        Vec3d sum;
        constexpr int steps = 400;
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; j < steps; ++j) {
                const double y = -1 + 2 * (i + 0.5) / steps;
                const Vec3d w = direction(y, 2 * pi * (j + 0.5) / steps);
                sum =
                    sum + to_double(ref::sky_radiance(sky, static_cast<float>(y))) * std::max(dot(n, w), 0.0);
            }
        }
        sum = sum * (4 * pi / (steps * steps));
        const Vec3f e = ref::sky_irradiance(sky, static_cast<float>(ny));
        EXPECT_NEAR(static_cast<double>(e.x), sum.x, 2e-3) << ny;
        EXPECT_NEAR(static_cast<double>(e.y), sum.y, 2e-3) << ny;
        EXPECT_NEAR(static_cast<double>(e.z), sum.z, 2e-3) << ny;
    }
}

// --- whole pictures
// ------------------------------------------------------------------------------------------

/// A floor seen straight down: pixel centres are known points of y = 0.
Scene floor_from_above(int size, double height_m) {
    Scene scene = empty_scene(size, size);
    add(scene, box({-20, -1, -20}, {20, 0, 20}), 0);
    scene.materials[0].roughness = 0.6f;
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.height_m = height_m;
    scene.camera.eye = {0, 10, 0};
    scene.camera.look_at = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    return scene;
}

Vec3d floor_point(const Scene& scene, int x, int y) {
    const double m = scene.camera.height_m / scene.render.height;
    return {(x + 0.5 - 0.5 * scene.render.width) * m, 0, (y + 0.5 - 0.5 * scene.render.height) * m};
}

TEST(Shade, PlaneUnderADirectionalLightHasTheKnownRadiance) {
    Scene scene = floor_from_above(16, 4);
    const Vec3d to_light = normalize(Vec3d{0.3, 0.8, -0.2});
    scene.lights.push_back(directional(-to_light, {2, 3, 4}));
    const Frame frame = render_frame(scene);
    const double brdf = textbook_brdf({1, 0.6000000238418579, 0}, {0, 1, 0}, to_light, {0, 1, 0});
    for (int i = 0; i < 16; ++i) {
        const Vec3f p = pixel(frame, i, 15 - i);
        EXPECT_NEAR(static_cast<double>(p.x), 2 * brdf * to_light.y, 1e-5);
        EXPECT_NEAR(static_cast<double>(p.y), 3 * brdf * to_light.y, 1e-5);
        EXPECT_NEAR(static_cast<double>(p.z), 4 * brdf * to_light.y, 1e-5);
    }
}

TEST(Shade, PointLightFallsWithTheSquareOfDistanceAndEndsAtItsRange) {
    Scene scene = floor_from_above(64, 12);
    scene.lights.push_back(at_point(LightKind::point, {0.5, 1.5, 0.25}, {0, -1, 0}, {7, 7, 7}));
    scene.lights[0].light.range_m = 5;
    const Frame frame = render_frame(scene);
    int beyond = 0;
    for (int y = 0; y < 64; y += 3) {
        for (int x = 0; x < 64; x += 3) {
            const Vec3d d = scene.lights[0].light.position - floor_point(scene, x, y);
            const double r = length(d), window = std::max(1 - std::pow(r / 5, 4), 0.0);
            const double expected =
                7 * window * window / (r * r) * (d.y / r) *
                textbook_brdf({1, 0.6000000238418579, 0}, {0, 1, 0}, d * (1 / r), {0, 1, 0});
            ASSERT_NEAR(static_cast<double>(pixel(frame, x, y).x), expected, 2e-5 * expected + 1e-7)
                << x << "," << y;
            beyond += r > 5;
        }
    }
    EXPECT_GT(beyond, 20);
}

TEST(Shade, ASurfaceAtTheLightItselfStaysFiniteAndTheSameBits) {
    Scene scene = floor_from_above(16, 4);
    SceneLight at_floor = at_point(LightKind::point, floor_point(scene, 8, 8), {0, -1, 0}, {7, 7, 7});
    at_floor.shadow.method = ShadowMethod::none;
    scene.lights.push_back(at_floor);
    const Frame expected = render_frame(scene, {}, {Isa::ref, 1});
    for (int x = 0; x < 16; ++x)
        EXPECT_TRUE(std::isfinite(pixel(expected, x, 8).x)) << x;
    for (const Isa isa : supported_isas())
        EXPECT_EQ(hash(render_frame(scene, {}, {isa, 1})), hash(expected)) << isa_name(isa);
}

TEST(Shade, SpotIsFullInsideItsConeAndDarkOutside) {
    Scene scene = floor_from_above(128, 8);
    scene.lights.push_back(at_point(LightKind::spot, {0, 3, 0}, {0, -1, 0}, {5, 5, 5}));
    scene.lights[0].light.range_m = 1000;
    scene.lights[0].light.inner_cone_deg = 20;
    scene.lights[0].light.outer_cone_deg = 40;
    const Frame frame = render_frame(scene);
    int inside = 0, edge = 0, outside = 0;
    for (int x = 0; x < 128; ++x) {
        const Vec3d p = floor_point(scene, x, 64);
        const Vec3d d = Vec3d{0, 3, 0} - p;
        const double r = length(d), cosine = d.y / r, angle = std::acos(cosine) * 180 / pi;
        const double full = 5 / (r * r) * cosine *
                            textbook_brdf({1, 0.6000000238418579, 0}, {0, 1, 0}, d * (1 / r), {0, 1, 0});
        const double share = static_cast<double>(pixel(frame, x, 64).x) / full;
        if (angle < 19.9) {
            EXPECT_NEAR(share, 1, 1e-4) << angle;
            ++inside;
        } else if (angle > 40.1) {
            EXPECT_EQ(share, 0) << angle;
            ++outside;
        } else {
            const double co = std::cos(40 * pi / 180), ci = std::cos(20 * pi / 180);
            const double t = std::clamp((cosine - co) / (ci - co), 0.0, 1.0);
            EXPECT_NEAR(share, t * t * (3 - 2 * t), 1e-4) << angle;
            ++edge;
        }
    }
    EXPECT_GT(inside, 20);
    EXPECT_GT(edge, 20);
    EXPECT_GT(outside, 20);
}

TEST(Shade, ThinSheetsGlowWhereLightComesFromBehind) {
    // A sheet that faces down, seen from below, lit from above.
    Scene scene = empty_scene(8, 8);
    scene.materials[0].translucency = 0.5f;
    Mesh sheet = plane(20, 20);
    for (Triangle& t : sheet.triangles)
        std::swap(t.v[1], t.v[2]);
    for (Vec3f& n : sheet.normals)
        n = -n;
    add(scene, sheet, 0);
    scene.camera.eye = {0, -5, 0};
    scene.camera.up = {0, 0, -1};
    scene.lights.push_back(directional({0, -1, 0}, {1, 1, 1}));
    const double in = 1 - 0.04;
    const double glow = static_cast<double>(pixel(render_frame(scene), 4, 4).x);
    EXPECT_NEAR(glow, 0.5 / pi * in * in, 1e-3);
    scene.materials[0].translucency = 0;
    EXPECT_EQ(pixel(render_frame(scene), 4, 4), (Vec3f{0, 0, 0}));
}

TEST(Shade, SkyIsSeenBehindEverythingUnlessHidden) {
    Scene scene = empty_scene(8, 8);
    scene.sky.zenith = {0, 0, 1};
    scene.sky.horizon = {0, 1, 0};
    scene.sky.ground = {1, 0, 0};
    scene.camera.eye = {0, 0, 0};
    scene.camera.look_at = {0, 10, -1};
    const Vec3f up = pixel(render_frame(scene), 4, 4);
    EXPECT_GT(up.z, 0.9f);
    EXPECT_EQ(up.x, 0.0f);
    scene.camera.look_at = {0, -10, -1};
    EXPECT_EQ(pixel(render_frame(scene), 4, 4), (Vec3f{1, 0, 0}));
    scene.sky.visible = false;
    EXPECT_EQ(pixel(render_frame(scene), 4, 4), (Vec3f{0, 0, 0}));
}

}  // namespace
}  // namespace obscura
