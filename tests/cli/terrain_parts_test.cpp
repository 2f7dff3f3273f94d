// Days made in parts and after interruptions have the bytes of one run; what does not belong together is
// refused; pictures of hours; targets that cannot be written are told before the work.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

#include "core/image_io.h"
#include "hierarchy/terrain/far_file.h"
#include "hierarchy/terrain/far_parts.h"
#include "tests/cli/program.h"

namespace obscura {
namespace {

using namespace test;

constexpr const char* day_scene =
    "format = 1\n[camera]\neye_m = [0, 90, 200]\nlook_at_m = [0, 0, 0]\n[[terrain]]\nid = \"t\"\n"
    "file = \"hill.asc\"\n[[light]]\nid = \"sun\"\ntype = \"sun\"\ntime = 2024-04-12T12:00:00Z\n"
    "latitude_deg = 45\nlongitude_deg = 0\n";

/// A hill over rough ground.
std::string grid(int width, int height) {
    std::string text =
        "ncols " + std::to_string(width) + "\nnrows " + std::to_string(height) + "\ncellsize 10\n";
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int hill = std::abs(x - width / 2) < 3 && std::abs(y - height / 2) < 3 ? 80 : 0;
            text += std::to_string(hill + (x * y + x / 7 * 13) % 9) + " ";
        }
    }
    return text;
}

struct Day {
    Folder folder;
    std::vector<std::string> base;
    explicit Day(int width = 40, int height = 30, const char* suns = "50") {
        folder.write("day.toml", day_scene);
        folder.write("hill.asc", grid(width, height));
        base = {"terrain", "day.toml", "--suns", suns, "--threshold", "4", "--tile-side", "64", "-t", "1"};
    }
    Outcome run(const std::vector<std::string>& more) const {
        std::vector<std::string> all = base;
        all.insert(all.end(), more.begin(), more.end());
        return run_in(folder, all);
    }
    std::string bytes(const char* name) const { return file_text(folder / name); }
};

TEST(TerrainParts, MergedTheyAreOneRun) {
    const Day day;
    ASSERT_EQ(day.run({"-o", "whole.far"}).code, 0);
    for (const char* part : {"1", "2", "3"})
        ASSERT_EQ(
            day.run({"-o", std::string("part") + part + ".far", "--tile", std::string(part) + "/3"}).code, 0);
    EXPECT_EQ(missing_groups(read_far_file(day.folder / "part2.far").day), (std::vector<int>{0, 2, 3}));
    const Outcome merged =
        day.run({"-o", "merged.far", "--merge", "part3.far", "--merge", "part1.far", "--merge", "part2.far"});
    EXPECT_EQ(merged.code, 0) << merged.err;
    EXPECT_EQ(day.bytes("merged.far"), day.bytes("whole.far"));

    const Outcome gap = day.run({"-o", "gap.far", "--merge", "part1.far", "--merge", "part3.far"});
    EXPECT_EQ(gap.code, 3);
    EXPECT_NE(gap.err.find("gap.far: cannot be merged: suns 17 to 32 are in none of the parts"),
              std::string::npos)
        << gap.err;
    Day other = Day(41, 30);
    ASSERT_EQ(other.run({"-o", "other.far"}).code, 0);
    std::filesystem::copy(other.folder / "other.far", day.folder / "other.far");
    const Outcome stranger = day.run({"-o", "gap.far", "--merge", "part1.far", "--merge", "other.far"});
    EXPECT_EQ(stranger.code, 3);
    EXPECT_NE(stranger.err.find("other.far: is of another day"), std::string::npos) << stranger.err;
    EXPECT_FALSE(std::filesystem::exists(day.folder / "gap.far"));
}

/// Runs until something is in the partial file, and is ended by the signal. Code 0 where it was done before.
Outcome interrupted(const Day& day, int signal) {
    std::vector<std::string> arguments = day.base;
    arguments.insert(arguments.end(), {"-o", "day.far"});
    Program program(arguments);
    program.folder = day.folder.path;
    program.start();
    while (program.running() && !std::filesystem::exists(day.folder / "day.far.partial"))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.send(signal);
    return program.wait();
}

