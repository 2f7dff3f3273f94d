// Edits of pairs and sets of pixels on maps painted by hand: things of several parts, interfaces, masks,
// matches; and pixels that are in none.
#include "stereo/edit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/stereo/edits.h"
#include "tests/stereo/slabs.h"
#include "tests/stereo/small_solver.h"

namespace obscura {
namespace {

MiddleView three_slabs() {
    MiddleView view = empty_view(12, 4);
    paint(view, {0, 0, 4, 4, 0, 0, 0, 0.5f});
    paint(view, {4, 0, 8, 4, 1, 1, 10, 0.25f});
    paint(view, {8, 0, 12, 4, 2, 2, 2, 0});
    return view;
}

TEST(StereoEditPairs, PartsOfOneObjectJoinByTheMeanOfTheirRoundness) {
    MiddleView view = empty_view(8, 2);
    paint(view, {0, 0, 4, 2, 5, 1, 0, 1});
    paint(view, {4, 0, 8, 2, 5, 2, 4, 1});
    const StereoEdit half{"half", 1, RoundnessEdit{{{}, {2}}, 3}};
    const DisparitySystem s = edited_system(view, {half}, plain(), {}).system;
    const float wanted[] = {1, 1, 1, 2, 3, 3, 3};
    for (int x = 0; x < 7; ++x)
        EXPECT_FLOAT_EQ(s.gradient_x(x, 0), wanted[x]) << x;
}

TEST(StereoEditPairs, AThingOfSeveralObjectsHasOneCentre) {
    MiddleView view = empty_view(12, 2);
    paint(view, {0, 0, 4, 2, 0, 0, 0, 0});
    paint(view, {4, 0, 8, 2, 1, 0, 10, 0});
    paint(view, {8, 0, 12, 2, 2, 0, 4, 0});
    StereoEdit edit{"pair", 1, RoundnessEdit{{{0, 1}, {}}, 2, true}};
    const DisparitySystem one = edited_system(view, {edit}, plain(), {}).system;
    EXPECT_FLOAT_EQ(one.start(0, 0), -5);
    EXPECT_FLOAT_EQ(one.start(4, 0), 15);
    EXPECT_FLOAT_EQ(one.gradient_x(3, 0), 20);
    EXPECT_FLOAT_EQ(one.gradient_x(7, 0), -6);  // another object: kept

    std::get<RoundnessEdit>(edit.what).together = false;
    const DisparitySystem two = edited_system(view, {edit}, plain(), {}).system;
    EXPECT_FLOAT_EQ(two.start(0, 0), 0);
    EXPECT_FLOAT_EQ(two.start(4, 0), 10);
    EXPECT_FLOAT_EQ(two.gradient_x(3, 0), 10);
}

TEST(StereoEditPairs, InterfaceEditsRevertBordersInEitherOrder) {
    const MiddleView view = three_slabs();
    EditParams params = plain();
    params.interfaces = InterfaceGradients::edited;
    const StereoEdit move = anchor({1}, 3);
    const float g01 = 10 - 1.5f, g12 = 2 - 10.75f;
    const auto borders = [&](const std::vector<StereoEdit>& edits) {
        const DisparitySystem s = edited_system(view, edits, params, {}).system;
        return std::array<float, 2>{s.gradient_x(3, 1), s.gradient_x(7, 1)};
    };
    using Pair = std::array<float, 2>;
    EXPECT_EQ(borders({move}), (Pair{g01 + 3, g12 - 3}));
    const EditTarget zero{{0}, {}}, one{{1}, {}}, second_material{{}, {1}};
    EXPECT_EQ(borders({move, {"i", 1, InterfaceEdit{zero, one, {}}}}), (Pair{g01, g12 - 3}));
    EXPECT_EQ(borders({move, {"i", 1, InterfaceEdit{one, zero, {}}}}), (Pair{g01, g12 - 3}));
    EXPECT_EQ(borders({move, {"i", 1, InterfaceEdit{second_material, {}, {}}}}), (Pair{g01, g12}));
    EXPECT_EQ(borders({move, {"i", 0.5, InterfaceEdit{zero, one, {}}}}), (Pair{g01 + 1.5f, g12 - 3}));
    // Two halves keep three quarters.
    EXPECT_EQ(
        borders({move, {"i", 0.5, InterfaceEdit{zero, one, {}}}, {"j", 0.5, InterfaceEdit{one, {}, {}}}}),
        (Pair{g01 + 0.75f, g12 - 1.5f}));

    // Where all are kept, one may be let go; what keeps prevails.
    params.interfaces = InterfaceGradients::original;
    EXPECT_EQ(borders({move}), (Pair{g01, g12}));
    EXPECT_EQ(borders({move, {"i", 1, InterfaceEdit{zero, one, {}, false}}}), (Pair{g01 + 3, g12}));
    EXPECT_EQ(
        borders(
            {move, {"i", 1, InterfaceEdit{zero, one, {}, false}}, {"j", 1, InterfaceEdit{zero, one, {}}}}),
        (Pair{g01, g12}));
}

TEST(StereoEditPairs, MasksKeepGradientsInsideObjectsToo) {
    MiddleView view = empty_view(12, 4, 2);
    paint(view, {0, 0, 16, 4, 0, 0, 0, 1});
    Image<float> mask(12, 4);  // of the picture, without margins
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 12; ++x)
            mask(x, y) = x < 4 ? 1.0f : x < 8 ? 0.5f : 0.0f;
    const auto row = [&](const Image<float>& m, const MiddleView& v) {
        const StereoEdit keep{"mask", 1, InterfaceEdit{{}, {}, m}};
        const DisparitySystem s = edited_system(v, {roundness({0}, 3), keep}, plain(), {}).system;
        std::vector<float> g;
        for (int x = 0; x + 1 < v.width(); ++x)
            g.push_back(s.gradient_x(x, 2));
        return g;
    };
    // Original under the mask, in the margin as at the picture's edge; half way; rounded.
    EXPECT_EQ(row(mask, view), (std::vector<float>{1, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3}));

