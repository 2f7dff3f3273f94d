// Lamps of any shape: surfaces that shine, as lights.

#include <gtest/gtest.h>

#include <cmath>

#include "app/frame/surface_light.h"
#include "app/scene/build.h"
#include "app/scene/scene_file.h"
#include "core/error.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

/// A floor seen from straight above, 4 x 4 m of it, a lamp over it; the floor has a soft matt white.
std::string floor_scene(const std::string& lamp, const std::string& lights) {
    return "format = 1\n[camera]\nprojection = \"orthographic\"\nheight_m = 4\neye_m = [0, 0.4, 0]\n"
           "look_at_m = [0, 0, 0]\nup = [0, 0, -1]\nnear_m = 0.01\n"
           "[render]\nsize_px = [64, 64]\nsamples = 1\n"
           "[sky]\nambient = 0\n[material.glow]\nbase_color = 0\nemission_w_m2_sr = 7\n"
           "[material.white]\nbase_color = 1\nroughness = 1\n"
           "[[mesh]]\nid = \"floor\"\nshape = \"plane\"\nwidth_m = 200\ndepth_m = 200\nmaterial = "
           "\"white\"\n" +
           lamp + lights;
}

Frame render(const std::string& text) {
    const SceneDocument document = read_scene_text(text, "scene.toml");
    return render_frame(build_scene(document, {}));
}

const std::string surface_light_text =
    "[[light]]\nid = \"l\"\ntype = \"surface\"\nmaterial = \"glow\"\nrange_m = 10000\n";

TEST(SurfaceLamp, APanelIsAnAreaLight) {
    // A box whose lower face shines down, with the rest of it in the way of the rest.
    const std::string panel =
        "[[mesh]]\nid = \"panel\"\nshape = \"plane\"\nwidth_m = 1.2\ndepth_m = 0.5\ntranslate_m = [0.3, 0.8, "
        "0]\n"
        "rotate_deg = [180, 0, 0]\nmaterial = \"glow\"\n"
        "[[mesh]]\nid = \"post\"\nshape = \"box\"\nsize_m = [0.1, 0.3, 0.1]\ntranslate_m = [-0.5, 0.15, "
        "0.4]\n";
    const Frame lamp = render(floor_scene(panel, surface_light_text + "shadow = { samples = 256 }\n"));
    const Frame area =
        render(floor_scene(panel,
                           "[[light]]\nid = \"l\"\ntype = \"area\"\nradiance_w_m2_sr = 7\n"
                           "position_m = [0.3, 0.8, 0]\nlook_at_m = [0.3, 0, 0]\nwidth_m = 1.2\n"
                           "height_m = 0.5\nrange_m = 10000\nshadow = { samples = 256 }\n"));
    double sum = 0, apart = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const auto a = static_cast<double>(pixel(lamp, x, y).x),
                       b = static_cast<double>(pixel(area, x, y).x);
            sum += b;
            apart += std::fabs(a - b);
            EXPECT_NEAR(a, b, 0.03) << x << ',' << y;
        }
    }
    EXPECT_GT(sum / 4096, 0.2);
    EXPECT_LT(apart / sum, 0.004);
}

TEST(SurfaceLamp, ABallShinesAsAPointAtItsMiddle) {
    // Irradiance of a uniform ball that is seen whole: pi L (R / d)^2 cos.
    const double radius = 0.15, high = 0.9;
    const std::string ball =
        "[[mesh]]\nid = \"ball\"\nshape = \"sphere\"\nradius_m = 0.15\ntranslate_m = [0.2, 0.9, -0.1]\n"
        "material = \"glow\"\n";
    for (const int samples : {1, 64, 256}) {
        const Frame frame = render(floor_scene(
            ball, surface_light_text + "shadow = { samples = " + std::to_string(samples) + " }\n"));
        for (const auto& [px, py] : {std::pair{32, 32}, {5, 60}, {50, 20}, {63, 0}, {36, 32}}) {
            const double x = ((px + 0.5) / 64 - 0.5) * 4 - 0.2, z = ((py + 0.5) / 64 - 0.5) * 4 + 0.1;
            const double r2 = x * x + z * z + high * high;
            const double expected = 7 * radius * radius / r2 * (high / std::sqrt(r2)) * 0.96 * 0.96;
            // A sphere of triangles has less surface.
            EXPECT_NEAR(static_cast<double>(pixel(frame, px, py).x), expected, 0.02 * expected)
                << samples << ": " << px << ',' << py;
        }
    }
}

