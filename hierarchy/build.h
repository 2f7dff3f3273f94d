#pragma once
// The tree of a light view straight from triangles, without rasterizing every texel.

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "core/types.h"
#include "hierarchy/multires.h"

namespace obscura {

/// Squares of a map whose values will be asked for: at level 0 texels, at level l squares of 2^l texels whose
/// own value (a descent that stops there) is wanted, not what lies below it.
class NeededNodes {
  public:
    /// x, y in squares of that level.
    void add(std::uint32_t x, std::uint32_t y, int level);
    /// Sorts, drops repetitions; call before building.
    void finish();
    /// Sorted by the first texel's Morton code (x in the even bits), then level: code << 5 | level.
    const std::vector<std::uint64_t>& codes() const { return codes_; }

  private:
    std::vector<std::uint64_t> codes_;
};

struct BuildParams {
    Receivers receivers = Receivers::any;
    bool only_casters = true;
    const NeededNodes* needed = nullptr;  ///< build only what these need; null: everything
};

/// What a construction did: exact counts, the same for any exec.
struct BuildStats {
    std::uint64_t nodes_visited = 0;
    std::uint64_t certified_cover = 0;  ///< squares decided by single planes that cover them
    std::uint64_t certified_mesh = 0;   ///< squares decided by surfaces of several triangles
    std::uint64_t texels_rasterized = 0;
    std::uint64_t list_operations = 0;  ///< record-square tests
    double setup_s = 0, build_s = 0;    ///< seconds of wall clock
};

/// The multiresolution hierarchy of `mesh` seen from `view` (square, a power of two in [1, 2^20] a side):
/// equal bit for bit to build_bottom_up() over interval_map(), for any exec. Memory follows the tree, not the
/// map. When `cancel` is set meanwhile, the result has no meaning.
MultiresTree build_shadow_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                               const Exec& exec, BuildStats* stats = nullptr,
                               const std::atomic<bool>* cancel = nullptr);

}  // namespace obscura
