#include "lessons/quad_fields.h"

#include <algorithm>
#include <cmath>

#include "optics/far_field_methods.h"
#include "optics/thesis/far_field.h"

namespace obscura {
namespace {

Field empty_field(const FrequencyGrid& grid) {
    return {Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
}

FieldTarget target_of(Field& field) {
    return {field.re.pixels.data(), field.im.pixels.data(), nullptr, field.re.width};
}

}  // namespace

Field field_of_quads(const QuadList& quads, const FrequencyGrid& grid, const Exec& exec) {
    Field field = empty_field(grid);
    far_field_direct(quads, grid, target_of(field), exec);
    return field;
}

Field field_of_runs(ImageView<const float> mask, const FrequencyGrid& grid, const Exec& exec) {
    Field field = empty_field(grid);
    far_field_runs(mask, row_runs(mask, exec.isa), grid, target_of(field), exec);
    return field;
}

Field field_anew(const Image<float>& mask, const FrequencyGrid& grid, const Exec& exec) {
    Aperture aperture;
    aperture.mask = mask;
    Field field = empty_field(grid);
    far_field_into(aperture, grid, {}, target_of(field), exec);
    return field;
}

Image<float> power_of(const Field& field) {
    Image<float> power(field.re.width, field.re.height);
    for (std::size_t i = 0; i < power.pixels.size(); ++i)
        power.pixels[i] = field.re.pixels[i] * field.re.pixels[i] + field.im.pixels[i] * field.im.pixels[i];
    return power;
}

double largest_difference(const Field& a, const Field& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.re.pixels.size(); ++i) {
        const auto re = static_cast<double>(a.re.pixels[i] - b.re.pixels[i]),
                   im = static_cast<double>(a.im.pixels[i] - b.im.pixels[i]);
        most = std::max(most, re * re + im * im);
    }
    return std::sqrt(most);
}

}  // namespace obscura
