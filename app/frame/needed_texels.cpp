#include "app/frame/needed_texels.h"

#include <bit>
#include <utility>

#include "app/frame/square_set.h"
#include "core/parallel.h"
#include "filters/kernel_box.h"

namespace obscura {
namespace {

/// Level of the squares whose texels are asked for together.
constexpr int block_level = 3;

void add_boxes(const std::int32_t (&view)[block_samples], const BoxesOnLevel& boxes, SquareSet& squares) {
    for (int group = 0; group < block_groups; ++group) {
        for (std::uint32_t left = boxes.reading[group]; left != 0; left &= left - 1) {
            const int at = group * 16 + std::countr_zero(left), level = boxes.level[at];
            const int shift = level == 0 ? block_level : 0;  // maps are no smaller than a block
            squares.add(view[at], level, boxes.x0[at] >> shift, boxes.y0[at] >> shift, boxes.x1[at] >> shift,
                        boxes.y1[at] >> shift);
        }
    }
}

/// Words of what the samples of one tile read, light by light; none of lights that are given up.
std::vector<std::vector<std::uint64_t>> collect_tile(const TileScene& tiles, std::size_t tile,
                                                     std::span<const PcfLight> lights,
                                                     const std::vector<char>& given_up, Isa isa) {
    std::vector<SquareSet> squares(lights.size());
    TileWork work;  // not initialised: every stage writes what the next one reads
    KernelBoxes boxes;
    for (const SamplePosition sample : tiles.pattern) {
        walk_blocks(tiles, tile, sample, isa, work, [&](const TileRect&, int) {
            for (std::size_t l = 0; l < lights.size(); ++l) {
                if (given_up[l] != 0) continue;
                OBSCURA_DISPATCH(isa, kernel_boxes, work.surface, lights[l], boxes);
                for (const BoxesOnLevel& kernel : boxes.kernel)
                    add_boxes(boxes.view, kernel, squares[l]);
            }
        });
    }
    std::vector<std::vector<std::uint64_t>> words;
    words.reserve(squares.size());
    for (SquareSet& of_light : squares)
        words.push_back(of_light.take_words());
    return words;
}

/// Moves one light's words out of all tiles.
std::vector<std::uint64_t> join(std::vector<std::vector<std::vector<std::uint64_t>>>& tiles,
                                std::size_t light) {
    std::size_t count = 0;
    for (const auto& tile : tiles)
        count += tile[light].size();
    std::vector<std::uint64_t> words;
    words.reserve(count);
    for (auto& tile : tiles) {
        words.insert(words.end(), tile[light].begin(), tile[light].end());
        tile[light] = {};
    }
    return words;
}

/// What tiles collected, tile by tile, and what is known of it.
struct Collected {
    std::vector<std::vector<std::vector<std::uint64_t>>> words;  ///< per tile of all pictures, per light
    std::vector<std::int64_t> squares;                           ///< per light
    std::vector<char> given_up;
};

void collect_picture(const TileScene& tiles, std::span<const PcfLight> lights, const Exec& exec,
                     std::int64_t most_squares, Collected& all) {
    // Rows of tiles one after the other, so that a light that wants too much is known before memory is gone.
    const auto columns = static_cast<std::size_t>(tiles.bins->columns);
    const std::size_t begin = all.words.size();
    all.words.resize(begin + tiles.bins->tiles());
    for (std::size_t first = 0; begin + first < all.words.size(); first += columns) {
        parallel_for(columns, exec, [&](std::size_t i) {
            all.words[begin + first + i] = collect_tile(tiles, first + i, lights, all.given_up, exec.isa);
        });
        for (std::size_t l = 0; l < lights.size(); ++l) {
            for (std::size_t i = begin + first; i < begin + first + columns; ++i)
                all.squares[l] += count_squares(all.words[i][l]);
            if (all.squares[l] > most_squares) all.given_up[l] = 1;
        }
    }
}

}  // namespace

std::vector<std::optional<std::vector<NeededNodes>>> needed_texels(std::span<const TileScene> pictures,
                                                                   std::span<const PcfLight> lights,
                                                                   const Exec& exec,
                                                                   std::int64_t most_squares) {
    Collected all;
    all.squares.resize(lights.size());
    all.given_up.resize(lights.size());
    for (const TileScene& tiles : pictures)
        collect_picture(tiles, lights, exec, most_squares, all);
    std::vector<std::optional<std::vector<NeededNodes>>> needed(lights.size());
    for (std::size_t l = 0; l < lights.size(); ++l) {
        std::vector<std::uint64_t> of_light = join(all.words, l);
        if (all.given_up[l] != 0) continue;
        needed[l] =
            needed_of_words(std::move(of_light), static_cast<std::size_t>(lights[l].views), block_level);
    }
    return needed;
}

}  // namespace obscura
