// Lesson 1. Edge functions: which texels does a triangle cover?
//
// You learn: a triangle is where three linear functions are not negative (J. Pineda, "A Parallel Algorithm
// for Polygon Rasterization", SIGGRAPH 1988, section 3); in integers they are exact; and the top-left rule
// gives a sample on a shared edge to exactly one of the two triangles.
//
// Calls: raster/setup.h setup_triangles (corners snap to a grid of 1/256 texel),
//        raster/coverage.h edge_function, covers.

#include <fmt/format.h>

#include "core/topology.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "lessons/texel_space.h"
#include "raster/coverage.h"
#include "raster/setup.h"

namespace obscura {
namespace {

// P, Q and the edge from a to b that they share, in texels: it runs through the centres of six texels.
constexpr Vec3f apex_p{7.25f, 1.0f, 0.5f}, a{4.5f, 12.5f, 0.5f}, b{18.5f, 5.5f, 0.5f};
constexpr Vec3f apex_q{19.75f, 14.75f, 0.5f};
bool on_shared_edge(int x, int y) {
    return x - 4 == 2 * (12 - y) && x > 4 && x < 18;
}

// Step 1: two triangles become two records: corners in fixed point, turned so that inside is positive.
std::vector<TriangleRecord> two_records(int columns, int rows, const Exec& exec) {
    Mesh mesh;
    mesh.positions = {apex_p, a, b, apex_q};
    mesh.triangles = {{{0, 1, 2}}, {{3, 2, 1}}};
    analyse_topology(mesh);
    TriangleSetup setup;
    setup_triangles(mesh, texel_view(columns, rows), {}, exec, setup);
    const TriangleRecord* first = setup.records.data() + setup.blocks.front().begin;
    return {first, first + setup.blocks.front().count};
}
constexpr int shared_edge = 1;  // opposite corner 0, the apex of both

// Step 2: one edge function at the centre of a texel, exact; its unit is the square of 1/256 texel.
std::int64_t at_centre(const EdgeFunction& e, int x, int y) {
    return e.at(x * subtexel_one + subtexel_one / 2, y * subtexel_one + subtexel_one / 2);
}

// Step 3: one panel per edge of P shows where E >= 0; where all three are, is the triangle.
void outline(Figure& f, const TriangleRecord& t, const Cells& c, const Pen& pen, int bold_edge = -1) {
    const auto corner = [&](int k) { return c.at(t.x[k % 3] / 256.0, t.y[k % 3] / 256.0); };
    f.polyline({corner(0), corner(1), corner(2), corner(0)}, pen);
    if (bold_edge >= 0) f.line(corner(bold_edge), corner(bold_edge + 1), {ink::dark, 3});
}
void draw_signs(Figure& f, const TriangleRecord& p) {
    f.text({1084, 136}, "Three edge functions of P", lettering::head);
    for (int k = 0; k < 4; ++k) {
        const Cells c{{1084.0 + 248 * (k % 2), 172.0 + 198 * (k / 2)}, 9, 24, 16};
        c.each([&](int x, int y) {
            const bool in = k == 3 ? covers(p, x, y) : at_centre(edge_function(p, k), x, y) >= 0;
            f.fill(c.cell(x, y), in ? ink::sky : ink::panel);
        });
        f.grid(c, {ink::paper, 1});
        outline(f, p, c, {ink::blue, 1.5}, k < 3 ? k : -1);
        f.text(c.at(0, -1), k == 3 ? "all three: inside P" : fmt::format("edge {} of P: E ≥ 0", k));
    }
}

// Step 4: ask both triangles about every centre. Two owners, or none on the shared edge, would be red.
void draw_owners(Figure& f, const Cells& c, const TriangleRecord& p, const TriangleRecord& q) {
    f.text({76, 136}, "Each centre asks both triangles: covers(P, x, y)?  covers(Q, x, y)?", lettering::head);
    int owned_by[3] = {0, 0, 0};  // centres on the shared edge with so many owners
    c.each([&](int x, int y) {
        const int owners = int{covers(p, x, y)} + int{covers(q, x, y)};
        if (on_shared_edge(x, y)) ++owned_by[owners];
        const bool wrong = on_shared_edge(x, y) ? owners != 1 : owners == 2;
        const Rgb8 tint = wrong ? ink::red : covers(p, x, y) ? ink::sky : ink::orange;
        if (wrong || owners == 1) f.fill(c.cell(x, y), tint, wrong ? 1.0 : 0.38);
    });
    f.grid(c, {ink::grid, 1});
    f.ticks(c, 4);
    outline(f, p, c, {ink::blue, 3.5});
    outline(f, q, c, {ink::orange, 3.5}, shared_edge);
    f.frame(c.box());
    const EdgeFunction shared = edge_function(q, shared_edge);
    c.each([&](int x, int y) {
        const bool in_p = covers(p, x, y), in_q = covers(q, x, y);
        const Vec2d at = c.centre(x, y);
        if (on_shared_edge(x, y)) f.disc(at, 11, ink::paper), f.ring(at, 11, {ink::dark, 2});
        f.disc(at, in_p || in_q ? 5 : 2, in_p ? ink::blue : in_q ? ink::red : ink::grey);
        const auto e = at_centre(shared, x, y) / (subtexel_one * subtexel_one);
        if ((in_p || in_q) && e * e <= 14 * 14)
            f.text(at + Vec2d{0, 18.5}, fmt::format("{}", e), lettering::small);
    });
    f.text(c.at(8.84, 5.25), "P", {20, ink::blue, Align::left, true, true});
    f.text(c.at(14.82, 11.25), "Q", {20, ink::red, Align::left, true, true});
    f.legend({76, 850}, {{Mark::dot, ink::blue, "centre owned by P"},
                         {Mark::dot, ink::red, "by Q"},
                         {Mark::dot, ink::grid, "by nobody"},
                         {Mark::line, ink::dark, "shared edge"},
                         {Mark::ring, ink::dark, "centre exactly on it"}});
    f.text({76, 886}, "Small numbers: E of the shared edge as Q sees it, in texels squared; 0 on the edge.");
    f.text({76, 914},
           fmt::format("Centres on the shared edge with one owner: {}; with two: {}; with none: {}.",
                       owned_by[1], owned_by[2], owned_by[0]),
           lettering::bold);
}

// Step 5: the sample on the edge, enlarged.
void draw_rule(Figure& f, const Cells& c, const TriangleRecord& p, const TriangleRecord& q) {
    f.text(c.at(0, -0.07), "The top-left rule, at texel (8, 10)", lettering::head);
    f.polygon({c.at(0, 0), c.at(1, 0), c.at(1, 0.25), c.at(0, 0.75)}, ink::sky, 0.38);
    f.polygon({c.at(0, 1), c.at(1, 1), c.at(1, 0.25), c.at(0, 0.75)}, ink::orange, 0.38);
    f.line(c.at(0, 0.75), c.at(1, 0.25), {ink::dark, 3});
    f.frame(c.box());
    f.arrow(c.at(0.5, 0.5), c.at(0.75, 0.5625), {ink::dark, 2});
    f.disc(c.at(0.5, 0.5), 7, ink::dark);
    f.text(c.at(0.06, 0.14), "P", {14, ink::blue, Align::left, true});
    f.text(c.at(0.06, 0.94), "Q", {14, ink::red, Align::left, true});
    f.text(c.at(0.72, 0.67), "(ε, ε²)");
    const auto sees = [](const TriangleRecord& t) {
        return at_centre(edge_function(t, shared_edge), 8, 10) < 0 ? "−1: outside" : "0: inside";
    };
    f.paragraph(
        c.at(1.1, 0.08),
        fmt::format("The centre is on the edge:\nE = 0 for P and for Q. Move\nit by (ε, ε²) in thought: "
                    "now\nit is on no edge at all.\n \nIn integers: an edge keeps\nE = 0 if A > 0, or "
                    "A = 0 and\nB > 0; else E becomes −1.\n \nP sees {},\nQ sees {}.",
                    sees(p), sees(q)));
}

}  // namespace

Image<Rgb8> lesson_1_edge_functions(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(1, "Edge functions", "A texel is covered when its centre lies inside all three edges.");
    const Cells map{{76, 168}, 40, 24, 16};  // texels, forty pixels each
    const std::vector<TriangleRecord> records = two_records(map.columns, map.rows, exec);
    draw_owners(f, map, records[0], records[1]);
    draw_signs(f, records[0]);
    draw_rule(f, {{1084, 600}, 208, 1, 1}, records[0], records[1]);
    f.source_line(1, "raster/setup.h setup_triangles · raster/coverage.h edge_function, covers");
    return f.picture;
}

}  // namespace obscura
