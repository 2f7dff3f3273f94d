#include "lessons/lessons.h"

#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/ladder.h"

namespace obscura {
namespace {

const std::array<LessonInfo, 4> infos{{
    {1, "Edge functions", "which texels a triangle covers, and who owns a sample on a shared edge"},
    {2, "Depth", "one plane per face, the nearest of two surfaces, and why depth is monotone and clamped"},
    {3, "Layers", "every crossing of a ray with solids and sheets, in order"},
    {4, "Intervals", "from a counter along the ray to the depth interval and the stored depth"},
}};

constexpr std::array drawings{lesson_1_edge_functions, lesson_2_depth, lesson_3_layers, lesson_4_intervals};
static_assert(drawings.size() == std::tuple_size_v<decltype(infos)>);

}  // namespace

std::span<const LessonInfo> lessons() {
    return infos;
}

Image<Rgb8> draw_lesson(int number, const Exec& exec) {
    if (number < 1 || number > static_cast<int>(drawings.size())) {
        throw UsageError(fmt::format("there is no lesson {}: choose 1 to {}", number, drawings.size()));
    }
    return drawings[static_cast<std::size_t>(number - 1)](exec);
}

}  // namespace obscura
