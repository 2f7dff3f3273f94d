// Where edits of disparity fail: contradictions, thin things, leaves, the borders of the picture. Prints the
// tables of stereo/limits.md.

#include <gtest/gtest.h>

#include "tests/pair/limit_cases.h"

namespace obscura {
namespace {

using namespace stereo_limits;

// --- contradictory edits

/// Two boxes side by side, faces in one plane 4.75 m away, 85 pixels wide each, before a wall.
std::string two_boxes() {
    return wall() + box("left", {1, 1, 0.5}, {-0.5, 0, 0}) + box("right", {1, 1, 0.5}, {0.5, 0, 0}, "clay");
}

TEST(StereoStability, OneObjectIsPulledTwoWays) {
    for (const double offset : {1.0, 4.0, 16.0, 64.0}) {
        const std::string pull =
            edit("nearer", "anchor", "left", fmt::format("offset_px = {}", offset)) +
            edit("farther", "anchor", "left", fmt::format("offset_px = {}\nweight = 3", -offset));
        const Case c = made("", two_boxes() + pull);
        const StereoPair pair = pair_of(c, false);
        const Range left = change_of(pair, c.object("left"));
        const SolveReport& report = pair.solution.report;
        std::printf("| %2.0f | %6.2f | %s |\n", offset, left.mean, named(report).c_str());
        EXPECT_TRUE(report.converged);
        EXPECT_NEAR(left.mean, -0.5 * offset, 0.01 * offset) << "the mean by weight";
        for (const char* name : {"nearer", "farther"}) {
            ASSERT_NE(entry(report, name), nullptr);
            EXPECT_EQ(entry(report, name)->against, std::string(name) == "nearer" ? "farther" : "nearer");
        }
    }
}

/// Touching boxes, one forward, the other back.
void pull_apart(const std::string& keys, const char* name, double offset, double least_border,
                std::int64_t most_folds) {
    const Case c = made(keys, two_boxes() + anchor("left", offset) + anchor("right", -offset));
    const StereoPair pair = pair_of(c);
    const Range left = change_of(pair, c.object("left"));
    const Conflicts after = left_over(c, pair);
    std::printf("| %s | %2.0f | %.1f | %.1f | %.2f | %ld | %ld | %.2f %% |\n", name, offset, left.high,
                left.low, steepest(pair, c.object("left")), after.count(ConflictKind::depth_inversion),
                after.count(ConflictKind::fold), 100 * pair.realised.error.share());
    EXPECT_TRUE(pair.solution.report.converged);
    EXPECT_NEAR(left.high, offset, 0.01 * offset);
    EXPECT_GT(left.low, least_border * offset);
    EXPECT_LE(after.count(ConflictKind::fold), most_folds);
    EXPECT_GT(pair.realised.error.share(), 0.99);
}

TEST(StereoStability, TouchingObjectsArePulledApart) {
    for (const double offset : {4.0, 16.0, 64.0}) {
        const bool far = offset > 8;
        pull_apart("", "original", offset, 0.27, far ? 2000 : 0);
        pull_apart("anchor_weight = 100", "original, c2 = 100", offset, 0.95, far ? 1000 : 10);
        pull_apart("interfaces = \"edited\"", "edited", offset, 0.89, far ? 200 : 0);
        pull_apart("interfaces = \"edited\"\nreset_inversions = false", "edited, nothing reset", offset, 0.99,
                   0);
    }
}

/// How often, per row that shows both, the left eye's picture goes from one box to the other; of the worst
/// row. Once is right.
int worst_mixing(double behind_m) {
    const Case c = made("interfaces = \"edited\"", wall() + box("left", {1, 1, 0.5}, {-0.5, 0, 0}) +
                                                       box("right", {1, 1, 0.5}, {0.5, 0, -behind_m}) +
                                                       anchor("left", 24) + anchor("right", -24));
    const StereoPair pair = pair_of(c);
    int worst = 0;
    for (int y = 0; y < 216; ++y) {
        int turns = 0;
        for (int x = 1; x < 384; ++x) {
            const std::uint32_t a = seen_object(c.scene, pair.eyes.left_map, x - 1, y),
                                b = seen_object(c.scene, pair.eyes.left_map, x, y);
            turns += a != b && a != c.object("wall") && b != c.object("wall") ? 1 : 0;
        }
        worst = std::max(worst, turns);
    }
    std::printf("| %g | %d |\n", behind_m, worst);
    return worst;
}

TEST(StereoStability, FacesOfOneDepthMixWhereTheyOverlap) {
    EXPECT_GT(worst_mixing(0), 2);
    EXPECT_EQ(worst_mixing(0.001), 1);
    EXPECT_EQ(worst_mixing(0.01), 1);
}

TEST(StereoStability, ABallIsPushedThroughAWall) {
    const auto push = [](const char* keys, const char* name, double offset) {
        const Case c =
            made(keys, wall() + ball("ball", 0.5, {0, 0, 0}) + anchor("ball", offset) + anchor("wall", 0));
        const StereoPair pair = pair_of(c, false);
        const Conflicts after = left_over(c, pair);
        const std::int64_t found = before_solve(pair, ConflictKind::depth_inversion),
                           left = after.count(ConflictKind::depth_inversion);
        std::printf("| %s | %3.0f | %.2f | %.2f | %.2f | %ld | %ld | %.1f | %ld |\n", name, offset,
                    change_of(pair, c.object("ball")).mean, change_of(pair, c.object("wall")).low,
                    steepest(pair, c.object("ball")), found, left, after.worst(ConflictKind::depth_inversion),
                    after.count(ConflictKind::fold));
        return std::pair{found, left};
    };
    const char* const as_edited = "interfaces = \"edited\"\nreset_inversions = false";
    for (const double offset : {-2.0, -4.0, -8.0, -16.0}) {
        const auto [found, left] = push("", "original", offset);
        EXPECT_EQ(found > 0, offset < -3) << "the wall is 3 pixels behind the ball";
        EXPECT_EQ(left > 0, offset < -10) << "stretching holds for a while";
    }
    for (const double offset : {-4.0, -16.0}) {
        const auto [found, left] = push(as_edited, "edited, nothing reset", offset);
        EXPECT_EQ(found, left) << "what was asked for";
    }
}

TEST(StereoStability, MatchesPullAgainstAnchors) {
    // The globe is to come 6 px nearer than a ball that stands 0.4 m before it.
    const std::string balls = wall() + ball("ball", 0.6, {-0.7, 0, 0}) + ball("globe", 0.4, {0.9, 0.2, -0.2});
    const std::string match = "source_m = [-0.7, 0, 0.6]\ndestination_m = [0.9, 0.2, 0.2]\noffset_px = 6\n";
    const auto run = [&](const char* name, const std::string& edits, const std::string& keys) {
        const Case c = made("", balls + edits + edit("m", "match", "", match + keys));
        const StereoPair pair = pair_of(c, false);
        const MatchingSet& set = pair.edited.system.sets.at(0);
        double wanted = 0, got = 0;
        for (const MatchedPixel& p : set.members) {
            wanted += static_cast<double>(p.target + pair.view.disparity(set.source_x, set.source_y) -
                                          pair.view.disparity(p.x, p.y));
            got += change_at(pair, p.x, p.y);
        }
        const auto members = static_cast<double>(set.members.size());
        std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %s |\n", name, members, wanted / members,
                    got / members, change_at(pair, set.source_x, set.source_y),
                    named(pair.solution.report).c_str());
        return got / wanted;
    };
    const std::string wall_and_ball = anchor("wall", 0) + anchor("ball", 0);
    EXPECT_GT(run("nothing held", "", ""), 0.5);
    EXPECT_GT(run("wall held", anchor("wall", 0), ""), 0.5);
    EXPECT_GT(run("wall and ball held", wall_and_ball, ""), 0.9);
    EXPECT_LT(run("all held", wall_and_ball + anchor("globe", 0), ""), 0.5);
    EXPECT_GT(run("wall and ball held, disc of 10 px", wall_and_ball, "radius_px = 10"), 0.9);
}

TEST(StereoStability, AnAnchorsWeightIsNotItsShare) {
    double last = 1;
    for (const double weight : {1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001}) {
        const std::string balls = wall() + ball("ball", 0.6, {-0.7, 0, 0}) + anchor("wall", 0);
        const auto share = [&](const char* keys) {
            const Case c = made(keys, balls + anchor("ball", 8, weight));
            return change_of(pair_of(c, false), c.object("ball")).mean / 8;
        };
        const double original = share(""), edited = share("interfaces = \"edited\"");
        std::printf("| %.3f | %.3f | %.3f |\n", weight, original, edited);
        EXPECT_LE(original, last);
        last = original;
    }
}

// --- thin geometry

/// Poles 4 m from the camera, so many pixels wide, up and down out of the picture, slightly aslant.
constexpr double pole_px[] = {0.5, 1, 2, 4};
std::string poles(double offset) {
    std::string text = wall() + anchor("wall", 0);
    for (int i = 0; i < 4; ++i) {
        const std::string name = fmt::format("pole{}", i);
        text += anchor(name, offset) +
                box(name, {pole_px[i] * 4 / focal_px, 4, 0.02}, {-0.9 + 0.6 * i, 0, 1}) +
                "rotate_deg = [0, 0, 2]\n";
    }
    return text;
}

void move_poles(const char* name, const std::string& keys, double offset, double least_share) {
    const Case c = made(keys, poles(offset));
    const StereoPair pair = pair_of(c);
    std::string reached, widths;
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t pole = c.object(fmt::format("pole{}", i));
        reached += fmt::format("{:.2f} · ", change_of(pair, pole).mean / offset);
        widths += fmt::format("{:.1f}, {:.1f} · ", width_in(c.scene, pair.eyes.left_map, pole),
                              width_in(c.scene, pair.eyes.right_map, pole));
    }
    std::printf("| %s | %2.0f | %s| %s| %.1f | %.2f | %ld |\n", name, offset, reached.c_str(), widths.c_str(),
                change_of(pair, c.object("wall")).high, 100 * pair.realised.error.share(),
                pair.reprojection.triangles_out);
    EXPECT_GT(pair.realised.error.share(), least_share);
    EXPECT_EQ(pair.eyes.left_map.cracks + pair.eyes.right_map.cracks, 0);
}

