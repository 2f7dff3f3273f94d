#include "filters/convolution_fft.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
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

/// Groups that are filled and read together: rows of 64 pixels, so that pictures are met along their rows.
constexpr int groups_together = 4;

/// Pixels [begin, end) of sixteen, zeros elsewhere. True when any is not 0.
bool load_sixteen(const float* from, std::ptrdiff_t step, int begin, int end, float* to) {
    if (begin == 0 && end == 16 && step == 1) {
        std::memcpy(to, from, 16 * sizeof(float));
    } else {
        std::fill_n(to, 16, 0.0f);
        for (int x = begin; x < end; ++x)
            to[x] = from[step * x];
    }
    std::uint32_t bits = 0;
    for (int x = 0; x < 16; ++x)
        bits |= std::bit_cast<std::uint32_t>(to[x]) << 1;
    return bits != 0;
}

/// Groups [begin, end) of a tile's real or imaginary part (`plane`), zeros where the channel has no pixels.
/// Marks those that are not all 0.
void load_groups(const Channel<const float>& from, const Rectangle& at, int begin, int end, const Tile& tile,
                 float* plane, char* used) {
    for (int y = 0; y < tile.height; ++y) {
        const bool row_exists = at.y + y >= 0 && at.y + y < from.height;
        for (int g = begin; g < end; ++g) {
            float* const to = plane + g * tile.group_step + 16 * y;
            const int x0 = at.x + 16 * g;
            const int first = std::clamp(-x0, 0, 16), last = std::clamp(from.width - x0, 0, 16);
            if (!row_exists || first >= last) {
                std::fill_n(to, 16, 0.0f);
            } else if (load_sixteen(from.row(at.y + y) + from.step * x0, from.step, first, last, to)) {
                used[g] = 1;
            }
        }
    }
}

/// What is valid in groups [begin, end) of a tile and exists in the result.
void store_groups(const Convolver& c, const Rectangle& at, int begin, int end, const Tile& tile,
                  const float* plane) {
    const Channel<float>& out = c.channel.out;
    const int rows = std::min(c.valid_height(), out.height - at.y);
    for (int y = 0; y < rows; ++y) {
        for (int g = begin; g < end; ++g) {
            const float* const from = plane + g * tile.group_step + 16 * (c.lead_y() + y);
            const int x0 = at.x - c.lead_x() + 16 * g;  // in the result
            const int first = std::max(c.lead_x() - 16 * g, 0), last = std::min(out.width - x0, 16);
            float* const row = out.row(at.y + y) + out.step * x0;
            for (int x = first; x < last; ++x)
                row[out.step * x] = from[x];
        }
    }
}

/// Calls fn(begin, end) for the groups from `first` on, a few at a time.
template <class Fn>
void for_groups(const Tile& tile, int first, const Exec& exec, const Fn& fn) {
    parallel_blocks(static_cast<std::size_t>(tile.groups() - first), groups_together, exec,
                    [&](std::size_t begin, std::size_t end) {
                        fn(first + static_cast<int>(begin), first + static_cast<int>(end));
                    });
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

/// Forward along y, but for groups that are 0 and stay so.
void transform_columns(const Convolver& c, Tile& tile, int begin, int end, const char* used, Isa isa) {
    for (int g = begin; g < end; ++g) {
        const std::ptrdiff_t at = g * tile.group_step;
        if (used[g] != 0) fft16_forward(c.along_y, tile.re.data() + at, tile.im.data() + at, isa);
    }
}

/// The kernel's transform over the number of its coefficients, which is what forward and backward scale by.
void transform_kernel(const Convolver& c, Tile& tile, const Exec& exec) {
    std::vector<char> used(static_cast<std::size_t>(tile.groups()));
    std::fill(tile.im.begin(), tile.im.end(), 0.0f);
    for_groups(tile, 0, exec, [&](int begin, int end) {
        load_groups(c.channel.kernel, {0, 0}, begin, end, tile, tile.re.data(), used.data());
        transform_columns(c, tile, begin, end, used.data(), exec.isa);
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
    std::vector<char> used(static_cast<std::size_t>(tile.groups()));
    for_groups(tile, 0, exec, [&](int begin, int end) {
        load_groups(c.channel.source, from[0], begin, end, tile, tile.re.data(), used.data());
        if (both) {
            load_groups(c.channel.source, from[1], begin, end, tile, tile.im.data(), used.data());
        } else {
            std::fill(tile.im.data() + begin * tile.group_step, tile.im.data() + end * tile.group_step, 0.0f);
        }
        transform_columns(c, tile, begin, end, used.data(), exec.isa);
    });
    if (std::none_of(used.begin(), used.end(), [](char any) { return any != 0; })) return;
    const auto batches = static_cast<std::size_t>(c.height() / 16);
    parallel_blocks(batches, exec.threads == 1 ? batches : 4, exec, [&](std::size_t begin, std::size_t end) {
        convolve_rows(c, tile, begin, end, exec.isa);
    });
    // Groups before the first valid column need not come back.
    for_groups(tile, c.lead_x() / 16, exec, [&](int begin, int end) {
        for (int g = begin; g < end; ++g) {
            const std::ptrdiff_t at = g * tile.group_step;
            fft16_backward(c.along_y, tile.re.data() + at, tile.im.data() + at, exec.isa);
        }
        store_groups(c, to[0], begin, end, tile, tile.re.data());
        if (both) store_groups(c, to[1], begin, end, tile, tile.im.data());
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
    tiles.reserve(static_cast<std::size_t>(lists));
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
