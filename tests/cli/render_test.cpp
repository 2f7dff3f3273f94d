// obscura render from outside: outputs, frames, crops, overrides, reports.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "app/frame/shadow_text.h"
#include "core/image_io.h"
#include "core/isa.h"
#include "tests/cli/scene_folder.h"
#include "tests/report/json_reader.h"

namespace obscura::test {
namespace {

TEST(Render, WithoutFlagsThePictureIsNamedAfterTheScene) {
    const SceneFolder folder;
    const Outcome run = run_in(folder, {"render", "s.toml"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(folder.listing(), (Names{"s.png", "s.toml"}));
    const Image<Rgba8> picture = png(folder / "s.png");
    EXPECT_EQ(picture.width, 64);
    EXPECT_EQ(picture.height, 48);
    EXPECT_NE(picture(32, 24), picture(0, 0)) << "nothing is to be seen";
}

TEST(Render, TerrainIsSeenInItsMaterial) {
    const Folder folder;
    folder.write("t.asc", "ncols 3\nnrows 3\ncellsize 10\n1 2 1\n2 6 2\n1 2 1\n");
    folder.write(
        "s.toml",
        "format = 1\n[camera]\neye_m = [0, 40, 30]\nlook_at_m = [0, 3, 0]\n[[terrain]]\nid = \"t\"\n"
        "file = \"t.asc\"\nmaterial = \"red\"\nskirt_m = 2\ntranslate_m = [0, 1, 0]\n"
        "[material.red]\nbase_color = [0.8, 0.02, 0.02]\n[[light]]\nid = \"l\"\n"
        "type = \"directional\"\nazimuth_deg = 120\nelevation_deg = 50\n[render]\nsize_px = [32, 24]\n");
    const Outcome run = run_in(folder, {"render", "s.toml", "-q"});
    ASSERT_EQ(run.code, 0) << run.err;
    const Rgba8 middle = png(folder / "s.png")(16, 12);
    EXPECT_GT(middle.r, 2 * middle.g);
    EXPECT_GT(middle.r, 2 * middle.b);
    EXPECT_NE(run_in(folder, {"render", "s.toml", "-q", "--overwrite", "-D", "limits.triangles=31"})
                  .err.find("brings the scene to 32 triangles"),
              std::string::npos);
}

TEST(Render, ExistingFilesAreKeptUnlessToldOtherwise) {
    const SceneFolder folder;
    folder.write("s.png", "mine");
    const Outcome refused = run_in(folder, {"render", "s.toml"});
    EXPECT_EQ(refused.code, 5);
    EXPECT_EQ(refused.err, "obscura: error: s.png: already exists (--overwrite replaces it)\n");
    EXPECT_EQ(file_text(folder / "s.png"), "mine");
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "--overwrite"}).code, 0);
    EXPECT_EQ(png(folder / "s.png").width, 64);
}

TEST(Render, SameBytesForEveryThreadCountAndInstructionSet) {
    const SceneFolder folder;
    ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q"}).code, 0);
    const std::string expected = file_text(folder / "s.png");
    ASSERT_FALSE(expected.empty());
    for (const Isa isa : supported_isas()) {
        for (const char* threads : {"0", "1", "2", "3", "7"}) {
            const std::string name(isa_name(isa));
            ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q", "-o", "t.png", "--overwrite", "--isa", name,
                                      "-t", threads})
                          .code,
                      0);
            EXPECT_TRUE(file_text(folder / "t.png") == expected) << name << ", " << threads << " threads";
        }
    }
}