void expect_goes_on(const Day& day) {
    const FarDay left = read_far_file(day.folder / "day.far.partial").day;
    const std::size_t missing = missing_groups(left).size();
    EXPECT_GT(missing, 0u);
    EXPECT_LT(missing, static_cast<std::size_t>(left.groups()));
    EXPECT_EQ(day.run({"-o", "day.far"}).code, 0);
    EXPECT_FALSE(std::filesystem::exists(day.folder / "day.far.partial"));
    ASSERT_EQ(day.run({"-o", "whole.far"}).code, 0);
    EXPECT_EQ(day.bytes("day.far"), day.bytes("whole.far"));
}

TEST(TerrainParts, KilledInTheMiddleItGoesOnFromThere) {
    for (const int signal : {SIGTERM, SIGKILL}) {
        // Where this test does not come to run between the first unit and the last, there are more of them.
        bool killed = false;
        for (const char* suns : {"400", "1600", "4096"}) {
            const Day day(130, 120, suns);
            const Outcome outcome = interrupted(day, signal);
            if (outcome.code == 0) continue;
            ASSERT_TRUE(outcome.code == 128 + signal || outcome.code == 1000 + signal)
                << outcome.code << outcome.err;
            ASSERT_FALSE(std::filesystem::exists(day.folder / "day.far"));
            expect_goes_on(day);
            killed = true;
            break;
        }
        EXPECT_TRUE(killed) << signal;
    }
}

TEST(TerrainParts, APartialFileOfAnotherDayIsRefused) {
    const Day day, other(41, 30);
    ASSERT_EQ(other.run({"-o", "o.far"}).code, 0);
    std::filesystem::copy(other.folder / "o.far", day.folder / "day.far.partial");
    const Outcome refused = day.run({"-o", "day.far"});
    EXPECT_EQ(refused.code, 3);
    EXPECT_NE(refused.err.find("day.far.partial: is what an interrupted run has left, of another day"),
              std::string::npos)
        << refused.err;
    EXPECT_EQ(day.run({"-o", "day.far", "--overwrite"}).code, 0);
    EXPECT_FALSE(std::filesystem::exists(day.folder / "day.far.partial"));
}

TEST(TerrainParts, APartIsNoDayForAScene) {
    const Day day;
    ASSERT_EQ(day.run({"-o", "part.far", "--tile", "2/4"}).code, 0);
    day.folder.write("picture.toml", std::string(day_scene) + "[shadow.sun]\nday_file = \"part.far\"\n");
    const Outcome check = run_in(day.folder, {"check", "picture.toml"});
    EXPECT_EQ(check.code, 3);
    EXPECT_NE(check.err.find("suns 1 to 16 and 33 to 50 are missing"), std::string::npos) << check.err;
}

TEST(TerrainParts, ShadowsAtHours) {
    const Day day;
    ASSERT_EQ(day.run({"--shadows", "s_####.png"}).code, 0);
    // From six to eighteen hours UTC at longitude 0 in April.
    int pictures = 0;
    for (const std::string& name : day.folder.listing())
        pictures += name.starts_with("s_") ? 1 : 0;
    EXPECT_EQ(pictures, 13);
    const Image<Rgba8> morning = decode_png(day.bytes("s_0800.png"), "s");
    ASSERT_EQ(morning.width, 40);
    // The hill's shadow lies west of it, and there is none to the east.
    EXPECT_EQ(morning(10, 14).r, 0);
    EXPECT_EQ(morning(26, 15).r, 255);
    ASSERT_EQ(day.run({"--shadows", "t_####.png", "--shadow-time", "08:00", "--shadow-time", "17:30:20",
                       "--angular-diameter", "4"})
                  .code,
              0);
    const Image<Rgba8> soft = decode_png(day.bytes("t_0800.png"), "t");
    int grey = 0;
    for (const Rgba8 p : soft.pixels)
        grey += p.r > 0 && p.r < 255;
    EXPECT_GT(grey, 20);
    EXPECT_TRUE(std::filesystem::exists(day.folder / "t_173020.png"));
    EXPECT_EQ(day.run({"--shadows", "u_####.png", "--shadow-time", "23:00"}).code, 2);
    EXPECT_EQ(day.run({"--shadows", "u.png"}).code, 2);
    EXPECT_EQ(day.run({"--shadow-time", "08:00", "-o", "x.far"}).code, 2);
    EXPECT_EQ(day.run({"--curvature", "-o", "x.far"}).code, 2);
    // Flags that would do nothing.
    EXPECT_EQ(day.run({"--refraction", "0.2", "--hours", "x.pfm"}).code, 2);
    EXPECT_EQ(day.run({"--curvature", "--list", "x.csv"}).code, 2);
    EXPECT_EQ(day.run({"--angular-diameter", "0.53", "-o", "x.far"}).code, 2);
}

