#include "core/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace obscura {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
    throw InputError(path.string(), fmt::format("{}: {}", what, std::strerror(error)));
}

struct Descriptor {
    explicit Descriptor(int fd_) : fd(fd_) {}
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int fd;
};

}  // namespace

MappedFile map_file(const std::filesystem::path& path) {
    // Without O_NONBLOCK a pipe would wait for its writer.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.fd < 0) fail(path, "cannot be opened", errno);
    struct stat status {};
    if (::fstat(file.fd, &status) != 0) fail(path, "cannot be read", errno);
    if (!S_ISREG(status.st_mode)) throw InputError(path.string(), "is not a regular file");
    if (status.st_size == 0) return {};

    const auto size = static_cast<std::size_t>(status.st_size);
    void* memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd, 0);
    if (memory == MAP_FAILED) fail(path, "cannot be mapped to memory", errno);
    std::shared_ptr<const void> owner(memory,
                                      [size](const void* p) { ::munmap(const_cast<void*>(p), size); });
    ::madvise(memory, size, MADV_WILLNEED);  // only advice
    return {{static_cast<const std::uint8_t*>(memory), size}, std::move(owner)};
}

}  // namespace obscura
