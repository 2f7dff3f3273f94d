#include "hierarchy/needed_nodes.h"

#include <algorithm>

#include "core/radix_sort.h"

namespace obscura {
namespace {

// A code holds the Morton code of the square's first texel (40 bits), then its height (5 bits), then what is
// wanted: its value (0) or all its texels (1). Sorted codes put the contents of any square side by side.
constexpr int code_bits = 46;
std::uint64_t code_of(std::uint64_t morton, int height, bool texels) {
    return (morton << (2 * height)) << 6 | static_cast<std::uint64_t>(height) << 1 | (texels ? 1u : 0u);
}
std::uint64_t first_texel(std::uint64_t code) {
    return code >> 6;
}
int height_of(std::uint64_t code) {
    return static_cast<int>(code >> 1 & 31u);
}

}  // namespace

void NeededNodes::add(std::uint64_t morton, int level) {
    codes_.push_back(code_of(morton, level, level == 0));
}

void NeededNodes::add_texels(std::uint64_t morton, int level) {
    codes_.push_back(code_of(morton, level, true));
}

void NeededNodes::add(std::uint32_t x, std::uint32_t y, int level) {
    add(morton_code(x, y), level);
}

void NeededNodes::add_texels(std::uint32_t x, std::uint32_t y, int level) {
    add_texels(morton_code(x, y), level);
}

void NeededNodes::add(const NeededNodes& other) {
    codes_.insert(codes_.end(), other.codes_.begin(), other.codes_.end());
}

void NeededNodes::finish() {
    if (!std::is_sorted(codes_.begin(), codes_.end())) sort_bits(codes_, 0, code_bits);
    codes_.erase(std::unique(codes_.begin(), codes_.end()), codes_.end());
}

NeededNodes::Codes NeededNodes::inside_child(Codes codes, std::uint64_t child_morton, int height) {
    const auto before = [](std::uint64_t code, std::uint64_t texel) { return first_texel(code) < texel; };
    const std::uint64_t begin = child_morton << (2 * height), end = (child_morton + 1) << (2 * height);
    const auto low = std::lower_bound(codes.begin(), codes.end(), begin, before);
    const auto high = std::lower_bound(low, codes.end(), end, before);
    const auto inside =
        codes.subspan(static_cast<std::size_t>(low - codes.begin()), static_cast<std::size_t>(high - low));
    return inside;
}

bool NeededNodes::asks_for_all(Codes codes, std::uint64_t morton, int height) {
    // Among the codes of the same first texel, higher squares come later; those above are known to the
    // caller.
    const std::uint64_t from = code_of(morton, height, false);
    const auto at = std::lower_bound(codes.begin(), codes.end(), from);
    return at != codes.end() && first_texel(*at) == first_texel(from);
}

bool NeededNodes::asks_for_value_only(Codes codes, std::uint64_t morton, int height) {
    const std::uint64_t value = code_of(morton, height, false);
    return height > 0 && std::all_of(codes.begin(), codes.end(), [&](std::uint64_t code) {
               return code == value || height_of(code) > height;
           });
}

}  // namespace obscura
