#pragma once
// The bytes of a file of shadow trees, version 1. Everything is little-endian.
//
//   FileHeader | TreeRecord x trees | zeros to 64 | units of tree 0 | zeros | units of tree 1 | zeros | ...
//
// Units begin at multiples of 64 bytes and have at least 3 bytes of zeros behind them, so that lookups can
// read them where they lie in a mapped file. The top grid is not stored: it is made again in less time.

#include <cstdint>

#include "hierarchy/shadow_tree.h"

namespace obscura {

constexpr char tree_file_magic[8] = {'O', 'B', 'S', 'C', 'T', 'R', 'E', 'E'};
constexpr std::uint32_t tree_file_version = 1;
constexpr std::uint32_t tree_file_byte_order = 0x01020304u;
constexpr std::uint64_t tree_file_alignment = 64;
constexpr std::uint64_t tree_file_slack = tree_slack_bytes;

struct TreeFileHeader {
    char magic[8] = {};
    std::uint32_t version = 0;
    std::uint32_t byte_order = 0;
    std::uint64_t key[2] = {};
    std::uint64_t file_bytes = 0;
    std::uint32_t trees = 0;
    std::uint32_t reserved = 0;  ///< zero
    std::uint64_t checksum = 0;  ///< bulk_hash of header and records, with zero in this place
};
static_assert(sizeof(TreeFileHeader) == 56);

struct TreeRecord {
    double to_map[16] = {};  ///< row by row
    double near_w = 0;
    std::uint64_t first_byte = 0;  ///< of the units, in the file
    std::uint64_t bytes = 0;       ///< of the units, padding included
    std::uint64_t padding_bytes = 0;
    std::uint64_t full = 0, empty = 0, leaf = 0;
    std::uint64_t content_hash = 0;  ///< content_hash() of the tree
    std::int32_t width = 0, height = 0;
    float min_depth = 0, max_depth = 0;
    std::uint32_t perspective = 0;
    std::uint32_t layout = 0;
    std::int32_t levels = 0;
    std::int32_t top_levels = 0;
    std::uint32_t offset_scale[max_tree_levels + 1] = {};
    std::uint32_t code = 0;  ///< ShadowCode
};
static_assert(sizeof(TreeRecord) == 312);

}  // namespace obscura
