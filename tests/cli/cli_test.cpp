// The program from outside: commands, help, flags, messages and exit codes.

#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace obscura::test {
namespace {

/// Commands as the program itself lists them.
std::vector<std::string> listed_commands() {
    const std::string help = Program({"--help"}).run().out;
    std::vector<std::string> names;
    const std::regex row("\n  ([a-z]+) +[A-Z]");
    for (std::sregex_iterator at(help.begin(), help.end(), row), end; at != end; ++at)
        names.push_back((*at)[1]);
    return names;
}

TEST(Cli, AloneItPrintsShortHelpAndExitsTwo) {
    const Outcome run = Program({}).run();
    EXPECT_EQ(run.code, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find("Usage: obscura COMMAND"), std::string::npos);
}

TEST(Cli, VersionNamesCompilerInstructionSetsAndLibraries) {
    const Outcome run = Program({"version"}).run();
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(run.err, "");
    for (const char* part : {"obscura 0.", "built with", "ref sse2", "(chosen: ", "threads", "TBB 20",
                             "xsimd ", "fmt ", "toml++ ", "tinyobjloader ", "CLI11 ", "stb_image v"}) {
        EXPECT_NE(run.out.find(part), std::string::npos) << part << "\n" << run.out;
    }
    EXPECT_EQ(Program({"--version"}).run().out, run.out);
}

TEST(Cli, EveryCommandHasHelpWithUsage) {
    const auto commands = listed_commands();
    for (const char* expected : {"render", "check", "dump", "info", "diff", "diffraction", "stereo",
                                 "terrain", "bench", "lesson", "version"})
        EXPECT_NE(std::find(commands.begin(), commands.end(), expected), commands.end()) << expected;
    for (const std::string& command : commands) {
        const Outcome run = Program({command, "--help"}).run();
        EXPECT_EQ(run.code, 0) << command;
        EXPECT_NE(run.out.find("Usage: obscura " + command), std::string::npos) << command;
        EXPECT_EQ(run.err, "") << command;
        for (std::size_t at = 0; at < run.out.size();) {
            const std::size_t end = std::min(run.out.find('\n', at), run.out.size());
            EXPECT_LE(end - at, 100u) << command << ": " << run.out.substr(at, end - at);
            at = end + 1;
        }
    }
}

/// A value that is right for what stands behind a flag in the help; nothing for a switch.
std::string plausible_value(const std::string& kind) {
    const std::vector<std::pair<std::string, std::string>> values = {{"KEY=VALUE", "render.samples=1"},
                                                                     {"WxH", "8x8"},
                                                                     {"DIR", "."},
                                                                     {"FILE", "x.png"},
                                                                     {"MIB", "64"},
                                                                     {"DIFF", "0.5"},
                                                                     {"ISA", "ref"},
                                                                     {"RANGE", "1"},
                                                                     {"X0,Y0,X1,Y1", "0,0,4,4"},
                                                                     {"X,Y", "1,1"},
                                                                     {"NAMES", "depth,normal"},
                                                                     {"KIND", "png"},
                                                                     {"LIST", "1"},
                                                                     {"TEXT", "a"},
                                                                     {"NAME", "accuracy"},
                                                                     {"MM", "4"},
                                                                     {"UM", "5"},
                                                                     {"NM", "500"},
                                                                     {"DEG", "10"},
                                                                     {"SHARE", "0.5"},
                                                                     {"RATIO", "2"},
                                                                     {"LIGHT", "d65"},
                                                                     {"X", "2"},
                                                                     {"U,V", "1,2"},
                                                                     {"METHOD", "runs"},
                                                                     {"MODE", "exact"},
                                                                     {"LAYOUT", "anaglyph"},
                                                                     {"VARIANTS", "warp"},
                                                                     {"PREFIX", "map"},
                                                                     {"ID", "ground"},
                                                                     {"LINES", "4"},
                                                                     {"SAMPLES", "64"},
                                                                     {"SOLVER", "fmg"},
                                                                     {"DECADES", "5"},
                                                                     {"K", "0.13"},
                                                                     {"HH:MM", "07:30"},
                                                                     {"I/N", "1/2"},
                                                                     {"N", "1"}};
    for (const auto& [name, value] : values) {
        if (name == kind) return value;
    }
    ADD_FAILURE() << "no value for " << kind;
    return "";
}

TEST(Cli, EveryFlagInTheHelpIsParsed) {
    int flags = 0;
    for (const std::string& command : listed_commands()) {
        const std::string help = Program({command, "--help"}).run().out;
        const std::regex row("\n  (?:(-[A-Za-z]), |    )(--[a-z-]+)(?: ([^ \n]+))?(?=  |\n)");
        for (std::sregex_iterator at(help.begin(), help.end(), row), end; at != end; ++at) {
            if ((*at)[2] == "--help") continue;
            for (const std::string& name : {at->str(1), at->str(2)}) {
                if (name.empty()) continue;
                ++flags;
                std::vector<std::string> line{command, name};
                if ((*at)[3].matched) line.push_back(plausible_value((*at)[3]));
                // A second unknown flag is the first thing to be reported when this one is understood.
                line.push_back("--no-such-flag");
                const Outcome run = Program(line).run();
                EXPECT_EQ(run.code, 2) << command << " " << name;
                EXPECT_NE(run.err.find("unknown flag '--no-such-flag'"), std::string::npos)
                    << command << " " << name << ": " << run.err;
            }
        }
    }
    EXPECT_GT(flags, 10);
}

struct Mistake {
    std::vector<std::string> line;
    int code;
    std::string
        message;  ///< all of standard error behind "obscura: error: "; "..." at the end: its beginning
};

bool says(const std::string& err, const std::string& message) {
    const std::string expected = "obscura: error: " + message;
    if (!message.ends_with("...")) return err == expected + "\n";
    return err.starts_with(expected.substr(0, expected.size() - 3)) && err.ends_with("\n");
}

TEST(Cli, MistakesHaveTheirCodesAndMessages) {
    const Folder folder;
    folder.write("s.toml", small_scene);
    folder.write("empty.toml", "");
    folder.write("typo.toml", std::string(small_scene) + "sampels = 4\n");
    const std::vector<Mistake> mistakes = {
        {{"chekc", "s.toml"}, 2, "unknown command 'chekc'; did you mean 'check'? (see 'obscura --help')"},
        {{"paint"}, 2, "unknown command 'paint' (see 'obscura --help')"},
        {{"check"}, 2, "SCENE is missing (see 'obscura check --help')"},
        {{"check", "s.toml", "t.toml"}, 2, "unexpected argument 't.toml' (see 'obscura check --help')"},
        {{"check", "--sampels", "4", "s.toml"},
         2,
         "unknown flag '--sampels'; did you mean '--samples'? (see 'obscura check --help')"},
        {{"check", "s.toml", "--samples"}, 2, "--samples: 1 required N missing (see 'obscura check --help')"},
        {{"check", "s.toml", "--samples", "2"}, 2, "--samples: '2' is not 1, 4 or 16"},
        {{"check", "s.toml", "--samples=x"}, 2, "--samples: 'x' is not a whole number from 1 to 16"},
        {{"check", "s.toml", "--size", "64"}, 2, "--size: '64' is not a size in pixels like 960x540"},
        {{"dump"}, 2, "SCENE is missing (see 'obscura dump --help')"},
        {{"info"}, 2, "FILE is missing (see 'obscura info --help')"},
        {{"diff", "a.png"}, 2, "B is missing (see 'obscura diff --help')"},
        {{"bench", "rater"},
         2,
         "there is no bench 'rater'; did you mean 'raster'? (see 'obscura bench --help')"},
        {{"lesson"}, 2, "NUMBER is missing (see 'obscura lesson --help')"},
        {{"lesson", "0"}, 2, "NUMBER: '0' is not a whole number from 1 to ..."},
        {{"lesson", "1", "-o", "x.pfm"}, 2, "'x.pfm': lessons end in .png"},
        {{"lesson", "1", "-o", "none/x.png"}, 5, "none/x.png: cannot be created in 'none': ..."},
        {{"version", "--loud"}, 2, "unknown flag '--loud' (see 'obscura version --help')"},
        {{"render", "s.toml", "-o", ""}, 2, "--output is empty (see 'obscura render --help')"},
        {{"render", "s.toml", "--stats-json", ""}, 2, "--stats-json is empty (see 'obscura render --help')"},
        {{"stereo", "s.toml", "--maps", ""}, 2, "--maps is empty (see 'obscura stereo --help')"},
        {{"check", "s.toml", "--allow-path", ""}, 2, "--allow-path is empty (see 'obscura check --help')"},
        {{"check", "s.toml", "--allow-path", "none"}, 2, "--allow-path: 'none' is no folder"},
        {{"info", "s.toml", "--allow-path", "s.toml"}, 2, "--allow-path: 's.toml' is no folder"},
        {{"check", ""}, 2, "SCENE is empty (see 'obscura check --help')"},
        {{"diff", "a.png", "b.png", "-o", "d8.txt"}, 2, "'d8.txt': pictures end in ..."},
        {{"diff", "a.png", "b.png", "-o", "d.pfm"}, 2, "'d.pfm': pictures of differences end in .png"},
        {{"check", "none.toml"}, 3, "none.toml: cannot open: No such file or directory"},
        {{"check", "."}, 3, ".: not a regular file, but a folder"},
        {{"check", "empty.toml"}, 3, "empty.toml: ..."},
        {{"check", "typo.toml"},
         3,
         "typo.toml:22:1: unknown key 'sampels' in [render]; did you mean 'samples'?"},
        {{"check", "s.toml", "--limit-memory", "1", "--size", "4000x4000"}, 4, "s.toml: needs about ..."},
    };
    for (const Mistake& m : mistakes) {
        const Outcome run = run_in(folder, m.line);
        EXPECT_EQ(run.code, m.code) << m.message;
        EXPECT_TRUE(says(run.err, m.message)) << run.err << "instead of " << m.message;
        EXPECT_EQ(run.out, "") << m.message;
    }
}

TEST(Cli, LeadingZerosAreDecimal) {
    const Folder folder;
    folder.write("s.toml", small_scene);
    const Outcome run = run_in(folder, {"check", "s.toml", "--size", "010x0020"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.out.find("10 x 20 pixels"), std::string::npos) << run.out;
}

TEST(Cli, FlagsWinOverDefinesAndDefinesOverTheScene) {
    const Folder folder;
    folder.write("s.toml", small_scene);
    EXPECT_NE(run_in(folder, {"check", "s.toml", "-D", "camera.vfov_deg=50"}).out.find("50 degrees"),
              std::string::npos);
    EXPECT_NE(run_in(folder, {"check", "-D", "render.samples=4", "--samples", "16", "s.toml"})
                  .out.find("16 samples"),
              std::string::npos);
    // One value per -D: the next word is the scene.
    EXPECT_EQ(run_in(folder, {"check", "-D", "camera.vfov_deg=50", "s.toml"}).code, 0);
}

TEST(Cli, FilesThatLookLikeFlagsFollowTwoDashes) {
    const Folder folder;
    folder.write("--s.toml", small_scene);
    EXPECT_EQ(run_in(folder, {"check", "--", "--s.toml"}).code, 0);
}

TEST(Cli, DumpedScenesReadBack) {
    const Folder folder;
    folder.write("s.toml", small_scene);
    const Outcome first = run_in(folder, {"dump", "s.toml"});
    ASSERT_EQ(first.code, 0) << first.err;
    folder.write("t.toml", first.out);
    EXPECT_EQ(run_in(folder, {"dump", "t.toml"}).out, first.out);
}

TEST(Cli, OnlyTerminalsSeeColourAndOnlyIfWanted) {
    const auto error = [](std::vector<std::string> environment) {
        Program program({"paint"});
        program.err_on_terminal = true;
        program.environment = std::move(environment);
        return program.run().err;
    };
    const std::string plain = "obscura: error: unknown command 'paint' (see 'obscura --help')\r\n";
    EXPECT_EQ(error({"TERM=xterm", "NO_COLOR="}).find("obscura: \x1b[1;31merror:\x1b[0m unknown"), 0u);
    EXPECT_EQ(error({"TERM=xterm", "NO_COLOR=1"}), plain);
    EXPECT_EQ(error({"TERM=dumb", "NO_COLOR="}), plain);
}

TEST(Cli, ClosedPipesEndQuietly) {
    Program program({"dump", "--format"});
    program.out_broken_pipe = true;
    const Outcome run = program.run();
    EXPECT_EQ(run.code, 128 + SIGPIPE);
    EXPECT_EQ(run.err, "");
}

/// A copy of the program alone in a folder of its own.
Program lonely(const Folder& folder, std::vector<std::string> arguments, const std::string& path) {
    const std::filesystem::path copy = folder / "obscura";
    if (!std::filesystem::exists(copy)) std::filesystem::copy_file(OBSCURA_BINARY, copy);
    return Program(std::move(arguments), copy.string(), {"PATH=" + path});
}

TEST(Cli, NeighboursAreFoundBesideTheProgramAndOnPath) {
    const Folder folder;
    const std::filesystem::path home = std::filesystem::path(OBSCURA_BINARY).parent_path();
    const std::string help = Program({"lesson", "--help"}).run().out;
    ASSERT_NE(help, "");

    const Outcome on_path = lonely(folder, {"lesson", "--help"}, home.string()).run();
    EXPECT_EQ(on_path.code, 0) << on_path.err;
    EXPECT_EQ(on_path.out, help);

    // A link to the program is the program: what counts is beside the file behind it.
    std::filesystem::create_symlink(OBSCURA_BINARY, folder / "link");
    const Outcome linked = Program({"lesson", "--help"}, (folder / "link").string(), {"PATH="}).run();
    EXPECT_EQ(linked.code, 0) << linked.err;
    EXPECT_EQ(linked.out, help);
}

TEST(Cli, AbsentNeighboursAreMistakesThatSayHowToBuildThem) {
    const Folder folder;
    for (const std::string command : {"bench", "lesson"}) {
        const Outcome run = lonely(folder, {command, "--help"}, folder.path.string()).run();
        EXPECT_EQ(run.code, 2) << command;
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(run.err,
                  "obscura: error: 'obscura " + command + "' is a program of its own, obscura-" + command +
                      ", which cannot be started from the folder of this one or from PATH: No such file "
                      "or directory; in the source folder './obscura " +
                      command + "' builds it\n");
    }
}

TEST(Cli, LessonsAreDrawnAndListed) {
    const Folder folder;
    EXPECT_NE(run_in(folder, {"lesson", "--help"}).out.find("\n  2  "), std::string::npos);
    const Outcome run = run_in(folder, {"lesson", "2", "-o", "l.png"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.out, "l.png\n");
    EXPECT_EQ(file_text(folder / "l.png").substr(1, 3), "PNG");
    EXPECT_EQ(run_in(folder, {"lesson", "2", "-o", "l.png"}).code, 5);
}

TEST(Cli, ClosedStandardOutputIsNoError) {
    Program program({"dump", "--format"});
    program.out_closed = true;
    const Outcome run = program.run();
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(run.err, "");
}

TEST(Cli, FullDevicesAreOutputErrors) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    for (const std::vector<std::string>& line :
         {std::vector<std::string>{"version"}, {"dump", "--format"}, {"check", "--help"}, {"--help"}}) {
        Program program(line);
        program.out_target = "/dev/full";
        const Outcome run = program.run();
        EXPECT_EQ(run.code, 5) << line[0];
        EXPECT_EQ(run.err, "obscura: error: standard output: cannot be written\n");
    }
}

}  // namespace
}  // namespace obscura::test
