// What a run must not write over: files that it reads, results of its own, standard output with statistics.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/scene_folder.h"
#include "tests/report/json_reader.h"

namespace obscura::test {
namespace {

/// A scene that reads a texture, a mesh with its materials, a lens's mask and an edit's, and keeps a map.
struct ReadingScene : Folder {
    ReadingScene() {
        const Image<Rgb8> white(64, 48, {255, 255, 255});
        for (const char* name : {"house.png", "wood.png", "lens.png", "edit.png"})
            write(name, encode_png(white.view()));
        write("roof.mtl", "newmtl wood\nmap_Kd wood.png\n");
        write("roof.obj", "mtllib roof.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl wood\nf 1/1 2/1 3/1\n");
        std::string text = small_scene;
        text.replace(text.find("base_color"), 0, "texture = \"house.png\"\n");
        text.replace(text.find("resolution"), 0, "scope = \"full\"\ncache = \"maps\"\n");
        write("house.toml", text + R"([[mesh]]
id = "roof"
shape = "file"
file = "roof.obj"
[optics]
aperture = "file"
file = "lens.png"
radius_px = 4
[stereo]
zero_parallax_m = 7
[[stereo.edit]]
id = "held"
type = "interface"
objects = ["cube"]
second_objects = ["roof"]
mask = "edit.png"
)");
    }
    std::string bytes() const {
        std::string all;
        for (const std::string& name : listing())
            if (std::filesystem::is_regular_file(path / name)) all += name + file_text(path / name);
        return all;
    }
};

const Names read_by_render = {"house.toml", "house.png", "wood.png", "lens.png",
                              "roof.mtl",   "roof.obj",  "edit.png"};

void expect_refused(const ReadingScene& folder, const Names& line, const std::string& file) {
    const std::string before = folder.bytes();
    const Outcome run = run_in(folder, line);
    EXPECT_EQ(run.code, 5) << file << '\n' << run.err;
    EXPECT_EQ(run.err, "obscura: error: " + file + ": is read by this run and is not replaced\n");
    EXPECT_TRUE(folder.bytes() == before) << file;
}

TEST(Targets, RenderReplacesNothingThatItReads) {
    const ReadingScene folder;
    expect_refused(folder, {"render", "house.toml", "--overwrite"}, "house.png");
    for (const std::string& file : read_by_render)
        expect_refused(folder, {"render", "house.toml", "-o", "x.png", "--overwrite", "--stats-json", file},
                       file);
    expect_refused(folder, {"render", "house.toml", "-o", "wood.png", "--overwrite"}, "wood.png");
    // So does what the scene names and this command does not read, under any name.
    std::filesystem::create_symlink("edit.png", folder / "e.png");
    expect_refused(folder, {"render", "house.toml", "-o", "e.png", "--overwrite"}, "e.png");
    expect_refused(folder,
                   {"render", "house.toml", "-D", "material.unused.texture=\"maps.pfm\"", "-o", "maps.pfm",
                    "--overwrite"},
                   "maps.pfm");
    // Channels are files, too.
    std::filesystem::rename(folder / "house.png", folder / "a.depth.png");
    expect_refused(folder,
                   {"render", "house.toml", "-D", "material.stone.texture=\"a.depth.png\"", "-o", "a.png",
                    "--aov", "depth", "--aov-format", "png", "--overwrite"},
                   "a.depth.png");
}

TEST(Targets, OtherNamesOfAFileAreThatFile) {
    const ReadingScene folder;
    std::filesystem::create_symlink("house.png", folder / "soft.png");
    std::filesystem::create_hard_link(folder / "house.png", folder / "hard.png");
    std::filesystem::create_directory(folder / "sub");
    for (const std::string name : {"soft.png", "hard.png", "./house.png", "sub/../house.png"})
        expect_refused(folder, {"render", "house.toml", "-o", name, "--overwrite"}, name);
    const std::string whole = (folder / "house.png").string();
    expect_refused(folder, {"render", "house.toml", "-o", whole, "--overwrite"}, whole);
}

TEST(Targets, MapsThatAreKeptAreReadAndWrittenByTheRun) {
    const ReadingScene folder;
    const std::string map = "maps/lamp.shadowtree";
    const Names line{"render", "house.toml", "-q", "-o", "x.png", "--overwrite", "--stats-json", map};
    std::filesystem::create_directory(folder / "maps");
    expect_refused(folder, line, map);  // not there yet
    ASSERT_EQ(run_in(folder, {"render", "house.toml", "-q", "-o", "x.png"}).code, 0);
    expect_refused(folder, line, map);
}

TEST(Targets, StereoReplacesNothingThatItReads) {
    const ReadingScene folder;
    const Names begin{"stereo", "house.toml", "--overwrite"};
    for (const std::string file : {"house.png", "lens.png", "edit.png"}) {
        Names line = begin;
        line.insert(line.end(), {"-o", file});
        expect_refused(folder, line, file);
    }
    folder.write("report.html", file_text(folder / "house.toml"));
    expect_refused(folder, {"stereo", "report.html", "-o", "p.png", "--report", "report.html", "--overwrite"},
                   "report.html");
    std::filesystem::rename(folder / "house.png", folder / "m.scale.png");
    expect_refused(folder,
                   {"stereo", "house.toml", "-D", "material.stone.texture=\"m.scale.png\"", "-o", "p.png",
                    "--maps", "m", "--overwrite"},
                   "m.scale.png");
}

TEST(Targets, DiffractionAndDiffReplaceNothingThatTheyRead) {
    const ReadingScene folder;
    folder.write("m.re.pfm", file_text(folder / "lens.png"));
    folder.write("b.png", file_text(folder / "lens.png"));
    expect_refused(folder, {"diffraction", "lens.png", "-o", "lens.png", "--overwrite"}, "lens.png");
    expect_refused(folder,
                   {"diffraction", "lens.png", "-o", "x.png", "--overwrite", "--stats-json", "lens.png"},
                   "lens.png");
    expect_refused(folder, {"diffraction", "m.re.pfm", "-o", "m.pfm", "--amplitude", "--overwrite"},
                   "m.re.pfm");
    for (const std::string file : {"lens.png", "b.png"})
        expect_refused(folder, {"diff", "lens.png", "b.png", "-o", file, "--overwrite"}, file);
}

TEST(Targets, TwoResultsGoToTwoFiles) {
    const ReadingScene folder;
    std::filesystem::create_symlink("x.png", folder / "link.json");
    for (const std::string stats : {"x.png", "./x.png", "link.json"}) {
        for (const char* command : {"render", "stereo"}) {
            const Outcome run =
                run_in(folder, {command, "house.toml", "-o", "x.png", "--overwrite", "--stats-json", stats});
            EXPECT_EQ(run.code, 2) << run.err;
            EXPECT_EQ(run.err, "obscura: error: '" + stats + "' would be written twice\n");
        }
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST(Targets, StatisticsGoToStandardOutputAlone) {
    const ReadingScene folder;
    const Outcome render = run_in(folder, {"render", "house.toml", "-v", "-o", "r.png", "--stats-json", "-"});
    ASSERT_EQ(render.code, 0) << render.err;
    EXPECT_EQ(parse_json(render.out).at("frames").list.at(0).at("files").list.at(0).at("file").text, "r.png");
    const Outcome stereo = run_in(folder, {"stereo", "house.toml", "-v", "-o", "s.png", "--stats-json", "-"});
    ASSERT_EQ(stereo.code, 0) << stereo.err;
    EXPECT_EQ(parse_json(stereo.out).at("layout").text, "side-by-side");
    const Outcome light = run_in(folder, {"diffraction", "box", "--mask-size", "16", "--size", "16", "-o",
                                          "d.png", "--stats-json", "-"});
    ASSERT_EQ(light.code, 0) << light.err;
    EXPECT_EQ(parse_json(light.out).at("aperture").text, "box");
    EXPECT_NE(light.err.find("method    "), std::string::npos) << "the plan is told elsewhere";
    EXPECT_FALSE(std::filesystem::exists(folder / "-"));
}

TEST(Targets, StatisticsOnStandardOutputTolerateNothingBeside) {
    const ReadingScene folder;
    for (const auto& [line, message] : std::vector<std::pair<Names, std::string>>{
             {{"render", "house.toml", "--pixel", "1,1"},
              "--pixel prints to standard output and has no statistics"},
             {{"diffraction", "box", "--plan"}, "--plan prints to standard output and has no statistics"},
             {{"render", "house.toml", "-o", "out.png", "--overwrite"}, "'out.png' is standard output, too"},
             {{"stereo", "house.toml", "-o", "out.png", "--overwrite"}, "'out.png' is standard output, too"},
             {{"diffraction", "box", "-o", "out.png", "--overwrite"}, "'out.png' is standard output, too"}}) {
        Names with = line;
        with.insert(with.end(), {"--stats-json", "-"});
        Program program(with);
        program.folder = folder.path;
        program.out_target = "out.png";
        const Outcome run = program.run();
        EXPECT_EQ(run.code, 2) << message;
        EXPECT_EQ(run.err, "obscura: error: --stats-json -: " + message + "\n");
    }
}

}  // namespace
}  // namespace obscura::test
