// Reading, overriding, dumping and animating scene files that are right.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "app/scene/keyframes.h"
#include "app/scene/scene_file.h"
#include "app/scene/stereo_settings.h"

namespace obscura {
namespace {

constexpr const char* small_scene = R"(format = 1
[camera]
eye_m = [0, 2, 8]
look_at_m = [0, 1, 0]
vfov_deg = 35
[[mesh]]
id = "cube"
shape = "box"
size_m = 2
material = "stone"
[[mesh.instance]]
translate_m = [3, 0, 0]
[material.stone]
base_color = [0.6, 0.55, 0.5]
[[light]]
id = "lamp"
type = "directional"
azimuth_deg = 120
elevation_deg = 30
[shadow.lamp]
resolution = 1024
[frames]
range = "1-9x2"
[[frames.camera]]
frame = 1
vfov_deg = 30
[[frames.camera]]
frame = 5
vfov_deg = 50
)";

TEST(SceneFile, ValuesAndDefaultsArrive) {
    const SceneDocument scene = read_scene_text(small_scene, "s.toml");
    EXPECT_EQ(vec3(subtable(scene.root, "camera"), "up"), (Vec3d{0, 1, 0}));
    const SceneTable& mesh = *subtables(scene.root, "mesh").at(0);
    EXPECT_EQ(vec3(mesh, "size_m"), (Vec3d{2, 2, 2}));
    EXPECT_EQ(vec3(*subtables(mesh, "instance").at(0), "translate_m"), (Vec3d{3, 0, 0}));
    const SceneTable& shadow = subtable(*subtables(scene.root, "light").at(0), "shadow");
    EXPECT_EQ(integer(shadow, "resolution"), 1024);
    EXPECT_EQ(integer(shadow, "filter_px"), 3);
    EXPECT_EQ(size2(subtable(scene.root, "render"), "size_px").width, 960);
}

TEST(SceneFile, DumpReadsBackToItself) {
    const std::string first = dump_scene(read_scene_text(small_scene, "s.toml"));
    EXPECT_NE(first.find("roughness = 0.8"), std::string::npos) << "defaults are missing";
    EXPECT_EQ(dump_scene(read_scene_text(first, "dump.toml")), first);
}

TEST(SceneFile, OverridesReplaceAndCreate) {
    const SceneDocument scene =
        read_scene_text(small_scene, "s.toml",
                        {"camera.vfov_deg=20", "light.lamp.elevation_deg=5", "render.tone=linear",
                         "mesh.0.size_m=[1,2,3]", "shadow.lamp.filter_px = 5"});
    EXPECT_EQ(number(subtable(scene.root, "camera"), "vfov_deg"), 20);
    EXPECT_EQ(number(*subtables(scene.root, "light").at(0), "elevation_deg"), 5);
    EXPECT_EQ(text(subtable(scene.root, "render"), "tone"), "linear");
    EXPECT_EQ(vec3(*subtables(scene.root, "mesh").at(0), "size_m"), (Vec3d{1, 2, 3}));
    EXPECT_EQ(integer(subtable(*subtables(scene.root, "light").at(0), "shadow"), "filter_px"), 5);
}

TEST(Keyframes, LinearTracksAreStraightAndHeldOutside) {
    const SceneDocument scene = read_scene_text(small_scene, "s.toml");
    const auto vfov = [&](double frame) { return number(camera_at(scene, frame), "vfov_deg"); };
    EXPECT_EQ(vfov(0), 30);
    EXPECT_EQ(vfov(1), 30);
    EXPECT_EQ(vfov(2), 35);
    EXPECT_EQ(vfov(5), 50);
    EXPECT_EQ(vfov(9), 50);
    EXPECT_EQ(scene_frames(scene), (FrameRange{1, 9, 2}));
}

TEST(Keyframes, SmoothTracksAreCatmullRom) {
    // Even spacing: the textbook weights at the middle of a segment are (-1, 9, 9, -1) / 16.
    const Track even{{0, 1, 2, 3}, {{1}, {5}, {2}, {8}}};
    EXPECT_DOUBLE_EQ(evaluate(even, 1.5, Interpolation::smooth)[0], (-1.0 + 45 + 18 - 8) / 16);
    EXPECT_EQ(evaluate(even, 1, Interpolation::smooth)[0], 5);
    EXPECT_EQ(evaluate(even, -1, Interpolation::smooth)[0], 1);
    EXPECT_EQ(evaluate(even, 4, Interpolation::smooth)[0], 8);
    // Straight lines stay straight, however uneven the keyframes are, and components do not mix.
    const Track line{{0, 1, 7, 8.5}, {{1, 0}, {3, 0}, {15, 1}, {18, 0}}};
    for (const double frame : {0.25, 1.0, 3.3, 7.9}) {
        EXPECT_NEAR(evaluate(line, frame, Interpolation::smooth)[0], 1 + 2 * frame, 1e-12) << frame;
    }
    // The slope is continuous across a keyframe.
    const auto at = [&](double frame) { return evaluate(even, frame, Interpolation::smooth)[0]; };
    EXPECT_NEAR((at(2) - at(2 - 1e-6)) / 1e-6, (at(2 + 1e-6) - at(2)) / 1e-6, 1e-4);
}

TEST(Keyframes, OvershootIsClampedToTheRange) {
    const SceneDocument scene = read_scene_text(R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
[[light]]
id = "l"
type = "directional"
azimuth_deg = 0
elevation_deg = 0
[frames]
interpolation = "smooth"
light = [{id = "l", frame = 0, irradiance_w_m2 = 9}, {id = "l", frame = 1, irradiance_w_m2 = 0},
         {id = "l", frame = 2, irradiance_w_m2 = 0}]
)",
                                                "s.toml");
    const SceneTable& light = *subtables(scene.root, "light").at(0);
    EXPECT_EQ(vec3(light_at(scene, light, 1.5), "irradiance_w_m2"), (Vec3d{0, 0, 0}));
    EXPECT_EQ(vec3(light_at(scene, light, 0), "irradiance_w_m2"), (Vec3d{9, 9, 9}));
    EXPECT_EQ(vec3(light, "irradiance_w_m2"), (Vec3d{3, 3, 3})) << "the document itself does not move";
}

