// Which method is cheapest: a fixed model of costs, fitted once to measurements on one thread with AVX-512,
// so that every machine makes the same choice (and so gives the same bits).
//
// Compared are the three that were ever the fastest in the bench, over all apertures, sizes and windows:
// runs, raster_fft and edges. Quads, singly, by shape, as one product or by levels, always lose to one of
// them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "optics/far_field_chirp.h"
#include "optics/far_field_methods.h"
#include "optics/far_field_plan.h"
#include "optics/field/natural_grid.h"
#include "optics/field/row_runs.h"

namespace obscura {
namespace {

// Nanoseconds.
constexpr double per_fft_sample = 0.95;  // sixteen sequences, times log2 of the length
constexpr double per_run_end = 3;        // sixteen frequencies
constexpr double per_phase = 2;          // sixteen frequencies of one edge
constexpr double per_transform = 26;     // of one interval, sixteen frequencies
constexpr double per_pixel = 0.3;        // stored
constexpr double per_texel = 0.1;        // searched for runs
constexpr double per_table_entry = 60;   // of natural grids, and of the chirp
constexpr double never = std::numeric_limits<double>::infinity();

/// What decides.
struct MaskFacts {
    int width = 0, height = 0;
    double runs = 0;
    bool mirrored = false;
    double columns = 0, rows = 0;  ///< at most so many of them differ from their neighbours

