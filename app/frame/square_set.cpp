#include "app/frame/square_set.h"

#include <bit>
#include <utility>

#include "core/radix_sort.h"

namespace obscura {
namespace {

constexpr int mask_bits = 16, morton_bits = 34, level_bits = 5, view_bits = 3;
constexpr std::uint64_t squares_mask = (std::uint64_t{1} << mask_bits) - 1;

}  // namespace

std::size_t SquareSet::probe(std::uint64_t key) const {
    const std::size_t slots = table_.size();
    // Knuth's multiplicative hash.
    std::size_t at = (key * 0x9e3779b97f4a7c15ull) >> (64 - log2_slots_);
    while (table_[at] != 0 && table_[at] >> mask_bits != key)
        at = (at + 1) & (slots - 1);
    return at;
}

std::size_t SquareSet::slot_of(std::uint64_t key) {
    std::size_t at = probe(key);
    if (table_[at] != 0) return at;
    if (2 * ++used_ > table_.size()) {
        grow();
        at = probe(key);
    }
    table_[at] = key << mask_bits;
    return at;
}

void SquareSet::grow() {
    const auto old = std::exchange(table_, std::vector<std::uint64_t>(2 * table_.size(), 0));
    ++log2_slots_;
    for (const std::uint64_t word : old) {
        if (word != 0) table_[probe(word >> mask_bits)] = word;
    }
}

std::vector<std::uint64_t> SquareSet::take_words() {
    constexpr std::uint64_t place_mask = (std::uint64_t{1} << place_bits) - 1;
    std::vector<std::uint64_t> words;
    words.reserve(used_);
    for (const std::uint64_t word : table_) {
        if (word == 0) continue;
        const std::uint64_t key = word >> mask_bits;
        const std::uint64_t morton = morton_code(static_cast<std::uint32_t>(key & place_mask),
                                                 static_cast<std::uint32_t>(key >> place_bits & place_mask));
        words.push_back((key >> (2 * place_bits) << morton_bits | morton) << mask_bits |
                        (word & squares_mask));
    }
    *this = {};
    return words;
}

std::int64_t count_squares(std::span<const std::uint64_t> words) {
    std::int64_t count = 0;
    for (const std::uint64_t word : words)
        count += std::popcount(word & squares_mask);
    return count;
}

std::vector<NeededNodes> needed_of_words(std::vector<std::uint64_t> words, std::size_t views,
                                         int texel_level) {
    sort_bits(words, mask_bits, mask_bits + morton_bits + level_bits + view_bits);
    std::vector<NeededNodes> needed(views);
    for (std::size_t i = 0; i < words.size();) {
        const std::uint64_t key = words[i] >> mask_bits;
        std::uint64_t squares = 0;
        for (; i < words.size() && words[i] >> mask_bits == key; ++i)
            squares |= words[i] & squares_mask;
        const std::uint64_t morton = key & ((std::uint64_t{1} << morton_bits) - 1);
        const auto level = static_cast<int>(key >> morton_bits & ((1u << level_bits) - 1));
        NeededNodes& of_view = needed[key >> (morton_bits + level_bits)];
        for (; squares != 0; squares &= squares - 1) {
            const std::uint64_t square = morton << 4 | static_cast<std::uint64_t>(std::countr_zero(squares));
            if (level == 0) {
                of_view.add_texels(square, texel_level);
            } else {
                of_view.add(square, level);
            }
        }
    }
    for (NeededNodes& of_view : needed)
        of_view.finish();
    return needed;
}

}  // namespace obscura