TEST(Keyframes, DatesStayInTheYearsOfTheirKey) {
    // A smooth curve swings beyond its last keyframes.
    const SceneDocument scene = read_scene_text(R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
[[light]]
id = "l"
type = "sun"
latitude_deg = 48
longitude_deg = 16
time = 2190-06-21T12:00:00Z
[frames]
interpolation = "smooth"
light = [{id = "l", frame = 0, time = 1800-01-01T00:00:00-11:00},
         {id = "l", frame = 1, time = 2200-12-31T23:59:59+11:00},
         {id = "l", frame = 2, time = 2200-12-31T23:59:59+11:00}]
)",
                                                "s.toml");
    const SceneTable& light = *subtables(scene.root, "light").at(0);
    for (int i = 0; i <= 20; ++i) {
        const int year = date_time(light_at(scene, light, 0.1 * i), "time").year;
        EXPECT_TRUE(year >= 1800 && year <= 2200) << year;
    }
}

TEST(SceneFile, LeapSecondsAreTheNextMinute) {
    const auto time_of = [](const std::string& time) {
        const std::string text =
            std::string(
                "format = 1\ncamera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]} # 2016-12-31T23:59:60Z\n"
                "light = [{id = \"l\", type = \"sun\", latitude_deg = 48, longitude_deg = 16, time = ") +
            time + "}]\n";
        return date_time(*subtables(read_scene_text(text, "s.toml").root, "light").at(0), "time");
    };
    EXPECT_EQ(time_of("2016-12-31T23:59:60Z"), (DateTime{2017, 1, 1, 0, 0, 0, 0, true, 0}));
    EXPECT_EQ(time_of("2017-01-01 00:59:60.25+01:00"),
              (DateTime{2017, 1, 1, 1, 0, 0, 250'000'000, true, 60}));
    EXPECT_EQ(time_of("2016-12-31T23:59:59Z"), (DateTime{2016, 12, 31, 23, 59, 59, 0, true, 0}));
    const SceneDocument scene = read_scene_text(
        "format = 1\ncamera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}\n"
        "[[light]]\nid = \"l\"\ntype = \"sun\"\nlatitude_deg = 48\nlongitude_deg = 16\n"
        "time = 2016-12-31T23:59:60Z\n[[frames.light]]\nid = \"l\"\nframe = 1\n"
        "time = 2015-06-30T23:59:60Z\n[[frames.light]]\nid = \"l\"\nframe = 2\ntime = "
        "2016-12-31T23:59:59Z\n",
        "s.toml");
    EXPECT_EQ(date_time(*subtables(subtable(scene.root, "frames"), "light").at(0), "time").year, 2015);
    EXPECT_EQ(date_time(*subtables(subtable(scene.root, "frames"), "light").at(0), "time").month, 7);
}

TEST(StereoLimits, ComfortKeepsToItsSideOfTheScreen) {
    // From so near, no eye can turn in far enough.
    const SceneDocument document = read_scene_text(
        "format = 1\ncamera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}\n"
        "stereo = {viewing_distance_m = 1e-20, comfort_far_deg = 0}\n",
        "s.toml");
    EXPECT_LE(stereo_settings(document, Scene{}, 1, {}).edit.comfort.farthest_px, 0);
}

TEST(Keyframes, TimesRunThroughMidnightAndMonths) {
    const DateTime evening{2028, 2, 28, 23, 30, 0, 0, true, 60};
    const DateTime later = from_epoch_seconds(epoch_seconds(evening) + 3600.5, 60);
    EXPECT_EQ(later, (DateTime{2028, 2, 29, 0, 30, 0, 500000000, true, 60}));
    EXPECT_EQ(epoch_seconds({1970, 1, 1, 1, 0, 0, 0, true, 60}), 0);
    EXPECT_EQ(from_epoch_seconds(-1, 0), (DateTime{1969, 12, 31, 23, 59, 59, 0, true, 0}));
}

TEST(Keyframes, FrameRanges) {
    EXPECT_EQ(parse_frame_range("7"), (FrameRange{7, 7, 1}));
    EXPECT_EQ(parse_frame_range("1-48x5"), (FrameRange{1, 48, 5}));
    EXPECT_EQ(parse_frame_range("1-48x5")->count(), 10);
    EXPECT_TRUE(parse_frame_range("1-48x5")->contains(46));
    EXPECT_FALSE(parse_frame_range("1-48x5")->contains(48));
    for (const char* bad :
         {"", "-1", "1-", "5-4", "1-5x0", "1-5x", "1 - 5", "1,2", "1x2", "9999999999", "1-2-3"}) {
        EXPECT_FALSE(parse_frame_range(bad)) << bad;
    }
}

TEST(SceneFile, EndingsOfOutputsAreOfAnyCase) {
    for (const char* file : {"A.PNG", "a.Pfm", "a.png"})
        EXPECT_NO_THROW(read_scene_text(fmt::format("format = 1\ncamera = {{eye_m = [0, 1, 5], look_at_m = "
                                                    "[0, 0, 0]}}\n[[output]]\nfile = \"{}\"\n",
                                                    file),
                                        "s.toml"))
            << file;
}

}  // namespace
}  // namespace obscura
