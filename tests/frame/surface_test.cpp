// Surfaces and textures against rays in double.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "raster/texture.h"
#include "raster/view.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

/// A textured floor of 40 m with uvs in metres, seen at a slant.
Scene textured_floor(int samples = 1) {
    Scene scene = empty_scene(160, 120, samples);
    add(scene, plane(40, 40, 3, 3), 0);
    scene.materials[0].texture = 0;
    scene.textures.push_back(checkerboard(64, 8));
    for (Vec2f& uv : scene.mesh.uvs)
        uv = uv * 0.5f;
    scene.camera.eye = {0.3, 2.0, 9};
    scene.camera.look_at = {0, 0.4, 0};
    scene.camera.vfov_deg = 50;
    return scene;
}

/// The floor point that picture position (X, Y) sees, and whether it does.
struct FloorHit {
    bool hit = false;
    double x = 0, z = 0;
};
FloorHit floor_hit(const Scene& scene, double X, double Y) {
    const Camera& c = scene.camera;
    const Basis b = look_basis(c.look_at - c.eye, c.up);
    const double h = scene.render.height;
    Vec3d origin = c.eye, d = b.forward;
    const double sx = X - 0.5 * scene.render.width, sy = 0.5 * h - Y;
    if (c.kind == CameraKind::perspective) {
        const double t = std::tan(0.5 * c.vfov_deg * num::pi / 180) / (0.5 * h);
        d = d + b.right * (sx * t) + b.up * (sy * t);
    } else {
        origin = origin + b.right * (sx * c.height_m / h) + b.up * (sy * c.height_m / h);
    }
    const double s = -origin.y / d.y;
    const Vec3d p = origin + d * s;
    return {s > 0 && std::fabs(p.x) < 20.1 && std::fabs(p.z) < 20.1, p.x, p.z};
}

/// Calls check(X, Y, at, block) for each sample of the picture that is covered.
template <class Check>
int for_each_covered(const Scene& scene, Check&& check) {
    FrameCache cache;
    FrameStats stats;
    prepare_scene(scene, {}, cache, stats);
    const TileScene tiles = prepare_tiles(scene, {}, cache);
    const auto work = std::make_unique<TileWork>();
    int count = 0;
    for (const SamplePosition sample : tiles.pattern) {
        for (int y = 0; y < scene.render.height; ++y) {
            for (int x = 0; x < scene.render.width; x += frame_tile_side) {
                const TileRect tile = tile_visibility(tiles, x / 64, y / 64, sample, best_isa(), *work);
                const int first = (y % 64) / block_rows * block_rows;
                block_surface(tiles, tile, first, best_isa(), *work);
                for (int c = 0; c < 64 && x + c < scene.render.width; ++c) {
                    const int at = (y % 64 - first) * 64 + c;
                    if ((work->surface.covered[at / 16] >> (at & 15) & 1u) == 0) continue;
                    check(x + c + sample.x / 256.0, y + sample.y / 256.0, at, work->surface);
                    ++count;
                }
            }
        }
    }
    return count;
}

TEST(Orthographic, NothingNearerThanTheNearPlaneIsSeen) {
    // Sheets 2 m and 5 m below a camera that looks straight down from 10 m.
    Scene scene = empty_scene(64, 64);
    add(scene, plane(20, 20), 0, {0, 5, 0});
    add(scene, plane(1, 1), 0, {0, 8, 0});
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.height_m = 4;
    scene.camera.eye = {0, 10, 0};
    scene.camera.look_at = {0, 0, 0};
    const auto depth_at_centre = [&](double near_m) {
        scene.camera.near_m = near_m;
        return render_frame(scene, all_channels()).depth_m(32, 32);
    };
    EXPECT_NEAR(depth_at_centre(0.05), 2, 1e-6);
    EXPECT_NEAR(depth_at_centre(1.999), 2, 1e-6);
    EXPECT_NEAR(depth_at_centre(2.001), 5, 1e-6);
    EXPECT_NEAR(depth_at_centre(4.5), 5, 1e-6);
    EXPECT_EQ(depth_at_centre(5.5), std::numeric_limits<float>::infinity());

    // A slanted sheet through the near plane is cut where the plane is.
    Scene slanted = textured_floor();
    slanted.camera.kind = CameraKind::orthographic;
    slanted.camera.height_m = 7;
    slanted.camera.near_m = 9;
    int seen = 0;
    const Frame frame = render_frame(slanted, all_channels());
    for (const float depth : frame.depth_m.pixels) {
        EXPECT_GE(depth, 8.99f);
        seen += depth < 9.5f;
    }
    EXPECT_GT(seen, 100);
}

