// Lesson 19. The sample is the texel: shadows without a map.
//
// You learn: a map samples where its texels are, the camera asks elsewhere; between them lie stairs, acne and
// leaks. So ask of the camera's own samples whether a triangle covers them as the light sees both, and
// whether they lie behind its plane (T. Aila and S. Laine, "Alias-Free Shadow Maps", EGSR 2004; G. Johnson,
// J. Lee, C. Burns, W. Mark, "The Irregular Z-Buffer", ACM TOG 2005). Sixteen neighbours on a Morton curve
// ask together. The only tolerance is what is uncertain of a sample's own place: what one depth of the camera
// may mean, and 1/256 pixel beside its own triangle, whose corners the camera has snapped.
//
// Calls: raster/exact/casters.h build_casters, exact_light, raster/exact/exact_shadow.h ExactWork,
//        ref::exact_shadow, exact_darkens, raster/shadow_map.h build_shadow_map, filters/pcf.h pcf_block.

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/exact_panels.h"
#include "lessons/exact_scene.h"
#include "lessons/ladder.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"

namespace obscura {
namespace {

constexpr int map_texels = 256;
constexpr float bias = 0.006f;  ///< of the depth range
constexpr Crop close_up{40, 87, 47, 34};

// Step 1: exact shadows of a picture's samples. Kernels must say what the definition says, which orders all
// samples, and that what rays to the sun say, which know neither grid nor boxes.
std::vector<std::uint32_t> exact_bits(const SeenPoints& seen, const ExactLight& light, ExactWork& work,
                                      const Exec& exec) {
    std::vector<std::uint32_t> lit(seen.covered.size()), defined = lit;
    ExactCounts counts;
    work.shadows(seen.points(), light, exec.isa, lit.data(), counts);
    work.shadows(seen.points(), light, Isa::ref, defined.data(), counts);
    CHECK(lit == defined);
    return lit;
}
void check_exact(const SeenPoints& seen, const ExactLight& light, const Visibility& exact,
                 const Visibility& truth) {
    CHECK(exact == truth);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const ref::ExactShadow s = ref::exact_shadow(seen.points(), light, static_cast<int>(i));
        CHECK((exact[i] == 1.0f) == (s.asks && s.lit));
    }
}

// Step 2: four ways to ask a map, and how many samples each gets wrong.
struct Way {
    std::string name, fault;
    Visibility visibility;
};
std::vector<Way> ways_of_map(const ExactScene& scene, const SeenPoints& seen, const ShadowMap& map,
                             const Exec& exec) {
    const LightView& view = map.views[0];
    const double(&depth)[4] = view.to_map.m[2];
    const double depth_per_m = length(Vec3d{depth[0], depth[1], depth[2]});
    return {{"first depth", "acne", by_first_depth(scene, seen, view, 0, exec)},
            {fmt::format("first depth, bias {:.0f} cm", 100 * static_cast<double>(bias) / depth_per_m),
             "bias: leaks", by_first_depth(scene, seen, view, bias, exec)},
            {"middle of solids", "middle: stairs", by_map(scene, seen, map, 1, exec)},
            {"middle, PCF 3 x 3", "PCF 3 x 3: blur", by_map(scene, seen, map, 3, exec)}};
}

void draw_wrong(Figure& f, Vec2d at, std::vector<Way> ways, const Visibility& exact,
                const Visibility& truth) {
    f.text(at, "At a sample a pixel", lettering::bold);
    f.text(at + Vec2d{296, 0}, "wrongly dark", lettering::right);
    f.text(at + Vec2d{384, 0}, "wrongly lit", lettering::right);
    ways.push_back({"exact", "", exact});
    for (const Way& way : ways) {
        const WrongSamples wrong = wrong_samples(way.visibility, truth);
        CHECK((wrong.dark > 0 && wrong.lit > 0) == (way.name != "exact"));
        at.y += 19;
        f.text(at, way.name);
        f.text(at + Vec2d{296, 0}, fmt::format("{}", wrong.dark), lettering::right);
        f.text(at + Vec2d{384, 0}, fmt::format("{}", wrong.lit), lettering::right);
    }
}

// Step 3: where on the light's grid the camera asks, and where a map samples.
void draw_grid(Figure& f, const SampledPicture& picture) {
    f.text({460, 142}, "1  Where the camera asks", lettering::head);
    const MapWindow all{{460, 158, 400, 400}, 0, 0, map_texels};
    draw_samples(f, picture, all, 1.3, false);
    const Image<int> asked = samples_per_texel(picture, map_texels);
    const auto idle = std::count(asked.pixels.begin(), asked.pixels.end(), 0);
    const auto busiest = std::max_element(asked.pixels.begin(), asked.pixels.end());
    const auto place = static_cast<int>(busiest - asked.pixels.begin());
    const MapWindow near{{892, 158, 180, 180}, place % map_texels - 2.0, place / map_texels - 2.0, 5};
    const MapWindow far{{892, 378, 180, 180}, 70, 160, 12};
    for (const MapWindow* window : {&near, &far}) {
        draw_samples(f, picture, *window, 5, true);
        const Vec2d from = all.at({window->x0, window->y0});
        f.frame({from.x, from.y, window->texels * all.px(), window->texels * all.px()}, {ink::red, 2});
    }
    f.text({892, 357}, fmt::format("near: up to {} a texel", *busiest));
    f.text({892, 577}, "far: texels for nobody");
    f.text({460, 577}, fmt::format("{:.0f} % of {} x {} texels are never asked",
                                   100.0 * static_cast<double>(idle) / (map_texels * map_texels), map_texels,
                                   map_texels));
}

// Step 4: casters, sixteen to a box, and samples, sixteen to a bunch.
void draw_order(Figure& f, const SampledPicture& picture) {
    f.text({1120, 142}, "2  Sixteen and sixteen", lettering::head);
    draw_sixteens(f, picture, {{1120, 158, 440, 400}, 124, 84, 20});
    f.text({1120, 577}, "boxes of 16 triangles; bunches of 16 samples, a colour each");
}

// Step 5: one triangle against one bunch; and all samples against the planes of what covers them.
void draw_tests(Figure& f, const SampledPicture& picture) {
    f.text({40, 614}, "3  Inside three edges ...", lettering::head);
    draw_pair(f, picture, telling_pair(picture), {40, 630, 270, 270});
    f.legend({40, 924}, {{Mark::dot, dark_color, "behind"},
                         {Mark::dot, lit_color, "before"},
                         {Mark::ring, lit_color, "outside"}});
    f.text({350, 614}, "... and behind the plane, metres", lettering::head);
    const PlaneDistances d = plane_distances(picture);
    CHECK(d.farthest_same < d.rounding.low && d.rounding.high < d.nearest_dark);  // nothing lies between
    draw_distances(f, d, {390, 630, 330, 248});
    f.legend({350, 924}, {{Mark::square, lit_color, "lit"},
                          {Mark::square, dark_color, "dark"},
                          {Mark::square, rounding_color, "rounding"},
                          {Mark::square, snapping_color, "1/256 pixel"}});
}

// Step 6: the same edge by maps, by exact samples, and as it is.
void draw_close_ups(Figure& f, const ExactScene& scene, const SeenPoints& seen, const std::vector<Way>& ways,
                    const ExactLight& light, const Exec& exec) {
    f.text({766, 614}, "4  The framed edge: a map of 256 texels, exact samples", lettering::head);
    f.text({1560, 614}, "rms error", {9, ink::soft, Align::right});
    const LitPixels truth = true_pixels(scene, 12, close_up, exec);
    double least = 1;
    const auto draw = [&](std::size_t i, const std::string& name, const LitPixels& pixels) {
        const Vec2d at{766 + 202.0 * static_cast<double>(i % 4), 630 + 162.0 * static_cast<double>(i / 4)};
        const double error = rms_between(pixels.light, truth.light);
        CHECK(error < least);  // each is better than the one before
        least = error;
        draw_picture(f, at, pixels.picture, 4);
        f.text(at + Vec2d{0, 153}, name);
        if (error > 0) f.text(at + Vec2d{188, 153}, fmt::format("{:.3f}", error), lettering::right);
    };
    for (std::size_t i = 0; i < ways.size(); ++i)
        draw(i, ways[i].fault, lit_pixels(scene, seen, ways[i].visibility, close_up));
    for (const int finer : {1, 2, 4}) {
        const SeenPoints finely = seen_points(scene, finer, exec);
        ExactWork work(finely.size());
        const Visibility exact = of_bits(exact_bits(finely, light, work, exec));
        draw(finer == 4 ? 6 : static_cast<std::size_t>(3 + finer),
             fmt::format("exact: {} a pixel", finer * finer), lit_pixels(scene, finely, exact, close_up));
    }
    draw(7, "truth: 144 rays", truth);
}

}  // namespace