TEST(Render, ACropIsThatPartOfTheWholePicture) {
    const SceneFolder folder;
    ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q", "-o", "a.pfm", "--aov", "depth"}).code, 0);
    ASSERT_EQ(
        run_in(folder, {"render", "s.toml", "-q", "-o", "c.pfm", "--aov", "depth", "--crop", "17,9,50,41"})
            .code,
        0);
    const Image<Vec3f> whole = pfm<Vec3f>(folder / "a.pfm"), part = pfm<Vec3f>(folder / "c.pfm");
    const Image<float> depth = pfm<float>(folder / "a.depth.pfm"),
                       part_depth = pfm<float>(folder / "c.depth.pfm");
    ASSERT_EQ(part.width, 33);
    ASSERT_EQ(part.height, 32);
    int differences = 0;
    for (int y = 0; y < part.height; ++y) {
        for (int x = 0; x < part.width; ++x) {
            if (part(x, y) != whole(x + 17, y + 9)) ++differences;
            if (part_depth(x, y) != depth(x + 17, y + 9)) ++differences;
        }
    }
    EXPECT_EQ(differences, 0);
}

TEST(Render, SizeSamplesAndDefinesChangeThePicture) {
    const SceneFolder folder;
    const auto bytes = [&](const std::string& name, std::vector<std::string> flags) {
        Names line{"render", "s.toml", "-q", "-o", name};
        line.insert(line.end(), flags.begin(), flags.end());
        const Outcome run = run_in(folder, line);
        EXPECT_EQ(run.code, 0) << run.err;
        return file_text(folder / name);
    };
    const std::string plain = bytes("a.png", {});
    EXPECT_NE(bytes("b.png", {"--samples", "1"}), plain);
    EXPECT_EQ(bytes("c.png", {"--samples", "4"}), plain);
    EXPECT_NE(bytes("d.png", {"-D", "camera.vfov_deg=50"}), plain);
    EXPECT_NE(bytes("e.png", {"-D", "material.stone.base_color=[1,0,0]", "-D", "light.lamp.azimuth_deg=10"}),
              plain);
    bytes("f.png", {"--size", "80x020"});
    EXPECT_EQ(png(folder / "f.png").width, 80);
    EXPECT_EQ(png(folder / "f.png").height, 20);
}

TEST(Render, FramesFillTheHashes) {
    const SceneFolder folder(
        "[frames]\nrange = \"1-9x2\"\n[[frames.camera]]\nframe = 1\nvfov_deg = 30\n"
        "[[frames.camera]]\nframe = 9\nvfov_deg = 50\n");
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "-o", "f_###.png", "--frames", "9,1-5x4,5"}).code, 0);
    EXPECT_EQ(folder.listing(), (Names{"f_001.png", "f_005.png", "f_009.png", "s.toml"}));
    EXPECT_NE(file_text(folder / "f_001.png"), file_text(folder / "f_009.png"));
    // A frame is the same whether it comes alone or after others.
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "-o", "alone.png", "--frames", "9"}).code, 0);
    EXPECT_EQ(file_text(folder / "alone.png"), file_text(folder / "f_009.png"));

    const Outcome outside = run_in(folder, {"render", "s.toml", "-o", "x###.png", "--frames", "8-12"});
    EXPECT_EQ(outside.code, 2);
    EXPECT_EQ(outside.err, "obscura: error: --frames: frame 12 is not one of the scene's frames (1-9x2)\n");
    const Outcome unnumbered = run_in(folder, {"render", "s.toml", "-o", "x.png"});
    EXPECT_EQ(unnumbered.code, 2);
    EXPECT_EQ(unnumbered.err,
              "obscura: error: 'x.png': several frames need #### in the name, for the frame number\n");
    EXPECT_EQ(folder.listing().size(), 5u);
}

