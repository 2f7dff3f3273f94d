#pragma once
// Frequencies at which a far field is wanted.

namespace obscura {

/// Frequencies first_u + x step_u, first_v + y step_v of the pixels (x, y); cycles per texel, steps > 0.
struct FrequencyGrid {
    int width = 0, height = 0;
    double first_u = 0, first_v = 0;
    double step_u = 0, step_v = 0;
    friend bool operator==(const FrequencyGrid&, const FrequencyGrid&) = default;
};

/// Frequency (centre_u, centre_v) at pixel (width / 2, height / 2).
FrequencyGrid centred_grid(int width, int height, double step, double centre_u = 0, double centre_v = 0);

/// The half of a centred grid that holds everything of a real mask's pattern: u = 0 to (width / 2) step_u in
/// width / 2 + 1 columns, every row as in centred_grid().
FrequencyGrid half_grid(int width, int height, double step);

}  // namespace obscura