TEST(Visibility, BacksOfASolidThatTurnsInsideOutAreSeen) {
    // A beam along +Z whose width falls from 2 m through 0 to -0.6 m: closed, of positive volume, and inside
    // out at its far end.
    Mesh beam = box({2, 2, 3});
    for (Vec3f& p : beam.positions) {
        if (p.z > 0) p.x *= -0.3f;
    }
    Scene scene = empty_scene(64, 64);
    add(scene, beam, 0, {0, 0, 1.5f});
    ASSERT_EQ(scene.mesh.components.size(), 1u);
    ASSERT_TRUE(scene.mesh.components[0].closed);
    ASSERT_GT(signed_volumes(scene.mesh)[0], 0);
    scene.camera.eye = {5, 0, 2.9};
    scene.camera.look_at = {0, 0, 2.9};
    EXPECT_NEAR(render_frame(scene, all_channels()).depth_m(32, 32), 5 - 1.3 * 2.9 / 3 + 1, 0.02);
}

TEST(Channels, AMeshWithoutObjectsShowsNone) {
    Scene scene = textured_floor();
    scene.mesh.object.clear();
    scene.mesh.objects.clear();
    for (const std::uint32_t object : render_frame(scene, all_channels()).object.pixels)
        ASSERT_EQ(object, no_object);
}

class Floor : public testing::TestWithParam<bool> {};

TEST_P(Floor, PositionsUvsAndDerivativesAreThoseOfTheRays) {
    Scene scene = textured_floor(4);
    if (GetParam()) {
        scene.camera.kind = CameraKind::orthographic;
        scene.camera.height_m = 7;
    }
    const Vec3d eye = scene.camera.eye;
    const auto uv = [](const FloorHit& h) {
        // plane(): u along +X, v away from +Z, in metres; here halved.
        return Vec2d{0.5 * h.x, -0.5 * h.z};
    };
    double origin_u = 0, origin_v = 0;
    bool first = true;
    const int count = for_each_covered(scene, [&](double X, double Y, int at, const SurfaceBlock& s) {
        const FloorHit hit = floor_hit(scene, X, Y);
        ASSERT_TRUE(hit.hit);
        const double distance = std::hypot(hit.x - eye.x, hit.z - eye.z, eye.y);
        const double slant = distance / eye.y;
        EXPECT_NEAR(eye.x + static_cast<double>(s.px[at]), hit.x, 1e-6 * distance * slant);
        EXPECT_NEAR(eye.y + static_cast<double>(s.py[at]), 0, 1e-6 * distance);
        EXPECT_NEAR(eye.z + static_cast<double>(s.pz[at]), hit.z, 1e-6 * distance * slant);
        EXPECT_EQ(s.ny[at], 1.0f);

        // The uv origin is the shape's business: take it from the first sample.
        const Vec2d here = uv(hit);
        if (first) {
            origin_u = static_cast<double>(s.u[at]) - here.x;
            origin_v = static_cast<double>(s.v[at]) - here.y;
            first = false;
        }
        constexpr double e = 1e-3;
        const auto derivative = [&](double dx, double dy) {
            const FloorHit a = floor_hit(scene, X - dx * e, Y - dy * e),
                           b = floor_hit(scene, X + dx * e, Y + dy * e);
            return (uv(b) - uv(a)) * (0.5 / e);
        };
        const Vec2d dx = derivative(1, 0), dy = derivative(0, 1);
        const double scale = std::max(std::hypot(dx.x, dx.y), std::hypot(dy.x, dy.y));
        // Corners are snapped to 1/256 pixel, and uvs clamped to the triangle.
        EXPECT_NEAR(static_cast<double>(s.u[at]), here.x + origin_u, 1e-5 * slant + scale / 128);
        EXPECT_NEAR(static_cast<double>(s.v[at]), here.y + origin_v, 1e-5 * slant + scale / 128);
        EXPECT_NEAR(static_cast<double>(s.ux[at]), dx.x, 2e-3 * scale);
        EXPECT_NEAR(static_cast<double>(s.vx[at]), dx.y, 2e-3 * scale);
        EXPECT_NEAR(static_cast<double>(s.uy[at]), dy.x, 2e-3 * scale);
        EXPECT_NEAR(static_cast<double>(s.vy[at]), dy.y, 2e-3 * scale);
    });
    EXPECT_GT(count, 10000);
}
INSTANTIATE_TEST_SUITE_P(Cameras, Floor, testing::Bool());

