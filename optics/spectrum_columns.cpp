#include "optics/spectrum_columns.h"

#include <algorithm>
#include <cstddef>

#include "core/num.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// Calls place(column) for the columns of the grid that are congruent to j, ascending, those that begin up to
/// 15 before the grid included.
template <class Place>
void for_congruent(const NaturalAxis& u, std::int64_t j, Place&& place) {
    const std::int64_t period = u.period();
    for (std::int64_t c = ((j - u.first + 15) & (period - 1)) - 15; c < u.count; c += period)
        place(static_cast<int>(c));
}

/// One strip after the other; pointers are set at the end, when nothing moves any more.
class StripBuilder {
  public:
    StripBuilder(const NaturalAxis& u, int group, int first_lane)
        : u_(u), group_(group), first_(first_lane) {}

    template <class Factor>
    void add(int column, bool mirrored, Factor&& factor) {
        float values[48] = {};
        std::uint8_t kept[16] = {};
        int count = 0;
        for (int lane = 0; lane < 16; ++lane) {
            const int at = mirrored ? column + 15 - lane : column + lane;
            const int j = 16 * group_ + lane;
            const bool twin = mirrored && j == 0;  // 0 is its own mirror image
            if (at < 0 || at >= u_.count || j < first_ || j >= u_.period() / 2 || twin) continue;
            const ColumnFactor f = factor(at, j, mirrored);
            values[lane] = f.re;
            values[16 + lane] = f.im;
            values[32 + lane] = f.power;
            kept[lane] = 1;
            ++count;
        }
        if (count == 0) return;
        result_.strips.push_back({column, mirrored, nullptr, nullptr, nullptr, nullptr});
        result_.factors.insert(result_.factors.end(), values, values + 48);
        result_.lanes.insert(result_.lanes.end(), kept, kept + 16);
        whole_.push_back(count == 16);
    }

    GroupStrips finish() {
        for (std::size_t s = 0; s < result_.strips.size(); ++s) {
            ColumnStrip& strip = result_.strips[s];
            strip.re = &result_.factors[48 * s];
            strip.im = strip.re + 16;
            strip.power = strip.re + 32;
            strip.keep = whole_[s] ? nullptr : &result_.lanes[16 * s];
        }
        return std::move(result_);
    }

  private:
    NaturalAxis u_;
    int group_, first_;
    GroupStrips result_;
    std::vector<bool> whole_;
};

template <class Factor>
GroupStrips group_strips(const NaturalAxis& u, int group, int first_lane, Factor&& factor) {
    StripBuilder builder(u, group, first_lane);
    for_congruent(u, 16 * group, [&](int column) { builder.add(column, false, factor); });
    for_congruent(u, -16 * group - 15, [&](int column) { builder.add(column, true, factor); });
    return builder.finish();
}

}  // namespace

int column_groups(const NaturalAxis& u) {
    return std::max(1, u.period() / 2 / 16);
}

int groups_at_once(int groups, int length, const Exec& exec) {
    constexpr int most = 8, samples = 8192;
    const int threads = exec.threads > 0 ? exec.threads : hardware_threads();
    const int balanced = threads == 1 ? groups : (groups + 4 * threads - 1) / (4 * threads);
    return std::max(1, std::min({most, samples / length, balanced}));
}

GroupStrips complex_strips(const NaturalAxis& u, int group, const AxisFactors& factors) {
    return group_strips(u, group, 1, [&](int column, int, bool) {
        const auto at = static_cast<std::size_t>(column);
        return ColumnFactor{factors.re[at], factors.im[at], factors.power[at]};
    });
}

GroupStrips mirror_strips(const NaturalAxis& u, int group) {
    return group_strips(u, group, 0, [&](int column, int j, bool mirrored) {
        const std::int64_t index = u.first + column;
        if (j == 0) return ColumnFactor{};
        // F = D / (2 pi i u); D is i times the sum here, and minus that for the mirrored frequency.
        const double size = 1 / (2 * num::pi * (static_cast<double>(index) / u.period()));
        return ColumnFactor{static_cast<float>(mirrored ? -size : size), 0, static_cast<float>(size * size)};
    });
}

void store_real_pair(const float* re, const float* im, float scale, const SpectrumRows& rows,
                     const NaturalAxis& u, const AxisFactors& factors, const FieldTarget& target) {
    const int period = u.period(), row_period = 1 << rows.log2_period;
    for (int c = 0; c < u.count; ++c) {
        const std::int64_t j = (u.first + c) & (period - 1);
        const bool first_of_pair = j == 0;
        if (!first_of_pair && 2 * j != period) continue;
        const auto column = static_cast<std::size_t>(c);
        const float undo = first_of_pair ? 1.0f : 1 / scale;
        const float factor_re = undo * factors.re[column], factor_im = undo * factors.im[column];
        const float factor_power = undo * undo * factors.power[column];
        for (int r = 0; r < rows.count; ++r) {
            const std::int64_t k = (rows.first + r) & (row_period - 1);
            const std::size_t at = std::size_t{16} * rows.position[k];
            const std::size_t opposite = std::size_t{16} * rows.position[-k & (row_period - 1)];
            // X = A + i B, see store_real_columns16.
            const float a = 0.5f * (first_of_pair ? re[at] + re[opposite] : im[at] + im[opposite]);
            const float b = 0.5f * (first_of_pair ? im[at] - im[opposite] : re[opposite] - re[at]);
            const std::ptrdiff_t to = r * target.stride + c;
            if (target.power != nullptr) target.power[to] = (a * a + b * b) * factor_power * rows.power[r];
            if (target.re != nullptr) {
                const float f = a * factor_re - b * factor_im, g = a * factor_im + b * factor_re;
                target.re[to] = f * rows.re[r] - g * rows.im[r];
                target.im[to] = f * rows.im[r] + g * rows.re[r];
            }
        }
    }
}

void clear_half_period(const NaturalAxis& u, int rows, const FieldTarget& target) {
    const int period = u.period();
    for (int c = 0; c < u.count; ++c) {
        if (2 * ((u.first + c) & (period - 1)) != period) continue;
        for (int r = 0; r < rows; ++r) {
            const std::ptrdiff_t at = r * target.stride + c;
            if (target.power != nullptr) target.power[at] = 0;
            if (target.re != nullptr) target.re[at] = target.im[at] = 0;
        }
    }
}

SpectrumRows spectrum_rows(const NaturalAxis& v, const FftPlan& plan, const AxisFactors& factors) {
    return {v.log2_period,       v.count, v.first, plan.position.data(), factors.re.data(), factors.im.data(),
            factors.power.data()};
}

}  // namespace obscura
