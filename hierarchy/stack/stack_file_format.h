#pragma once
// The bytes of a file of one stack, version 1. Everything is little-endian.
//
//   StackFileHeader | SliceView x slices | zeros to 64 | words of the octree | zeros to 64

#include <cstdint>

#include "hierarchy/stack/stack_code.h"
#include "hierarchy/stack/stack_frame.h"

namespace obscura {

constexpr char stack_file_magic[8] = {'O', 'B', 'S', 'C', 'S', 'T', 'A', 'K'};
constexpr std::uint32_t stack_file_version = 1;
constexpr std::uint32_t stack_file_byte_order = 0x01020304u;
constexpr std::uint64_t stack_file_alignment = 64;

struct StackFileHeader {
    char magic[8] = {};
    std::uint32_t version = 0;
    std::uint32_t byte_order = 0;
    std::uint64_t key[2] = {};
    std::uint64_t file_bytes = 0;
    std::uint64_t bytes = 0;          ///< of the octree, padding included
    std::uint64_t padding_bytes = 0;  ///< of these
    std::uint64_t full = 0, empty = 0, leaf = 0;
    std::uint64_t content_hash = 0;  ///< content_hash() of the stack
    StackFrame frame;
    std::int32_t map_levels = 0, slice_levels = 0, anisotropy = 0;
    std::uint32_t slices = 0;
    std::uint32_t layout = 0;
    std::uint32_t offset_scale[max_tree_levels + 1] = {};
    std::uint64_t checksum = 0;  ///< bulk_hash of header and slices, with zero in this place
};
static_assert(sizeof(StackFileHeader) == 320);

}  // namespace obscura
