#include "bench/raster/workloads.h"

#include <algorithm>

namespace obscura {

const char* workload_name(Workload workload) {
    switch (workload) {
        case Workload::depth:
            return "depth";
        case Workload::dual_depth:
            return "dual depth";
        case Workload::frame:
            return "frame";
        case Workload::static_frame:
            return "static frame";
        case Workload::shadow_map:
            return "shadow map";
        case Workload::lookup:
            return "lookup";
    }
    return "";
}

std::string workload_file_name(Workload workload) {
    std::string name = workload_name(workload);
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

std::size_t result_size(Workload workload, const BenchScene& scene) {
    const auto pixels = [](int w, int h) {
        return static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    };
    const std::size_t texels = pixels(scene.light.width, scene.light.height);
    switch (workload) {
        case Workload::depth:
            return texels;
        case Workload::dual_depth:
            return 2 * texels;
        case Workload::frame:
        case Workload::static_frame:
            return 3 * pixels(scene.scene.render.width, scene.scene.render.height);
        case Workload::shadow_map:
        case Workload::lookup:
            break;
    }
    return 0;
}

}  // namespace obscura
