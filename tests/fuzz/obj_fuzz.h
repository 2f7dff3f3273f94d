#pragma once
// What the fuzzer and the replay of its corpus do with one input.

#include <cstdint>
#include <span>

namespace obscura {

/// Reads `bytes` as an OBJ text and, behind the first NUL byte, the MTL text that every mtllib means. Ends
/// quietly when the input is read or refused with an InputError or LimitError; checks what a read model
/// promises and that tinyobjloader reads the same.
void try_obj(std::span<const std::uint8_t> bytes);

}  // namespace obscura
