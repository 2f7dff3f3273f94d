// Lesson 20. Penumbrae: many samples for the price of a few.
//
// You learn: a light with a size is many lights without, and a penumbra the sum of their hard shadows. Where
// to put them so that few do: no two on a line (H. Vogel's sunflower; a Kronecker lattice; a ball whose
// points look like a disc from every side). Too few show steps, never grain. And how not to pay for each:
// what any part of a disc in the sky can have before a point lies in a cone around its place on the grid of
// the disc's middle, so one walk through the boxes serves all parts, and most points find nothing in it at
// all.
//
// Calls: raster/light_samples.h light_samples, raster/exact/soft_casters.h soft_parts, exact_soft_light,
//        raster/exact/exact_shadow.h ExactWork, raster/exact/exact_soft.h exact_spread.

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/exact_scene.h"
#include "lessons/ladder.h"
#include "lessons/light_panels.h"
#include "raster/camera_rays.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"
#include "raster/exact/soft_casters.h"
#include "raster/light_samples.h"

namespace obscura {
namespace {

constexpr Crop close_up{40, 80, 56, 41};
constexpr int truth_parts = 1024;

/// What so many parts of the sun make of the picture, and what asking them took.
struct Sunlight {
    int parts = 1;
    Visibility share;  ///< of parts that reach each sample
    ExactCounts together, alone;
};

/// Step 1: bits of every part, at once.
Sunlight sunlight(const ExactScene& scene, const SeenPoints& seen, int count, const Exec& exec) {
    Light sun = scene.sun;
    sun.angular_diameter_deg = soft_sun_deg;
    const CameraRays rays = camera_rays(scene.camera, exact_width, exact_height);
    CasterScratch scratch;
    const std::vector<Casters> casters = build_casters(scene.mesh, sun, exec, scratch);
    const ExactLight middle = exact_light(sun, casters, scene.mesh, rays);
    const std::vector<Light> lights = light_samples(sun, count);
    const SoftParts parts = soft_parts(scene.mesh, lights, exec);
    const ExactSoft soft = exact_soft_light(sun, middle, parts, scene.mesh);
    const std::size_t words = seen.covered.size();
    // Counts are told of kernels: the reference knows no boxes.
    const Isa isa = exec.isa == Isa::ref ? Isa::sse2 : exec.isa;
    Sunlight result;
    result.parts = count;
    result.share.assign(seen.size(), 0.0f);
    std::vector<std::uint32_t> lit(words * lights.size()), own(words);
    ExactWork work(seen.size());
    work.shadows(seen.points(), soft, isa, lit.data(), words, result.together);
    for (std::size_t p = 0; p < lights.size(); ++p) {
        // Alone a part says the same.
        if (count <= 64) {
            const auto its = build_casters(scene.mesh, lights[p], exec, scratch);
            work.shadows(seen.points(), exact_light(lights[p], its, scene.mesh, rays), isa, own.data(),
                         result.alone);
            CHECK(std::equal(own.begin(), own.end(), lit.begin() + static_cast<std::ptrdiff_t>(p * words)));
        }
        for (std::size_t i = 0; i < seen.size(); ++i) {
            if ((lit[p * words + i / 16] >> (i % 16) & 1u) != 0)
                result.share[i] += 1.0f / static_cast<float>(count);
        }
    }
    return result;
}

double rms(const Visibility& a, const Visibility& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
        sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Step 2: the same penumbra by more and more parts.
void draw_steps(Figure& f, const ExactScene& scene, const SeenPoints& seen,
                const std::vector<Sunlight>& suns) {
    f.text({40, 452}, "2  The framed penumbra: steps, as many as there are parts; no grain", lettering::head);
    for (std::size_t i = 0; i < suns.size(); ++i) {
        const Vec2d at{40 + 308.0 * static_cast<double>(i), 468};
        draw_picture(f, at, lit_pixels(scene, seen, suns[i].share, close_up).picture, 5);
        f.text(at + Vec2d{0, 224},
               suns[i].parts == 1 ? "its middle" : fmt::format("{} parts", suns[i].parts));
    }
}

/// Step 3: what is wrong with few of them, and what many of them take.
void draw_charts(Figure& f, const std::vector<Sunlight>& suns, const Sunlight& truth) {
    f.text({40, 740}, "3  Error", lettering::head);
    const Plot error{{110, 766, 380, 150}, 0, 8, -3.5, -0.5};
    decade_axes(f, error, false, "parts: 1, 4, 16, 64, 256", "rms of a sample's light");
    std::vector<Vec2d> curve;
    for (const Sunlight& sun : suns) {
        const double wrong = rms(sun.share, truth.share);
        CHECK(sun.parts == 1 || wrong < 0.2);
        curve.push_back(error.at(2.0 * static_cast<double>(curve.size()), decades_of(wrong)));
    }
    f.polyline(curve, {ink::red, 2});
    for (const Vec2d p : curve)
        f.disc(p, 3.5, ink::red);

    f.text({590, 740}, "4  Work: triangles and boxes asked, for each sample", lettering::head);
    const Plot work{{660, 766, 380, 150}, 0, 6, -1, 2};
    decade_axes(f, work, false, "parts: 1, 4, 16, 64", "sixteen at a time");
    std::vector<Vec2d> together, alone;
    const auto samples = static_cast<double>(truth.share.size());
    for (const Sunlight& sun : suns) {
        if (sun.alone.samples == 0) continue;
        const auto asked = [&](const ExactCounts& c) {
            return decades_of(static_cast<double>(c.groups + c.triangles) / samples);
        };
        const double x = 2.0 * static_cast<double>(together.size());
        together.push_back(work.at(x, asked(sun.together)));
        alone.push_back(work.at(x, asked(sun.alone)));
    }
    f.polyline(alone, {ink::blue, 2});
    f.polyline(together, {ink::orange, 2});
    f.paragraph(
        {1110, 786},
        "Sixteen parts stand in the lanes of one test,\nso up to sixteen cost what one does. By\nthemselves, "
        "each has casters to put in order\nand boxes to walk; all at once, one walk finds\nthe few triangles "
        "that any may have before\nsixteen samples, and mostly none.");
    f.legend({660, 948},
             {{Mark::line, ink::blue, "each part by itself"}, {Mark::line, ink::orange, "all at once"}});
}

}  // namespace

Image<Rgb8> lesson_20_penumbrae(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(20, "Many samples for the price of a few",
              "A light with a size is many without. What none of them can have before a point, one cone "
              "tells for all.");
    const ExactScene scene = exact_scene();
    const SeenPoints seen = seen_points(scene, 1, exec);
    std::vector<Sunlight> suns;
    for (const int parts : {1, 4, 16, 64, 256})
        suns.push_back(sunlight(scene, seen, parts, exec));
    const Sunlight truth = sunlight(scene, seen, truth_parts, exec);

    f.text({40, 142}, fmt::format("A sun of {:.0f} degrees, {} parts", soft_sun_deg, suns.back().parts),
           lettering::head);
    draw_picture(f, {40, 158},
                 lit_pixels(scene, seen, suns.back().share, {0, 0, exact_width, exact_height}).picture, 2);
    f.frame({40 + 2.0 * close_up.x, 158 + 2.0 * close_up.y, 2.0 * close_up.width, 2.0 * close_up.height},
            {ink::red, 2});
    f.text({460, 142}, "1  Where the parts are", lettering::head);
    draw_lights(f, {460, 158});
    draw_cone(f, {1260, 158, 300, 240});
    draw_steps(f, scene, seen, suns);
    draw_charts(f, suns, truth);
    f.source_line(
        20,
        "raster/light_samples.h light_samples · raster/exact/soft_casters.h soft_parts exact_soft_light · "
        "raster/exact/exact_shadow.h ExactWork");
    return f.picture;
}

}  // namespace obscura
