// Solutions at 1:2, 1:4 and 1:8 against the solution at full resolution, the paper's figure 4.6; and solves
// that start from the frame before.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/scene.h"
#include "stereo/edit.h"
#include "stereo/solver.h"
#include "stereo/upsample.h"
#include "stereo/warm_start.h"
#include "stereo_ray_scene.h"

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

Solution solved(const MiddleView& view, const std::vector<StereoEdit>& edits,
                const DisparityMap& initial = {}) {
    const EditedSystem edited = edited_system(view, edits, EditParams{}, names, Exec{});
    SolverParams params;
    params.tolerance_max_px = 0.01;
    params.tolerance_rms_px = 0.005;
    return solve(edited.system, params, Exec{}, initial);
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

// The reduced system is another one: an anchor's hold ends over a pixel or two at the object's outline, which
// are less than one pixel of 1:8. Upsampling must not add to what that costs.
TEST_P(ReducedSolve, IsNearTheFullOne) {
    const int n = GetParam();
    const MiddleView view = sphere_scene().view(), low = reduced(view, n);
    const std::vector<StereoEdit> edits = rounder(2, 3);
    const DisparityMap full = solved(view, edits).disparity;
    const DisparityMap small = solved(low, edits).disparity;
    const DisparityMap up = upsampled_solution(view, low, small, UpsampleParams{}, Exec{});
    Miss everywhere, at_samples, change;
    for (std::size_t i = 0; i < full.pixels.size(); ++i) {
        everywhere.add(up.pixels[i], full.pixels[i]);
        change.add(full.pixels[i], view.disparity.pixels[i]);
    }
    for (int y = 0; y < low.height(); ++y)
        for (int x = 0; x < low.width(); ++x)
            at_samples.add(small(x, y),
                           full(sampled_pixel(x, n, view.width()), sampled_pixel(y, n, view.height())));
    fmt::print(
        "1:{}: max {:.3f} rms {:.4f} px, at samples max {:.3f} rms {:.4f}; change {:.2f}, rms {:.2f} px\n", n,
        everywhere.worst, everywhere.rms(), at_samples.worst, at_samples.rms(), change.worst, change.rms());
    EXPECT_GT(change.worst, 3);
    EXPECT_LT(everywhere.rms(), 1.05 * at_samples.rms());
    EXPECT_LT(everywhere.rms(), 0.06 * n);
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
