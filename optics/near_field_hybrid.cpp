// Near field of runs: along x closed forms, along y convolution.
//
// A row of the mask is a sum of runs, whose share at every x' is a difference of table rows, taken in double.
// That leaves a one-dimensional problem per column of pixels: to convolve the rows' shares with the chirp in
// y. Sixteen columns go through the transforms at a time, and through the caches only once.
//
// The arithmetic of the two-dimensional FFT (forward, product, backward, at twice the size in both axes)
// shrinks to three one-dimensional transforms of half as many pixels at two pixels per texel.

#include "core/parallel.h"
#include "optics/field/line_sums.h"
#include "optics/field/mask_changes.h"
#include "optics/near_field_convolve.h"
#include "optics/near_field_methods.h"

namespace obscura {

void near_field_hybrid(const NearFieldCase& c, const FieldTarget& target, const Exec& exec) {
    const LineChanges& changes = c.changes;
    const EdgeTable table(c.horizontal(), c.turns, distinct_edges(changes, c.mask.width), exec);
    std::vector<std::int64_t> offsets(changes.edge.size());
    for (std::size_t i = 0; i < offsets.size(); ++i)
        offsets[i] = table.offset(changes.edge[i]);
    // 1 / (i lambda z) becomes 1 / (2 i) with Fresnel integrals; a run is its end less its beginning, the sum
    // of its changes is the opposite.
    const ColumnConvolution convolution(c.vertical(), c.turns, {0, 0.5}, exec.isa);

    const int width = part_to_compute(c).columns;
    const bool mirrored = width < c.grid.width;
    parallel_blocks(
        static_cast<std::size_t>(width), ColumnTile::columns, exec, [&](std::size_t begin, std::size_t end) {
            ColumnScratch scratch(convolution.length());
            ColumnTile tile(c.grid.height, target);
            for (std::size_t x = begin; x < end; x += 16) {
                const LineSums sums{c.mask.height,         changes.first.data(), offsets.data(),
                                    changes.weight.data(), table.re_base() + x,  table.im_base() + x};
                OBSCURA_DISPATCH(exec.isa, sum_lines16, sums, scratch.re.data(), scratch.im.data());
                convolution.run(scratch, static_cast<std::ptrdiff_t>(x - begin), tile.target(), exec.isa);
            }
            const auto first = static_cast<std::ptrdiff_t>(begin);
            tile.copy_to(target, first, static_cast<int>(end - begin),
                         mirrored ? c.grid.width - 1 - first : -1);
        });
}

}  // namespace obscura
