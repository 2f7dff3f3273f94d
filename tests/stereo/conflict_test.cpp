// Conflicts found on maps painted by hand, so that every count is plain, and what is done about them.
#include "stereo/conflict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "stereo/conflict_overlay.h"
#include "stereo/edit.h"
#include "tests/stereo/ray_scene.h"
#include "tests/stereo/slabs.h"
#include "tests/stereo/small_solver.h"

namespace obscura {
namespace {

const std::vector<std::string> names = {"wall", "lion"};

/// A lion, 8 x 4 pixels at disparity 2, before a wall at -3; far from the sides.
MiddleView lion_and_wall() {
    MiddleView view = empty_view(64, 8);
    paint(view, {0, 0, 64, 8, 0, 0, -3});
    paint(view, {28, 2, 36, 6, 1, 0, 2});
    return view;
}

StereoEdit anchor(std::uint32_t object, double offset_px, double weight = 1) {
    return {"anchor", weight, AnchorEdit{{{object}, {}}, offset_px}};
}

EditParams edited_interfaces() {
    EditParams p;
    p.interfaces = InterfaceGradients::edited;
    return p;
}

TEST(StereoConflict, InversionsAreCountedPerPairNamedAndReset) {
    const MiddleView view = lion_and_wall();
    const EditedSystem pushed = edited_system(view, {anchor(1, -9)}, edited_interfaces(), names);
    ASSERT_EQ(pushed.conflicts.size(), 1u);
    const Conflict& c = pushed.conflicts[0];
    EXPECT_EQ(c.kind, ConflictKind::depth_inversion);
    EXPECT_EQ(c.what, "lion in front of wall");
    EXPECT_EQ(c.object, 1u);
    EXPECT_EQ(c.behind, 0u);
    EXPECT_EQ(c.pixels, 2 * 8 + 2 * 4);  // pairs of neighbours along its outline
    EXPECT_EQ(c.inherited, 0);
    EXPECT_NEAR(c.worst_px, 4, 1e-6);

    // Both sides of the outline are marked: of the lion all but its inner 6 x 2, of the wall a ring without
    // corners.
    const auto marked = std::count(pushed.conflict_pixels.pixels.begin(), pushed.conflict_pixels.pixels.end(),
                                   conflict_bit(ConflictKind::depth_inversion));
    EXPECT_EQ(marked, (32 - 12) + 24);
    EXPECT_FLOAT_EQ(pushed.system.gradient_x(27, 3), 5);
    EXPECT_FLOAT_EQ(pushed.system.gradient_y(30, 5), -5);

    EditParams leave = edited_interfaces();
    leave.reset_inversions = false;
    EXPECT_FLOAT_EQ(edited_system(view, {anchor(1, -9)}, leave, names).system.gradient_x(27, 3), -4);

    // Kept in order, there is nothing to reset or to tell.
    const EditedSystem nearer = edited_system(view, {anchor(1, -4)}, edited_interfaces(), names);
    EXPECT_TRUE(nearer.conflicts.empty());
    EXPECT_FLOAT_EQ(nearer.system.gradient_x(27, 3), 1);
    // Kept interfaces have no inverted target, but what the edits would do is still told.
    const EditedSystem kept = edited_system(view, {anchor(1, -9)}, {}, names);
    EXPECT_EQ(kept.conflicts.size(), 1u);
    EXPECT_FLOAT_EQ(kept.system.gradient_x(27, 3), 5);
}

TEST(StereoConflict, StepsTooSmallToMeanAnythingAreNoInversions) {
    EXPECT_TRUE(inverted(1, -0.1, 0.05));
    EXPECT_TRUE(inverted(-0.01, 3, 0.05));
    EXPECT_FALSE(inverted(1, -0.04, 0.05));
    EXPECT_FALSE(inverted(-1e-5, 3, 0.05));
    EXPECT_FALSE(inverted(1, 2, 0.05));
    EXPECT_FALSE(inverted(0, 2, 0.05));
}

/// A rope across the whole picture, 20 wide with margins of 6, at disparity 4 on its first three rows.
MiddleView rope(float disparity) {
    MiddleView view = empty_view(20, 4, 6);
    paint(view, {0, 0, 32, 4, 0, 0, -3});
    paint(view, {0, 0, 32, 3, 1, 0, disparity});
    return view;
}

TEST(StereoConflict, TheWindowLeavesAsMuchDisparityAsThereIsToItsSide) {
    const MiddleView view = rope(-1);
    EXPECT_EQ(border_distance(view, 6), 0.5);
    EXPECT_EQ(border_distance(view, 5), 0.5);
    EXPECT_EQ(border_distance(view, 25), 0.5);
    EXPECT_EQ(border_distance(view, 16), 9.5);
    EXPECT_EQ(border_distance(view, 0), 5.5);

    const EditedSystem edited = edited_system(view, {anchor(1, 5)}, {}, names);  // to disparity 4
    ASSERT_EQ(edited.conflicts.size(), 2u);
    for (const Conflict& c : edited.conflicts) {
        EXPECT_EQ(c.kind, ConflictKind::window_violation);
        EXPECT_EQ(c.pixels, 3 * 8);  // four columns at 0.5 to 3.5 on either side of each border
        EXPECT_EQ(c.inherited, 0);
        EXPECT_NEAR(c.worst_px, 3.5, 1e-6);
    }
    EXPECT_EQ(edited.conflicts[0].what, "lion at the left");
    EXPECT_EQ(edited.conflicts[1].what, "lion at the right");

    const DisparitySystem& s = edited.system;
    EXPECT_FLOAT_EQ(s.anchor_value(7, 1), 1.5f);
    EXPECT_FLOAT_EQ(s.anchor_weight(7, 1), 2);  // the artist's and the window's
    EXPECT_FLOAT_EQ(s.start(7, 1), 1.5f);
    EXPECT_FLOAT_EQ(s.anchor_value(4, 1), 1.5f);
    EXPECT_FLOAT_EQ(s.anchor_value(16, 1), 4);
    EXPECT_FLOAT_EQ(s.anchor_weight(16, 1), 1);
    EXPECT_EQ(s.anchor_weight(7, 3), 0);  // the wall is behind the screen

    EditParams off;
    off.window_weight = 0;
    const EditedSystem left = edited_system(view, {anchor(1, 5)}, off, names);
    EXPECT_EQ(left.conflicts.size(), 2u);
    EXPECT_FLOAT_EQ(left.system.anchor_value(7, 1), 4);
}

TEST(StereoConflict, WhatTheUneditedPictureViolatesIsToldAndLeft) {
    const MiddleView view = rope(4);
    const EditedSystem none = edited_system(view, {}, {}, names);
    ASSERT_EQ(none.conflicts.size(), 2u);
    EXPECT_EQ(none.conflicts[0].inherited, none.conflicts[0].pixels);
    EXPECT_EQ(none.system.anchor_weight(7, 1), 0);

    // Brought nearer, it is held where it was; or at the limit when asked.
    const EditedSystem nearer = edited_system(view, {anchor(1, 1)}, {}, names);
    EXPECT_EQ(nearer.conflicts[0].inherited, 0);
    EXPECT_FLOAT_EQ(nearer.system.anchor_value(7, 1), 4);
    EditParams all;
    all.window_inherited = true;
    EXPECT_FLOAT_EQ(edited_system(view, {}, all, names).system.anchor_value(7, 1), 1.5f);
}

TEST(StereoConflict, TheComfortZoneClampsWhateverIsOutside) {
    const MiddleView view = lion_and_wall();
    EditParams params;
    params.comfort = {5, -2.5};
    params.comfort_weight = 3;
    const EditedSystem edited = edited_system(view, {anchor(1, 10, 0.5)}, params, names);
    ASSERT_EQ(edited.conflicts.size(), 2u);
    EXPECT_EQ(edited.conflicts[0].what, "wall too far");
    EXPECT_EQ(edited.conflicts[0].pixels, 64 * 8 - 32);
    EXPECT_EQ(edited.conflicts[0].inherited, 64 * 8 - 32);
    EXPECT_NEAR(edited.conflicts[0].worst_px, 0.5, 1e-6);
    EXPECT_EQ(edited.conflicts[1].what, "lion too near");
    EXPECT_NEAR(edited.conflicts[1].worst_px, 2, 1e-6);  // a weight of 1/2 lifts half way

    const DisparitySystem& s = edited.system;
    EXPECT_FLOAT_EQ(s.anchor_value(30, 3), 5);
    EXPECT_FLOAT_EQ(s.anchor_weight(30, 3), 3.5f);
    EXPECT_FLOAT_EQ(s.start(30, 3), 5);
    EXPECT_FLOAT_EQ(s.anchor_value(2, 2), -2.5f);
    EXPECT_FLOAT_EQ(s.anchor_weight(2, 2), 3);

    params.comfort_weight = 0;
    EXPECT_FLOAT_EQ(edited_system(view, {anchor(1, 10, 0.5)}, params, names).system.start(30, 3), 7);
}

TEST(StereoConflict, FoldsAreLimitedButOldOnesStay) {
    for (const int reduction : {1, 2}) {
        const auto r = static_cast<float>(reduction);
        MiddleView view = empty_view(16 * reduction, 2 * reduction);
        view.reduction = reduction;
        view.object = view.material = Image<std::uint32_t>(16, 2, nothing_seen);
        view.disparity = DisparityMap(16, 2, -20);
        paint(view, {0, 0, 16, 2, 0, 0, -30, 1.5f * r, 0});
        paint(view, {12, 0, 16, 2, 0, 0, 40, 1.5f * r, 0});  // a step: a part of the object hides another
        const StereoEdit rounder{"round", 1, RoundnessEdit{{{0}, {}}, 2}};
        const EditedSystem edited = edited_system(view, {rounder}, {}, names);
        const auto fold = std::find_if(edited.conflicts.begin(), edited.conflicts.end(),
                                       [](const Conflict& c) { return c.kind == ConflictKind::fold; });
        ASSERT_NE(fold, edited.conflicts.end());
        EXPECT_EQ(fold->what, "wall");
        EXPECT_EQ(fold->pixels, 2 * 14);
        EXPECT_NEAR(fold->worst_px, r, 1e-5);
        const float step = view.disparity(12, 0) - view.disparity(11, 0);
        EXPECT_FLOAT_EQ(edited.system.gradient_x(3, 0), 1.9f * r);
        EXPECT_FLOAT_EQ(edited.system.gradient_x(11, 0), 2 * step);
        EditParams off;
        off.limit_folds = false;
        EXPECT_FLOAT_EQ(edited_system(view, {rounder}, off, names).system.gradient_x(3, 0), 3 * r);

        // Eyes stand side by side: however steep it falls from row to row, nothing runs backwards.
        paint(view, {0, 0, 16, 2, 0, 0, -30, 0, 1.5f * r});
        const EditedSystem steep = edited_system(view, {rounder}, {}, names);
        EXPECT_TRUE(steep.conflicts.empty());
        EXPECT_FLOAT_EQ(steep.system.gradient_y(3, 0), 3 * r);
    }
}

TEST(StereoConflict, SolvingLeavesFewer) {
    // The same detectors on the optimised map: the lion pushed into the wall comes back before it.
    const MiddleView view = lion_and_wall();
    const EditParams params = edited_interfaces();
    const EditedSystem strong = edited_system(view, {anchor(1, -900, 0.01)}, params, names);
    EXPECT_EQ(strong.conflicts[0].pixels, 24);
    const Image<double> x = small_minimiser(strong.system);
    DisparityMap optimised(x.width, x.height);
    std::transform(x.pixels.begin(), x.pixels.end(), optimised.pixels.begin(),
                   [](double d) { return static_cast<float>(d); });
    const Conflicts left = find_conflicts(view, optimised, {}, names);
    EXPECT_EQ(left.count(ConflictKind::depth_inversion), 0);
    const Conflicts before = find_conflicts(view, edited_disparity(view, {anchor(1, -900)}), {}, names);
    EXPECT_EQ(before.count(ConflictKind::depth_inversion), 24);
    EXPECT_GT(before.worst(ConflictKind::depth_inversion), 800);
    EXPECT_TRUE(find_conflicts(view, view.disparity, {}, names).list.empty());
}

TEST(StereoConflict, AnyThreadsFindTheSame) {
    RayScene scene;
    const MiddleView view = scene.view();
    const DisparityMap map = edited_disparity(view, {{"a", 1, RoundnessEdit{{{2}, {}}, 6}}, anchor(0, 9)});
    const ConflictLimits limits{{12, -9}, 0.05};
    const Conflicts one = find_conflicts(view, map, limits, {}, {Isa::ref, 1});
    ASSERT_GT(one.list.size(), 2u);
    EXPECT_TRUE(std::is_sorted(one.list.begin(), one.list.end(),
                               [](const Conflict& a, const Conflict& b) { return a.pixels > b.pixels; }));
    // Every pixel with an inverted step to one of its four neighbours is marked, and no other.
    const auto step_inverted = [&](int x, int y, int i, int j) {
        if (i < 0 || j < 0 || i >= map.width || j >= map.height) return false;
        if (view.object(x, y) == view.object(i, j)) return false;
        return inverted(static_cast<double>(view.disparity(i, j) - view.disparity(x, y)),
                        static_cast<double>(map(i, j) - map(x, y)), limits.meaningful_px);
    };
    int marked = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const bool wanted = step_inverted(x, y, x - 1, y) || step_inverted(x, y, x + 1, y) ||
                                step_inverted(x, y, x, y - 1) || step_inverted(x, y, x, y + 1);
            EXPECT_EQ((one.pixels(x, y) & conflict_bit(ConflictKind::depth_inversion)) != 0, wanted);
            marked += wanted ? 1 : 0;
        }
    }
    EXPECT_GT(marked, 100);
    for (const int threads : {2, 3, 5}) {
        const Conflicts many = find_conflicts(view, map, limits, {}, {Isa::ref, threads});
        EXPECT_EQ(many.pixels, one.pixels);
        ASSERT_EQ(many.list.size(), one.list.size());
        for (std::size_t i = 0; i < one.list.size(); ++i) {
            EXPECT_EQ(many.list[i].what, one.list[i].what);
            EXPECT_EQ(many.list[i].pixels, one.list[i].pixels);
            EXPECT_EQ(many.list[i].worst_px, one.list[i].worst_px);
        }
    }
}

