// The terrain command on a small hill: its files, said again, and what is refused.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "app/cli/terrain_command.h"
#include "app/elevation/elevation.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/sun_path.h"
#include "hierarchy/terrain/far_file.h"
#include "raster/heights/height_sweep.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

class TerrainDay : public testing::Test {
  protected:
    void SetUp() override {
        std::ostringstream grid;
        grid << "ncols 40\nnrows 30\ncellsize 10\n";
        for (int y = 0; y < 30; ++y) {
            for (int x = 0; x < 40; ++x)
                grid << (std::abs(x - 20) < 3 && std::abs(y - 15) < 3 ? 80 : 0) + (x * y) % 3 << ' ';
        }
        write("hill.asc", grid.str());
        write("day.toml", scene("[[terrain]]\nid = \"t\"\nfile = \"hill.asc\"\n"));
        options.run.scene = folder / "day.toml";
        options.suns = 20;
        options.threshold = 4;
        options.tile_side = 64;
        options.far_shadows = folder / "day.far";
        options.hours = folder / "hours.pfm";
        options.picture = folder / "hours.png";
    }

    static std::string scene(const std::string& terrain) {
        return "format = 1\n[camera]\neye_m = [0, 90, 200]\nlook_at_m = [0, 0, 0]\n" + terrain +
               "[[light]]\nid = \"sun\"\ntype = \"sun\"\ntime = 2024-04-12T12:00:00Z\nlatitude_deg = 45\n"
               "longitude_deg = 0\n";
    }
    void write(const char* name, const std::string& text) const { std::ofstream(folder / name) << text; }
    std::string bytes(const fs::path& path) const {
        std::ostringstream text;
        text << std::ifstream(path, std::ios::binary).rdbuf();
        return text.str();
    }
    /// What it printed.
    std::string run() const {
        testing::internal::CaptureStdout();
        EXPECT_EQ(terrain_command(options), 0);
        return testing::internal::GetCapturedStdout();
    }
    template <class Error>
    std::string error() const {
        try {
            terrain_command(options);
        } catch (const Error& e) {
            return e.what();
        }
        return "no error";
    }

    TemporaryFolder temporary;
    const fs::path folder = temporary.path;
    TerrainDayOptions options;
};

TEST_F(TerrainDay, ShadowsAndHoursOfTheDay) {
    const std::string said = run();
    EXPECT_NE(said.find("far shadows of 20 suns in 2 units"), std::string::npos) << said;
    const FarFile file = read_far_file(options.far_shadows);
    const HeightField field = decode_elevation(bytes(folder / "hill.asc"), "hill.asc", {}, {}).field;
    ASSERT_EQ(file.day.suns.size(), 20u);
    EXPECT_EQ(file.day.grid.width, 40);

    // Hours are those of suns that reach a sample, by shadows that the file and near rays give.
    const auto hours = std::get<Image<float>>(decode_pfm(bytes(options.hours), "hours.pfm"));
    Image<float> sum(40, 30);
    bool shaded = false;
    for (int group = 0; group < file.day.groups(); ++group) {
        const std::vector<ShadowBits> maps = far_maps(file.day, group, {});
        for (std::size_t i = 0; i < maps.size(); ++i) {
            const FarSun& sun = file.day.suns[static_cast<std::size_t>(file.day.suns_of(group).first) + i];
            const ShadowBits dark = with_near_shadows(field, sun, maps[i], 4);
            for (int y = 0; y < 30; ++y) {
                for (int x = 0; x < 40; ++x) {
                    sum(x, y) += dark(x, y) ? 0.0f : static_cast<float>(sun.hours);
                    shaded |= dark(x, y);
                }
            }
        }
    }
    EXPECT_EQ(hours, sum);
    EXPECT_TRUE(shaded);
    const Image<Rgba8> picture = decode_png(bytes(options.picture), "hours.png");
    EXPECT_EQ(picture.width, 40);
    EXPECT_GE(picture.height, 30);
}

TEST_F(TerrainDay, TheSameDayAgainMakesNothing) {
    options.hours = options.picture = "";
    run();
    const auto time = fs::last_write_time(options.far_shadows);
    EXPECT_NE(run().find("are there already"), std::string::npos);
    EXPECT_EQ(fs::last_write_time(options.far_shadows), time);
    options.threshold = 5;
    EXPECT_NE(error<OutputError>().find("already exists"), std::string::npos);
    options.run.overwrite = true;
    EXPECT_NE(run().find("far shadows of 20 suns in 2 units"), std::string::npos);
    EXPECT_EQ(read_far_file(options.far_shadows).day.params.threshold, 5);
}

TEST_F(TerrainDay, DamagedFilesAreMadeAgain) {
    options.hours = options.picture = "";
    run();
    const std::string good = bytes(options.far_shadows);
    std::string bad = good;
    bad.back() = static_cast<char>(bad.back() ^ 1);
    write("day.far", bad);
    EXPECT_NE(run().find("far shadows of 20 suns in 2 units"), std::string::npos);
    EXPECT_EQ(bytes(options.far_shadows), good);
}

TEST_F(TerrainDay, WhatIsThereIsNotReplacedByAnotherResult) {
    options.hours = options.picture = "";
    options.far_shadows = folder / "d.pfm";
    run();
    const std::string far = bytes(options.far_shadows);
    options.hours = options.far_shadows;
    options.run.overwrite = true;
    EXPECT_NE(error<UsageError>().find("would be written twice"), std::string::npos);
    EXPECT_EQ(bytes(options.far_shadows), far);
}

TEST_F(TerrainDay, QuietIsQuiet) {
    options.run.quiet = true;
    EXPECT_EQ(run(), "");
    options.hours = options.picture = "";
    EXPECT_EQ(run(), "");
}

TEST_F(TerrainDay, WhatIsRefused) {
    write("bare.toml", scene(""));
    options.run.scene = folder / "bare.toml";
    EXPECT_NE(error<InputError>().find("has no [[terrain]]"), std::string::npos);
    options.run.scene = folder / "day.toml";
    options.terrain = "T";
    EXPECT_NE(error<UsageError>().find("no terrain 'T'"), std::string::npos);
    options.terrain = "";
    options.run.overrides = {"limits.memory_mib=1", "terrain.t.file=large.asc"};
    const auto write_large = [&](int side) {
        std::string large = fmt::format("ncols {}\nnrows {}\ncellsize 1\n", side, side);
        for (int i = 0; i < side * side; ++i)
            large += "1 ";
        write("large.asc", large);
    };
    write_large(250);
    EXPECT_NE(error<LimitError>().find("a day over 250 x 250 samples takes 1 MiB"), std::string::npos);
    write_large(300);
    EXPECT_NE(error<LimitError>().find("an eighth of limits.memory_mib"), std::string::npos);
    options.run.overrides = {};
    options.far_shadows = options.hours = options.picture = "";
    EXPECT_NE(error<UsageError>().find("nothing to make"), std::string::npos);
}

}  // namespace
}  // namespace obscura
