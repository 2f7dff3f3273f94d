// A floating horizon (profile.h) over the grid's lines, from the sun's side on. A far shadow of threshold d
// asks the profile as it was d lines before: the profile of the first k lines is asked by line k + d.
//
// Exact though it computes in doubles: a profile errs by rounding of its values only, and by what merging
// lets go. Where a sample is not farther from it than that, sun_hidden() decides in integers.

#include "raster/heights/height_sweep.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "raster/heights/height_march.h"
#include "raster/heights/profile.h"
#include "raster/heights/sun_view.h"

namespace obscura {
namespace {

constexpr double rise_unit_m = 1.0 / static_cast<double>(std::int64_t{1} << rise_fraction_bits);

class Sweep {
  public:
    Sweep(const HeightField& field, const HeightSun& sun)
        : field_(field),
          sun_(sun),
          view_(sun_view(field, sun)),
          rise_m_(static_cast<double>(sun.rise_q36) * rise_unit_m) {
        // A value is made by a few operations on numbers of at most this size.
        const HeightRange range = height_range(field);
        const double largest =
            std::max(std::fabs(metres_of(range.least_q16)), std::fabs(metres_of(range.greatest_q16))) +
            rise_m_ * view_.lines;
        tolerance_m_ = std::ldexp(largest, -50);
        // Each line merged may let go of `tolerance` and of some roundings.
        doubt_m_ = 4 * tolerance_m_ * (view_.lines + 4);
        before_.resize(static_cast<std::size_t>(view_.rows));
        now_.resize(before_.size());
    }

    std::vector<ShadowBits> run(std::span<const int> thresholds, SweepStats* stats) {
        std::vector<ShadowBits> maps;
        for ([[maybe_unused]] const int d : thresholds)
            maps.emplace_back(field_.width(), field_.height());
        for (int line = 0; line < view_.lines; ++line) {
            add(line);
            for (std::size_t i = 0; i < thresholds.size(); ++i)
                ask(line, std::max(thresholds[i], 1), maps[i]);
        }
        for (std::size_t i = 0; i < thresholds.size(); ++i) {
            if (thresholds[i] == 0) add_first_strips(maps[i]);
        }
        if (stats != nullptr) {
            const std::int64_t samples = std::int64_t{field_.width()} * field_.height();
            stats->samples += samples * static_cast<std::int64_t>(thresholds.size());
            stats->marched += marched_;
        }
        return maps;
    }

  private:
    double g_m(int line, int row) const { return metres_of(view_.height_q16(line, row)) + rise_m_ * line; }
    double first_u(int line) const { return static_cast<double>(view_.slope_q20 * line); }

    /// The profile of lines 0 to `line`.
    void add(int line) {
        std::swap(before_, now_);
        for (int row = 0; row < view_.rows; ++row)
            now_[static_cast<std::size_t>(row)] = g_m(line, row);
        if (view_.rows == 1) {
            add_sample(line);
        } else if (line == 0) {
            line_profile(now_, 0, profile_);
        } else {
            strip_profile(
                before_, now_,
                {static_cast<double>(view_.slope_q20), first_u(line), view_.crossed_diagonals, tolerance_m_},
                strip_);
            upper_envelope(profile_, strip_, first_u(line), tolerance_m_, merged_);
            std::swap(profile_, merged_);
        }
    }

    /// A grid of one row is a line without width: seen from the sun a point, or one beside the other.
    void add_sample(int line) {
        const double u = first_u(line);
        const bool hides = line > 0 && view_.slope_q20 == 0;
        const double g = hides ? std::max(profile_.lines[0].g0, now_[0]) : now_[0];
        profile_.lines = {{u, u, g, 0}};
        profile_.end = u;
    }

    /// Asks the profile of lines 0 to `line` for the line d further.
    void ask(int line, int d, ShadowBits& map) {
        if (d >= view_.lines - line) return;
        const int asking = line + d;
        const ProfileLine *at_u = profile_.lines.data(), *last = at_u + profile_.lines.size() - 1;
        const double first = first_u(asking), rise = rise_m_ * asking, cell = static_cast<double>(cell_q20);
        for (int row = 0; row < view_.rows; ++row) {
            const double u = first + cell * row;
            if (u > profile_.end) return;
            while (at_u != last && at_u[1].from <= u)
                ++at_u;
            const double above_m = at_u->at(u) - (metres_of(view_.height_q16(asking, row)) + rise);
            if (above_m < -doubt_m_) continue;
            if (above_m <= doubt_m_) {
                ++marched_;
                if (!sun_hidden(view_, asking, row, {.first = d})) continue;
            }
            const GridPlace at = place_of(field_, sun_, asking, row);
            map.set(at.x, at.y);
        }
    }

    /// Between a sample's own line and the next, the ray passes over one diagonal at most.
    void add_first_strips(ShadowBits& map) const {
        if (!view_.crossed_diagonals) return;
        for (int line = 1; line < view_.lines; ++line) {
            for (int row = 0; row + 1 < view_.rows; ++row) {
                const std::int32_t own = view_.height_q16(line, row);
                // Quickly: both ends have to be low enough.
                if (view_.height_q16(line - 1, row) <= own && view_.height_q16(line, row + 1) <= own)
                    continue;
                if (!sun_hidden(view_, line, row, {.first = 0, .last = 1})) continue;
                const GridPlace at = place_of(field_, sun_, line, row);
                map.set(at.x, at.y);
            }
        }
    }

    const HeightField& field_;
    const HeightSun& sun_;
    SunView view_;
    double rise_m_, tolerance_m_ = 0, doubt_m_ = 0;
    std::vector<double> before_, now_;
    Profile profile_, strip_, merged_;
    std::int64_t marched_ = 0;
};

}  // namespace

std::vector<ShadowBits> sweep_shadows(const HeightField& field, const HeightSun& sun,
                                      std::span<const int> thresholds, SweepStats* stats) {
    CHECK(std::all_of(thresholds.begin(), thresholds.end(), [](int d) { return d >= 0; }));
    return Sweep(field, sun).run(thresholds, stats);
}

std::vector<std::vector<ShadowBits>> sweep_suns(const HeightField& field, std::span<const HeightSun> suns,
                                                std::span<const int> thresholds, const Exec& exec) {
    std::vector<std::vector<ShadowBits>> maps(suns.size());
    parallel_for(suns.size(), exec,
                 [&](std::size_t i) { maps[i] = sweep_shadows(field, suns[i], thresholds); });
    return maps;
}

}  // namespace obscura
