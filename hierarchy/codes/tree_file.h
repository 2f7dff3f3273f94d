#pragma once
// Shadow trees in files: written whole or not at all, read without copying, believed only after checking.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/file_output.h"
#include "hierarchy/shadow_tree.h"
#include "hierarchy/tree_file_key.h"

namespace obscura {

/// Hash of what lookups see of a tree: code, layout, levels, scales and units. Not the view, counts or top
/// grid.
std::uint64_t content_hash(const ShadowTree& tree);

/// Writes one or more trees (six for a point light) atomically, without joining them in memory. Each tree's
/// view must be square with 2^levels texels a side. Throws OutputError.
void write_tree_file(const std::filesystem::path& path, std::span<const ShadowTree> trees,
                     const TreeFileKey& key, Existing existing = Existing::replace);

struct TreeFile {
    TreeFileKey key;
    std::vector<ShadowTree> trees;  ///< their bits are the file, mapped; top grids are as when written
};

/// Reads a file of trees. Throws InputError naming the file when it cannot be read, is cut short, altered,
/// not of this kind, of another version, or holds a tree whose structure could lead a lookup outside.
TreeFile read_tree_file(const std::filesystem::path& path);

/// The same for bytes in memory, aligned to 64, that `owner` keeps alive; `name` is for messages.
TreeFile read_tree_file(std::span<const std::uint8_t> bytes, std::shared_ptr<const void> owner,
                        const std::string& name);

struct CachedTrees {
    CacheState state = CacheState::absent;
    std::vector<ShadowTree> trees;  ///< when usable
};

/// Reads a file if it has this key. What is not usable is to be built again; what is broken throws InputError
/// as read_tree_file() does.
CachedTrees read_cached_trees(const std::filesystem::path& path, const TreeFileKey& key);

}  // namespace obscura
