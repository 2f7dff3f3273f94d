#include "optics/glare_bloom.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

/// Two neighbours on the coarse grid and the share of the second.
struct Between {
    int index = 0;
    double share = 0;
};

Between between(double position) {
    const double below = std::floor(position);
    return {static_cast<int>(below), position - below};
}

/// Position of fine pixel x on the coarse grid whose sample 0 lies at fine position (scale - 1) / 2.
Between coarse_position(int x, int scale) {
    return between((x + 0.5) / scale - 0.5);
}

void share_out(Image<double>& to, Between x, Between y, double value) {
    to(x.index, y.index) += (1 - x.share) * (1 - y.share) * value;
    to(x.index + 1, y.index) += x.share * (1 - y.share) * value;
    to(x.index, y.index + 1) += (1 - x.share) * y.share * value;
    to(x.index + 1, y.index + 1) += x.share * y.share * value;
}

/// Share of a tap that lies `distance` from the centre which the outskirts take: 0 up to 2 scale, 1 from 4
/// scale on, smooth in between, so that neither part has an edge.
double outer_share(double distance, int scale) {
    const double t = std::clamp(distance / (2.0 * scale) - 1, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

Image<float> rounded(const Image<double>& from) {
    Image<float> to(from.width, from.height);
    std::transform(from.pixels.begin(), from.pixels.end(), to.pixels.begin(),
                   [](double v) { return static_cast<float>(v); });
    return to;
}

}  // namespace

SplitKernel split_kernel(ImageView<const float> kernel, int scale) {
    const int radius_x = kernel.width / 2, radius_y = kernel.height / 2;
    const int core_x = std::min(4 * scale, radius_x), core_y = std::min(4 * scale, radius_y);
    SplitKernel split;
    split.core = Image<float>(2 * core_x + 1, 2 * core_y + 1);
    // One sample more than the radius covers, for the upper neighbour.
    const int coarse_x = radius_x / scale + 1, coarse_y = radius_y / scale + 1;
    Image<double> sum(2 * coarse_x + 1, 2 * coarse_y + 1);
    for (int y = -radius_y; y <= radius_y; ++y) {
        for (int x = -radius_x; x <= radius_x; ++x) {
            const float value = kernel(x + radius_x, y + radius_y);
            if (value == 0) continue;
            const double share = outer_share(std::sqrt(static_cast<double>(x * x + y * y)), scale);
            const auto outer = static_cast<float>(share * static_cast<double>(value));
            if (share < 1) split.core(x + core_x, y + core_y) = value - outer;
            if (outer == 0) continue;
            Between at_x = between(static_cast<double>(x) / scale),
                    at_y = between(static_cast<double>(y) / scale);
            at_x.index += coarse_x;
            at_y.index += coarse_y;
            share_out(sum, at_x, at_y, static_cast<double>(outer));
        }
    }
    split.outskirts = rounded(sum);
    return split;
}

Image<float> coarsened(ImageView<const float> fine, int scale) {
    Image<double> sum(fine.width / scale + 3, fine.height / scale + 3);
    for (int y = 0; y < fine.height; ++y) {
        for (int x = 0; x < fine.width; ++x) {
            if (fine(x, y) == 0) continue;
            Between at_x = coarse_position(x, scale), at_y = coarse_position(y, scale);
            ++at_x.index;
            ++at_y.index;
            share_out(sum, at_x, at_y, static_cast<double>(fine(x, y)));
        }
    }
    return rounded(sum);
}

double CoarsePlane::at(int x, int y) const {
    const Between at_x = coarse_position(x, scale), at_y = coarse_position(y, scale);
    const int i = at_x.index + first, j = at_y.index + first;
    const auto sample = [&](int column, int row) {
        const bool inside = column >= 0 && column < samples.width && row >= 0 && row < samples.height;
        return inside ? static_cast<double>(samples(column, row)) : 0.0;
    };
    const double upper = (1 - at_x.share) * sample(i, j) + at_x.share * sample(i + 1, j);
    const double lower = (1 - at_x.share) * sample(i, j + 1) + at_x.share * sample(i + 1, j + 1);
    return ((1 - at_y.share) * upper + at_y.share * lower) / (static_cast<double>(scale) * scale);
}

}  // namespace obscura
