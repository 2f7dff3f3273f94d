#include "raster/heights/height_field.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

Diagonal other(Diagonal d) {
    return d == Diagonal::falling ? Diagonal::rising : Diagonal::falling;
}

}  // namespace

std::int32_t height_q16_of(double height_m) {
    CHECK(std::fabs(height_m) <= largest_height_m);
    return static_cast<std::int32_t>(std::floor(height_m / height_unit_m + 0.5));
}

void check_height_field(const HeightField& field) {
    CHECK(field.width() >= 1 && field.width() <= largest_height_field_side);
    CHECK(field.height() >= 1 && field.height() <= largest_height_field_side);
    CHECK(std::isfinite(field.cell_x_m) && field.cell_x_m > 0);
    CHECK(std::isfinite(field.cell_y_m) && field.cell_y_m > 0);
}

HeightRange height_range(const HeightField& field) {
    const auto [least, greatest] =
        std::minmax_element(field.height_q16.pixels.begin(), field.height_q16.pixels.end());
    return {*least, *greatest};
}

HeightField turned(const HeightField& field) {
    HeightField out{Image<std::int32_t>(field.height(), field.width()), field.cell_y_m, field.cell_x_m,
                    other(field.diagonal)};
    for (int y = 0; y < field.height(); ++y) {
        for (int x = 0; x < field.width(); ++x)
            out.height_q16(field.height() - 1 - y, x) = field.height_q16(x, y);
    }
    return out;
}

HeightField mirrored(const HeightField& field) {
    HeightField out = field;
    out.diagonal = other(field.diagonal);
    for (int y = 0; y < field.height(); ++y)
        std::reverse(out.height_q16.row(y), out.height_q16.row(y) + field.width());
    return out;
}

double earth_drop_m(double distance_squared_m2, double refraction) {
    constexpr double earth_radius_m = 6'371'000;
    return distance_squared_m2 * (1 - refraction) / (2 * earth_radius_m);
}

HeightField curved(const HeightField& field, double refraction) {
    HeightField out = field;
    for (int y = 0; y < field.height(); ++y) {
        const double north_m = (y - 0.5 * (field.height() - 1)) * field.cell_y_m;
        for (int x = 0; x < field.width(); ++x) {
            const double east_m = (x - 0.5 * (field.width() - 1)) * field.cell_x_m;
            const double drop_m = earth_drop_m(east_m * east_m + north_m * north_m, refraction);
            out.height_q16(x, y) = height_q16_of(metres_of(field.height_q16(x, y)) - drop_m);
        }
    }
    return out;
}

}  // namespace obscura