TEST(StereoStability, PolesAreMovedFar) {
    for (const double offset : {2.0, 8.0, 32.0}) {
        move_poles("original", "", offset, offset < 10 ? 0.99 : 0.97);
        move_poles("original, c2 = 100", "anchor_weight = 100", offset, 0.99);
        move_poles("edited", "interfaces = \"edited\"", offset, 0.9999);
    }
}

// --- foliage

/// Parts of the map that hang together, of neighbours with values.
std::int64_t islands(const Image<std::uint8_t>& valid) {
    Image<std::uint8_t> left = valid;
    std::int64_t count = 0;
    std::vector<std::pair<int, int>> todo;
    const auto visit = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= left.width || y >= left.height || left(x, y) == 0) return;
        left(x, y) = 0;
        todo.emplace_back(x, y);
    };
    for (int y = 0; y < left.height; ++y) {
        for (int x = 0; x < left.width; ++x) {
            if (left(x, y) == 0) continue;
            ++count;
            visit(x, y);
            while (!todo.empty()) {
                const auto [i, j] = todo.back();
                todo.pop_back();
                visit(i - 1, j);
                visit(i + 1, j);
                visit(i, j - 1);
                visit(i, j + 1);
            }
        }
    }
    return count;
}

/// A crown of leaves, forward or rounder, before a wall that is held or before nothing.
void move_leaves(bool before_wall, int leaves, const std::string& edits, const char* what,
                 double most_off_px) {
    std::string text = mesh("tree",
                            fmt::format("tree\"\nheight_m = 3\ncrown_radius_m = 1.2\ntrunk_m = 0.8\n"
                                        "leaves = {}\nleaf_m = 0.12\n",
                                        leaves),
                            {0, -1.6, 0}, "") +
                       edits;
    if (before_wall) text += wall() + anchor("wall", 0);
    const Case c = made("", text);
    const StereoPair pair = pair_of(c);
    DifferenceSum off;
    for (int y = 0; y < pair.view.height(); ++y) {
        for (int x = 0; x < pair.view.width(); ++x) {
            if (pair.view.object(x, y) == c.object("tree"))
                off.add(static_cast<double>(pair.optimised(x, y) - pair.edited.system.start(x, y)));
        }
    }
    const std::int64_t cracks = pair.eyes.left_map.cracks + pair.eyes.right_map.cracks;
    std::printf("| %s | %d | %s | %ld | %d | %.2f | %.1f | %.2f | %.2f | %ld | %ld |\n",
                before_wall ? "wall" : "sky", leaves, what, islands(pair.edited.system.valid),
                pair.solution.report.iterations, off.result().rms, off.result().max,
                100 * pair.realised.error.share(), 100 * pair.left_error.share(),
                pair.reprojection.triangles_out, cracks);
    EXPECT_TRUE(pair.solution.report.converged);
    EXPECT_LT(off.result().rms, most_off_px);
    EXPECT_GT(pair.realised.error.share(), 0.99);
    EXPECT_GT(pair.left_error.share(), 0.98);
    EXPECT_LE(cracks, 4);
    // Islands before the sky, one part before a wall.
    EXPECT_EQ(islands(pair.edited.system.valid) == 1, before_wall);
}