/// Light that leaves the middle of the floor, and of a ceiling as far above the lamp at y = 0.8.
struct BothSides {
    double floor, ceiling;
};
BothSides both_sides(const std::string& lamp, const std::string& samples) {
    const std::string ceiling =
        "[[mesh]]\nid = \"ceiling\"\nshape = \"plane\"\nwidth_m = 200\ndepth_m = 200\n"
        "rotate_deg = [180, 0, 0]\ntranslate_m = [0, 1.6, 0]\nmaterial = \"white\"\n";
    const std::string light =
        surface_light_text + (samples.empty() ? "" : "shadow = { samples = " + samples + " }\n");
    const std::string down = floor_scene(lamp + ceiling, light);
    std::string up = down;
    for (const auto& [from, to] :
         {std::pair<std::string, std::string>{"eye_m = [0, 0.4, 0]", "eye_m = [0, 1.2, 0]"},
          {"look_at_m = [0, 0, 0]", "look_at_m = [0, 1.6, 0]"}})
        up.replace(up.find(from), from.size(), to);
    const auto middle = [](const Frame& frame) {
        double sum = 0;
        for (int y = 24; y < 40; ++y) {
            for (int x = 24; x < 40; ++x)
                sum += static_cast<double>(pixel(frame, x, y).x) / 256;
        }
        return sum;
    };
    return {middle(render(down)), middle(render(up))};
}

TEST(SurfaceLamp, WhatShinesToAllSidesIsAsBrightFromEach) {
    const std::string sheet =
        "[[mesh]]\nid = \"sheet\"\nshape = \"box\"\nsize_m = [1, 0.01, 1]\ntranslate_m = [0, 0.8, 0]\n"
        "material = \"glow\"\n";
    const std::string tube =
        "[[mesh]]\nid = \"tube\"\nshape = \"cylinder\"\nradius_m = 0.01\nheight_m = 1.2\n"
        "rotate_deg = [0, 0, 90]\ntranslate_m = [0.6, 0.8, 0]\nmaterial = \"glow\"\n";
    // Nine, of which few points show few sides each.
    std::string balls =
        "[[mesh]]\nid = \"balls\"\nshape = \"sphere\"\nradius_m = 0.03\nsegments = 24\nrings = 12\n"
        "material = \"glow\"\n";
    for (int i = 0; i < 9; ++i)
        balls += "[[mesh.instance]]\ntranslate_m = [" + std::to_string(0.3 * (i % 3) - 0.3) + ", 0.8, " +
                 std::to_string(0.3 * (i / 3) - 0.3) + "]\n";
    struct Case {
        std::string lamp;
        double near_64, near_16;
    };
    for (const Case& c : {Case{sheet, 0.03, 0.05}, {tube, 0.05, 0.15}, {balls, 0.2, 0.5}}) {
        const BothSides truth = both_sides(c.lamp, "256");
        EXPECT_NEAR(truth.floor / truth.ceiling, 1, 0.03);
        for (const auto& [samples, near] : {std::pair{"64", c.near_64}, {"16", c.near_16}}) {
            const BothSides few = both_sides(c.lamp, samples);
            EXPECT_NEAR(few.floor / truth.floor, 1, near) << samples;
            EXPECT_NEAR(few.ceiling / truth.ceiling, 1, near) << samples;
        }
    }
}

TEST(SurfaceLamp, APanelLightsNothingBehindItUnlessItIsTakenForAPoint) {
    const std::string panel =
        "[[mesh]]\nid = \"panel\"\nshape = \"plane\"\nwidth_m = 0.6\ndepth_m = 0.6\n"
        "translate_m = [0, 0.8, 0]\nrotate_deg = [180, 0, 0]\nmaterial = \"glow\"\n";
    // By default, too, where no penumbra is in sight.
    const BothSides usual = both_sides(panel, "");
    EXPECT_GT(usual.floor, 0.3);
    EXPECT_EQ(usual.ceiling, 0);
    const BothSides point = both_sides(panel, "1");
    EXPECT_NEAR(point.floor, point.ceiling, 0.01 * point.floor);
}

