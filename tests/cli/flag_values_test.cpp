// Values of flags, names of outputs and machine reports, without a process around them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "app/cli/flag_values.h"
#include "app/cli/progress.h"
#include "app/report/json_writer.h"
#include "app/report/output_plan.h"
#include "core/error.h"

namespace obscura {
namespace {

std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const UsageError& e) {
        return e.what();
    }
    return "no error";
}

TEST(FlagValues, WholeNumbersAreDecimalAndComplete) {
    EXPECT_EQ(whole_number("--n", "010", 0, 100), 10);
    EXPECT_EQ(whole_number("--n", "-7", -10, 100), -7);
    for (const char* wrong :
         {"", "x", "1x", "0x10", "1.5", "1e3", " 1", "101", "-1", "99999999999999999999"}) {
        EXPECT_EQ(error_of([&] { whole_number("--n", wrong, 0, 100); }),
                  "--n: '" + std::string(wrong) + "' is not a whole number from 0 to 100");
    }
}

TEST(FlagValues, RealNumbersAreFinite) {
    EXPECT_EQ(real_number("--f", "2.5e1", 0, 100), 25.0);
    for (const char* wrong : {"", "nan", "inf", "1,5", "-0.1", "101", "1e999"})
        EXPECT_THROW(real_number("--f", wrong, 0, 100), UsageError) << wrong;
}

TEST(FlagValues, SizesCropsAndPixels) {
    EXPECT_EQ(size_value("--size", "960x540").width, 960);
    EXPECT_EQ(size_value("--size", "960x540").height, 540);
    for (const char* wrong : {"960", "960x", "x540", "0x5", "5x-1", "5x5x5", "2000000x1"})
        EXPECT_THROW(size_value("--size", wrong), UsageError) << wrong;
    EXPECT_EQ(crop_value("--crop", "1,2,30,40", 30, 40), (Region{1, 2, 29, 38}));
    for (const char* wrong : {"1,2,3", "1,2,1,4", "1,4,3,4", "-1,0,3,4", "0,0,31,40", "0,0,30,41", "a,0,1,1"})
        EXPECT_THROW(crop_value("--crop", wrong, 30, 40), UsageError) << wrong;
    EXPECT_EQ(pixel_value("--pixel", "29,39", 30, 40).y, 39);
    for (const char* wrong : {"30,0", "0,40", "-1,0", "1", "1,2,3"})
        EXPECT_THROW(pixel_value("--pixel", wrong, 30, 40), UsageError) << wrong;
}

TEST(FlagValues, FramesAreSortedUniqueAndTheScenes) {
    const FrameRange scene{1, 48, 1};
    EXPECT_EQ(frame_values("--frames", "9-12,1,5,10", scene), (std::vector<int>{1, 5, 9, 10, 11, 12}));
    EXPECT_EQ(frame_values("--frames", "1-7x3", scene), (std::vector<int>{1, 4, 7}));
    EXPECT_EQ(frame_values("--frames", "1-8x3", scene), (std::vector<int>{1, 4, 7}));
    EXPECT_EQ(error_of([&] { frame_values("--frames", "40-50", scene); }),
              "--frames: frame 50 is not one of the scene's frames (1-48)");
    EXPECT_EQ(error_of([&] { frame_values("--frames", "0-999999999", scene); }),
              "--frames: frame 999999999 is not one of the scene's frames (1-48)");
    EXPECT_EQ(error_of([&] {
                  frame_values("--frames", "1-3", FrameRange{1, 9, 2});
              }),
              "--frames: frame 2 is not one of the scene's frames (1-9x2)");
    for (const char* wrong : {"", "1,", "a", "5-1", "1-5x0", "1..5", "1-"})
        EXPECT_THROW(frame_values("--frames", wrong, scene), UsageError) << wrong;
}

