// Joint bilateral upsampling of a change; see upsample.h.

#include "stereo/upsample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "stereo/change_samples.h"

namespace obscura {
namespace {

/// The samples around a column (or row): the last at or before it and the first behind.
struct Between {
    int before = 0, behind = 0;              ///< indices; equal at the borders
    float from_before = 0, from_behind = 0;  ///< pixels of full resolution, either sign
    float share = 0;                         ///< of `behind`, linear
};

std::vector<Between> between_samples(int full_size, int low_size, int reduction) {
    std::vector<Between> all(static_cast<std::size_t>(full_size));
    for (int x = 0, i = 0; x < full_size; ++x) {
        const auto place = [&](int index) { return sampled_pixel(index, reduction, full_size); };
        while (i + 1 < low_size && place(i + 1) <= x)
            ++i;
        Between& b = all[static_cast<std::size_t>(x)];
        b.before = i;
        b.behind = x < place(i) ? i : std::min(i + 1, low_size - 1);
        b.from_before = static_cast<float>(x - place(i));
        b.from_behind = static_cast<float>(x - place(b.behind));
        if (b.behind != i) b.share = b.from_before / static_cast<float>(place(b.behind) - place(i));
    }
    return all;
}

/// A full-resolution pixel, as samples are compared with it.
struct Guide {
    float disparity = 0;
    std::uint32_t object = 0;
    Vec3f normal;
};

/// A weighted mean that is exact when all values are equal: of differences to the first.
struct Mean {
    float first = 0, sum = 0, weight = 0;
    void add(float value, float w) {
        if (weight == 0) first = value;
        sum += w * (value - first);
        weight += w;
    }
    float value() const { return first + sum / weight; }
};

class Upsampler {
  public:
    Upsampler(const MiddleView& full, const MiddleView& low, const Image<float>& change,
              const UpsampleParams& params, const Exec& exec)
        : full_(full),
          samples_(change_samples(full, low, change, params.steepest_change, exec)),
          object_mean_(mean_change_per_object(low, change)),
          columns_(between_samples(full.width(), low.width(), low.reduction)),
          rows_(between_samples(full.height(), low.height(), low.reduction)),
          per_disparity_squared_(static_cast<float>(1 / (params.disparity_px * params.disparity_px))),
          reduction_(low.reduction),
          normals_(!full.normal.pixels.empty()) {}

    void row(int y, float* out) const {
        const Between& v = rows_[static_cast<std::size_t>(y)];
        const ChangeSample* upper = samples_.row(v.before);
        const ChangeSample* lower = samples_.row(v.behind);
        for (int x = 0; x < full_.width(); ++x) {
            const Guide g{full_.disparity(x, y), full_.object(x, y), normals_ ? full_.normal(x, y) : Vec3f{}};
            if (g.object == nothing_seen) continue;
            const Between& u = columns_[static_cast<std::size_t>(x)];
            Mean mean;
            add(mean, upper[u.before], g, u.from_before, v.from_before, (1 - u.share) * (1 - v.share));
            add(mean, upper[u.behind], g, u.from_behind, v.from_before, u.share * (1 - v.share));
            add(mean, lower[u.before], g, u.from_before, v.from_behind, (1 - u.share) * v.share);
            add(mean, lower[u.behind], g, u.from_behind, v.from_behind, u.share * v.share);
            out[x] = mean.weight > 0 ? mean.value() : from_farther(g, x, y);
        }
    }

  private:
    float likeness(const ChangeSample& s, const Guide& g) const {
        const float d = g.disparity - s.disparity;
        const float near = 1 / (1 + d * d * per_disparity_squared_);
        if (!normals_) return near;
        const float facing = std::max(dot(s.normal, g.normal), 0.0f);
        return near * (0.05f + facing * facing);
    }

    void add(Mean& mean, const ChangeSample& s, const Guide& g, float columns, float rows,
             float share) const {
        if (s.object != g.object || !(share > 0)) return;
        const float d = g.disparity - s.disparity;
        mean.add(s.change + s.per_disparity * d + (s.per_column * columns + s.per_row * rows),
                 share * likeness(s, g));
    }

