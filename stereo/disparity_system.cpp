#include "stereo/disparity_system.h"

#include "core/error.h"

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
        const std::size_t source = at(set.source_x, set.source_y);
        for (const MatchedPixel& p : set.members) {
            const std::size_t member = at(p.x, p.y);
            if (member != source)
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

DisparitySystem unedited_system(const DisparityMap& original, const Image<std::uint8_t>& valid) {
    const int width = original.width, height = original.height;
    DisparitySystem s;
    s.original = s.start = original;
    s.valid = valid.pixels.empty() ? Image<std::uint8_t>(width, height, 1) : valid;
    CHECK(s.valid.width == width && s.valid.height == height);
    s.gradient_x = s.gradient_y = s.anchor_weight = s.anchor_value = Image<float>(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (x + 1 < width) s.gradient_x(x, y) = original(x + 1, y) - original(x, y);
            if (y + 1 < height) s.gradient_y(x, y) = original(x, y + 1) - original(x, y);
        }
    }
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

void residual_row(const DisparitySystem& s, const DisparityMap& x, int y, double* out) {
    const auto width = static_cast<std::size_t>(s.width());
    const double weight = 2.0 * static_cast<double>(s.gradient_weight);
    const std::uint8_t* valid = s.valid.row(y);
    const float *value = x.row(y), *original = s.original.row(y);
    const float *anchor = s.anchor_weight.row(y), *wanted = s.anchor_value.row(y);
    for (std::size_t i = 0; i < width; ++i) {
        const auto v = static_cast<double>(value[i]);
        out[i] = static_cast<double>(s.epsilon) * (static_cast<double>(original[i]) - v) +
                 static_cast<double>(anchor[i]) * (static_cast<double>(wanted[i]) - v);
    }
    // Each pair pulls its two ends by the same number, so that nothing is lost in the sum.
    const float* right = s.gradient_x.row(y);
    double before = 0;
    for (std::size_t i = 0; i < width; ++i) {
        double pull = 0;
        if (i + 1 < width && (valid[i] & valid[i + 1]) != 0) {
            pull = weight * (static_cast<double>(right[i]) -
                             (static_cast<double>(value[i + 1]) - static_cast<double>(value[i])));
        }
        out[i] += before - pull;
        before = pull;
    }
    const auto add_pairs = [&](int upper, double sign) {
        const float *a = x.row(upper), *b = x.row(upper + 1), *down = s.gradient_y.row(upper);
        const std::uint8_t *above = s.valid.row(upper), *below = s.valid.row(upper + 1);
        for (std::size_t i = 0; i < width; ++i) {
            const double pull = weight * (static_cast<double>(down[i]) -
                                          (static_cast<double>(b[i]) - static_cast<double>(a[i])));
            out[i] += (above[i] & below[i]) != 0 ? sign * pull : 0.0;
        }
    };
    if (y > 0) add_pairs(y - 1, 1.0);
    if (y + 1 < s.height()) add_pairs(y, -1.0);
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
