#include "app/models/file_access.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// scene/ is the root, outside/ is not.
class FileAccessTest : public testing::Test {
  protected:
    FileAccessTest() {
        folder.write("scene/meshes/a.obj", "inside");
        folder.write("outside/secret.obj", "secret");
        folder.write("scene2/b.obj", "a name that begins alike");
        access.root = folder.path / "scene";
    }

    template <class Error>
    void expect_error(const std::function<void()>& fn, const std::string& part) {
        try {
            fn();
            ADD_FAILURE() << "no error; wanted: " << part;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    }
    void expect_outside(const std::string& name) {
        expect_error<InputError>([&] { resolve_input(access, name); }, "leads outside");
    }

    TemporaryFolder folder;
    FileAccess access;
};

TEST_F(FileAccessTest, FilesInsideAreRead) {
    EXPECT_EQ(resolve_input(access, "meshes/a.obj"), folder.path / "scene/meshes/a.obj");
    EXPECT_EQ(resolve_input(access, "meshes/../meshes/./a.obj"), folder.path / "scene/meshes/a.obj");
    EXPECT_EQ(read_input(access, "meshes/a.obj", 100), "inside");
    fs::create_symlink("meshes/a.obj", folder.path / "scene/link.obj");
    EXPECT_EQ(read_input(access, "link.obj", 100), "inside");
    access.root += "/";
    EXPECT_EQ(read_input(access, "meshes/a.obj", 100), "inside");
}

TEST_F(FileAccessTest, ABackslashIsASlashWhereNoFileHasIt) {
    EXPECT_EQ(read_input(access, "meshes\\a.obj", 100), "inside");
    folder.write("scene/meshes\\a.obj", "with a backslash");
    EXPECT_EQ(read_input(access, "meshes\\a.obj", 100), "with a backslash");
    expect_outside("..\\outside\\secret.obj");
    expect_error<MissingFile>([&] { resolve_input(access, "meshes\\b.obj"); }, "No such file");
}

TEST_F(FileAccessTest, NamesTheFolderThatIsLeft) {
    expect_error<InputError>([&] { resolve_input(access, "../outside/secret.obj"); },
                             "leads outside " + (folder.path / "scene").string() + " (");
    expect_error<InputError>([&] { resolve_input({}, "../secret.obj"); },
                             "leads outside " + fs::current_path().string() + " (");
}

TEST_F(FileAccessTest, NothingOutside) {
    expect_outside("../outside/secret.obj");
    expect_outside("meshes/../../outside/secret.obj");
    expect_outside((folder.path / "outside/secret.obj").string());
    expect_outside("/etc/passwd");
    expect_outside("../scene2/b.obj");
    expect_outside("../outside/not_there.obj");  // tells nothing about what is there
    fs::create_symlink("../outside/secret.obj", folder.path / "scene/link.obj");
    expect_outside("link.obj");
    fs::create_directory_symlink(folder.path / "outside", folder.path / "scene/folder");
    expect_outside("folder/secret.obj");
}

TEST_F(FileAccessTest, AllowedFoldersOpen) {
    access.allowed.push_back(folder.path / "outside");
    EXPECT_EQ(read_input(access, "../outside/secret.obj", 100), "secret");
    EXPECT_EQ(read_input(access, (folder.path / "outside/secret.obj").string(), 100), "secret");
    expect_outside("../scene2/b.obj");
}

TEST_F(FileAccessTest, MissingEmptyAndEndless) {
    expect_error<MissingFile>([&] { resolve_input(access, "meshes/none.obj"); },
                              "meshes/none.obj: cannot open: No such file or directory");
    expect_error<MissingFile>([&] { read_file(folder.path / "none", 100); }, "No such file or directory");
    expect_error<InputError>([&] { resolve_input(access, ""); }, "empty file name");
    expect_error<InputError>([&] { resolve_input(access, std::string("a\0b", 3)); }, "NUL");
    expect_error<InputError>([&] { resolve_input(access, std::string(5000, 'x')); }, "File name too long");
    fs::create_symlink("loop2", folder.path / "scene/loop1");
    fs::create_symlink("loop1", folder.path / "scene/loop2");
    expect_error<InputError>([&] { resolve_input(access, "loop1"); }, "symbolic links");
}

TEST_F(FileAccessTest, OnlyRegularFiles) {
    const fs::path fifo = folder.path / "scene/fifo";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    expect_error<InputError>([&] { read_file(fifo, 100); },
                             "not a regular file, but a FIFO");  // and returns at once
    expect_error<InputError>([&] { read_file("/dev/zero", 100); }, "not a regular file, but a device");
    expect_error<InputError>([&] { read_file(folder.path, 100); }, "not a regular file, but a folder");

    const fs::path path = folder.path / "scene/socket";
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    ASSERT_LT(path.string().size(), sizeof address.sun_path);
    std::copy_n(path.c_str(), path.string().size(), address.sun_path);
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_GE(fd, 0);
    ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    expect_error<InputError>([&] { read_file(path, 100); }, "not a regular file");
    ::close(fd);
}

TEST_F(FileAccessTest, SizesAreLimited) {
    const fs::path file = folder.write("scene/ten", "0123456789");
    EXPECT_EQ(read_file(file, 10), "0123456789");
    expect_error<LimitError>([&] { read_file(file, 9); }, "limit");
    EXPECT_EQ(read_file(folder.write("scene/empty", ""), 0), "");
    // A hole of a terabyte is refused before anything is allocated.
    const fs::path huge = folder.write("scene/huge", "");
    if (::truncate(huge.c_str(), std::int64_t{1} << 40) != 0) GTEST_SKIP() << "no sparse files here";
    expect_error<LimitError>([&] { read_file(huge, 1 << 20); }, "1099511627776");
}

}  // namespace
}  // namespace obscura