TEST(Render, HashesOfFoldersAndOfSingleFramesStay) {
    const SceneFolder folder("");
    std::filesystem::create_directory(folder / "job ##12");
    std::filesystem::rename(folder / "s.toml", folder / "take ##3.toml");
    EXPECT_EQ(run_in(folder, {"render", "take ##3.toml"}).code, 0);
    EXPECT_EQ(run_in(folder, {"render", "take ##3.toml", "-o", "job ##12/a#.png", "--aov", "depth"}).code, 0);
    EXPECT_EQ(run_in(folder, {"render", "take ##3.toml", "-o", "a#_##.png"}).code, 0);
    for (const char* file : {"take ##3.png", "job ##12/a#.png", "job ##12/a#.depth.pfm", "a#_01.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;

    const std::vector<std::string> two{"render", "take ##3.toml", "-D", "frames.range=\"1-2\""};
    const auto also = [&](std::vector<std::string> more) {
        more.insert(more.begin(), two.begin(), two.end());
        return run_in(folder, more);
    };
    EXPECT_EQ(also({}).code, 0);
    EXPECT_EQ(also({"-o", "job ##12/b#.png", "--frames", "2"}).code, 0);
    for (const char* file : {"take ##3.0001.png", "take ##3.0002.png", "job ##12/b2.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
    const Outcome folders = also({"-o", "job ##12/c.png"});
    EXPECT_EQ(folders.code, 2);
    EXPECT_NE(folders.err.find("need #### in the name"), std::string::npos) << folders.err;
}

TEST(Render, TheScenesOutputListIsWritten) {
    const SceneFolder folder(
        "[[output]]\nfile = \"look.png\"\n[[output]]\naov = \"normal\"\nfile = \"n.pfm\"\n");
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "-q"}).code, 0);
    EXPECT_EQ(folder.listing(), (Names{"look.png", "n.pfm", "s.toml"}));
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "-q", "-o", "only.png"}).code, 0);
    EXPECT_EQ(folder.listing(), (Names{"look.png", "n.pfm", "only.png", "s.toml"}));
}

TEST(Render, ChannelsHaveTheirMeaning) {
    const SceneFolder folder;
    const std::string all = "depth,normal,albedo,object,shadow";
    ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q", "--aov", all}).code, 0);
    const Outcome mapped =
        run_in(folder, {"render", "s.toml", "-o", "m.png", "--aov", all, "--aov-format", "png"});
    ASSERT_EQ(mapped.code, 0) << mapped.err;
    EXPECT_NE(mapped.err.find("m.depth.png (0 = "), std::string::npos) << mapped.err;

    // The middle of the picture is the box, its corner the sky.
    const Image<float> depth = pfm<float>(folder / "s.depth.pfm"),
                       object = pfm<float>(folder / "s.object.pfm");
    EXPECT_NEAR(depth(32, 32), 7.1, 0.2);
    EXPECT_TRUE(std::isinf(depth(0, 0)));
    EXPECT_EQ(object(32, 24), 0.0f);
    EXPECT_EQ(object(0, 0), -1.0f);
    const Vec3f normal = pfm<Vec3f>(folder / "s.normal.pfm")(32, 32);
    EXPECT_NEAR(normal.z, 1.0, 1e-6);
    EXPECT_EQ(png(folder / "m.normal.png")(32, 32), (Rgba8{128, 128, 255, 255}));
    EXPECT_EQ(png(folder / "m.normal.png")(0, 0), (Rgba8{128, 128, 128, 255}));
    EXPECT_EQ(png(folder / "m.depth.png")(0, 0).r, 255);
    EXPECT_LT(png(folder / "m.depth.png")(32, 32).r, 64);
    EXPECT_EQ(png(folder / "m.object.png")(0, 0), (Rgba8{0, 0, 0, 255}));
    EXPECT_NE(png(folder / "m.object.png")(32, 24), (Rgba8{0, 0, 0, 255}));
    EXPECT_EQ(png(folder / "m.shadow.png")(0, 0).r, 255);
    const Vec3f albedo = pfm<Vec3f>(folder / "s.albedo.pfm")(32, 24);
    EXPECT_GT(albedo.x, albedo.z);
}

