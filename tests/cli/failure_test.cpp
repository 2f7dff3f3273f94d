// obscura render when something fails from outside: read-only folders, full disks, little memory, signals,
// rivals.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/scene_folder.h"

namespace obscura::test {
namespace {

TEST(Render, ReadOnlyFoldersAreRefusedBeforeTheWork) {
    const SceneFolder folder;
    // /proc refuses new files to everyone; a folder of one's own to all but root.
    const Outcome refused = run_in(folder, {"render", "s.toml", "-o", "/proc/x.png"});
    EXPECT_EQ(refused.code, 5) << refused.err;
    if (::geteuid() == 0) return;
    std::filesystem::create_directory(folder / "ro");
    std::filesystem::permissions(folder / "ro",
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    const Outcome run = run_in(folder, {"render", "s.toml", "-o", "ro/x.png"});
    EXPECT_EQ(run.code, 5) << run.err;
    std::filesystem::permissions(folder / "ro", std::filesystem::perms::owner_all);
}

TEST(Render, AFullDiskIsAnOutputError) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const SceneFolder folder;
    std::filesystem::create_symlink("/dev/full", folder / "x.png");
    const Outcome run = run_in(folder, {"render", "s.toml", "-q", "-o", "x.png"});
    EXPECT_EQ(run.code, 5);
    EXPECT_EQ(run.err, "obscura: error: x.png: cannot be written: No space left on device\n");
    EXPECT_EQ(folder.listing(), (Names{"s.toml", "x.png"}));
}

TEST(Render, TooLittleMemoryIsALimit) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers reserve more than any limit";
#endif
    const SceneFolder folder;
    Program program({"render", "s.toml", "--size", "4000x3000", "--samples", "1", "-q"});
    program.folder = folder.path;
    program.memory_bytes = rlim_t{160} << 20;
    const Outcome run = program.run();
    EXPECT_EQ(run.code, 4) << run.err;
    EXPECT_TRUE(run.err.starts_with("obscura: error: out of memory")) << run.err;
    EXPECT_EQ(folder.listing(), (Names{"s.toml"}));
}

/// Long enough to be interrupted on any machine: it is stopped at its first sign of life.
Names long_render(const std::string& output) {
    return {"render", "s.toml",         "--size", "4000x3000", "--samples", "16", "--isa",
            "ref",    "--limit-memory", "100000", "-t",        "1",         "-o", output};
}

/// Waits for the first line of progress. False when the program ended before.
bool wait_for_progress(const Program& program) {
    while (program.running()) {
        if (program.err_so_far().find('%') != std::string::npos) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

TEST(Render, SignalsLeaveNoFile) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGUSR1, SIGALRM, SIGRTMIN}) {
        const SceneFolder folder;
        Program program(long_render("x.png"));
        program.folder = folder.path;
        program.start();
        EXPECT_TRUE(wait_for_progress(program));
        program.send(signal);
        const Outcome run = program.wait();
        EXPECT_EQ(run.code, 128 + signal) << run.err;
        EXPECT_EQ(run.err.find("error"), std::string::npos) << run.err;
        EXPECT_EQ(folder.listing(), (Names{"s.toml"}));
    }
}

bool has_temporary(const Folder& folder) {
    const Names names = folder.listing();
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name.find(".part.") != std::string::npos; });
}

/// Sends `signal` while a file is being written; the exit code. 0: it was ready before.
int end_while_writing(const Folder& folder, int signal) {
    Program program({"render", "s.toml", "--size", "2000x1500", "--samples", "1", "-q", "-o", "x.pfm",
                     "--aov", "normal,albedo", "--overwrite"});
    program.folder = folder.path;
    program.start();
    while (program.running() && !has_temporary(folder)) {
    }
    program.send(signal);
    return program.wait().code;
}

TEST(Render, SignalsWhileAFileIsWrittenLeaveNoTemporary) {
    // Faults keep what they are: the process is killed by its signal.
    for (const auto& [signal, expected] : std::vector<std::pair<int, int>>{{SIGHUP, 128 + SIGHUP},
                                                                           {SIGQUIT, 128 + SIGQUIT},
                                                                           {SIGXCPU, 128 + SIGXCPU},
                                                                           {SIGUSR2, 128 + SIGUSR2},
                                                                           {SIGABRT, 1000 + SIGABRT},
                                                                           {SIGSEGV, 1000 + SIGSEGV}}) {
        const SceneFolder folder;
        int code = 0;
        for (int tries = 0; code == 0 && tries < 5; ++tries)
            code = end_while_writing(folder, signal);
        EXPECT_EQ(code, expected);
        EXPECT_FALSE(has_temporary(folder)) << signal;
    }
}