TEST(SurfaceLamp, NothingOfAConvexLampShadesIt) {
    // All of the floor is lit evenly on either side: no ring or spoke of the lamp's own triangles.
    const std::string ball =
        "[[mesh]]\nid = \"ball\"\nshape = \"sphere\"\nradius_m = 0.2\ntranslate_m = [0, 1, 0]\n"
        "material = \"glow\"\n";
    const Frame frame = render(floor_scene(ball, surface_light_text + "shadow = { samples = 256 }\n"));
    for (int y = 0; y < 64; ++y) {
        for (int x = 1; x < 64; ++x) {
            const auto a = static_cast<double>(pixel(frame, x - 1, y).x),
                       b = static_cast<double>(pixel(frame, x, y).x);
            EXPECT_NEAR(b / a, 1, 0.13) << x << ',' << y;
        }
    }
}

TEST(SurfaceLamp, ALampInAClosedBoxLightsNothingOutside) {
    const std::string boxed =
        "[[mesh]]\nid = \"ball\"\nshape = \"sphere\"\nradius_m = 0.1\ntranslate_m = [0, 1, 0]\n"
        "material = \"glow\"\n"
        "[[mesh]]\nid = \"box\"\nshape = \"box\"\nsize_m = [0.3, 0.3, 0.3]\ntranslate_m = [0, 1, 0]\n";
    const Frame frame = render(floor_scene(boxed, surface_light_text + "shadow = { samples = 64 }\n"));
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x)
            EXPECT_EQ(pixel(frame, x, y), (Vec3f{0, 0, 0})) << x << ',' << y;
    }
}

TEST(SurfaceLamp, SeveralLampsOfOneMaterialShareTheirPoints) {
    // Two balls, one of which a wall hides from the left half.
    const std::string balls =
        "[[mesh]]\nid = \"ball\"\nshape = \"sphere\"\nradius_m = 0.1\nmaterial = \"glow\"\n"
        "[[mesh.instance]]\ntranslate_m = [-1, 1, 0]\n[[mesh.instance]]\ntranslate_m = [1, 1, 0]\n";
    const Frame both = render(floor_scene(balls, surface_light_text + "shadow = { samples = 64 }\n"));
    const std::string one =
        "[[mesh]]\nid = \"ball\"\nshape = \"sphere\"\nradius_m = 0.1\nmaterial = \"glow\"\n"
        "translate_m = [-1, 1, 0]\n";
    const Frame left = render(floor_scene(one, surface_light_text + "shadow = { samples = 64 }\n"));
    for (int y = 0; y < 64; y += 5) {
        for (int x = 0; x < 64; x += 3) {
            const auto sum = static_cast<double>(pixel(left, x, y).x + pixel(left, 63 - x, y).x);
            EXPECT_NEAR(static_cast<double>(pixel(both, x, y).x), sum, 0.08 * sum) << x << ',' << y;
        }
    }
}

TEST(SurfaceLamp, WhatIsDarkIsTold) {
    const auto notes = [](const std::string& text) {
        return build_scene(read_scene_text(text, "scene.toml"), {}).notes;
    };
    const auto bare = notes(floor_scene("", surface_light_text));
    ASSERT_EQ(bare.size(), 1u);
    EXPECT_NE(bare[0].find("no surface has the material 'glow'"), std::string::npos) << bare[0];
    const auto black =
        notes(floor_scene("", "[[light]]\nid = \"l\"\ntype = \"surface\"\nmaterial = \"white\"\n"));
    ASSERT_EQ(black.size(), 1u);
    EXPECT_NE(black[0].find("no emission_w_m2_sr"), std::string::npos) << black[0];
    const auto error_of = [](const std::string& text) -> std::string {
        try {
            build_scene(read_scene_text(text, "scene.toml"), {});
        } catch (const InputError& e) {
            return e.what();
        }
        return "none";
    };
    EXPECT_EQ(
        error_of(floor_scene("", "[[light]]\nid = \"l\"\ntype = \"surface\"\nmaterial = \"glowing\"\n")),
        "scene.toml:29:12: the scene has no material 'glowing'");
    EXPECT_NE(error_of(floor_scene("", surface_light_text + "shadow = { method = \"stack\" }\n"))
                  .find("needs a light of one shape"),
              std::string::npos);
    // And is rendered, dark.
    EXPECT_EQ(pixel(render(floor_scene("", surface_light_text)), 9, 9), (Vec3f{0, 0, 0}));
}

}  // namespace
}  // namespace obscura
