#include "optics/thesis/scaled_colours.h"

#include "core/error.h"

namespace obscura {

FrequencyGrid pattern_grid(const FrequencyGrid& grid, std::span<const ScaledColour> colours, double step) {
    CHECK(!colours.empty());
    return scaled_cover(grid, colours.back().scale, colours.front().scale, step);
}

void add_colours(const PowerImage& pattern, const FrequencyGrid& grid, std::span<const ScaledColour> colours,
                 Image<Vec3f>& sum, const Exec& exec) {
    for (const ScaledColour& colour : colours)
        add_scaled_power(pattern, grid, colour.scale, colour.weight, PowerInterpolation::cubic, sum, exec);
}

void add_colours_in_batches(const PowerImage& pattern, const FrequencyGrid& grid,
                            std::span<const ScaledColour> colours, Image<Vec3f>& sum, const Exec& exec) {
    CHECK(colours.size() == 4 * batch_lookups);
    // Colour 4 j + i has the scale of colour 4 j times that of ladder[i].
    double ladder[4];
    for (std::size_t i = 0; i < 4; ++i)
        ladder[i] = colours[i].scale / colours[0].scale;
    const PowerBatch batch = gather_batch(pattern, pattern.grid, ladder, PowerInterpolation::cubic, exec);
    for (std::size_t at = 0; at < colours.size(); at += 4) {
        const Vec3d four[4] = {colours[at].weight, colours[at + 1].weight, colours[at + 2].weight,
                               colours[at + 3].weight};
        add_scaled_batch(batch, grid, colours[at].scale, four, PowerInterpolation::cubic, sum, exec);
    }
}

}  // namespace obscura
