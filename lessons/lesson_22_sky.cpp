// Lesson 22. The sky as many suns.
//
// You learn: light of the whole sky is the sum over directions, and so K distant lights with hard shadows:
// cut the sky into K parts, put each part's light where its middle is. Where little sky is seen, little light
// arrives, which no constant "ambient" knows: between two walls the ground's share is known in closed form,
// and the sum comes to it as K grows. What shade keeps is the sky's own colour: it is blue.
//
// Calls: core/sky/clear_sky.h clear_air, clear_sky, sky_radiance, core/sky/sky_directions.h sky_grid,
//        sky_directions, raster/exact/casters.h build_casters, exact_light,
//        raster/exact/exact_shadow.h ExactWork.

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/color.h"
#include "core/error.h"
#include "core/sky/clear_sky.h"
#include "core/sky/sky_directions.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/sky_panels.h"
#include "lessons/street_scene.h"

namespace obscura {
namespace {

constexpr int width = 1080, height = 720, side = 336, picture_suns = 64;
constexpr double sun_azimuth_deg = 212, sun_elevation_deg = 52;

/// The sun as one more direction.
SkyDirection sun_of(const ClearSky& sky) {
    return {sky.towards_sun, sky.sun_irradiance_w_m2, 0};
}

/// Step 1: parts of the sky, and which of them the street's middle sees.
void draw_skies(Figure& f, const ClearSky& sky, const SkyGrid& grid, const Mesh& street, const Camera& camera,
                const Exec& exec) {
    const auto suns = sky_directions(grid, picture_suns, SkyImportance::radiance);
    const auto color = [&](Vec3d d) { return exposed(to_double(sky_radiance(sky, d)) * 1.6); };
    const Box whole{40, 156, 240, 240}, seen{310, 156, 240, 240};
    f.text({40, 142}, fmt::format("1  The sky as {} suns", picture_suns), lettering::head);
    draw_sky_disc(f, whole, color);
    draw_suns(
        f, whole, suns, [](std::size_t) { return true; }, 3.2, ink::yellow);
    f.text({40, 420}, "each as strong as any other:");
    f.text({40, 439}, "they crowd where the sky is bright");

    const SeenPoints middle = ground_points(street, {0});
    const Arrivals arrive = arrivals(street, camera, middle, suns, exec);
    f.text({310, 142}, "2  From the street's middle", lettering::head);
    draw_sky_disc(f, seen, [&](Vec3d d) {
        const bool wall = d.y * 0.5 * street_width < std::fabs(d.x) * wall_height;
        return wall ? Rgb8{120, 108, 96} : color(d);
    });
    draw_suns(
        f, seen, suns, [&](std::size_t k) { return arrive(k, 0); }, 3.2, ink::yellow);
    const int count = count_arrivals(arrive, suns.size(), 0);
    f.text({310, 420}, fmt::format("{} of {} arrive: a hard shadow each,", count, picture_suns));
    f.text({310, 439}, "asked at the point itself");
}

/// Steps 2 and 3: across the street, and how far from the formula.
void draw_convergence(Figure& f, const Mesh& street, const Camera& camera, const Exec& exec) {
    std::vector<double> xs;
    for (int i = 0; i < 96; ++i)
        xs.push_back(street_width * ((i + 0.5) / 96 - 0.5));
    const SeenPoints ground = ground_points(street, xs);
    const Plot across{{630, 176, 400, 200}, -0.5 * street_width, 0.5 * street_width, 0, 0.6};
    f.text({590, 142}, "3  Share of an even sky, from wall to wall", lettering::head);
    draw_share_axes(f, across);
    const Plot errors{{1170, 176, 380, 200}, 0, 3, -4, -1};
    f.text({1110, 142}, "4  Distance from the formula", lettering::head);
    decade_axes(f, errors, false, "", "rms");
    std::vector<Vec2d> curve[2];
    for (const int suns : {16, 64, 256, 1024}) {
        const auto place = static_cast<double>(curve[0].size());
        for (const SkyImportance importance : {SkyImportance::radiance, SkyImportance::cosine}) {
            const auto share = even_sky_shares(street, camera, ground, suns, importance, exec);
            double sum = 0;
            for (std::size_t i = 0; i < xs.size(); ++i)
                sum += (share[i] - sky_view_factor(xs[i])) * (share[i] - sky_view_factor(xs[i]));
            const double rms = std::sqrt(sum / static_cast<double>(xs.size()));
            CHECK(rms < 0.5 / std::sqrt(suns), "the sum comes to the formula");
            curve[importance == SkyImportance::cosine].push_back(errors.at(place, decades_of(rms)));
            if (importance == SkyImportance::radiance || suns == 64 || suns == 1024) continue;
            std::vector<Vec2d> steps;
            for (std::size_t i = 0; i < xs.size(); ++i)
                steps.push_back(across.at(xs[i], share[i]));
            f.polyline(steps, {suns == 16 ? ink::sky : ink::orange, 2});
        }
        f.text(errors.at(place, errors.y0) + Vec2d{0, 18}, fmt::format("{}", suns), lettering::tick);
    }
    std::vector<Vec2d> formula;
    for (const double x : xs)
        formula.push_back(across.at(x, sky_view_factor(x)));
    f.polyline(formula, {ink::dark, 1.2});
    f.legend({630, 428}, {{Mark::line, ink::dark, "(sin a + sin b) / 2"},
                          {Mark::line, ink::sky, "16 suns"},
                          {Mark::line, ink::orange, "256"}});
    const Rgb8 colors[] = {ink::purple, ink::orange};
    for (int i = 0; i < 2; ++i) {
        f.polyline(curve[i], {colors[i], 2});
        for (const Vec2d p : curve[i])
            f.disc(p, 3.5, colors[i]);
    }
    f.text({errors.box.x + errors.box.w + 10, 414}, "suns", {9, ink::soft, Align::right});
    f.legend({1130, 428}, {{Mark::line, ink::purple, "equal parts of the sky"},
                           {Mark::line, ink::orange, "equal light on the ground"}});
}

/// Step 4: the street by the sun, and by a sky that every wall lets through or that has shadows.
void draw_streets(Figure& f, const ClearSky& sky, const StreetScene& street, const SkyGrid& grid,
                  const Exec& exec) {
    const SeenPoints seen = seen_points(street.mesh, street.camera, width, height, exec);
    const std::vector<SkyDirection> sun{sun_of(sky)};
    const auto by_sun = irradiance(seen, sun, arrivals(street.mesh, street.camera, seen, sun, exec));
    const auto radiance = [&](Vec3d d) { return sky_radiance(sky, d); };
    const auto draw = [&](double x, std::vector<Vec3d> light) {
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] = light[i] + by_sun[i];
        f.image(static_cast<int>(x), 484, street_picture(street, seen, light, radiance, width, height), 2);
        f.frame({x, 484, 0.5 * width, 0.5 * height}, {ink::soft, 1});
    };
    const auto suns = sky_directions(grid, picture_suns, SkyImportance::radiance);
    f.text({40, 470}, "5  Sun and sky: every wall lets the sky's light through", lettering::head);
    draw(40, irradiance(seen, suns));
    f.text({600, 470}, fmt::format("6  The same sun and sky, as {} more suns with shadows", picture_suns),
           lettering::head);
    draw(600, irradiance(seen, suns, arrivals(street.mesh, street.camera, seen, suns, exec)));
}

/// Step 5: how many suns it takes to hide them, and what colour the shade has.
void draw_shade(Figure& f, const ClearSky& sky, const StreetScene& street, const Mesh& plain,
                const SkyGrid& grid, const Exec& exec) {
    StreetScene near = street;
    near.camera.look_at = {2.9, 0.75, -0.6};
    near.camera.vfov_deg = 17;
    const SeenPoints seen = seen_points(near.mesh, near.camera, side, side, exec);
    const auto radiance = [&](Vec3d d) { return sky_radiance(sky, d); };
    f.text({1180, 470}, "7  The sky alone, three times as bright", lettering::head);
    const Vec2d places[] = {{1180, 484}, {1392, 484}, {1180, 684}};
    int i = 0;
    for (const int count : {16, 64, 256}) {
        const auto suns = sky_directions(grid, count, SkyImportance::radiance);
        auto light = irradiance(seen, suns, arrivals(near.mesh, near.camera, seen, suns, exec));
        for (Vec3d& l : light)
            l = l * 3.0;
        const Vec2d at = places[i++];
        f.image(static_cast<int>(at.x), static_cast<int>(at.y),
                street_picture(near, seen, light, radiance, side, side), 2);
        f.frame({at.x, at.y, 0.5 * side, 0.5 * side}, {ink::soft, 1});
        f.text(at + Vec2d{0, 0.5 * side + 19}, fmt::format("{} suns", count));
    }

    // A white page on the ground, in the sun and in the shade of a wall.
    const std::vector<Vec3d> light = sun_and_sky(plain, near.camera, {3.5, -3.5}, sun_of(sky),
                                                 sky_directions(grid, 256, SkyImportance::radiance), exec);
    for (std::size_t k = 0; k < 2; ++k) {
        const double most = std::max({light[k].x, light[k].y, light[k].z});
        draw_swatch(f, {1392, 684 + 92.0 * static_cast<double>(k), 56, 56},
                    linear_to_srgb8(to_float(light[k] * (0.9 / most))),
                    k == 0 ? "in the sun" : "in the shade",
                    fmt::format("blue/red {:.2f}", light[k].z / light[k].x));
    }
    f.text({1392, 684 + 168}, "a white page, each as bright");
}

}  // namespace

