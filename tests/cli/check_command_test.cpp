// What `obscura check` says of a scene: every light's maps, the meshes, the output; nothing is written.

#include "app/cli/check_command.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>

#include "app/cli/info_command.h"
#include "core/error.h"
#include "core/image_io.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

TEST(CheckCommand, ReportsWithoutRendering) {
    TemporaryFolder folder;
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
[[mesh]]
id = "a"
shape = "box"
[[light]]
id = "lamp"
type = "point"
position_m = [0, 3, 0]
intensity_w_sr = 20
shadow = {method = "map", resolution = 1024}
[[light]]
id = "spot"
type = "spot"
position_m = [0, 3, 0]
look_at_m = [0, 0, 0]
intensity_w_sr = 20
shadow = {resolution = 65536, scope = "full", filter = "hierarchical"}
[[light]]
id = "sun"
type = "directional"
azimuth_deg = 90
elevation_deg = 40
shadow = {resolution = "auto"}
[[light]]
id = "moon"
type = "directional"
azimuth_deg = 180
elevation_deg = 40
[frames]
range = "1-48"
[[output]]
file = "out_####.png"
)");
    const std::string report = check_report({folder.path / "s.toml", {"render.samples=1"}, {}});
    for (const char* line :
         {"picture   960 x 540 pixels, 1 sample each", "frames    48 (1-48)",
          "output    beauty -> out_####.png",
          "light     lamp: point, 6 dense shadow maps of 1024 x 1024, filter 3 x 3, 24.0 MiB",
          "light     spot: spot, 1 compressed shadow map of 65536 x 65536, filter 3 x 3, built whole, "
          "filtered hierarchically, about 12.0 MiB",
          "light     sun: directional, 1 compressed shadow map of 16384 x 16384, texels of ",
          "          compressed: 'resolution' is of maps\n", "          auto: a texel spans 0.",
          "light     moon: directional, shadows of the picture's own samples, exact: 12 triangles to put in "
          "order, up to 518400 samples to look up\n          exact: 48 frames; a tree pays from 50 on\n",
          "meshes    12 triangles, 24 vertices, 1 object, 1 closed and 0 open components", "\nok\n"}) {
        EXPECT_NE(report.find(line), std::string::npos) << line << "\nis not in\n" << report;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path),
                            std::filesystem::directory_iterator()),
              1)
        << "something was written";
}

TEST(CheckCommand, TellsTheCodeThatAutoTakesAndWhy) {
    const TemporaryFolder folder;
    const auto report = [&](const std::string& shadow) {
        folder.write("s.toml",
                     "format = 1\n[camera]\neye_m = [0, 2, 6]\nlook_at_m = [0, 0, 0]\n[render]\n"
                     "size_px = [20, 16]\n[[mesh]]\nid = \"a\"\nshape = \"box\"\n[[light]]\nid = \"sun\"\n"
                     "type = \"directional\"\nazimuth_deg = 90\nelevation_deg = 40\n"
                     "shadow = {resolution = 1024" +
                         shadow + "}\n");
        return check_report({folder.path / "s.toml", {}, {}});
    };
    const struct {
        const char *keys, *told;
    } cases[] = {
        {", code = \"auto\", filter_px = 1, cache = \"maps\"",
         "\n          mmh: auto, smaller than mh and as fast, and made once for its file\n"},
        {", code = \"auto\", scope = \"full\"",
         "\n          mh: auto, without a cache every run would wait for others to be made\n"},
        {", code = \"auto\"", "\n          mh: auto, parts of a map are written by themselves\n"},
        {", code = \"auto\", cache = \"maps\"",
         "\n          mh: auto, for kernels of several texels smaller ones are slower\n"},
        {", code = \"auto\", cache = \"maps\", top_levels = 0",
         "\n          mh: auto, with so few top_levels smaller ones are slower\n"},
    };
    for (const auto& c : cases) {
        const std::string text = report(c.keys);
        EXPECT_NE(text.find(c.told), std::string::npos) << c.told << "\nis not in\n" << text;
    }
    EXPECT_NE(report(cases[0].keys).find("built whole as mmh and kept in maps"), std::string::npos);
    EXPECT_EQ(report(", code = \"mmh\"").find("mmh: "), std::string::npos) << "as asked";
}

