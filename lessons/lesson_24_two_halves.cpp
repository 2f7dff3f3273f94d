// Lesson 24. A tree's two halves: structure and values.
//
// You learn: which squares have nodes repeats far more often than depths do. So the structure is written as a
// graph, in which everything that is alike stands once, and depths in a list beside it, in the order in which
// a walk through the whole tree meets them. A lookup counts what stands before: that is the number of its
// depth. And a list of depths that are neighbours on the map is small numbers: one that many can take, and
// steps from the lowest. L. Scandolo, E. Eisemann, "Directed Acyclic Graph Encoding for Compressed Shadow
// Maps", High-Performance Graphics 2021, sections 3.1 to 3.3.
//
// Calls: hierarchy/dag/topology.h dag_topology, hierarchy/dag/chunks.h chunk_of,
//        hierarchy/dag/dag.h dag_stats, hierarchy/codes/codes.h encode_tree.

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/dag/dag.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/graph_panels.h"
#include "lessons/ladder.h"
#include "lessons/tree_scene.h"

namespace obscura {
namespace {

constexpr int shown_levels = 3, paper_levels = 4, paper_chunk_log2 = 5;

MultiresTree town_tree(const Mesh& mesh, int texels, const Exec& exec) {
    BuildParams params;
    params.keep_intervals = true;
    return build_shadow_tree(mesh, lesson_view(mesh, texels), params, exec);
}

// Step 1: treelets, and where the commonest stand.
void draw_structure(Figure& f, const Mesh& mesh, const Exec& exec) {
    constexpr int texels = 128;
    const DagTopology dag = dag_topology(town_tree(mesh, texels, exec), shown_levels, TreeLayout::fractions);
    f.text({40, 146}, "1  Structure: what hangs below a square, whatever its depths", lettering::head);
    const std::vector<TreeletUse> uses = treelet_uses(dag);
    draw_picture(f, {40, 162}, treelet_map(dag, uses, texels), 3);
    std::uint64_t all = 0;
    for (const TreeletUse& use : uses)
        all += use.squares;
    for (std::size_t i = 0; i < coloured_treelets; ++i) {
        const Box box{460 + 116.0 * static_cast<double>(i % 3), 190 + 124.0 * static_cast<double>(i / 3), 88,
                      88};
        draw_treelet(f, dag.treelets[uses[i].treelet], shown_levels, box, treelet_color(i));
        f.text({box.x, box.y - 7}, fmt::format("{} times", uses[i].squares),
               {8.5, treelet_color(i), Align::left, true});
    }
    f.paragraph(
        {460, 450},
        fmt::format("Squares of 4 x 4 texels and what hangs below:\ncoloured is what has a value. {} such "
                    "squares,\n{} kinds of them, {} nodes above.\nGrey: all kinds but the commonest six.",
                    all, uses.size(), dag.nodes.size()));
}

// Step 2: a lookup counts.
void draw_counting(Figure& f) {
    const Image<DepthInterval> map = small_map();
    const MultiresTree tree = build_bottom_up(map.view());
    const DagTopology dag = dag_topology(tree, 1, TreeLayout::fractions);
    f.text({870, 146}, "2  A lookup counts the values that stand before", lettering::head);
    constexpr std::uint32_t x = 2, y = 3;
    const std::uint32_t number = draw_counted_tree(f, tree, x, y, {870, 196, 690, 190});
    const DagNode& root = dag.nodes.back();
    CHECK(number == 1 + root.before[3] + 1, "own value, those before child 3, and its own");
    f.paragraph({870, 446}, fmt::format("Texel ({}, {}): one value at the root, {} below its children before "
                                        "the last, one at the last itself, so "
                                        "number {}.\nA node needs to know how many values hang below each "
                                        "child, not where they are: so two "
                                        "nodes can\nbe one though their depths differ.",
                                        x, y, root.before[3], number));
}

std::vector<NumberRange> ranges_from(const DagTopology& dag, std::size_t first, std::size_t count) {
    const auto begin = dag.values.begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

/// How much there is to see in a chunk: intervals of some width beside the extent of all, where both kinds
/// are.
std::size_t telling(const std::vector<NumberRange>& ranges, TreeLayout layout) {
    const ValueChunk chunk = chunk_of(ranges, layout);
    const std::size_t others = ranges.size() - chunk.factors.size();
    if (chunk.factor_bytes != 1 || others < 5 || others > 16) return 0;
    const auto [low, high] = std::minmax_element(
        ranges.begin(), ranges.end(), [](const auto& a, const auto& b) { return a.least < b.least; });
    const double extent = static_cast<double>(high->least - low->least);
    return static_cast<std::size_t>(std::count_if(ranges.begin(), ranges.end(), [&](const NumberRange& r) {
        return static_cast<double>(r.greatest - r.least) > 0.05 * extent;
    }));
}

// Step 3: a chunk.
void draw_values(Figure& f, const Mesh& mesh, const Exec& exec) {
    constexpr int texels = 256;
    const DagTopology dag = dag_topology(town_tree(mesh, texels, exec), paper_levels, TreeLayout::fractions);
    constexpr std::size_t length = 1u << paper_chunk_log2;
    std::size_t best = 0, most = 0;
    for (std::size_t first = 0; first + length <= dag.values.size(); first += length) {
        const std::size_t seen = telling(ranges_from(dag, first, length), dag.layout);
        if (seen > most) best = first;
        most = std::max(seen, most);
    }
    const std::vector<NumberRange> ranges = ranges_from(dag, best, length);
    const ValueChunk chunk = chunk_of(ranges, dag.layout);
    f.text({40, 588},
           fmt::format("3  Values {} to {} of the town, in the order of the walk: a chunk", best,
                       best + length - 1),
           lettering::head);
    draw_chunk(f, ranges, chunk, dag.layout, {40, 604, 760, 262});
    f.paragraph(
        {40, 886},
        fmt::format(
            "{} depths are the one that most intervals hold, a bit each; {} are a lowest depth and so many "
            "equal steps, a byte each.\n{} bytes for what would be {} as floats.",
            length - chunk.factors.size(), chunk.factors.size(), 16 + length / 8 + chunk.factors.size(),
            4 * length));
}

// Step 4: what that saves of either half.
void draw_bytes(Figure& f, const Mesh& mesh, const Exec& exec) {
    f.text({870, 588}, "4  Bytes, of MH's", lettering::head);
    int group = 0;
    for (const int texels : {256, 1024, 4096}) {
        const MultiresTree tree = town_tree(mesh, texels, exec);
        std::vector<TwoHalves> bars;
        for (const ShadowCode code : {ShadowCode::mh, ShadowCode::mmh}) {
            EncodeParams params;
            params.code = code;
            params.exec = exec;
            const MultiresCounts c = encode_tree(tree, {}, params).counts;
            bars.push_back({code == ShadowCode::mh ? "MH" : "MMH",
                            4e-3 * static_cast<double>(c.full + c.empty),
                            4e-3 * static_cast<double>(c.full + c.leaf)});
        }
        for (const bool packed : {false, true}) {
            EncodeParams params;
            params.code = ShadowCode::dag;
            if (!packed) params.dag = {paper_levels, paper_chunk_log2, false};
            const DagStats s = dag_stats(encode_tree(tree, {}, params));
            bars.push_back({packed ? "packed" : "graph", 1e-3 * static_cast<double>(s.structure_bytes()),
                            1e-3 * static_cast<double>(s.value_bytes())});
        }
        const Plot plot{{870 + 236.0 * group++, 618, 216, 250}, 0, 4, 0, 1.08};
        draw_halves(f, bars, plot);
        f.line(plot.at(0, 0), plot.at(4, 0), {ink::grey, 1});
        f.text(plot.at(2, 0) + Vec2d{0, 44},
               fmt::format("{} x {}: MH {:.0f} kB", texels, texels, bars[0].sum()),
               {9, ink::dark, Align::centre});
    }
}

}  // namespace

Image<Rgb8> lesson_24_two_halves(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(24, "Structure and values apart",
              "Where a tree has nodes repeats far more often than the depths in them: write the one as a "
              "graph, the other as a "
              "list.");
    const Mesh mesh = lesson_town();
    draw_structure(f, mesh, exec);
    draw_counting(f);
    draw_values(f, mesh, exec);
    draw_bytes(f, mesh, exec);
    f.legend({40, 940}, {{Mark::dot, ink::orange, "the representative"},
                         {Mark::dot, ink::blue, "base + step x factor"}});
    f.legend({870, 940}, {{Mark::square, ink::blue, "structure"}, {Mark::square, ink::orange, "values"}});
    f.source_line(24,
                  "hierarchy/dag/topology.h dag_topology · hierarchy/dag/chunks.h chunk_of · "
                  "hierarchy/dag/dag.h dag_stats");
    return f.picture;
}

}  // namespace obscura
