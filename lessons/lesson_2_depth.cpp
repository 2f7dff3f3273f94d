// Lesson 2. Depth: how far away is a triangle at a texel?
//
// You learn: depth is affine over the map, so a planar face needs three numbers (a, b, c); a depth map keeps
// the least depth of each texel; and why the one formula float(a X + (b Y + c)), clamped, is used everywhere:
// it is monotone, which the hierarchy's tests rely on (L. Scandolo, P. Bauszat, E. Eisemann, "Compressed
// Multiresolution Hierarchies for High-Quality Precomputed Shadows", 2016, section 3).
//
// Calls: raster/coverage.h depth_at, sample_position, covers; raster/depth_map.h depth_map.

#include <cmath>

#include <fmt/format.h>

#include "core/topology.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "lessons/texel_space.h"
#include "raster/coverage.h"
#include "raster/depth_map.h"
#include "raster/view.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

// Step 1: the depth map of a small mesh as a contour map; nine texels make one pixel of the figure.
void draw_contours(Figure& f, const Exec& exec) {
    constexpr int side = 456, fine = 3, bands = 24;
    Mesh mesh;
    add_part(mesh, sphere(1.0, 10, 6), rotation_x(20));
    add_part(mesh, box({-1.25, -1.1, -1.25}, {1.25, -0.6, 1.25}), Affine{});
    analyse_topology(mesh);
    const LightView view =
        orthographic_light_view(bounds_of(mesh), {-2.0 / 3, -2.0 / 3, -1.0 / 3}, side * fine);
    const Image<float> depth = depth_map(mesh, view, exec);
    const auto band = [&](int x, int y) { return static_cast<int>(std::floor(depth(x, y) * bands)); };
    const auto band_color = [](int i) { return i < bands ? heat(1 - (i + 0.5) / bands) : ink::panel; };
    Image<Rgb8> contours(view.width, view.height, ink::panel);
    for (int y = 0; y + 2 < view.height; ++y) {
        for (int x = 0; x + 2 < view.width; ++x) {
            const bool line = band(x, y) != band(x + 2, y) || band(x, y) != band(x, y + 2);
            contours(x, y) = mix(band_color(band(x, y)), ink::dark, line ? 0.7 : 0.0);
        }
    }
    f.text({40, 136}, "One plane per face: depth as a contour map", lettering::head);
    f.image(40, 152, contours, fine);
    for (int i = 0; i < bands; ++i)
        f.fill({40.0 + 19 * i, 620, 19, 16}, band_color(i));
    f.text({40, 655}, "depth 0, near the light");
    f.text({496, 655}, "1, far", lettering::right);
    f.paragraph({40, 706},
                "From line to line, depth grows by 1/24. Within a face\nthe lines are straight, "
                "parallel and evenly spaced:\ndepth is affine in X and Y; a, b and c say it all.");
}

// Step 2: the depth map of A, the depths of B, and of both: the least one stays.
void draw_nearest(Figure& f, const Exec& exec) {
    const View view = texel_view(12, 9);
    const Mesh a = one_triangle({0.4f, 0.8f, 0.2f}, {11.6f, 3.2f, 0.86f}, {2.2f, 8.8f, 0.34f});
    const Mesh b = one_triangle({11.7f, 0.3f, 0.16f}, {10.6f, 8.7f, 0.3f}, {0.6f, 5.6f, 0.8f});
    Mesh both = a;
    append_mesh(both, b);
    const Image<float> after_a = depth_map(a, view, exec);
    const char* titles[] = {"the map after triangle A", "triangle B alone", "after B: min(A, B)"};
    f.text({560, 136}, "The nearest depth stays", lettering::head);
    for (int i = 0; i < 3; ++i) {
        const Cells c{{560.0 + 344 * i, 176}, 26, view.width, view.height};
        const Image<float> map = i == 0 ? after_a : depth_map(i == 1 ? b : both, view, exec);
        f.text(c.at(0, -0.4), titles[i]);
        c.each([&](int x, int y) {
            const float z = map(x, y);
            const Rgb8 color = z < 1 ? heat(1 - static_cast<double>(z)) : ink::panel;
            f.fill(c.cell(x, y), color);
            f.label(c.cell(x, y), z < 1 ? fmt::format("{:.0f}", z * 100) : "·", {7.5, readable_on(color)});
        });
        f.grid(c, {ink::paper, 1});
        c.each([&](int x, int y) {
            if (i == 2 && map(x, y) < after_a(x, y)) f.frame(c.cell(x, y), {ink::red, 2.5});
        });
    }
    f.legend({560, 442}, {{Mark::frame, ink::red, "B is nearer and replaces A"}});
    f.text({860, 442}, "·  nothing there: depth 1");
    f.text({1560, 442}, "numbers: 100 × depth", lettering::right);
}

