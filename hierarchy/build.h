#pragma once
// The tree of a light view straight from triangles, without rasterizing every texel.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "hierarchy/certain_tree.h"
#include "hierarchy/multires.h"
#include "hierarchy/needed_nodes.h"
#include "raster/intervals.h"

namespace obscura {

/// What became of a square, for lessons and pictures.
struct BuildSquare {
    enum Fate : std::uint8_t { divided, nothing, cover, mesh, rasterized, not_needed } fate = divided;
    std::int32_t x0 = 0, y0 = 0, side = 1;
};

/// How work is cut into pieces. Nothing of it changes the tree; the defaults are fast.
struct BuildTuning {
    std::size_t open_squares = 256;      ///< upper squares are divided until so many are left to do
    std::int32_t smallest_task = 64;     ///< but not below this side
    std::int32_t block_side = 8;         ///< squares up to this side are rasterized: a power of two in [1, 8]
    std::int32_t tile_side = 64;         ///< and dense lists in squares up to this one: in [1, 64]
    std::int32_t texels_per_facet = 16;  ///< a list is dense where it has fewer texels than these
    std::size_t longest_surface = 1024;  ///< longer lists are not searched for surfaces of several facets
};

struct BuildParams {
    Receivers receivers = Receivers::any;
    bool only_casters = true;
    const NeededNodes* needed = nullptr;  ///< build only what these need; null: everything
    /// Stop with LimitError when the tree gets more nodes than this. Open sheets under any receivers have a
    /// node for every few texels, and no estimate beforehand can tell.
    std::uint64_t max_nodes = UINT64_MAX;
    /// Trees of certain squares: detail below what is certain ends at squares of 2^detail_height texels a
    /// side.
    int detail_height = 0;
    bool keep_intervals = false;   ///< MultiresTree::intervals
    bool mesh_certificate = true;  ///< false: only single planes decide squares, to see what the rest gains
    BuildTuning tuning;
    std::vector<BuildSquare>* trace = nullptr;  ///< receives every square that was visited, parents first
};

/// What a construction did: exact counts, the same for any exec.
struct BuildStats {
    std::uint64_t nodes_visited = 0;
    std::uint64_t certified_cover = 0;  ///< squares decided by single planes that cover them
    std::uint64_t certified_mesh = 0;   ///< squares decided by surfaces of several triangles
    std::uint64_t texels_rasterized = 0;
    std::uint64_t list_operations = 0;  ///< facet-square tests
    std::uint64_t facets = 0;           ///< triangles and pairs that reach the map
    double setup_s = 0, build_s = 0;    ///< seconds of wall clock

    BuildStats& operator+=(const BuildStats& s) {
        nodes_visited += s.nodes_visited;
        certified_cover += s.certified_cover;
        certified_mesh += s.certified_mesh;
        texels_rasterized += s.texels_rasterized;
        list_operations += s.list_operations;
        facets += s.facets;
        setup_s += s.setup_s;
        build_s += s.build_s;
        return *this;
    }
};

/// The multiresolution hierarchy of `mesh` seen from `view` (square, a power of two in [1, 2^20] a side):
/// equal bit for bit to build_bottom_up() over interval_map(), for any exec. Memory follows the tree, not the
/// map. When `cancel` is set meanwhile, the result has no meaning.
MultiresTree build_shadow_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                               const Exec& exec, BuildStats* stats = nullptr,
                               const std::atomic<bool>* cancel = nullptr);

/// The same construction without the choice of depths: multires_of() of the result is build_shadow_tree()'s.
/// `params.needed` must be null; `params.max_nodes` counts groups of four squares.
CertainTree build_certain_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                               const Exec& exec, BuildStats* stats = nullptr,
                               const std::atomic<bool>* cancel = nullptr);

}  // namespace obscura
