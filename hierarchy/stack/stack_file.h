#pragma once
// A stack in a file: written whole or not at all, read without copying, believed only after checking
// (as hierarchy/codes/tree_file.h).

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/file_output.h"
#include "hierarchy/stack/stack.h"
#include "hierarchy/tree_file_key.h"

namespace obscura {

/// Hash of all that lookups see of a stack: frame, slices, layout, shape, scales and words.
std::uint64_t content_hash(const ShadowStack& stack);

/// Writes atomically. Throws OutputError.
void write_stack_file(const std::filesystem::path& path, const ShadowStack& stack, const TreeFileKey& key,
                      Existing existing = Existing::replace);

struct StackFile {
    TreeFileKey key;
    ShadowStack stack;  ///< its bits are the file, mapped
};

/// Throws InputError naming the file when it cannot be read, is cut short, altered, not of this kind, of
/// another version, or holds an octree whose structure could lead a lookup outside.
StackFile read_stack_file(const std::filesystem::path& path);

/// The same for bytes in memory, aligned to 64, that `owner` keeps alive; `name` is for messages.
StackFile read_stack_file(std::span<const std::uint8_t> bytes, std::shared_ptr<const void> owner,
                          const std::string& name);

struct CachedStack {
    CacheState state = CacheState::absent;
    std::optional<ShadowStack> stack;  ///< when usable
};

/// Reads a file if it has this key. What is not usable is to be built again; what is broken throws InputError
/// as read_stack_file() does.
CachedStack read_cached_stack(const std::filesystem::path& path, const TreeFileKey& key);

}  // namespace obscura
