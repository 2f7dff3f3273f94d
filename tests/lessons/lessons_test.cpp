// The lessons' pictures: the same bits everywhere, known by hash, and committed copies that are not stale.
//
// A picture that changed on purpose: look at it, then for each N
//   obscura lesson N -o lessons/lesson_N.png --overwrite
// and take over the hash that this test prints; the commit says why.

#include "lessons/lessons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "hierarchy/build.h"
#include "lessons/aperture_panels.h"
#include "lessons/colour_sums.h"
#include "lessons/plane_fields.h"
#include "lessons/quad_fields.h"
#include "lessons/stereo_edits.h"
#include "lessons/stereo_panels.h"
#include "lessons/stereo_scene.h"
#include "lessons/tree_scene.h"
#include "optics/far_field_progress.h"

#include "stereo/disparity.h"
#include "stereo/thesis/cascade.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

constexpr std::array golden{"2b80deeaca7a1f64", "c1edc3458efbb83c", "415f018f5fd1ffd8", "6e230742d6859167",
                            "a622c68fa6df36e5", "463b045736f92eae", "bad0f240905ab4ef", "d69376fc7fe7dfe6",
                            "bcc896970de58f40", "eae4629398c439fa", "bb4e9518dd83ec37", "54a9d24dd16b3d21",
                            "294c403290cf5138", "ee2c1eec80a45ce7", "fc6848fda193cc44", "f264fb93641cd360",
                            "f1ef4a390dcd3930", "990754ca6ce5e483", "4b00908a3d75a2e1", "65b0b6aa9d951712",
                            "da0c432aa660d88e", "a13142e5c4a4a3f1", "8574ac3f051bac1b", "938d031c10fcd9a5",
                            "1148fdaa76ced024", "8a967255e0cf58da", "c1aedc7ed143a769"};

fs::path lessons_folder() {
    return fs::path(OBSCURA_SOURCE_DIR) / "lessons";
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in.good()) << file;
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
}

std::string hash_of(const Image<Rgb8>& picture) {
    return hash_text(Hasher().value(picture.width).value(picture.height).values(picture.pixels).state);
}

TEST(Lessons, HaveNumbersInOrderAndTheirOwnGoldenHash) {
    ASSERT_EQ(lessons().size(), golden.size());
    for (std::size_t i = 0; i < lessons().size(); ++i) {
        EXPECT_EQ(lessons()[i].number, static_cast<int>(i) + 1);
        EXPECT_FALSE(lessons()[i].title.empty());
        EXPECT_FALSE(lessons()[i].summary.empty());
    }
}

/// The scalar reference is slow at maps of 2048 texels: see LessonSevenTracesTheSameWithRef. Lesson 20, which
/// counts what kernels do, asks sse2 for it; and of its thousand suns the narrowest and the widest kernels
/// are enough, which ExactSoft.EveryIsaSaysTheSame compares with the reference and the others. Lesson 22 has
/// seventy million shadows, which ExactShadows' own tests compare. Lessons 19 and 21 take the longest: all
/// their sets are for the slow run.
bool drawn_with(const LessonInfo& lesson, Isa isa) {
    const bool slow = std::getenv("OBSCURA_SLOW_TESTS") != nullptr;
    if ((lesson.number == 19 || lesson.number == 21) && !slow) return isa == Isa::sse2 || isa == best_isa();
    // Nothing that lesson 27 calls has an instruction set.
    if (lesson.number == 27) return isa == Isa::ref || isa == best_isa();
    if (lesson.number == 20) return isa == Isa::sse2 || isa == best_isa();
    return isa != Isa::ref || (lesson.number != 7 && lesson.number != 22);
}

class LessonPictures : public testing::TestWithParam<int> {};