TEST(TerrainParts, FramesAtTheTimesOfTheListHaveTheirSuns) {
    const Day day;
    ASSERT_EQ(day.run({"-o", "day.far", "--list", "suns.csv"}).code, 0);
    std::istringstream list(day.bytes("suns.csv"));
    std::vector<std::string> times;
    for (std::string line; std::getline(list, line);)
        times.push_back(line.substr(0, line.find(',')));
    ASSERT_EQ(times.size(), 51u);
    EXPECT_EQ(times[0], "time");
    const auto scene = [&](const char* range) {
        return std::string(day_scene) +
               "[shadow.sun]\nday_file = \"day.far\"\n[render]\nsize_px = [32, 24]\n[frames]\nrange = \"" +
               range + "\"\n[[frames.light]]\nframe = 1\nid = \"sun\"\ntime = " + times[7] +
               "\n[[frames.light]]\nframe = 3\nid = \"sun\"\ntime = " + times[30] + "\n";
    };
    day.folder.write("lapse.toml", scene("1-3x2"));
    const Outcome check = run_in(day.folder, {"check", "lapse.toml"});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_NE(check.out.find("day: 'day_file' has the suns of a day"), std::string::npos) << check.out;
    EXPECT_EQ(run_in(day.folder, {"render", "lapse.toml", "-o", "f_####.png"}).code, 0);
    day.folder.write("lapse.toml", scene("1-3"));
    const Outcome between = run_in(day.folder, {"render", "lapse.toml", "-o", "g_####.png"});
    EXPECT_EQ(between.code, 3);
    EXPECT_NE(between.err.find("frame 2: light 'sun' stands where no sun of 'day.far' does"),
              std::string::npos)
        << between.err;
    EXPECT_FALSE(std::filesystem::exists(day.folder / "g_0001.png")) << "told before any frame";
    // Only frames that are rendered have to have their suns.
    day.folder.write("lapse.toml", scene("2-3"));
    const Outcome last = run_in(day.folder, {"render", "lapse.toml", "--frames", "3", "-o", "h_####.png"});
    EXPECT_EQ(last.code, 0) << last.err;
}

TEST(TerrainParts, WhatCannotBeWrittenIsToldBeforeGroundIsRead) {
    const Day day;
    // No model is there to be read.
    std::filesystem::remove(day.folder / "hill.asc");
    const std::pair<const char*, const char*> targets[] = {{"-o", "a.far"},
                                                           {"--hours", "a.pfm"},
                                                           {"--picture", "a.png"},
                                                           {"--shadows", "a_####.png"},
                                                           {"--list", "a.csv"}};
    // A folder that is not there; and /proc, which refuses new files to everyone, root too.
    for (const char* folder : {"none/", "/proc/"}) {
        for (const auto& [flag, file] : targets) {
            const Outcome outcome = day.run({flag, std::string(folder) + file});
            EXPECT_EQ(outcome.code, 5) << flag << " " << folder << ": " << outcome.err;
        }
    }
}

}  // namespace
}  // namespace obscura
