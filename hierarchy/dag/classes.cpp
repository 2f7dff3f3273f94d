#include "hierarchy/dag/classes.h"

#include <algorithm>
#include <bit>

#include "core/error.h"
#include "hierarchy/dag/chunks.h"

namespace obscura {
namespace {

constexpr std::uint32_t most_ranges = 1u << max_chunk_log2;
constexpr std::uint64_t out_of_reach = ~std::uint64_t{0} / 2;

/// Planes of class bits that so many classes need.
constexpr std::uint32_t planes_of(std::size_t classes) {
    return classes <= 1 ? 0 : classes == 2 ? 1 : 2;
}

/// The greatest power of two of which a range holds a multiple.
int widest_shift(NumberRange range) {
    if (range.least == 0) return 31;
    return static_cast<int>(std::bit_width((range.least - 1) ^ range.greatest)) - 1;
}

/// What ranges that are one class have in common, range by range.
struct Common {
    int shift = 31;  ///< all hold a multiple of 2^shift
    std::uint32_t least_last = ~0u, greatest_first = 0;

    void add(NumberRange range) {
        shift = std::min(shift, widest_shift(range));
        least_last = std::min(least_last, range.greatest);
        greatest_first = std::max(greatest_first, range.least);
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

struct Item {
    NumberRange range;
    std::uint32_t at;  ///< which of the chunk's values
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
    void run(std::size_t most, std::uint64_t bound) {
        bits_.assign((most + 1) * (count_ + 1), out_of_reach);
        from_.assign(bits_.size(), 0);
        bits_[0] = 0;
        for (std::size_t first = 0; first < count_; ++first) {
            Common common;
            for (std::size_t last = first; last < count_; ++last) {
                common.add(items_[last].range);
                const std::uint64_t bits = (last + 1 - first) * common.width();
                if (bits >= bound) break;  // longer ones have no fewer
                for (std::size_t k = 0; k < most; ++k) {
                    const std::uint64_t sum = bits_[at(k, first)] + bits;
                    if (sum >= bits_[at(k + 1, last + 1)]) continue;
                    bits_[at(k + 1, last + 1)] = sum;
                    from_[at(k + 1, last + 1)] = static_cast<std::uint32_t>(first);
                }
            }
        }
    }
    std::uint64_t bits(std::size_t classes) const { return bits_[at(classes, count_)]; }

    /// The items of each class, when there are so many.
    std::vector<std::span<const Item>> parts(std::size_t classes) const {
        std::vector<std::span<const Item>> parts(classes);
        std::size_t end = count_;
        for (std::size_t k = classes; k > 0; --k) {
            const std::size_t first = from_[at(k, end)];
            parts[k - 1] = std::span(items_).subspan(first, end - first);
            end = first;
        }
        return parts;
    }

  private:
    std::size_t at(std::size_t classes, std::size_t items) const { return classes * (count_ + 1) + items; }

    std::vector<Item> items_;
    std::size_t count_;
    std::vector<std::uint64_t> bits_;  ///< by classes, then by how many items they hold
    std::vector<std::uint32_t> from_;  ///< of the same: the first item of the last class
};

class Chooser {
  public:
    Chooser(std::span<const NumberRange> ranges, TreeLayout layout, int chunk_log2)
        : layout_(layout), plane_bits_(std::uint64_t{1} << chunk_log2) {
        for (std::uint32_t i = 0; i < ranges.size(); ++i)
            items_.push_back({ranges[i], i});
        chunk_.class_of.resize(ranges.size());
        chunk_.factors.resize(ranges.size());
    }

    ClassedChunk run() {
        std::vector<Item> rest = items_;
        std::vector<Item> best_rest;
        std::vector<ValueClass> held, best_held;
        std::uint64_t least = out_of_reach;
        std::size_t best_classes = 0;
        for (;;) {
            Cut cut(rest);
            cut.run(most_classes - held.size(), least);
            for (std::size_t k = 0; k + held.size() <= most_classes; ++k) {
                if (k + held.size() == 0) continue;
                const std::uint64_t bits = cut.bits(k) + overhead(k + held.size());
                if (bits >= least) continue;
                least = bits;
                best_classes = k;
                best_held = held;
                best_rest = rest;
            }
            if (rest.empty() || held.size() == most_classes - 1) break;
            held.push_back({stored_number(most_held(ranges_of(rest)), layout_), 0, 0});
            std::erase_if(rest, [&](const Item& item) { return holds(item.range, held.back().base); });
        }
        settle(best_held, best_rest, best_classes);
        return std::move(chunk_);
    }

  private:
    static bool holds(NumberRange range, std::uint32_t v) { return range.least <= v && v <= range.greatest; }
    static std::vector<NumberRange> ranges_of(const std::vector<Item>& items) {
        std::vector<NumberRange> ranges;
        for (const Item& item : items)
            ranges.push_back(item.range);
        return ranges;
    }
    std::uint64_t overhead(std::size_t classes) const {
        return classes * packed_class_bytes * 8 + planes_of(classes) * plane_bits_;
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
                common.add(item.range);
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
    const std::uint64_t plane_bits_;
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