    // The same mask in half its pixels, stretched: smooth between.
    Image<float> coarse(6, 2);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 6; ++x)
            coarse(x, y) = x < 2 ? 1.0f : x < 4 ? 0.5f : 0.0f;
    const std::vector<float> g = row(coarse, view);
    for (std::size_t i = 0; i + 1 < g.size(); ++i)
        EXPECT_LE(g[i], g[i + 1]);
    EXPECT_FLOAT_EQ(g[3], 1);
    EXPECT_FLOAT_EQ(g[7], 2);
    EXPECT_FLOAT_EQ(g[12], 3);
}

TEST(StereoEditPairs, MatchingSetsAreTheDestinationsObject) {
    MiddleView view = empty_view(20, 6, 3);
    paint(view, {3, 0, 10, 6, 0, 0, -4, 0.5f});
    paint(view, {12, 1, 20, 5, 1, 0, 6, 0.25f, 1});
    StereoEdit edit{"m", 2, MatchEdit{{1.5, 2.5}, {12.5, 3.5}, 1.5}};
    EditParams params = plain();
    params.match_weight = 3;
    const EditedSystem edited = edited_system(view, {edit}, params, {});
    ASSERT_EQ(edited.system.sets.size(), 1u);
    const MatchingSet& set = edited.system.sets[0];
    EXPECT_EQ(set.name, "m");
    EXPECT_EQ(set.source_x, 4);
    EXPECT_EQ(set.source_y, 2);
    EXPECT_EQ(set.weight, 6);
    ASSERT_EQ(set.members.size(), 8u * 4u);
    EXPECT_EQ(set.members[0].x, 12);
    EXPECT_EQ(set.members[0].y, 1);
    for (const MatchedPixel& p : set.members)
        EXPECT_EQ(p.target, 1.5f + view.disparity(p.x, p.y) - view.disparity(15, 3));

    // Source and destination on one object: all of it but the source.
    std::get<MatchEdit>(edit.what).source_px = {10.5, 2.5};
    EXPECT_EQ(edited_system(view, {edit}, params, {}).system.sets[0].members.size(), 31u);
    // In a radius, of the same object or of any.
    auto& match = std::get<MatchEdit>(edit.what);
    match.radius_px = 2;
    match.source_px = {1.5, 2.5};
    match.destination_px = {9.5, 2.5};  // the corner column of the object
    EXPECT_EQ(edited_system(view, {edit}, params, {}).system.sets[0].members.size(), 8u);
    match.any_object = true;
    EXPECT_EQ(edited_system(view, {edit}, params, {}).system.sets[0].members.size(), 8u);
    paint(view, {10, 0, 12, 6, 2, 0, 0});
    EXPECT_EQ(edited_system(view, {edit}, params, {}).system.sets[0].members.size(), 8u + 4);
}

