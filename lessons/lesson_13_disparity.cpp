// Lesson 13. Disparity from depth.
//
// You learn: two eyes look side by side through one window, the screen; where their lines of sight to a point
// cross it, they are apart by d = scale / z - offset pixels; so a depth map is a disparity map, and each
// eye's picture has every point half of d away from where the middle view has it. (F. L. Scandolo, thesis,
// 2019, section 4.3.1; B. Mendiburu, "3D Movie Making", 2009.)
//
// Calls: stereo/stereo_rig.h disparity_law, stereo/disparity.h disparity_map, two_way_disparity,
//        stereo/moved_mesh.h eye_positions, stereo/eye_mesh.h eye_mesh.

#include <cmath>

#include <fmt/format.h>

#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/stereo_panels.h"
#include "lessons/stereo_scene.h"
#include "stereo/disparity.h"

namespace obscura {
namespace {

constexpr int width = 360, height = 240, row = 143;
constexpr Rgb8 left_color = ink::blue, right_color = ink::red;

/// A point of the scene that the lesson follows: column of the middle view, in `row`.
struct Followed {
    int column = 0;
    Rgb8 color;
    const char* name;
};
constexpr Followed followed[] = {
    {290, ink::green, "bust"}, {91, ink::dark, "block"}, {136, ink::orange, "wall"}};

// Step 1: the rig from above. A row of the depth map is a section through the scene.
void draw_rig(Figure& f, const StereoScene& scene, const SeenPicture& seen, Vec2d eyes) {
    const auto at = [&](double x, double z) { return eyes + Vec2d{112 * x, -50 * z}; };
    const double half = 0.5 * scene.rig.interaxial_m, screen = scene.rig.zero_parallax_m;
    f.line(at(-2.15, screen), at(2.15, screen), {ink::grey, 2});
    f.text(at(2.15, screen) - Vec2d{0, 8}, "screen, 4 m", {9, ink::soft, Align::right, false, true});
    for (int x = 0; x < width; ++x) {
        const Vec3f p = seen.position(x, row);
        if (std::fabs(p.x) < 2.15f)
            f.disc(at(static_cast<double>(p.x), -static_cast<double>(p.z)), 1.6, ink::soft);
    }
    for (const Followed& point : followed) {
        const Vec3d p = to_double(seen.position(point.column, row));
        for (const double eye : {-half, half}) {
            const double reach = std::max(1.0, screen / -p.z);
            f.line(at(eye, 0), at(eye + (p.x - eye) * reach, -p.z * reach),
                   {eye < 0 ? left_color : right_color, 1.1});
            const double crossing = eye + (p.x - eye) * screen / -p.z;
            f.fill({at(crossing, 0).x - 1.5, at(0, screen).y - 6, 3, 12}, eye < 0 ? left_color : right_color);
        }
        f.disc(at(p.x, -p.z), 5, point.color);
        f.text(at(p.x, -p.z) + Vec2d{9, -9}, point.name, {9, point.color, Align::left, true, true});
    }
    f.disc(at(-half, 0), 6, left_color);
    f.disc(at(half, 0), 6, right_color);
    f.text(at(-half, 0) + Vec2d{-12, 4}, "left eye", {9, left_color, Align::right, true, false});
    f.text(at(half, 0) + Vec2d{12, 4}, "right eye", {9, right_color, Align::left, true, false});
}

// Step 2: the law.
void draw_law(Figure& f, const DisparityLaw& law, const SeenPicture& seen, const Plot& plot) {
    f.axes(plot, "", "d, pixels");
    level_lines(f, plot, {-30, -20, -10, 0, 10, 20, 30});
    axis_numbers(f, plot, {2, 4, 6, 8, 10}, 0);
    f.text(plot.at(plot.x1, plot.y0) + Vec2d{10, 38}, "z, metres",
           {9, ink::soft, Align::right, false, false});
    f.line(plot.at(plot.x0, -law.offset), plot.at(plot.x1, -law.offset), {ink::grey, 1.2, 5});
    f.text(plot.at(plot.x1, -law.offset) + Vec2d{-6, 16}, "−offset: infinitely far",
           {9, ink::soft, Align::right, false, false});
    std::vector<Vec2d> curve;
    for (double z = plot.x0; z <= plot.x1; z += 0.05) {
        if (law.at(z) <= 30) curve.push_back(plot.at(z, static_cast<double>(law.at(z))));
    }
    f.polyline(curve, {ink::dark, 2});
    for (const Followed& point : followed) {
        const auto z = static_cast<double>(seen.depth_m(point.column, row));
        const Vec2d at = plot.at(z, static_cast<double>(law.at(z)));
        f.disc(at, 5, point.color);
        f.text(at + Vec2d{10, -9}, point.name, {9, point.color, Align::left, true, true});
    }
}

/// Rings where the points are at `share` of their disparity, and a line to where the middle view has them.
void draw_points(Figure& f, Vec2d at, const DisparityMap& map, double share) {
    for (const Followed& point : followed) {
        const double x = point.column + 0.5, moved = x + share * static_cast<double>(map(point.column, row));
        f.line(at + Vec2d{x, row - 17.0}, at + Vec2d{x, row + 18.0}, {ink::paper, 1.5});
        f.line(at + Vec2d{x, row + 0.5}, at + Vec2d{moved, row + 0.5}, {ink::dark, 1.5});
        f.disc(at + Vec2d{moved, row + 0.5}, 5.5, ink::paper);
        f.disc(at + Vec2d{moved, row + 0.5}, 4, point.color);
    }
}

// Step 3: an eye's picture, and in it what the other eye does not see.
void draw_eye(Figure& f, const StereoScene& scene, const EyeDisparity& eye, Eye which, Vec2d at,
              const Exec& exec) {
    const MovedMesh mesh = unmoved(scene.mesh);
    Image<Rgb8> picture = shaded(scene.mesh, seen_by_eye(scene, mesh, which, width, height, exec));
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Sight sight = eye.sight.pixels[i];
        if (sight == Sight::hidden || sight == Sight::outside)
            picture.pixels[i] = mix(picture.pixels[i], ink::yellow, 0.75);
        if (sight == Sight::unknown) picture.pixels[i] = mix(picture.pixels[i], ink::purple, 0.8);
    }
    draw_picture(f, at, picture);
}

void draw_table(Figure& f, const MiddleView& view, Vec2d at) {
    constexpr double columns[] = {120, 190, 270, 350};
    constexpr const char* heads[] = {"z", "d", "left X", "right X"};
    for (int i = 0; i < 4; ++i)
        f.text(at + Vec2d{columns[i], 0}, heads[i], {9.5, ink::dark, Align::right, true, false});
    for (const Followed& point : followed) {
        at.y += 28;
        const auto d = static_cast<double>(view.disparity(point.column, row));
        const double x = point.column + 0.5;
        f.text(at, point.name, {9.5, point.color, Align::left, true, false});
        f.text(at + Vec2d{columns[0], 0}, fmt::format("{:.2f} m", view.depth_m(point.column, row)),
               lettering::right);
        f.text(at + Vec2d{columns[1], 0}, fmt::format("{:+.1f}", d), lettering::right);
        f.text(at + Vec2d{columns[2], 0}, fmt::format("{:.1f}", x + 0.5 * d), lettering::right);
        f.text(at + Vec2d{columns[3], 0}, fmt::format("{:.1f}", x - 0.5 * d), lettering::right);
    }
}

}  // namespace

