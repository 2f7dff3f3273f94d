// The margin that glare is taken from: what is just outside of the frame glares into it, and nothing else
// changes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/frame/light_shadow.h"
#include "app/frame/load_scene.h"
#include "app/frame/memory.h"
#include "app/frame/render_frame.h"
#include "app/glare/glare_margin.h"
#include "app/glare/lens.h"
#include "app/scene/build.h"
#include "optics/aperture_extent.h"
#include "tests/frame/one_picture.h"

namespace obscura {
namespace {

Scene scene_of(const std::string& text) {
    return load_scene(read_scene_text(text, "margin.toml"), FileAccess{".", {}});
}

/// A sky of three clip levels all around.
std::string bright_sky(const std::string& keys) {
    return R"(format = 1
[camera]
eye_m = [0, 1, 4]
look_at_m = [0, 1, 0]
vfov_deg = 40
[render]
size_px = [192, 128]
samples = 1
[sky]
zenith_w_m2_sr = 3
horizon_w_m2_sr = 3
ground_w_m2_sr = 3
[optics]
blades = 6
f_number = 24
wavelengths = 12
mask_px = 128
radius_px = 90
)" + keys;
}

/// A lamp of 0.3 x 0.3 m, `x_m` to the right (the frame ends at 1.9), a floor with shadows and a texture.
std::string lamp_aside(double x_m, const std::string& keys) {
    return R"(format = 1
[camera]
eye_m = [0, 1, 4]
look_at_m = [0, 1, 0]
vfov_deg = 40
[render]
size_px = [128, 96]
samples = 4
[sky]
visible = false
ambient = 0.2
[material.glow]
base_color = 0
emission_w_m2_sr = [900, 700, 400]
[[light]]
id = "sun"
type = "directional"
azimuth_deg = 30
elevation_deg = 40
irradiance_w_m2 = 1
[light.shadow]
method = "compressed"
[[mesh]]
id = "floor"
shape = "box"
size_m = [9, 0.2, 9]
translate_m = [0, -0.1, 0]
[[mesh]]
id = "post"
shape = "box"
size_m = [0.2, 1.2, 0.2]
translate_m = [-0.7, 0.6, 0]
[[mesh]]
id = "lamp"
shape = "box"
size_m = [0.3, 0.3, 0.3]
material = "glow"
translate_m = [)" +
           std::to_string(x_m) + R"(, 1.2, 0]
[optics]
aperture = "slit"
rotation_deg = 0
mask_px = 64
f_number = 200
wavelengths = 5
radius_px = 40
)" + keys;
}

void expect_same(const Frame& a, const Frame& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    EXPECT_EQ(a.x0, b.x0);
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x)
            ASSERT_EQ(a.radiance.view()(x, y), b.radiance.view()(x, y)) << x << " " << y;
    }
    EXPECT_TRUE(a.depth_m == b.depth_m);
    EXPECT_TRUE(a.normal == b.normal);
    EXPECT_TRUE(a.albedo == b.albedo);
    EXPECT_TRUE(a.object == b.object);
    EXPECT_TRUE(a.shadow == b.shadow);
}

/// The darkest channel of a picture that should be 3 throughout, as a share of that.
double darkest(const Frame& frame) {
    float least = 3;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            const Vec3f p = frame.radiance.view()(x, y);
            least = std::min({least, p.x, p.y, p.z});
        }
    }
    return static_cast<double>(least) / 3;
}

TEST(GlareMargin, ABrightSkyIsUniformToItsCorners) {
    // A 500th of the clip level may be missing at each side, of a sky of three.
    const Frame wide = render_frame(scene_of(bright_sky("")));
    ASSERT_TRUE(wide.stats.glare);
    EXPECT_GT(wide.stats.glare->margin_px, 4);
    EXPECT_LT(wide.stats.glare->margin_px, 16);
    EXPECT_EQ(wide.width, 192);
    EXPECT_GT(darkest(wide), 1 - 2.0 / 500 / 3);
    EXPECT_LT(darkest(render_frame(scene_of(bright_sky("margin_px = 0\n")))), 0.985);
}

