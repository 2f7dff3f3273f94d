// Masks as sums of products of intervals.

#include "optics/field/separable_terms.h"

#include <cstring>
#include <map>
#include <utility>

namespace obscura {
namespace {

/// One maximal run of equal, open texels of a row.
struct Run {
    std::int32_t first, last;
    float value;
    auto operator<=>(const Run&) const = default;  // NOLINT(modernize-use-nullptr): of clang-tidy 14 alone
};
using Runs = std::vector<Run>;

Runs runs_of_row(const float* row, int width) {
    Runs runs;
    for (std::int32_t x = 0; x < width;) {
        const float value = row[x];
        const std::int32_t first = x;
        while (x < width && row[x] == value)
            ++x;
        if (value != 0.0f) runs.push_back({first, x, value});
    }
    return runs;
}

/// Equal lines of texels (rows or columns): where they stand (bands), and what they hold.
struct LineGroup {
    Runs content;
    std::vector<std::pair<std::int32_t, std::int32_t>> bands;
};

/// Bands of equal neighbours begin at `heads` and hold `runs`; the last ends at `end`. Groups stand in the
/// order in which contents first appear.
std::vector<LineGroup> grouped(const std::vector<std::int32_t>& heads, std::vector<Runs>&& runs,
                               std::int32_t end) {
    std::vector<LineGroup> groups;
    std::map<Runs, std::size_t> group_of;
    for (std::size_t h = 0; h < heads.size(); ++h) {
        if (runs[h].empty()) continue;
        const auto [at, is_new] = group_of.try_emplace(std::move(runs[h]), groups.size());
        if (is_new) groups.push_back({at->first, {}});
        groups[at->second].bands.emplace_back(heads[h], h + 1 < heads.size() ? heads[h + 1] : end);
    }
    return groups;
}

std::vector<LineGroup> group_rows(ImageView<const float> mask) {
    std::vector<std::int32_t> heads;
    std::vector<Runs> runs;
    for (std::int32_t y = 0; y < mask.height; ++y) {
        const std::size_t bytes = static_cast<std::size_t>(mask.width) * sizeof(float);
        if (y > 0 && std::memcmp(mask.row(y), mask.row(y - 1), bytes) == 0) continue;
        heads.push_back(y);
        runs.push_back(runs_of_row(mask.row(y), mask.width));
    }
    return grouped(heads, std::move(runs), mask.height);
}

/// Columns that differ from their left neighbour, the first among them; found row by row, as memory lies.
std::vector<std::int32_t> column_heads(ImageView<const float> mask) {
    std::vector<std::int32_t> differs(static_cast<std::size_t>(mask.width), 0);
    for (int y = 0; y < mask.height; ++y) {
        const float* row = mask.row(y);
        std::int32_t* flag = differs.data();
        for (int x = 1; x < mask.width; ++x)
            flag[x] |= row[x] != row[x - 1] ? 1 : 0;
    }
    std::vector<std::int32_t> heads;
    for (std::int32_t x = 0; x < mask.width; ++x) {
        if (x == 0 || differs[static_cast<std::size_t>(x)] != 0) heads.push_back(x);
    }
    return heads;
}

std::vector<LineGroup> group_columns(ImageView<const float> mask) {
    const std::vector<std::int32_t> heads = column_heads(mask);
    std::vector<Runs> runs(heads.size());
    std::vector<float> value(heads.size(), 0.0f);
    for (std::int32_t y = 0; y < mask.height; ++y) {
        const float* row = mask.row(y);
        for (std::size_t h = 0; h < heads.size(); ++h) {
            const float now = row[heads[h]];
            if (now == value[h]) continue;
            if (value[h] != 0.0f) runs[h].back().last = y;
            if (now != 0.0f) runs[h].push_back({y, mask.height, now});
            value[h] = now;
        }
    }
    return grouped(heads, std::move(runs), mask.width);
}

/// Contents lie along the lines, bands across them.
SeparableTerms terms_of(const std::vector<LineGroup>& groups, int along, int across) {
    SeparableTerms terms;
    const double middle_x = along * 0.5, middle_y = across * 0.5;
    for (const LineGroup& group : groups) {
        for (const Run& run : group.content)
            terms.x.add(run.first - middle_x, run.last - middle_x, run.value);
        for (const auto& [from, to] : group.bands)
            terms.y.add(from - middle_y, to - middle_y, 1.0f);
        terms.x.close_term();
        terms.y.close_term();
    }
    return terms;
}

}  // namespace

bool all_even(const IntervalTerms& terms) {
    for (std::size_t k = 0; k + 1 < terms.begin.size(); ++k) {
        auto low = static_cast<std::size_t>(terms.begin[k]),
             high = static_cast<std::size_t>(terms.begin[k + 1]);
        while (low < high) {
            --high;
            if (terms.x0[low] != -terms.x1[high] || terms.x1[low] != -terms.x0[high] ||
                terms.weight[low] != terms.weight[high])
                return false;
            ++low;
        }
    }
    return true;
}

int products_per_term(const SeparableTerms& terms) {
    return (all_even(terms.x) ? 1 : 2) * (all_even(terms.y) ? 1 : 2);
}

SeparableTerms separable_terms(const QuadList& quads) {
    SeparableTerms terms;
    const double middle_x = quads.columns * 0.5, middle_y = quads.rows * 0.5;
    for (std::size_t k = 0; k < quads.size(); ++k) {
        terms.x.add(quads.x[k] - middle_x, quads.x[k] + quads.width[k] - middle_x, quads.weight[k]);
        terms.y.add(quads.y[k] - middle_y, quads.y[k] + quads.height[k] - middle_y, 1.0f);
        terms.x.close_term();
        terms.y.close_term();
    }
    return terms;
}

SeparableTerms distinct_rows(ImageView<const float> mask) {
    return terms_of(group_rows(mask), mask.width, mask.height);
}

SeparableTerms distinct_columns(ImageView<const float> mask) {
    SeparableTerms terms = terms_of(group_columns(mask), mask.height, mask.width);
    std::swap(terms.x, terms.y);
    return terms;
}

SeparableTerms separable_terms(ImageView<const float> mask) {
    SeparableTerms columns = distinct_columns(mask), rows = distinct_rows(mask);
    const auto products = [](const SeparableTerms& t) { return t.count() * products_per_term(t); };
    return products(rows) < products(columns) ? rows : columns;
}

}  // namespace obscura
