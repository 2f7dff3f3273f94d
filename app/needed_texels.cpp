#include "app/needed_texels.h"

#include <algorithm>

#include "core/parallel.h"
#include "filters/pcf_place.h"

namespace obscura {
namespace {

/// Level of the squares whose texels are asked for together.
constexpr int block_level = 3;

/// Squares of one view: level, y, x from the highest bits down. Sorted and unique after tidy().
struct SquareList {
    static constexpr int place_bits = 28;
    static constexpr std::uint64_t place_mask = (std::uint64_t{1} << place_bits) - 1;
    std::vector<std::uint64_t> squares;
    /// Some that are in the list, so that few come in twice; not needed once it is full.
    std::vector<std::uint64_t> recent = std::vector<std::uint64_t>(256, ~std::uint64_t{0});

    /// Level 0 stands for a block of texels.
    void add(int level, std::int32_t x, std::int32_t y) {
        const auto square = (static_cast<std::uint64_t>(level) << place_bits | static_cast<std::uint64_t>(y))
                                << place_bits |
                            static_cast<std::uint64_t>(x);
        std::uint64_t& same_slot =
            recent[(static_cast<std::uint64_t>(x) + static_cast<std::uint64_t>(y) * 17) & 255];
        if (same_slot == square) return;
        same_slot = square;
        squares.push_back(square);
    }
    void tidy() {
        std::sort(squares.begin(), squares.end());
        squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
    }
    void add_to(NeededNodes& needed) const {
        for (const std::uint64_t square : squares) {
            const auto x = static_cast<std::uint32_t>(square & place_mask),
                       y = static_cast<std::uint32_t>(square >> place_bits & place_mask);
            const auto level = static_cast<int>(square >> (2 * place_bits));
            if (level == 0) {
                needed.add_texels(x, y, block_level);
            } else {
                needed.add(x, y, level);
            }
        }
    }
};

/// First and last square of a kernel along one axis, as the map holds them; none when first > last.
struct Run {
    std::int32_t first, last;
};

Run run_of(std::int32_t first, int side, std::int32_t size, bool directional) {
    const std::int32_t last = first + side - 1;
    // Taps of lamps are clamped into their map; those of parallel light outside of it read nothing.
    if (!directional) return {std::clamp(first, 0, size - 1), std::clamp(last, 0, size - 1)};
    return {std::max(first, 0), std::min(last, size - 1)};
}

void add_kernel(const PcfLight& light, const ref::PcfPlace& place, int level, SquareList& list) {
    const ref::Kernel kernel(place, light.side, level);
    const std::int32_t size = light.view[place.view].size >> level;
    const Run x = run_of(kernel.x0, kernel.side, size, light.directional),
              y = run_of(kernel.y0, kernel.side, size, light.directional);
    if (x.first > x.last || y.first > y.last) return;
    const int shift = level == 0 ? block_level : 0;  // maps are no smaller than a block
    for (std::int32_t by = y.first >> shift; by <= y.last >> shift; ++by) {
        for (std::int32_t bx = x.first >> shift; bx <= x.last >> shift; ++bx)
            list.add(level, bx, by);
    }
}

/// All kernels of one lookup.
void add_lookup(const PcfLight& light, const ref::PcfPlace& place, SquareList& list) {
    if (light.filter == PcfFilter::pcf) return add_kernel(light, place, 0, list);
    const ref::Levels levels = ref::levels_of(place);
    add_kernel(light, place, levels.fine, list);
    if (levels.blend != 0.0f) add_kernel(light, place, levels.fine + 1, list);
}

/// One light's lists, one per view.
using ViewLists = std::vector<SquareList>;

/// What the samples of one tile read of every light's views; nothing of lights that are given up.
std::vector<ViewLists> collect_tile(const TileScene& tiles, std::size_t tile,
                                    std::span<const PcfLight> lights, const std::vector<char>& given_up,
                                    Isa isa) {
    std::vector<ViewLists> lists;
    for (const PcfLight& light : lights)
        lists.emplace_back(static_cast<std::size_t>(light.views));
    TileWork work;  // not initialised: every stage writes what the next one reads
    for (const SamplePosition sample : tiles.pattern) {
        walk_tile(tiles, tile, sample, isa, work, [&](int, int, int at) {
            for (std::size_t l = 0; l < lights.size(); ++l) {
                if (given_up[l] != 0) continue;
                const ref::PcfPlace place = ref::pcf_place(work.surface, lights[l], at);
                if (place.kind != ref::PcfPlace::on_map) continue;
                add_lookup(lights[l], place, lists[l][static_cast<std::size_t>(place.view)]);
            }
        });
        for (ViewLists& of_light : lists) {
            for (SquareList& list : of_light)
                list.tidy();
        }
    }
    for (ViewLists& of_light : lists) {
        for (SquareList& list : of_light) {
            list.squares.shrink_to_fit();
            list.recent = {};
        }
    }
    return lists;
}

/// Joins the lists of all tiles.
std::vector<NeededNodes> join(const std::vector<std::vector<ViewLists>>& tiles, std::size_t light,
                              std::size_t views) {
    std::vector<NeededNodes> needed(views);
    for (std::size_t v = 0; v < views; ++v) {
        for (const std::vector<ViewLists>& tile : tiles)
            tile[light][v].add_to(needed[v]);
        needed[v].finish();
    }
    return needed;
}

}  // namespace

std::vector<std::optional<std::vector<NeededNodes>>> needed_texels(const TileScene& tiles,
                                                                   std::span<const PcfLight> lights,
                                                                   const Exec& exec,
                                                                   std::int64_t most_squares) {
    // Rows of tiles one after the other, so that a light that wants too much is known before memory is gone.
    const auto columns = static_cast<std::size_t>(tiles.bins->columns);
    std::vector<std::vector<ViewLists>> lists(tiles.bins->tiles());
    std::vector<std::int64_t> squares(lights.size(), 0);
    std::vector<char> given_up(lights.size(), 0);
    for (std::size_t first = 0; first < lists.size(); first += columns) {
        parallel_for(columns, exec, [&](std::size_t i) {
            lists[first + i] = collect_tile(tiles, first + i, lights, given_up, exec.isa);
        });
        for (std::size_t l = 0; l < lights.size(); ++l) {
            for (std::size_t i = first; i < first + columns; ++i) {
                for (const SquareList& list : lists[i][l])
                    squares[l] += static_cast<std::int64_t>(list.squares.size());
            }
            if (squares[l] > most_squares) given_up[l] = 1;
        }
    }
    std::vector<std::optional<std::vector<NeededNodes>>> needed(lights.size());
    for (std::size_t l = 0; l < lights.size(); ++l) {
        if (given_up[l] == 0) needed[l] = join(lists, l, static_cast<std::size_t>(lights[l].views));
    }
    return needed;
}

}  // namespace obscura