    double texels() const { return static_cast<double>(width) * height; }
};

bool same_rows(const RowRuns& runs, std::size_t a, std::size_t b) {
    const auto at = [&](std::size_t y) { return static_cast<std::size_t>(runs.first[y]); };
    const std::size_t count = at(a + 1) - at(a);
    bool same = count == at(b + 1) - at(b);
    for (std::size_t i = 0; same && i < count; ++i) {
        const std::size_t j = at(a) + i, k = at(b) + i;
        same =
            runs.begin[j] == runs.begin[k] && runs.end[j] == runs.end[k] && runs.weight[j] == runs.weight[k];
    }
    return same;
}

MaskFacts facts_of(const RowRuns& runs, int width, int height) {
    MaskFacts facts{width, height, static_cast<double>(runs.begin.size()), false, 0, 0};
    facts.mirrored = width % 2 == 0 && same_left_and_right(runs, width);
    std::vector<std::uint8_t> changes(static_cast<std::size_t>(width) + 1);
    for (const auto* ends : {&runs.begin, &runs.end}) {
        for (const std::int32_t x : *ends)
            changes[static_cast<std::size_t>(x)] = 1;
    }
    facts.columns = static_cast<double>(std::count(changes.begin(), changes.end(), 1));
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        facts.rows += y == 0 || !same_rows(runs, y, y - 1) ? 1 : 0;
    return facts;
}

double fft_ns(int log2_length) {
    return per_fft_sample * std::max(1, log2_length) * (1 << log2_length);
}

double pixels_of(const FrequencyGrid& grid) {
    return static_cast<double>(grid.width) * grid.height;
}

/// Groups of sixteen columns of one period that the grid shows.
double groups_of(const NaturalAxis& u) {
    return std::max(1.0, std::min(u.period() / 32.0, u.count / 16.0 + 1));
}

double natural_runs_ns(const MaskFacts& m, const NaturalGrid& grid) {
    const double groups = groups_of(grid.u), parts = m.mirrored ? 1 : 2;
    return per_table_entry * (grid.u.period() + grid.v.period()) +
           groups * parts * (0.5 * fft_ns(grid.v.log2_period) + per_run_end * m.runs) +
           groups * per_phase * parts * m.width;
}

double raster_fft_ns(const MaskFacts& m, const NaturalGrid& grid) {
    const double groups = groups_of(grid.u);
    // Rows are transposed on their way in and out.
    constexpr double per_transposed = 0.6;
    return per_table_entry * (grid.u.period() + grid.v.period()) +
           std::ceil(m.height / 32.0) * fft_ns(grid.u.log2_period) + groups * fft_ns(grid.v.log2_period) +
           per_transposed * grid.u.period() * m.height;
}

double chirp_ns(const MaskFacts& m, const FrequencyGrid& grid) {
    const double groups = std::ceil(grid.width / 16.0);
    const int log2 = chirp_log2_length(m.height, grid.height);
    if (log2 == 0) return never;
    const double length = 1 << log2;
    const double tiles = std::ceil(grid.height / (length - m.height + 1));
    const double sums =
        std::min(per_transform * m.runs, per_transform * m.width / 2 + 2 * per_run_end * m.runs);
    constexpr double per_product = 2.5;  // of sixteen sequences with the chirp and its spectrum
    return per_table_entry * (length + tiles * m.height + grid.height) +
           groups * (sums + tiles * (2 * fft_ns(log2) + per_product * length));
}

/// From an upper bound of the number of terms, before they are counted.
double edges_ns(const MaskFacts& m, const FrequencyGrid& grid) {
    const double terms = std::min(m.columns, m.rows) * (m.mirrored ? 0.5 : 1);
    const double per_product = m.mirrored ? 0.05 : 0.1;  // of one term and pixel
    const double intervals = m.columns + terms * m.runs / m.height;
    return m.texels() + per_product * terms * pixels_of(grid) + intervals * (grid.width + grid.height);
}

struct Choice {
    FarFieldMethod method;
    double ns;
};

std::string reason_of(const Choice& best, const Choice& other, const MaskFacts& m, bool natural) {
    const std::string rest =
        other.ns == never
            ? std::string("nothing else serves")
            : fmt::format("{} about {:.3g} ms", far_field_method_name(other.method), other.ns * 1e-6);
    return fmt::format("{}: about {:.3g} ms on one thread ({}); {} runs in {} rows, {} grid",
                       far_field_method_name(best.method), best.ns * 1e-6, rest, m.runs, m.height,
                       natural ? "natural" : "free");
}

/// Throws when a method that was asked for cannot serve.
void check_method(const Aperture& aperture, const FrequencyGrid& grid, bool natural,
                  const FarFieldParams& params) {
    const FarFieldMethod method = params.method;
    const auto refuse = [&](const char* why) {
        throw InputError("far field",
                         fmt::format("method {} cannot serve: {}", far_field_method_name(method), why));
    };
    if (!natural && (method == FarFieldMethod::levels || method == FarFieldMethod::raster_fft))
        refuse("the grid's step is not 1 / a power of two that is at least the mask's side");
    if (!natural && method == FarFieldMethod::runs &&
        chirp_log2_length(aperture.mask.height, grid.height) == 0) {
        throw LimitError(
            fmt::format("far field: method runs serves masks of at most 65536 rows, not {}; the "
                        "method edges serves any",
                        aperture.mask.height));
    }
    if (method == FarFieldMethod::polygon && !aperture.outline.disjoint)
        refuse("no outline of disjoint loops is known of this aperture");
    if (params.cull < 0 || !std::isfinite(params.cull))
        throw InputError("far field", "cull must be 0 or more");
    if (params.cull > 0 && method != FarFieldMethod::automatic && method != FarFieldMethod::edges)
        refuse("only the method edges can cull");
}

}  // namespace

void check_grid(const FrequencyGrid& grid) {
    if (grid.width < 1 || grid.height < 1) {
        throw InputError("far field",
                         fmt::format("a grid of {} x {} frequencies is empty", grid.width, grid.height));
    }
    const auto check_axis = [](const char* axis, double first, double step, int count) {
        if (step > 0 && std::isfinite(first) && std::isfinite(step) && std::isfinite(first + step * count))
            return;
        throw InputError("far field",
                         fmt::format("frequencies along {} must be finite and their step positive, not from "
                                     "{} in steps of {} cycles per texel",
                                     axis, first, step));
    };
    check_axis("u", grid.first_u, grid.step_u, grid.width);
    check_axis("v", grid.first_v, grid.step_v, grid.height);
}

FarFieldReport plan_far_field(const Aperture& aperture, const RowRuns& runs, const FrequencyGrid& grid,
                              const FarFieldParams& params) {
    check_grid(grid);
    const auto mask = aperture.mask.view();
    const auto natural = natural_grid(mask.width, mask.height, grid);
    check_method(aperture, grid, natural.has_value(), params);
    FarFieldReport report;
    report.method = params.method;
    if (params.method != FarFieldMethod::automatic) {
        report.reason = fmt::format("{}: asked for", far_field_method_name(params.method));
        return report;
    }
    const MaskFacts m = facts_of(runs, mask.width, mask.height);
    const bool whole = natural && natural_is_cheaper(*natural, m.height, grid);
    const double shared = per_pixel * pixels_of(grid) + per_texel * m.texels();
    std::vector<Choice> choices{
        {FarFieldMethod::runs, shared + (whole ? natural_runs_ns(m, *natural) : chirp_ns(m, grid))},
        {FarFieldMethod::raster_fft, natural ? shared + raster_fft_ns(m, *natural) : never},
        {FarFieldMethod::edges, shared + edges_ns(m, grid)}};
    std::sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) { return a.ns < b.ns; });
    if (params.cull > 0) {
        const auto edges = std::find_if(choices.begin(), choices.end(),
                                        [](const Choice& c) { return c.method == FarFieldMethod::edges; });
        std::rotate(choices.begin(), edges, edges + 1);
    }
    report.method = choices[0].method;
    report.cost_ms = choices[0].ns * 1e-6;
    report.reason = reason_of(choices[0], choices[1], m, natural.has_value());
    if (params.cull > 0) report.reason += "; only edges can cull";
    return report;
}

FarFieldReport plan_far_field(const Aperture& aperture, const FrequencyGrid& grid,
                              const FarFieldParams& params) {
    return plan_far_field(aperture, row_runs(aperture.mask.view(), best_isa()), grid, params);
}

}  // namespace obscura