TEST(StereoConflict, TheOverlayColoursConflictsAlone) {
    const MiddleView view = rope(4);
    Image<std::uint8_t> bits(view.width(), view.height());
    bits(10, 1) = conflict_bit(ConflictKind::depth_inversion);
    bits(0, 0) = conflict_bit(ConflictKind::depth_inversion);  // in the margin: not in the picture
    bits(20, 2) = conflict_bit(ConflictKind::comfort);
    const Image<Vec3f> beauty(20, 4, {0.5f, 0.5f, 0.5f});
    const Image<Vec3f> overlay = conflict_overlay(beauty, view, bits);
    int lines = 0, greys = 0;
    for (const Vec3f& c : overlay.pixels) {
        lines += c == conflict_colour(ConflictKind::depth_inversion) ? 1 : 0;
        greys += c.x == c.y && c.y == c.z && c.x < 0.3f ? 1 : 0;
    }
    EXPECT_EQ(lines, 9);  // a pixel, widened by one
    EXPECT_EQ(greys, 80 - 9 - 1);
    EXPECT_NE(overlay(14, 2).x, overlay(14, 2).z);
    for (int a = 0; a < conflict_kinds; ++a)
        for (int b = 0; b < a; ++b)
            EXPECT_FALSE(conflict_colour(ConflictKind{a}) == conflict_colour(ConflictKind{b}));
}

}  // namespace
}  // namespace obscura
