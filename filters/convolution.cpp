#include "filters/convolution.h"

#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "filters/convolution_fft.h"
#include "filters/convolution_lanes.h"

namespace obscura {
namespace {

static_assert(sizeof(Vec3f) == 3 * sizeof(float));

Channel<const float> channel(ImageView<const Vec3f> image, int c) {
    return {reinterpret_cast<const float*>(image.data) + c, image.width, image.height, 3, 3 * image.stride};
}
Channel<float> channel(Image<Vec3f>& image, int c) {
    return {reinterpret_cast<float*>(image.pixels.data()) + c, image.width, image.height, 3,
            3 * std::ptrdiff_t{image.width}};
}
Image<float> plane_of(const Channel<const float>& channel) {
    Image<float> plane(channel.width, channel.height);
    for (int y = 0; y < plane.height; ++y) {
        for (int x = 0; x < plane.width; ++x)
            plane(x, y) = channel.row(y)[channel.step * x];
    }
    return plane;
}

template <class T>
Image<T> blank_result(ImageView<const T> source, ImageView<const T> kernel) {
    CHECK(source.width >= 1 && source.height >= 1 && kernel.width >= 1 && kernel.height >= 1);
    return {source.width + kernel.width - 1, source.height + kernel.height - 1};
}

/// Pixels that are not 0, row by row.
struct Sources {
    struct Pixel {
        int x;
        float value;
    };
    std::vector<Pixel> pixels;
    std::vector<std::size_t> row;  ///< row y: pixels [row[y], row[y + 1])
};
Sources sources_of(const Channel<const float>& source) {
    Sources s;
    s.row.push_back(0);
    for (int y = 0; y < source.height; ++y) {
        const float* const row = source.row(y);
        for (int x = 0; x < source.width; ++x) {
            const float value = row[source.step * x];
            if (value != 0.0f) s.pixels.push_back({x, value});
        }
        s.row.push_back(s.pixels.size());
    }
    return s;
}

/// Row `y` of the result: every source row that the kernel carries there, from top to bottom.
void splat_row(const Sources& sources, ImageView<const float> kernel, int y, float* out, Isa isa) {
    const int rows = static_cast<int>(sources.row.size()) - 1;
    for (int from = std::max(0, y - kernel.height + 1); from <= std::min(y, rows - 1); ++from) {
        const float* const kernel_row = kernel.row(y - from);
        for (std::size_t i = sources.row[static_cast<std::size_t>(from)];
             i < sources.row[static_cast<std::size_t>(from) + 1]; ++i) {
            const Sources::Pixel p = sources.pixels[i];
            OBSCURA_DISPATCH(isa, add_scaled, out + p.x, kernel_row, p.value, kernel.width);
        }
    }
}

Image<float> splat(const Channel<const float>& source, ImageView<const float> kernel, const Exec& exec) {
    Image<float> out(source.width + kernel.width - 1, source.height + kernel.height - 1);
    const Sources sources = sources_of(source);
    parallel_blocks(static_cast<std::size_t>(out.height), 8, exec, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            splat_row(sources, kernel, y, out.row(y), exec.isa);
    });
    return out;
}

}  // namespace

Image<float> convolve_fft(ImageView<const float> source, ImageView<const float> kernel, const Exec& exec) {
    Image<float> out = blank_result(source, kernel);
    const ConvolutionPlan plan =
        plan_convolution(0, source.width, source.height, kernel.width, kernel.height);
    const ChannelConvolution plane{{source.data, source.width, source.height, 1, source.stride},
                                   {kernel.data, kernel.width, kernel.height, 1, kernel.stride},
                                   {out.pixels.data(), out.width, out.height, 1, out.width}};
    convolve_tiles({&plane, 1}, plan, exec);
    return out;
}

Image<Vec3f> convolve_fft(ImageView<const Vec3f> source, ImageView<const Vec3f> kernel, const Exec& exec) {
    Image<Vec3f> out = blank_result(source, kernel);
    const ConvolutionPlan plan =
        plan_convolution(0, source.width, source.height, kernel.width, kernel.height);
    const ChannelConvolution channels[3] = {{channel(source, 0), channel(kernel, 0), channel(out, 0)},
                                            {channel(source, 1), channel(kernel, 1), channel(out, 1)},
                                            {channel(source, 2), channel(kernel, 2), channel(out, 2)}};
    convolve_tiles(channels, plan, exec);
    return out;
}

Image<float> convolve_splats(ImageView<const float> source, ImageView<const float> kernel, const Exec& exec) {
    blank_result(source, kernel);
    return splat({source.data, source.width, source.height, 1, source.stride}, kernel, exec);
}

Image<Vec3f> convolve_splats(ImageView<const Vec3f> source, ImageView<const Vec3f> kernel, const Exec& exec) {
    Image<Vec3f> out = blank_result(source, kernel);
    for (int c = 0; c < 3; ++c) {
        const Image<float> plane = splat(channel(source, c), plane_of(channel(kernel, c)).view(), exec);
        const Channel<float> to = channel(out, c);
        for (int y = 0; y < out.height; ++y) {
            for (int x = 0; x < out.width; ++x)
                to.row(y)[to.step * x] = plane(x, y);
        }
    }
    return out;
}

}  // namespace obscura