TEST_P(LessonPictures, AreTheSameOnEveryIsaAndThreadCount) {
    const LessonInfo& lesson = lessons()[static_cast<std::size_t>(GetParam() - 1)];
    for (const Isa isa : supported_isas()) {
        if (!drawn_with(lesson, isa)) continue;
        const int threads = isa == best_isa() ? 2 : 1;
        const Image<Rgb8> picture = draw_lesson(lesson.number, Exec{isa, threads});
        ASSERT_EQ(hash_of(picture), golden[static_cast<std::size_t>(lesson.number - 1)])
            << isa_name(isa) << ", threads: " << threads;
    }
}

INSTANTIATE_TEST_SUITE_P(Lessons, LessonPictures, testing::Range(1, static_cast<int>(golden.size()) + 1));

TEST(Lessons, LessonSevenTracesTheSameWithRef) {
    const std::pair<Mesh, int> maps[] = {{lesson_town(), 512}, {lesson_solids(), 256}};
    for (const auto& [mesh, texels] : maps) {
        std::vector<BuildSquare> expected;
        for (const Isa isa : supported_isas()) {
            SCOPED_TRACE(isa_name(isa));
            std::vector<BuildSquare> trace;
            BuildParams params;
            params.trace = &trace;
            BuildStats stats;
            build_shadow_tree(mesh, lesson_view(mesh, texels), params, Exec{isa, 1}, &stats);
            ASSERT_GT(stats.texels_rasterized, 10000);
            ASSERT_GT(trace.size(), 100u);
            if (expected.empty()) expected = trace;  // supported_isas() begins with ref
            ASSERT_EQ(trace.size(), expected.size());
            for (std::size_t i = 0; i < trace.size(); ++i) {
                ASSERT_EQ(trace[i].x0, expected[i].x0);
                ASSERT_EQ(trace[i].y0, expected[i].y0);
                ASSERT_EQ(trace[i].side, expected[i].side);
                ASSERT_EQ(trace[i].fate, expected[i].fate);
            }
        }
    }
}

/// Committed pictures have the hash that drawn ones have. Drawn again only to say where they differ.
TEST(Lessons, CommittedPicturesAreNotStale) {
    for (const LessonInfo& lesson : lessons()) {
        const fs::path file = lessons_folder() / fmt::format("lesson_{}.png", lesson.number);
        SCOPED_TRACE(file);
        const std::string png = bytes_of(file);
        EXPECT_LT(png.size(), (lesson.number < 10 ? 288u : 384u) * 1024u);  // patterns do not pack well
        const Image<Rgba8> decoded = decode_png(png, file.string());
        Image<Rgb8> committed(decoded.width, decoded.height);
        std::transform(decoded.pixels.begin(), decoded.pixels.end(), committed.pixels.begin(), [](Rgba8 c) {
            return Rgb8{c.r, c.g, c.b};
        });
        if (hash_of(committed) == golden[static_cast<std::size_t>(lesson.number - 1)]) continue;
        const Image<Rgb8> drawn = draw_lesson(lesson.number, {});
        ASSERT_EQ(committed.width, drawn.width);
        ASSERT_EQ(committed.height, drawn.height);
        for (int y = 0; y < drawn.height; ++y) {
            for (int x = 0; x < drawn.width; ++x)
                ASSERT_EQ(committed(x, y), drawn(x, y)) << "first differing pixel: " << x << ", " << y;
        }
        FAIL() << "the committed picture is what is drawn, but both are not what the hash says";
    }
}

TEST(Lessons, EachIsOneSourceFileOfLessThan200Lines) {
    std::size_t found = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(lessons_folder())) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("lesson_", 0) != 0 || entry.path().extension() != ".cpp") continue;
        ++found;
        const std::string text = bytes_of(entry.path());
        EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 200) << name;
    }
    EXPECT_EQ(found, lessons().size());
}

