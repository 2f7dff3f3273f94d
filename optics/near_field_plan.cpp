// Which strategy is cheapest: a model of costs with constants measured once, so that a choice is the same on
// every machine.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/error.h"
#include "core/num.h"
#include "optics/field/mask_changes.h"
#include "optics/near_field_convolve.h"
#include "optics/near_field_methods.h"

namespace obscura {
namespace {

/// Nanoseconds on one thread (AVX-512).
constexpr double integral_ns = 60;     ///< one Fresnel integral
constexpr double fft_ns = 1.15;        ///< per element and binary logarithm, sixteen lanes
constexpr double multiply_ns = 2.5;    ///< per element, sixteen lanes
constexpr double change_ns = 2.2;      ///< per change or interval end, sixteen lanes
constexpr double plan_ns = 26;         ///< twiddles, per element
constexpr double product_ns = 0.105;   ///< per term and pixel
constexpr double texel_scan_ns = 0.3;  ///< finding changes
constexpr double texel_term_ns = 1.2;  ///< grouping columns and rows
constexpr double end_term_ns = 110;    ///< the same, per end of a run in distinct ones
constexpr double texel_lane_ns = 0.8;  ///< bringing sixteen rows side by side
constexpr double pixel_ns = 1.2;       ///< writing both parts

constexpr double never = std::numeric_limits<double>::infinity();

/// A number that every different line of texels has for its own (but for chance).
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// A line of texels by its number, and how many runs end in it.
struct NamedLine {
    std::uint64_t name = 0;  ///< 0: no texel is open
    std::int64_t ends = 0;
};

/// How many different lines are not empty; `ends` gets those of one of each.
std::int64_t distinct(std::vector<NamedLine> lines, std::int64_t& ends) {
    std::sort(lines.begin(), lines.end(),
              [](const NamedLine& a, const NamedLine& b) { return a.name < b.name; });
    std::int64_t different = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].name == 0 || (i > 0 && lines[i].name == lines[i - 1].name)) continue;
        ++different;
        ends += lines[i].ends;
    }
    return different;
}

/// What the costs depend on, told from the changes alone.
struct MaskCounts {
    std::int64_t columns = 0, rows = 0;  ///< distinct ones, empty ones not counted
    std::int64_t ends = 0;               ///< of runs in the distinct rows, and of bands of equal rows
    std::int64_t terms() const { return std::min(columns, rows); }
};

MaskCounts count(const NearFieldCase& c) {
    const LineChanges& changes = c.changes;
    MaskCounts counts;
    // Sums of random multiples of the changes: along a row they name the row; down a column, added up from
    // the left, the column.
    std::vector<NamedLine> rows, columns(static_cast<std::size_t>(c.mask.width) + 1);
    for (std::size_t y = 0; y < static_cast<std::size_t>(c.mask.height); ++y) {
        NamedLine row{0, changes.first[y + 1] - changes.first[y]};
        for (auto i = static_cast<std::size_t>(changes.first[y]);
             i < static_cast<std::size_t>(changes.first[y + 1]); ++i) {
            const auto edge = static_cast<std::size_t>(changes.edge[i]);
            const auto weight =
                static_cast<std::uint64_t>(static_cast<std::int64_t>(changes.weight[i] * 0x1p40));
            row.name += weight * mixed(edge + 1);
            columns[edge].name += weight * mixed(y + 1);
        }
        if (rows.empty() || row.name != rows.back().name) counts.ends += 2;  // a band of equal rows
        rows.push_back(row);
    }
    for (std::size_t x = 1; x < columns.size(); ++x)
        columns[x].name += columns[x - 1].name;
    counts.rows = distinct(std::move(rows), counts.ends);
    std::int64_t unused = 0;
    counts.columns = distinct(std::move(columns), unused);
    return counts;
}

double pixels_of(const PlaneGrid& grid) {
    return static_cast<double>(grid.width) * grid.height;
}

double texels_of(const NearFieldCase& c) {
    return static_cast<double>(c.mask.width) * c.mask.height;
}

/// Rows of one axis for `edges` of its edges.
double table_cost_ns(const PlaneAxis& axis, double edges) {
    double entries = edges * axis.pixels;
    if (const std::optional<StepRatio> ratio = step_ratio(axis.step))
        entries = std::min<double>(entries,
                                   double{1} * ratio->q * axis.texels + double{1} * ratio->p * axis.pixels);
    return integral_ns * entries;
}

/// Kernels of one axis, and the transforms of `columns` columns along it.
double convolution_cost_ns(const PlaneAxis& axis, double columns) {
    const double length = ColumnConvolution::transform_length(axis);
    if (length == 0) return never;
    const StepRatio ratio = *step_ratio(axis.step);
    const double kernels = std::min(ratio.q, axis.pixels);
    const double span = double{1} * axis.pixels * ratio.p / ratio.q;
    const double transform = fft_ns * length * num::log2(length);
    return kernels * (axis.texels + span) * integral_ns + plan_ns * length + transform +
           std::ceil(columns / 16) * ((1 + kernels) * transform + kernels * multiply_ns * length);
}

