#pragma once
// What the fuzzer and the replay of its corpus do with one input.

#include <cstdint>
#include <span>

namespace obscura {

/// Reads `bytes` as an elevation model of every kind. Ends quietly when they are read or refused with an
/// InputError or LimitError; checks what a read model promises.
void try_elevation(std::span<const std::uint8_t> bytes);

}  // namespace obscura
