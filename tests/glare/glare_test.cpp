// Glare in frames: where it stands among the stages, what it leaves alone, what frames share.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "app/frame/frame_glare.h"
#include "app/frame/load_scene.h"
#include "app/frame/render_frame.h"
#include "app/glare/glare_memory.h"
#include "app/glare/hidden_lamps.h"
#include "app/glare/lamp_pixels.h"
#include "app/glare/lens.h"
#include "app/glare/source_kernels.h"
#include "app/report/lens_text.h"
#include "app/report/render_stats.h"
#include "app/scene/build.h"
#include "core/error.h"
#include "core/isa.h"
#include "core/num.h"
#include "tests/frame/one_picture.h"

namespace obscura {
namespace {

/// A lamp before a wall; `rest` follows.
std::string night(const std::string& rest) {
    return R"(format = 1
[camera]
eye_m = [0, 1, 4]
look_at_m = [0, 1, 0]
vfov_deg = 40
[render]
size_px = [72, 48]
samples = 1
[sky]
visible = false
ambient = 0.2
[material.glow]
base_color = 0
emission_w_m2_sr = [900, 700, 400]
[[mesh]]
id = "wall"
shape = "box"
size_m = [3, 2, 0.2]
translate_m = [0, 1, -1]
[[mesh]]
id = "bulb"
shape = "sphere"
radius_m = 0.08
material = "glow"
translate_m = [0.4, 1.2, 0]
)" + rest;
}

const char* const lens = R"([optics]
aperture = "slit"
mask_px = 64
f_number = 200
wavelengths = 5
radius_px = 20
)";

Scene scene_of(const std::string& text) {
    return load_scene(read_scene_text(text, "night.toml"), FileAccess{".", {}});
}

double light_of(const Frame& frame) {
    double sum = 0;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            const Vec3f p = frame.radiance.view()(x, y);
            sum += static_cast<double>(p.x) + static_cast<double>(p.y) + static_cast<double>(p.z);
        }
    }
    return sum;
}

bool same(const Frame& a, const Frame& b) {
    if (a.width != b.width || a.height != b.height) return false;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            if (a.radiance.view()(x, y) != b.radiance.view()(x, y)) return false;
        }
    }
    return true;
}

TEST(FrameGlare, KeepsTheLightAndLeavesOtherChannels) {
    const Frame plain = render_frame(scene_of(night("")), all_channels()),
                glare = render_frame(scene_of(night(lens)), all_channels());
    EXPECT_FALSE(plain.stats.glare);
    ASSERT_TRUE(glare.stats.glare);
    EXPECT_GT(glare.stats.glare->sources, 0);
    EXPECT_FALSE(same(plain, glare));
    const double sources = light_of(plain);
    EXPECT_NEAR(light_of(glare) / sources, 1 - glare.stats.glare->lost, 2e-3)
        << "the wall's light adds to the lamp's";
    EXPECT_TRUE(glare.depth_m == plain.depth_m);
    EXPECT_TRUE(glare.normal == plain.normal);
    EXPECT_TRUE(glare.albedo == plain.albedo);
    EXPECT_TRUE(glare.object == plain.object);
    EXPECT_TRUE(glare.shadow == plain.shadow);
}

TEST(FrameGlare, ACropIsPartOfTheWhole) {
    const Scene scene = scene_of(night(lens));
    const Frame whole = render_frame(scene, all_channels());
    FrameOptions options = all_channels();
    options.crop = {5, 9, 40, 21};
    const Frame part = render_frame(scene, options);
    ASSERT_EQ(part.width, 40);
    ASSERT_EQ(part.height, 21);
    EXPECT_EQ(part.x0, 5);
    for (int y = 0; y < 21; ++y) {
        for (int x = 0; x < 40; ++x) {
            ASSERT_EQ(part.radiance.view()(x, y), whole.radiance.view()(x + 5, y + 9)) << x << " " << y;
            ASSERT_EQ(part.object(x, y), whole.object(x + 5, y + 9));
            ASSERT_EQ(part.depth_m(x, y), whole.depth_m(x + 5, y + 9));
        }
    }
}

