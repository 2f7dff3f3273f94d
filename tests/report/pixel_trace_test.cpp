// The account of a pixel ends at the picture's pixel.

#include "app/report/pixel_trace.h"

#include <gtest/gtest.h>

#include "filters/tonemap.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

TEST(PixelTrace, EndsAtThePicturesPixelBitForBit) {
    for (const int samples : {1, 4, 16}) {
        const Scene scene = everything(samples);
        FrameCache cache;
        Frame frame;
        render_frame(scene, {}, {}, cache, frame);
        const Image<Rgb8> picture = tonemap(std::as_const(frame.radiance).view(), {}, {});
        for (const auto& [x, y] :
             {std::pair{0, 0}, {199, 129}, {60, 60}, {100, 40}, {130, 70}, {101, 100}, {95, 47}}) {
            const PixelTrace trace = trace_pixel(scene, x, y, {}, cache);
            EXPECT_EQ(trace.radiance, pixel(frame, x, y)) << trace.text;
            EXPECT_EQ(trace.pixel, picture(x, y)) << trace.text;
        }
    }
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
