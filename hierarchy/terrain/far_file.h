#pragma once
// A day's far shadows in a file: written whole or not at all, mapped when read, any tile by itself.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/file_output.h"
#include "hierarchy/terrain/far_day.h"
#include "hierarchy/tree_file_key.h"

namespace obscura {

/// The lower half of the key of files whose upper half is far_day_hash(): the version of what is coded.
constexpr std::uint64_t far_file_kind = 1;

/// Writes atomically. Throws OutputError.
void write_far_file(const std::filesystem::path& path, const FarDay& day, const TreeFileKey& key,
                    Existing existing = Existing::replace);

struct FarFile {
    TreeFileKey key;
    FarDay day;  ///< its bytes are the file, mapped
};

/// Reads the header and the index, not the units, whose own checksums far_tile() compares. Throws InputError
/// naming the file when it cannot be read, is cut short, altered, not of this kind or of another version.
FarFile read_far_file(const std::filesystem::path& path);

/// The same for bytes in memory that `owner` keeps alive; `name` is for messages.
FarFile read_far_file(std::span<const std::uint8_t> bytes, std::shared_ptr<const void> owner,
                      const std::string& name);

}  // namespace obscura