/// Lesson 9: half of all quads are as small as a texel, twice the resolution costs twice the quads, and the
/// small ones are signed: without the negative ones the mask is another.
TEST(Lessons, LessonNinesQuadsLieAlongTheEdge) {
    const QuadList quads = quads_of(binary_mask(ApertureKind::iris, 1024).view());
    const QuadList smallest = quads_where(quads, [&](std::size_t k) { return level_side(quads, k) == 1; });
    EXPECT_NEAR(static_cast<double>(smallest.size()) / static_cast<double>(quads.size()), 0.5, 0.05);
    const QuadList half = quads_of(binary_mask(ApertureKind::iris, 256).view());
    EXPECT_NEAR(static_cast<double>(quads.size()) / static_cast<double>(half.size()), 4.0, 1.0);

    const Image<float> mask = binary_mask(ApertureKind::iris, 64);
    const QuadList all = quads_of(mask.view());
    EXPECT_EQ(mask_of(all).pixels, mask.pixels);
    EXPECT_GT(count_negative(all), all.size() / 8);
    EXPECT_NE(mask_of(quads_where(all, [&](std::size_t k) { return all.weight[k] > 0; })).pixels,
              mask.pixels);
}

/// Lesson 10: every quadrupling of the quads, the largest first, brings the sum closer; all of them are what
/// the runs give; and the large ones alone are not enough.
TEST(Lessons, LessonTensQuadsAddUpToTheRuns) {
    const Image<float> mask = binary_mask(ApertureKind::iris, 128);
    const FrequencyGrid grid = centred_grid(128, 128, 1.0 / 256);
    const QuadList quads = largest_first(quads_of(mask.view()));
    const Field full = field_of_runs(mask.view(), grid, {});
    const double area = open_area(mask.view());
    double before = 1;
    for (const std::size_t count : {1u, 4u, 16u, 64u}) {
        const QuadList some = quads_where(quads, [&](std::size_t k) { return k < count; });
        const double error = largest_difference(field_of_quads(some, grid, {}), full) / area;
        EXPECT_LT(error, before) << count;
        EXPECT_GT(error, 1e-3) << count;
        before = error;
    }
    EXPECT_LT(largest_difference(field_of_quads(quads, grid, {}), full), 1e-6 * area);
}

/// Lesson 11: 4 sin^2(pi N / 2) behind the opening, 1 behind the disc, and the far field in the end, ever
/// closer.
TEST(Lessons, LessonElevensLightComesAndGoes) {
    const Aperture circle = full_aperture(ApertureKind::circle, 256);
    for (const double n : {0.5, 1.0, 2.0, 2.5, 3.0, 4.0}) {
        const OnAxis light = on_axis(circle, n, {});
        const double s = std::sin(0.5 * M_PI * n);
        EXPECT_NEAR(light.opening, 4 * s * s, 0.01) << n;
        EXPECT_NEAR(light.disc, 1, 0.01) << n;
    }
    const Aperture heptagon = full_aperture(ApertureKind::iris, 64);
    double before = 4;
    for (const double n : {0.8, 0.2, 0.05}) {
        const PlaneGrid plane = centred_plane(32, 2.4 / n * 64);
        const Image<float> near = near_field_intensity(heptagon, plane, at_fresnel_number(heptagon, n), {});
        const double error = share_of_peak(near, far_intensity(heptagon, plane, n, {}));
        EXPECT_LT(error, before / 8) << n;
        before = error;
    }
    EXPECT_LT(before, 1 / 400.0);
}

/// Lesson 12: more wavelengths are closer to all of them, and lookups at 1/W cost more than all that 60 may.
TEST(Lessons, LessonTwelvesColoursAddUpAndNeedFineLookups) {
    const Aperture aperture = full_aperture(ApertureKind::iris, 64);
    const double reach = 12.0 / 64;
    const FrequencyGrid grid = centred_grid(24, 24, 2 * reach / 24);
    const Image<Vec3f> all = colour_of(aperture, grid, 240, {});
    double before = 1;
    for (const int count : {1, 7, 15, 60}) {
        const double error = colour_error(colour_of(aperture, grid, count, {}), all, grid, 0, reach);
        EXPECT_LT(error, before) << count;
        before = error;
    }
    EXPECT_LT(before, 1e-3);
    const auto lookup_error = [&](double step, PowerInterpolation interpolation) {
        return colour_error(looked_up_colour(aperture, grid, 60, step, interpolation, {}), all, grid, 0,
                            reach);
    };
    EXPECT_GT(lookup_error(1.0 / 64, PowerInterpolation::linear), 0.1);
    EXPECT_GT(lookup_error(1.0 / 64, PowerInterpolation::cubic), 0.1);
    EXPECT_LT(lookup_error(1.0 / 128, PowerInterpolation::cubic), 0.06);
    EXPECT_LT(lookup_error(1.0 / 256, PowerInterpolation::cubic), 0.01);
}

