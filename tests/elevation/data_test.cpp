// Real ground: every bit of the sweep is the march's.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/elevation/elevation.h"
#include "core/sun_path.h"
#include "raster/heights/height_march.h"
#include "raster/heights/height_sweep.h"
#include "tests/core/shared_folder.h"

namespace obscura {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

std::optional<HeightField> real_ground(const std::string& name) {
    const std::filesystem::path folder = shared_folder("data/terrain");
    if (!std::filesystem::exists(folder / (name + ".pgm"))) return {};
    return decode_elevation(bytes_of(folder / (name + ".pgm")), name + ".pgm",
                            bytes_of(folder / (name + ".json")), {})
        .field;
}

bool all_cases() {
    return std::getenv("OBSCURA_SLOW_TESTS") != nullptr;
}

/// A day of 13 hours and 158 suns, every `step`-th of them.
std::vector<HeightSun> day_of(const HeightField& field, int step) {
    SunPath day;
    day.year = 2024, day.month = 4, day.day = 12, day.latitude_deg = 38, day.steps = 158;
    std::vector<HeightSun> suns;
    const std::vector<SunStep> steps = sun_steps_by_travel(day, 0.5);
    EXPECT_EQ(steps.size(), 158u);
    for (std::size_t i = 0; i < steps.size(); i += static_cast<std::size_t>(step))
        suns.push_back(height_sun(field, steps[i].azimuth_deg, steps[i].elevation_deg));
    return suns;
}

TEST(TerrainData, JacksborosSweepIsItsMarch) {
    const auto field = real_ground("jacksboro");
    if (!field)
        GTEST_SKIP() << "SKIPPED: no elevation model here: "
                     << "jacksboro";
    SweepStats stats;
    std::int64_t dark = 0;
    for (const HeightSun& sun : day_of(*field, all_cases() ? 1 : 40)) {
        constexpr int thresholds[] = {0, 1, 6};
        const auto maps = sweep_shadows(*field, sun, thresholds, &stats);
        for (std::size_t i = 0; i < std::size(thresholds); ++i)
            ASSERT_EQ(maps[i], march_shadows(*field, sun, {.first = thresholds[i]}));
        dark += count_of(maps[0]);
    }
    EXPECT_GT(dark, stats.samples / 3 / 20);
    EXPECT_LT(stats.marched, stats.samples / 10000) << "real ground has hardly any ties";
}

/// Of larger models some suns, and of these every sample of some lines.
TEST(TerrainData, OtherGroundOnSamples) {
    for (const char* name : {"baltoro_srtm3", "etna_srtm3", "sierra_30m", "greenriver_lidar_1m"}) {
        const auto field = real_ground(name);
        if (!field) GTEST_SKIP() << "SKIPPED: no elevation model here: " << name;
        std::int64_t compared = 0, dark = 0;
        for (const HeightSun& sun : day_of(*field, all_cases() ? 8 : 79)) {
            constexpr int thresholds[] = {0, 16};
            const auto maps = sweep_shadows(*field, sun, thresholds);
            const SunView view = sun_view(*field, sun);
            for (int line = 7; line < view.lines; line += 101) {
                for (int row = 0; row < view.rows; ++row) {
                    const GridPlace at = place_of(*field, sun, line, row);
                    ASSERT_EQ(maps[0](at.x, at.y), sun_hidden(view, line, row))
                        << name << " " << at.x << " " << at.y;
                    ASSERT_EQ(maps[1](at.x, at.y), sun_hidden(view, line, row, {.first = 16})) << name;
                    ++compared;
                    dark += maps[0](at.x, at.y);
                }
            }
        }
        EXPECT_GT(compared, 4000);
        EXPECT_GT(dark, 10) << name;
    }
}

}  // namespace
}  // namespace obscura