TEST(CheckCommand, StacksAreToldAdvisedAndRefusedAtTheirKey) {
    const TemporaryFolder folder;
    const std::string lamp =
        "format = 1\n[camera]\neye_m = [0, 2, 6]\nlook_at_m = [0, 0, 0]\n[render]\nsize_px = [20, 16]\n"
        "[[mesh]]\nid = \"floor\"\nshape = \"box\"\nsize_m = [8, 1, 8]\n[[light]]\nid = \"lamp\"\n"
        "type = \"area\"\nposition_m = [0, 4, 0]\nlook_at_m = [0, 0, 0]\nradiance_w_m2_sr = 1\n";
    const std::string stack = "[shadow.lamp]\nmethod = \"stack\"\nresolution = 512\n";
    folder.write("s.toml", lamp + stack);
    folder.write("e.toml", lamp);
    const std::string told = check_report({folder.path / "s.toml", {}, {}});
    for (const char* line :
         {"light     lamp: area, a stack of 64 shadow maps of 512 x 512, aimed at a level plane: 12 "
          "triangles to build 64 times, once, 1280 samples to look up a frame, all maps each; about 64.9 "
          "KiB, ",
          " more meanwhile\n          stack: as asked\n"})
        EXPECT_NE(told.find(line), std::string::npos) << told;
    EXPECT_EQ(told.find("note      light"), std::string::npos) << told;

    // Many frames in which it stands still: said, not done.
    const char* advice = "note      light 'lamp': its points have casters of their own";
    const auto report_of = [&](const char* file, std::vector<std::string> overrides) {
        return check_report({folder.path / file, std::move(overrides), {}});
    };
    const std::string many = report_of("e.toml", {"frames.range=\"1-20\""});
    EXPECT_NE(many.find(advice), std::string::npos) << many;
    EXPECT_NE(many.find("          exact: "), std::string::npos) << many;
    EXPECT_EQ(report_of("e.toml", {}).find(advice), std::string::npos) << "one frame";
    const std::string moving = report_of(
        "e.toml", {"frames.range=\"1-20\"",
                   "frames.light=[{id=\"lamp\", frame=1, radiance_w_m2_sr=1}, {id=\"lamp\", frame=20, "
                   "radiance_w_m2_sr=2}]"});
    EXPECT_EQ(moving.find(advice), std::string::npos) << moving;

    // A lamp that shines to its back, too, in a room.
    const auto refused_of = [&](std::vector<std::string> overrides) -> std::string {
        try {
            report_of("s.toml", std::move(overrides));
        } catch (const InputError& error) {
            return error.what();
        } catch (const LimitError& error) {
            return error.what();
        }
        return "";
    };
    const std::string inside = refused_of(
        {"mesh.floor.size_m=[8, 8, 8]", "light.lamp.two_sided=true", "light.lamp.position_m=[0,1,0]"});
    EXPECT_NE(inside.find("s.toml:18:1"), std::string::npos) << inside;
    EXPECT_NE(
        inside.find("light 'lamp': shadow.method = \"stack\" aims all maps at one plane below the light, "
                    "and there is none"),
        std::string::npos)
        << inside;
}

