// Depth of the receiver's plane: solids thinner than a texel is steep, and what stands on them.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/num.h"
#include "raster/shadow_map.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

constexpr double deg = num::pi / 180;

/// A slab of 1 cm with a box of 6 x 2 x 4 m on it, seen from above; the sun stands low.
Scene thin_slab(int filter_px, double elevation_deg, double azimuth_deg) {
    Scene scene = empty_scene(300, 300);
    add(scene, box({30, 0.01, 30}), 0, {0, -0.005f, 0});
    add(scene, box({6, 2, 4}), 0, {0, 1, 0});
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.height_m = 30;
    scene.camera.eye = {0, 10, 0};
    scene.camera.look_at = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    const double e = elevation_deg * deg, a = azimuth_deg * deg;
    scene.lights.push_back(directional({num::cos(e) * num::cos(a), -num::sin(e), num::cos(e) * num::sin(a)},
                                       {1, 1, 1}, filter_px, 256));
    return scene;
}

bool in_footprint(Vec3d p) {
    return std::fabs(p.x) <= 3 && std::fabs(p.z) <= 2;
}

/// Whether the box hides the light from a point of the slab.
bool is_shaded(Vec3d p, Vec3d direction) {
    // Way back to the light until it is above the box: 2 m up.
    double enter = 0, leave = 2 / -direction.y;
    for (const auto& [at, way, half] : {std::array{p.x, -direction.x, 3.0}, {p.z, -direction.z, 2.0}}) {
        const double a = (-half - at) / way, b = (half - at) / way;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
}

// At 0.02 degrees a texel of 4 cm reaches 100 m along the slab, and its plane leaves the depths of the box.
TEST(ShadowPlane, GrazingLightLeavesALevelSlabLit) {
    for (const double elevation : {1.0, 0.5, 0.2, 0.05, 0.02}) {
        for (const ShadowMethod method : {ShadowMethod::map, ShadowMethod::compressed}) {
            Scene scene = thin_slab(1, elevation, 20);
            scene.mesh = {};
            add(scene, box({30, 0.5, 30}), 0, {0, -0.25f, 0});
            add(scene, box({0.1, 0.15, 0.1}), 0, {0, 0.075f, 0});
            scene.lights[0].shadow.method = method;
            scene.lights[0].shadow.resolution = 1024;
            const Frame frame = render_frame(scene, all_channels());
            int seen = 0, dark = 0;
            for (int y = 0; y < 300; ++y) {
                for (int x = 0; x < 300; ++x) {
                    const Vec3d p{(x + 0.5) / 10 - 15, 0, (y + 0.5) / 10 - 15};
                    // Beside the post's shadow, which ends beyond the slab.
                    if (std::fabs(p.x * num::sin(20 * deg) - p.z * num::cos(20 * deg)) < 0.3) continue;
                    ++seen;
                    dark += frame.shadow(x, y) < 1 ? 1 : 0;
                }
            }
            EXPECT_GT(seen, 80000);
            EXPECT_EQ(dark, 0) << elevation << (method == ShadowMethod::map ? ", map" : ", tree");
        }
    }
}

class ThinSlab : public testing::TestWithParam<int> {};

TEST_P(ThinSlab, HasNoAcneUnderALowSunAndTheBoxOnItLeaksNoLight) {
    const int side = GetParam();
    for (const double elevation : {10.0, 30.0}) {
        for (const double azimuth : {20.0, 115.0}) {
            const Scene scene = thin_slab(side, elevation, azimuth);
            const Vec3d l = scene.lights[0].light.direction;
            const double texel = texel_size_m(shadow_views(scene.lights[0], bounds_of(scene.mesh))[0]);
            // The kernel and one texel, across the light and along it.
            const double across_m = (side / 2 + 1.0) * texel, along_m = across_m / -l.y;
            const Vec3d along = normalize(Vec3d{l.x, 0, l.z}), across = {-along.z, 0, along.x};
            const Frame frame = render_frame(scene, all_channels());
            int lit = 0, dark = 0, acne = 0, leaks = 0, contact = 0;
            for (int y = 0; y < 300; ++y) {
                for (int x = 0; x < 300; ++x) {
                    const Vec3d p{(x - 149.5) * 0.1, 0, (y - 149.5) * 0.1};
                    if (in_footprint(p)) continue;
                    if (std::max(std::fabs(p.x), std::fabs(p.z)) > 15 - along_m) continue;
                    int votes = 0, voters = 0, beside = 0;
                    for (int k = 0; k < 25; ++k) {
                        const Vec3d q =
                            p + along * (along_m * (k % 5 - 2) / 2) + across * (across_m * (k / 5 - 2) / 2);
                        ++voters;
                        // Under the box: dark if behind it, no question if before it.
                        beside += in_footprint(q);
                        votes += is_shaded(q, l);
                    }
                    const float v = frame.shadow(x, y);
                    if (votes == 0) {
                        ++lit;
                        acne += v != 1.0f;
                    } else if (votes == voters) {
                        ++dark;
                        contact += beside > 0;
                        leaks += v != 0.0f;
                    }
                }
            }
            EXPECT_EQ(acne, 0) << "of " << lit << ", elevation " << elevation << " azimuth " << azimuth;
            EXPECT_EQ(leaks, 0) << "of " << dark << ", elevation " << elevation << " azimuth " << azimuth;
            EXPECT_GT(lit, 10000);
            EXPECT_GT(dark, 200);
            EXPECT_GT(contact, 20);
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Kernels, ThinSlab, testing::Values(1, 3, 5));

}  // namespace
}  // namespace obscura
