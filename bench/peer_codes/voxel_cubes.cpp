#include "bench/peer_codes/voxel_cubes.h"

#include <algorithm>

#include "core/error.h"

namespace obscura {
namespace {

constexpr std::uint32_t octant_of(std::uint32_t x, std::uint32_t y, std::uint32_t z, int level) {
    return (x >> level & 1u) | (y >> level & 1u) << 1 | (z >> level & 1u) << 2;
}

/// Eight voxels as bits.
std::uint32_t voxel_bits(const Octants& voxels) {
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < voxels.size(); ++i)
        bits |= (voxels[i] == CubeId::lit ? 1u : 0u) << i;
    return bits;
}

/// 64 voxels as bits, from cubes of eight.
std::uint64_t leaf_bits(const Octants& cubes) {
    std::uint64_t bits = 0;
    for (unsigned i = 0; i < cubes.size(); ++i) {
        const std::uint64_t eight = cubes[i] == CubeId::lit ? 0xffu
                                    : is_mixed(cubes[i])    ? number_of(cubes[i])
                                                            : 0;
        bits |= eight << (8 * i);
    }
    return bits;
}

}  // namespace

std::size_t CubeTable::HashOctants::operator()(const Octants& octants) const {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (const CubeId id : octants) {
        hash = (hash ^ static_cast<std::uint64_t>(id)) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
}

CubeTable::CubeTable(int levels) : levels_(static_cast<std::size_t>(std::max(levels - leaf_level, 0))) {}

CubeId CubeTable::cube(int level, const Octants& octants) {
    const auto none = [&](CubeId id) {
        return std::find(octants.begin(), octants.end(), id) == octants.end();
    };
    const bool mixed = std::any_of(octants.begin(), octants.end(), is_mixed);
    if (!mixed && none(CubeId::lit)) return none(CubeId::shadow) ? CubeId::free : CubeId::shadow;
    if (!mixed && none(CubeId::shadow)) return CubeId::lit;
    if (level < leaf_level) return mixed_cube(voxel_bits(octants));
    if (level == leaf_level) {
        const std::uint64_t bits = leaf_bits(octants);
        const auto [found, is_new] =
            leaf_numbers_.try_emplace(bits, static_cast<std::uint32_t>(leaves_.size()));
        if (is_new) leaves_.push_back(bits);
        return mixed_cube(found->second);
    }
    Octants settled = octants;
    std::replace(settled.begin(), settled.end(), CubeId::free, CubeId::shadow);
    Level& table = levels_[static_cast<std::size_t>(level - leaf_level - 1)];
    const auto [found, is_new] =
        table.numbers.try_emplace(settled, static_cast<std::uint32_t>(table.cubes.size()));
    if (is_new) table.cubes.push_back(settled);
    return mixed_cube(found->second);
}

bool CubeTable::lit(int level, CubeId cube, std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    while (is_mixed(cube) && level > leaf_level) {
        const Level& table = levels_[static_cast<std::size_t>(level - leaf_level - 1)];
        cube = table.cubes[number_of(cube)][octant_of(x, y, z, --level)];
    }
    if (!is_mixed(cube)) return cube == CubeId::lit;
    const std::uint32_t voxel = octant_of(x, y, z, 0);
    if (level < leaf_level) return (number_of(cube) >> voxel & 1u) != 0;
    return (leaves_[number_of(cube)] >> (8 * octant_of(x, y, z, 1) + voxel) & 1u) != 0;
}

std::size_t CubeTable::count(int level) const {
    if (level == leaf_level) return leaves_.size();
    return levels_[static_cast<std::size_t>(level - leaf_level - 1)].cubes.size();
}

std::vector<std::vector<bool>> CubeTable::marks(CubeId root) const {
    std::vector<std::vector<bool>> marks;
    for (std::size_t level = 0; level <= levels_.size(); ++level)
        marks.emplace_back(count(leaf_level + static_cast<int>(level)), false);
    if (is_mixed(root) && !marks.back().empty()) marks.back()[number_of(root)] = true;
    for (std::size_t level = levels_.size(); level-- > 0;) {
        for (std::size_t i = 0; i < levels_[level].cubes.size(); ++i) {
            if (!marks[level + 1][i]) continue;
            for (const CubeId id : levels_[level].cubes[i])
                if (is_mixed(id)) marks[level][number_of(id)] = true;
        }
    }
    return marks;
}

std::vector<std::size_t> CubeTable::reached(CubeId root) const {
    std::vector<std::size_t> counts;
    for (const std::vector<bool>& level : marks(root))
        counts.push_back(static_cast<std::size_t>(std::count(level.begin(), level.end(), true)));
    return counts;
}

std::uint64_t CubeTable::bytes(CubeId root) const {
    const std::vector<std::vector<bool>> marks = this->marks(root);
    auto words = 2 * static_cast<std::uint64_t>(std::count(marks[0].begin(), marks[0].end(), true));
    for (std::size_t level = 0; level < levels_.size(); ++level) {
        for (std::size_t i = 0; i < levels_[level].cubes.size(); ++i) {
            const Octants& octants = levels_[level].cubes[i];
            if (marks[level + 1][i])
                words +=
                    1 + static_cast<std::uint64_t>(std::count_if(octants.begin(), octants.end(), is_mixed));
        }
    }
    return 4 * words;
}

}  // namespace obscura
