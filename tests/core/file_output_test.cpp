// Output files: complete or absent, whatever goes wrong.

#include "core/file_output.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <class Action>
std::string output_error(Action action) {
    try {
        action();
    } catch (const OutputError& e) {
        return e.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A fresh folder that knows what is in it.
class FileOutput : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "obscura_output_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
    }
    void TearDown() override { fs::remove_all(folder); }
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }
    fs::path folder;
};

TEST_F(FileOutput, TheLongestNamesAreTaken) {
    for (const std::size_t length : {242u, 255u}) {
        const fs::path file = folder / std::string(length, 'n');
        check_writable(file);
        write_file_atomically(file, "x");
        EXPECT_EQ(content(file), "x");
    }
    EXPECT_TRUE(contains(output_error([&] { check_writable(folder / std::string(256, 'n')); }),
                         "File name too long"));
    EXPECT_EQ(entries(), 2u);
}

TEST_F(FileOutput, WhatReplacesAFileHasItsMode) {
    const fs::path file = folder / "f", link = folder / "l";
    fs::create_symlink("f", link);
    for (const mode_t mode : {0400u, 0640u, 0604u}) {
        write_file_atomically(file, "before", Existing::replace);
        ASSERT_EQ(::chmod(file.c_str(), mode), 0);
        write_file_atomically(link, "after", Existing::replace);
        struct stat status {};
        ASSERT_EQ(::stat(file.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 07777, mode);
        EXPECT_EQ(content(file), "after");
    }
}

TEST_F(FileOutput, ALinkToNowhereIsToldWithTheFolderThatIsMissing) {
    const fs::path link = folder / "l", missing = folder / "none";
    fs::create_symlink(missing / "f", link);
    EXPECT_TRUE(contains(output_error([&] { check_writable(link); }),
                         link.string() + ": cannot be created in '" + missing.string() + "'"));
}

TEST_F(FileOutput, WritesAndLeavesNothingElse) {
    const std::string bytes(3'000'000, 'x');
    write_file_atomically(folder / "a.png", bytes);
    EXPECT_EQ(content(folder / "a.png"), bytes);
    write_file_atomically(folder / "empty", "");
    EXPECT_EQ(fs::file_size(folder / "empty"), 0u);
    EXPECT_EQ(entries(), 2u);
}

TEST_F(FileOutput, ReplacesOnlyWhenTold) {
    const fs::path path = folder / "a.png";
    write_file_atomically(path, "old");
    EXPECT_TRUE(contains(output_error([&] { write_file_atomically(path, "new"); }), "already exists"));
    EXPECT_TRUE(contains(output_error([&] { check_writable(path); }), "already exists"));
    EXPECT_EQ(content(path), "old");
    check_writable(path, Existing::replace);
    write_file_atomically(path, "new", Existing::replace);
    EXPECT_EQ(content(path), "new");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(FileOutput, MissingFolderAndFileAsFolderAreNamed) {
    std::ofstream(folder / "file") << "x";
    for (const fs::path& path : {folder / "no/such/a.png", folder / "file/a.png"}) {
        for (const bool check : {false, true}) {
            const std::string error =
                output_error([&] { check ? check_writable(path) : write_file_atomically(path, "x"); });
            EXPECT_TRUE(contains(error, path.string())) << error;
            EXPECT_TRUE(contains(error, "o such file or directory") || contains(error, "ot a directory"))
                << error;
        }
    }
    EXPECT_TRUE(contains(output_error([&] { write_file_atomically(folder, "x"); }), "is a directory"));
    EXPECT_TRUE(contains(output_error([&] { check_writable(folder); }), "is a directory"));
    EXPECT_TRUE(contains(output_error([&] { check_writable(folder / ""); }), "no file name"));
    EXPECT_EQ(entries(), 1u);
}

TEST_F(FileOutput, FolderThatTakesNoFilesIsSeenBeforeRendering) {
    // /proc refuses new files to everyone, root too.
    EXPECT_TRUE(
        contains(output_error([] { check_writable("/proc/obscura.png"); }), "cannot be created in '/proc'"));
    EXPECT_TRUE(
        contains(output_error([] { write_file_atomically("/proc/obscura.png", "x"); }), "cannot be created"));
    if (::geteuid() == 0) return;
    ::chmod(folder.c_str(), 0555);
    EXPECT_TRUE(contains(output_error([&] { check_writable(folder / "a.png"); }), "ermission denied"));
    ::chmod(folder.c_str(), 0755);
}

TEST_F(FileOutput, FullDeviceIsAnErrorAndStaysADevice) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_EQ(output_error([] { write_file_atomically("/dev/full", "x"); }),
              "/dev/full: cannot be written: No space left on device");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
    write_file_atomically("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(FileOutput, FailureHalfWayLeavesTheOldFileAndNoTemporary) {
    // A file size limit stands for a disk that fills up.
    const fs::path path = folder / "a.png";
    write_file_atomically(path, "old");
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit old_limit{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
    const rlimit small{1000, old_limit.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string error =
        output_error([&] { write_file_atomically(path, std::string(5000, 'x'), Existing::replace); });
    ::setrlimit(RLIMIT_FSIZE, &old_limit);
    std::signal(SIGXFSZ, old_handler);
    EXPECT_TRUE(contains(error, "File too large")) << error;
    EXPECT_EQ(content(path), "old");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(FileOutput, SymbolicLinksAreFollowedAndKept) {
    write_file_atomically(folder / "real.png", "old");
    fs::create_symlink("real.png", folder / "link.png");
    EXPECT_TRUE(
        contains(output_error([&] { write_file_atomically(folder / "link.png", "x"); }), "already exists"));
    write_file_atomically(folder / "link.png", "new", Existing::replace);
    EXPECT_TRUE(fs::is_symlink(folder / "link.png"));
    EXPECT_EQ(content(folder / "real.png"), "new");

    fs::create_symlink("later.png", folder / "dangling.png");
    write_file_atomically(folder / "dangling.png", "made");
    EXPECT_EQ(content(folder / "later.png"), "made");
    EXPECT_EQ(entries(), 4u);
}

TEST_F(FileOutput, OnePlaceHasManyNames) {
    fs::create_directory(folder / "sub");
    fs::create_directory_symlink("sub", folder / "other");
    fs::create_symlink("x", folder / "sub" / "link");  // leads to nothing yet
    const fs::path place = fs::canonical(folder) / "sub" / "x";
    for (const char* name : {"sub/x", "sub/./x", "sub/../sub/x", "other/x", "sub/link", "other/link"})
        EXPECT_EQ(place_of_output(folder / name), place) << name;
    write_file_atomically(folder / "other" / "link", "there");
    EXPECT_EQ(content(place), "there");
    EXPECT_EQ(place_of_output(folder / "sub" / "link"), place);
    EXPECT_EQ(place_of_output("x"), fs::canonical(fs::current_path()) / "x");
    EXPECT_NE(place_of_output(folder / "x"), place);
}

TEST_F(FileOutput, PipeIsWrittenDirectly) {
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        write_file_atomically(pipe, "through");
        ::_exit(0);
    }
    EXPECT_EQ(content(pipe), "through");
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(FileOutput, OfManyRivalsForOneNewFileExactlyOneWins) {
    // All start together, behind one pipe, and all see that the file is not there yet.
    int start[2];
    ASSERT_EQ(::pipe(start), 0);
    std::vector<pid_t> rivals;
    for (char id = 'a'; id < 'i'; ++id) {
        const pid_t child = ::fork();
        if (child == 0) {
            ::close(start[1]);
            char nothing = 0;
            if (::read(start[0], &nothing, 1) != 0) ::_exit(99);
            try {
                write_file_atomically(folder / "a.png", std::string(2 << 20, id));
            } catch (const OutputError&) {
                ::_exit(5);
            }
            ::_exit(0);
        }
        rivals.push_back(child);
    }
    ::close(start[0]);
    ::close(start[1]);
    int winners = 0;
    for (const pid_t rival : rivals) {
        int status = 0;
        ::waitpid(rival, &status, 0);
        ASSERT_TRUE(WIFEXITED(status));
        EXPECT_TRUE(WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 5) << WEXITSTATUS(status);
        winners += WEXITSTATUS(status) == 0;
    }
    EXPECT_EQ(winners, 1);
    const std::string bytes = content(folder / "a.png");
    EXPECT_EQ(bytes, std::string(2 << 20, bytes.empty() ? '?' : bytes[0]));
    EXPECT_EQ(entries(), 1u);
}

TEST_F(FileOutput, SignalRemovesTheTemporaryUnderWay) {
    // The child writes far more than fits before the signal; its handler does what main's does.
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGTERM, [](int signal) {
            remove_pending_outputs();
            ::_exit(128 + signal);
        });
        const std::string bytes(8 << 20, 'x');
        const char go = 'g';
        if (::write(ready[1], &go, 1) != 1) ::_exit(99);
        while (true)
            write_file_atomically(folder / "a.png", bytes, Existing::replace);
    }
    char go = 0;
    ASSERT_EQ(::read(ready[0], &go, 1), 1);
    ::usleep(50'000);
    ::kill(child, SIGTERM);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 128 + SIGTERM);
    for (const auto& entry : fs::directory_iterator(folder)) {
        EXPECT_EQ(entry.path().filename(), "a.png");
        EXPECT_EQ(entry.file_size(), std::size_t{8} << 20);
    }
    ::close(ready[0]);
    ::close(ready[1]);
}

}  // namespace
}  // namespace obscura
