// Lesson 3. Layers: what does a ray of light meet on its way, all of it?
//
// You learn: a depth map knows the first surface only. A layer list knows every crossing of a texel's ray:
// its depth, its triangle, and whether the ray enters a solid, leaves one, or crosses an open sheet. The
// order is a key (depth, then entry before open before exit, then triangle), so nothing depends on who came
// first. L. Bavoil et al., "Multi-Fragment Effects on the GPU using the k-Buffer", I3D 2007; ours drops
// nothing.
//
// Calls: raster/layers.h layers_of (through it setup, bins and layer tiles), core/topology.h analyse_topology
//        (which components are closed; see lessons/cut.cpp for the scene).

#include <algorithm>

#include <fmt/format.h>

#include "lessons/cut.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "raster/layers.h"

namespace obscura {
namespace {

constexpr Box side_view{180, 176, 1380, 300}, top_view{180, 690, 1380, 210};

// An entry lifts the counter, an exit lowers it, a sheet does neither.
void mark(Figure& f, Vec2d at, Crossing crossing) {
    if (crossing == Crossing::open) {
        f.disc(at, 7, ink::green);
    } else {
        f.marker(at, 8, crossing == Crossing::entry ? -1 : 1,
                 crossing == Crossing::entry ? ink::blue : ink::red);
    }
}

// Step 1: one ray, from the light through everything; below it the list in the order of the key.
void draw_ray(Figure& f, const CutScene& scene, const CutRay& ray, const Layers& layers) {
    const double X = ray.x + 0.5;
    const auto crossings = layers.at(ray.x, scene.row);
    const Vec2d top = in_cut(scene, side_view, X, 0), end = in_cut(scene, side_view, X, 1);
    f.text(top - Vec2d{0, 22}, ray.name, {9.5, ink::dark, Align::centre, true});
    f.arrow(top - Vec2d{0, 16}, end + Vec2d{0, 16}, {ink::orange, 2}, 11);
    double y = end.y + 46;
    for (const LayerCrossing& c : crossings) {
        // Entries stand left of the ray, exits right of it, so that both show where depths are equal.
        const double side = c.crossing == Crossing::entry ? -9 : c.crossing == Crossing::exit ? 9 : 0;
        mark(f, in_cut(scene, side_view, X, static_cast<double>(c.depth)) + Vec2d{side, 0}, c.crossing);
        mark(f, {top.x - 62, y - 5}, c.crossing);
        f.text({top.x - 46, y}, fmt::format("{:.3f}", c.depth));
        f.text({top.x + 6, y}, fmt::format("#{}", c.triangle), {9.5, ink::grey});
        y += 21;
    }
}

// Step 2: the same question for every texel: how long is its list? Seen from above, as the light sees it.
void draw_counts(Figure& f, const CutScene& scene, const Layers& layers) {
    const Region& r = layers.region;
    const Cells c{{top_view.x, top_view.y}, 6, r.width, r.height};
    std::size_t longest = 0;
    for (int i = 0; i < r.width * r.height; ++i)
        longest = std::max(longest, layers.at(i % r.width, r.y0 + i / r.width).size());
    const auto color = [&](std::size_t count) {
        return count == 0 ? ink::panel
                          : heat(1 - static_cast<double>(count) / static_cast<double>(longest + 1));
    };
    c.each([&](int x, int y) { f.fill(c.cell(x, y), color(layers.at(x, r.y0 + y).size())); });
    const double cut_y = c.centre(0, scene.row - r.y0).y;
    f.line({c.box().x - 8, cut_y}, {c.box().x + c.box().w + 8, cut_y}, {ink::orange, 2, 7});
    for (std::size_t count = 0; count <= longest; ++count) {
        const Box swatch{180 + 62.0 * static_cast<double>(count), 914, 58, 20};
        f.fill(swatch, color(count));
        f.label(swatch, fmt::format("{}", count), {9, readable_on(color(count))});
    }
    f.text({190 + 62.0 * static_cast<double>(longest + 1), 929}, "crossings of the texel's ray");
}

}  // namespace

Image<Rgb8> lesson_3_layers(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(3, "Layers", "Every crossing of every ray, in order: entries, exits and open sheets.");
    const CutScene scene = cut_scene();
    const Layers layers = layers_of(scene.mesh, scene.view, {0, scene.row - 17, scene.view.width, 35}, exec);

    draw_cut(f, scene, side_view, 1, exec);
    f.text({40, 190}, "Side view", lettering::head);
    f.paragraph({40, 216}, "a cut along\none row of\ntexels; darker\nwhere solids\noverlap");
    f.text({172, 184}, "0", {9, ink::soft, Align::right});
    f.text({172, 474}, "1", {9, ink::soft, Align::right});
    f.text({40, 522}, "The lists", lettering::head);
    f.paragraph({40, 548}, "depth, and\ntriangle #\n \nequal depths:\nentries first");
    for (const CutRay& ray : cut_rays(scene))
        draw_ray(f, scene, ray, layers);

    f.text({40, 704}, "From above", lettering::head);
    f.paragraph({40, 730}, "the length of\neach list; the\ndashed line\nis the cut");
    draw_counts(f, scene, layers);
    f.legend({900, 929}, {{Mark::up, ink::blue, "entry: counter + 1"},
                          {Mark::down, ink::red, "exit: counter − 1"},
                          {Mark::dot, ink::green, "open sheet: ± 0"}});
    f.source_line(3, "raster/layers.h layers_of · core/topology.h analyse_topology");
    return f.picture;
}

}  // namespace obscura