TEST(CheckCommand, TellsWhatHoursOfSunTake) {
    const TemporaryFolder folder;
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
[[mesh]]
id = "a"
shape = "box"
[[light]]
id = "sun"
type = "sun"
latitude_deg = 48.2
longitude_deg = 16.37
time = 2026-03-20T12:00:00+01:00
from = 06:30:00
to = "12:30"
steps = 36
)");
    const auto report_of = [&](std::vector<std::string> overrides) {
        return check_report({folder.path / "s.toml", std::move(overrides), {}});
    };
    const std::string report = report_of({});
    for (const char* line :
         {"sun hours light 'sun', 2026-03-20, 06:30 to 12:30 in 36 steps of 10 min: up 06:30 to "
          "12:30, 6.00 h\n          exact: 36 suns, each with all that casts shadows in order, 36 "
          "in a pass, 1 pass; up to 2073600 samples to look up for each; ",
          " at most\n"}) {
        EXPECT_NE(report.find(line), std::string::npos) << line << "\nis not in\n" << report;
    }
    const std::string night = report_of({"light.sun.from=00:00", "light.sun.to=04:00"});
    EXPECT_NE(
        night.find(
            "note      light 'sun' does not rise at latitude 48.2 on 2026-03-20 between 00:00 and 04:00"),
        std::string::npos)
        << night;
}

/// The message and code class of a lens that is refused.
std::string refused(const TemporaryFolder& folder, const std::string& optics,
                    std::vector<std::string> overrides = {}) {
    folder.write("a.toml",
                 "format = 1\n[camera]\neye_m = [0, 2, 6]\nlook_at_m = [0, 0, 0]\n[render]\nsize_px = [20, "
                 "16]\n[optics]\n" +
                     optics);
    try {
        check_report({folder.path / "a.toml", std::move(overrides), {}});
    } catch (const InputError& error) {
        return "input: " + std::string(error.what());
    } catch (const LimitError& error) {
        return "limit: " + std::string(error.what());
    }
    return "";
}

TEST(CheckCommand, TwoSpellingsOfAFileAreOneOutput) {
    const TemporaryFolder folder;
    const std::string text =
        refused(folder, "[[output]]\nfile = \"x.png\"\n[[output]]\nfile = \"./x.png\"\n");
    EXPECT_NE(text.find("a.toml:11:8: another output has the same 'file'"), std::string::npos) << text;
}

TEST(CheckCommand, APairTakesMoreThanAPicture) {
    TemporaryFolder folder;
    const std::string plain =
        "format = 1\ncamera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}\n[[mesh]]\nid = \"a\"\nshape = "
        "\"box\"\n";
    folder.write("plain.toml", plain);
    folder.write("pair.toml", plain + "[stereo]\n");
    const auto mib_of = [](const std::string& report, const std::string& what) {
        const std::size_t at = report.find(what);
        return at == std::string::npos ? 0.0 : std::stod(report.substr(at + what.size()));
    };
    const std::string one = check_report({folder.path / "plain.toml", {}, {}}),
                      two = check_report({folder.path / "pair.toml", {}, {}});
    EXPECT_EQ(one.find("a pair"), std::string::npos) << one;
    const double picture = mib_of(one, "memory    about ");
    EXPECT_GT(picture, 1);
    EXPECT_EQ(mib_of(two, "memory    about "), picture);
    EXPECT_GT(mib_of(two, "memory    a pair: about "), 3 * picture) << two;
}

TEST(CheckCommand, RefusesWhatRenderingRefuses) {
    TemporaryFolder folder;
    const std::string plain =
        "format = 1\ncamera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}\nrender = {size_px = [2000, "
        "2000]}\n[[mesh]]\nid = \"a\"\nshape = \"box\"\n";
    folder.write("plain.toml", plain);
    std::string files = plain;
    for (const char* aov : {"depth", "normal", "albedo", "object", "shadow"})
        files += std::string("[[output]]\nfile = \"") + aov + ".pfm\"\naov = \"" + aov + "\"\n";
    folder.write("channels.toml", files);
    folder.write("pair.toml", plain + "[stereo]\n");
    const auto check = [&](const char* scene, int limit_mib) -> std::string {
        try {
            check_report({folder.path / scene, {"limits.memory_mib=" + std::to_string(limit_mib)}, {}});
        } catch (const LimitError& error) {
            return error.what();
        }
        return "ok";
    };
    // 2000 x 2000 pixels: 36 bytes of channels are 137 MiB.
    const std::string report = check_report({folder.path / "plain.toml", {}, {}});
    const std::string before = "memory    about ";
    const int picture = std::stoi(report.substr(report.find(before) + before.size()));
    EXPECT_EQ(check("plain.toml", picture + 60), "ok");
    EXPECT_NE(check("channels.toml", picture + 60).find("channels.toml: needs about "), std::string::npos);
    EXPECT_EQ(check("channels.toml", picture + 180), "ok");
    // `render` makes the picture where there is no room for a pair.
    const auto pair = [&](const char* limit) {
        return check_report({folder.path / "pair.toml", {limit}, {}}).find("a pair is refused") !=
               std::string::npos;
    };
    EXPECT_TRUE(pair("limits.memory_mib=200"));
    EXPECT_FALSE(pair("limits.memory_mib=4096"));
}

