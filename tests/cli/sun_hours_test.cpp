// obscura render --aov sun_hours from outside: numbers, the picture with its scale, what is said.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/scene_folder.h"
#include "tests/report/json_reader.h"

namespace obscura::test {
namespace {

/// A folder with the small scene in it, under a sun called "day" with these keys.
struct SunnyFolder : Folder {
    explicit SunnyFolder(const std::string& keys) {
        write("s.toml", std::string(small_scene) + "[[light]]\nid = \"day\"\ntype = \"sun\"\n" + keys);
    }
};

TEST(SunHoursOutside, AreNumbersAndAPictureWithItsScale) {
    const SunnyFolder folder(
        "latitude_deg = 48.2\nlongitude_deg = 16.37\n"
        "time = 2026-06-21T12:00:00+02:00\nsteps = 24\n");
    const Names line{"render", "s.toml", "--size", "200x150", "--aov", "sun_hours"};
    const auto with = [&](Names more) {
        more.insert(more.begin(), line.begin(), line.end());
        return more;
    };
    const Outcome numbers = run_in(folder, with({"-o", "n.png", "--stats-json", "s.json"}));
    ASSERT_EQ(numbers.code, 0) << numbers.err;
    EXPECT_NE(
        numbers.err.find("sun hours: light 'day', 2026-06-21, 00:00 to 24:00 in 24 steps of 60 min: up 04:"),
        std::string::npos)
        << numbers.err;
    const std::string stats = file_text(folder / "s.json");
    const Json report = JsonReader(stats).document(), hours = report.at("frames").list.at(0).at("sun_hours");
    EXPECT_EQ(hours.at("light").text, "day");
    EXPECT_EQ(hours.at("date").text, "2026-06-21");
    EXPECT_EQ(hours.at("steps").number, 24);
    EXPECT_NEAR(hours.at("sunlit_h").number, 16.0, 0.2);
    const Image<float> pfm_hours = pfm(folder / "n.sun_hours.pfm");
    EXPECT_TRUE(std::isnan(pfm_hours(0, 0)));
    EXPECT_GT(pfm_hours(100, 75), 0);
    EXPECT_LE(static_cast<double>(pfm_hours(100, 75)), hours.at("sunlit_h").number + 1e-6);

    ASSERT_EQ(run_in(folder, with({"-q", "-o", "m.png", "--aov-format", "png"})).code, 0);
    const Image<Rgba8> picture = png(folder / "m.sun_hours.png");
    EXPECT_EQ(picture.width, 200);
    EXPECT_GT(picture.height, 150 + 20);
    EXPECT_EQ(picture(0, 0), (Rgba8{205, 205, 205, 255}));
    // The bar runs from dark to light.
    const auto light_at = [&](int x) { return picture(x, 150 + 12).g; };
    EXPECT_LT(light_at(20), 40);
    EXPECT_GT(light_at(170), 200);
    EXPECT_LT(light_at(60), light_at(120));
    // Too narrow for numbers: the picture alone.
    ASSERT_EQ(
        run_in(folder, {"render", "s.toml", "-q", "-o", "k.png", "--aov", "sun_hours", "--aov-format", "png"})
            .code,
        0);
    EXPECT_EQ(png(folder / "k.sun_hours.png").height, 48);
}

TEST(SunHoursOutside, APolarNightIsSaidAndHasNoHours) {
    const SunnyFolder folder(
        "latitude_deg = 70\nlongitude_deg = 20\n"
        "time = 2026-12-21T12:00:00+01:00\n");
    const Outcome run =
        run_in(folder, {"render", "s.toml", "-o", "n.png", "--size", "200x150", "--aov", "sun_hours"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find(
                  "light 'day' does not rise at latitude 70 on 2026-12-21 between 00:00 and 24:00: there are "
                  "no hours of sun"),
              std::string::npos)
        << run.err;
    EXPECT_EQ(pfm(folder / "n.sun_hours.pfm")(100, 75), 0.0f);
    EXPECT_EQ(run_in(folder, {"render", "s.toml", "-q", "-o", "m.png", "--size", "200x150", "--aov",
                              "sun_hours", "--aov-format", "png"})
                  .code,
              0);
}

}  // namespace
}  // namespace obscura::test
