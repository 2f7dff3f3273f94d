#pragma once
// Intervals of any 64 x 64 texels of a view of any size, again and again: triangles are set up and binned
// once. The rasterizer's own tiles, without anything of the hierarchy.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "raster/bin.h"
#include "raster/interval_map.h"
#include "raster/setup.h"

namespace obscura {

class RegionOracle {
  public:
    static constexpr int side = layer_tile_side;

    RegionOracle(const Mesh& mesh, const LightView& view, Receivers receivers) : receivers_(receivers) {
        SetupParams params;
        params.only_casters = true;
        params.pair_faces = true;
        setup_triangles(mesh, view, params, Exec{}, setup_);
        bin_records(setup_, {0, 0, view.width, view.height}, std::max(side, view.width / 128), Exec{}, bins_);
    }

    /// Row by row; x, y need not be aligned to anything.
    const std::vector<DepthInterval>& intervals(int x, int y) {
        list_.clear();
        const int last_x = (x + side - 1) / bins_.tile, last_y = (y + side - 1) / bins_.tile;
        for (int r = y / bins_.tile; r <= last_y; ++r) {
            for (int c = x / bins_.tile; c <= last_x; ++c) {
                const auto bin = bins_.list(bins_.index(c, r));
                list_.insert(list_.end(), bin.begin(), bin.end());
            }
        }
        std::sort(list_.begin(), list_.end());
        list_.erase(std::unique(list_.begin(), list_.end()), list_.end());
        // Of a bin of thousands of texels a side, most records are elsewhere.
        list_.erase(std::remove_if(list_.begin(), list_.end(),
                                   [&](std::uint32_t i) { return !near(&setup_.records[i], x, y); }),
                    list_.end());
        out_.resize(side * side);
        tiler_.run(setup_, list_, {x, y, side, side}, receivers_, Isa::sse2, out_.data());
        return out_;
    }

  private:
    static bool near(const TriangleRecord* t, int x, int y) {
        const auto meets = [&](const TriangleRecord& r) {
            return std::min({r.x[0], r.x[1], r.x[2]}) <= (x + side) * subtexel_one &&
                   std::max({r.x[0], r.x[1], r.x[2]}) >= x * subtexel_one &&
                   std::min({r.y[0], r.y[1], r.y[2]}) <= (y + side) * subtexel_one &&
                   std::max({r.y[0], r.y[1], r.y[2]}) >= y * subtexel_one;
        };
        return meets(t[0]) || (t[0].paired && meets(t[1]));
    }

    Receivers receivers_;
    TriangleSetup setup_;
    TileBins bins_;
    IntervalTiler tiler_;
    std::vector<std::uint32_t> list_;
    std::vector<DepthInterval> out_;
};

}  // namespace obscura
