#include "bench/peer_codes/voxel_dag.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/error.h"

namespace obscura {
namespace {

constexpr CubeId unknown = static_cast<CubeId>(0xffffffffu);

VoxelRange common_range(VoxelRange a, VoxelRange b) {
    return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

/// The common ranges of all squares above the smallest.
void fill_upper(std::vector<Image<VoxelRange>>& pyramid) {
    while (pyramid.back().width > 1) {
        const Image<VoxelRange>& below = pyramid.back();
        Image<VoxelRange> above(below.width / 2, below.height / 2);
        for (int y = 0; y < above.height; ++y) {
            const VoxelRange *upper = below.row(2 * y), *lower = below.row(2 * y + 1);
            for (int x = 0; x < above.width; ++x) {
                above(x, y) = common_range(common_range(upper[2 * x], upper[2 * x + 1]),
                                           common_range(lower[2 * x], lower[2 * x + 1]));
            }
        }
        pyramid.push_back(std::move(above));
    }
}

/// The boundary of a range at which the largest cubes end.
std::uint32_t roundest(VoxelRange range) {
    const auto first = static_cast<std::uint32_t>(range.first);
    auto boundary = static_cast<std::uint32_t>(range.last);
    while (boundary != 0 && (boundary & (boundary - 1)) >= first)
        boundary &= boundary - 1;
    return boundary;
}

/// Cubes up to `end` as a run of their own, or part of the last.
void append(CubeRuns& runs, std::uint32_t end, CubeId id) {
    if (!runs.empty() && runs.back().id == id) {
        runs.back().end = end;
    } else if (end > (runs.empty() ? 0 : runs.back().end)) {
        runs.push_back({end, id});
    }
}

}  // namespace

VoxelRange voxel_range(DepthInterval interval, int levels) {
    // Exact: times a power of two.
    const auto side = static_cast<float>(1 << levels);
    const float entry = interval.entry * side, exit = interval.exit * side;
    const auto below = static_cast<std::int32_t>(entry);
    return {below + (static_cast<float>(below) < entry ? 1 : 0), static_cast<std::int32_t>(exit)};
}

VoxelDag::VoxelDag(int levels)
    : levels_(levels), cubes_(levels), uniform_cubes_(static_cast<std::size_t>(levels) + 1) {
    CHECK(levels > leaf_level && levels <= 20);
}

void VoxelDag::quantise(ImageView<const DepthInterval> texels, Image<VoxelRange>& ranges) {
    for (int y = 0; y < texels.height; ++y) {
        for (int x = 0; x < texels.width; ++x) {
            VoxelRange range = voxel_range(texels(x, y), levels_);
            rounded_ += range.empty() ? 1 : 0;
            range.last = std::max(range.first, range.last);
            ranges(x, y) = range;
        }
    }
}

/// The cubes behind a square, in cubes of its side. `smallest`: those behind a square of ranges[0], of
/// 2^lowest texels a side, that has no common range.
template <class Smallest>
CubeRuns VoxelDag::square(const Pyramid& ranges, int lowest, int level, int x, int y,
                          const Smallest& smallest) {
    const VoxelRange range = ranges[static_cast<std::size_t>(level - lowest)](x, y);
    if (!range.empty()) return uniform(level, range);
    if (level == lowest) return smallest(x, y);
    CubeRuns quadrant[4];
    for (int i = 0; i < 4; ++i)
        quadrant[i] = square(ranges, lowest, level - 1, 2 * x + (i & 1), 2 * y + (i >> 1), smallest);
    return join(level, quadrant);
}

void VoxelDag::add_band(ImageView<const DepthInterval> band) {
    const int side = band.height;
    CHECK(band.width == 1 << levels_ && std::has_single_bit(static_cast<unsigned>(side)));
    CHECK(tile_levels_ < 0 || side == 1 << tile_levels_);
    tile_levels_ = std::countr_zero(static_cast<unsigned>(side));
    const auto texel = [](int, int) -> CubeRuns {
        CHECK(false, "a texel has a range");
        return {};
    };
    for (int x0 = 0; x0 < band.width; x0 += side) {
        Pyramid ranges;
        ranges.emplace_back(side, side);
        quantise(band.crop(x0, 0, side, side), ranges[0]);
        fill_upper(ranges);
        tile_ranges_.push_back(ranges.back()(0, 0));
        tiles_.push_back(square(ranges, 0, tile_levels_, 0, 0, texel));
    }
}

void VoxelDag::finish() {
    const int tiles = 1 << (levels_ - tile_levels_);
    CHECK(tiles_.size() == static_cast<std::size_t>(tiles) * static_cast<std::size_t>(tiles));
    Pyramid ranges;
    ranges.emplace_back(tiles, tiles);
    ranges[0].pixels = std::move(tile_ranges_);
    fill_upper(ranges);
    const CubeRuns all = square(ranges, tile_levels_, levels_, 0, 0, [&](int x, int y) {
        return std::move(tiles_[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles) +
                                static_cast<std::size_t>(x)]);
    });
    CHECK(all.size() == 1 && all[0].end == 1);
    root_ = all[0].id;
    tiles_.clear();
}

/// All texels may turn dark at any boundary of the range: where one lies between cubes, none is mixed.
CubeRuns VoxelDag::uniform(int level, VoxelRange range) {
    const std::uint32_t cubes = 1u << (levels_ - level), side = 1u << level;
    const std::uint32_t lit = static_cast<std::uint32_t>(range.last) >> level;
    const std::uint32_t dark = (static_cast<std::uint32_t>(range.first) + side - 1) >> level;
    CubeRuns runs;
    append(runs, std::min(dark, lit), CubeId::lit);
    append(runs, lit, CubeId::free);
    if (dark > lit) append(runs, dark, uniform_cube(level, roundest(range) - lit * side));
    append(runs, cubes, CubeId::shadow);
    return runs;
}

/// A cube that turns dark at one boundary, strictly inside it.
CubeId VoxelDag::uniform_cube(int level, std::uint32_t boundary) {
    std::vector<CubeId>& known = uniform_cubes_[static_cast<std::size_t>(level)];
    if (known.empty()) known.assign(std::size_t{1} << level, unknown);
    if (known[boundary] != unknown) return known[boundary];
    const std::uint32_t half = 1u << (level - 1);
    const CubeId nearer = boundary >= half ? CubeId::lit : uniform_cube(level - 1, boundary);
    const CubeId farther = boundary <= half ? CubeId::shadow : uniform_cube(level - 1, boundary - half);
    return known[boundary] =
               cubes_.cube(level, {nearer, nearer, nearer, nearer, farther, farther, farther, farther});
}

/// Four squares as one: its cubes are two deep in theirs. Where nothing changes for long, neither do they.
CubeRuns VoxelDag::join(int level, const CubeRuns (&quadrant)[4]) {
    const std::uint32_t count = 1u << (levels_ - level + 1);
    const CubeRun* run[4];
    for (int i = 0; i < 4; ++i)
        run[i] = quadrant[i].data();
    Octants octants;
    /// Puts the quadrants' cubes at z into their half of the octants; returns where one of them changes.
    const auto take = [&](std::uint32_t z, std::size_t half) {
        std::uint32_t end = count;
        for (std::size_t i = 0; i < 4; ++i) {
            while (run[i]->end <= z)
                ++run[i];
            octants[4 * half + i] = run[i]->id;
            end = std::min(end, run[i]->end);
        }
        return end;
    };
    CubeRuns runs;
    for (std::uint32_t z = 0; z < count;) {
        const std::uint32_t end = take(z, 0);
        take(z + 1, 1);
        z += end >= z + 2 ? (end - z) / 2 * 2 : 2;
        append(runs, z / 2, cubes_.cube(level, octants));
    }
    return runs;
}

}  // namespace obscura
