#include "stereo/disparity_system.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// Calls term(weight, a, b, wanted) for each pair term weight * (x_b - x_a - wanted)^2; pixels by index.
template <class Term>
void pair_terms(const DisparitySystem& s, Term&& term) {
    const int width = s.width(), height = s.height();
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    const double weight = 2.0 * static_cast<double>(s.gradient_weight);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (s.valid(x, y) == 0) continue;
            if (x + 1 < width && s.valid(x + 1, y) != 0)
                term(weight, at(x, y), at(x + 1, y), static_cast<double>(s.gradient_x(x, y)));
            if (y + 1 < height && s.valid(x, y + 1) != 0)
                term(weight, at(x, y), at(x, y + 1), static_cast<double>(s.gradient_y(x, y)));
        }
    }
    for (const MatchingSet& set : s.sets) {
        if (s.valid(set.source_x, set.source_y) == 0) continue;
        const std::size_t source = at(set.source_x, set.source_y);
        for (const MatchedPixel& p : set.members) {
            const std::size_t member = at(p.x, p.y);
            if (member != source && s.valid(p.x, p.y) != 0)
                term(static_cast<double>(set.weight), source, member, static_cast<double>(p.target));
        }
    }
}

/// Calls term(weight, a, wanted) for each term weight * (x_a - wanted)^2.
template <class Term>
void pixel_terms(const DisparitySystem& s, Term&& term) {
    for (std::size_t i = 0; i < s.original.pixels.size(); ++i) {
        if (s.valid.pixels[i] == 0) continue;
        term(static_cast<double>(s.epsilon), i, static_cast<double>(s.original.pixels[i]));
        const auto anchor = static_cast<double>(s.anchor_weight.pixels[i]);
        if (anchor > 0) term(anchor, i, static_cast<double>(s.anchor_value.pixels[i]));
    }
}

void check(const DisparitySystem& s, const DisparityMap& x) {
    CHECK(x.width == s.width() && x.height == s.height() && s.valid.pixels.size() == x.pixels.size() &&
          s.gradient_x.pixels.size() == x.pixels.size() && s.gradient_y.pixels.size() == x.pixels.size() &&
          s.anchor_weight.pixels.size() == x.pixels.size() &&
          s.anchor_value.pixels.size() == x.pixels.size());
}

}  // namespace

DisparitySystem unedited_system(const DisparityMap& original, const Image<std::uint8_t>& valid,
                                const Exec& exec) {
    const int width = original.width, height = original.height;
    DisparitySystem s;
    s.original = s.start = original;
    s.valid = valid.pixels.empty() ? Image<std::uint8_t>(width, height, 1) : valid;
    CHECK(s.valid.width == width && s.valid.height == height);
    s.gradient_x = s.gradient_y = s.anchor_weight = s.anchor_value = Image<float>(width, height);
    parallel_blocks(static_cast<std::size_t>(height), 32, exec, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            const float *here = original.row(y), *below = original.row(std::min(y + 1, height - 1));
            float *right = s.gradient_x.row(y), *down = s.gradient_y.row(y);
            for (int x = 0; x + 1 < width; ++x)
                right[x] = here[x + 1] - here[x];
            for (int x = 0; x < width; ++x)
                down[x] = below[x] - here[x];
        }
    });
    return s;
}

double energy(const DisparitySystem& s, const DisparityMap& x) {
    check(s, x);
    const auto value = [&](std::size_t i) { return static_cast<double>(x.pixels[i]); };
    double sum = 0;
    pair_terms(s, [&](double weight, std::size_t a, std::size_t b, double wanted) {
        const double miss = value(b) - value(a) - wanted;
        sum += weight * miss * miss;
    });
    pixel_terms(s, [&](double weight, std::size_t a, double wanted) {
        const double miss = value(a) - wanted;
        sum += weight * miss * miss;
    });
    return sum;
}

namespace {

/// Pull between x_a and x_b = x_a + wanted for each i; 0 where a pixel is not valid.
struct PairRow {
    const float *a, *b, *wanted;
    const std::uint8_t *valid_a, *valid_b;
    double pull(double weight, std::size_t i) const {
        return weight *
               (static_cast<double>(wanted[i]) - (static_cast<double>(b[i]) - static_cast<double>(a[i])));
    }
};

bool all_valid(const std::uint8_t* row, std::size_t count) {
    return std::memchr(row, 0, count) == nullptr;
}

/// out[i] += sign * pull, for pairs of row `upper` and the next.
void add_column_pulls(const PairRow& pairs, std::size_t count, double weight, bool valid, double* out) {
    if (valid) {
        for (std::size_t i = 0; i < count; ++i)
            out[i] += pairs.pull(weight, i);
    } else {
        for (std::size_t i = 0; i < count; ++i)
            out[i] += (pairs.valid_a[i] & pairs.valid_b[i]) != 0 ? pairs.pull(weight, i) : 0.0;
    }
}

}  // namespace

void residual_row(const DisparitySystem& s, const DisparityMap& x, int y, double* out) {
    const auto width = static_cast<std::size_t>(s.width());
    const double weight = 2.0 * static_cast<double>(s.gradient_weight);
    const auto epsilon = static_cast<double>(s.epsilon);
    const std::uint8_t* valid = s.valid.row(y);
    const float *value = x.row(y), *original = s.original.row(y);
    const float *anchor = s.anchor_weight.row(y), *wanted = s.anchor_value.row(y);
    const bool here = all_valid(valid, width);
    // A pair pulls its two ends by the same number, computed twice: nothing is lost in the sum.
    const PairRow right{value, value + 1, s.gradient_x.row(y), valid, valid + 1};
    for (std::size_t i = 0; i < width; ++i) {
        const auto v = static_cast<double>(value[i]);
        out[i] = epsilon * (static_cast<double>(original[i]) - v) +
                 static_cast<double>(anchor[i]) * (static_cast<double>(wanted[i]) - v);
    }
    if (here) {
        for (std::size_t i = 0; i + 1 < width; ++i)
            out[i] -= right.pull(weight, i);
        for (std::size_t i = 1; i < width; ++i)
            out[i] += right.pull(weight, i - 1);
    } else {
        for (std::size_t i = 0; i + 1 < width; ++i) {
            if ((valid[i] & valid[i + 1]) == 0) continue;
            out[i] -= right.pull(weight, i);
            out[i + 1] += right.pull(weight, i);
        }
    }
    if (y > 0) {
        const PairRow up{x.row(y - 1), value, s.gradient_y.row(y - 1), s.valid.row(y - 1), valid};
        add_column_pulls(up, width, weight, here && all_valid(up.valid_a, width), out);
    }
    if (y + 1 < s.height()) {
        const PairRow down{value, x.row(y + 1), s.gradient_y.row(y), valid, s.valid.row(y + 1)};
        add_column_pulls(down, width, -weight, here && all_valid(down.valid_b, width), out);
    }
    if (here) return;
    for (std::size_t i = 0; i < width; ++i)
        out[i] = valid[i] != 0 ? out[i] : 0.0;
}

Image<double> residual(const DisparitySystem& s, const DisparityMap& x) {
    check(s, x);
    Image<double> r(s.width(), s.height());
    for (int y = 0; y < s.height(); ++y)
        residual_row(s, x, y, r.row(y));
    set_residuals(s, x, [&](int i, int j, double value) { r(i, j) += value; });
    return r;
}

}  // namespace obscura