TEST(FrameGlare, ThePatternTellsItsProgressAndCanBeStopped) {
    const Scene scene = scene_of(night(lens));
    std::vector<double> shares;
    std::atomic<bool> cancel{false};
    FrameOptions options;
    options.cancel = &cancel;
    options.progress = [&](double share) { shares.push_back(share); };
    EXPECT_TRUE(render_frame(scene, options, {}).complete);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);

    // All tiles are done at a half: what is stopped from there on is the pattern.
    options.progress = [&](double share) { cancel = share >= 0.5; };
    const Frame stopped = render_frame(scene, options, {});
    EXPECT_FALSE(stopped.complete);
    EXPECT_EQ(stopped.stats.glare->kernels, 0);
}

TEST(FrameGlare, NothingClipsNothingChanges) {
    const Frame plain = render_frame(scene_of(night("")));
    const Frame glare = render_frame(scene_of(night(std::string(lens) + "clip = 2000\n")));
    ASSERT_TRUE(glare.stats.glare);
    EXPECT_EQ(glare.stats.glare->sources, 0);
    EXPECT_EQ(glare.stats.glare->psf_s, 0) << "no pattern is computed";
    EXPECT_NE(glare.stats.glare->reason.find("nothing is computed"), std::string::npos);
    EXPECT_TRUE(same(plain, glare));
}

TEST(FrameGlare, ExposureMovesTheClipLevel) {
    // The lamp's radiance is 900: at -10 EV it is 0.88.
    Scene scene = scene_of(night(lens));
    scene.render.exposure_ev = -10;
    EXPECT_EQ(render_frame(scene).stats.glare->sources, 0);
    scene.render.exposure_ev = -9;
    EXPECT_GT(render_frame(scene).stats.glare->sources, 0);
}

TEST(FrameGlare, PatternsAreKeptWhileTheLensStays) {
    Scene scene = scene_of(night(lens));
    FrameCache cache;
    Frame frame;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_FALSE(frame.stats.glare->kept);
    const Frame first = render_frame(scene);
    scene.optics.clip = 3;
    scene.render.exposure_ev = 1;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_TRUE(frame.stats.glare->kept) << "neither clip level nor exposure change the pattern";
    scene.optics.clip = 1;
    scene.render.exposure_ev = 0;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_TRUE(frame.stats.glare->kept);
    EXPECT_TRUE(same(frame, first)) << "no frame depends on those before it";
    scene.optics.shape.rotation_deg = 30;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_FALSE(frame.stats.glare->kept);
    EXPECT_FALSE(same(frame, first));
    EXPECT_TRUE(same(frame, render_frame(scene)));
}

TEST(FrameGlare, BitsDoNotDependOnThreadsOrInstructionSets) {
    const Scene scene = scene_of(night(lens));
    FrameCache cache;
    Frame expected, frame;
    render_frame(scene, {}, {Isa::ref, 1}, cache, expected);
    for (const Isa isa : supported_isas()) {
        for (const int threads : {1, 3}) {
            FrameCache own;
            render_frame(scene, {}, {isa, threads}, own, frame);
            EXPECT_TRUE(same(frame, expected)) << isa_name(isa) << " " << threads;
        }
    }
}

