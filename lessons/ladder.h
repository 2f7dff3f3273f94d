#pragma once
// The ladder: a lesson is a file of its own, its picture, and one row here.

#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"

namespace obscura {

constexpr int lesson_width = 1600, lesson_height = 1000;

/// In order from 1: the function that draws it, its title, and what it shows.
// clang-format off
#define OBSCURA_LESSONS(LESSON) \
    LESSON(lesson_1_edge_functions, "Edge functions", "which texels a triangle covers, and who owns a sample on a shared edge") \
    LESSON(lesson_2_depth, "Depth", "one plane per face, the nearest of two surfaces, and why depth is monotone and clamped") \
    LESSON(lesson_3_layers, "Layers", "every crossing of a ray with solids and sheets, in order") \
    LESSON(lesson_4_intervals, "Intervals", "from a counter along the ray to the depth interval and the stored depth") \
    LESSON(lesson_5_mode_of_four, "The mode of four", "how four squares choose their parent's depth, and what is left of them") \
    LESSON(lesson_6_tree, "The tree", "level by level: nodes stand where depth intervals have nothing in common") \
    LESSON(lesson_7_recursion, "Recursion", "from triangles to the tree: squares that are certain, and the few that are rasterized") \
    LESSON(lesson_8_lookups, "Lookups", "steps down the tree for a kernel: each texel by itself, or all together") \
    LESSON(lesson_9_quads, "Quads of an aperture", "an aperture as few signed rectangles, level by level from its texels up") \
    LESSON(lesson_10_adding_quads, "Adding quads", "the far field as a sum of closed forms, largest quads first, and what it costs") \
    LESSON(lesson_11_near_to_far, "From near to far", "fringes along a shadow's edge become the far field; the bright spot behind a disc") \
    LESSON(lesson_12_colour, "Adding wavelengths", "one pattern per wavelength, how many it takes, and how fine a lookup must be") \
    LESSON(lesson_13_disparity, "Disparity from depth", "how far apart two eyes see a point, from its depth; and what one sees alone") \
    LESSON(lesson_14_conflict, "One edit's conflict", "edits tear a map and turn order round; gradients tell where, a system heals it") \
    LESSON(lesson_15_jacobi, "Jacobi, sweep by sweep", "news travels one pixel per sweep; a pyramid is faster and solves something else") \
    LESSON(lesson_16_v_cycle, "The V-cycle", "what is wrong goes down the levels, corrections come up; error per iteration") \
    LESSON(lesson_17_vertices, "Vertices follow the map", "triangles cut where the map bends, moved half a disparity for either eye") \
    LESSON(lesson_18_kept_field, "A far field up to date", "a disc moves over an iris: the difference is added, its drift is counted, its price compared") \
    LESSON(lesson_19_exact_shadows, "The sample is the texel", "shadows of the camera's own samples, without a map: edges, planes, and what is uncertain") \
    LESSON(lesson_20_penumbrae, "Penumbrae", "a light with a size as many without: where they are, what too few show, what all at once cost") \
    LESSON(lesson_21_stack, "A stack of shadow maps", "a lamp's maps share an octree, and one descent asks many of them at once") \
    LESSON(lesson_22_sky, "The sky as many suns", "skylight as a sum of hard shadows, against a street's formula; why shade is blue") \
    LESSON(lesson_23_two_as_one, "Two subtrees as one", "differences repeat where depths do not; what was compared must not move any more") \
    LESSON(lesson_24_two_halves, "Structure and values", "a tree as a graph of what is alike and a list of depths that a lookup counts along") \
    LESSON(lesson_25_an_edge_in_a_square, "An edge in a square", "a leaf that holds an edge and two planes does not mind how many texels it has") \
    LESSON(lesson_26_floating_horizon, "The horizon that never moves", "one profile that only grows shades a whole elevation model, line by line") \
    LESSON(lesson_27_day_in_bits, "Near and far; a day in bits", "far shadows stored, near ones by rays, and each map coded by the one before it")
// clang-format on

#define OBSCURA_DECLARE_LESSON(draw, title, summary) Image<Rgb8> draw(const Exec& exec);
OBSCURA_LESSONS(OBSCURA_DECLARE_LESSON)
#undef OBSCURA_DECLARE_LESSON

}  // namespace obscura
