#include "app/models/file_access.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace obscura {
namespace {

namespace fs = std::filesystem;

struct Descriptor {
    explicit Descriptor(int value) : fd(value) {}
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int fd;
};

[[noreturn]] void fail(const fs::path& file, std::string_view what, int error) {
    const std::string message = fmt::format("{}: {}", what, std::generic_category().message(error));
    if (error == ENOENT || error == ENOTDIR) throw MissingFile(file.string(), message);
    throw InputError(file.string(), message);
}

bool inside(const fs::path& path, const fs::path& folder) {
    std::error_code error;
    fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
    if (error) return false;
    if (!base.has_filename()) base = base.parent_path();  // "dir/" and "dir" are one folder
    const auto [end, unused] = std::mismatch(base.begin(), base.end(), path.begin(), path.end());
    return end == base.end();
}

/// A folder as a message names it: a relative one says nothing to who reads the message elsewhere.
std::string folder_text(const fs::path& folder) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
    return error ? "the scene's folder" : real.string();
}

const char* kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a FIFO";
    if (S_ISSOCK(mode)) return "a socket";
    if (S_ISCHR(mode) || S_ISBLK(mode)) return "a device";
    return "something else";
}

std::string read_opened(const fs::path& file, int flags, std::int64_t max_bytes) {
    const auto too_large = [&](std::int64_t bytes) {
        return LimitError(fmt::format("{}: {} bytes or more, the limit for this file is {} bytes",
                                      file.string(), bytes, max_bytes));
    };
    // O_NONBLOCK: opening a FIFO that nobody writes to returns at once, and is refused below.
    const Descriptor in(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY | flags));
    if (in.fd < 0 && errno == ENXIO)
        throw InputError(file.string(), "not a regular file, but a socket or device");
    if (in.fd < 0) fail(file, "cannot open", errno);
    struct stat status = {};
    if (::fstat(in.fd, &status) != 0) fail(file, "cannot inspect", errno);
    if (!S_ISREG(status.st_mode)) {
        throw InputError(file.string(), fmt::format("not a regular file, but {}", kind_of(status.st_mode)));
    }
    if (status.st_size > max_bytes) throw too_large(status.st_size);

    // The size is a hint: the file may grow or shrink while it is read.
    std::string bytes(static_cast<std::size_t>(status.st_size) + 1, '\0');
    std::size_t filled = 0;
    while (true) {
        const ssize_t got = ::read(in.fd, bytes.data() + filled, bytes.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(file, "cannot read", errno);
        if (got == 0) break;
        filled += static_cast<std::size_t>(got);
        if (static_cast<std::int64_t>(filled) > max_bytes) throw too_large(static_cast<std::int64_t>(filled));
        if (filled == bytes.size()) bytes.resize(bytes.size() * 2);
    }
    bytes.resize(filled);
    return bytes;
}

}  // namespace

namespace {

fs::path resolve_as_written(const FileAccess& access, const fs::path& folder, const std::string& name) {
    if (name.empty()) throw InputError("", "empty file name");
    if (name.find('\0') != std::string::npos) throw InputError("", "file name contains a NUL byte");

    // Where it leads is decided before whether it is there: no peeking outside.
    std::error_code error;
    fs::path path = fs::weakly_canonical((folder.empty() ? fs::path(".") : folder) / name, error);
    if (error) fail(name, "cannot follow", error.value());
    const bool allowed =
        inside(path, access.root) || std::any_of(access.allowed.begin(), access.allowed.end(),
                                                 [&](const fs::path& a) { return inside(path, a); });
    if (!allowed) {
        throw InputError(name, fmt::format("leads outside {} (--allow-path DIR permits a further folder)",
                                           folder_text(access.root)));
    }
    struct stat status = {};
    if (::stat(path.c_str(), &status) != 0) fail(name, "cannot open", errno);
    if (access.read) access.read->add(path);
    return path;
}

}  // namespace

fs::path resolve_beside(const FileAccess& access, const fs::path& folder, std::string_view relative) {
    std::string name(relative);
    try {
        return resolve_as_written(access, folder, name);
    } catch (const MissingFile&) {
        if (name.find('\\') == std::string::npos) throw;
        std::replace(name.begin(), name.end(), '\\', '/');
        return resolve_as_written(access, folder, name);
    }
}

fs::path resolve_input(const FileAccess& access, std::string_view relative) {
    return resolve_beside(access, access.root, relative);
}

std::string read_file(const fs::path& file, std::int64_t max_bytes) {
    return read_opened(file, 0, max_bytes);
}

std::string read_input(const FileAccess& access, std::string_view relative, std::int64_t max_bytes) {
    return read_opened(resolve_input(access, relative), O_NOFOLLOW, max_bytes);
}

std::string read_model_bytes(const std::filesystem::path& file, const Limits& limits) {
    try {
        return read_file(file, limits.memory_mib * (1024 * 1024 / 8));
    } catch (const LimitError& error) {
        throw LimitError(fmt::format("{}, an eighth of limits.memory_mib", error.what()));
    }
}

}  // namespace obscura
