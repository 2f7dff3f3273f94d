#include "bench/raster/agreement.h"

#include <cmath>

namespace obscura {
namespace {

constexpr float background = 1.0f;
constexpr float depth_tolerance = 1e-5f;
constexpr float bend_tolerance = 1e-4f;

struct Mean {
    double sum = 0;
    std::size_t count = 0;
    double value() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

Mean mean_depth(const float* depth, std::size_t texels) {
    Mean mean;
    for (std::size_t i = 0; i < texels; ++i) {
        if (depth[i] >= background) continue;
        mean.sum += static_cast<double>(depth[i]);
        ++mean.count;
    }
    return mean;
}

bool on_silhouette(const float* depth, int width, std::ptrdiff_t at) {
    const float middle = depth[at];
    for (const std::ptrdiff_t step :
         {std::ptrdiff_t{1}, std::ptrdiff_t{width}, std::ptrdiff_t{width} + 1, std::ptrdiff_t{width} - 1}) {
        const float before = depth[at - step], after = depth[at + step];
        if ((before >= background) != (middle >= background) ||
            (after >= background) != (middle >= background)) {
            return true;
        }
        if (std::fabs((before - middle) + (after - middle)) > bend_tolerance) return true;
    }
    return false;
}

}  // namespace

Agreement summarise(Workload workload, const BenchScene& scene, const float* result) {
    Agreement agreement;
    const std::size_t size = result_size(workload, scene);
    if (is_frame(workload)) {
        Mean luminance;
        for (std::size_t i = 0; i < size; i += 3) {
            const double y = 0.2126 * static_cast<double>(result[i]) +
                             0.7152 * static_cast<double>(result[i + 1]) +
                             0.0722 * static_cast<double>(result[i + 2]);
            luminance.sum += y;
            if (y > 0) ++luminance.count;
        }
        agreement.mean_first = luminance.value();
        agreement.covered = static_cast<double>(luminance.count) / (static_cast<double>(size) / 3.0);
        return agreement;
    }
    const std::size_t texels = result_size(Workload::depth, scene);
    const Mean first = mean_depth(result, texels);
    agreement.covered = static_cast<double>(first.count) / static_cast<double>(texels);
    agreement.mean_first = first.value();
    if (workload == Workload::dual_depth) agreement.mean_second = mean_depth(result + texels, texels).value();
    return agreement;
}

void compare_depths(Agreement& agreement, const BenchScene& scene, const float* result,
                    const float* reference) {
    const int width = scene.light.width, height = scene.light.height;
    std::size_t wrong = 0, wrong_inside = 0, inside = 0;
    for (int y = 1; y + 1 < height; ++y) {
        for (int x = 1; x + 1 < width; ++x) {
            const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * width + x;
            const bool differs = std::fabs(result[at] - reference[at]) > depth_tolerance;
            const bool excluded = on_silhouette(reference, width, at);
            wrong += differs ? 1u : 0u;
            wrong_inside += differs && !excluded ? 1u : 0u;
            inside += excluded ? 0u : 1u;
        }
    }
    const double texels = static_cast<double>(width - 2) * static_cast<double>(height - 2);
    agreement.wrong = static_cast<double>(wrong) / texels;
    agreement.wrong_inside =
        inside > 0 ? static_cast<double>(wrong_inside) / static_cast<double>(inside) : 0.0;
}

}  // namespace obscura