TEST(CheckCommand, LensesThatNothingHasAreToldAtTheirKey) {
    const TemporaryFolder folder;
    const std::string file = (folder.path / "a.toml").string();
    const std::string range = "; on the sensor they must be from 1e-09 to 1 m wide";
    EXPECT_EQ(refused(folder, "sensor_width_mm = 30000\n"),
              "input: " + file + ":8:19: 'sensor_width_mm' makes pixels of 1.5 m" + range);
    EXPECT_EQ(refused(folder, "focal_length_mm = 1e6\n"),
              "input: " + file + ":8:19: 'focal_length_mm' makes pixels of 45.4963 m" + range);
    EXPECT_EQ(refused(folder, "sensor_width_mm = 1e-300\n"),
              "input: " + file + ":8:19: 'sensor_width_mm' makes pixels of 5e-305 m" + range);
    EXPECT_EQ(refused(folder, "", {"camera.focal_length_mm=50", "camera.sensor_height_mm=1e6"}),
              "input: -D camera.sensor_height_mm=1e6: 'sensor_height_mm' makes pixels of 62.5 m" + range);
    EXPECT_EQ(refused(folder, "", {"camera.vfov_deg=1e-300"}),
              "input: -D camera.vfov_deg=1e-300: 'vfov_deg' must be in [1e-06, 180), not 1e-300");
    EXPECT_EQ(refused(folder, "", {"camera.focal_length_mm=1e-320"}).find("input: -D camera.focal_length_mm"),
              0u);
    EXPECT_EQ(refused(folder, "sensor_width_mm = 30\n"), "");
}

TEST(CheckCommand, EveryTurnOfALensThatTheFormatAllowsIsMade) {
    const TemporaryFolder folder;
    for (const char* turn : {"-36000", "3601", "36000"}) {
        EXPECT_EQ(refused(folder, "aperture = \"iris\"\nmask_px = 64\nradius_px = 4\n",
                          {"optics.rotation_deg=" + std::string(turn)}),
                  "");
    }
}

TEST(CheckCommand, PatternsOutOfReachAreToldWhereTheLensIs) {
    const TemporaryFolder folder;
    const std::string text = refused(folder, "radius_px = 4096\nf_number = 16\n");
    EXPECT_EQ(
        text.find("limit: " + (folder.path / "a.toml").string() + ":7:2: the lens's pattern needs 3.46e+12 "),
        0u)
        << text;
}

