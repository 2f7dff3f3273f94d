// Solutions at 1:2, 1:4 and 1:8 against the solution at full resolution, the paper's figure 4.6; and solves
// that start from the frame before.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/scene.h"
#include "stereo/edit.h"
#include "stereo/reduced_system.h"
#include "stereo/solver/solver.h"
#include "stereo/upsample.h"
#include "stereo/warm_start.h"
#include "tests/stereo/ray_scene.h"

namespace obscura {
namespace {

const std::vector<std::string> names{"wall", "ground", "sphere"};

RayScene sphere_scene() {
    RayScene scene;
    scene.width = 480;
    scene.height = 270;
    scene.focal_px = 450;
    scene.margin_px = 8;
    return scene;
}

SolverParams precise() {
    SolverParams params;
    params.tolerance_max_px = 0.01;
    params.tolerance_rms_px = 0.005;
    return params;
}

DisparitySystem system_of(const MiddleView& view, const std::vector<StereoEdit>& edits) {
    return edited_system(view, edits, EditParams{}, names, Exec{}).system;
}

Solution solved(const MiddleView& view, const std::vector<StereoEdit>& edits,
                const DisparityMap& initial = {}) {
    return solve(system_of(view, edits), precise(), Exec{}, initial);
}

std::vector<StereoEdit> rounder(double roundness, double offset_px) {
    StereoEdit round, anchor;
    round.name = "round";
    round.what = RoundnessEdit{.target = {.objects = {2}, .materials = {}}, .roundness = roundness};
    anchor.name = "anchor";
    anchor.what = AnchorEdit{.target = {.objects = {2}, .materials = {}}, .offset_px = offset_px};
    return {round, anchor};
}

class ReducedSolve : public testing::TestWithParam<int> {};

struct Miss {
    double squares = 0, worst = 0;
    std::int64_t pixels = 0;
    void add(float a, float b) {
        const auto miss = static_cast<double>(a - b);
        worst = std::max(worst, std::abs(miss));
        squares += miss * miss;
        ++pixels;
    }
    double rms() const { return std::sqrt(squares / static_cast<double>(pixels)); }
};

TEST_P(ReducedSolve, IsNearTheFullOne) {
    const int n = GetParam();
    const MiddleView view = sphere_scene().view(), low = reduced(view, n);
    const std::vector<StereoEdit> edits = rounder(2, 3);
    const DisparitySystem system = system_of(view, edits);
    const DisparityMap full = solve(system, precise(), Exec{}).disparity;
    const DisparityMap small = solve(reduced_system(system, view, n, Exec{}), precise(), Exec{}).disparity;
    const DisparityMap up = upsampled_solution(view, low, small, UpsampleParams{}, Exec{});
    // The paper's way: edits applied to the samples.
    const DisparityMap paper =
        upsampled_solution(view, low, solved(low, edits).disparity, UpsampleParams{}, Exec{});
    Miss everywhere, papers, at_samples, change;
    for (std::size_t i = 0; i < full.pixels.size(); ++i) {
        everywhere.add(up.pixels[i], full.pixels[i]);
        papers.add(paper.pixels[i], full.pixels[i]);
        change.add(full.pixels[i], view.disparity.pixels[i]);
    }
    for (int y = 0; y < low.height(); ++y)
        for (int x = 0; x < low.width(); ++x)
            at_samples.add(small(x, y),
                           full(sampled_pixel(x, n, view.width()), sampled_pixel(y, n, view.height())));
    fmt::print(
        "1:{}: max {:.3f} rms {:.4f} px, at samples max {:.3f} rms {:.4f}; edited samples: max {:.3f} rms "
        "{:.4f}; change {:.2f}, rms {:.2f} px\n",
        n, everywhere.worst, everywhere.rms(), at_samples.worst, at_samples.rms(), papers.worst, papers.rms(),
        change.worst, change.rms());
    EXPECT_GT(change.worst, 3);
    EXPECT_LT(everywhere.worst, 0.3);
    EXPECT_LT(everywhere.rms(), 0.025);
    EXPECT_LT(everywhere.rms(), 0.1 * papers.rms());
}

TEST_P(ReducedSolve, OfNoEditsIsTheViewItself) {
    const int n = GetParam();
    const MiddleView view = sphere_scene().view();
    const DisparitySystem low = reduced_system(unedited_system(view.disparity, {}), view, n, Exec{});
    const DisparitySystem unedited = unedited_system(reduced(view, n).disparity, {});
    EXPECT_EQ(low.original, unedited.original);
    EXPECT_EQ(low.start, unedited.start);
    EXPECT_EQ(low.gradient_x, unedited.gradient_x);
    EXPECT_EQ(low.gradient_y, unedited.gradient_y);
    EXPECT_EQ(low.anchor_weight, unedited.anchor_weight);
    EXPECT_EQ(low.valid, unedited.valid);
    EXPECT_EQ(low.epsilon, unedited.epsilon * static_cast<float>(n * n));
}

TEST_P(ReducedSolve, MovesEverythingExactly) {
    // All objects anchored at an offset: that, at every pixel.
    const int n = GetParam();
    const MiddleView view = sphere_scene().view(), low = reduced(view, n);
    StereoEdit all;
    all.name = "all";
    all.what = AnchorEdit{.target = {.objects = {0, 1, 2}, .materials = {}}, .offset_px = 5};
    EditParams params;
    params.epsilon = 1e-8;
    params.window_weight = 0;  // the ground comes before the frame
    const DisparitySystem system =
        reduced_system(edited_system(view, {all}, params, names, Exec{}).system, view, n, Exec{});
    const DisparityMap small = solve(system, precise(), Exec{}).disparity;
    const DisparityMap up = upsampled_solution(view, low, small, UpsampleParams{}, Exec{});
    Miss solver, all_pixels;
    for (std::size_t i = 0; i < small.pixels.size(); ++i)
        solver.add(small.pixels[i], low.disparity.pixels[i] + 5);
    for (std::size_t i = 0; i < up.pixels.size(); ++i)
        all_pixels.add(up.pixels[i], view.disparity.pixels[i] + 5);
    fmt::print("1:{}: offset of all: solver {:.4f}, all pixels {:.4f} px\n", n, solver.worst,
               all_pixels.worst);
    EXPECT_LT(solver.worst, 0.01);
    EXPECT_LT(all_pixels.worst, 0.03);
}

TEST_P(ReducedSolve, FollowsMatchingPoints) {
    const int n = GetParam();
    const MiddleView view = sphere_scene().view(), low = reduced(view, n);
    StereoEdit match;
    match.name = "match";  // the sphere to a point of the wall
    match.weight = 4;
    match.what = MatchEdit{.source_px = {61.5, 40.5}, .destination_px = {255.5, 150.5}, .offset_px = 2};
    const DisparitySystem system = system_of(view, {match});
    ASSERT_EQ(system.sets.size(), 1u);
    const DisparitySystem smaller = reduced_system(system, view, n, Exec{});
    ASSERT_EQ(smaller.sets.size(), 1u);
    EXPECT_NEAR(static_cast<double>(smaller.sets[0].members.size()),
                static_cast<double>(system.sets[0].members.size()) / (n * n), 12.0 * 12 / n);
    const DisparityMap full = solve(system, precise(), Exec{}).disparity;
    const DisparityMap up =
        upsampled_solution(view, low, solve(smaller, precise(), Exec{}).disparity, UpsampleParams{}, Exec{});
    Miss miss, change;
    for (std::size_t i = 0; i < full.pixels.size(); ++i) {
        miss.add(up.pixels[i], full.pixels[i]);
        change.add(full.pixels[i], view.disparity.pixels[i]);
    }
    fmt::print("1:{}: match max {:.3f} rms {:.4f} px of change {:.2f}, rms {:.2f}\n", n, miss.worst,
               miss.rms(), change.worst, change.rms());
    // The wall's point is drawn out like a needle of one pixel; a thicker one is stiffer, so the sphere comes
    // nearer instead.
    EXPECT_LT(miss.rms(), 0.05 * n * change.rms() + 0.01);
}

TEST(ReducedSystem, SkipsWhatIsInvalidAndSumsWhatIsAnchored) {
    const int n = 4;
    MiddleView view = sphere_scene().view();
    DisparitySystem full = unedited_system(view.disparity, {});
    // Two gradients on the way of one reduced pair change, one of them beside an invalid pixel.
    full.gradient_x(41, 21) += 2;
    full.gradient_x(43, 21) += 7;
    full.valid(44, 21) = 0;
    // Three anchored pixels of one block, the sample not among them.
    for (const int x : {80, 82, 83}) {
        full.anchor_weight(x, 42) = 2;
        full.anchor_value(x, 42) = view.disparity(x, 42) + 3;
    }
    const DisparitySystem low = reduced_system(full, view, n, Exec{});
    EXPECT_FLOAT_EQ(low.gradient_x(10, 5), view.disparity(45, 21) - view.disparity(41, 21) + 2);
    EXPECT_FLOAT_EQ(low.gradient_x(11, 5), view.disparity(49, 21) - view.disparity(45, 21));
    EXPECT_EQ(low.anchor_weight(20, 10), 6);
    EXPECT_FLOAT_EQ(low.anchor_value(20, 10), view.disparity(81, 41) + 3);
    EXPECT_EQ(low.anchor_weight(21, 10), 0);
}

TEST(ReducedSystem, SourcesAndAnchorsStayWithTheirObject) {
    const int n = 4;
    MiddleView view = sphere_scene().view();
    view.object = Image<std::uint32_t>(view.width(), view.height(), 0);
    DisparitySystem full = unedited_system(view.disparity, {});
    // A source between samples; its block's sample (41, 41) is of another object, the next one its own.
    view.object(41, 41) = 1;
    full.start(42, 42) = 10;
    full.start(45, 41) = 7;
    full.sets.push_back(
        {"match", 42, 42, 2, {{100, 99, 9}, {101, 101, 1.5f}, {102, 101, 9}, {105, 101, -2}}});
    full.sets.push_back({"between samples", 41, 41, 1, {{100, 100, 1}}});
    // Anchors: four pixels of a block, one of them of the sample's object.
    view.object(81, 81) = view.object(82, 82) = 5;
    for (const auto& [x, y] : {std::pair{80, 80}, {81, 80}, {82, 82}, {83, 83}})
        full.anchor_weight(x, y) = 1;
    const DisparitySystem low = reduced_system(full, view, n, Exec{});
    ASSERT_EQ(low.sets.size(), 1u);
    const MatchingSet& set = low.sets[0];
    EXPECT_EQ(set.source_x, 11);  // (45, 41)
    EXPECT_EQ(set.source_y, 10);
    EXPECT_EQ(set.weight, 2 * n * n);
    ASSERT_EQ(set.members.size(), 2u);
    EXPECT_EQ(set.members[0].x, 25);
    EXPECT_EQ(set.members[0].y, 25);
    EXPECT_EQ(set.members[0].target, 1.5f + 3);  // the sample lies 3 px behind the source
    EXPECT_EQ(set.members[1].target, -2.0f + 3);
    EXPECT_EQ(low.anchor_weight(20, 20), 1);
}

INSTANTIATE_TEST_SUITE_P(Reductions, ReducedSolve, testing::Values(2, 4, 8));

TEST(WarmSolve, StartsFromTheFrameBefore) {
    const RayScene scene = sphere_scene();
    RayScene moved = scene;
    const Vec3d step{0.02, 0, 0.05};
    moved.centre = scene.centre - step;
    moved.wall_z = scene.wall_z - step.z - scene.wall_normal.x / scene.wall_normal.z * step.x;
    const MiddleView before = scene.view(), now = moved.view();
    Camera first;
    first.eye = {0, 0, 0};
    first.look_at = {0, 0, 1};
    first.up = {0, -1, 0};
    first.vfov_deg = 2 * std::atan(scene.height / (2 * scene.focal_px)) * 180 / M_PI;
    Camera second = first;
    second.eye = step;
    second.look_at = second.look_at + step;
    const std::vector<StereoEdit> edits = rounder(2, 3);
    const DisparityMap last = solved(before, edits).disparity;
    const Solution cold = solved(now, edits);
    const DisparityMap start = carried_map({before, first}, last, {now, second}, WarmStartParams{}, Exec{});
    const Solution warm = solved(now, edits, start);
    double away = 0, apart = 0;
    for (std::size_t i = 0; i < start.pixels.size(); ++i) {
        away = std::max(away, static_cast<double>(std::abs(start.pixels[i] - cold.disparity.pixels[i])));
        apart = std::max(apart,
                         static_cast<double>(std::abs(warm.disparity.pixels[i] - cold.disparity.pixels[i])));
    }
    fmt::print("start within {:.3f} px; {} iterations cold, {} warm; {:.4f} px apart\n", away,
               cold.report.iterations, warm.report.iterations, apart);
    EXPECT_LE(warm.report.iterations, cold.report.iterations);
    EXPECT_LT(apart, 0.05);
}

}  // namespace
}  // namespace obscura
