// A disc that moves over a heptagon: every frame near the truth, within the bound that it states, and fresh
// where it says so.

#include "optics/far_field_progress.h"
#include "optics/aperture_shapes.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/optics/far_field_reference.h"

namespace obscura {
namespace {

using namespace far_field_reference;

/// A heptagon partly hidden by a disc at (x, 10) from the centre.
Image<float> occluded(int size, double disc_x) {
    const double r = 0.4 * size;
    return mask_where(size, size, [&](double x, double y) {
        return in_heptagon(x, y, r) && std::hypot(x - disc_x, y - 10) > 0.15 * size;
    });
}

Field fresh(const Image<float>& mask, const FrequencyGrid& grid) {
    Aperture aperture;
    aperture.mask = mask;
    Field field = field_for(grid);
    far_field_into(aperture, grid, {}, target_of(field), Exec{});
    return field;
}

TEST(FarFieldProgress, FollowsAMovingDiscWithinItsBound) {
    const FrequencyGrid grid = half_grid(256, 256, 1.0 / 256);
    FarFieldProgress progress;
    progress.grid = grid;
    int added = 0, refreshed = 0;
    for (int frame = 0; frame < 60; ++frame) {
        const Image<float> mask = occluded(128, -40 + 0.25 * frame);
        const ProgressReport report = update_far_field(progress, mask.view(), Exec{});
        ASSERT_EQ(progress.mask, mask);
        const double error = worst_error(progress.field, mask.view(), grid, open_area(mask.view()), 20);
        ASSERT_LE(error, report.error_bound) << "frame " << frame << ": " << report.reason;
        ASSERT_LE(report.error_bound, progress.tolerance);
        if (report.refreshed) {
            EXPECT_EQ(report.reason.find("computed anew"), 0u) << report.reason;
            EXPECT_EQ(progress.field.re, fresh(mask, grid).re);
            EXPECT_EQ(progress.field.im, fresh(mask, grid).im);
            ++refreshed;
        } else {
            ++added;
        }
    }
    // The first frame, and whenever the bound has run up.
    EXPECT_GE(refreshed, 2);
    EXPECT_LE(refreshed, 12);
    EXPECT_GE(added, 40);
}

TEST(FarFieldProgress, SaysWhatItDidAndWhy) {
    FarFieldProgress progress;
    progress.grid = half_grid(256, 256, 1.0 / 256);
    Image<float> mask = occluded(128, -20);
    ProgressReport report = update_far_field(progress, mask.view(), Exec{});
    EXPECT_TRUE(report.refreshed);
    EXPECT_EQ(report.reason, "computed anew: the first of its size and grid");

    const Field before = progress.field;
    report = update_far_field(progress, mask.view(), Exec{});
    EXPECT_FALSE(report.refreshed);
    EXPECT_EQ(report.reason, "kept: nothing changed");
    EXPECT_EQ(progress.field.re, before.re);

    mask(64, 64) = 1.0f - mask(64, 64);
    report = update_far_field(progress, mask.view(), Exec{});
    EXPECT_FALSE(report.refreshed);
    EXPECT_EQ(report.terms, 1);
    EXPECT_LT(report.update_ms, report.refresh_ms);

    // Everything changes: too many columns.
    const Image<float> noise = odd_masks()[4].mask;
    for (int y = 0; y < noise.height; ++y) {
        for (int x = 0; x < noise.width; ++x)
            mask(x + 40, y + 40) = noise(x, y);
    }
    report = update_far_field(progress, mask.view(), Exec{});
    EXPECT_TRUE(report.refreshed);
    EXPECT_NE(report.reason.find("computed anew"), std::string::npos);

    progress.tolerance = 1e-6;
    mask(64, 64) = 0.5f;
    report = update_far_field(progress, mask.view(), Exec{});
    EXPECT_TRUE(report.refreshed);
    EXPECT_NE(report.reason.find("error could reach"), std::string::npos) << report.reason;

    report = update_far_field(progress, Image<float>(30, 50, 1.0f).view(), Exec{});
    EXPECT_TRUE(report.refreshed);
    report = update_far_field(progress, Image<float>(30, 50).view(), Exec{});
    EXPECT_EQ(progress.field.re, Image<float>(129, 256));
}

TEST(FarFieldProgress, SameBitsEverywhere) {
    const auto run = [](const Exec& exec) {
        FarFieldProgress progress;
        progress.grid = centred_grid(90, 70, 1.0 / 128);
        for (int frame = 0; frame < 5; ++frame)
            update_far_field(progress, occluded(100, -20 + frame).view(), exec);
        return progress.field;
    };
    const Field first = run({Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        const Field other = run({isa, 2});
        EXPECT_EQ(first.re, other.re) << isa_name(isa);
        EXPECT_EQ(first.im, other.im) << isa_name(isa);
    }
}

TEST(FarFieldProgress, AnotherGridStartsAnew) {
    ApertureShape shape;
    const Aperture iris = make_aperture(shape, 64, 1.0);
    FarFieldProgress progress;
    for (const double step : {1.0 / 64, 1.0 / 256}) {
        progress.grid = centred_grid(32, 32, step);
        EXPECT_TRUE(update_far_field(progress, iris.mask.view(), {}).refreshed);
        FarFieldParams params;
        params.symmetry = false;
        EXPECT_EQ(progress.field.re, far_field(iris, progress.grid, params, {}).re);
    }
    EXPECT_FALSE(update_far_field(progress, iris.mask.view(), {}).refreshed);
}

}  // namespace
}  // namespace obscura
