// Bounds and integrals of masks and outlines.

#include "optics/aperture_extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/num.h"

namespace obscura {

namespace {

/// Calls visit(y, first, last) for every row with open texels [first, last].
template <class Visit>
void for_open_rows(ImageView<const float> mask, Visit&& visit) {
    for (int y = 0; y < mask.height; ++y) {
        const float* row = mask.row(y);
        int first = 0, last = mask.width - 1;
        while (first <= last && row[first] == 0)
            ++first;
        while (last >= first && row[last] == 0)
            --last;
        if (first <= last) visit(y, first, last);
    }
}

}  // namespace

OpenExtent open_extent(ImageView<const float> mask) {
    int left = mask.width, right = -1, top = mask.height, bottom = -1;
    for_open_rows(mask, [&](int y, int first, int last) {
        left = std::min(left, first);
        right = std::max(right, last);
        top = std::min(top, y);
        bottom = y;
    });
    if (right < 0) return {};
    return {right - left + 1, bottom - top + 1};
}

double fringes_to(ImageView<const float> mask, double u, double v) {
    double least = std::numeric_limits<double>::infinity(), largest = -least;
    for_open_rows(mask, [&](int y, int first, int last) {
        for (const int corner : {0, 1}) {
            const double a = u * first + v * (y + corner), b = u * (last + 1) + v * (y + corner);
            least = std::min({least, a, b});
            largest = std::max({largest, a, b});
        }
    });
    return largest > least ? largest - least : 0;
}

double transmitted_power(ImageView<const float> mask) {
    double sum = 0;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            const double f = static_cast<double>(mask(x, y));
            sum += f * f;
        }
    }
    return sum;
}

double light_past_line(ImageView<const float> mask, double frequency) {
    // Steps of the mask along both axes, closed beyond its sides: a straight border of any direction takes 4
    // / pi times its length of them on the average.
    double steps = 0;
    for (int y = 0; y <= mask.height; ++y) {
        for (int x = 0; x <= mask.width; ++x) {
            const auto at = [&](int i, int j) {
                const bool inside = i >= 0 && j >= 0 && i < mask.width && j < mask.height;
                return inside ? static_cast<double>(mask(i, j)) : 0.0;
            };
            const double here = at(x, y);
            steps += std::fabs(here - at(x - 1, y)) + std::fabs(here - at(x, y - 1));
        }
    }
    const double border = steps * (num::pi / 4);
    return border / (2 * num::pi * num::pi * num::pi * transmitted_power(mask) * frequency);
}

}  // namespace obscura
