#include "optics/half_plane.h"

#include <algorithm>

#include "core/parallel.h"

namespace obscura {

std::optional<HalfPlane> half_plane(const Aperture& aperture, const FrequencyGrid& grid,
                                    const FarFieldParams& params) {
    const double centre_x = -grid.first_u / grid.step_u, centre_y = -grid.first_v / grid.step_v;
    HalfPlane half;
    half.centre_x = grid.width / 2;
    half.centre_y = grid.height / 2;
    if (centre_x != half.centre_x || centre_y != half.centre_y || grid.width < 4) return {};
    // The exact transform of an outline knows nothing of the mask's symmetry.
    if (params.method != FarFieldMethod::polygon) {
        const MaskSymmetry symmetry = mask_symmetry(aperture.mask.view());
        half.quarter = symmetry.left_right || symmetry.top_bottom;
        half.top_bottom = symmetry.top_bottom;
    }
    half.grid = grid;
    half.grid.first_u = 0;
    half.grid.width = half.centre_x + 1;
    if (half.quarter) {
        half.grid.first_v = 0;
        half.grid.height = half.centre_y + 1;
    } else {
        half.grid.height = 2 * half.centre_y + 1;
    }
    return half;
}

void unfold(const HalfPlane& half, ImageView<const float> part, float conjugate_sign, Image<float>& whole,
            const Exec& exec) {
    constexpr std::size_t rows_per_item = 16;
    parallel_blocks(static_cast<std::size_t>(whole.height), rows_per_item, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                            const int v = y - half.centre_y;
                            float* to = whole.row(y);
                            // Row of the part that holds (u, v), and whether it holds the conjugate.
                            const auto fetch = [&](int frequency_v, bool& conjugate) {
                                if (!half.quarter) return part.row(frequency_v + half.centre_y);
                                if (frequency_v < 0 && !half.top_bottom) conjugate = !conjugate;
                                return part.row(std::abs(frequency_v));
                            };
                            bool right_conjugate = false, left_conjugate = true;
                            const float* right = fetch(v, right_conjugate);
                            const float* left = fetch(-v, left_conjugate);
                            const float right_sign = right_conjugate ? conjugate_sign : 1.0f;
                            const float left_sign = left_conjugate ? conjugate_sign : 1.0f;
                            for (int u = 1; u <= half.centre_x; ++u)
                                to[half.centre_x - u] = left_sign * left[u];
                            for (int u = 0; u < whole.width - half.centre_x; ++u)
                                to[half.centre_x + u] = right_sign * right[u];
                        }
                    });
}

}  // namespace obscura
