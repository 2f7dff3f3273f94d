// Reading, overriding, dumping and animating scene files that are right.

#include <gtest/gtest.h>

#include <string>

#include "app/keyframes.h"
#include "app/scene_file.h"

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

}  // namespace
}  // namespace obscura
