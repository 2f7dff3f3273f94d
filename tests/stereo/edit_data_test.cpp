// Edits of a measured scene: Middlebury's cones (Scharstein and Szeliski, CVPR 2003). cones_disp2 is of the
// left picture, codes are quarter pixels, 0 is unknown.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/pnm.h"
#include "stereo/edit.h"
#include "stereo/solver/solver.h"
#include "tests/core/shared_folder.h"

namespace obscura {
namespace {

const std::filesystem::path file = shared_folder("data/stereo/cones_disp2.pgm");
constexpr std::uint32_t mask_object = 4;

/// The screen at 40 pixels. Objects: four bands of disparity, and the wooden mask by a mask painted by hand,
/// an ellipse that keeps to its disparities.
MiddleView cones() {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const GreyCodes grey = decode_pnm(bytes, "cones_disp2.pgm");
    MiddleView view;
    view.picture_width = grey.codes.width;
    view.picture_height = grey.codes.height;
    view.disparity = DisparityMap(grey.codes.width, grey.codes.height, -40);
    view.object = Image<std::uint32_t>(grey.codes.width, grey.codes.height, nothing_seen);
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            const double d = grey.codes(x, y) / 4.0;
            if (d == 0) continue;
            view.disparity(x, y) = static_cast<float>(d - 40);
            view.object(x, y) = d < 27 ? 0 : d < 33 ? 1 : d < 43 ? 2 : 3;
            const double u = (x - 318) / 84.0, v = (y - 222) / 112.0;
            if (u * u + v * v < 1 && d > 31 && d < 43) view.object(x, y) = mask_object;
        }
    }
    return view;
}

TEST(StereoEditData, AMeasuredFaceIsMadeRounderAndBroughtNearer) {
    SKIP_WITHOUT(file);
    const MiddleView view = cones();
    const EditTarget face{{mask_object}, {}};
    const std::vector<StereoEdit> edits = {{"round", 1, RoundnessEdit{face, 3}},
                                           {"nearer", 0.2, AnchorEdit{face, 6}},
                                           {"back stays", 1, AnchorEdit{{{0}, {}}, 0}}};
    EditParams params;
    params.comfort = {16, -24};
    const std::vector<std::string> names = {"wall", "trellis", "middle", "front", "face"};
    const EditedSystem edited = edited_system(view, edits, params, names);
    const Solution solution = solve(edited.system, {}, {});
    ASSERT_TRUE(solution.report.converged);

    // Least squares of the new disparity by the old one on the face: the slope is the roundness it got.
    double n = 0, sum_d = 0, sum_x = 0, dd = 0, dx = 0;
    std::int64_t unknown = 0;
    for (std::size_t i = 0; i < view.object.pixels.size(); ++i) {
        const auto d = static_cast<double>(view.disparity.pixels[i]);
        const auto x = static_cast<double>(solution.disparity.pixels[i]);
        EXPECT_TRUE(std::isfinite(x));
        if (view.object.pixels[i] == nothing_seen) {
            EXPECT_EQ(solution.disparity.pixels[i], -40);
            EXPECT_EQ(edited.conflict_pixels.pixels[i], 0);
            ++unknown;
        }
        if (view.object.pixels[i] != mask_object) continue;
        n += 1, sum_d += d, sum_x += x, dd += d * d, dx += d * x;
    }
    EXPECT_GT(unknown, 1000);
    EXPECT_GT(n, 15000);
    const double slope = (dx - sum_d * sum_x / n) / (dd - sum_d * sum_d / n);
    RecordProperty("roundness", std::to_string(slope));
    EXPECT_GT(slope, 2);
    EXPECT_LE(slope, 3.1);
    EXPECT_NEAR((sum_x - sum_d) / n, 6, 1.5);

    // D~ sinks the face's rim into what is behind it; the solution does so less.
    const ConflictLimits limits{params.comfort, 0.5};
    const Conflicts before = find_conflicts(view, edited_disparity(view, edits), limits, names);
    const Conflicts after = find_conflicts(view, solution.disparity, limits, names);
    const auto inversions = [](const Conflicts& c) { return c.count(ConflictKind::depth_inversion); };
    EXPECT_GT(inversions(before), 50);
    EXPECT_LT(4 * inversions(after), inversions(before));
}

TEST(StereoEditData, AnIslandOfOnePixelIsSolvedLikeAnyOther) {
    // Measured maps have known pixels amid unknown ones.
    for (const int width : {64, 450}) {
        Image<std::uint8_t> valid(width, 60, 1);
        for (int y = 20; y < 50; ++y)
            for (int x = 20; x < 50; ++x)
                valid(x, y) = x == 30 && y == 30 ? 1 : 0;
        DisparitySystem s = unedited_system(DisparityMap(width, 60, 3), valid);
        std::fill(s.anchor_weight.pixels.begin(), s.anchor_weight.pixels.begin() + width, 1.0f);
        std::fill(s.anchor_value.pixels.begin(), s.anchor_value.pixels.end(), 5.0f);
        const Solution solution = solve(s, {}, {});
        EXPECT_TRUE(solution.report.converged);
        EXPECT_NEAR(solution.disparity(30, 30), 3, 0.01);
        EXPECT_NEAR(solution.disparity(5, 0), 5, 0.1);
    }
}

}  // namespace
}  // namespace obscura
