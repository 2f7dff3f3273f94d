// Lesson 23. Two subtrees as one.
//
// You learn: depths of two houses hardly ever agree, but the difference from a roof to what stands on it
// does; so values are kept relative to the one above, and a subtree can stand for another. When that is
// lossless: all values below a parent move by one shift, so whoever has been compared must not move any more.
// The published rule lets a parent move after its children were compared, and loses them. L. Scandolo, P.
// Bauszat, E. Eisemann, "Merged Multiresolution Hierarchies for Shadow Map Compression", Pacific Graphics
// 2016, section 3.2.
//
// Calls: hierarchy/multires.h build_bottom_up, hierarchy/codes/codes.h encode_tree,
//        hierarchy/mmh/subtrees.h subtrees_of, hierarchy/mmh/merge.h merge_subtrees,
//        hierarchy/codes/decode.h tree_value.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/combine.h"
#include "hierarchy/mmh/merge.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/merge_panels.h"
#include "lessons/tree_scene.h"
#include "raster/interval_map.h"

namespace obscura {
namespace {

ShadowTree merged_tree(const Image<DepthInterval>& map) {
    EncodeParams params;
    params.code = ShadowCode::mmh;
    return encode_tree(build_bottom_up(map.view()), {}, params);
}

std::uint64_t nodes_of(const MultiresCounts& counts) {
    return counts.full + counts.empty + counts.leaf;
}

// Step 1: two houses, one a floor deeper. Their tree, merged, stores what stands on the roofs once.
void draw_pair(Figure& f) {
    constexpr std::array<House, 2> houses{
        {{{.40f, .50f}, {.62f, .70f}, {.22f, .33f}}, {{.66f, .74f}, {.86f, .92f}, {.50f, .60f}}}};
    const Image<DepthInterval> map = map_of(houses);
    const ShadowTree tree = merged_tree(map);
    const std::uint64_t before = nodes_of(count_nodes(build_bottom_up(map.view())));
    const std::uint64_t after = nodes_of(tree.counts);
    CHECK(after < before);
    f.text({40, 146}, "1  Depths differ, differences agree", lettering::head);
    const std::array<std::array<float, 3>, 2> depths{decoded(tree, 0), decoded(tree, 1)};
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(contains(part_of(houses[0], k), depths[0][k]) && contains(part_of(houses[1], k), depths[1][k]),
              "lossless");
        const float of_a = depths[0][k] - depths[0][0], of_b = depths[1][k] - depths[1][0];
        CHECK(std::abs(of_a - of_b) < 1e-6f, "one difference for both");
    }
    draw_houses(f, houses, depths, {40, 178, 400, 250}, {520, 178, 250, 250});
    f.text({40, 496},
           fmt::format("{} nodes become {}: what stands on both roofs is stored once, as differences.",
                       before, after));
}

/// The pair that tells the rules apart.
constexpr DepthInterval inner_a{.40f, .60f}, child_a{.70f, .71f}, inner_b{.45f, .70f}, child_b{.775f, .785f};
constexpr DepthInterval inners[] = {inner_a, inner_b}, children[] = {child_a, child_b};

// Step 2: the rule as published, by hand.
void draw_published(Figure& f) {
    f.text({850, 146}, "2  A parent that moves afterwards loses its children (the published rule)",
           lettering::head);
    const DepthInterval inner = common(inner_a, inner_b);
    const DepthInterval below = common(moved(child_a, middle(inner_a)), moved(child_b, middle(inner_b)));
    CHECK(below.entry <= below.exit, "the published rule merges");
    const float value = middle(inner) + middle(below);
    CHECK(!contains(child_a, value) && !contains(child_b, value), "and loses both");

    const Plot compare = depth_plot(f, {850, 178, 330, 250}, 4, 0.35, 0.85);
    const Plot after = depth_plot(f, {1230, 178, 330, 250}, 4, 0.35, 0.85);
    f.text({850, 170}, "compared from the middles: + .205 and + .205", {9, ink::soft});
    f.text({1230, 170}, "then the parents meet, and their middle moves", {9, ink::soft});
    for (int i = 0; i < 2; ++i) {
        const Rgb8 color = house_colors[i];
        const double x = 0.6 + 2.0 * i, from = double{middle(inners[i])}, to = double{middle(children[i])};
        draw_bar(f, compare, {x, inners[i], color});
        draw_bar(f, compare, {x + 0.9, children[i], color});
        f.arrow(compare.at(x, -from) + Vec2d{6, 0}, compare.at(x + 0.9, -to) - Vec2d{4, 4}, {ink::dark, 1.5},
                8);
        draw_depth(f, compare, x, from, ink::dark);
        draw_bar(f, after, {2.0 + 1.0 * i, children[i], color});
        f.text(compare.at(x, -0.85) + Vec2d{0, 20}, i == 0 ? "parent A" : "parent B", lettering::tick);
        f.text(compare.at(x + 0.9, -0.85) + Vec2d{0, 20}, i == 0 ? "child A" : "child B", lettering::tick);
        f.text(after.at(2.0 + i, -0.85) + Vec2d{0, 20}, i == 0 ? "child A" : "child B", lettering::tick);
    }
    draw_bar(f, after, {0.7, inner, ink::green});
    f.text(after.at(0.7, -0.85) + Vec2d{0, 20}, "both parents", lettering::tick);
    const Vec2d end = after.at(2.5, -double{value});
    f.arrow(after.at(0.7, -double{middle(inner)}) + Vec2d{6, 0}, end - Vec2d{10, 3}, {ink::red, 1.5}, 8);
    draw_depth(f, after, 0.7, double{middle(inner)}, ink::dark);
    draw_depth(f, after, 2.5, double{value}, ink::red, fmt::format("{:.2f}", value));
    f.text({850, 474}, "A: parent [.40, .60], child [.70, .71].   B: [.45, .70] and [.775, .785].");
    f.text({850, 496}, fmt::format("Both parents move to {:.3f} in [.45, .60]; both children become {:.2f}, "
                                   "which neither is.",
                                   middle(inner), value));
}

// Step 3: the same pair by ours.
void draw_frozen(Figure& f) {
    const Image<DepthInterval> map = map_of({{{inner_a, child_a, inner_a}, {inner_b, child_b, inner_b}}});
    const MultiresTree plain = build_bottom_up(map.view());
    const ShadowTree tree = merged_tree(map);
    const std::array<float, 3> a = decoded(tree, 0), b = decoded(tree, 1);
    CHECK(contains(child_a, a[1]) && contains(child_b, b[1]), "lossless");
    CHECK(nodes_of(tree.counts) == nodes_of(count_nodes(plain)), "refused");

    f.text({40, 530}, "3  What is compared stands still", lettering::head);
    const Plot plot = depth_plot(f, {40, 562, 330, 250}, 4, 0.35, 0.85);
    f.text({40, 554}, "a value is frozen before its children", {9, ink::soft});
    const std::array<float, 3> values[] = {a, b};
    const float shift = b[0] - a[0];
    for (int i = 0; i < 2; ++i) {
        const double x = 0.5 + 1.9 * i;
        draw_bar(f, plot, {x, inners[i], house_colors[i]});
        draw_bar(f, plot, {x + 0.7, children[i], house_colors[i]});
        draw_depth(f, plot, x, double{values[i][0]}, ink::dark);
        draw_depth(f, plot, x + 0.7, double{values[i][1]}, ink::dark);
        f.text(plot.at(x, -0.85) + Vec2d{0, 20}, i == 0 ? "parent A" : "parent B", lettering::tick);
    }
    draw_bar(f, plot, {1.6, moved(child_b, shift), ink::red, 8});
    f.text(plot.at(1.6, -double{moved(child_b, shift).exit}) + Vec2d{0, 20}, "child B, moved",
           {8.5, ink::red, Align::centre, true, true});
    f.paragraph({40, 858}, fmt::format("B's child, moved by the one shift of\n{:+.3f} to A, misses A's: both "
                                       "stay.",
                                       -shift));
}

// Step 4: a town.
void draw_town(Figure& f, const Exec& exec) {
    constexpr int texels = 128, charted = 1024;
    const Mesh mesh = lesson_town();
    BuildParams build;
    build.keep_intervals = true;
    const LightView view = lesson_view(mesh, texels);
    const SubtreeSet set = subtrees_of(build_shadow_tree(mesh, view, build, exec));
    const Merged merged = merge_subtrees(set, {}, exec);
    const auto gone = std::count(merged.alive.begin(), merged.alive.end(), 0) +
                      static_cast<std::ptrdiff_t>(merged.stats.merged);
    f.text({430, 530}, "4  A town: coloured squares are another's", lettering::head);
    draw_picture(f, {430, 546}, merged_town(interval_map(mesh, view, {}, exec), set, merged), 3);

    f.text({880, 530}, "5  How far to look", lettering::head);
    const MultiresTree tree = build_shadow_tree(mesh, lesson_view(mesh, charted), build, exec);
    const auto mh = static_cast<double>(encode_tree(tree, {}).bytes);
    std::vector<LimitedShare> shares;
    for (const int limit : {1, 10, 100, 1000, 0}) {
        EncodeParams params;
        params.code = ShadowCode::mmh;
        params.merge.search_limit = limit;
        params.exec = exec;
        shares.push_back({limit, static_cast<double>(encode_tree(tree, {}, params).bytes) / mh});
    }
    draw_shares(f, shares, {{930, 570, 330, 300}, -0.2, 4.2, 0.5, 1});
    f.paragraph(
        {1310, 590},
        fmt::format("Of the town's {} subtrees\n{} are gone: {} became\nanother's, the others hung\nbelow "
                    "these.\n\nOnly subtrees of equal shape\nare compared. The extremes\nof their depths "
                    "reject nearly\nall pairs at once.\n\nA lookup adds what it meets\non its way down, in "
                    "whole\nnumbers: sums of floats\nwould miss.",
                    set.subtrees.size(), gone, merged.stats.merged));
}

}  // namespace

Image<Rgb8> lesson_23_two_as_one(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(23, "Two subtrees as one",
              "What stands on two roofs is alike once depths are told from the roof; but what was compared "
              "must not move.");
    draw_pair(f);
    draw_published(f);
    draw_frozen(f);
    draw_town(f, exec);
    f.legend({40, 912}, {{Mark::square, house_colors[0], "A"},
                         {Mark::square, house_colors[1], "B"},
                         {Mark::square, ink::green, "what both can be"}});
    f.legend({40, 936}, {{Mark::dot, ink::dark, "the depth stored"}, {Mark::square, ink::red, "misses"}});
    f.source_line(23,
                  "hierarchy/mmh/subtrees.h subtrees_of · hierarchy/mmh/merge.h merge_subtrees · "
                  "hierarchy/codes/codes.h encode_tree");
    return f.picture;
}

}  // namespace obscura