TEST(CheckCommand, TellsWhatFilesHoldThatThePictureWillNot) {
    TemporaryFolder folder;
    folder.write("a.mtl", "newmtl x\nd 0.2\n");
    folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
    folder.write("empty.obj", "# nothing\n");
    folder.write("lost.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl (null)\nf 1 2 3\n");
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
mesh = [{id = "a", file = "a.obj"}, {id = "a2", file = "a.obj"}, {id = "e", file = "empty.obj"},
        {id = "far", shape = "box", size_m = 0.1, translate_m = [5e6, 0, 5e6]},
        {id = "lost", file = "lost.obj"}]
)");
    CheckOptions options{folder.path / "s.toml", {}, {}};
    EXPECT_THROW(check_report(options), InputError);
    options.allow_missing = true;
    const std::string report = check_report(options);
    const std::string root = folder.path.string();
    for (const std::string& line :
         {"note      " + root + "/a.mtl: 'x' is transparent in the file; drawn opaque\n",
          "note      " + root + "/empty.obj: has no triangles\n",
          "note      " + root + "/lost.obj:4: material '(null)' is not defined in any mtllib\n",
          std::string("note      mesh 'far': single precision has steps of 0.5 m where it stands: 12 of 12 "
                      "triangles collapse, 0 more have edges of a few steps")}) {
        const std::size_t at = report.find(line);
        EXPECT_NE(at, std::string::npos) << line << "\nis not in\n" << report;
        EXPECT_EQ(report.find(line, at + 1), std::string::npos) << "twice: " << line;
    }
}

TEST(CheckCommand, TexturesWithoutCoordinatesToShowThemAreTold) {
    TemporaryFolder folder;
    const Image<Rgb8> white(2, 2, {255, 255, 255});
    folder.write("t.png", encode_png(white.view()));
    folder.write("a.mtl", "newmtl x\nmap_Kd t.png\nnewmtl y\nmap_Kd t.png\n");
    const std::string begin = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    folder.write("none.obj", begin + "usemtl x\nf 1 2 3\nf 2 4 3\n");
    folder.write("some.obj",
                 begin + "vt 0 0\nusemtl x\nf 1/1 2/1 3/1\nf 2 4/1 3/1\nusemtl y\nf 1/1 2/1 3/1\n");
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
mesh = [{id = "none", file = "none.obj"}, {id = "some", file = "some.obj"}, {id = "box", shape = "box", material = "m"},
        {id = "own", file = "none.obj", material = "m"}, {id = "plain", file = "none.obj", material = "p"}]
material = {m = {texture = "t.png"}, p = {}}
)");
    const auto count = [](const std::string& text, const std::string& part) {
        int n = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
            ++n;
        return n;
    };
    const std::string report = check_report({folder.path / "s.toml", {}, {}});
    for (const char* note :
         {"note      mesh 'none': texture t.png of material 'none/x' does not show on 2 of its 2 "
          "triangles: no texture coordinates (vt)\n",
          "note      mesh 'some': texture t.png of material 'some/x' does not show on 1 of its 2 "
          "triangles: no texture coordinates (vt)\n",
          "note      mesh 'own': texture t.png of material 'm' does not show on 2 of its 2 "
          "triangles: no texture coordinates (vt)\n"})
        EXPECT_EQ(count(report, note), 1) << note << "\nis not in\n" << report;
    EXPECT_EQ(count(report, "does not show"), 3) << report;

    std::ostringstream info;
    InfoOptions options;
    options.file = folder.path / "some.obj";
    EXPECT_EQ(info_command(options, info), 0);
    EXPECT_EQ(
        count(info.str(), "some.obj: texture t.png of material 'x' does not show on 1 of its 2 triangles"), 1)
        << info.str();
    EXPECT_EQ(count(info.str(), "does not show"), 1);
}

TEST(CheckCommand, SurveyedMeshesArePlacedBeforeTheyAreRounded) {
    TemporaryFolder folder;
    folder.write("far.obj", "v 500000 0 5400000.3\nv 500000 0 5400000.5\nv 500000 1 5400000.3\nf 1 2 3\n");
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
mesh = [{id = "m", file = "far.obj", translate_m = [-500000, 0, -5400000]}]
)");
    EXPECT_EQ(check_report({folder.path / "s.toml", {}, {}}).find("note      mesh"), std::string::npos);
    const std::string left = check_report({folder.path / "s.toml", {"mesh.m.translate_m=[0,0,0]"}, {}});
    EXPECT_NE(left.find("where it stands: 1 of 1 triangles collapse"), std::string::npos) << left;
}

}  // namespace
}  // namespace obscura