TEST(StereoStability, LeavesBeforeTheSky) {
    move_leaves(false, 300, "", "unedited", 0.001);
    for (const int leaves : {300, 3000}) {
        move_leaves(false, leaves, anchor("tree", 6), "6 px forward", 0.001);
        move_leaves(false, leaves, roundness("tree", 3), "3 times rounder", 1.2);
    }
    move_leaves(false, 3000, roundness("tree", 3) + anchor("tree", 0), "the same, held", 0.4);
}

TEST(StereoStability, LeavesBeforeAWall) {
    for (const int leaves : {300, 3000}) {
        move_leaves(true, leaves, anchor("tree", 6), "6 px forward", 2.5);
        move_leaves(true, leaves, roundness("tree", 3), "3 times rounder", 1.1);
    }
    move_leaves(true, 3000, anchor("tree", 6, 100), "6 px forward, weight 100", 0.3);
}

// --- the borders of the picture

TEST(StereoStability, ObjectsCutByTheBorder) {
    // A post 3 m away that the left border cuts in the middle, 5.6 px before the screen, 4 px further
    // forward.
    const auto cut = [](const char* keys, const char* name, const char* margin) {
        const Case c = made(
            fmt::format("margin_px = {}\n{}", margin, keys),
            wall() + box("post", {0.4, 1.2, 0.1}, {-1.43, 0, 2}) + anchor("post", 4) + anchor("wall", 0));
        const StereoPair pair = pair_of(c);
        const std::uint32_t post = c.object("post");
        const Range r = change_of(pair, post);
        const Conflicts after = left_over(c, pair);
        double violation = after.worst(ConflictKind::window_violation);
        std::printf("| %s | %s | %.1f | %.1f to %.1f | %.1f, %.1f | %.0f, %.0f | %.2f, %.2f |\n", name,
                    margin, violation, r.low, r.high,
                    static_cast<double>(pair.eyes.left_map.disparity(0, 108)),
                    static_cast<double>(pair.eyes.right_map.disparity(0, 108)),
                    width_in(c.scene, pair.eyes.left_map, post), width_in(c.scene, pair.eyes.right_map, post),
                    100 * pair.left_error.share(), 100 * pair.right_error.share());
        EXPECT_GT(pair.left_error.share(), 0.99);
        EXPECT_GT(pair.right_error.share(), 0.99);
        return violation;
    };
    const std::string all = "window_inherited = true\nwindow_weight = 100";
    for (const char* margin : {"0", "\"auto\""}) {
        const double off = cut("window_weight = 0", "off", margin), on = cut("", "on", margin),
                     inherited = cut("window_inherited = true", "on, inherited too", margin),
                     heavy = cut(all.c_str(), "the same, weight 100", margin);
        EXPECT_LT(on, off - 3);
        EXPECT_GT(on, 4) << "what was there before stays";
        EXPECT_LT(inherited, 2);
        EXPECT_LT(heavy, 0.2);
    }
}