    /// None of the four samples around is of the object: a wider window, the object's mean, its neighbours.
    float from_farther(const Guide& g, int x, int y) const {
        constexpr int reach = 2;
        const Between& u = columns_[static_cast<std::size_t>(x)];
        const Between& v = rows_[static_cast<std::size_t>(y)];
        const int last_row = std::min(v.behind + reach, samples_.height - 1);
        const int last_column = std::min(u.behind + reach, samples_.width - 1);
        const auto pixel = static_cast<float>(reduction_);
        Mean own, any;
        for (int j = std::max(v.before - reach, 0); j <= last_row; ++j) {
            const auto rows = static_cast<float>(y - sampled_pixel(j, reduction_, full_.height()));
            for (int i = std::max(u.before - reach, 0); i <= last_column; ++i) {
                const ChangeSample& s = samples_(i, j);
                if (s.object == nothing_seen) continue;
                const auto columns = static_cast<float>(x - sampled_pixel(i, reduction_, full_.width()));
                const float near = 1 / (1 + (columns * columns + rows * rows) / (pixel * pixel));
                add(own, s, g, columns, rows, near * near);
                any.add(s.change, near * near * likeness(s, g));
            }
        }
        if (own.weight > 0) return own.value();
        if (g.object < object_mean_.size() && object_mean_[g.object]) return *object_mean_[g.object];
        return any.weight > 0 ? any.value() : 0;
    }

    const MiddleView& full_;
    Image<ChangeSample> samples_;
    std::vector<std::optional<float>> object_mean_;
    std::vector<Between> columns_, rows_;
    float per_disparity_squared_;
    int reduction_;
    bool normals_;
};

}  // namespace

std::vector<std::optional<float>> mean_change_per_object(const MiddleView& view, const Image<float>& change) {
    std::vector<double> sum;
    std::vector<std::int64_t> count;
    for (std::size_t i = 0; i < change.pixels.size(); ++i) {
        const std::uint32_t object = view.object.pixels[i];
        if (object == nothing_seen) continue;
        if (object >= sum.size()) {
            sum.resize(object + std::size_t{1});
            count.resize(object + std::size_t{1});
        }
        sum[object] += static_cast<double>(change.pixels[i]);
        ++count[object];
    }
    std::vector<std::optional<float>> mean(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i)
        if (count[i] > 0) mean[i] = static_cast<float>(sum[i] / static_cast<double>(count[i]));
    return mean;
}

Image<float> upsampled_change(const MiddleView& full, const MiddleView& low, const Image<float>& change,
                              const UpsampleParams& params, const Exec& exec) {
    const int n = low.reduction;
    CHECK(full.reduction == 1 && low.width() == (full.width() + n - 1) / n &&
              low.height() == (full.height() + n - 1) / n && change.width == low.width() &&
              change.height == low.height() && full.normal.pixels.empty() == low.normal.pixels.empty(),
          fmt::format("1:{} of {} x {}", n, full.width(), full.height()));
    Image<float> out(full.width(), full.height());
    const Upsampler upsampler(full, low, change, params, exec);
    parallel_blocks(static_cast<std::size_t>(full.height()), 8, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                            upsampler.row(y, out.row(y));
                    });
    return out;
}

DisparityMap upsampled_solution(const MiddleView& full, const MiddleView& low, const DisparityMap& solution,
                                const UpsampleParams& params, const Exec& exec) {
    CHECK(solution.width == low.width() && solution.height == low.height());
    Image<float> change = solution;
    for (std::size_t i = 0; i < change.pixels.size(); ++i)
        change.pixels[i] -= low.disparity.pixels[i];
    DisparityMap map = upsampled_change(full, low, change, params, exec);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const float c = map.pixels[i], d = full.disparity.pixels[i];
        map.pixels[i] = c == 0 ? d : d + c;
    }
    return map;
}

}  // namespace obscura
