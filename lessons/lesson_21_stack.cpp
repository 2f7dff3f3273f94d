// Lesson 21. A stack of shadow maps: all of them for less than one lookup each.
//
// You learn: the shadow maps of a lamp's points are nearly the same picture again and again. Put in the order
// of a curve over the lamp and stacked, they are a solid of depths, and an octree over it finds what the maps
// have in common (L. Scandolo, P. Bauszat, E. Eisemann, "Compressed Multiresolution Hierarchies for
// High-Quality Precomputed Shadows", 2016, section 4), the more so when all maps keep one plane in place. And
// how to ask all maps at once: descend with the whole run of maps, and only where no node holds for all of
// it, halve the run.
//
// Calls: hierarchy/stack/light_samples.h hilbert_samples, hierarchy/stack/focus.h focused_views,
//        hierarchy/stack/stack.h build_stack, hierarchy/stack/encode.h decode_stack, stack_value,
//        hierarchy/stack/visible_share.h visible_share, hierarchy/stack/answered_runs.h answered_runs,
//        hierarchy/stack/stack_query.h lit_samples, lit_of_subset.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/stack_panels.h"
#include "lessons/stack_scene.h"

namespace obscura {
namespace {

constexpr int picture_width = 768, picture_height = 512, lamp_maps = 256;
constexpr PictureWindow close_up{300, 205, 120, 80, 1}, counted{250, 150, 480, 320, 4};

void draw_axis(Figure& f, const Box& box, int maps) {
    f.arrow({box.x - 14, box.y + 4}, {box.x - 14, box.y + box.h}, {ink::soft, 1.2}, 8);
    f.text({box.x - 20, box.y + 0.5 * box.h}, fmt::format("{} maps", maps), {9, ink::soft, Align::right});
}

/// Step 1: the maps of points along a line, so that a cut through the stack shows what moves.
void draw_cuts(Figure& f, const LampScene& scene, const Tube& tube, const Exec& exec) {
    f.text({800, 142}, "2  A row of texels in 32 maps, from one end of the lamp to the other",
           lettering::head);
    const Stacked apart = stack_apart(scene, tube_samples(scene, {1, 0, 0}, tube_maps), tube_texels, exec);
    draw_row(f, {800, 156, 370, 232}, row_of(apart.stack, tube_texels / 2));
    f.text({800, 408}, fmt::format("each map aimed by itself: the octree takes {:.2f} of", apart.ratio()));
    f.text({800, 427}, "the maps' own quadtrees");
    draw_row(f, {1190, 156, 370, 232}, row_of(tube.stacked.stack, tube.row));
    f.text({1190, 408}, fmt::format("all maps keep the floor in place: {:.2f}.", tube.stacked.ratio()));
    f.text({1190, 427}, "The higher a thing, the more it leans");
}

/// Step 2: points of the cut, and the runs of maps that answer them.
void draw_questions(Figure& f, const Tube& tube) {
    const Box cut{110, 494, 768, 192};
    f.text({40, 458}, "3  The same cut with the octree's nodes, and four points that ask all 32 maps",
           lettering::head);
    draw_axis(f, cut, tube_maps);
    draw_row(f, cut, row_of(tube.stacked.stack, tube.row));
    const int nodes = draw_row_nodes(f, cut, tube.stacked.stack, tube.row);
    f.text({110, 705},
           fmt::format("{} nodes meet this row, for {} texels; nodes span {} maps a texel", nodes,
                       tube_maps * tube_texels, 1 << std::max(0, -tube.stacked.stack.code.shape.anisotropy)));

    const StackLookup lookup = stack_lookup(tube.stacked.stack, {0, 0, 0});
    const TellingColumns x_of = telling_columns(tube);
    struct Asked {
        const char *name, *where;
        Vec3d at;
    };
    const Asked asked[] = {{"A", "floor, lit", {x_of.lit, tube.row + 0.5, 0}},
                           {"B", "floor, penumbra", {x_of.partly, tube.row + 0.5, 0}},
                           {"C", "floor, umbra", {x_of.dark, tube.row + 0.5, 0}},
                           {"D", "above the floor", {x_of.raised, tube.row + 0.5, raised_m}}};
    double x = 930;
    for (const Asked& a : asked) {
        std::vector<Vec2d> way;
        for (int k = 0; k < tube_maps; ++k) {
            const double column =
                column_of((*tube.stacked.stack.slices)[static_cast<std::size_t>(k)], a.at.x, a.at.z);
            way.push_back({cut.x + column * cut.w / tube_texels, cut.y + (k + 0.5) * cut.h / tube_maps});
        }
        f.polyline(way, {ink::red, 2.5});
        f.text(way.front() + Vec2d{0, -11}, a.name, {9.5, ink::red, Align::centre, true, true});
        const LampReceivers one = receivers_over(tube.stacked.stack.frame, {a.at});
        StackWork work;
        const auto runs = ref::answered_runs(lookup, one.points(), 0, work);
        const NodesRead read = nodes_read(lookup, one, {Isa::ref, 1});
        draw_runs(f, {x, cut.y, 44, cut.h}, runs, tube_maps);
        f.text({x, cut.y - 8}, a.name, {9.5, ink::red, Align::left, true});
        f.paragraph({x + 54, cut.y + 14},
                    fmt::format("{}\n\n{} of 32 lit\n{} run{}\n\n{:.0f} nodes\none by one\n{:.0f}", a.where,
                                read.lit[0], runs.size(), runs.size() == 1 ? "" : "s", read.at_once[0],
                                read.one_by_one[0]),
                    {8.5, ink::dark});
        x += 160;
    }
}

/// Step 3: a few of the maps or all of them.
void draw_shares(Figure& f, const LampScene& scene, const StackLookup& lookup, const Exec& exec) {
    const LampReceivers seen = seen_receivers(scene, picture_width, picture_height, close_up, exec);
    f.text({40, 740}, "4  By 16 of the maps for each point, by all", lettering::head);
    double x = 40;
    for (const int samples : {16, 0}) {
        StackWork work;
        const auto share = visible_share(lookup, seen.points(), samples, exec, &work);
        draw_picture(f, {x, 754}, lit_picture(scene, seen, share, close_up.columns()), 2);
        f.text({x, 933}, fmt::format("{}: {:.0f} nodes a point", samples == 0 ? "all 256" : "16 of 256",
                                     static_cast<double>(work.nodes) / static_cast<double>(seen.size())));
        x += 256;
    }
}

/// Step 4: what all of them take.
void draw_work(Figure& f, const LampScene& scene, const Stacked& whole, const Exec& exec) {
    const LampReceivers seen = seen_receivers(scene, picture_width, picture_height, counted, exec);
    const auto read_of = [&](const Stacked& s) {
        return nodes_read(stack_lookup(s.stack, scene.camera.eye), seen, exec);
    };
    const NodesRead whole_read = read_of(whole);
    constexpr double least = 4, most = 4096;
    f.text({572, 740}, "5  Nodes read, all 256 maps asked", lettering::head);
    draw_nodes_read(f, {572, 754}, whole_read.one_by_one, counted.columns(), 2, least, most);
    draw_nodes_read(f, {828, 754}, whole_read.at_once, counted.columns(), 2, least, most);
    f.text({572, 933}, fmt::format("one by one: mean {:.0f}", mean_of(whole_read.one_by_one)));
    f.text({828, 933}, fmt::format("at once: mean {:.0f}", mean_of(whole_read.at_once)));
    draw_heat_scale(f, {892, 729, 120, 12}, least, most, "nodes");

    const Plot plot{{1170, 768, 300, 142}, 0, 3, 0, 3.5};
    f.text({1120, 740}, "6  The more maps, the less each costs", lettering::head);
    decade_axes(f, plot, false, "", "nodes a point");
    std::vector<Vec2d> each, at_once;
    for (const int maps : {4, 16, 64, 256}) {
        const NodesRead read = maps == lamp_maps ? whole_read : read_of(stacked(scene, maps, exec));
        const auto x = static_cast<double>(each.size());
        each.push_back(plot.at(x, decades_of(mean_of(read.one_by_one))));
        at_once.push_back(plot.at(x, decades_of(mean_of(read.at_once))));
        f.text(plot.at(x, 0) + Vec2d{0, 18}, fmt::format("{}", maps), lettering::tick);
    }
    for (const auto& [curve, color] : {std::pair{each, ink::blue}, {at_once, ink::orange}}) {
        f.polyline(curve, {color, 2});
        for (const Vec2d p : curve)
            f.disc(p, 3.5, color);
    }
    f.text(plot.at(3, 0) + Vec2d{36, 18}, "maps", {9, ink::soft, Align::left});
    f.text(each.back() + Vec2d{10, 4}, "one by one", {9, ink::blue, Align::left});
    f.text(at_once.back() + Vec2d{10, 4}, "at once", {9, ink::orange, Align::left});
}

}  // namespace

Image<Rgb8> lesson_21_stack(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(
        21, "A stack of shadow maps",
        "A lamp's maps are nearly one picture. Stacked they share an octree, and one descent asks many.");
    const LampScene scene = lamp_scene();
    const Stacked whole = stacked(scene, lamp_maps, exec);
    const StackLookup lookup = stack_lookup(whole.stack, scene.camera.eye);
    f.text({40, 142}, "The lamp's shadows", lettering::head);
    const LampReceivers seen =
        seen_receivers(scene, picture_width, picture_height, {0, 0, picture_width, picture_height}, exec);
    f.image(40, 156, lit_picture(scene, seen, visible_share(lookup, seen.points(), 0, exec), picture_width),
            2);
    f.frame({40, 156, 384, 256}, {ink::soft, 1});
    f.frame({40 + 0.5 * counted.x, 156 + 0.5 * counted.y, 0.5 * counted.width, 0.5 * counted.height},
            {ink::red, 1.5});
    f.frame({40 + 0.5 * close_up.x, 156 + 0.5 * close_up.y, 0.5 * close_up.width, 0.5 * close_up.height},
            {ink::orange, 1.5});
    f.text({40, 431},
           fmt::format("{} maps of {} x {}: {:.1f} MB, {:.2f} of their quadtrees", lamp_maps, lamp_texels,
                       lamp_texels, 1e-6 * static_cast<double>(whole.stack.bytes), whole.ratio()));
    f.text({464, 142}, "1  Where the maps stand", lettering::head);
    draw_curve(f, {464, 156, 256, 256}, 64);
    f.text({464, 431}, "64 points: 16 in a row are a square");
    const Tube tube = tube_of(scene, exec);
    draw_cuts(f, scene, tube, exec);
    draw_questions(f, tube);
    draw_shares(f, scene, lookup, exec);
    draw_work(f, scene, whole, exec);
    f.source_line(
        21,
        "hierarchy/stack/stack.h build_stack · focus.h focused_views · visible_share.h visible_share · "
        "answered_runs.h answered_runs · stack_query.h lit_samples lit_of_subset");
    return f.picture;
}

}  // namespace obscura
