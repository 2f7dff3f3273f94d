// `obscura new`: scenes to begin with.

#include "app/cli/new_command.h"

#include <gtest/gtest.h>

#include <sstream>

#include "core/error.h"
#include "core/image_io.h"
#include "tests/cli/program.h"

namespace obscura {
namespace {

using test::file_text;
using test::Folder;
using test::Outcome;

class NewCommand : public ::testing::TestWithParam<const char*> {};

/// What is written is the file that the project shows, and it renders by the command that is told.
TEST_P(NewCommand, WritesASceneThatRenders) {
    const std::string kind = GetParam();
    const Folder folder;
    const Outcome made = test::run_in(folder, {"new", "--kind", kind, "my scene"});
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(made.out, "");
    EXPECT_EQ(file_text(folder / "my scene.toml"),
              file_text(std::string(OBSCURA_SOURCE_DIR "/scenes/starters/") + kind + ".toml"));
    const std::string command = kind == "stereo" ? "stereo" : "render";
    EXPECT_EQ(made.err, "written: my scene.toml\nrender it: obscura " + command +
                            " 'my scene.toml' -o 'my scene.png'\n");
    std::vector<std::string> words = {command, "my scene.toml",          "-o", "my scene.png",
                                      "-D",    "render.size_px=[64,36]", "-D", "render.samples=1",
                                      "-D",    "sky.occlusion=false"};
    if (kind == "object" || kind == "stereo")
        words.insert(words.end(), {"-D", "light.lamp.shadow.samples=4"});
    if (kind == "night") words.insert(words.end(), {"-D", "light.lantern.shadow.samples=4"});
    if (kind == "night") words.insert(words.end(), {"-D", "optics.radius_px=16"});
    const Outcome rendered = test::run_in(folder, words);
    EXPECT_EQ(rendered.code, 0) << rendered.err;
    EXPECT_EQ(decode_png(file_text(folder / "my scene.png"), "picture").height, 36);
}

INSTANTIATE_TEST_SUITE_P(Kinds, NewCommand, ::testing::Values("place", "object", "night", "stereo"));

TEST(NewCommand, KindsAreThoseOfTheTest) {
    ASSERT_EQ(starters().size(), 4u);
    for (const Starter& s : starters())
        EXPECT_EQ(s.stereo, std::string(s.name) == "stereo");
}

TEST(NewCommand, TheReadmeShowsThePlace) {
    std::string shown, line;
    std::istringstream text(starters()[0].text);
    while (std::getline(text, line))
        shown += line.empty() ? "\n" : "    " + line + "\n";
    EXPECT_NE(file_text(OBSCURA_SOURCE_DIR "/README.md").find(shown), std::string::npos);
}

TEST(NewCommand, KeepsWhatIsThere) {
    const Folder folder;
    folder.write("a.toml", "mine");
    EXPECT_EQ(test::run_in(folder, {"new", "a.toml"}).code, 5);
    EXPECT_EQ(file_text(folder / "a.toml"), "mine");
    EXPECT_EQ(test::run_in(folder, {"new", "--overwrite", "a.toml"}).code, 0);
    EXPECT_EQ(file_text(folder / "a.toml"), starters()[0].text);
    EXPECT_EQ(test::run_in(folder, {"new", "no/folder/a"}).code, 5);
}

TEST(NewCommand, UnknownKindsAreRefused) {
    const Folder folder;
    const Outcome wrong = test::run_in(folder, {"new", "a", "--kind", "nigth"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_EQ(
        wrong.err,
        "obscura: error: --kind 'nigth' is none of place, object, night, stereo; did you mean 'night'?\n");
    EXPECT_EQ(test::run_in(folder, {"new"}).code, 2);
    EXPECT_EQ(test::run_in(folder, {"new", "sub/"}).code, 2);
    EXPECT_TRUE(folder.listing().empty());
    EXPECT_EQ(test::run_in(folder, {"new", "a.png"}).code, 0);
    EXPECT_EQ(folder.listing(), std::vector<std::string>{"a.png.toml"});
}

}  // namespace
}  // namespace obscura
