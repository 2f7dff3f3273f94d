#include "hierarchy/dag/classes.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/error.h"
#include "hierarchy/dag/chunks.h"

namespace obscura {
namespace {

constexpr std::uint32_t most_ranges = 1u << max_chunk_log2;
constexpr std::uint32_t out_of_reach = 1u << 30;  // bits: more than any chunk has

/// Planes of class bits that so many classes need.
constexpr std::uint32_t planes_of(std::size_t classes) {
    return classes <= 1 ? 0 : classes == 2 ? 1 : 2;
}

/// The greatest power of two of which a range holds a multiple.
int widest_shift(NumberRange range) {
    if (range.least == 0) return 31;
    return static_cast<int>(std::bit_width((range.least - 1) ^ range.greatest)) - 1;
}

struct Item {
    NumberRange range;
    std::uint32_t at;  ///< which of the chunk's values
    int shift;         ///< widest_shift(range)
};

/// What items that are one class have in common, item by item.
struct Common {
    int shift = 31;  ///< all hold a multiple of 2^shift
    std::uint32_t least_last = ~0u, greatest_first = 0;

    void add(const Item& item) {
        shift = std::min(shift, item.shift);
        least_last = std::min(least_last, item.range.greatest);
        greatest_first = std::max(greatest_first, item.range.least);
    }
    bool one_number() const { return greatest_first <= least_last; }
    std::uint32_t width() const {
        if (one_number()) return 0;
        const std::uint64_t unit = std::uint64_t{1} << shift;
        const std::uint64_t first = (greatest_first + unit - 1) >> shift, last = least_last >> shift;
        return first > last ? static_cast<std::uint32_t>(std::bit_width(first - last)) : 0;
    }
    ValueClass as_class(TreeLayout layout) const {
        if (one_number()) return {stored_number({greatest_first, least_last}, layout), 0, 0};
        return {least_last >> shift << shift, static_cast<std::uint32_t>(shift), width()};
    }
};

/// Cuts items, in their order, into classes.
class Cut {
  public:
    explicit Cut(std::vector<Item> items) : items_(std::move(items)), count_(items_.size()) {
        std::sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
            const std::uint64_t x = std::uint64_t{a.range.least} + a.range.greatest;
            const std::uint64_t y = std::uint64_t{b.range.least} + b.range.greatest;
            return x != y ? x < y : a.at < b.at;
        });
    }

    /// Least bits of factors in 0 to `most` classes, where they are fewer than `bound`.
    void run(std::size_t most, std::uint32_t bound) {
        for (std::size_t held = 0; held <= count_; ++held)
            best_[held].bits.fill(out_of_reach);
        best_[0].bits[0] = 0;
        for (std::size_t first = 0; first < count_; ++first) {
            const Best& before = best_[first];
            const std::uint32_t least = *std::min_element(before.bits.begin(), before.bits.begin() + most);
            Common common;
            for (std::size_t last = first; last < count_; ++last) {
                common.add(items_[last]);
                const std::uint32_t bits = static_cast<std::uint32_t>(last + 1 - first) * common.width();
                if (least + bits >= bound) break;  // longer ones have no fewer
                Best& after = best_[last + 1];
                for (std::size_t k = 0; k < most; ++k) {
                    if (before.bits[k] + bits >= after.bits[k + 1]) continue;
                    after.bits[k + 1] = before.bits[k] + bits;
                    after.first[k + 1] = static_cast<std::uint8_t>(first);
                }
            }
        }
    }
    std::uint32_t bits(std::size_t classes) const { return best_[count_].bits[classes]; }

    /// The items of each class, when there are so many.
    std::vector<std::span<const Item>> parts(std::size_t classes) const {
        std::vector<std::span<const Item>> parts(classes);
        std::size_t end = count_;
        for (std::size_t k = classes; k > 0; --k) {
            const std::size_t first = best_[end].first[k];
            parts[k - 1] = std::span(items_).subspan(first, end - first);
            end = first;
        }
        return parts;
    }

  private:
    /// Of the first so many items, by how many classes they are cut into.
    struct Best {
        std::array<std::uint32_t, most_classes + 1> bits;
        std::array<std::uint8_t, most_classes + 1> first;  ///< item of the last class
    };

    std::vector<Item> items_;
    std::size_t count_;
    std::array<Best, most_ranges + 1> best_;
};

class Chooser {
  public:
    Chooser(std::span<const NumberRange> ranges, TreeLayout layout, int chunk_log2)
        : layout_(layout), plane_bits_(1u << chunk_log2) {
        for (std::uint32_t i = 0; i < ranges.size(); ++i)
            items_.push_back({ranges[i], i, widest_shift(ranges[i])});
        chunk_.class_of.resize(ranges.size());
        chunk_.factors.resize(ranges.size());
    }