double edges_cost_ns(const NearFieldCase& c, const MaskCounts& counts) {
    const auto [columns, rows] = part_to_compute(c);
    const PlaneAxis x = c.horizontal(), y = c.vertical();
    const double terms = static_cast<double>(counts.terms());
    const double ends = static_cast<double>(counts.ends);
    const double edges_x = std::min<double>(c.mask.width, 2 * static_cast<double>(counts.columns)),
                 edges_y = std::min<double>(c.mask.height, 2 * static_cast<double>(counts.rows));
    return texel_term_ns * texels_of(c) + end_term_ns * ends + table_cost_ns(x, edges_x) +
           table_cost_ns(y, edges_y) + change_ns * ends * (columns + rows) / 16 +
           product_ns * terms * columns * rows + pixel_ns * pixels_of(c.grid);
}

double hybrid_cost_ns(const NearFieldCase& c, const MaskCounts& counts) {
    const PlaneAxis x = c.horizontal();
    const double columns = part_to_compute(c).columns;
    const double edges = std::min<double>(c.mask.width, 2 * static_cast<double>(counts.columns));
    const double ends = static_cast<double>(c.changes.edge.size()) + c.mask.height;
    return texel_scan_ns * texels_of(c) + table_cost_ns(x, edges) + change_ns * ends * columns / 16 +
           convolution_cost_ns(c.vertical(), columns) + pixel_ns * pixels_of(c.grid);
}

double fft_cost_ns(const NearFieldCase& c) {
    return convolution_cost_ns(c.horizontal(), c.mask.height) +
           convolution_cost_ns(c.vertical(), c.grid.width) +
           texel_lane_ns * (texels_of(c) + 2.0 * c.mask.height * c.grid.width) + pixel_ns * pixels_of(c.grid);
}

struct Choice {
    NearFieldMethod method;
    double ms;
};

}  // namespace

NearFieldReport plan_near_field_case(const NearFieldCase& c, const NearFieldParams& params) {
    const NearFieldMethod method = params.method;
    if (!(params.cull >= 0) || !std::isfinite(params.cull))
        throw InputError("near field", "cull must be 0 or more");
    if (params.cull > 0 && method != NearFieldMethod::automatic && method != NearFieldMethod::edges) {
        throw InputError("near field", fmt::format("method {} cannot serve: only the method edges can cull",
                                                   near_field_method_name(method)));
    }
    const bool convolves = method == NearFieldMethod::hybrid || method == NearFieldMethod::fft;
    const bool along_y = ColumnConvolution::transform_length(c.vertical()) > 0;
    const bool along_x = ColumnConvolution::transform_length(c.horizontal()) > 0;
    if (convolves && !(along_y && (along_x || method == NearFieldMethod::hybrid))) {
        throw InputError(
            "", fmt::format("near field by {}: the plane's step must be a ratio p / q of texels with "
                            "q up to 16, and mask and plane together at most 65536 texels long",
                            near_field_method_name(method)));
    }
    NearFieldReport report;
    report.method = method;
    report.reason = fmt::format("{}: as asked for", near_field_method_name(method));
    if (method != NearFieldMethod::automatic) return report;

    const MaskCounts counts = count(c);
    std::array<Choice, 3> choices{Choice{NearFieldMethod::edges, edges_cost_ns(c, counts) * 1e-6},
                                  Choice{NearFieldMethod::hybrid, hybrid_cost_ns(c, counts) * 1e-6},
                                  Choice{NearFieldMethod::fft, fft_cost_ns(c) * 1e-6}};
    std::stable_sort(choices.begin(), choices.end(),
                     [](const Choice& a, const Choice& b) { return a.ms < b.ms; });
    if (params.cull > 0) {
        const auto edges = std::find_if(choices.begin(), choices.end(), [](const Choice& choice) {
            return choice.method == NearFieldMethod::edges;
        });
        std::rotate(choices.begin(), edges, edges + 1);
    }
    report.method = choices[0].method;
    report.cost_ms = choices[0].ms;
    report.edges = counts.terms();
    report.reason = fmt::format("{}: {:.3g} ms for {} distinct columns or rows and {} changes; ",
                                near_field_method_name(choices[0].method), choices[0].ms, counts.terms(),
                                c.changes.edge.size());
    report.reason +=
        std::isfinite(choices[1].ms)
            ? fmt::format("next {} with {:.3g} ms", near_field_method_name(choices[1].method), choices[1].ms)
            : std::string("the plane's step allows no convolution");
    if (params.cull > 0) report.reason += "; only edges can cull";
    return report;
}

}  // namespace obscura
