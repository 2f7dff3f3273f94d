// Near field by fast Fourier transforms alone: the baseline, and what is left when a mask has too many edges.
//
// The kernel is integrated over texels, so it is exact and twice the mask is padding enough. Kernels that
// sample the chirp instead need it sampled finely wherever it reaches: the eightfold padding of the thesis
// (section 3.5.2, figure 3.12) is the price of that, not of the problem.

#include <algorithm>

#include "core/parallel.h"
#include "optics/near_field_convolve.h"
#include "optics/near_field_methods.h"

namespace obscura {
namespace {

/// Sixteen rows of the mask from row y on, one per lane; rows beyond it are closed.
void load_rows(ImageView<const float> mask, int y, ColumnScratch& scratch) {
    std::fill_n(scratch.re.data(), 16 * mask.width, 0.0f);
    std::fill_n(scratch.im.data(), 16 * mask.width, 0.0f);
    for (int lane = 0; lane < std::min(16, mask.height - y); ++lane) {
        const float* row = mask.row(y + lane);
        float* to = scratch.re.data() + lane;
        for (int x = 0; x < mask.width; ++x)
            to[16 * x] = row[x];
    }
}

/// Sixteen rows of `from` as lanes: element k of lane l is from(k, first + l).
void load_lanes(const Raster<float>& from, int first, int lanes, int length, float* to) {
    std::fill_n(to, 16 * length, 0.0f);
    for (int lane = 0; lane < lanes; ++lane) {
        const float* row = from.pixels.data() + static_cast<std::ptrdiff_t>(from.width) * (first + lane);
        for (int k = 0; k < length; ++k)
            to[16 * k + lane] = row[k];
    }
}

}  // namespace

void near_field_fft(const NearFieldCase& c, const FieldTarget& target, const Exec& exec) {
    const ColumnConvolution along_x(c.horizontal(), c.turns, {1, 0}, exec.isa);
    const ColumnConvolution along_y(c.vertical(), c.turns, {0, -0.5}, exec.isa);

    // Row x' of these holds what all rows of the mask send to x'.
    const int padded = (c.mask.height + 15) / 16 * 16;
    Raster<float> re(padded, c.grid.width), im(padded, c.grid.width);
    parallel_for(static_cast<std::size_t>(padded / 16), exec, [&](std::size_t g) {
        ColumnScratch scratch(along_x.length());
        load_rows(c.mask, static_cast<int>(16 * g), scratch);
        along_x.run(scratch, static_cast<std::ptrdiff_t>(16 * g),
                    {re.pixels.data(), im.pixels.data(), nullptr, padded}, exec.isa);
    });

    const auto width = static_cast<std::size_t>(c.grid.width);
    parallel_blocks(width, ColumnTile::columns, exec, [&](std::size_t begin, std::size_t end) {
        ColumnScratch scratch(along_y.length());
        ColumnTile tile(c.grid.height, target);
        for (std::size_t x = begin; x < end; x += 16) {
            const int lanes = static_cast<int>(std::min<std::size_t>(16, end - x));
            load_lanes(re, static_cast<int>(x), lanes, c.mask.height, scratch.re.data());
            load_lanes(im, static_cast<int>(x), lanes, c.mask.height, scratch.im.data());
            along_y.run(scratch, static_cast<std::ptrdiff_t>(x - begin), tile.target(), exec.isa);
        }
        tile.copy_to(target, static_cast<std::ptrdiff_t>(begin), static_cast<int>(end - begin), -1);
    });
}

}  // namespace obscura
