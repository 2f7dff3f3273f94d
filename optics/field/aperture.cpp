// Sums, reductions and symmetries of masks.

#include "optics/field/aperture.h"

#include <algorithm>

namespace obscura {

double open_area(ImageView<const float> mask) {
    double sum = 0;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x)
            sum += static_cast<double>(mask(x, y));
    }
    return sum;
}

Aperture reduce(const Aperture& aperture, int levels, bool binary) {
    CHECK(levels >= 0 && levels < 16);
    const int side = 1 << levels;
    const Image<float>& from = aperture.mask;
    Aperture to;
    to.pitch_m = aperture.pitch_m * side;
    to.mask = Image<float>((from.width + side - 1) / side, (from.height + side - 1) / side);
    const double share = 1.0 / (static_cast<double>(side) * side);
    for (int y = 0; y < to.mask.height; ++y) {
        for (int x = 0; x < to.mask.width; ++x) {
            double sum = 0;
            for (int j = y * side; j < std::min((y + 1) * side, from.height); ++j) {
                for (int i = x * side; i < std::min((x + 1) * side, from.width); ++i)
                    sum += static_cast<double>(from(i, j));
            }
            const double mean = sum * share;
            to.mask(x, y) = binary ? (mean >= 0.5 ? 1.0f : 0.0f) : static_cast<float>(mean);
        }
    }
    to.outline = aperture.outline;
    for (auto& loop : to.outline.loops) {
        for (Vec2d& p : loop)
            p = {p.x / side, p.y / side};
    }
    return to;
}

MaskSymmetry mask_symmetry(ImageView<const float> mask) {
    MaskSymmetry symmetry{true, true};
    for (int y = 0; y < mask.height && (symmetry.left_right || symmetry.top_bottom); ++y) {
        const float* row = mask.row(y);
        const float* opposite = mask.row(mask.height - 1 - y);
        for (int x = 0; x < mask.width; ++x) {
            symmetry.left_right = symmetry.left_right && row[x] == row[mask.width - 1 - x];
            symmetry.top_bottom = symmetry.top_bottom && row[x] == opposite[x];
        }
    }
    return symmetry;
}

}  // namespace obscura
