// Lesson 5. The mode of four: how a tree of depths grows from its leaves.
//
// You learn: four squares hand their parent the depth that most of them can take; those it suits disappear,
// the others keep a value of their own; and where something must stay below a square that disappears, an
// empty node keeps the way open. L. Scandolo, P. Bauszat, E. Eisemann, "Compressed Multiresolution
// Hierarchies for High-Quality Precomputed Shadows", Eurographics 2016, section 3.1 and algorithm 2.
//
// Calls: hierarchy/combine.h combine, hierarchy/multires.h build_bottom_up, value_at.

#include <array>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "hierarchy/combine.h"
#include "hierarchy/multires.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "lessons/tree_panels.h"
#include "lessons/tree_scene.h"

namespace obscura {
namespace {

using Four = std::array<DepthInterval, 4>;

Combined combined(const Four& four) {
    const DepthInterval child[4] = {four[0], four[1], four[2], four[3]};
    return combine(child);
}

// Step 1: four cases. Every child's minimum is a candidate; the number above it says how many it suits.
struct Case {
    const char *name, *why;
    Four child;
};
constexpr Case cases[] = {
    {"all share a depth",
     "the parent's interval is what all\nfour have in common",
     {{{.20f, .62f}, {.30f, .80f}, {.12f, .55f}, {.40f, .90f}}}},
    {"three share",
     "child 3 is left with a value of\nits own",
     {{{.15f, .50f}, {.25f, .60f}, {.10f, .45f}, {.70f, .92f}}}},
    {"two and two",
     "a tie: the first to reach the\ncount wins, here child 0's minimum",
     {{{.20f, .42f}, {.60f, .90f}, {.12f, .35f}, {.55f, .75f}}}},
    {"none share",
     "child 0 wins: a parent without\nvalue would cost as much",
     {{{.10f, .22f}, {.34f, .46f}, {.56f, .68f}, {.78f, .90f}}}},
};

void draw_case(Figure& f, const Case& c, const Plot& plot) {
    const Combined parent = combined(c.child);
    f.fill(plot.box, ink::panel);
    const auto bar = [&](double x, DepthInterval i, Rgb8 color, double half) {
        const Vec2d top = plot.at(x, -static_cast<double>(i.entry)),
                    end = plot.at(x, -static_cast<double>(i.exit));
        f.fill({top.x - half, top.y, 2 * half, end.y - top.y}, color);
    };
    for (int i = 0; i < 4; ++i) {
        const float candidate = c.child[static_cast<std::size_t>(i)].entry;
        int suits = 0;
        for (const DepthInterval& other : c.child)
            suits += contains(other, candidate) ? 1 : 0;
        const bool stays = (parent.covered >> i & 1u) == 0;
        bar(i + 0.5, c.child[static_cast<std::size_t>(i)],
            stays ? ink::green : mix(ink::grey, ink::paper, 0.4), 13);
        const double depth = -static_cast<double>(candidate);
        f.line(plot.at(0.1, depth), plot.at(4.1, depth), {ink::orange, 1.2, 4});
        f.text(plot.at(i + 0.5, depth) - Vec2d{0, 4}, fmt::format("{}", suits),
               {8.5, ink::dark, Align::centre, true, true});
        f.text(plot.at(i + 0.5, -1) + Vec2d{0, 20}, fmt::format("child {}", i), lettering::tick);
    }
    bar(4.75, parent.interval, ink::blue, 15);
    f.disc(plot.at(4.75, -static_cast<double>(stored_depth(parent.interval))), 5, ink::yellow);
    f.text(plot.at(4.75, -1) + Vec2d{0, 20}, "parent", {9, ink::blue, Align::centre, true});
    f.text(plot.at(0, 0) - Vec2d{0, 12}, c.name, lettering::head);
    f.paragraph(plot.at(0, -1) + Vec2d{0, 48}, c.why);
}

// Step 2: from a map of intervals to that of the parents.
Image<DepthInterval> parents_of(const Image<DepthInterval>& map) {
    Image<DepthInterval> up(map.width / 2, map.height / 2);
    for (int y = 0; y < up.height; ++y) {
        for (int x = 0; x < up.width; ++x)
            up(x, y) = combined({map(2 * x, 2 * y), map(2 * x + 1, 2 * y), map(2 * x, 2 * y + 1),
                                 map(2 * x + 1, 2 * y + 1)})
                           .interval;
    }
    return up;
}

// Step 3: its intervals, and what is left of each level in the tree.
void draw_tree(Figure& f, double y) {
    const Image<DepthInterval> texels = small_map(), pairs = parents_of(texels), root = parents_of(pairs);
    const MultiresTree tree = build_bottom_up(texels.view());
    const std::vector<TreeSquare> squares = squares_of(tree);
    const Image<DepthInterval>* maps[] = {&texels, &pairs, &root};
    const char* names[] = {"texels", "combined by four", "once more: the root"};
    constexpr double side = 212;
    for (int level = 0; level < 3; ++level) {
        const double x = 40 + 250.0 * level;
        f.text({x, y - 12}, names[level], lettering::body);
        draw_intervals(f, *maps[level], {x, y}, side);
        if (level < 2) f.arrow({x + side + 6, y + 0.5 * side}, {x + 246, y + 0.5 * side}, {ink::soft, 2});
    }
    const char* left[] = {"left of the texels", "of the squares", "the root"};
    for (int level = 2; level >= 0; --level) {
        const double x = 820 + 250.0 * (2 - level);
        f.text({x, y - 12}, left[level], lettering::body);
        draw_nodes(f, squares, level, {{x, y}, side / (4 >> level), 4 >> level, 4 >> level});
    }
    for (int i = 0; i < 16; ++i)
        CHECK(contains(texels(i % 4, i / 4),
                       value_at(tree, static_cast<std::uint32_t>(i % 4), static_cast<std::uint32_t>(i / 4))));
    const MultiresCounts counts = count_nodes(tree);
    f.text({820, y + side + 34},
           fmt::format("16 depths became {} values and {} empty node{}. A lookup goes down to its texel and "
                       "keeps the last value on its way.",
                       counts.full + counts.leaf, counts.empty, counts.empty == 1 ? "" : "s"));
}

}  // namespace

Image<Rgb8> lesson_5_mode_of_four(const Exec&) {
    Figure f(lesson_width, lesson_height);
    f.heading(5, "The mode of four",
              "Four squares choose the depth that most of them can take; a tree grows from its texels to its "
              "root.");
    for (int i = 0; i < 4; ++i)
        draw_case(f, cases[i], {{40 + 390.0 * i, 160, 340, 310}, 0, 5.4, -1, 0});
    f.legend({40, 590},
             {{Mark::square, mix(ink::grey, ink::paper, 0.4), "the parent's value suits it: it disappears"},
              {Mark::square, ink::green, "keeps its own"},
              {Mark::dashes, ink::orange, "candidates, and how many intervals they meet"},
              {Mark::square, ink::blue, "the parent's interval"}});
    f.text({40, 642}, "Intervals, from the texels up (depth down each cell)", lettering::head);
    f.text({820, 642}, "The tree, from the root down", lettering::head);
    draw_tree(f, 684);
    f.legend({40, 930}, {{Mark::square, kind_color(ChildKind::full), "full: value and children"},
                         {Mark::square, kind_color(ChildKind::leaf), "leaf: value"},
                         {Mark::square, kind_color(ChildKind::empty), "empty: children only"},
                         {Mark::square, ink::panel, "nothing: the last value above holds"}});
    f.source_line(5, "hierarchy/combine.h combine · hierarchy/multires.h build_bottom_up value_at");
    return f.picture;
}

}  // namespace obscura
