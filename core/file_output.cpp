#include "core/file_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

// --- temporaries under way ---------------------------------------------------------------------------
// The one mutable global of the house: a signal handler can reach nothing else. A slot's path is written
// before its state turns to `open` and not touched until it is `free` again.

enum SlotState : int { slot_free, slot_filling, slot_open };

struct Slot {
    std::atomic<int> state{slot_free};
    char path[4096] = {};
};
constinit Slot slots[64];
static_assert(std::atomic<int>::is_always_lock_free);

/// Holds a slot while its temporary may exist; without a free slot the file is merely not cleaned by a
/// signal.
class Pending {
  public:
    explicit Pending(const std::string& path) {
        if (path.size() >= sizeof(Slot::path)) return;
        for (Slot& s : slots) {
            int expected = slot_free;
            if (!s.state.compare_exchange_strong(expected, slot_filling)) continue;
            std::memcpy(s.path, path.c_str(), path.size() + 1);
            s.state.store(slot_open);
            slot = &s;
            return;
        }
    }
    ~Pending() {
        if (slot) slot->state.store(slot_free);
    }
    Pending(const Pending&) = delete;
    Pending& operator=(const Pending&) = delete;

  private:
    Slot* slot = nullptr;
};

// --- steps -------------------------------------------------------------------------------------------

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
    throw OutputError(fmt::format("{}: {}: {}", path.string(), what, std::strerror(error)));
}

struct Descriptor {
    int fd = -1;
    explicit Descriptor(int fd_) : fd(fd_) {}
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    /// Closes now; 0 or the error.
    int close() {
        const int result = ::close(fd);
        fd = -1;
        return result == 0 ? 0 : errno;
    }
};

/// 0 or the error of the first write that failed.
int write_all(int fd, std::string_view bytes) {
    constexpr std::size_t block = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), block));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno;
        if (n == 0) return EIO;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return 0;
}

/// What stands at the target now.
enum class Target { absent, regular, directory, special };

Target target_kind(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        if (errno == ENOENT) return Target::absent;
        fail(path, "cannot be written", errno);
    }
    if (S_ISREG(status.st_mode)) return Target::regular;
    return S_ISDIR(status.st_mode) ? Target::directory : Target::special;
}

/// Refuses what must not be written; returns the kind of target.
Target check_target(const fs::path& path, Existing existing) {
    if (path.filename().empty()) throw OutputError(fmt::format("'{}': no file name", path.string()));
    const Target kind = target_kind(path);
    if (kind == Target::directory) throw OutputError(fmt::format("{}: is a directory", path.string()));
    if (kind == Target::regular && existing == Existing::refuse) {
        throw OutputError(fmt::format("{}: already exists (--overwrite replaces it)", path.string()));
    }
    return kind;
}

/// The file that a chain of symbolic links leads to, existing or not, so that links survive.
fs::path behind_links(fs::path path) {
    std::error_code error;
    for (int i = 0; i < 40 && fs::is_symlink(path, error); ++i) {
        path = path.parent_path() / fs::read_symlink(path, error);  // an absolute target replaces the folder
    }
    return path;
}

fs::path directory_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// A name beside the target that no other write of this process uses; short, whatever the target is called.
fs::path temporary_beside(const fs::path& path) {
    static std::atomic<unsigned> counter{0};
    return directory_of(path) / fmt::format(".part.{}-{}", ::getpid(), counter++);
}

int create_exclusively(const fs::path& path) {
    return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

/// What replaces a file may be read and written by the same people. 0 or the error.
int keep_mode(const fs::path& replaced, int fd) {
    struct stat status {};
    if (::stat(replaced.c_str(), &status) != 0) return errno == ENOENT ? 0 : errno;
    return ::fchmod(fd, status.st_mode & 07777) == 0 ? 0 : errno;
}

/// 0 or the error. Never replaces a file that came into being meanwhile, unless told to.
int rename_into_place(const fs::path& from, const fs::path& to, Existing existing) {
    if (existing == Existing::refuse) {
        if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
        if (errno != EINVAL && errno != ENOSYS) return errno;
        if (::access(to.c_str(), F_OK) == 0) return EEXIST;  // a file system without the atomic form
    }
    return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

/// Makes the new name durable. File systems that cannot sync a directory are not an error.
void sync_directory(const fs::path& directory) {
    const Descriptor d(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (d.fd >= 0 && ::fsync(d.fd) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS) {
        fail(directory, "cannot be synced", errno);
    }
}

/// 0 or the error of the first write that failed.
int write_parts(int fd, std::span<const std::string_view> parts) {
    int error = 0;
    for (std::size_t i = 0; i < parts.size() && !error; ++i)
        error = write_all(fd, parts[i]);
    return error;
}

void write_directly(const fs::path& path, std::span<const std::string_view> parts) {
    Descriptor out(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (out.fd < 0) fail(path, "cannot be opened", errno);
    if (const int error = write_parts(out.fd, parts)) fail(path, "cannot be written", error);
    if (const int error = out.close()) fail(path, "cannot be written", error);
}

}  // namespace

void write_file_atomically(const fs::path& path, std::string_view bytes, Existing existing) {
    write_file_atomically(path, std::span(&bytes, 1), existing);
}

void write_file_atomically(const fs::path& path, std::span<const std::string_view> parts, Existing existing) {
    if (check_target(path, existing) == Target::special) return write_directly(path, parts);
    const fs::path target = behind_links(path);
    const fs::path temporary = temporary_beside(target);
    const Pending pending(temporary.string());

    Descriptor out(create_exclusively(temporary));
    if (out.fd < 0) fail(path, "cannot be created", errno);
    int error = write_parts(out.fd, parts);
    if (!error) error = keep_mode(target, out.fd);
    if (!error && ::fsync(out.fd) != 0) error = errno;
    const int close_error = out.close();
    if (!error) error = close_error;
    if (!error) error = rename_into_place(temporary, target, existing);
    if (error) {
        ::unlink(temporary.c_str());
        fail(path, "cannot be written", error);
    }
    sync_directory(directory_of(target));
}

void check_writable(const fs::path& path, Existing existing) {
    const Target kind = check_target(path, existing);
    if (kind == Target::special) {
        if (::access(path.c_str(), W_OK) != 0) fail(path, "cannot be written", errno);
        return;
    }
    const fs::path target = behind_links(path), probe = temporary_beside(target);
    const Pending pending(probe.string());
    const Descriptor out(create_exclusively(probe));
    if (out.fd < 0)
        fail(path, fmt::format("cannot be created in '{}'", directory_of(target).string()), errno);
    ::unlink(probe.c_str());
}

fs::path place_of_output(const fs::path& path) {
    std::error_code error;
    const fs::path whole = behind_links(fs::absolute(path, error));
    const fs::path folder = fs::weakly_canonical(directory_of(whole), error);
    return error ? whole.lexically_normal() : folder / whole.filename();
}

void remove_pending_outputs() noexcept {
    const int saved = errno;
    for (Slot& s : slots) {
        if (s.state.load() == slot_open) ::unlink(s.path);
    }
    errno = saved;
}

}  // namespace obscura
