#include "lessons/lessons.h"

#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/ladder.h"

namespace obscura {
namespace {

const std::array<LessonInfo, 17> infos{{
    {1, "Edge functions", "which texels a triangle covers, and who owns a sample on a shared edge"},
    {2, "Depth", "one plane per face, the nearest of two surfaces, and why depth is monotone and clamped"},
    {3, "Layers", "every crossing of a ray with solids and sheets, in order"},
    {4, "Intervals", "from a counter along the ray to the depth interval and the stored depth"},
    {5, "The mode of four", "how four squares choose their parent's depth, and what is left of them"},
    {6, "The tree", "level by level: nodes stand where depth intervals have nothing in common"},
    {7, "Recursion", "from triangles to the tree: squares that are certain, and the few that are rasterized"},
    {8, "Lookups", "steps down the tree for a kernel: each texel by itself, or all together"},
    {9, "Quads of an aperture", "an aperture as few signed rectangles, level by level from its texels up"},
    {10, "Adding quads", "the far field as a sum of closed forms, largest quads first, and what it costs"},
    {11, "From near to far",
     "fringes along a shadow's edge become the far field; the bright spot behind a disc"},
    {12, "Adding wavelengths",
     "one pattern per wavelength, how many it takes, and how fine a lookup must be"},
    {13, "Disparity from depth",
     "how far apart two eyes see a point, from its depth; and what one sees alone"},
    {14, "One edit's conflict",
     "edits tear a map and turn order round; gradients tell where, a system heals it"},
    {15, "Jacobi, sweep by sweep",
     "news travels one pixel per sweep; a pyramid is faster and solves something else"},
    {16, "The V-cycle", "what is wrong goes down the levels, corrections come up; error per iteration"},
    {17, "Vertices follow the map",
     "triangles cut where the map bends, moved half a disparity for either eye"},
}};

constexpr std::array drawings{lesson_1_edge_functions, lesson_2_depth,        lesson_3_layers,
                              lesson_4_intervals,      lesson_5_mode_of_four, lesson_6_tree,
                              lesson_7_recursion,      lesson_8_lookups,      lesson_9_quads,
                              lesson_10_adding_quads,  lesson_11_near_to_far, lesson_12_colour,
                              lesson_13_disparity,     lesson_14_conflict,    lesson_15_jacobi,
                              lesson_16_v_cycle,       lesson_17_vertices};
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