/// Glare, lights with a size, stacks and trees, textures.
TEST(Render, IsExpectedToTakeWhatCheckSays) {
    const SceneFolder folder;
    for (const char* name :
         {"box_on_plane", "glare_post", "soft_stack", "spot", "stereo_pair", "textured_quad", "two_lights"}) {
        const std::string scene = std::string(OBSCURA_SOURCE_DIR "/scenes/tests/") + name + ".toml";
        const Outcome checked = run_in(folder, {"check", scene});
        const Outcome rendered =
            run_in(folder, {"render", scene, "-q", "--overwrite", "-o", "p.png", "--stats-json", "p.json"});
        ASSERT_TRUE(checked.code == 0 && rendered.code == 0) << checked.err << rendered.err;
        const Json memory = parse_json(file_text(folder / "p.json")).at("memory");
        const auto bytes = static_cast<std::int64_t>(memory.at("estimate_bytes").number);
        EXPECT_NE(checked.out.find("memory    about " + size_text(bytes) + " of "), std::string::npos)
            << name << ": " << bytes << '\n'
            << checked.out;
        // And both refuse less than that.
        const std::string limit = "limits.memory_mib=" + std::to_string(bytes >> 20);
        const Outcome refused = run_in(folder, {"check", scene, "-D", limit});
        const Outcome not_rendered = run_in(folder, {"render", scene, "-o", "no.png", "-D", limit});
        EXPECT_EQ(refused.code, 4) << name;
        EXPECT_EQ(not_rendered.code, 4) << name;
        EXPECT_EQ(refused.err, not_rendered.err);
        EXPECT_EQ(refused.out.find("ok"), std::string::npos) << refused.out;
    }
}

TEST(Render, StatisticsAreJsonWithTheStatedMembers) {
    const SceneFolder folder;
    ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q", "--stats-json", "s.json", "--isa", "ref", "-t", "2",
                              "--aov", "depth"})
                  .code,
              0);
    const Json stats = parse_json(file_text(folder / "s.json"));
    EXPECT_EQ(stats.at("schema").number, 1);
    EXPECT_EQ(stats.at("scene").text, "s.toml");
    EXPECT_EQ(stats.at("isa").text, "ref");
    EXPECT_EQ(stats.at("threads").number, 2);
    EXPECT_EQ(stats.at("width_px").number, 64);
    EXPECT_GT(stats.at("total_s").number, 0);
    EXPECT_GT(stats.at("memory").at("estimate_bytes").number, 0);
    EXPECT_GT(stats.at("memory").at("peak_resident_bytes").number, 1e6);
    const Json& frame = stats.at("frames").list.at(0);
    EXPECT_EQ(frame.at("frame").number, 1);
    EXPECT_GT(frame.at("seconds").at("render").number, 0);
    EXPECT_EQ(frame.at("counts").at("triangles").number, 12);
    const Json& lamp = frame.at("lights").list.at(0);
    EXPECT_EQ(lamp.at("light").text, "lamp");
    EXPECT_EQ(lamp.at("method").text, "compressed");
    EXPECT_EQ(lamp.at("scope").text, "frame");
    EXPECT_EQ(lamp.at("resolution").number, 256);
    for (const char* member : {"nodes_leaf", "bytes", "nodes_visited", "texels_rasterized", "list_operations",
                               "build_s", "lookup_s", "needed"}) {
        EXPECT_GT(lamp.at(member).number, 0) << member;
    }
    for (const char* member : {"nodes_full", "nodes_empty", "certified_cover", "certified_mesh", "encode_s"})
        EXPECT_GE(lamp.at(member).number, 0) << member;
    ASSERT_EQ(frame.at("files").list.size(), 2u);
    EXPECT_EQ(frame.at("files").list[1].at("file").text, "s.depth.pfm");
    EXPECT_EQ(frame.at("files").list[0].at("bytes").number,
              static_cast<double>(file_text(folder / "s.png").size()));
}

