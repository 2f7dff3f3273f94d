// Where disparity editing fails beyond its edits: smaller maps, tessellation, warping, what no eye saw, time.
// Prints the tables of stereo/limits.md.

#include <gtest/gtest.h>

#include "stereo/solver/solver.h"
#include "stereo/thesis/warp.h"
#include "tests/pair/limit_cases.h"

namespace obscura {
namespace {

using namespace stereo_limits;

struct Named {
    const char* name;
    std::string text;
};

/// A pole 4 m from the camera, so many pixels wide, and where it is to go.
std::string pole(double width_px, double offset_px) {
    return wall() + anchor("wall", 0) + anchor("pole", offset_px) +
           box("pole", {width_px * 4 / focal_px, 4, 0.02}, {0.1, 0, 1}) + "rotate_deg = [0, 0, 2]\n";
}
std::string rounder_ball() {
    return wall() + ball("ball", 0.6, {-0.7, 0, 0}) + anchor("wall", 0) + roundness("ball", 2) +
           anchor("ball", 4);
}
std::string matched(const std::string& keys) {
    return wall() + ball("ball", 0.6, {-0.7, 0, 0}) + ball("globe", 0.4, {0.9, 0.2, 0.6}) +
           anchor("wall", 0) +
           edit("m", "match", "",
                "source_m = [-0.7, 0, 0.6]\ndestination_m = [0.9, 0.2, 1.0]\noffset_px = 6\n" + keys);
}

// --- maps of lower resolution

TEST(StereoStability, MapsOfLowerResolution) {
    struct Scaled : Named {
        const char* keys;
        double most_rms_px;  // at 1:8
    };
    const Scaled cases[] = {
        {{"rounder, moved ball", rounder_ball()}, "", 0.1},
        {{"pole of 8 px", pole(8, 8)}, "", 0.3},
        {{"pole of 2 px", pole(2, 8)}, "", 0.3},
        {{"pole of 1 px", pole(1, 8)}, "", 0.3},
        {{"pole of 1 px, interfaces edited", pole(1, 8)}, "interfaces = \"edited\"\n", 0.1},
        {{"match, disc of 20 px", matched("radius_px = 20")}, "", 0.2},
        {{"match, globe", matched("")}, "", 0.2},
        {{"match, globe; source held", matched("") + anchor("ball", 0)}, "", 0.6},
    };
    for (const Scaled& s : cases) {
        const std::string keys = std::string(s.keys) + "tolerance_px = 0.005\n";
        const StereoPair exact = pair_of(made(keys, s.text), false);
        std::printf("| %s |", s.name);
        for (const int scale : {2, 4, 8}) {
            const StereoPair pair = pair_of(made(keys + fmt::format("map_scale = {}", scale), s.text), false);
            DifferenceSum off;
            for (std::size_t i = 0; i < pair.optimised.pixels.size(); ++i) {
                if (exact.edited.system.valid.pixels[i] != 0)
                    off.add(static_cast<double>(pair.optimised.pixels[i]) -
                            static_cast<double>(exact.optimised.pixels[i]));
            }
            std::printf(" %.3f, %.1f |", off.result().rms, off.result().max);
            EXPECT_TRUE(scale != 8 || off.result().rms < s.most_rms_px) << s.name;
        }
        std::printf("\n");
    }
}

// --- triangles

struct Bent : Named {
    double least_share, most_px;  // at 0.1
};

void triangles(const Bent& s) {
    std::printf("| %s |", s.name);
    std::int64_t last = 0;
    for (const double tolerance : {1.0, 0.3, 0.1, 0.03}) {
        const StereoPair pair = pair_of(made(fmt::format("tessellation_px = {}", tolerance), s.text));
        const DisparityError& error = pair.realised.error;
        std::printf(" %ld, %.2f %%, %.2f |", pair.reprojection.triangles_out, 100 * error.share(),
                    error.max_px);
        EXPECT_GE(pair.reprojection.triangles_out, last);
        last = pair.reprojection.triangles_out;
        if (tolerance != 0.1) continue;
        EXPECT_GT(error.share(), s.least_share) << s.name;
        EXPECT_LT(error.max_px, s.most_px) << s.name;
    }
    std::printf("\n");
}

TEST(StereoStability, TrianglesAgainstTolerance) {
    triangles({{"rounder, moved ball", rounder_ball()}, 0.999, 0.15});
    triangles({{"one pixel pulled out", matched("") + anchor("ball", 0)}, 0.999, 0.5});
}

TEST(StereoStability, TrianglesAgainstSteepness) {
    triangles({{"pole of 2 px, 2 px forward", pole(2, 2)}, 0.999, 0.2});
    triangles({{"pole of 2 px, 8 px forward", pole(2, 8)}, 0.998, 0.5});
    triangles({{"pole of 2 px, 32 px forward", pole(2, 32)}, 0.99, 1.5});
}

// --- warping, and what the middle view never saw

std::int64_t nothing_in(const EyeMap& map) {
    return std::count(map.triangle.pixels.begin(), map.triangle.pixels.end(), nothing_seen);
}

TEST(StereoStability, WarpingLeavesHoles) {
    std::int64_t last = 0;
    for (const double offset : {0.0, 2.0, 8.0, 32.0, 64.0}) {
        const Case c = made("interfaces = \"edited\"", wall() + ball("ball", 0.5, {0, 0, 0}) +
                                                           anchor("ball", offset) + anchor("wall", 0));
        const StereoPair pair = pair_of(c);
        const Image<Vec3f> any(pair.view.width(), pair.view.height());
        std::int64_t holes = 0;
        for (const double shift : {0.5, -0.5})
            holes += warped(any, pair.view, pair.optimised, {shift, 0.5}, {}).holes;
        const std::int64_t ours = nothing_in(pair.eyes.left_map) + nothing_in(pair.eyes.right_map) +
                                  pair.eyes.left_map.cracks + pair.eyes.right_map.cracks;
        std::printf("| %2.0f | %ld | %.2f %% | %ld |\n", offset, holes,
                    100.0 * static_cast<double>(holes) / (2 * 384 * 216), ours);
        EXPECT_EQ(ours, 0);
        EXPECT_GT(holes, last);
        last = holes;
    }
}

/// The mean change that an object was given in one pair less that in the other, where both show it.
double mean_difference(const StereoPair& a, std::uint32_t in_a, const StereoPair& b, std::uint32_t in_b) {
    const int shift = b.view.margin_px - a.view.margin_px;
    double sum = 0, count = 0;
    for (int y = 0; y < a.view.height(); ++y) {
        for (int x = 0; x < a.view.width(); ++x) {
            const int there = x + shift;
            if (there < 0 || there >= b.view.width()) continue;
            if (a.view.object(x, y) != in_a || b.view.object(there, y) != in_b) continue;
            sum += change_at(a, x, y) - change_at(b, there, y);
            ++count;
        }
    }
    return sum / count;
}

/// Where an eye sees the dome at a place at which the middle view shows something else, against a pair in
/// which nothing is before it.
Difference unseen_error(const Case& c, const StereoPair& pair, const Case& open, const StereoPair& truth) {
    const std::uint32_t dome = c.object("dome"), there = open.object("dome");
    const double moved = mean_difference(pair, dome, truth, there);
    DifferenceSum sum;
    for (const double side : {-0.5, 0.5}) {
        const EyeMap& map = side < 0 ? pair.eyes.left_map : pair.eyes.right_map;
        for (int y = 0; y < map.triangle.height; ++y) {
            for (int x = 0; x < map.triangle.width; ++x) {
                if (seen_object(c.scene, map, x, y) != dome) continue;
                // Its column in the middle view.
                const double column = x + side * static_cast<double>(map.disparity(x, y));
                const auto at = static_cast<int>(std::floor(column));
                const int in = at + pair.view.margin_px, open_in = at + truth.view.margin_px;
                if (std::min(in, open_in) < 0 || in + 1 >= pair.view.width() ||
                    open_in + 1 >= truth.view.width())
                    continue;
                if (pair.view.object(in, y) == dome || pair.view.object(in + 1, y) == dome) continue;
                if (truth.view.object(open_in, y) != there || truth.view.object(open_in + 1, y) != there)
                    continue;
                const double t = column - at, change = (1 - t) * change_at(truth, open_in, y) +
                                                       t * change_at(truth, open_in + 1, y);
                sum.add(static_cast<double>(map.disparity(x, y) - map.original(x, y)) - change - moved);
            }
        }
    }
    return sum.result();
}

TEST(StereoStability, SurfacesThatTheMiddleViewNeverSaw) {
    const std::string dome = wall() + anchor("wall", 0) + ball("dome", 1.6, {0, 0, -2.6}, "stone"),
                      post = box("post", {0.4, 6, 0.1}, {0.1, 0, 1}, "clay");
    const auto run = [&](const char* name, const std::string& edits, double offset, double most_rms_px) {
        const Case c = made("interfaces = \"edited\"", dome + edits + post + anchor("post", offset)),
                   open = made("interfaces = \"edited\"", dome + edits);
        const StereoPair pair = pair_of(c), truth = pair_of(open, false);
        const Difference d = unseen_error(c, pair, open, truth);
        const Range change = change_of(truth, open.object("dome"));
        std::printf("| %s | %.0f | %ld | %.1f to %.1f | %.2f | %.2f |\n", name, offset, d.pixels, change.low,
                    change.high, d.rms, d.max);
        EXPECT_LT(d.rms, most_rms_px);
        EXPECT_GT(d.pixels, 100);
    };
    for (const double offset : {8.0, 32.0, 64.0}) {
        run("8 px forward", anchor("dome", 8), offset, 0.01);
        run("6 times rounder", anchor("dome", 0) + roundness("dome", 6), offset, 1);
    }
}

// --- time

struct Seen {
    MiddleView view;
    DisparityMap optimised;
    Camera camera;
};

/// How much the change of disparity of what both frames show differs.
Difference unsteadiness(const Seen& before, const Seen& now, double* share) {
    const MapProjection from = map_projection(before.camera, before.view),
                        to = map_projection(now.camera, now.view);
    DifferenceSum sum;
    std::int64_t steady = 0;
    for (int y = 0; y < now.view.height(); ++y) {
        for (int x = 0; x < now.view.width(); ++x) {
            const std::uint32_t object = now.view.object(x, y);
            if (object == nothing_seen) continue;
            const Vec3d point =
                to.eye + to.ray(x + 0.5, y + 0.5) * static_cast<double>(now.view.depth_m(x, y));
            const MapPoint place = from.project(to_float(point));
            const double u = place.column() - 0.5, v = place.row() - 0.5;
            if (!from.on_map(place) || u < 0 || v < 0 || u >= before.view.width() - 1 ||
                v >= before.view.height() - 1)
                continue;
            const auto i = static_cast<int>(u), j = static_cast<int>(v);
            double change = 0;
            bool same = true;
            for (int k = 0; k < 4; ++k) {
                const int a = i + (k & 1), b = j + (k >> 1);
                same = same && before.view.object(a, b) == object &&
                       std::fabs(static_cast<double>(before.view.depth_m(a, b)) - place.z) < 0.02 * place.z;
                change += ((k & 1) != 0 ? u - i : 1 - (u - i)) * (k >> 1 != 0 ? v - j : 1 - (v - j)) *
                          static_cast<double>(before.optimised(a, b) - before.view.disparity(a, b));
            }
            if (!same) continue;
            const double d = static_cast<double>(now.optimised(x, y) - now.view.disparity(x, y)) - change;
            steady += std::fabs(d) <= 0.25 ? 1 : 0;
            sum.add(d);
        }
    }
    *share =
        static_cast<double>(steady) / static_cast<double>(std::max<std::int64_t>(sum.result().pixels, 1));
    return sum.result();
}

struct Steadiness {
    double rms = 0, max = 0, share = 1;  ///< of the worst frame
    int iterations = 0;                  ///< of all
};

/// Five frames of a camera that goes `step_m` to the right with each.
Steadiness sequence(const char* name, const std::string& keys, const std::string& text, double step_m,
                    bool warm = true) {
    const Case start = made(keys, text + "[frames]\nrange = \"1-5\"\n");
    StereoCache cache;
    std::optional<Seen> last;
    Steadiness worst;
    for (int frame = 1; frame <= 5; ++frame) {
        Case c = start;
        set_frame(c.scene, c.document, frame);
        c.scene.camera.eye.x += step_m * frame;
        c.scene.camera.look_at.x += step_m * frame;
        c.settings = stereo_settings(c.document, c.scene, frame, FileAccess{});
        StereoPair pair;
        StereoPairOptions options;
        options.pictures = false;
        c.settings.warm_start = warm;
        render_stereo_pair(c.scene, c.settings, options, Exec{}, cache, pair);
        worst.iterations += pair.solution.report.iterations;
        Seen now{pair.view, pair.optimised, c.scene.camera};
        if (last) {
            double share = 0;
            const Difference d = unsteadiness(*last, now, &share);
            worst.rms = std::max(worst.rms, d.rms);
            worst.max = std::max(worst.max, d.max);
            worst.share = std::min(worst.share, share);
            if (pair.temporal) {
                EXPECT_NEAR(pair.temporal->error.max_px, d.max, 1e-3) << "as the pair says";
            }
        }
        last = std::move(now);
    }
    std::printf("| %s%s | %.3f | %.2f | %.2f %% | %d |\n", name, warm ? "" : ", cold", worst.rms, worst.max,
                100 * worst.share, worst.iterations);
    return worst;
}

/// A room with things to edit.
std::string furniture() {
    return wall() + ball("ball", 0.6, {-0.7, 0, 0}) + box("post", {0.1, 4, 0.1}, {0.6, 0, 1}) +
           ball("globe", 0.4, {0.9, 0.2, 0.4}, "stone");
}

TEST(StereoStability, SlowCamera) {
    const std::string edited =
        furniture() + roundness("ball", 2) + anchor("ball", 4) + anchor("wall", -2) + anchor("post", 4);
    EXPECT_LT(sequence("no edits", "", furniture(), 0.02).max, 1e-3);
    EXPECT_LT(sequence("edits, camera still", "", edited, 0).max, 0.05);
    const Steadiness cold = sequence("edits", "", edited, 0.02, false),
                     warm = sequence("edits", "", edited, 0.02);
    EXPECT_LT(warm.rms, 0.1);
    EXPECT_GT(warm.share, 0.98);
    EXPECT_NEAR(warm.rms, cold.rms, 0.005) << "the start leaves no trace";
    EXPECT_LT(warm.iterations, cold.iterations);
    EXPECT_LT(sequence("edits, interfaces edited", "interfaces = \"edited\"", edited, 0.02).rms, 0.05);
    EXPECT_LT(sequence("edits at 1:4", "map_scale = 4", edited, 0.02).rms, 0.12);
}

std::string keyed(const char* id, const char* what, double from, double to) {
    return fmt::format(
        "[[frames.stereo_edit]]\nframe = 1\nid = \"{}\"\n{} = {}\n[[frames.stereo_edit]]\nframe = 5\n"
        "id = \"{}\"\n{} = {}\n",
        id, what, from, id, what, to);
}
/// The largest change from one of five frames to the next.
double fade(const char* name, const std::string& edits) {
    return sequence(name, "interfaces = \"edited\"", furniture() + anchor("wall", 0) + edits, 0).max;
}

TEST(StereoStability, WeightsThatFade) {
    EXPECT_GT(fade("8 px, weight 1 to 0", anchor("ball", 8) + keyed("ball_at", "weight", 1, 0)), 6);
    EXPECT_GT(
        fade("-6 px, into the wall, weight 0 to 1", anchor("globe", -6) + keyed("globe_at", "weight", 0, 1)),
        5);
}

TEST(StereoStability, OffsetsThatFade) {
    // In even steps 8 px in four frames are 2 px each.
    EXPECT_LT(fade("8 to 0 px", anchor("ball", 8) + keyed("ball_at", "offset_px", 8, 0)), 2.2);
    EXPECT_LT(fade("0 to -6 px, into the wall", anchor("globe", -6) + keyed("globe_at", "offset_px", 0, -6)),
              2.5);
}

}  // namespace
}  // namespace obscura