Image<Rgb8> lesson_13_disparity(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(13, "Disparity from depth",
              "Two eyes look through one window: how far apart their lines of sight cross it.");
    const StereoScene scene = stereo_scene();
    const SeenPicture seen = seen_from_middle(scene.mesh, scene.camera, width, height, exec);
    const MiddleView view = stereo_view(scene, seen);
    const DisparityLaw law = disparity_law(scene.rig, scene.camera, height);
    f.text({40, 140}, "The rig from above: one row of the picture", lettering::head);
    draw_rig(f, scene, seen, {290, 560});
    f.text({600, 140}, "d = scale / z − offset", lettering::head);
    draw_law(f, law, seen, {{650, 190, 440, 330}, 1.5, 10.5, -30, 30});
    f.text({1170, 140}, "Three points", lettering::head);
    draw_table(f, view, {1170, 176});
    f.paragraph({1170, 306},
                fmt::format("scale = focal length × distance of the eyes\n = {:.1f} px × {:.1f} m\noffset = "
                            "scale / {:.0f} m = {:.1f} px\n \nd is left X minus right X: positive before "
                            "the\nscreen, 0 on it. However far a point is, d never\nfalls below −offset. The "
                            "eyes are 30 cm apart to\nmake it plain; yours are 6.",
                            law.focal_px, scene.rig.interaxial_m, scene.rig.zero_parallax_m, law.offset));
    const DisparityColours colours{-20, 20};
    const TwoWayDisparity eyes = two_way_disparity(view, view.disparity, {}, exec);
    constexpr double y = 640, x[] = {40, 426, 812, 1200};
    constexpr const char* names[] = {"middle view", "its disparity map", "left eye: X + d/2",
                                     "right eye: X − d/2"};
    for (int i = 0; i < 4; ++i)
        f.text({x[i], y - 12}, names[i], lettering::bold);
    draw_picture(f, {x[0], y}, shaded(scene.mesh, seen));
    draw_map(f, {x[1], y}, view.disparity, colours);
    draw_eye(f, scene, eyes.left, Eye::left, {x[2], y}, exec);
    draw_eye(f, scene, eyes.right, Eye::right, {x[3], y}, exec);
    for (int i = 0; i < 4; ++i)
        draw_points(f, {x[i], y}, view.disparity, i < 2 ? 0 : 2.5 - i);
    draw_colours(f, {x[1], y + height + 10}, 330, colours, "px");
    f.legend({x[2], y + height + 24},
             {{Mark::square, ink::yellow, "the other eye does not see it"},
              {Mark::square, ink::purple, "nor did the middle view: a map knows nothing here"}});
    f.source_line(13,
                  "stereo/stereo_rig.h disparity_law · stereo/disparity.h disparity_map two_way_disparity · "
                  "stereo/moved_mesh.h eye_positions");
    return f.picture;
}

}  // namespace obscura