TEST(Render, MessagesFitTheirListener) {
    const SceneFolder folder;
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "-q"}).err, "");
    const std::string lines = run_in(folder, {"render", "s.toml", "-o", "b.png", "--size", "640x480"}).err;
    EXPECT_EQ(lines.find('\x1b'), std::string::npos) << "control sequences in a file";
    EXPECT_EQ(lines.find('\r'), std::string::npos);
    EXPECT_NE(lines.find("100 %"), std::string::npos) << lines;
    EXPECT_NE(lines.find("b.png"), std::string::npos) << lines;
    const std::string verbose = run_in(folder, {"render", "s.toml", "-v", "-o", "c.png"}).err;
    for (const char* words : {"shadow maps", "light lamp: 256 x 256, what the frame looks up", "nodes_full ",
                              "texels_rasterized ", "lookups ", "MiB at most so far"}) {
        EXPECT_NE(verbose.find(words), std::string::npos) << words << " is not in\n" << verbose;
    }
    const std::string fitted =
        run_in(folder, {"render", "s.toml", "-v", "-o", "d.png", "-D", "shadow.lamp.resolution=auto"}).err;
    EXPECT_NE(fitted.find("(auto: a texel spans 0."), std::string::npos) << fitted;
}

TEST(Render, WhatIsLikelyAMistakeIsNoted) {
    const SceneFolder folder(
        "[[light]]\nid = \"sun\"\ntype = \"sun\"\nlatitude_deg = 48\nlongitude_deg = 16\n"
        "time = 2026-06-21T01:00:00+02:00\n");
    const Outcome night = run_in(folder, {"render", "s.toml"});
    EXPECT_EQ(night.code, 0);
    EXPECT_NE(night.err.find("note: light 'sun' is below the horizon in frame 1"), std::string::npos)
        << night.err;
    EXPECT_EQ(night.err.find("no mesh"), std::string::npos) << night.err;

    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    folder.write("e.toml",
                 "format = 1\n[camera]\neye_m = [0, 2, 8]\nlook_at_m = [0, 1, 0]\n[render]\nsize_px = "
                 "[8, 8]\n[[mesh]]\nid = \"m\"\nfile = \"flat.obj\"\n");
    const Outcome empty = run_in(folder, {"render", "e.toml"});
    EXPECT_EQ(empty.code, 0) << empty.err;
    EXPECT_NE(empty.err.find("note: no mesh has a triangle with an area"), std::string::npos) << empty.err;
    EXPECT_EQ(run_in(folder, {"render", "e.toml", "--overwrite", "-q"}).err, "");
}

TEST(Check, TellsHowFineTheMapOfAParallelLightIs) {
    const SceneFolder folder;
    const Outcome run = run_in(
        folder, {"check", "s.toml", "-D", "light.lamp.azimuth_deg=0", "-D", "light.lamp.elevation_deg=0"});
    // 2 m over 256 texels, one of them margin at each side.
    EXPECT_NE(run.out.find("256 x 256, texels of 7.87 mm"), std::string::npos) << run.out << run.err;
}

TEST(Render, TerminalsSeeOneLineThatRenewsItself) {
    const SceneFolder folder;
    const auto said = [&](std::vector<std::string> more) {
        std::vector<std::string> line{"render", "s.toml", "--overwrite", "--size", "640x480"};
        line.insert(line.end(), more.begin(), more.end());
        Program program(line);
        program.folder = folder.path;
        program.err_on_terminal = true;
        program.environment = {"TERM=xterm"};
        return program.run().err;
    };
    const std::string live = said({});
    EXPECT_EQ(live.find("\rframe 1 (1 of 1): "), 0u) << live;
    EXPECT_NE(live.find("\r\x1b[Kframe 1 in "), std::string::npos) << live;
    EXPECT_EQ(std::count(live.begin(), live.end(), '\n'), 1) << live;
    EXPECT_EQ(said({"-q"}), "");
}

