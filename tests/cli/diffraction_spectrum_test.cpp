// obscura diffraction --spectrum from outside: colours with known answers, modes, plans.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/scene_folder.h"

namespace obscura::test {
namespace {

TEST(DiffractionCommand, ColoursRunFromBlueInsideToRedOutside) {
    const Folder folder;
    const Outcome run = run_in(folder, {"diffraction", "circle", "--spectrum", "d65", "--mask-size", "128",
                                        "--size", "128", "--zoom", "16", "-o", "c.pfm", "-o", "c.png"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(folder.listing(), (std::vector<std::string>{"c.pfm", "c.png"}));
    const Image<Vec3f> colour = pfm<Vec3f>(folder / "c.pfm");
    // The first dark ring of blue lies inside that of red: on it blue is weaker than red, and at the centre
    // not.
    const Vec3f middle = colour(64, 64);
    EXPECT_GT(middle.z, 1.5f * middle.x) << "short waves are spread least";
    // Airy's first zero: 1.22 / (0.9 * 128) cycle per texel at 550 nm, 2048 steps a cycle: 21.7 pixels.
    const auto sum_over = [&](int from, int to) {
        Vec3f sum;
        for (int x = from; x < to; ++x)
            sum = sum + colour(64 + x, 64);
        return sum;
    };
    const Vec3f inner = sum_over(17, 20), outer = sum_over(22, 25);
    EXPECT_GT(inner.x, 1.3f * inner.z) << "where blue has its zero, red is left";
    EXPECT_GT(outer.z + outer.x, outer.y * 1.2f) << "where green has its zero, purple is left";
}

/// Mean difference of two pictures, as a share of the first one's mean.
double difference_of(const Image<Vec3f>& a, const Image<Vec3f>& b) {
    double sum = 0, difference = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        sum += std::fabs(static_cast<double>(a.pixels[i].y));
        difference += std::fabs(static_cast<double>(a.pixels[i].y - b.pixels[i].y));
    }
    return difference / sum;
}

TEST(DiffractionCommand, SpectrumModesShowNearlyTheSame) {
    const Folder folder;
    const auto colours = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"diffraction", "iris", "--mask-size", "128", "--size", "64",
                                     "--spectrum", "d65", "--overwrite", "-o", "c.pfm"});
        const Outcome run = run_in(folder, flags);
        EXPECT_EQ(run.code, 0) << run.err;
        return pfm<Vec3f>(folder / "c.pfm");
    };
    const Image<Vec3f> exact = colours({}), named = colours({"--spectrum-mode", "exact"});
    EXPECT_TRUE(exact == named) << "that is the default";
    for (const char* mode : {"full60", "batch4"}) {
        const double off = difference_of(exact, colours({"--spectrum-mode", mode}));
        EXPECT_GT(off, 0) << mode;
        EXPECT_LT(off, 0.05) << mode;
    }
    // The heuristic of near fields is right on the axis and in the open alone.
    const Image<Vec3f> near = colours({"--near", "100"}),
                       scaled = colours({"--near", "100", "--spectrum-mode", "scaled"});
    EXPECT_GT(difference_of(near, scaled), 0);
    EXPECT_LT(difference_of(near, scaled), 0.3);
}

TEST(DiffractionCommand, ThePlanCountsWavelengths) {
    const Folder folder;
    const auto plan = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"diffraction", "iris", "--plan"});
        return run_in(folder, flags).out;
    };
    const std::string far = plan({"--spectrum", "d65", "--wavelengths", "17"});
    EXPECT_NE(far.find("light     17 wavelengths, together about "), std::string::npos) << far;
    const std::string near = plan({"--spectrum", "equal", "--near", "5"});
    EXPECT_NE(near.find("light     40 wavelengths, together about "), std::string::npos) << near;
    EXPECT_EQ(plan({"--wavelength-nm", "500"}).find("light "), std::string::npos);
    const std::string batches = plan({"--spectrum", "d65", "--spectrum-mode", "batch4"});
    EXPECT_NE(batches.find("light     60 wavelengths, looked up in one pattern\n"), std::string::npos)
        << batches;
    const std::string scaled = plan({"--spectrum", "equal", "--near", "5", "--spectrum-mode", "scaled"});
    EXPECT_NE(scaled.find("light     40 wavelengths, scaled from one, together about "), std::string::npos)
        << scaled;
}

}  // namespace
}  // namespace obscura::test
