// obscura stereo from outside: layouts, files, exit codes, what is said, mistakes.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/scene_folder.h"

namespace obscura::test {
namespace {

const std::string edits = R"([stereo]
interaxial_m = 0.2
zero_parallax_m = 7
[[stereo.edit]]
id = "round"
type = "roundness"
objects = ["cube"]
roundness = 2
)";

bool same(const Image<Rgba8>& a, const Image<Rgba8>& b) {
    return a.width == b.width && a.height == b.height && a.pixels == b.pixels;
}

class StereoCli : public testing::Test {
  protected:
    void SetUp() override { folder.write("s.toml", std::string(small_scene) + edits); }
    Outcome run(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "stereo");
        return run_in(folder, std::move(arguments));
    }
    Folder folder;
};

TEST_F(StereoCli, EveryLayoutHasItsSize) {
    const std::vector<std::pair<std::string, std::pair<int, int>>> layouts = {{"side-by-side", {128, 48}},
                                                                              {"half-side-by-side", {64, 48}},
                                                                              {"cross-eye", {128, 48}},
                                                                              {"over-under", {64, 96}},
                                                                              {"half-over-under", {64, 48}},
                                                                              {"anaglyph", {64, 48}},
                                                                              {"anaglyph-half", {64, 48}},
                                                                              {"anaglyph-dubois", {64, 48}},
                                                                              {"interlaced", {64, 48}},
                                                                              {"left", {64, 48}},
                                                                              {"right", {64, 48}}};
    const Outcome help = run({"--help"});
    for (const auto& [layout, size] : layouts) {
        EXPECT_NE(help.out.find(layout), std::string::npos) << layout;
        const Outcome made = run({"s.toml", "-q", "--layout", layout, "-o", layout + ".png"});
        ASSERT_EQ(made.code, 0) << made.err;
        EXPECT_EQ(made.err + made.out, "") << layout;
        const Image<Rgba8> picture = png(folder / (layout + ".png"));
        EXPECT_EQ(picture.width, size.first) << layout;
        EXPECT_EQ(picture.height, size.second) << layout;
    }
    const Image<Rgba8> both = png(folder / "side-by-side.png"), crossed = png(folder / "cross-eye.png");
    const Image<Rgba8> left = png(folder / "left.png"), right = png(folder / "right.png");
    EXPECT_FALSE(same(left, right));
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            ASSERT_EQ(both(x, y), left(x, y));
            ASSERT_EQ(both(x + 64, y), right(x, y));
            ASSERT_EQ(crossed(x, y), right(x, y));
        }
    }
    const Outcome two = run({"s.toml", "-q", "--layout", "separate", "-o", "two.png"});
    ASSERT_EQ(two.code, 0) << two.err;
    EXPECT_TRUE(same(png(folder / "two.left.png"), left));
    EXPECT_TRUE(same(png(folder / "two.right.png"), right));
    EXPECT_FALSE(std::filesystem::exists(folder / "two.png"));
}

TEST_F(StereoCli, EyesChangeOverWhereALayoutShowsBoth) {
    const auto picture = [&](const std::string& layout, const Names& more = {}) {
        Names line{"s.toml", "-q", "--overwrite", "--layout", layout, "-o", "p.png"};
        line.insert(line.end(), more.begin(), more.end());
        const Outcome made = run(line);
        EXPECT_EQ(made.code, 0) << made.err;
        return png(folder / "p.png");
    };
    const Names swap{"--swap-eyes"};
    EXPECT_TRUE(same(picture("side-by-side", swap), picture("cross-eye")));
    EXPECT_TRUE(same(picture("cross-eye", swap), picture("side-by-side")));
    const Image<Rgba8> left = picture("left"), right = picture("right"), plain = picture("interlaced"),
                       swapped = picture("interlaced", {"--swap-eyes", "--stats-json", "p.json"});
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            ASSERT_EQ(plain(x, y), (y % 2 == 0 ? left : right)(x, y));
            ASSERT_EQ(swapped(x, y), (y % 2 == 0 ? right : left)(x, y));
        }
    }
    EXPECT_NE(file_text(folder / "p.json").find("\"swapped_eyes\": true"), std::string::npos);
    for (const std::string layout : {"left", "right", "separate"}) {
        const Outcome refused = run({"s.toml", "--layout", layout, "-o", "q.png", "--swap-eyes"});
        EXPECT_EQ(refused.code, 2);
        EXPECT_EQ(refused.err, "obscura: error: --swap-eyes: layout '" + layout + "' names its eyes\n");
    }
}

TEST_F(StereoCli, ThreadsAndInstructionsGiveTheSameBytes) {
    ASSERT_EQ(run({"s.toml", "-q", "-o", "a.png", "--maps", "a", "--threads", "1", "--isa", "ref"}).code, 0);
    ASSERT_EQ(run({"s.toml", "-q", "-o", "b.png", "--maps", "b", "--threads", "3"}).code, 0);
    EXPECT_EQ(file_text(folder / "a.png"), file_text(folder / "b.png"));
    EXPECT_EQ(file_text(folder / "a.after.pfm"), file_text(folder / "b.after.pfm"));
}

