// Culling of dark blocks before the far field is computed.
//
// L. Scandolo: Compression and rendering with image-based representations (thesis, 2019), section 3.4.3,
// "Culling and Symmetry": the pattern is sampled at 1/8 of its resolution, and blocks are skipped whose power
// and whose power's analytic derivatives are zero there. A dark fringe through a block's centre makes the
// value small while the block is bright: sampling values alone misses most blocks of a pattern of fringes.
//
// Here the test is on the amplitude, to first order: |F| + 4 steps of |dF/du| + 4 steps of |dF/dv| at the
// block's centre. F is the transform of a mask, dF/du that of the mask times -2 pi i x, so both come from the
// same matrix product with the factors' derivatives in place of the factors. First order is not quite enough:
// of a box's pattern up to 8 % of the bright blocks are lost, those whose centre is a zero in u and in v, and
// those whose inner edge is much brighter than their centre. A bright neighbour tells of both, so the eight
// blocks around a bright one are kept as well.

#include "optics/far_field_cull.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

constexpr int block = 8;

/// Adds scale * sqrt(power of the terms' field) to `sum`.
void add_amplitude(const SeparableTerms& terms, const FrequencyGrid& centres, Slope slope, float scale,
                   Image<float>& sum, const Exec& exec) {
    Image<float> power(sum.width, sum.height);
    SeparableParams params;
    params.slope = slope;
    separable_field(terms, centres, params, {nullptr, nullptr, power.pixels.data(), power.width}, exec);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        sum.pixels[i] += scale * std::sqrt(power.pixels[i]);
}

/// The blocks and the eight around each.
BlockSet grown(const BlockSet& set) {
    BlockSet more = set;
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(set.columns) +
               static_cast<std::size_t>(x);
    };
    for (int y = 0; y < set.rows; ++y) {
        for (int x = 0; x < set.columns; ++x) {
            if (set.active[at(x, y)] == 0) continue;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, set.rows - 1); ++j) {
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, set.columns - 1); ++i)
                    more.active[at(i, j)] = 1;
            }
        }
    }
    return more;
}

}  // namespace

BlockSet bright_blocks(const SeparableTerms& terms, const FrequencyGrid& grid, double amplitude,
                       CullTest test, const Exec& exec) {
    BlockSet set;
    set.columns = (grid.width + block - 1) / block;
    set.rows = (grid.height + block - 1) / block;

    // Centres lie 3.5 pixels into a block; a step of the centres' grid is a block.
    const double half = (block - 1) * 0.5;
    const FrequencyGrid centres{set.columns,
                                set.rows,
                                grid.first_u + half * grid.step_u,
                                grid.first_v + half * grid.step_v,
                                block * grid.step_u,
                                block * grid.step_v};
    Image<float> most(set.columns, set.rows);
    add_amplitude(terms, centres, Slope::none, 1.0f, most, exec);
    if (test != CullTest::value) {
        add_amplitude(terms, centres, Slope::u, 0.5f, most, exec);
        add_amplitude(terms, centres, Slope::v, 0.5f, most, exec);
    }

    const auto limit = static_cast<float>(amplitude);
    for (const float value : most.pixels)
        set.active.push_back(value > limit ? 1 : 0);
    return test == CullTest::with_neighbours ? grown(set) : set;
}

std::int64_t active_count(const BlockSet& blocks) {
    return std::count(blocks.active.begin(), blocks.active.end(), std::uint8_t{1});
}

}  // namespace obscura
