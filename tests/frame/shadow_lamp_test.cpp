// Lamps inside things: seams of the six maps, margins of kernels, rooms that are inside out.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>

#include "raster/shadow_map.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

/// Looks down on a floor of 12 x 12 m; what is lower than 2 m below the eye's 10 is floor.
Scene floor_below(LightKind kind, bool closed_floor, int filter_px, int resolution) {
    Scene scene = empty_scene(120, 120);
    add(scene, box({1, 1, 1}), 0, {0, 1, 0});
    if (closed_floor) {
        add(scene, box({12, 1, 12}), 0, {0, -0.5f, 0});
    } else {
        add(scene, plane(12, 12), 0);
    }
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.height_m = 12;
    scene.camera.eye = {0, 10, 0};
    scene.camera.look_at = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    SceneLight lamp = at_point(kind, {0.07, 1.03, -0.04}, {0.1, -1, 0.05}, {10, 10, 10});
    lamp.light.outer_cone_deg = 70;
    lamp.light.inner_cone_deg = 65;
    lamp.shadow.filter_px = filter_px;
    lamp.shadow.resolution = resolution;
    scene.lights.push_back(lamp);
    return scene;
}

// The margin around a face for kernels of 15 texels is as wide as all of a map of 16, whose kernels reach
// over all of a face: then planes continued to their taps come before the box, and something is lit.
TEST(Lamp, MapsHardlyWiderThanTheirKernelDarkenWhatABoxHides) {
    for (const LightKind kind : {LightKind::point, LightKind::spot}) {
        for (const int resolution : {16, 32}) {
            for (const int side : {7, 9, 15}) {
                Scene scene = floor_below(kind, true, side, resolution);
                scene.lights[0].shadow.method = ShadowMethod::compressed;
                const Frame frame = render_frame(scene, all_channels());
                double light = 0;
                for (int y = 0; y < 120; ++y) {
                    for (int x = 0; x < 120; ++x)
                        light += frame.depth_m(x, y) < 9.9f ? 0.0 : static_cast<double>(pixel(frame, x, y).x);
                }
                const std::string what = (kind == LightKind::spot ? "spot " : "point ") +
                                         std::to_string(resolution) + ", kernel " + std::to_string(side);
                if (2 * (side / 2 + 1) < resolution) {
                    EXPECT_EQ(light, 0) << what;
                }
                EXPECT_TRUE(std::isfinite(light)) << what;
            }
        }
    }
}

TEST(Lamp, AClosedBoxLetsNoLightOutAtAnyResolutionAndKernel) {
    for (const LightKind kind : {LightKind::point, LightKind::spot}) {
        for (const bool closed_floor : {false, true}) {
            for (const int resolution : {16, 20, 32, 48, 64, 100, 128, 144, 192, 256}) {
                for (const int side : {1, 3, 5}) {
                    const Frame frame =
                        render_frame(floor_below(kind, closed_floor, side, resolution), all_channels());
                    int floor = 0, lit = 0;
                    for (int y = 0; y < 120; ++y) {
                        for (int x = 0; x < 120; ++x) {
                            if (frame.depth_m(x, y) < 9.9f) continue;
                            ++floor;
                            // A point's six maps reach everywhere; beyond its cone a spot has none.
                            lit += kind == LightKind::point ? frame.shadow(x, y) != 0.0f
                                                            : pixel(frame, x, y).x != 0.0f;
                        }
                    }
                    EXPECT_EQ(lit, 0) << (kind == LightKind::spot ? "spot " : "point ") << resolution
                                      << ", kernel " << side << (closed_floor ? ", slab" : ", sheet");
                    EXPECT_GT(floor, 10000);
                }
            }
        }
    }
}

TEST(Lamp, ARoomThatIsInsideOutIsLitWithoutSpeckles) {
    Scene scene = empty_scene(160, 120);
    Mesh room = box({5, 3, 4});
    for (Triangle& t : room.triangles)
        std::swap(t.v[1], t.v[2]);
    for (Vec3f& n : room.normals)
        n = -n;
    add(scene, room, 0, {0, 1.5f, 0});
    scene.camera.eye = {-2, 1.6, 1.5};
    scene.camera.look_at = {1, 1.2, -1};
    const CameraRays rays = camera_rays(scene.camera, scene.render.width, scene.render.height);
    for (const int side : {1, 3, 5}) {
        scene.lights.assign(1, at_point(LightKind::point, {0.4, 2.1, 0.3}, {0, -1, 0}, {10, 10, 10}));
        scene.lights[0].shadow.filter_px = side;
        scene.lights[0].shadow.resolution = 512;
        const Frame frame = render_frame(scene, all_channels());
        int inner = 0, dark = 0;
        for (int y = 0; y < frame.height; ++y) {
            for (int x = 0; x < frame.width; ++x) {
                const auto along = [&](int k) {
                    const double dir = rays.dir0[k] + (x + 0.5) * rays.dir_x[k] + (y + 0.5) * rays.dir_y[k];
                    return rays.eye[k] + dir * static_cast<double>(frame.depth_m(x, y));
                };
                // Where walls meet without thickness, kernels find one before the other.
                const int walls = (std::fabs(along(0)) > 2.5 - 0.08) +
                                  (std::fabs(along(1) - 1.5) > 1.5 - 0.08) +
                                  (std::fabs(along(2)) > 2.0 - 0.08);
                if (walls > 1) continue;
                ++inner;
                dark += frame.shadow(x, y) != 1.0f;
            }
        }
        EXPECT_EQ(dark, 0) << "kernel " << side;
        EXPECT_GT(inner, 15000);
    }
}

TEST(Lamp, CancelStopsWhileMapsAreBuiltAndTheNextFrameBuildsThemAfresh) {
    const Scene scene = everything(1);
    FrameCache cache;
    Frame frame;
    std::atomic<bool> cancel = true;
    FrameOptions options;
    options.cancel = &cancel;
    render_frame(scene, options, {}, cache, frame);
    EXPECT_FALSE(frame.complete);
    EXPECT_EQ(frame.stats.shadow_maps, 0);
    EXPECT_EQ(frame.stats.samples, 0);
    cancel = false;
    render_frame(scene, options, {}, cache, frame);
    EXPECT_TRUE(frame.complete);
    EXPECT_EQ(hash(frame), hash(render_frame(scene)));
}

}  // namespace
}  // namespace obscura