TEST_F(StereoCli, MapsAreWhatTheyAreCalled) {
    const Outcome made = run({"s.toml", "-o", "a.png", "--maps", "m"});
    ASSERT_EQ(made.code, 0) << made.err;
    const std::vector<std::string> expected = {
        "a.png",           "m.after.pfm",          "m.after.png", "m.before.pfm", "m.before.png",
        "m.conflicts.png", "m.left.occlusion.png", "m.left.pfm",  "m.left.png",   "m.right.occlusion.png",
        "m.right.pfm",     "m.right.png",          "m.scale.png", "s.toml"};
    EXPECT_EQ(folder.listing(), expected);
    const Image<float> before = pfm(folder / "m.before.pfm"), after = pfm(folder / "m.after.pfm");
    EXPECT_GT(before.width, 64) << "with margins";
    EXPECT_EQ(before.height, 48);
    // f = 24 / tan(17.5 degrees) = 76.12 px, the screen is at 7 m. Nothing is seen in the corner, as if at
    // infinity; in the middle there is the cube's top, 8.06 m away.
    EXPECT_NEAR(before(0, 0), -76.12 * 0.2 / 7, 0.001);
    EXPECT_NEAR(before(before.width / 2, 24), 76.12 * 0.2 * (1 / 8.06 - 1 / 7.0), 0.15);
    EXPECT_EQ(after(0, 0), before(0, 0));
    EXPECT_NE(after.pixels, before.pixels);
    EXPECT_EQ(pfm(folder / "m.left.pfm").width, 64);
    EXPECT_EQ(png(folder / "m.conflicts.png").width, 64);
    EXPECT_EQ(png(folder / "m.after.png").width, before.width);
}