/// Whether it ends by itself; else it is killed.
bool ends(const Program& program) {
    for (int i = 0; i < 2000; ++i) {
        if (!program.running()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    program.send(SIGKILL);
    return false;
}

/// A run that comes to a pipe once `written` is there, and waits: until somebody reads it, or for ever.
struct WaitingRun {
    Names line;
    const char* pipe;
    const char* written;
    bool opened;  ///< for reading, and not read: more is written than it holds
    int signal;
};

TEST(Render, SignalsEndRunsThatWaitForAReader) {
    const Names depth{"render", "s.toml", "-o", "x.pfm", "--aov", "depth", "--size", "400x300", "-q"};
    const auto with_statistics = [](const char* command) {
        return Names{command, "s.toml", "-o", "x.png", "--stats-json", "x.json", "-q"};
    };
    for (const auto& [line, pipe, written, opened, signal] : std::vector<WaitingRun>{
             {depth, "x.depth.pfm", "x.pfm", false, SIGTERM},
             {depth, "x.depth.pfm", "x.pfm", true, SIGTERM},
             {depth, "x.depth.pfm", "x.pfm", true, SIGALRM},
             {with_statistics("render"), "x.json", "x.png", false, SIGINT},
             {with_statistics("stereo"), "x.json", "x.png", false, SIGHUP},
         }) {
        const SceneFolder folder;
        ASSERT_EQ(::mkfifo((folder / pipe).c_str(), 0600), 0);
        const int reader = opened ? ::open((folder / pipe).c_str(), O_RDONLY | O_NONBLOCK) : -1;
        Program program(line);
        program.folder = folder.path;
        program.start();
        while (program.running() && !std::filesystem::exists(folder / written))
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        program.send(signal);
        EXPECT_TRUE(ends(program)) << line[0] << ' ' << signal;
        EXPECT_EQ(program.wait().code, 128 + signal);
        EXPECT_FALSE(has_temporary(folder));
        if (reader >= 0) ::close(reader);
    }
}

TEST(Render, AParentThatIgnoresASignalMeansIt) {
    const SceneFolder folder;
    const std::string command = std::string("trap '' HUP; exec ") + OBSCURA_BINARY +
                                " render s.toml --size 1000x750 --samples 1 -q -o x.pfm --aov normal";
    Program program({"-c", command}, "/bin/sh");
    program.folder = folder.path;
    program.start();
    while (program.running() && !has_temporary(folder)) {
    }
    program.send(SIGHUP);
    EXPECT_EQ(program.wait().code, 0);
    EXPECT_EQ(folder.listing(), (Names{"s.toml", "x.normal.pfm", "x.pfm"}));
}

TEST(Render, FilesLargerThanTheLimitAreOutputErrors) {
    const SceneFolder folder;
    for (const Names& line : std::vector<Names>{
             {"render", "s.toml", "-q", "--size", "200x150", "-o", "x.pfm"},
             {"render", "s.toml", "-q", "-o", "x.pfm", "--stats-json", "x.json"},
             {"stereo", "s.toml", "-q", "-o", "x.png", "--maps", "m"},
             {"diffraction", "box", "--mask-size", "16", "--size", "64", "-o", "x.pfm"},
         }) {
        Program program(line);
        program.folder = folder.path;
        program.file_bytes = 600;
        const Outcome run = program.run();
        EXPECT_EQ(run.code, 5) << line[0] << run.err;
        EXPECT_NE(run.err.find(": cannot be written: File too large\n"), std::string::npos) << run.err;
        EXPECT_FALSE(has_temporary(folder)) << line[0];
    }
}

TEST(Render, ACacheThatCannotBeWrittenLeavesNoFolder) {
    std::string text = small_scene;
    text.replace(text.find("resolution"), 0, "scope = \"full\"\ncache = \"maps\"\n");
    const Folder folder;
    folder.write("s.toml", text);
    Program program({"render", "s.toml", "-q", "-o", "x.png"});
    program.folder = folder.path;
    program.file_bytes = 100;
    const Outcome run = program.run();
    EXPECT_EQ(run.code, 5) << run.err;
    EXPECT_NE(run.err.find("lamp.shadowtree: cannot be written: File too large"), std::string::npos)
        << run.err;
    EXPECT_EQ(folder.listing(), (Names{"s.toml"}));
}

TEST(Render, AKilledRunLeavesTheOldFileAlone) {
    const SceneFolder folder;
    ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q", "-o", "x.png"}).code, 0);
    const std::string before = file_text(folder / "x.png");
    Names line = long_render("x.png");
    line.push_back("--overwrite");
    Program program(line);
    program.folder = folder.path;
    program.start();
    EXPECT_TRUE(wait_for_progress(program));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().code, 1000 + SIGKILL);
    EXPECT_EQ(file_text(folder / "x.png"), before);
}

TEST(Render, TwoProcessesOneOutputGiveOneWholeFile) {
    const SceneFolder folder;
    ASSERT_EQ(run_in(folder, {"render", "s.toml", "-q", "-o", "one.png"}).code, 0);
    const std::string expected = file_text(folder / "one.png");
    for (int round = 0; round < 5; ++round) {
        Program a({"render", "s.toml", "-q", "-o", "x.png", "--overwrite"});
        Program b({"render", "s.toml", "-q", "-o", "x.png", "--overwrite"});
        a.folder = b.folder = folder.path;
        a.start();
        b.start();
        EXPECT_EQ(a.wait().code, 0);
        EXPECT_EQ(b.wait().code, 0);
        EXPECT_TRUE(file_text(folder / "x.png") == expected);
        EXPECT_EQ(folder.listing(), (Names{"one.png", "s.toml", "x.png"}));
    }
}

TEST(Render, AClosedStandardOutputDoesNotTouchTheFiles) {
    const SceneFolder folder;
    Program program({"render", "s.toml", "-q"});
    program.folder = folder.path;
    program.out_closed = true;
    EXPECT_EQ(program.run().code, 0);
    EXPECT_EQ(png(folder / "s.png").width, 64);
}

}  // namespace
}  // namespace obscura::test
