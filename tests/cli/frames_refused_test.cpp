// What rendering would refuse in some frame is refused by `check`, and by `render` before its first file.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace obscura::test {
namespace {

using Names = std::vector<std::string>;

/// The small scene with a lens, and one keyframe at frame 1 and one at frame 5.
struct LensScene : Folder {
    LensScene(const std::string& optics, const std::string& first, const std::string& last) {
        write("s.toml", small_scene + std::string("[optics]\nmask_px = 64\n") + optics +
                            "[frames]\nrange = \"1-5\"\noptics = [\n  {frame = 1, " + first +
                            "},\n  {frame = 5, " + last + "}]\n");
    }
};

/// Both commands, which say the same.
void expect_both_refuse(const Folder& folder, int code, const std::string& place, const std::string& message,
                        const std::string& command = "render") {
    const Outcome check = run_in(folder, {"check", "s.toml"});
    const Outcome render = run_in(folder, {command, "s.toml", "-o", "p.####.png"});
    EXPECT_EQ(check.code, code) << check.err << check.out;
    EXPECT_EQ(check.err, render.err);
    EXPECT_EQ(render.code, code);
    EXPECT_NE(check.err.find("s.toml:" + place + ": "), std::string::npos) << check.err;
    EXPECT_NE(check.err.find(message), std::string::npos) << check.err;
    EXPECT_EQ(folder.listing(), Names{"s.toml"});
}

TEST(FramesRefused, ApertureThatKeyframesClose) {
    const std::string closed = "the aperture is closed: no texel lets light through";
    expect_both_refuse(LensScene("radius_px = 8\noccluder = \"disc\"\naperture = \"circle\"\n",
                                 "occluder_diameter = 0.1", "occluder_diameter = 4"),
                       3, "30:35", "frame 2: " + closed);
    expect_both_refuse(LensScene("radius_px = 8\naperture = \"annulus\"\nvanes = 0\n", "obstruction = 0.3",
                                 "obstruction = 0.9999999999999999"),
                       3, "31:29", "frame 5: " + closed);
    // The frames that are rendered count.
    const LensScene late("radius_px = 8\noccluder = \"disc\"\naperture = \"circle\"\n",
                         "occluder_diameter = 0.1", "occluder_diameter = 4");
    const Outcome open = run_in(late, {"render", "s.toml", "-o", "p.####.png", "--frames", "1"});
    EXPECT_EQ(open.code, 0) << open.err;
    expect_both_refuse(LensScene("radius_px = 8\noccluder = \"disc\"\naperture = \"circle\"\n",
                                 "occluder_diameter = 0.1", "occluder_diameter = 4"),
                       3, "30:35", "frame 2: " + closed, "stereo");
}

TEST(FramesRefused, PatternThatKeyframesPutOutOfReach) {
    expect_both_refuse(LensScene("radius_px = 64\n", "f_number = 22", "f_number = 0.1"), 4, "29:26",
                       "frame 5: the lens's pattern needs");
}

// Whether anything glares is not what it depends on.
TEST(FramesRefused, ClosedApertureOfAPictureWithoutGlare) {
    const Folder folder;
    folder.write("s.toml", small_scene + std::string("[optics]\nmask_px = 64\nradius_px = 8\nclip = 1e9\n"
                                                     "aperture = \"circle\"\noccluder = \"disc\"\n"
                                                     "occluder_diameter = 4\n"));
    expect_both_refuse(folder, 3, "22:2", "the aperture is closed");
}

TEST(FramesRefused, StackWithoutAPlaneInSomeFrame) {
    const Folder folder;
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 2, 6], look_at_m = [0, 0, 0]}
render = {size_px = [20, 16]}
mesh = [{id = "floor", shape = "box", size_m = [8, 8, 8]}]
[[light]]
id = "lamp"
type = "area"
position_m = [0, 9, 0]
look_at_m = [0, 0, 0]
radiance_w_m2_sr = 1
two_sided = true
shadow = {method = "stack", resolution = 256, samples = 4}
[frames]
range = "1-3"
light = [
  {id = "lamp", frame = 1, position_m = [0, 9, 0]},
  {id = "lamp", frame = 3, position_m = [0, 1, 0]}]
)");
    expect_both_refuse(folder, 3, "17:41", "frame 3: light 'lamp': shadow.method = \"stack\"");
}

// Channels beside the picture, and a margin that keyframes widen.
TEST(FramesRefused, MemoryThatOneFrameNeeds) {
    const Folder folder;
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 2, 6], look_at_m = [0, 0, 0]}
render = {size_px = [4000, 4000], samples = 1}
limits = {memory_mib = 1100}
optics = {mask_px = 64, radius_px = 500, clip = 1}
frames = {range = "1-2", optics = [{frame = 1, clip = 1e9}, {frame = 2, clip = 1e-9}]}
)");
    const Outcome check = run_in(folder, {"check", "s.toml"}),
                  render = run_in(folder, {"render", "s.toml", "-o", "p.####.png"});
    EXPECT_EQ(check.code, 4) << check.err << check.out;
    EXPECT_EQ(render.code, 4);
    EXPECT_EQ(check.err, render.err);
    EXPECT_NE(check.err.find("s.toml: frame 2: needs about"), std::string::npos) << check.err;
    EXPECT_EQ(folder.listing(), Names{"s.toml"});
}

}  // namespace
}  // namespace obscura::test