    ClassedChunk run() {
        std::vector<Stage> stages{{{}, items_}};
        while (!stages.back().rest.empty() && stages.size() < most_classes)
            stages.push_back(next_stage(stages.back()));

        // All that is left in one class: no more than this is looked at.
        std::uint32_t least = out_of_reach;
        for (const Stage& stage : stages) {
            Common common;
            for (const Item& item : stage.rest)
                common.add(item);
            const auto count = static_cast<std::uint32_t>(stage.rest.size());
            const std::size_t classes = stage.held.size() + (count == 0 ? 0 : 1);
            least = std::min(least, count * common.width() + overhead(classes) + 1);
        }

        const Stage* best = nullptr;
        std::size_t best_classes = 0;
        for (const Stage& stage : stages) {
            const std::size_t held = stage.held.size();
            Cut cut(stage.rest);
            cut.run(most_classes - held, least);
            for (std::size_t k = held == 0 ? 1 : 0; k + held <= most_classes; ++k) {
                const std::uint32_t bits = cut.bits(k) + overhead(k + held);
                if (bits >= least) continue;
                least = bits;
                best = &stage;
                best_classes = k;
            }
        }
        CHECK(best != nullptr);
        settle(best->held, best->rest, best_classes);
        return std::move(chunk_);
    }

  private:
    /// Numbers that are classes of their own, and what none of them serves.
    struct Stage {
        std::vector<ValueClass> held;
        std::vector<Item> rest;
    };
    Stage next_stage(const Stage& before) const {
        Stage stage = before;
        const std::uint32_t number = stored_number(most_held(ranges_of(before.rest)), layout_);
        stage.held.push_back({number, 0, 0});
        std::erase_if(stage.rest, [&](const Item& item) { return holds(item.range, number); });
        return stage;
    }

    static bool holds(NumberRange range, std::uint32_t v) { return range.least <= v && v <= range.greatest; }
    static std::vector<NumberRange> ranges_of(const std::vector<Item>& items) {
        std::vector<NumberRange> ranges;
        ranges.reserve(items.size());
        for (const Item& item : items)
            ranges.push_back(item.range);
        return ranges;
    }
    std::uint32_t overhead(std::size_t classes) const {
        return static_cast<std::uint32_t>(classes) * packed_class_bytes * 8 +
               planes_of(classes) * plane_bits_;
    }

    void settle(const std::vector<ValueClass>& held, const std::vector<Item>& rest, std::size_t classes) {
        chunk_.classes = held;
        std::vector<char> is_left(items_.size(), 0);
        for (const Item& item : rest)
            is_left[item.at] = 1;
        // The first of the held numbers that fits, as they were found.
        for (const Item& item : items_) {
            if (is_left[item.at] != 0) continue;
            std::size_t c = 0;
            while (!holds(item.range, held[c].base))
                ++c;
            chunk_.class_of[item.at] = static_cast<std::uint8_t>(c);
        }
        Cut cut(rest);
        cut.run(classes, out_of_reach);
        for (const std::span<const Item> part : cut.parts(classes)) {
            Common common;
            for (const Item& item : part)
                common.add(item);
            const ValueClass of = common.as_class(layout_);
            for (const Item& item : part) {
                chunk_.class_of[item.at] = static_cast<std::uint8_t>(chunk_.classes.size());
                chunk_.factors[item.at] = factor_in(item.range, of);
            }
            chunk_.classes.push_back(of);
        }
    }

    /// The factor whose value comes nearest to the number that is preferred.
    std::uint32_t factor_in(NumberRange range, const ValueClass& of) const {
        if (of.width == 0) return 0;
        const std::uint64_t unit = std::uint64_t{1} << of.shift;
        const std::uint32_t base = of.base >> of.shift;
        const auto first = static_cast<std::uint32_t>((range.least + unit - 1) >> of.shift);
        const std::uint32_t from = first > base ? first - base : 0;
        const std::uint32_t to =
            std::min((range.greatest >> of.shift) - base, 0xffffffffu >> (32 - of.width));
        CHECK(from <= to);
        const std::uint32_t wanted = stored_number(range, layout_) >> of.shift;
        return std::clamp(wanted > base ? wanted - base : 0, from, to);
    }

    const TreeLayout layout_;
    const std::uint32_t plane_bits_;
    std::vector<Item> items_;
    ClassedChunk chunk_;
};

}  // namespace

std::uint64_t ClassedChunk::bytes(int chunk_log2) const {
    std::uint64_t bits = planes_of(classes.size()) << chunk_log2;
    for (const std::uint8_t c : class_of)
        bits += classes[c].width;
    return packed_head_bytes + classes.size() * packed_class_bytes + (bits + 7) / 8;
}

ClassedChunk classed_chunk_of(std::span<const NumberRange> ranges, TreeLayout layout, int chunk_log2) {
    CHECK(!ranges.empty() && ranges.size() <= most_ranges);
    return Chooser(ranges, layout, chunk_log2).run();
}

}  // namespace obscura