TEST(Surface, NormalsOfASphereAreItsRadii) {
    Scene scene = empty_scene(100, 100);
    add(scene, sphere(1, 96, 48), 0);
    scene.camera.eye = {0, 0.5, 4};
    double worst = 0;
    const int count = for_each_covered(scene, [&](double, double, int at, const SurfaceBlock& s) {
        const Vec3d p = scene.camera.eye + Vec3d{static_cast<double>(s.px[at]), static_cast<double>(s.py[at]),
                                                 static_cast<double>(s.pz[at])};
        const Vec3d n{static_cast<double>(s.nx[at]), static_cast<double>(s.ny[at]),
                      static_cast<double>(s.nz[at])};
        EXPECT_NEAR(length(n), 1, 1e-6);
        worst = std::max(worst, length(n - normalize(p)));
    });
    EXPECT_GT(count, 1000);
    EXPECT_LT(worst, 0.004);  // chords of 3.75 degrees
}

TEST(Surface, BackSidesOfSheetsTurnTheirNormals) {
    Scene scene = empty_scene(20, 20);
    add(scene, plane(10, 10), 0);
    scene.camera.eye = {0, -3, 1};
    for_each_covered(scene, [&](double, double, int at, const SurfaceBlock& s) {
        ASSERT_EQ(s.ny[at], -1.0f);
        ASSERT_EQ(s.gy[at], -1.0f);
    });
    EXPECT_EQ(render_frame(scene, all_channels()).normal(10, 10), (Vec3f{0, -1, 0}));
}

TEST(Surface, SolidsHideTheirBacksWhereverTheCameraStands) {
    // From outside backs are culled, from inside they must not be.
    Scene scene = empty_scene(32, 32);
    add(scene, box({4, 4, 4}), 0);
    FrameOptions options;
    options.depth = true;
    scene.camera.eye = {0, 0, 10};
    EXPECT_NEAR(render_frame(scene, options).depth_m(16, 16), 8.0f, 1e-4f);
    scene.camera.eye = {0, 0, 0.5};
    EXPECT_NEAR(render_frame(scene, options).depth_m(16, 16), 2.5f, 1e-4f);
    // An inside-out solid shows its inner walls' fronts from inside and its backs from outside.
    for (Triangle& t : scene.mesh.triangles)
        std::swap(t.v[1], t.v[2]);
    analyse_topology(scene.mesh);
    scene.camera.eye = {0, 0, 10};
    EXPECT_NEAR(render_frame(scene, options).depth_m(16, 16), 8.0f, 1e-4f);
}

TEST(Texture, FastLog2IsNearTheTrueOne) {
    for (double x = 1e-3; x < 1e9; x *= 1.0371) {
        EXPECT_NEAR(static_cast<double>(fast_log2(static_cast<float>(x))), std::log2(x),
                    2e-4 + 1e-7 * std::log2(x + 2));
    }
    EXPECT_EQ(fast_log2(1024.0f), 10.0f);
}

TEST(Texture, LookupsAreExactAtTexelCentresAndRepeat) {
    Texture texture;
    texture.levels.emplace_back(4, 2);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 4; ++x)
            texture.levels[0](x, y) = {static_cast<float>(x), static_cast<float>(y), 1};
    }
    for (const float shift : {0.0f, 1.0f, -3.0f}) {
        // Row 0 is the top row; (0, 0) is the lower left corner.
        EXPECT_EQ(sample_level(texture, 0, {0.125f + shift, 0.75f}), (Vec3f{0, 0, 1}));
        EXPECT_EQ(sample_level(texture, 0, {0.875f, 0.25f + shift}), (Vec3f{3, 1, 1}));
        EXPECT_EQ(sample_level(texture, 0, {0.5f + shift, 0.75f}), (Vec3f{1.5f, 0, 1}));
        // Across the border: between the last and the first column.
        EXPECT_EQ(sample_level(texture, 0, {0.0f + shift, 0.5f}), (Vec3f{1.5f, 0.5f, 1}));
    }
}

