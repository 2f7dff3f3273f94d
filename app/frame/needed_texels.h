#pragma once
// scope = "frame": the parts of a light's map that a picture's lookups read.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/frame/tile.h"
#include "core/isa.h"
#include "hierarchy/needed_nodes.h"

namespace obscura {

/// A collection that would become larger than this is given up: the whole map is built then.
constexpr std::int64_t most_needed_squares = std::int64_t{1} << 24;

/// For every light what is read of each of its views, ready for building: what the kernels of all samples of
/// these pictures read, as the lookups' own code places them (filters/kernel_box.h). Texels come in blocks
/// of 8 x 8, which construction makes whole anyway; of coarser levels (hierarchical filtering) single
/// squares. `lights` need no stored depths. A light without a value wants more than `most_squares` of these.
/// The same for any exec.
std::vector<std::optional<std::vector<NeededNodes>>> needed_texels(
    std::span<const TileScene> pictures, std::span<const PcfLight> lights, const Exec& exec,
    std::int64_t most_squares = most_needed_squares);

/// Of one picture.
inline std::vector<std::optional<std::vector<NeededNodes>>> needed_texels(
    const TileScene& tiles, std::span<const PcfLight> lights, const Exec& exec,
    std::int64_t most_squares = most_needed_squares) {
    return needed_texels(std::span(&tiles, 1), lights, exec, most_squares);
}

}  // namespace obscura
