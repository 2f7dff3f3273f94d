// Edits against their equations: thesis 4.2 to 4.4 and what stereo/edit.h says beyond them.
#include "stereo/edit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "stereo/edit_classes.h"
#include "tests/stereo/edits.h"
#include "tests/stereo/ray_scene.h"
#include "tests/stereo/small_solver.h"

namespace obscura {
namespace {

constexpr std::uint32_t wall = 0, floor_object = 1, ball = 2;

RayScene small_scene() {
    RayScene scene;
    scene.width = 96;
    scene.height = 54;
    scene.focal_px = 90;
    scene.interaxial_m = 0.4;
    return scene;
}

std::vector<float> disparities_of(const MiddleView& view, std::uint32_t object) {
    std::vector<float> values;
    for (std::size_t i = 0; i < view.object.pixels.size(); ++i)
        if (view.object.pixels[i] == object) values.push_back(view.disparity.pixels[i]);
    return values;
}

/// The interquartile mean, by sorting.
double centre_of(const MiddleView& view, std::uint32_t object) {
    std::vector<float> v = disparities_of(view, object);
    std::sort(v.begin(), v.end());
    const std::size_t skip = v.size() / 4;
    double sum = 0;
    for (std::size_t i = skip; i < v.size() - skip; ++i)
        sum += static_cast<double>(v[i]);
    return sum / static_cast<double>(v.size() - 2 * skip);
}

std::uint64_t bits_of(const EditedSystem& e) {
    Hasher h;
    const DisparitySystem& s = e.system;
    for (const Image<float>* image :
         {&s.original, &s.start, &s.gradient_x, &s.gradient_y, &s.anchor_weight, &s.anchor_value})
        h.values(image->pixels);
    h.values(s.valid.pixels).value(s.gradient_weight).value(s.epsilon).values(e.conflict_pixels.pixels);
    for (const MatchingSet& set : s.sets) {
        h.bytes(set.name.data(), set.name.size()).value(set.source_x).value(set.source_y).value(set.weight);
        for (const MatchedPixel& p : set.members)
            h.value(p.x).value(p.y).value(p.target);
    }
    for (const Conflict& c : e.conflicts)
        h.value(c.kind).value(c.pixels).value(c.worst_px).bytes(c.what.data(), c.what.size());
    for (const EditNotice& n : e.notices)
        h.bytes(n.edit.data(), n.edit.size()).bytes(n.text.data(), n.text.size());
    return h.state;
}

TEST(StereoEdit, NoEditsAreTheUneditedSystemBitForBit) {
    MiddleView view = small_scene().view();
    for (int x = 0; x < view.width(); ++x)
        view.object(x, 0) = nothing_seen;
    const EditedSystem edited = edited_system(view, {}, {}, {});
    EditedSystem plain_system;
    plain_system.system = unedited_system(view.disparity, valid_pixels(view));
    plain_system.conflicts = edited.conflicts;
    plain_system.conflict_pixels = edited.conflict_pixels;
    EXPECT_EQ(bits_of(edited), bits_of(plain_system));

    const Image<double> x = small_minimiser(edited.system);
    for (std::size_t i = 0; i < x.pixels.size(); ++i)
        EXPECT_NEAR(x.pixels[i], static_cast<double>(view.disparity.pixels[i]), 1e-6);
}

TEST(StereoEdit, EditsOfNoWeightOrNoEffectChangeNothing) {
    const MiddleView view = small_scene().view();
    const EditedSystem none = edited_system(view, {}, {}, {});
    EXPECT_EQ(bits_of(edited_system(view, {roundness({ball}, 3, 0), anchor({wall}, 5, 0)}, {}, {})),
              bits_of(none));
    EXPECT_EQ(bits_of(edited_system(view, {roundness({ball}, 1)}, {}, {})), bits_of(none));
}

TEST(StereoEdit, RoundnessScalesAboutTheCentre) {
    const MiddleView view = small_scene().view();
    const EditedSystem edited = edited_system(view, {roundness({ball}, 2.5)}, plain(), {});
    const DisparitySystem& s = edited.system;
    const double centre = centre_of(view, ball);
    int inside = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x + 1 < view.width(); ++x) {
            const auto d = static_cast<double>(view.disparity(x, y));
            const double wanted = view.object(x, y) == ball ? centre + (d - centre) * 2.5 : d;
            EXPECT_NEAR(static_cast<double>(s.start(x, y)), wanted, 1e-4);
            const bool both = view.object(x, y) == ball && view.object(x + 1, y) == ball;
            const float g = view.disparity(x + 1, y) - view.disparity(x, y);
            // Between objects the original's, by default.
            EXPECT_FLOAT_EQ(s.gradient_x(x, y), both ? 2.5f * g : g);
            inside += both ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 300);
}

TEST(StereoEdit, InterfacesMayComeFromTheEditedMap) {
    const MiddleView view = small_scene().view();
    EditParams params = plain();
    params.interfaces = InterfaceGradients::edited;
    const EditedSystem edited = edited_system(view, {roundness({ball}, 2.5), anchor({ball}, 4)}, params, {});
    const DisparitySystem& s = edited.system;
    for (int y = 0; y + 1 < view.height(); ++y)
        for (int x = 0; x < view.width(); ++x)
            EXPECT_NEAR(static_cast<double>(s.gradient_y(x, y)),
                        static_cast<double>(s.start(x, y + 1) - s.start(x, y)), 2e-5);
    // Then nothing contradicts D~ but epsilon.
    const Image<double> x = small_minimiser(s);
    double worst = 0;
    for (std::size_t i = 0; i < x.pixels.size(); ++i)
        worst = std::max(worst, std::abs(x.pixels[i] - static_cast<double>(s.start.pixels[i])));
    EXPECT_LT(worst, 0.2);
    EXPECT_GT(worst, 0);
}

TEST(StereoEdit, KeptInterfacesCarryAnEditToTheNeighbours) {
    // Thesis 4.4: the deviation spreads over all objects. The ball moves; so does the floor beneath it.
    const MiddleView view = small_scene().view();
    EditParams params = plain();
    params.epsilon = 1e-3;
    const Image<double> x = small_minimiser(edited_system(view, {anchor({ball}, 4)}, params, {}).system);
    const auto moved = [&](std::uint32_t object) {
        double sum = 0;
        int n = 0;
        for (std::size_t i = 0; i < x.pixels.size(); ++i) {
            if (view.object.pixels[i] != object) continue;
            sum += x.pixels[i] - static_cast<double>(view.disparity.pixels[i]);
            ++n;
        }
        return sum / n;
    };
    EXPECT_NEAR(moved(ball), 4, 0.1);
    EXPECT_GT(moved(floor_object), 1);
    EXPECT_GT(moved(wall), 1);
}

TEST(StereoEdit, CentreIgnoresTheOuterHalf) {
    std::vector<float> v = {9, 1, 2, 3, 4, 5, 6, 7};
    EXPECT_DOUBLE_EQ(interquartile_mean(v), (3 + 4 + 5 + 6) / 4.0);
    v = {900, -100, 2, 3, 4, 5, 6, 7};
    EXPECT_DOUBLE_EQ(interquartile_mean(v), (3 + 4 + 5 + 6) / 4.0);
    v = {5};
    EXPECT_DOUBLE_EQ(interquartile_mean(v), 5);
    v = {1, 2, 4};
    EXPECT_NEAR(interquartile_mean(v), 7 / 3.0, 1e-6);

    // A ball partly hidden keeps its centre: a post over a fifth of it, at the middle or at the rim.
    const MiddleView whole = small_scene().view();
    const std::vector<float> all = disparities_of(whole, ball);
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    const double range = static_cast<double>(*high - *low), centre = centre_of(whole, ball);
    int left = whole.width(), right = 0;
    for (int y = 0; y < whole.height(); ++y)
        for (int x = 0; x < whole.width(); ++x)
            if (whole.object(x, y) == ball) left = std::min(left, x), right = std::max(right, x);
    for (const double at : {0.0, 0.2, 0.4, 0.8}) {
        MiddleView hidden = whole;
        const int from = left + static_cast<int>(at * (right - left)), wide = (right - left) / 5;
        for (int y = 0; y < whole.height(); ++y)
            for (int x = from; x < from + wide; ++x)
                hidden.object(x, y) = nothing_seen;
        EXPECT_NEAR(centre_of(hidden, ball), centre, 0.05 * range) << at;
        const DisparityMap map = edited_disparity(hidden, {roundness({ball}, 0)});
        for (std::size_t i = 0; i < map.pixels.size(); ++i)
            if (hidden.object.pixels[i] == ball) {
                EXPECT_NEAR(static_cast<double>(map.pixels[i]), centre_of(hidden, ball), 1e-4);
            }
    }
}

TEST(StereoEdit, AnchorsHoldRoundedDisparityAndAreAveragedByWeight) {
    const MiddleView view = small_scene().view();
    EditParams params = plain();
    params.anchor_weight = 2;
    const std::vector<StereoEdit> edits = {roundness({ball}, 2), anchor({ball}, 6, 0.5),
                                           anchor({ball, wall}, -2, 1.5)};
    const DisparitySystem s = edited_system(view, edits, params, {}).system;
    const double centre = centre_of(view, ball);
    for (std::size_t i = 0; i < s.original.pixels.size(); ++i) {
        const auto d = static_cast<double>(view.disparity.pixels[i]);
        const std::uint32_t object = view.object.pixels[i];
        const double weight = object == ball ? 4 : object == wall ? 3 : 0;
        EXPECT_EQ(static_cast<double>(s.anchor_weight.pixels[i]), weight);
        const double wanted = object == ball ? centre + 2 * (d - centre) : d - 2;
        if (weight == 0) continue;
        EXPECT_NEAR(static_cast<double>(s.anchor_value.pixels[i]), wanted, 1e-4);
        EXPECT_NEAR(static_cast<double>(s.start.pixels[i]), wanted, 1e-4);
    }
}

TEST(StereoEdit, WeightsFadeRoundnessAndLift) {
    const MiddleView view = small_scene().view();
    const double centre = centre_of(view, ball);
    const auto check = [&](const std::vector<StereoEdit>& edits, double factor, double lift) {
        const DisparityMap map = edited_disparity(view, edits);
        for (std::size_t i = 0; i < map.pixels.size(); ++i) {
            const auto d = static_cast<double>(view.disparity.pixels[i]);
            if (view.object.pixels[i] != ball) continue;
            EXPECT_NEAR(static_cast<double>(map.pixels[i]), centre + factor * (d - centre) + lift, 1e-4);
        }
    };
    check({roundness({ball}, 3, 0.25)}, 1.5, 0);
    check({roundness({ball}, 3, 7)}, 3, 0);  // a share is at most 1
    check({roundness({ball}, 3), roundness({ball}, 0.5)}, 1.5, 0);
    check({anchor({ball}, 8, 0.25)}, 1, 2);
    check({anchor({ball}, 8, 5)}, 1, 8);
}

TEST(StereoEdit, OrderAndThreadsLeaveNoTrace) {
    const MiddleView view = small_scene().view();
    Image<float> mask(7, 5, 0.3f);
    std::vector<StereoEdit> edits = {
        {"a", 0.7, RoundnessEdit{{{ball}, {}}, 3}},
        {"a", 0.7, RoundnessEdit{{{ball}, {}}, 1.7}},
        {"b", 0.9, RoundnessEdit{{{ball, floor_object}, {}}, 1.1, true}},
        {"b", 0.9, RoundnessEdit{{{wall, ball}, {}}, 1.3, true}},
        {"c", 0.3, AnchorEdit{{{ball}, {}}, 3.3}},
        {"d", 0.13, AnchorEdit{{{}, {ball, wall}}, -1.7}},
        {"e", 1.9, AnchorEdit{{{ball}, {}}, 0.77}},
        {"f", 0.4, InterfaceEdit{{{ball}, {}}, {{wall}, {}}, {}}},
        {"g", 0.7, InterfaceEdit{{}, {}, mask}},
        {"h", 0.6, MatchEdit{{10, 10}, {60, 30}, 2}},
        {"i", 0.6, MatchEdit{{20, 40}, {60, 30}, -1, 9}},
        {"j", 1, AnchorEdit{{{99}, {}}, 1}},
    };
    EditParams params;
    params.interfaces = InterfaceGradients::edited;
    params.comfort = {3, -6};
    const std::uint64_t bits = bits_of(edited_system(view, edits, params, {}, {Isa::ref, 1}));
    std::uint32_t random = 1;
    for (int round = 0; round < 12; ++round) {
        for (std::size_t i = edits.size(); i > 1; --i) {
            random = random * 1664525u + 1013904223u;
            std::swap(edits[i - 1], edits[(random >> 16) % i]);
        }
        // Nor does the order within a target.
        for (StereoEdit& edit : edits)
            if (auto* r = std::get_if<RoundnessEdit>(&edit.what))
                std::reverse(r->target.objects.begin(), r->target.objects.end());
        EXPECT_EQ(bits_of(edited_system(view, edits, params, {}, {Isa::ref, 1 + round % 4})), bits);
    }
    for (StereoEdit& edit : edits)
        edit.weight *= 0.5;
    EXPECT_NE(bits_of(edited_system(view, edits, params, {})), bits);
}

TEST(StereoEdit, OneOffsetForEverythingIsExact) {
    const MiddleView view = small_scene().view();
    const DisparitySystem s =
        edited_system(view, {anchor({wall, floor_object, ball}, 7)}, plain(), {}).system;
    const DisparitySystem none = edited_system(view, {}, plain(), {}).system;
    EXPECT_EQ(s.gradient_x.pixels, none.gradient_x.pixels);
    EXPECT_EQ(s.gradient_y.pixels, none.gradient_y.pixels);
    const Image<double> x = small_minimiser(s);
    for (std::size_t i = 0; i < x.pixels.size(); ++i) {
        EXPECT_EQ(s.start.pixels[i], static_cast<float>(static_cast<double>(view.disparity.pixels[i]) + 7));
        EXPECT_NEAR(x.pixels[i], static_cast<double>(view.disparity.pixels[i]) + 7, 7e-4 + 1e-6);
    }
}

TEST(StereoEdit, ReducedSystemsHaveTheSameMinimiser) {
    RayScene scene = small_scene();
    scene.width = 192;
    scene.height = 108;
    scene.focal_px = 180;
    scene.margin_px = 8;
    const MiddleView view = scene.view();
    // Both compromises, between anchors and epsilon and of the match with gradients, depend on the weights.
    EditParams params = plain();
    params.epsilon = 2e-3;
    const std::vector<StereoEdit> edits = {
        roundness({ball}, 1.5), anchor({ball}, 4, 0.02), {"m", 0.01, MatchEdit{{20, 20}, {100, 100}, 3}}};
    const Image<double> full = small_minimiser(edited_system(view, edits, params, {}).system);
    double largest = 0;
    for (std::size_t i = 0; i < full.pixels.size(); ++i)
        largest = std::max(largest, std::abs(full.pixels[i] - static_cast<double>(view.disparity.pixels[i])));
    EXPECT_GT(largest, 3);
    for (const int reduction : {2, 4, 8}) {
        const MiddleView small = reduced(view, reduction);
        const Image<double> x = small_minimiser(edited_system(small, edits, params, {}).system);
        double squares = 0;
        for (int y = 0; y < x.height; ++y) {
            for (int c = 0; c < x.width; ++c) {
                const double miss = x(c, y) - full(sampled_pixel(c, reduction, view.width()),
                                                   sampled_pixel(y, reduction, view.height()));
                squares += miss * miss;
            }
        }
        EXPECT_LT(std::sqrt(squares / static_cast<double>(x.pixels.size())), 0.07 * reduction) << reduction;
    }
}

TEST(StereoEdit, FadesFollowTheCamera) {
    WeightFade fade;
    EXPECT_EQ(fade_factor(fade, {1, 2, 3}, {0, 0, -1}), 1);
    fade.angle_deg = {20, 60};
    EXPECT_EQ(fade_factor(fade, {}, {0, 0, -1}), 1);
    const auto turned = [](double degrees) {
        const double a = degrees / 180 * 3.14159265358979;
        return Vec3d{std::sin(a), 0, -std::cos(a)};
    };
    EXPECT_NEAR(fade_factor(fade, {}, turned(20)), 1, 1e-12);
    EXPECT_NEAR(fade_factor(fade, {}, turned(40)), 0.5, 1e-12);
    EXPECT_NEAR(fade_factor(fade, {}, turned(30)), 1 - (3.0 / 16 - 2.0 / 64), 1e-12);
    EXPECT_NEAR(fade_factor(fade, {}, turned(60)), 0, 1e-12);
    EXPECT_EQ(fade_factor(fade, {}, turned(170)), 0);
    fade.distance_m = {10, 2};  // gone when near
    fade.position_m = {0, 0, 5};
    EXPECT_NEAR(fade_factor(fade, {0, 0, 11}, turned(40)), 0.25, 1e-12);
    EXPECT_EQ(fade_factor(fade, {0, 0, 6}, turned(0)), 0);
    EXPECT_EQ(fade_factor(fade, {0, 90, 6}, turned(0)), 1);
    fade.distance_m = {3, 3};
    EXPECT_EQ(fade_factor(fade, {0, 0, 8}, turned(0)), 1);
    EXPECT_EQ(fade_factor(fade, {0, 0, 8.1}, turned(0)), 0);
}

}  // namespace
}  // namespace obscura
