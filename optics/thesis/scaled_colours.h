#pragma once
// A far field's colours from one pattern, looked up at the scale of every wavelength: the thesis's full mode
// (section 3.4.3, equations 3.15 to 3.17) and its batch mode (figure 3.4).

#include <span>

#include "optics/thesis/spectral_lookup.h"

namespace obscura {

/// One wavelength: `weight` times the pattern at `scale` times the frequency (rho of 3.15).
struct ScaledColour {
    double scale = 1;
    Vec3d weight;
};

/// So many wavelengths the thesis takes; in its batch mode as so many lookups of four.
constexpr int full_lookups = 60, batch_lookups = 15;

/// Where the pattern must be known to serve colours of descending scale over `grid`. Throws as
/// scaled_cover().
FrequencyGrid pattern_grid(const FrequencyGrid& grid, std::span<const ScaledColour> colours, double step);

/// Adds every colour, one lookup each.
void add_colours(const PowerImage& pattern, const FrequencyGrid& grid, std::span<const ScaledColour> colours,
                 Image<Vec3f>& sum, const Exec& exec);

/// Adds 4 batch_lookups colours whose scales fall by one factor: four scaled copies of the pattern come
/// first, then each lookup takes a place of all four.
void add_colours_in_batches(const PowerImage& pattern, const FrequencyGrid& grid,
                            std::span<const ScaledColour> colours, Image<Vec3f>& sum, const Exec& exec);

}  // namespace obscura
