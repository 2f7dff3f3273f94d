#include "hierarchy/needed_nodes.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace obscura {
namespace {

// A code holds the Morton code of the square's first texel (40 bits), then its height, then what is wanted:
// its value (0) or all its texels (1). Sorted codes put the contents of any square side by side.
std::uint64_t code_of(std::uint64_t morton, int height, bool texels) {
    return (morton << (2 * height)) << 6 | static_cast<std::uint64_t>(height) << 1 | (texels ? 1u : 0u);
}
std::uint64_t first_texel(std::uint64_t code) {
    return code >> 6;
}
int height_of(std::uint64_t code) {
    return static_cast<int>(code >> 1 & 31u);
}

std::uint64_t spread(std::uint32_t v) {
    std::uint64_t b = v;
    b = (b | b << 16) & 0x0000ffff0000ffffull;
    b = (b | b << 8) & 0x00ff00ff00ff00ffull;
    b = (b | b << 4) & 0x0f0f0f0f0f0f0f0full;
    b = (b | b << 2) & 0x3333333333333333ull;
    return (b | b << 1) & 0x5555555555555555ull;
}

/// Least significant digits first: millions of codes take a tenth of the time of comparisons.
void sort_codes(std::vector<std::uint64_t>& codes) {
    constexpr int digit_bits = 12, code_bits = 48;
    constexpr std::size_t digits = std::size_t{1} << digit_bits, few = 4 * digits;
    if (codes.size() < few) {
        std::sort(codes.begin(), codes.end());
        return;
    }
    std::vector<std::uint64_t> from = std::move(codes), to(from.size());
    std::vector<std::size_t> place(digits);
    for (int shift = 0; shift < code_bits; shift += digit_bits) {
        const auto digit = [&](std::uint64_t code) { return code >> shift & (digits - 1); };
        std::fill(place.begin(), place.end(), 0);
        for (const std::uint64_t code : from)
            ++place[digit(code)];
        std::exclusive_scan(place.begin(), place.end(), place.begin(), std::size_t{0});
        for (const std::uint64_t code : from)
            to[place[digit(code)]++] = code;
        std::swap(from, to);
    }
    codes = std::move(from);
}

}  // namespace

std::uint64_t morton_code(std::uint32_t x, std::uint32_t y) {
    return spread(x) | spread(y) << 1;
}

void NeededNodes::add(std::uint32_t x, std::uint32_t y, int level) {
    codes_.push_back(code_of(morton_code(x, y), level, level == 0));
}

void NeededNodes::add_texels(std::uint32_t x, std::uint32_t y, int level) {
    codes_.push_back(code_of(morton_code(x, y), level, true));
}

void NeededNodes::add(const NeededNodes& other) {
    codes_.insert(codes_.end(), other.codes_.begin(), other.codes_.end());
}

void NeededNodes::finish() {
    sort_codes(codes_);
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
