// Skies have the same bits on any number of threads, with any compiler and in any build.

#include <gtest/gtest.h>

#include "core/hash.h"
#include "core/sky/sky_model.h"

namespace obscura {
namespace {

std::string hash_of(const SkyModel& sky, const Exec& exec) {
    Hasher hasher;
    for (const SkyDirection& d : sky_directions(sky, 64, SkyImportance::radiance, exec))
        hasher.value(d.direction).value(d.irradiance_w_m2);
    if (const auto* clear = std::get_if<ClearSky>(&sky))
        hasher.values(clear->molecules.pixels).values(clear->aerosol.pixels).values(clear->multiple.pixels);
    return hash_text(hasher.state);
}

std::string clear_hash(double elevation_deg, int threads) {
    Exec exec;
    exec.threads = threads;
    ClearAirParams params;
    params.ground_albedo = {0.3, 0.2, 0.1};
    return hash_of(clear_sky(clear_air(params, exec), 222, elevation_deg, exec), exec);
}

TEST(SameSky, OnAnyNumberOfThreads) {
    EXPECT_EQ(clear_hash(12.5, 1), clear_hash(12.5, 3));
}

// These change when a formula or a table's size does, and with nothing else.
TEST(SameSky, InEveryBuild) {
    EXPECT_EQ(clear_hash(37.5, 0), "0cffae5549f7a0f9");
    EXPECT_EQ(clear_hash(-5.25, 0), "e829671b0c2cb02a");
    EXPECT_EQ(hash_of(overcast_sky(-3, {5, 5, 5}, {0.2, 0.2, 0.2}), {}), "419b42272ae1f3f0");
    Image<Vec3f> image(37 * 2, 37);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            image(x, y) = {static_cast<float>(x % 7), static_cast<float>(y % 5),
                           static_cast<float>((x * y) % 11)};
    }
    ImageSky sky;
    sky.pixels = image;
    EXPECT_EQ(hash_of(sky, {}), "6303b725f764b4b5");
}

}  // namespace
}  // namespace obscura
