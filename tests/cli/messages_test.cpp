// Words that nobody can read cost no result: standard error that is full, closed or a pipe without a reader.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/cli/scene_folder.h"

namespace obscura::test {
namespace {

/// A scene with a note of its own: its sun is below the horizon.
struct NightFolder : Folder {
    NightFolder() {
        std::string text = small_scene;
        text.replace(text.find("elevation_deg = 30"), 18, "elevation_deg = -5");
        write("night.toml", text + "[frames]\nrange = \"1-2\"\n");
    }
};

const std::vector<Names> lines = {
    {"render", "night.toml", "-o", "r#.png"},
    {"render", "night.toml", "-v", "-v", "-o", "v#.png"},
    {"render", "night.toml", "--frames", "1", "-o", "one.png"},
    {"stereo", "night.toml", "-v", "-o", "s#.png"},
    {"diffraction", "box", "--mask-size", "16", "--size", "16", "--near", "1e9", "-o", "d.png"},
    {"diffraction", "box", "--mask-size", "16", "--size", "16", "--stats-json", "-", "-o", "j.png"},
};
const Names pictures = {"d.png",  "j.png",  "night.toml", "one.png", "r1.png",
                        "r2.png", "s1.png", "s2.png",     "v1.png",  "v2.png"};

/// Runs every line, standard error as `prepare` has it.
template <class Prepare>
void expect_all_written(Prepare&& prepare) {
    const NightFolder folder;
    for (const Names& line : lines) {
        Program program(line);
        program.folder = folder.path;
        prepare(program);
        EXPECT_EQ(program.run().code, 0) << line[0] << ' ' << line.back();
    }
    EXPECT_EQ(folder.listing(), pictures);
}

TEST(Messages, OnAFullDiskCostNoPicture) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    expect_all_written([](Program& program) { program.err_target = "/dev/full"; });
}

TEST(Messages, ToAReaderThatWentAwayCostNoPicture) {
    expect_all_written([](Program& program) { program.err_broken_pipe = true; });
}

TEST(Messages, WithoutAStandardErrorCostNoPicture) {
    expect_all_written([](Program& program) { program.err_closed = true; });
}

TEST(Messages, ErrorsKeepTheirCodeWhenTheyCannotBeTold) {
    const NightFolder folder;
    for (const auto& [line, code] :
         std::vector<std::pair<Names, int>>{{{"paint"}, 2},
                                            {{"check", "none.toml"}, 3},
                                            {{"render", "night.toml", "-o", "none/#.png"}, 5}}) {
        Program program(line);
        program.folder = folder.path;
        program.err_broken_pipe = true;
        EXPECT_EQ(program.run().code, code) << line[0];
    }
}

TEST(Messages, LostWordsOnStandardOutputAreToldWhenAllFilesAreThere) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const Folder folder;
    Program full({"diffraction", "box", "--mask-size", "16", "--size", "16", "-o", "a.png", "-o", "a.pfm"});
    full.folder = folder.path;
    full.out_target = "/dev/full";
    const Outcome run = full.run();
    EXPECT_EQ(run.code, 5);
    EXPECT_EQ(run.err, "obscura: error: standard output: cannot be written\n");
    Program broken({"diffraction", "box", "--mask-size", "16", "--size", "16", "-o", "b.png", "-o", "b.pfm"});
    broken.folder = folder.path;
    broken.out_broken_pipe = true;
    EXPECT_EQ(broken.run().code, 128 + SIGPIPE);
    EXPECT_EQ(folder.listing(), (Names{"a.pfm", "a.png", "b.pfm", "b.png"}));
}

}  // namespace
}  // namespace obscura::test
