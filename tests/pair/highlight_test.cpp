// Where highlights stand in depth: those of an unedited pair against pictures of two cameras.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/frame/stage.h"
#include "tests/pair/eyes.h"

namespace obscura {
namespace {

using namespace frame_scenes;
using namespace stereo_eyes;

/// A glossy ball on a glossy floor under one lamp and a sky.
Scene glossy() {
    Scene scene = empty_scene(240, 160, 4);
    scene.sky = Sky{};
    scene.materials.resize(3);
    scene.materials[1].roughness = 0.3f;
    scene.materials[1].base_color = {0.1f, 0.1f, 0.1f};
    scene.materials[2].roughness = 0.25f;
    scene.materials[2].base_color = {0.02f, 0.02f, 0.02f};
    add(scene, sphere(1, 96, 48), 1, {0.6f, 1, 0});
    add(scene, plane(30, 30, 1, 1), 2, {0, 0, 0});
    scene.lights = {directional({-0.2, -1, 0.9}, {2, 2, 2})};
    scene.camera = {CameraKind::perspective, {0, 1.8, 6}, {0, 1.1, 0}, {0, 1, 0}, 40, 10, 0.05};
    return scene;
}

/// Mean column of what is brighter than 0.6 of the brightest pixel in rows [y0, y1), weighted by the rest.
double highlight(const Frame& frame, int x0, int x1, int y0, int y1) {
    float most = 0;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x)
            most = std::max(most, pixel(frame, x, y).y);
    }
    double sum = 0, moment = 0;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            const double w = std::max(0.0, static_cast<double>(pixel(frame, x, y).y - 0.6f * most));
            sum += w;
            moment += w * (x + 0.5);
        }
    }
    return moment / sum;
}

TEST(EyesLight, HighlightsAreWhereTwoCamerasSeeThem) {
    const Scene scene = glossy();
    const int offset = 12;
    const StereoRig rig = rig_with_offset(scene, 0.35, offset);
    const auto pair_of = [&](EyeShading shading) {
        EyesCache cache;
        EyeFrames eyes;
        EyesWanted wanted;
        wanted.shading = shading;
        EXPECT_TRUE(
            render_eyes(scene, unrefined(scene), unedited(scene, rig), rig, wanted, 0, {}, cache, eyes));
        return eyes;
    };
    const EyeFrames eyes = pair_of(EyeShading::eyes), middle = pair_of(EyeShading::middle);
    // Wider by offset / 2 on either side: column x of the left eye is x + offset there, of the right one x.
    const Frame left = render_frame(beside(scene, rig, Eye::left, offset / 2)),
                right = render_frame(beside(scene, rig, Eye::right, offset / 2));
    int differ = 0, differ_middle = 0;
    for (int y = 0; y < eyes.left.height; ++y) {
        for (int x = 0; x < eyes.left.width; ++x) {
            const auto off = [&](const EyeFrames& e) {
                return std::max(std::fabs(pixel(e.left, x, y).y - pixel(left, x + offset, y).y),
                                std::fabs(pixel(e.right, x, y).y - pixel(right, x, y).y));
            };
            differ += off(eyes) > 0.01f ? 1 : 0;
            differ_middle += off(middle) > 0.01f ? 1 : 0;
        }
    }
    EXPECT_LE(differ, 5) << "outlines, where corners snap";
    EXPECT_GT(differ_middle, 100);
    struct Rows {
        const char* of;
        int y0, y1;
    };
    for (const Rows& r : {Rows{"ball", 30, 90}, Rows{"floor", 130, 160}}) {
        const auto disparity = [&](const EyeFrames& e) {
            return highlight(e.left, 0, 240, r.y0, r.y1) - highlight(e.right, 0, 240, r.y0, r.y1);
        };
        const double truth =
            highlight(left, offset, 240 + offset, r.y0, r.y1) - offset - highlight(right, 0, 240, r.y0, r.y1);
        EXPECT_NEAR(disparity(eyes), truth, 0.05) << r.of;
        EXPECT_GT(std::fabs(disparity(middle) - truth), 1) << r.of;
    }
}

}  // namespace
}  // namespace obscura