TEST(FlagValues, AovsByNameOnce) {
    EXPECT_EQ(aov_values("--aov", "normal,depth,normal"), (std::vector<Aov>{Aov::normal, Aov::depth}));
    EXPECT_EQ(error_of([] { aov_values("--aov", "dept"); }),
              "--aov: 'dept' is not one of depth, normal, albedo, object, shadow, sun_hours; did you mean "
              "'depth'?");
    EXPECT_THROW(aov_values("--aov", "beauty"), UsageError);
}

TEST(FlagValues, InstructionSets) {
    EXPECT_EQ(isa_value("--isa", "auto"), best_isa());
    EXPECT_EQ(isa_value("--isa", "ref"), Isa::ref);
    EXPECT_THROW(isa_value("--isa", "neon"), UsageError);
}

TEST(OutputPlan, FrameNumbersFillTheLastRunOfHashesOfTheName) {
    const PlannedOutput output{Aov::beauty, "a##/b_####.png", FileKind::png};
    EXPECT_EQ(output_path(output, 7), "a##/b_0007.png");
    EXPECT_EQ(output_path(output, 12345), "a##/b_12345.png");
}

TEST(OutputPlan, TheFlagReplacesTheListAndAovsLieBeside) {
    OutputRequest request;
    request.scene_stem = "yard";
    EXPECT_EQ(plan_outputs(request, {}).at(0).pattern, "yard.png");
    request.several_frames = true;
    EXPECT_EQ(plan_outputs(request, {}).at(0).pattern, "yard.####.png");
    request.output = "out/x_###.PFM";
    request.aovs = {Aov::depth};
    request.aov_kind = FileKind::png;
    const auto plan = plan_outputs(request, {{Aov::beauty, "list.png"}});
    ASSERT_EQ(plan.size(), 2u);
    EXPECT_EQ(plan[0].kind, FileKind::pfm);
    EXPECT_EQ(plan[1].pattern, "out/x_###.depth.png");
}

TEST(OutputPlan, RefusesWhatCannotBeMeant) {
    OutputRequest request;
    request.output = "x.jpg";
    EXPECT_THROW(plan_outputs(request, {}), UsageError);
    request.output = "x.png";
    EXPECT_THROW(
        plan_outputs({"", {}, FileKind::pfm, "s", false}, {{Aov::beauty, "a.png"}, {Aov::depth, "./a.png"}}),
        UsageError);
    request.several_frames = true;
    EXPECT_THROW(plan_outputs(request, {}), UsageError);
}

TEST(JsonWriter, NestsEscapesAndKeepsNumbersExact) {
    JsonWriter json;
    json.begin_object().member("a\"\n", 0.1).member("n", std::int64_t{-3}).member("t", true);
    json.member("bad", 1e308 * 10).key("l").begin_list().value("x").begin_object().end_object().end_list();
    EXPECT_EQ(json.end_object().finish(),
              "{\n  \"a\\\"\\u000a\": 0.1,\n  \"n\": -3,\n  \"t\": true,\n  \"bad\": null,\n  \"l\": [\n    "
              "\"x\",\n"
              "    {}\n  ]\n}\n");
}

TEST(Progress, LinesComeEveryTenth) {
    std::FILE* file = std::tmpfile();
    ASSERT_NE(file, nullptr);
    {
        Progress progress(file, Progress::Style::lines);
        progress.begin("frame 1", 0, 1);
        for (int i = 0; i <= 1000; ++i)
            progress.update(i / 1000.0);
        progress.finish();
    }
    std::rewind(file);
    std::string text(10000, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), file));
    std::fclose(file);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10) << text;
    EXPECT_EQ(text.rfind("frame 1:  10 %", 0), 0u) << text;
    EXPECT_NE(text.find("frame 1: 100 %"), std::string::npos) << text;
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

TEST(Progress, DurationsInWords) {
    EXPECT_EQ(duration_text(8.4), "8 s");
    EXPECT_EQ(duration_text(200), "3 min 20 s");
    EXPECT_EQ(duration_text(7500), "2 h 5 min");
}

}  // namespace
}  // namespace obscura
