#include "filters/convolution_fft.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/buffer.h"
#include "core/parallel.h"
#include "filters/convolution_lanes.h"
#include "filters/fft.h"

namespace obscura {
namespace {

/// A rectangle of complex numbers as groups of sixteen columns, each [row][column], so that transforms along
/// y run where the numbers are. Groups are a block further apart than they need: at a power of two the
/// sixteen rows of all groups would compete for the same few lines of the cache.
struct Tile {
    int width, height;
    std::ptrdiff_t group_step;
    Buffer<float> re, im;
    Tile(int width_, int height_)
        : width(width_),
          height(height_),
          group_step(16 * std::ptrdiff_t{height_} + 256),
          re(static_cast<std::size_t>(width_ / 16 * group_step)),
          im(re.size()) {}
    int groups() const { return width / 16; }
};

/// A transform in the order that convolve_rows() meets it: sixteen rows at a time, [column][row].
struct Spectrum {
    Buffer<float> re, im;
};

struct Rectangle {
    int x, y;  ///< of the tile's first pixel, in the source or the result
};

struct Convolver {
    const ChannelConvolution& channel;
    const ConvolutionPlan& plan;
    const FftPlan &along_x, &along_y;
    Spectrum& spectrum;

    int width() const { return along_x.length(); }
    int height() const { return along_y.length(); }
    /// Pixels of a tile before the valid ones: what wraps around. None does into a tile that holds
    /// everything.
    int lead_x() const { return plan.tiles_x == 1 ? 0 : channel.kernel.width - 1; }
    int lead_y() const { return plan.tiles_y == 1 ? 0 : channel.kernel.height - 1; }
    int valid_width() const { return width() - lead_x(); }
    int valid_height() const { return height() - lead_y(); }
    Rectangle tile(int i) const {
        return {i % plan.tiles_x * valid_width(), i / plan.tiles_x * valid_height()};
    }
};

/// Column by column of a group, zeros where the channel has no pixels. True when any is not 0.
bool load_group(const Channel<const float>& from, const Rectangle& at, int group, int height, float* to) {
    const int x0 = at.x + 16 * group;
    const int begin = std::clamp(-x0, 0, 16), end = std::clamp(from.width - x0, 0, 16);
    bool any = false;
    for (int y = 0; y < height; ++y, to += 16) {
        std::fill_n(to, 16, 0.0f);
        if (at.y + y < 0 || at.y + y >= from.height || begin >= end) continue;
        const float* const row = from.row(at.y + y) + from.step * x0;
        for (int x = begin; x < end; ++x) {
            to[x] = row[from.step * x];
            any |= to[x] != 0.0f;
        }
    }
    return any;
}

/// Columns of a group that are valid in the tile and exist in the result.
void store_group(const Convolver& c, const Rectangle& at, int group, const float* from) {
    const int first_x = c.lead_x(), first_y = c.lead_y();
    const int x0 = at.x - first_x + 16 * group;  // in the result
    const int begin = std::max(first_x - 16 * group, 0), end = std::min(c.channel.out.width - x0, 16);
    const int rows = std::min(c.valid_height(), c.channel.out.height - at.y);
    for (int y = 0; y < rows && begin < end; ++y) {
        float* const row = c.channel.out.row(at.y + y) + c.channel.out.step * x0;
        for (int x = begin; x < end; ++x)
            row[c.channel.out.step * x] = from[16 * (first_y + y) + x];
    }
}

/// Sixteen rows into `re`, `im` as [column][row], or back.
void rows_from(const Tile& tile, int first, float* re, float* im, Isa isa) {
    const std::ptrdiff_t at = 16 * std::ptrdiff_t{first};
    OBSCURA_DISPATCH(isa, transpose_blocks, tile.re.data() + at, tile.group_step, re, 256, tile.groups());
    OBSCURA_DISPATCH(isa, transpose_blocks, tile.im.data() + at, tile.group_step, im, 256, tile.groups());
}
void rows_to(Tile& tile, int first, const float* re, const float* im, Isa isa) {
    const std::ptrdiff_t at = 16 * std::ptrdiff_t{first};
    OBSCURA_DISPATCH(isa, transpose_blocks, re, 256, tile.re.data() + at, tile.group_step, tile.groups());
    OBSCURA_DISPATCH(isa, transpose_blocks, im, 256, tile.im.data() + at, tile.group_step, tile.groups());
}

/// The kernel's transform over the number of its coefficients, which is what forward and backward scale by.
void transform_kernel(const Convolver& c, Tile& tile, const Exec& exec) {
    parallel_for(static_cast<std::size_t>(tile.groups()), exec, [&](std::size_t g) {
        float* const re = tile.re.data() + static_cast<std::ptrdiff_t>(g) * tile.group_step;
        float* const im = tile.im.data() + static_cast<std::ptrdiff_t>(g) * tile.group_step;
        std::fill_n(im, 16 * c.height(), 0.0f);
        if (load_group(c.channel.kernel, {0, 0}, static_cast<int>(g), c.height(), re))
            fft16_forward(c.along_y, re, im, exec.isa);
    });
    const std::size_t batch = 16 * static_cast<std::size_t>(c.width());
    const std::size_t batches = static_cast<std::size_t>(c.height() / 16);
    const float scale = 1.0f / (static_cast<float>(c.width()) * static_cast<float>(c.height()));
    parallel_for(batches, exec, [&](std::size_t b) {
        float *const re = c.spectrum.re.data() + b * batch, *const im = c.spectrum.im.data() + b * batch;
        rows_from(tile, static_cast<int>(16 * b), re, im, exec.isa);
        fft16_forward(c.along_x, re, im, exec.isa);
        for (std::size_t i = 0; i < batch; ++i) {
            re[i] *= scale;
            im[i] *= scale;
        }
    });
}

/// Forward, product and backward along x of the rows of batches [begin, end), sixteen at a time, which stay
/// in the cache meanwhile.
void convolve_rows(const Convolver& c, Tile& tile, std::size_t begin, std::size_t end, Isa isa) {
    const std::size_t batch = 16 * static_cast<std::size_t>(c.width());
    Buffer<float> rows(2 * batch);
    float *const re = rows.data(), *const im = re + batch;
    for (std::size_t b = begin; b < end; ++b) {
        rows_from(tile, static_cast<int>(16 * b), re, im, isa);
        fft16_forward(c.along_x, re, im, isa);
        OBSCURA_DISPATCH(isa, multiply_spectra, re, im, c.spectrum.re.data() + b * batch,
                         c.spectrum.im.data() + b * batch, static_cast<int>(batch));
        fft16_backward(c.along_x, re, im, isa);
        rows_to(tile, static_cast<int>(16 * b), re, im, isa);
    }
}

/// Tiles 2 pair and 2 pair + 1 (if there is one) as real and imaginary part.
void convolve_pair(const Convolver& c, Tile& tile, int pair, const Exec& exec) {
    const int tiles = c.plan.tiles_x * c.plan.tiles_y;
    const bool both = 2 * pair + 1 < tiles;
    const Rectangle to[2] = {c.tile(2 * pair), c.tile(both ? 2 * pair + 1 : 2 * pair)};
    Rectangle from[2];
    for (int i = 0; i < 2; ++i)
        from[i] = {to[i].x - c.lead_x(), to[i].y - c.lead_y()};
    const auto groups = static_cast<std::size_t>(tile.groups());
    std::vector<char> used(groups);
    parallel_for(groups, exec, [&](std::size_t g) {
        float* const re = tile.re.data() + static_cast<std::ptrdiff_t>(g) * tile.group_step;
        float* const im = tile.im.data() + static_cast<std::ptrdiff_t>(g) * tile.group_step;
        const bool first = load_group(c.channel.source, from[0], static_cast<int>(g), c.height(), re);
        bool second = false;
        if (both) {
            second = load_group(c.channel.source, from[1], static_cast<int>(g), c.height(), im);
        } else {
            std::fill_n(im, 16 * c.height(), 0.0f);
        }
        used[g] = first || second;
        if (used[g]) fft16_forward(c.along_y, re, im, exec.isa);
    });
    if (std::none_of(used.begin(), used.end(), [](char any) { return any != 0; })) return;
    const auto batches = static_cast<std::size_t>(c.height() / 16);
    parallel_blocks(batches, exec.threads == 1 ? batches : 4, exec, [&](std::size_t begin, std::size_t end) {
        convolve_rows(c, tile, begin, end, exec.isa);
    });
    // Groups before the first valid column need not come back.
    const auto invalid = static_cast<std::size_t>(c.lead_x() / 16);
    parallel_for(groups - invalid, exec, [&](std::size_t i) {
        const std::size_t g = i + invalid;
        float* const re = tile.re.data() + static_cast<std::ptrdiff_t>(g) * tile.group_step;
        float* const im = tile.im.data() + static_cast<std::ptrdiff_t>(g) * tile.group_step;
        fft16_backward(c.along_y, re, im, exec.isa);
        store_group(c, to[0], static_cast<int>(g), re);
        if (both) store_group(c, to[1], static_cast<int>(g), im);
    });
}

}  // namespace

void convolve_tiles(std::span<const ChannelConvolution> channels, const ConvolutionPlan& plan,
                    const Exec& exec) {
    const FftPlan along_x = fft_plan(plan.log2_x), along_y = fft_plan(plan.log2_y);
    const int width = along_x.length(), height = along_y.length();
    const int pairs = (plan.tiles_x * plan.tiles_y + 1) / 2;
    const int threads = exec.threads > 0 ? exec.threads : hardware_threads();
    // Many pairs: each thread its own. Few: all threads on one, group by group.
    const bool many = pairs >= 4 * threads;
    const int lists = many ? threads : 1;
    const Exec inside{exec.isa, many ? 1 : threads};
    std::vector<Tile> tiles;
    for (int list = 0; list < lists; ++list)
        tiles.emplace_back(width, height);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Spectrum spectrum{Buffer<float>(pixels), Buffer<float>(pixels)};
    for (const ChannelConvolution& channel : channels) {
        const Convolver c{channel, plan, along_x, along_y, spectrum};
        transform_kernel(c, tiles[0], {exec.isa, threads});
        parallel_for(static_cast<std::size_t>(lists), exec, [&](std::size_t list) {
            for (int pair = static_cast<int>(list); pair < pairs; pair += lists)
                convolve_pair(c, tiles[list], pair, inside);
        });
    }
}

}  // namespace obscura