TEST(Render, TerminalsWithoutEscapeSequencesSeeLines) {
    const SceneFolder folder;
    for (const char* term : {"TERM=dumb", "TERM=", "TERM=unknown"}) {
        Program program({"render", "s.toml", "--overwrite"});
        program.folder = folder.path;
        program.err_on_terminal = true;
        program.environment = {term};
        const std::string said = program.run().err;
        EXPECT_EQ(said.find('\x1b'), std::string::npos) << term << said;
        EXPECT_NE(said.find("frame 1 (1 of 1): 100 %"), std::string::npos) << term << said;
    }
}

TEST(Render, APixelIsExplainedAndNothingWritten) {
    const SceneFolder folder;
    folder.write("s.png", "mine");
    const Outcome run = run_in(folder, {"render", "s.toml", "--pixel", "32,32"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(folder.listing(), (Names{"s.png", "s.toml"}));
    // The codes it ends with are those of the picture.
    ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q", "-o", "p.png"}).code, 0);
    const Rgba8 p = png(folder / "p.png")(32, 32);
    const std::string codes =
        "sRGB " + std::to_string(p.r) + " " + std::to_string(p.g) + " " + std::to_string(p.b) + "\n";
    EXPECT_NE(run.out.find(codes), std::string::npos) << codes << " in\n" << run.out;
    EXPECT_NE(run.out.find("triangle"), std::string::npos) << run.out;
    // So are they for every instruction set.
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "--pixel", "32,32", "--isa", "ref", "-t", "1"}).out,
              run.out);
}

TEST(Render, MistakesAreToldBeforeTheWork) {
    const SceneFolder folder;
    std::filesystem::create_directory(folder / "dir.png");
    const std::string set = isa_supported(Isa::avx512bw) ? "neon" : "avx512bw";
    struct Case {
        Names flags;
        int code;
        std::string message;
    };
    for (const Case& c : std::vector<Case>{
             {{"-o", "none/x.png"}, 5, "none/x.png: cannot be created in 'none': No such file or directory"},
             {{"-o", "dir.png"}, 5, "dir.png: is a directory"},
             {{"--stats-json", "none/s.json"}, 5, "none/s.json: cannot be created in 'none'"},
             {{"-o", "x.jpg"}, 2, "'x.jpg': pictures end in .png (8-bit sRGB) or .pfm (linear float)"},
             {{"--isa", set}, 2, "--isa: "},
             {{"--crop", "0,0,65,48"}, 2, "--crop: '0,0,65,48' is not a rectangle"},
             {{"--crop", "-1,0,5,5"}, 2, "--crop: '-1,0,5,5' is not a rectangle"},
             {{"--pixel", "64,0"}, 2, "--pixel: '64,0' is not inside the 64 x 48 picture"},
             {{"--aov", "dept"}, 2, "--aov: 'dept' is not one of"},
             {{"--aov", "sun_hours"}, 2, "--aov sun_hours: the scene has no light of type \"sun\""},
             {{"--aov-format", "tiff"}, 2, "--aov-format: 'tiff' is not png or pfm"},
             {{"-t", "-1"}, 2, "--threads: '-1' is not a whole number"},
             {{"-D", "camera.vfov=3"}, 3, "-D camera.vfov=3: "},
             {{"-D", "camera"}, 3, "-D camera: "},
             {{"--limit-memory", "1", "--size", "999x999"}, 4, "s.toml: needs about "}}) {
        Names line{"render", "s.toml"};
        line.insert(line.end(), c.flags.begin(), c.flags.end());
        const Outcome run = run_in(folder, line);
        EXPECT_EQ(run.code, c.code) << c.message << "\n" << run.err;
        EXPECT_TRUE(run.err.starts_with("obscura: error: " + c.message))
            << run.err << "instead of " << c.message;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
    EXPECT_EQ(folder.listing(), (Names{"dir.png", "s.toml"}));
}

}  // namespace
}  // namespace obscura::test