TEST(GlareMargin, ALampOutsideOfTheFrameGlaresIntoIt) {
    const Frame plain = render_frame(scene_of(lamp_aside(2.2, "clip = 2000\n")), all_channels());
    const Frame without = render_frame(scene_of(lamp_aside(2.2, "margin_px = 0\n")), all_channels());
    expect_same(without, plain);
    EXPECT_EQ(without.stats.glare->sources, 0);
    const Frame with = render_frame(scene_of(lamp_aside(2.2, "")), all_channels());
    EXPECT_EQ(with.stats.glare->margin_px, 96 / 8);
    EXPECT_GT(with.stats.glare->sources, 10);
    // The slit's streak runs along the rows of the lamp.
    const int row = 42;
    const float before = plain.radiance.view()(127, row).y, after = with.radiance.view()(127, row).y;
    EXPECT_GT(after, before + 0.5f);
    EXPECT_TRUE(with.object == plain.object) << "other channels have no margin";
    EXPECT_TRUE(with.depth_m == plain.depth_m);
}

TEST(GlareMargin, ALampThatLeavesThePictureLosesItsGlareLittleByLittle) {
    // Half a pixel wide, from the frame's border to beyond the margin, a third of a pixel at a time.
    std::vector<float> seen;
    for (int step = 0; step <= 54; ++step) {
        std::string text = lamp_aside(1.96 + 0.01 * step, "");
        const std::string size = "size_m = [0.3, 0.3, 0.3]";
        text.replace(text.find(size), size.size(), "size_m = [0.015, 0.3, 0.015]");
        const Frame frame = render_frame(scene_of(text));
        ASSERT_EQ(frame.stats.glare->margin_px, 12);
        // Near enough for the streak to reach from everywhere in the margin.
        float sum = 0;
        for (int x = 104; x < 120; ++x)
            sum += frame.radiance.view()(x, 42).y;
        seen.push_back(sum);
    }
    const float most = *std::max_element(seen.begin(), seen.end()), least = seen.back();
    EXPECT_EQ(seen[seen.size() - 2], least) << "beyond the margin";
    ASSERT_GT(most, least + 1);
    float jump = 0;
    for (std::size_t i = 1; i < seen.size(); ++i)
        jump = std::max(jump, std::abs(seen[i] - seen[i - 1]) / (most - least));
    RecordProperty("jump", std::to_string(jump));
    EXPECT_LT(jump, 0.15f);
}

TEST(GlareMargin, SharesFallFromTheMiddleOfItToItsEnd) {
    EXPECT_EQ(margin_share(0, 12), 1.0f);
    EXPECT_EQ(margin_share(6, 12), 1.0f);
    EXPECT_EQ(margin_share(9, 12), 0.5f);
    EXPECT_EQ(margin_share(12, 12), 0.0f);
    EXPECT_EQ(margin_share(0.5, 1), 1.0f);
    for (int i = 1; i < 120; ++i)
        EXPECT_LE(margin_share(0.1 * (i - 1), 12) - margin_share(0.1 * i, 12), 3.0f / 12 * 0.1f + 1e-6f);
}

TEST(GlareMargin, TheFrameInsideIsTheSameBits) {
    // Nothing clips, so only what the margin does to rendering could show: shadows are whole maps here, for
    // parts of them hold other depths, as true, when more is looked up.
    for (const char* scope : {"", "scope = \"full\"\n"}) {
        const auto text = [&](const std::string& keys) {
            std::string scene = lamp_aside(0.4, "clip = 2000\n" + keys);
            const std::string method = "method = \"compressed\"\n";
            return scene.insert(scene.find(method) + method.size(), scope);
        };
        const Frame none = render_frame(scene_of(text("margin_px = 0\n")), all_channels());
        for (const char* margin : {"margin_px = 1\n", "margin_px = 37\n", "margin_px = 64\n"}) {
            SCOPED_TRACE(margin);
            expect_same(render_frame(scene_of(text(margin)), all_channels()), none);
        }
    }
}

