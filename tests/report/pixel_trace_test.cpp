// The account of a pixel ends at the picture's pixel.

#include "app/report/pixel_trace.h"

#include <gtest/gtest.h>

#include "filters/tonemap.h"
#include "raster/camera_rays.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

/// The same with exact shadows.
Scene exactly(Scene scene) {
    for (SceneLight& light : scene.lights)
        light.shadow.method = ShadowMethod::exact;
    return scene;
}

/// And with lights that have a size, and one that is nothing but.
Scene softly(Scene scene) {
    for (SceneLight& light : scene.lights) {
        light.light.angular_diameter_deg = 3;
        light.light.radius_m = 0.2;
        light.shadow.samples = 16;
    }
    SceneLight area = scene.lights.back();
    area.light.kind = LightKind::area;
    area.light.position = {1, 5, 2};
    area.light.direction = {0, -1, 0};
    area.shadow.samples = auto_samples;
    scene.lights.push_back(area);
    return exactly(std::move(scene));
}

/// Pixels of a picture of 200 x 130, or of the same one smaller.
void expect_pictures_pixels(const Scene& scene) {
    const int width = scene.render.width, height = scene.render.height;
    FrameCache cache;
    Frame frame;
    render_frame(scene, {}, {}, cache, frame);
    const Image<Rgb8> picture = tonemap(std::as_const(frame.radiance).view(), {}, {});
    for (const auto& [x_of_200, y_of_130] :
         {std::pair{0, 0}, {199, 129}, {60, 60}, {100, 40}, {130, 70}, {101, 100}, {95, 47}}) {
        const int x = x_of_200 * width / 200, y = y_of_130 * height / 130;
        const PixelTrace trace = trace_pixel(scene, x, y, {}, cache);
        EXPECT_EQ(trace.radiance, pixel(frame, x, y)) << trace.text;
        EXPECT_EQ(trace.pixel, picture(x, y)) << trace.text;
    }
}

TEST(PixelTrace, EndsAtThePicturesPixelBitForBit) {
    for (const int samples : {1, 4, 16}) {
        expect_pictures_pixels(everything(samples));
        expect_pictures_pixels(exactly(everything(samples)));
    }
}

TEST(PixelTrace, EndsThereWithLightsThatHaveASize) {
    for (const int samples : {1, 4, 16}) {
        Scene scene = softly(everything(samples));
        scene.render.width = 80;
        scene.render.height = 52;
        expect_pictures_pixels(scene);
    }
}

/// The same out of stacks.
Scene stacked(Scene scene) {
    for (SceneLight& light : scene.lights) {
        const bool inside = light.light.kind == LightKind::point;
        light.shadow.method = inside ? ShadowMethod::exact : ShadowMethod::stack;
        light.shadow.samples = 16;
        light.shadow.resolution = 256;
    }
    return scene;
}

TEST(PixelTrace, EndsThereWithStacks) {
    for (const int samples : {1, 4})
        expect_pictures_pixels(stacked(softly(everything(samples))));
    const std::string text = trace_pixel(stacked(softly(everything(1))), 100, 110).text;
    EXPECT_NE(text.find("of 16 points of the light reach it; of its 16 parts"), std::string::npos) << text;
}

TEST(PixelTrace, TellsOfALightWithASizeHowMuchReachesASample) {
    Scene scene = softly(everything(4));
    scene.sky.occlusion = true;
    scene.sky.samples = 16;
    const std::string text = trace_pixel(scene, 100, 110).text;
    for (const char* word : {"(directional, with a size): ", " of 16 points reach it",
                             "(area, with a size): ", "sky: ", " of 6 directions reach it"})
        EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
}

TEST(PixelTrace, NamesTheTriangleThatDarkensASample) {
    // A box over a ground, seen from above.
    Scene scene = empty_scene(64, 48);
    add(scene, plane(6, 6), 0);
    add(scene, box({1, 1, 1}), 0, {0, 1.5f, 0});
    scene.camera.eye = {0, 6, 0.01};
    scene.camera.look_at = {0, 0, 0};
    scene.lights.push_back(directional({-1, -1, 0}, {1, 1, 1}));
    scene = exactly(std::move(scene));
    const CameraRays rays = camera_rays(scene.camera, 64, 48);
    // The point (-1.5, 0, 0) of the ground lies straight behind the box; (2, 0, 0) is free.
    const auto column = [&](double x) { return static_cast<int>((x / 6 - rays.dir0[0]) / rays.dir_x[0]); };
    const std::string dark = trace_pixel(scene, column(-1.5), 24).text,
                      lit = trace_pixel(scene, column(2), 24).text;
    for (const char* word : {"exact: view 0 of 1", "triangles darken it", "of object \"part\"",
                             "m along the light", "behind its plane", "visibility 0"})
        EXPECT_NE(dark.find(word), std::string::npos) << word << "\n" << dark;
    EXPECT_NE(lit.find("visibility 1"), std::string::npos) << lit;
}

TEST(PixelTrace, TellsOfEveryStage) {
    const Scene scene = everything(1);
    const std::string text = trace_pixel(scene, 100, 110).text;
    for (const char* word : {"triangle", "barycentrics", "depth", "position", "normal", "\"tiles\"",
                             "texture", "level", "directional", "point", "spot", "tap", "own texel: interval",
                             "visibility", "diffuse", "specular", "mean radiance", "sRGB"}) {
        EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
    }
}

}  // namespace
}  // namespace obscura
