// obscura render when something fails from outside: read-only folders, full disks, little memory, signals,
// rivals.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/program.h"

namespace obscura::test {
namespace {

using Names = std::vector<std::string>;

/// A folder with the small scene in it.
struct SceneFolder : Folder {
    explicit SceneFolder(const std::string& more = "") { write("s.toml", small_scene + more); }
};

Image<Rgba8> png(const std::filesystem::path& file) {
    return decode_png(file_text(file), file.string());
}

TEST(Render, ReadOnlyFoldersAreRefusedBeforeTheWork) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const SceneFolder folder;
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
    for (const int signal : {SIGINT, SIGTERM}) {
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