TEST(GlareMargin, CropsAreThePictures) {
    const Scene scene = scene_of(lamp_aside(2.2, "margin_px = 30\n"));
    const Frame whole = render_frame(scene, all_channels());
    for (const Region crop : {Region{0, 0, 9, 96}, Region{70, 20, 58, 31}, Region{127, 95, 1, 1}}) {
        FrameOptions options = all_channels();
        options.crop = crop;
        const Frame part = render_frame(scene, options);
        ASSERT_EQ(part.width, crop.width);
        ASSERT_EQ(part.x0, crop.x0);
        for (int y = 0; y < crop.height; ++y) {
            for (int x = 0; x < crop.width; ++x) {
                ASSERT_EQ(part.radiance.view()(x, y), whole.radiance.view()(crop.x0 + x, crop.y0 + y));
                ASSERT_EQ(part.object(x, y), whole.object(crop.x0 + x, crop.y0 + y));
            }
        }
    }
}

TEST(GlareMargin, LampsInItMayBePartlyHidden) {
    // A screen before the lens, outside of the frame, too, ends before the middle of the lamp.
    const auto sees = [](const std::string& visibility) {
        std::string text = lamp_aside(2.2, "visibility = \"" + visibility + "\"\n");
        text.insert(text.find("[optics]"),
                    "[[mesh]]\nid = \"screen\"\nshape = \"box\"\nsize_m = [0.05, 0.3, 0.001]\n"
                    "translate_m = [0.19, 1, 3.7]\n");
        text.replace(text.find("f_number = 200"), 14, "f_number = 8");
        const std::string slit = "aperture = \"slit\"\nrotation_deg = 0\n";
        text.replace(text.find(slit), slit.size(), "aperture = \"circle\"\n");
        return render_frame(scene_of(text)).stats;
    };
    const FrameStats open = sees("open"), hidden = sees("exact");
    ASSERT_GT(open.glare->sources, 10);
    EXPECT_EQ(open.glare->own_kernel_sources, 0);
    EXPECT_GT(hidden.glare->own_kernel_sources, 0);
    EXPECT_GT(hidden.glare->blocked, 0.01);
}

TEST(GlareMargin, FollowsTheLightThatTheKernelSendsFar) {
    OpticsSettings optics = scene_of(bright_sky("")).optics;
    const RenderSettings render = scene_of(bright_sky("")).render;
    const auto margin = [&](double brightest) { return glare_margin(optics, render, brightest); };
    EXPECT_EQ(margin(0), margin(4)) << "what stands in the light";
    EXPECT_GT(margin(5), margin(4));
    EXPECT_EQ(margin(1e9), 128 / 8);
    optics.radius_px = 5;
    EXPECT_LE(margin(1e9), 5) << "no light comes from farther away";
    optics.margin_px = 77;
    EXPECT_EQ(margin(0), 77);
    optics.enabled = false;
    EXPECT_EQ(margin(1e9), 0);
    EXPECT_EQ(glare_margin(Scene{}), 0);
}

TEST(GlareMargin, MemoryCountsIt) {
    const auto bytes = [](const std::string& keys) {
        return estimate_memory(scene_of(bright_sky(keys))).frame;
    };
    const std::int64_t pixels = std::int64_t{192 + 400} * (128 + 400) - 192 * 128;
    EXPECT_GT(bytes("margin_px = 200\n"), bytes("margin_px = 0\n") + pixels * 24);
    EXPECT_LT(bytes("margin_px = 200\n"), bytes("margin_px = 0\n") + pixels * 200);
    EXPECT_THROW(scene_of(bright_sky("margin_px = 4096\n[limits]\nmemory_mib = 1024\n")), LimitError);
}

TEST(GlareMargin, ShadowsOfOnePictureAreMadeAgainForAWiderOne) {
    Scene scene = scene_of(lamp_aside(2.2, "margin_px = 3\n"));
    FrameCache cache;
    Frame frame;
    render_frame(scene, {}, {}, cache, frame);
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_TRUE(frame.stats.lights.at(0).kept);
    scene.optics.margin_px = 40;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_FALSE(frame.stats.lights.at(0).kept);
    const Frame fresh = render_frame(scene);
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x)
            ASSERT_EQ(frame.radiance.view()(x, y), fresh.radiance.view()(x, y));
    }
}

}  // namespace
}  // namespace obscura