Image<Rgb8> lesson_22_sky(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(22, "The sky as many suns",
              "Skylight is a sum over directions: a hard shadow each. Where little sky is seen, little light "
              "arrives.");
    const ClearSky sky = clear_sky(clear_air({}, exec), sun_azimuth_deg, sun_elevation_deg, exec);
    const SkyGrid grid = sky_grid([&](Vec3d d) { return sky_radiance(sky, d); }, exec);
    const Mesh plain = plain_street();
    const StreetScene street = street_scene();
    draw_skies(f, sky, grid, plain, street.camera, exec);
    draw_convergence(f, plain, street.camera, exec);
    draw_streets(f, sky, street, grid, exec);
    draw_shade(f, sky, street, plain, grid, exec);
    f.paragraph(
        {40, 872},
        "Without shadows the arcade and the ground below the awning are as bright as the open street, and "
        "nothing stands on the\nground. As many suns, the sky keeps out of corners by itself: there is no "
        "constant to choose. What is black now saw no sky; the\nlight that walls send on is missing here, "
        "and is what a bounce brings. Shade is lit by the sky alone, and so it is blue.");
    f.source_line(22,
                  "core/sky/clear_sky.h clear_sky sky_radiance · core/sky/sky_directions.h sky_directions · "
                  "raster/exact/casters.h build_casters · exact_shadow.h ExactWork");
    return f.picture;
}

}  // namespace obscura
