#pragma once
// A file's bytes as memory, read when they are touched.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace obscura {

/// A whole file, mapped read-only; copies share the mapping, which lives as long as `owner` or a copy of it.
/// Files that are replaced by a rename (see file_output.h) keep the bytes they had; one that another process
/// cuts short while it is mapped ends this one with a bus error.
struct MappedFile {
    std::span<const std::uint8_t> bytes;  ///< page-aligned; empty for an empty file
    std::shared_ptr<const void> owner;
};

/// Throws InputError when the file cannot be opened, is not a regular file or cannot be mapped.
MappedFile map_file(const std::filesystem::path& path);

}  // namespace obscura