TEST(StereoEditPairs, WhatIsMatchedFollowsWithoutDraggingItsSource) {
    // A box on a wall that is moved back (thesis, figure 4.1), with both kinds of interfaces.
    MiddleView view = empty_view(48, 24);
    paint(view, {0, 0, 48, 24, 0, 0, 1, 0.125f});
    paint(view, {20, 6, 34, 18, 1, 0, 4});
    const std::vector<StereoEdit> edits = {anchor({0}, -6),
                                           {"m", 1, MatchEdit{{17.5, 12.5}, {20.5, 12.5}, 0.5}}};
    EditParams params = plain();
    params.interfaces = InterfaceGradients::edited;
    const DisparitySystem s = edited_system(view, edits, params, {}).system;
    const float box = view.disparity(17, 12) - 6 + 0.5f;
    EXPECT_FLOAT_EQ(s.start(25, 10), box);
    EXPECT_EQ(edited_disparity(view, edits), s.start);
    const Image<double> x = small_minimiser(s);
    for (std::size_t i = 0; i < x.pixels.size(); ++i)
        EXPECT_NEAR(x.pixels[i], static_cast<double>(s.start.pixels[i]), 0.02);

    StereoEdit half = edits[1];
    half.weight = 0.5;
    EXPECT_FLOAT_EQ(edited_disparity(view, {edits[0], half})(25, 10), (box + 4) / 2);
    // Two sets: the mean.
    StereoEdit other = edits[1];
    std::get<MatchEdit>(other.what).offset_px = 2.5;
    EXPECT_FLOAT_EQ(edited_disparity(view, {edits[0], other, edits[1]})(25, 10), box + 1);
}

TEST(StereoEditPairs, WhatCannotBeDoneIsANotice) {
    MiddleView view = empty_view(20, 6);
    paint(view, {0, 0, 10, 6, 0, 0, -4});
    const auto match = [](std::string name, Vec2d from, Vec2d to) {
        return StereoEdit{std::move(name), 1, MatchEdit{from, to}};
    };
    const EditedSystem edited = edited_system(view,
                                              {match("e", {1, 1}, {1.2, 1.2}),
                                               match("d", {1, 1}, {15, 2}),
                                               match("c", {15, 2}, {1, 1}),
                                               match("b", {1, 1}, {25, 2}),
                                               match("a", {-1e30, std::nextafter(0.0, -1)}, {1, 1}),
                                               {"f", 1, AnchorEdit{{{7}, {}}, 1}}},
                                              {}, {});
    EXPECT_TRUE(edited.system.sets.empty());
    std::string names;
    for (const EditNotice& n : edited.notices)
        names += n.edit;
    EXPECT_EQ(names, "fabcde");
}

TEST(StereoEditPairs, UnseenPixelsNeverEnter) {
    MiddleView view = three_slabs();
    view.object(1, 1) = nothing_seen;
    view.disparity(2, 2) = std::numeric_limits<float>::quiet_NaN();
    view.disparity(5, 3) = std::numeric_limits<float>::infinity();
    const EditedSystem edited = edited_system(view,
                                              {roundness({0, 1, 2}, 2),
                                               anchor({0, 1, 2, nothing_seen}, 1),
                                               {"m", 1, MatchEdit{{9, 1}, {0.5, 0.5}}}},
                                              {}, {});
    const DisparitySystem& s = edited.system;
    for (const auto& [x, y] : {std::pair{1, 1}, {2, 2}, {5, 3}}) {
        EXPECT_EQ(s.valid(x, y), 0);
        EXPECT_EQ(s.anchor_weight(x, y), 0);
        EXPECT_EQ(edited.conflict_pixels(x, y), 0);
        for (const MatchedPixel& p : s.sets.at(0).members)
            EXPECT_FALSE(p.x == x && p.y == y);
    }
    EXPECT_EQ(s.start(1, 1), view.disparity(1, 1));
    EXPECT_EQ(s.sets[0].members.size(), 14u);
    for (std::size_t i = 0; i < s.valid.pixels.size(); ++i)
        EXPECT_TRUE(s.valid.pixels[i] == 0 || std::isfinite(s.start.pixels[i]));
}

}  // namespace
}  // namespace obscura