// Step 3: a face so flat that one float serves several texels: stairs, but never a step back.
void draw_monotone(Figure& f, const Plot& plot, const Exec& exec) {
    constexpr float ulp = 0x1p-24f, z0 = 0.7f, z1 = z0 + 8 * ulp, z2 = z0 + 9 * ulp;
    const Mesh flat = one_triangle({0, 0, z0}, {48, 0, z1}, {0, 48, z2});
    const TriangleRecord t = first_record(flat, texel_view(48, 48), exec);
    f.axes(plot, "texel X", "depth, in steps of float");
    std::vector<Vec2d> plane, corners;  // the formula; and what weighting the three corners gives
    int steps_back = 0;
    for (int x = 0; x < 48; ++x) {
        const double X = sample_position(x, 128);
        const auto w1 = static_cast<float>(X / 48), w2 = static_cast<float>(0.5 / 48);
        const float weighted = ((1 - w1 - w2) * z0 + w1 * z1) + w2 * z2;
        for (const int end : {x, x + 1}) {
            plane.push_back(plot.at(end, (depth_at(t, X, 0.5) - z0) / ulp));
            corners.push_back(plot.at(end, (weighted - z0) / ulp));
        }
        if (x > 0 && corners.back().y > corners[corners.size() - 3].y) ++steps_back;
    }
    f.polyline(corners, {ink::orange, 2});
    f.polyline(plane, {ink::blue, 3});
    f.text({560, 516}, "Monotone: a very flat face, one row of texels", lettering::head);
    f.legend({560, 852}, {{Mark::line, ink::blue, "×, + and rounding are monotone: never back"}});
    const std::string back = fmt::format("corners weighted (barycentric): back {} times", steps_back);
    f.legend({560, 880}, {{Mark::line, ink::orange, back}});
}

// Step 4: the plane runs on beyond its triangle; the formula stops at the range of the face.
void draw_clamped(Figure& f, const Plot& plot, const Exec& exec) {
    const Mesh steep = one_triangle({5.2f, -4, 0.25f}, {10.6f, -4, 0.75f}, {8.0f, 30, 0.5f});
    const TriangleRecord t = first_record(steep, texel_view(16, 16), exec);
    f.axes(plot, "texel X", "depth");
    f.line(plot.at(0, t.zmin), plot.at(16, t.zmin), {ink::grey, 1.5, 5});
    f.line(plot.at(0, t.zmax), plot.at(16, t.zmax), {ink::grey, 1.5, 5});
    const auto plane = [&](double X) { return plot.at(X, t.a * X + (t.b * 0.5 + t.c)); };
    f.line(plane(3.2), plane(12.6), {ink::grey, 1.5});
    for (int x = 0; x < 16; ++x) {
        const double X = sample_position(x, 128);
        const Vec2d at = plot.at(X, depth_at(t, X, 0.5));
        if (x < 15) f.arrow(at, plot.at(X + 1, depth_at(t, X + 1, 0.5)) - Vec2d{7, 0}, {ink::blue, 1.5}, 7);
        f.disc(at, 6, ink::blue);
        if (!covers(t, x, 0)) f.disc(at, 3.5, ink::paper);
    }
    f.text({1080, 516}, "Clamped: a steep face, one row of texels", lettering::head);
    f.legend({1080, 852}, {{Mark::dot, ink::blue, "covered"}, {Mark::ring, ink::blue, "not covered"}});
    f.legend({1330, 852}, {{Mark::line, ink::grey, "plane"}, {Mark::dashes, ink::grey, "range"}});
    f.paragraph({1080, 880},
                "Corners snap to 1/256 texel: a sample just outside\nthe face still gets a depth of it.");
}

}  // namespace

Image<Rgb8> lesson_2_depth(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(2, "Depth", "float(a X + (b Y + c)), clamped to the face's range: one formula everywhere.");
    draw_contours(f, exec);
    draw_nearest(f, exec);
    draw_monotone(f, {{560, 560, 460, 250}, 0, 48, -1, 9}, exec);
    draw_clamped(f, {{1080, 560, 460, 250}, 0, 16, 0, 1}, exec);
    f.source_line(2, "raster/coverage.h depth_at, covers · raster/depth_map.h depth_map");
    return f.picture;
}

}  // namespace obscura