/// Lesson 13: an eye's picture shows at X +- d/2 what the middle view has at X.
TEST(Lessons, LessonThirteensEyesFindTheMiddleViewsPoints) {
    constexpr int width = 360, height = 240;
    const StereoScene scene = stereo_scene();
    const SeenPicture seen = seen_from_middle(scene.mesh, scene.camera, width, height, {});
    const MiddleView view = stereo_view(scene, seen);
    const TwoWayDisparity eyes = two_way_disparity(view, view.disparity, {}, {});
    int alone = 0, found = 0, compared = 0;
    for (const Eye eye : {Eye::left, Eye::right}) {
        const SeenPicture moved = seen_by_eye(scene, unmoved(scene.mesh), eye, width, height, {});
        const double share = eye == Eye::left ? 0.5 : -0.5;
        for (int x = 0; x < width; ++x) {
            constexpr int y = 143;
            alone += (eye == Eye::left ? eyes.left : eyes.right).sight(x, y) == Sight::hidden ? 1 : 0;
            const double at = x + 0.5 + share * static_cast<double>(view.disparity(x, y));
            if (at < 0 || at >= width) continue;
            const int column = static_cast<int>(at);
            if (moved.depth_m(column, y) < 0.98f * seen.depth_m(x, y)) continue;  // something is before it
            ++compared;
            // Half a pixel of the eye's picture, in metres there.
            const double pixel_m = static_cast<double>(seen.depth_m(x, y)) / 329.7;
            const Vec3f apart = moved.position(column, y) - seen.position(x, y);
            found += std::fabs(static_cast<double>(apart.x)) < 0.75 * pixel_m ? 1 : 0;
        }
    }
    EXPECT_GT(alone, 20);
    EXPECT_GT(compared, 500);
    EXPECT_GT(found, compared * 97 / 100);
}

/// The scene of lessons 14 to 17, its ball rounder and its bust pushed back.
struct EditedScene {
    StereoScene scene = stereo_scene();
    MiddleView view = stereo_view(scene, 144, 96, {});
    DisparitySystem system(const EditParams& params, bool matched = false) const {
        std::vector<StereoEdit> edits = lesson_edits(view, 16);
        if (matched) edits.push_back(lesson_match(view));
        return lesson_system(scene, view, edits, params, {}).system;
    }
};

TEST(Lessons, LessonFourteensInversionsAreGoneOnceSolved) {
    const EditedScene s;
    const auto turned = [&](const DisparityMap& map) {
        return find_conflicts(s.view, map, {}, object_names(s.scene.mesh))
            .count(ConflictKind::depth_inversion);
    };
    EditParams params;
    params.interfaces = InterfaceGradients::edited;
    EXPECT_EQ(turned(s.view.disparity), 0);
    EXPECT_GT(turned(edited_disparity(s.view, lesson_edits(s.view, 16))), 50);
    EXPECT_EQ(turned(minimiser(s.system(params), {})), 0);
    params.reset_inversions = false;
    EXPECT_GT(turned(minimiser(s.system(params), {})), 50);
}

TEST(Lessons, LessonFifteensSweepsAreSlowAndThePrintedSignIsWrong) {
    EditParams edit;
    edit.epsilon = 2e-3;
    const DisparitySystem system = EditedScene().system(edit);
    const DisparityMap truth = minimiser(system, {});
    const auto error = [&](const DisparityMap& x) { return size_of(difference(x, truth)).rms_px; };
    const double before = error(system.start);
    EXPECT_GT(error(jacobi_sweeps(system, system.start, 100, {best_isa(), 1})), 0.5 * before);
    SolverParams params;
    const double corrected = error(solve_cascade(system, params, {best_isa(), 1}).disparity);
    params.printed_sign = true;
    EXPECT_LT(corrected, 0.5 * before);
    EXPECT_GT(error(solve_cascade(system, params, {best_isa(), 1}).disparity), 2 * corrected);
}