TEST(FrameGlare, TheCameraDecidesThePixelsTrueSize) {
    const Scene by_angle = scene_of(night(std::string(lens) + "focal_length_mm = 50\n"));
    const double height = 2 * 50 * num::tan(num::pi / 9);
    EXPECT_NEAR(by_angle.optics.sensor_height_mm, height, 1e-9);
    EXPECT_NEAR(pixel_m(by_angle.optics, by_angle.render), 1e-3 * height / 48, 1e-12);
    EXPECT_NEAR(pupil_m(by_angle.optics), 0.05 / 200, 1e-15);
    const Scene by_width = scene_of(night(std::string(lens) + "sensor_width_mm = 36\n"));
    EXPECT_NEAR(by_width.optics.sensor_height_mm, 24, 1e-9);
    EXPECT_NEAR(by_width.optics.focal_length_mm, 12 / num::tan(num::pi / 9), 1e-9);
    EXPECT_EQ(scene_of(night(lens)).optics.focal_length_mm, by_width.optics.focal_length_mm);
}

TEST(FrameGlare, CheckTellsWhatItWouldDo) {
    const Scene scene = scene_of(night(std::string(lens) + "focal_length_mm = 50\n"));
    const std::string text = lens_text(scene.optics, scene.render, 3);
    for (const char* part :
         {"slit, 50 mm at f/200 (pupil 0.25 mm)", "pixels of 758.3 um", "41 x 41 pixels",
          "cycles of the pupil a pixel", "its pattern: ", "5 wavelengths", "MiB to spread it"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    EXPECT_EQ(lens_text(scene_of(night("")).optics, scene.render, 0), "");
}

TEST(FrameGlare, MemoryIsPlannedBeforeTheWork) {
    const Scene scene = scene_of(night(lens));
    const std::int64_t with = estimate_memory(scene).frame,
                       without = estimate_memory(scene_of(night(""))).frame;
    EXPECT_GT(with, without + 72 * 48 * 12);
    EXPECT_THROW(scene_of(night(std::string(lens) + "[limits]\nmemory_mib = 1\n")), LimitError)
        << estimate_memory(scene).total();
    Scene wide = scene;
    wide.optics.radius_px = 4000;
    EXPECT_GT(estimate_memory(wide).frame, with + (std::int64_t{1} << 30));
}

TEST(FrameGlare, MemoryCountsKernelsAndTheFinestMask) {
    const std::int64_t kernel = 41 * 41 * 12;
    EXPECT_EQ(lamp_count(scene_of(night(lens))), 1);
    EXPECT_EQ(lamp_count(scene_of(night(std::string(lens) + "clip = 1000\n"))), 0);
    const auto kernels = [](const std::string& keys, std::int64_t lamps) {
        return expected_kernels(scene_of(night(lens + keys)).optics, lamps);
    };
    EXPECT_EQ(kernels("", 8), 2);
    EXPECT_EQ(kernels("visibility = \"exact\"\nvisibility_samples = 9\n", 0), 2);
    EXPECT_EQ(kernels("visibility = \"exact\"\nvisibility_samples = 9\n", 1), 2 + 9);
    EXPECT_EQ(kernels("visibility = \"exact\"\nvisibility_samples = 9\n", 8), 2 + 2 * 9);
    EXPECT_EQ(kernels("focus_m = 3\nfocus_steps = 7\n", 8), 2 + 7);
    // They are held while the light is spread.
    OpticsSettings many = scene_of(night(std::string(lens) + "visibility = \"exact\"\n")).optics;
    const RenderSettings render = scene_of(night(lens)).render;
    many.visibility_samples = 4000;
    const std::int64_t least = glare_bytes(many, render, 0, 1, {});
    many.visibility_samples = 4005;
    EXPECT_EQ(glare_bytes(many, render, 0, 1, {}), least + 5 * kernel);
    // Nine samples a pixel of all colours, of one kernel at a time.
    const OpticsSettings wide = [] {
        OpticsSettings o = scene_of(night(lens)).optics;
        o.focus_m = 3;
        o.radius_px = 4096;
        return o;
    }();
    EXPECT_GT(glare_bytes(wide, {}, 0, 0, {}), std::int64_t{9} * 8193 * 8193 * 16);
    // Far streaks of a wide round lens are made of a mask as fine as masks get.
    OpticsSettings fine = scene_of(night(lens)).optics;
    fine.shape.kind = ApertureKind::circle;
    EXPECT_LT(glare_bytes(fine, render, 0, 0, {}), std::int64_t{4096} * 4096 * 4);
    fine.f_number = 1;
    EXPECT_GT(glare_bytes(fine, render, 0, 0, {}), std::int64_t{4096} * 4096 * 4);
}

TEST(FrameGlare, BrightPixelsAndPatternsAreHeldToTheLimitWhenTheyAreKnown) {
    const Scene scene = scene_of(night(std::string(lens) + "visibility = \"exact\"\n"));
    const std::int64_t most = std::int64_t{1} << 30;
    EXPECT_GT(glare_bytes(scene.optics, scene.render, 0, 1, most), most * bytes_per_lamp_pixel);
    EXPECT_NO_THROW(check_bright_pixels(scene, 1));
    EXPECT_THROW(check_bright_pixels(scene, most), LimitError);
    const std::int64_t kernel = 41 * 41 * 12, expected = expected_kernels(scene.optics, 1);
    EXPECT_EQ(kernels_that_fit(scene, -1), expected);
    EXPECT_EQ(kernels_that_fit(scene, 7 * kernel), expected + 7);
    SourceKernels full;
    full.most = 1;
    EXPECT_EQ(add_kernel(Image<Vec3f>(1, 1), full), 0);
    EXPECT_THROW(add_kernel(Image<Vec3f>(1, 1), full), LimitError);
}

TEST(FrameGlare, StatisticsTellOfIt) {
    const Scene scene = scene_of(night(lens));
    RenderReport report;
    FrameReport& frame = report.frames.emplace_back();
    frame.stats = render_frame(scene).stats;
    const std::string json = stats_json(report);
    for (const char* member : {"\"glare\": {", "\"sources\": ", "\"spread\": ", "\"lost\": ", "\"psf\": "})
        EXPECT_NE(json.find(member), std::string::npos) << member << json;
}

struct BadLens {
    const char* keys;
    const char* message;
};

TEST(FrameGlare, ContradictionsAreErrors) {
    const std::string start = night("");
    const std::vector<BadLens> all = {
        {"[optics]\nblades = 6\naperture = \"circle\"\n",
         "'blades' does not apply to [optics] with aperture = \"circle\""},
        {"[optics]\nfocal_length_mm = 50\nsensor_width_mm = 36\n",
         "'sensor_width_mm' = 36 does not fit focal_length_mm = 50 and the camera's angle of view, which "
         "make it 54.5955"},
        {"[optics]\ntemperature_kelvin = 3000\n", "'temperature_kelvin' needs light = \"blackbody\""},
        {"[optics]\naperture = \"irsi\"\n", "did you mean 'iris'?"},
        {"[optics]\nradius_px = 0\n", "'radius_px' must be in [1, 4096], not 0"},
        {"[optics]\nclip = 0\n", "'clip' must be"},
        {"[[frames.optics]]\nframe = 1\nclip = 3\n", "there is no [optics] to be animated"},
    };
    for (const BadLens& bad : all) {
        try {
            read_scene_text(start + bad.keys, "s.toml");
            ADD_FAILURE() << "read: " << bad.keys;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(bad.message), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(
        read_scene_text("format = 1\n[camera]\neye_m = [0, 1, 5]\nlook_at_m = [0, 0, 0]\nprojection = "
                        "\"orthographic\"\nheight_m = 3\n[optics]\n",
                        "s.toml"),
        InputError);
    EXPECT_THROW(
        read_scene_text("format = 1\n[camera]\neye_m = [0, 1, 5]\nlook_at_m = [0, 0, 0]\nfocal_length_mm = "
                        "50\n[optics]\nfocal_length_mm = 60\n",
                        "s.toml"),
        InputError);
}

}  // namespace
}  // namespace obscura