TEST(StereoStability, PicturesWithoutMargins) {
    // What the eyes see beyond the middle view is guessed by the triangles' own surfaces.
    const auto run = [](const char* name, const std::string& edits, double most_px) {
        const std::string text =
            wall() + ball("ball", 0.5, {-1.4, 0, 0}) + ball("other", 0.5, {1.4, 0.2, 1}) + edits;
        const StereoPair narrow = pair_of(made("window_weight = 0\nmargin_px = 0", text)),
                         wide = pair_of(made("window_weight = 0", text));
        DifferenceSum sum;
        std::int64_t off = 0;
        const auto compare = [&](const EyeMap& a, const EyeMap& b) {
            for (std::size_t i = 0; i < a.disparity.pixels.size(); ++i) {
                const double d = static_cast<double>(a.disparity.pixels[i] - b.disparity.pixels[i]);
                sum.add(d);
                off += std::fabs(d) > 0.25 ? 1 : 0;
            }
        };
        compare(narrow.eyes.left_map, wide.eyes.left_map);
        compare(narrow.eyes.right_map, wide.eyes.right_map);
        std::printf("| %s | %d | %.3f | %.2f | %ld |\n", name, wide.view.margin_px, sum.result().rms,
                    sum.result().max, off);
        EXPECT_LT(sum.result().rms, most_px);
    };
    run("none", "", 0.001);
    run("forward by 8", anchor("ball", 8) + anchor("other", 8) + anchor("wall", 0), 1);
    run("rounder", roundness("ball", 4) + roundness("other", 4) + anchor("wall", 0), 1);
}

}  // namespace
}  // namespace obscura
