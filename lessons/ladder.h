#pragma once
// One function per lesson, each in a file of its own.

#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"

namespace obscura {

constexpr int lesson_width = 1600, lesson_height = 1000;

Image<Rgb8> lesson_1_edge_functions(const Exec& exec);
Image<Rgb8> lesson_2_depth(const Exec& exec);
Image<Rgb8> lesson_3_layers(const Exec& exec);
Image<Rgb8> lesson_4_intervals(const Exec& exec);
Image<Rgb8> lesson_5_mode_of_four(const Exec& exec);
Image<Rgb8> lesson_6_tree(const Exec& exec);
Image<Rgb8> lesson_7_recursion(const Exec& exec);
Image<Rgb8> lesson_8_lookups(const Exec& exec);
Image<Rgb8> lesson_9_quads(const Exec& exec);
Image<Rgb8> lesson_10_adding_quads(const Exec& exec);
Image<Rgb8> lesson_11_near_to_far(const Exec& exec);
Image<Rgb8> lesson_12_colour(const Exec& exec);
Image<Rgb8> lesson_13_disparity(const Exec& exec);
Image<Rgb8> lesson_14_conflict(const Exec& exec);
Image<Rgb8> lesson_15_jacobi(const Exec& any);
Image<Rgb8> lesson_16_v_cycle(const Exec& any);
Image<Rgb8> lesson_17_vertices(const Exec& exec);

}  // namespace obscura
