// Lesson 17. Vertices follow the map.
//
// You learn: the eyes' pictures are not made by moving pixels but by moving vertices, each by half of the
// disparity that the map found for it; between vertices the change is linear, so triangles are cut until that
// is near enough, and only where it is not. Both eyes rasterize surfaces: there are no holes. (Scandolo,
// Bauszat, Eisemann 2018; F. L. Scandolo, thesis, 2019, section 4.3.4.)
//
// Calls: stereo/moved_mesh.h moved_mesh, eye_positions, stereo/refine.h refine, stereo/screen_weights.h,
//        stereo/eye_mesh.h eye_mesh.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/stereo_edits.h"
#include "lessons/stereo_panels.h"
#include "stereo/screen_weights.h"

namespace obscura {
namespace {

constexpr int width = 320, height = 208;
constexpr DisparityColours change_colours{-20, 20}, error_colours{-2, 2};

/// A mesh that follows the map, and by how much it misses it.
struct Following {
    MovedMesh moved;
    ReprojectStats stats;
    DisparityMap error;
};

// Step 1: the change at every pixel, as the triangle there has it, less the map's.
DisparityMap error_of(const StereoScene& scene, const MiddleView& view, const DisparityMap& change,
                      const MovedMesh& moved, const Exec& exec) {
    const MapProjection projection = map_projection(scene.camera, view);
    const SeenPicture seen = seen_from_middle(moved.mesh, scene.camera, width, height, exec);
    DisparityMap error(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (seen.triangle(x, y) == nothing_seen) continue;
            const auto& v = moved.mesh.triangles[seen.triangle(x, y)].v;
            const auto corner = [&](int k) { return projection.project(moved.mesh.positions[v[k]]); };
            double weight[3], sum = 0;
            ScreenWeights(corner(0), corner(1), corner(2)).at(x + 0.5, y + 0.5, weight);
            for (int k = 0; k < 3; ++k)
                sum += weight[k] * static_cast<double>(moved.change_px[v[k]]);
            error(x, y) = static_cast<float>(sum) - change(x, y);
        }
    }
    return error;
}

Following following(const StereoScene& scene, const MiddleView& view, const DisparityMap& solved,
                    int max_splits, const Exec& exec) {
    Following f;
    ReprojectParams params;
    params.max_splits = max_splits;
    f.moved = moved_mesh(scene.mesh, scene.camera, view, solved, params, exec, f.stats);
    f.error = error_of(scene, view, difference(solved, view.disparity), f.moved, exec);
    return f;
}

// Step 2: triangles over the change that they should follow, hidden ones left out.
void draw_triangles(Figure& f, Vec2d at, const StereoScene& scene, const Following& mesh,
                    const DisparityMap& change, const Exec& exec) {
    const SeenPicture seen = seen_from_middle(mesh.moved.mesh, scene.camera, 2 * width, 2 * height, exec);
    const Image<Rgb8> colours = disparity_picture(change, change_colours, exec);
    Image<Rgb8> picture(2 * width, 2 * height);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const std::uint32_t here = seen.triangle(x, y);
            const bool edge =
                (x > 0 && seen.triangle(x - 1, y) != here) || (y > 0 && seen.triangle(x, y - 1) != here);
            picture(x, y) = edge ? mix(colours(x / 2, y / 2), ink::dark, 0.75) : colours(x / 2, y / 2);
        }
    }
    draw_picture(f, at, picture);
}

double within(const DisparityMap& error, double tolerance_px) {
    const auto good = std::count_if(error.pixels.begin(), error.pixels.end(), [&](float e) {
        return std::fabs(static_cast<double>(e)) <= tolerance_px;
    });
    return 100.0 * static_cast<double>(good) / static_cast<double>(error.pixels.size());
}

}  // namespace

Image<Rgb8> lesson_17_vertices(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(17, "Vertices follow the map",
              "Not pixels are moved but vertices; triangles are cut where the map bends, and both eyes draw "
              "surfaces without holes.");
    const StereoScene scene = stereo_scene();
    const MiddleView view = stereo_view(scene, width, height, exec);
    const DisparityMap solved =
        minimiser(lesson_system(scene, view, lesson_edits(view, 16), {}, exec).system, exec);
    const DisparityMap change = difference(solved, view.disparity);
    const Following before = following(scene, view, solved, 0, exec),
                    after = following(scene, view, solved, 20, exec);
    constexpr double y = 676;
    const std::pair<const Following*, const char*> meshes[] = {{&before, "the scene's triangles"},
                                                               {&after, "cut until 0.1 px from the map"}};
    double x = 40;
    for (const auto& [mesh, name] : meshes) {
        f.text({x, 138}, name, lettering::head);
        f.text({x + 640, 138}, fmt::format("{} triangles", mesh->stats.triangles_out), lettering::right);
        draw_triangles(f, {x, 150}, scene, *mesh, change, exec);
        x += 700;
    }
    f.paragraph({1400, 168},
                "Colours: the change,\nsolved less original\ndisparity. The bust is\nonly shifted: "
                "nothing\nto cut. The ball was\nmade rounder, wall\nand floor bend to meet\nwhat moved.");
    draw_colours(f, {40, 580}, 300, change_colours, "px");
    constexpr double columns[] = {40, 420, 860, 1240};
    x = columns[0];
    for (const auto& [mesh, name] : meshes) {
        f.text({x, y - 12}, x < 100 ? "error before" : "after", lettering::bold);
        f.text({x + width, y - 12}, fmt::format("{:.1f} % within 0.1 px", within(mesh->error, 0.1)),
               lettering::right);
        draw_map(f, {x, y}, mesh->error, error_colours);
        x = columns[1];
    }
    draw_colours(f, {40, y + height + 10}, 300, error_colours, "px");
    for (const Eye eye : {Eye::left, Eye::right}) {
        x = columns[eye == Eye::left ? 2 : 3];
        f.text({x, y - 12}, eye == Eye::left ? "left eye" : "right eye", lettering::bold);
        draw_picture(f, {x, y},
                     shaded(after.moved.mesh, seen_by_eye(scene, after.moved, eye, width, height, exec)));
    }
    f.text({columns[2], y + height + 24},
           "The same triangles, moved half a disparity either way, lit where they really are.");
    f.source_line(17,
                  "stereo/moved_mesh.h moved_mesh eye_positions · stereo/screen_weights.h · "
                  "stereo/eye_mesh.h eye_mesh");
    return f.picture;
}

}  // namespace obscura
