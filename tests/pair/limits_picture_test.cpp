// The picture of stereo/limits.md; OBSCURA_PICTURES=FOLDER writes it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "app/report/pair_pictures.h"
#include "core/color.h"
#include "core/file_output.h"
#include "core/image_io.h"
#include "lessons/drawing/figure.h"
#include "stereo/disparity_colour.h"
#include "stereo/thesis/warp.h"
#include "tests/frame/scenes.h"
#include "tests/pair/limit_cases.h"

namespace obscura {
namespace {

using namespace stereo_limits;
constexpr int width = 384, height = 216;

struct Panels {
    Figure figure{1240, 1274};
    int count = 0;
    void add(const Image<Rgb8>& picture, const std::string& name, const std::string& what) {
        const int x = 24 + count % 3 * 404, y = 72 + count / 3 * 298;
        ++count;
        figure.image(x, y, picture, 1);
        figure.text({x + 0.0, y + height + 20.0}, name, lettering::bold);
        figure.text({x + 0.0, y + height + 40.0}, what);
    }
};

/// With squares on walls and stones, so that stretching shows, and sky where nothing is.
Case squared(const std::string& keys, const std::string& text) {
    Case c = made(keys, text +
                            "[sky]\nzenith_w_m2_sr = [0.3, 0.5, 0.9]\nhorizon_w_m2_sr = [0.6, 0.7, 0.85]\n"
                            "ground_w_m2_sr = [0.3, 0.3, 0.3]\nambient = 0.6\n");
    c.scene.render.samples = 4;
    Texture squares = frame_scenes::checkerboard(64, 8);
    for (Image<Vec3f>& level : squares.levels) {
        for (Vec3f& texel : level.pixels)
            texel = texel * 0.5f + Vec3f{0.5f, 0.5f, 0.5f};
    }
    c.scene.textures.push_back(squares);
    for (Material& material : c.scene.materials) {
        if (material.name == "plaster" || material.name == "stone" || material.name == "clay")
            material.texture = static_cast<int>(c.scene.textures.size()) - 1;
    }
    return c;
}

Image<Rgb8> codes(const Image<Vec3f>& light) {
    Image<Rgb8> out(light.width, light.height);
    const CodeTable& srgb = linear_to_srgb8_table();
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = {srgb(light.pixels[i].x), srgb(light.pixels[i].y), srgb(light.pixels[i].z)};
    return out;
}

Image<Rgb8> left_eye(const Case& c, const StereoPair& pair) {
    return codes(display_light(pair.eyes.left.radiance.view(), c.scene.render, Exec{}));
}

/// Change of disparity in the picture without margins; no change is a light grey, what shows nothing dark.
Image<Rgb8> change_picture(const StereoPair& pair, double range_px) {
    DisparityColours colours;
    colours.far_px = -range_px;
    colours.near_px = range_px;
    DisparityMap change(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int in = x + pair.view.margin_px;
            change(x, y) = pair.view.object(in, y) == nothing_seen
                               ? std::numeric_limits<float>::quiet_NaN()
                               : pair.optimised(in, y) - pair.view.disparity(in, y);
        }
    }
    return disparity_picture(change, colours, Exec{});
}

/// A part of a picture, enlarged to the size of a panel.
Image<Rgb8> enlarged(const Image<Rgb8>& picture, int x0, int y0, int times) {
    Image<Rgb8> out(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            out(x, y) = picture(x0 + x / times, y0 + y / times);
    }
    return out;
}

void add_boxes(Panels& panels) {
    const std::string boxes = wall() + box("left", {1, 1, 0.5}, {-0.5, 0, 0}) +
                              box("right", {1, 1, 0.5}, {0.5, 0, 0}, "clay") + anchor("left", 24) +
                              anchor("right", -24);
    const Case kept = squared("", boxes), parted = squared("interfaces = \"edited\"", boxes);
    const StereoPair stretched = pair_of(kept), torn = pair_of(parted);
    panels.add(change_picture(stretched, 24), "touching boxes, +24 and -24 px",
               "change: borders hold on to each other");
    panels.add(left_eye(kept, stretched), "the same, left eye",
               "squares stretch; two faces of one depth mix");
    panels.add(left_eye(parted, torn), "interfaces = \"edited\", left eye",
               "squares stay square; the faces mix");
    EXPECT_GT(steepest(stretched, kept.object("left")), 20 * steepest(torn, parted.object("left")));
}

void add_poles(Panels& panels) {
    std::string text = wall() + anchor("wall", 0);
    for (int i = 0; i < 4; ++i) {
        const std::string name = fmt::format("pole{}", i);
        text += anchor(name, 32) +
                box(name, {(i + 1) * 4 / focal_px, 4, 0.02}, {-0.9 + 0.6 * i, 0, 1}, "clay") +
                "rotate_deg = [0, 0, 2]\n";
    }
    const Case c = squared("", text);
    const StereoPair pair = pair_of(c);
    panels.add(change_picture(pair, 32), "poles of 1 to 4 px, 32 px forward",
               "change: a part of it, and the wall follows");
    panels.add(left_eye(c, pair), "the same, left eye", "the wall bulges beside every pole");
}

void add_push(Panels& panels) {
    const Case c =
        squared("", wall() + ball("ball", 0.5, {0, 0, 0}) + anchor("ball", -16) + anchor("wall", 0));
    const StereoPair pair = pair_of(c);
    panels.add(change_picture(pair, 16), "a ball pushed 16 px into the wall",
               "change: the wall is dragged along");
}

void add_match(Panels& panels) {
    const Case c =
        squared("", wall() + ball("ball", 0.6, {-0.7, 0, 0}) + ball("globe", 0.4, {0.9, 0.2, -0.2}) +
                        anchor("wall", 0) + anchor("ball", 0) + anchor("globe", 0) +
                        edit("m", "match", "",
                             "source_m = [-0.7, 0, 0.6]\ndestination_m = [0.9, 0.2, 0.2]\noffset_px = 6"));
    const StereoPair pair = pair_of(c, false);
    panels.add(change_picture(pair, 6.8), "matched, and both anchored",
               "change: a third of the way, the ball gives");
}

void add_leaves(Panels& panels) {
    const std::string tree = mesh("tree",
                                  "tree\"\nheight_m = 3\ncrown_radius_m = 1.2\ntrunk_m = 0.8\nleaves = "
                                  "300\nleaf_m = 0.12\n",
                                  {0, -1.6, 0}, "");
    const Case c = squared("", tree + roundness("tree", 3));
    const StereoPair pair = pair_of(c, false);
    panels.add(change_picture(pair, 4), "leaves before the sky, 3 times rounder",
               "change: islands stay where they were");
}

void add_border(Panels& panels) {
    const Case c =
        squared("window_inherited = true\nwindow_weight = 100",
                wall() + box("post", {0.4, 1.2, 0.1}, {-1.43, 0, 2}) + anchor("post", 4) + anchor("wall", 0));
    const StereoPair pair = pair_of(c);
    panels.add(change_picture(pair, 5), "a post that the left border cuts",
               "change: held at the border, forward beside it");
}

void add_small_map(Panels& panels) {
    const std::string text = wall() + anchor("wall", 0) + anchor("pole", 8) +
                             box("pole", {8 * 4 / focal_px, 4, 0.02}, {0.1, 0, 1}) +
                             "rotate_deg = [0, 0, 2]\n";
    const StereoPair full = pair_of(squared("", text), false);
    StereoPair small = pair_of(squared("map_scale = 8", text), false);
    // What is shown as change is the difference.
    small.view.disparity = full.optimised;
    panels.add(enlarged(change_picture(small, 3), 156, 60, 4), "a pole of 8 px solved at 1:8, 4 x",
               "error, -3 to 3 px: borders, in coarse steps");
}

void add_warped(Panels& panels) {
    Case c = squared("interfaces = \"edited\"",
                     wall() + ball("ball", 0.5, {0, 0, 0}) + anchor("ball", 48) + anchor("wall", 0));
    c.settings.middle_picture = true;
    const StereoPair pair = pair_of(c);
    const Image<Vec3f> middle = display_light(pair.eyes.middle->radiance.view(), c.scene.render, Exec{});
    const WarpedPicture warp = warped(middle, pair.view, pair.optimised, {0.5, 0.5}, {});
    Image<Rgb8> marked = codes(warp.picture);
    for (std::size_t i = 0; i < marked.pixels.size(); ++i) {
        if (warp.hole.pixels[i] != 0) marked.pixels[i] = mix(marked.pixels[i], ink::purple, 0.7);
    }
    panels.add(marked, "a ball 48 px forward: image warped", "left eye; purple: nobody saw it, invented");
    panels.add(left_eye(c, pair), "the same, rendered", "left eye; no hole");
    EXPECT_GT(warp.holes, 1000);
    EXPECT_EQ(std::count(pair.eyes.left_map.triangle.pixels.begin(), pair.eyes.left_map.triangle.pixels.end(),
                         nothing_seen),
              0);
}

TEST(StereoStability, PictureOfLimits) {
    Panels panels;
    panels.figure.text({24, 30}, "Where edits of disparity fail", lettering::head);
    panels.figure.text(
        {24, 52}, "change = disparity after less before: red nearer, blue farther, light grey unchanged");
    add_boxes(panels);
    add_poles(panels);
    add_push(panels);
    add_match(panels);
    add_leaves(panels);
    add_border(panels);
    add_small_map(panels);
    add_warped(panels);

    if (const char* folder = std::getenv("OBSCURA_PICTURES"); folder != nullptr) {
        const std::filesystem::path file = std::filesystem::path(folder) / "limits.png";
        write_file_atomically(file, encode_png(panels.figure.picture.view()), Existing::replace);
        std::cout << "wrote " << file << "\n";
    }
}

}  // namespace
}  // namespace obscura