TEST(Texture, MipLevelIsTheLogOfTheLongerSideOfThePixel) {
    const Texture texture = checkerboard(64, 8);
    EXPECT_EQ(mip_level(texture, {{1.0f / 64, 0}, {0, 1.0f / 64}}), 0.0f);
    EXPECT_EQ(mip_level(texture, {{1.0f / 16, 0}, {0, 1.0f / 64}}), 2.0f);
    EXPECT_EQ(mip_level(texture, {{1e-6f, 0}, {0, 1e-6f}}), 0.0f);
    EXPECT_EQ(mip_level(texture, {{100, 0}, {0, 0}}), 6.0f);
    EXPECT_EQ(mip_level(texture, {{NAN, 0}, {0, INFINITY}}), 6.0f);
}

TEST(Texture, FarCheckerboardFadesToItsMeanAndNearKeepsItsSquares) {
    Scene scene = textured_floor();
    for (Vec2f& uv : scene.mesh.uvs)
        uv = uv * 8.0f;
    FrameOptions options;
    options.albedo = options.depth = true;
    const Frame frame = render_frame(scene, options);
    std::set<float> near_values;
    int far = 0;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            const float v = frame.albedo(x, y).x, z = frame.depth_m(x, y);
            if (std::isinf(z)) continue;
            if (z > 22) {
                EXPECT_NEAR(v, 0.5f, 0.02f) << x << "," << y << " at " << z << " m";
                ++far;
            }
        }
    }
    EXPECT_GT(far, 100);
    // Close by, squares are black and white.
    Scene close = textured_floor();
    close.camera.eye = {0.3, 1.5, 1};
    close.camera.look_at = {0.3, 0, 0.5};
    const Frame near_frame = render_frame(close, options);
    int black = 0, white = 0;
    for (const Vec3f& v : near_frame.albedo.pixels) {
        black += v.x < 0.02f;
        white += v.x > 0.98f;
    }
    EXPECT_GT(black, 6000);
    EXPECT_GT(white, 6000);
}

TEST(SamplePattern, OneSamplePerColumnAndRowAndTheMeanAtTheCentre) {
    for (const int n : {1, 4, 16}) {
        const auto pattern = sample_pattern(n);
        ASSERT_EQ(pattern.size(), static_cast<std::size_t>(n));
        std::set<int> columns, rows;
        int x = 0, y = 0;
        for (const SamplePosition p : pattern) {
            columns.insert(p.x * n / 256);
            rows.insert(p.y * n / 256);
            x += p.x;
            y += p.y;
        }
        EXPECT_EQ(columns.size(), pattern.size());
        EXPECT_EQ(rows.size(), pattern.size());
        EXPECT_EQ(x, 128 * n);
        EXPECT_EQ(y, 128 * n);
    }
    // Sixteen queens do not see each other.
    const auto queens = sample_pattern(16);
    for (std::size_t i = 0; i < 16; ++i) {
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_NE(std::abs(queens[i].x - queens[j].x), std::abs(queens[i].y - queens[j].y));
    }
}

TEST(SamplePattern, SamplesMeasureTheShareOfAPixelThatAnEdgeCovers) {
    // A white quad whose vertical edge moves through one pixel.
    for (const int samples : {4, 16}) {
        for (const double share : {0.25, 0.5, 0.75}) {
            Scene scene = empty_scene(8, 8, samples);
            scene.materials[0].base_color = {0, 0, 0};
            scene.materials[0].emission = {1, 1, 1};
            add(scene, box({-10, -10, -1}, {share, 10, 0}), 0);
            scene.camera.kind = CameraKind::orthographic;
            scene.camera.height_m = 8;
            scene.camera.eye = {0, 0, 5};
            EXPECT_NEAR(pixel(render_frame(scene), 4, 4).x, share, 1e-6);
        }
    }
}

}  // namespace
}  // namespace obscura