Image<Rgb8> lesson_19_exact_shadows(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(19, "The sample is the texel",
              "Shadows of the very points that the camera sees, found without a map: no stairs, no acne, no "
              "leaks.");
    const ExactScene scene = exact_scene();
    CasterScratch scratch;
    const std::vector<Casters> casters = build_casters(scene.mesh, scene.sun, exec, scratch);
    const ExactLight light =
        exact_light(scene.sun, casters, scene.mesh, camera_rays(scene.camera, exact_width, exact_height));
    const ShadowMap map = map_of(scene, map_texels, exec);
    const SeenPoints seen = seen_points(scene, 1, exec);
    ExactWork work(seen.size());
    const std::vector<std::uint32_t> lit = exact_bits(seen, light, work, exec);
    const Visibility exact = of_bits(lit), truth = by_rays(scene, seen, exec);
    check_exact(seen, light, exact, truth);

    const SampledPicture picture = exact_picture(light, seen.points(), work, lit, map.views[0]);
    const std::vector<Way> ways = ways_of_map(scene, seen, map, exec);
    f.text({40, 142}, fmt::format("{} samples face the sun", picture.order.size()), lettering::head);
    draw_picture(f, {40, 158}, lit_pixels(scene, seen, exact, {0, 0, exact_width, exact_height}).picture, 2);
    f.frame({40 + 2.0 * close_up.x, 158 + 2.0 * close_up.y, 2.0 * close_up.width, 2.0 * close_up.height},
            {ink::red, 2});
    draw_wrong(f, {40, 446}, ways, exact, truth);
    draw_grid(f, picture);
    draw_order(f, picture);
    draw_tests(f, picture);
    draw_close_ups(f, scene, seen, ways, light, exec);
    f.source_line(19,
                  "raster/exact/casters.h build_casters exact_light · raster/exact/exact_shadow.h ExactWork "
                  "ref::exact_shadow ref::exact_darkens · raster/shadow_map.h build_shadow_map");
    return f.picture;
}

}  // namespace obscura
