#pragma once
// Elevation models as a grid of samples, and the triangles between them.

#include <cstdint>

#include "core/image.h"

namespace obscura {

/// How every cell of four samples is divided into two triangles. Falling: from the sample in the upper left
/// (north-west) to the lower right; rising: from the lower left to the upper right. Turning a grid by 90
/// degrees or mirroring it exchanges the two.
enum class Diagonal : std::uint8_t { falling, rising };

/// Heights in 1/65536 m, which reaches from -32768 to 32768 m in steps of 15 micrometres.
constexpr int height_fraction_bits = 16;
constexpr double height_unit_m = 1.0 / (1 << height_fraction_bits);
constexpr double largest_height_m = 32767.0;
constexpr int largest_height_field_side = 1 << 20;

/// A surface over a plane: sample (x, y) stands x * cell_x_m east and y * cell_y_m south of the north-western
/// corner, and triangles join the samples. Beyond the outermost samples there is nothing.
struct HeightField {
    Image<std::int32_t> height_q16;  ///< 1 to 2^20 samples a side
    double cell_x_m = 1, cell_y_m = 1;
    Diagonal diagonal = Diagonal::falling;

    int width() const { return height_q16.width; }
    int height() const { return height_q16.height; }
    friend bool operator==(const HeightField&, const HeightField&) = default;
};

/// The nearest representable height; |height_m| <= largest_height_m.
std::int32_t height_q16_of(double height_m);

constexpr double metres_of(std::int32_t height_q16) {
    return height_q16 * height_unit_m;
}

/// Broken preconditions end the process: sides, cell sizes that are positive and finite.
void check_height_field(const HeightField& field);

/// Least and greatest height.
struct HeightRange {
    std::int32_t least_q16 = 0, greatest_q16 = 0;
};
HeightRange height_range(const HeightField& field);

/// The same ground turned by 90 degrees clockwise (what was north is east), and mirrored east to west.
HeightField turned(const HeightField& field);
HeightField mirrored(const HeightField& field);

/// How much lower ground lies, as light sees it, at a distance of which the square is given: r^2 (1 -
/// refraction) / 2R, R = 6371 km, in metres.
double earth_drop_m(double distance_squared_m2, double refraction);

/// The same ground as light sees it over the round earth: lowered by r^2 (1 - refraction) / 2R, with r from
/// the grid's middle, R = 6371 km and the coefficient of terrestrial refraction (0.13 by day), after which
/// rays are straight. Heights are rounded once; from then on all is exact as for any field. A field that
/// would leave the range of heights is a broken precondition.
HeightField curved(const HeightField& field, double refraction);

}  // namespace obscura
