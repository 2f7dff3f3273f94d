#pragma once
// What files of trees and of stacks are told apart by.

#include <cstdint>

namespace obscura {

/// What the trees were made from, as a hash of geometry, light and settings: the caller's affair.
struct TreeFileKey {
    std::uint64_t high = 0, low = 0;
    friend bool operator==(const TreeFileKey&, const TreeFileKey&) = default;
};

enum class CacheState {
    usable,
    absent,         ///< no such file
    other_key,      ///< a sound header with another key: made from something else
    other_version,  ///< by another version of this program
};

}  // namespace obscura
