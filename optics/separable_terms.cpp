// Masks as sums of products of intervals.

#include "optics/separable_terms.h"

#include <map>
#include <utility>

namespace obscura {
namespace {

/// One maximal run of equal, open texels of a row.
struct Run {
    std::int32_t first, last;
    float value;
    auto operator<=>(const Run&) const = default;
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

bool same_row(const float* a, const float* b, int width) {
    for (int x = 0; x < width; ++x) {
        if (a[x] != b[x]) return false;
    }
    return true;
}

/// A set of equal rows: where they stand (bands), and what they hold.
struct RowGroup {
    Runs content;
    std::vector<std::pair<std::int32_t, std::int32_t>> bands;
};

/// In the order in which contents first appear.
std::vector<RowGroup> group_rows(ImageView<const float> mask) {
    std::vector<RowGroup> groups;
    std::map<Runs, std::size_t> group_of;
    for (std::int32_t y = 0; y < mask.height;) {
        const std::int32_t first = y;
        while (y < mask.height && same_row(mask.row(y), mask.row(first), mask.width))
            ++y;
        Runs runs = runs_of_row(mask.row(first), mask.width);
        if (runs.empty()) continue;
        const auto [at, is_new] = group_of.try_emplace(std::move(runs), groups.size());
        if (is_new) groups.push_back({at->first, {}});
        groups[at->second].bands.emplace_back(first, y);
    }
    return groups;
}

/// Along the rows go the contents, across them the bands.
SeparableTerms terms_of(const std::vector<RowGroup>& groups, int width, int height) {
    SeparableTerms terms;
    const double middle_x = width * 0.5, middle_y = height * 0.5;
    for (const RowGroup& group : groups) {
        for (const Run& run : group.content)
            terms.x.add(run.first - middle_x, run.last - middle_x, run.value);
        for (const auto& [from, to] : group.bands)
            terms.y.add(from - middle_y, to - middle_y, 1.0f);
        terms.x.close_term();
        terms.y.close_term();
    }
    return terms;
}

Image<float> transposed(ImageView<const float> mask) {
    constexpr int tile = 16;
    Image<float> turned(mask.height, mask.width);
    for (int y0 = 0; y0 < mask.height; y0 += tile) {
        for (int x0 = 0; x0 < mask.width; x0 += tile) {
            for (int y = y0; y < mask.height && y < y0 + tile; ++y) {
                for (int x = x0; x < mask.width && x < x0 + tile; ++x)
                    turned(y, x) = mask(x, y);
            }
        }
    }
    return turned;
}

}  // namespace

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
    const Image<float> turned = transposed(mask);
    SeparableTerms terms = terms_of(group_rows(turned.view()), mask.height, mask.width);
    std::swap(terms.x, terms.y);
    return terms;
}

SeparableTerms separable_terms(ImageView<const float> mask) {
    SeparableTerms columns = distinct_columns(mask), rows = distinct_rows(mask);
    return rows.count() < columns.count() ? rows : columns;
}

}  // namespace obscura
