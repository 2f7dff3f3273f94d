#include "optics/field/near_field_axis.h"

#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "optics/field/fresnel.h"

namespace obscura {
namespace {

constexpr int largest_denominator = 16, largest_numerator = 4096;
constexpr double narrow_below = 1e-4;
constexpr int readable_beyond = 15;

}  // namespace

std::optional<StepRatio> step_ratio(double step) {
    for (int q = 1; q <= largest_denominator; ++q) {
        const double p = std::floor(step * q + 0.5);
        if (p >= 1 && p <= largest_numerator && std::fabs(step * q - p) <= 1e-14 * p)
            return StepRatio{static_cast<int>(p), q};
    }
    return std::nullopt;
}

bool is_narrow(const PlaneAxis& axis, double turns) {
    return 2 * std::sqrt(turns) * axis.texels < narrow_below;
}

EdgeTable::EdgeTable(const PlaneAxis& axis, double turns, const std::vector<std::int32_t>& edges,
                     const Exec& exec)
    : offset_(static_cast<std::size_t>(axis.texels) + 1, -1) {
    const std::optional<StepRatio> ratio = step_ratio(axis.step);
    const auto texels = static_cast<double>(axis.texels), pixels = static_cast<double>(axis.pixels);
    const bool shared =
        ratio && ratio->q * texels + ratio->p * pixels <= pixels * static_cast<double>(edges.size());
    if (shared && !is_narrow(axis, turns))
        fill_lattice(axis, turns, *ratio, exec);
    else
        fill_rows(axis, turns, edges, exec);
}

// Edge j and pixel i are q j - p i lattice steps apart (and a constant). Steps of the same remainder modulo p
// stand together, falling, so that a row is contiguous and rises with i.
void EdgeTable::fill_lattice(const PlaneAxis& axis, double turns, StepRatio ratio, const Exec& exec) {
    const std::int64_t p = ratio.p, q = ratio.q;
    const std::int64_t highest = q * axis.texels, lowest = -p * (axis.pixels - 1);
    struct Class {
        std::int64_t base, top;
    };
    std::vector<Class> classes(static_cast<std::size_t>(p));
    std::vector<std::int64_t> step_at;
    for (std::int64_t c = 0; c < p; ++c) {
        const std::int64_t top = highest - (highest - c) % p;
        classes[static_cast<std::size_t>(c)] = {static_cast<std::int64_t>(step_at.size()), top};
        for (std::int64_t k = top; k >= lowest; k -= p)
            step_at.push_back(k);
    }
    for (int j = 0; j <= axis.texels; ++j) {
        const Class& c = classes[static_cast<std::size_t>(q * j % p)];
        offset_[static_cast<std::size_t>(j)] = c.base + (c.top - q * j) / p;
    }
    re_.resize(step_at.size() + readable_beyond);
    im_.resize(step_at.size() + readable_beyond);
    const double origin = 0.5 * axis.texels + axis.first, unit = 1.0 / static_cast<double>(q);
    parallel_blocks(step_at.size(), 512, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const FresnelValue v = fresnel_at(turns, static_cast<double>(step_at[i]) * unit - origin);
            re_[i] = v.c;
            im_[i] = v.s;
        }
    });
}

void EdgeTable::fill_rows(const PlaneAxis& axis, double turns, const std::vector<std::int32_t>& edges,
                          const Exec& exec) {
    const auto pixels = static_cast<std::size_t>(axis.pixels);
    for (std::size_t e = 0; e < edges.size(); ++e)
        offset_[static_cast<std::size_t>(edges[e])] = static_cast<std::int64_t>(e * pixels);
    re_.resize(edges.size() * pixels + readable_beyond);
    im_.resize(re_.size());
    const bool narrow = is_narrow(axis, turns);
    const int middle = axis.texels / 2;
    parallel_for(edges.size(), exec, [&](std::size_t e) {
        for (int i = 0; i < axis.pixels; ++i) {
            // From the middle outwards, to either side: E is odd, so both begin at the same distance,
            // exactly.
            const double d = axis.distance(middle, i);
            FresnelValue v;
            if (!narrow) {
                v = fresnel_at(turns, axis.distance(edges[e], i));
            } else if (edges[e] >= middle) {
                v = fresnel_between(turns, d, edges[e] - middle);
            } else {
                v = fresnel_between(turns, -d, middle - edges[e]);
                v = {-v.c, -v.s};
            }
            re_[e * pixels + static_cast<std::size_t>(i)] = v.c;
            im_[e * pixels + static_cast<std::size_t>(i)] = v.s;
        }
    });
}

}  // namespace obscura
