#pragma once
// What the fuzzer and the tests of crafted files do with one input.

#include <cstdint>
#include <span>

namespace obscura {

/// Makes the checksums of a file of shadow trees right where its numbers lead to bytes that it has, as an
/// adversary would: what is then refused is refused for its structure.
void seal_tree_file(std::span<std::uint8_t> bytes);

/// Reads a copy of `bytes` that ends where they end, sealed or as it is. Ends quietly when it is refused with
/// an InputError; of trees that are accepted, looks up texels all over the map. Returns whether it was read.
bool try_trees(std::span<const std::uint8_t> bytes, bool sealed);

}  // namespace obscura