TEST(Lessons, LessonSixteensConjugateGradientsOvertakeCycles) {
    for (const bool matched : {false, true}) {
        const DisparitySystem system = EditedScene().system({}, matched);
        EXPECT_EQ(system.sets.size(), matched ? 1u : 0u);
        const DisparityMap truth = minimiser(system, {});
        const auto error = [&](SolverMethod method) {
            SolverParams params;
            params.method = method;
            params.max_iterations = 6;
            params.tolerance_max_px = params.tolerance_rms_px = 1e-9;
            return size_of(difference(solve(system, params, {best_isa(), 1}).disparity, truth)).rms_px;
        };
        EXPECT_LT(error(SolverMethod::vcycle), 0.05);
        EXPECT_LT(error(SolverMethod::multigrid), 0.1 * error(SolverMethod::vcycle));
    }
}

TEST(Lessons, LessonSeventeensTrianglesFollowTheMapOnceCut) {
    const EditedScene s;
    const DisparityMap solved = minimiser(s.system({}), {});
    ReprojectParams params;
    ReprojectStats cut, whole;
    moved_mesh(s.scene.mesh, s.scene.camera, s.view, solved, params, {}, cut);
    params.max_splits = 0;
    moved_mesh(s.scene.mesh, s.scene.camera, s.view, solved, params, {}, whole);
    EXPECT_GT(cut.within, 0.999);
    EXPECT_LT(whole.within, 0.9);
    EXPECT_EQ(whole.triangles_out, whole.triangles_in);
    EXPECT_LT(cut.triangles_out, 2 * cut.triangles_in);
}

/// Lesson 18: a disc that moves a little is a few quads and a few columns of the mask's, and the kept field
/// stays as near to one made anew as it says; one that turns everything over is not worth adding.
TEST(Lessons, LessonEighteensFieldIsKeptWhileThatIsCheaper) {
    const Image<float> iris = binary_mask(ApertureKind::iris, 128);
    const auto mask_at = [&](double x, double radius = 14) {
        return behind_disc_at(iris, {x, 44 + 0.5 * x}, radius);
    };
    FarFieldProgress progress;
    progress.grid = centred_grid(256, 256, 1.0 / 512);
    EXPECT_TRUE(update_far_field(progress, mask_at(40).view(), {}).refreshed);
    int anew = 0;
    for (int x = 41; x < 80; ++x) {
        const Image<float> mask = mask_at(x);
        EXPECT_LT(difference_quads(progress.mask.view(), mask.view()).size(),
                  quads_of(mask.view()).size() / 4);
        const ProgressReport report = update_far_field(progress, mask.view(), {});
        anew += report.refreshed ? 1 : 0;
        const double error = largest_difference(progress.field, field_anew(mask, progress.grid, {}));
        EXPECT_LE(error, 1e-6 * open_area(mask.view())) << x;
        EXPECT_EQ(report.refreshed, error == 0) << x;
    }
    EXPECT_GT(anew, 0);
    EXPECT_LT(anew, 6);
    update_far_field(progress, mask_at(40, 28).view(), {});
    const ProgressReport jump = update_far_field(progress, mask_at(72, 28).view(), {});
    EXPECT_TRUE(jump.refreshed);
    EXPECT_GT(jump.update_ms, jump.refresh_ms);
}

TEST(Lessons, AnUnknownNumberIsAUsageError) {
    for (const int number : {-1, 0, static_cast<int>(lessons().size()) + 1, 1000000}) {
        EXPECT_THROW(draw_lesson(number, {}), UsageError) << number;
    }
}

}  // namespace
}  // namespace obscura