TEST_F(StereoCli, ComparisonsAreLabelledByTheirNames) {
    const Outcome made =
        run({"s.toml", "-q", "-o", "a.png", "--layout", "left", "--compare", "warp,remap,unedited"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Image<Rgba8> edited = png(folder / "a.png");
    for (const char* name : {"a.warp.png", "a.remap.png", "a.unedited.png"}) {
        EXPECT_EQ(png(folder / name).width, 64) << name;
        EXPECT_FALSE(same(png(folder / name), edited)) << name;
    }
    // Without edits the pair is the unedited one.
    ASSERT_EQ(run({"s.toml", "-q", "-o", "b.png", "--layout", "left", "-D", "stereo.edit.round.weight=0",
                   "-D", "stereo.window_weight=0"})
                  .code,
              0);
    EXPECT_TRUE(same(png(folder / "a.unedited.png"), png(folder / "b.png")));
}

TEST_F(StereoCli, ScenesWithoutStereoHaveDefaults) {
    folder.write("plain.toml", small_scene);
    const Outcome made = run({"plain.toml"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("the screen stands where the camera looks, at 8.062 m"), std::string::npos)
        << made.err;
    EXPECT_EQ(png(folder / "plain.stereo.png").width, 128);
}

TEST_F(StereoCli, PreviewsAreSmall) {
    ASSERT_EQ(run({"s.toml", "-q", "--preview", "-o", "p.png"}).code, 0);
    EXPECT_EQ(png(folder / "p.png").width, 32);
    EXPECT_EQ(png(folder / "p.png").height, 12);
}

TEST_F(StereoCli, FramesHaveTheirNumbers) {
    folder.write("f.toml", std::string(small_scene) + edits +
                               "[frames]\nrange = \"1-3\"\n[[frames.stereo]]\nframe = 1\ninteraxial_m = 0.1\n"
                               "[[frames.stereo]]\nframe = 3\ninteraxial_m = 0.3\n");
    const Outcome nameless = run({"f.toml", "-o", "a.png"});
    EXPECT_EQ(nameless.code, 2);
    EXPECT_NE(nameless.err.find("several frames need ####"), std::string::npos) << nameless.err;
    ASSERT_EQ(run({"f.toml", "-q", "--frames", "1,3", "-o", "a##.png", "--stats-json", "s.json"}).code, 0);
    EXPECT_FALSE(same(png(folder / "a01.png"), png(folder / "a03.png")));
    EXPECT_FALSE(std::filesystem::exists(folder / "a02.png"));
}

TEST_F(StereoCli, EveryFrameHasItsReport) {
    folder.write("f.toml", std::string(small_scene) + "[frames]\nrange = \"1-3\"\n");
    const Outcome nameless = run({"f.toml", "-q", "-o", "a#.png", "--report", "all.html"});
    EXPECT_EQ(nameless.code, 2);
    EXPECT_NE(nameless.err.find("several frames need ####"), std::string::npos) << nameless.err;
    ASSERT_EQ(run({"f.toml", "-q", "-o", "a#.png", "--frames", "2-3", "--report", "r#.html"}).code, 0);
    EXPECT_NE(file_text(folder / "r2.html").find("frame 2"), std::string::npos);
    EXPECT_NE(file_text(folder / "r3.html").find("frame 3"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "r1.html"));
}

TEST_F(StereoCli, StatisticsHoldWhatWasDone) {
    const Outcome made =
        run({"s.toml", "-v", "-o", "a.png", "--stats-json", "s.json", "--map-scale", "2", "--solver", "fmg"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("solved at 1:2 by fmg"), std::string::npos) << made.err;
    const std::string json = file_text(folder / "s.json");
    for (const char* part : {"\"schema\": 1", "\"method\": \"fmg\"", "\"map_scale\": 2", "\"realised\"",
                             "\"triangles_out\"", "\"conflicts\"", "\"file\": \"a.png\""})
        EXPECT_NE(json.find(part), std::string::npos) << part << "\n" << json;
}

TEST_F(StereoCli, ContradictionsAreNamed) {
    const std::string two =
        "[[stereo.edit]]\nid = \"forward\"\ntype = \"anchor\"\nobjects = [\"cube\"]\noffset_px = 3\n"
        "[[stereo.edit]]\nid = \"back\"\ntype = \"anchor\"\nobjects = [\"cube\"]\noffset_px = -3\n";
    folder.write("two.toml", std::string(small_scene) + edits + two);
    const Outcome made = run({"two.toml", "-o", "a.png"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("edit 'forward' is not satisfied"), std::string::npos) << made.err;
    EXPECT_NE(made.err.find("pulls edit 'back'"), std::string::npos) << made.err;
}

TEST_F(StereoCli, CheckTellsOfTheEyesAndTheEdits) {
    const Outcome checked = run_in(folder, {"check", "s.toml"});
    ASSERT_EQ(checked.code, 0) << checked.err;
    EXPECT_NE(checked.out.find("eyes 200 mm apart, screen at 7 m; what is far away has -2.175 px"),
              std::string::npos)
        << checked.out;
    EXPECT_NE(checked.out.find("edit      round: roundness, weight 1"), std::string::npos) << checked.out;
}

struct Mistake {
    std::vector<std::string> line;
    int code;
    std::string part;
};

TEST_F(StereoCli, MistakesAreRefusedBeforeAnyWork) {
    folder.write("ortho.toml",
                 "format = 1\n[camera]\neye_m = [0, 0, 5]\nlook_at_m = [0, 0, 0]\nprojection = "
                 "\"orthographic\"\nheight_m = 2\n");
    folder.write("slot.toml", std::string(small_scene) +
                                  "[stereo]\n[[stereo.edit]]\nid = \"e\"\n"
                                  "type = \"anchor\"\nmaterials = [\"cube/lid\"]\n");
    folder.write("there.png", "");
    folder.write("there.html", "");
    const std::vector<Mistake> mistakes = {
        {{}, 2, "SCENE is missing"},
        {{"s.toml", "--layout", "anaglyf"}, 2, "there is no layout 'anaglyf'; did you mean 'anaglyph'?"},
        {{"s.toml", "--solver", "multigird"}, 2, "there is no solver 'multigird'; did you mean 'multigrid'?"},
        {{"s.toml", "--map-scale", "3"}, 2, "--map-scale: '3' is not 1, 2, 4 or 8"},
        {{"s.toml", "--compare", "warp,edited"}, 2, "'edited' is not warp, remap or unedited"},
        {{"s.toml", "-o", "a.pfm"}, 2, "'a.pfm': stereo pictures end in .png"},
        {{"s.toml", "-o", "a.png", "--maps", "a", "--frames", "2"}, 2, "--frames"},
        {{"s.toml", "-o", "m.after.png", "--maps", "m"}, 2, "two pictures would go to this file"},
        {{"none.toml"}, 3, "none.toml: cannot open"},
        {{"ortho.toml"}, 3, "parallel views have no disparity"},
        {{"slot.toml"}, 3, "there is no material 'cube/lid'"},
        {{"s.toml", "--size", "4000x4000", "--limit-memory", "64"}, 4, "needs about"},
        {{"s.toml", "-o", "there.png"}, 5, "there.png"},
        {{"s.toml", "-o", "none/a.png"}, 5, "none/a.png"},
        {{"s.toml", "-o", "a.png", "--maps", "none/m"}, 5, "none/m.before.pfm"},
        {{"s.toml", "-o", "a.png", "--report", "a.txt"}, 2, "'a.txt': reports end in .html"},
        {{"s.toml", "-o", "a.png", "--report", "none/a.html"}, 5, "none/a.html"},
        {{"s.toml", "-o", "a.png", "--report", "there.html"}, 5, "there.html"},
    };
    const std::vector<std::string> before = folder.listing();
    for (const Mistake& m : mistakes) {
        const Outcome made = run(m.line);
        EXPECT_EQ(made.code, m.code) << made.err;
        EXPECT_NE(made.err.find(m.part), std::string::npos) << made.err << "instead of " << m.part;
        EXPECT_EQ(made.out, "");
    }
    EXPECT_EQ(folder.listing(), before);
}

}  // namespace
}  // namespace obscura::test
