// What `obscura check` says of a scene: every light's maps, the meshes, the output; nothing is written.

#include "app/cli/check_command.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>

#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

TEST(CheckCommand, ReportsWithoutRendering) {
    TemporaryFolder folder;
    folder.write("s.toml", R"(format = 1
camera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}
[[mesh]]
id = "a"
shape = "box"
[[light]]
id = "lamp"
type = "point"
position_m = [0, 3, 0]
intensity_w_sr = 20
shadow = {method = "map", resolution = 1024}
[[light]]
id = "spot"
type = "spot"
position_m = [0, 3, 0]
look_at_m = [0, 0, 0]
intensity_w_sr = 20
shadow = {resolution = 65536, scope = "full", filter = "hierarchical"}
[[light]]
id = "sun"
type = "directional"
azimuth_deg = 90
elevation_deg = 40
[frames]
range = "1-48"
[[output]]
file = "out_####.png"
)");
    const std::string report = check_report({folder.path / "s.toml", {"render.samples=1"}, {}});
    for (const char* line :
         {"picture   960 x 540 pixels, 1 sample each", "frames    48 (1-48)",
          "output    beauty -> out_####.png",
          "light     lamp: point, 6 dense shadow maps of 1024 x 1024, filter 3 x 3, 24.0 MiB",
          "light     spot: spot, 1 compressed shadow map of 65536 x 65536, filter 3 x 3, built whole, "
          "filtered "
          "hierarchically, about 12.0 MiB",
          "light     sun: directional, 1 compressed shadow map of 512 x 512, texels of ",
          "          auto: a texel spans 0.",
          "meshes    12 triangles, 24 vertices, 1 objects, 1 closed and 0 open components", "\nok\n"}) {
        EXPECT_NE(report.find(line), std::string::npos) << line << "\nis not in\n" << report;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path),
                            std::filesystem::directory_iterator()),
              1)
        << "something was written";
}

}  // namespace
}  // namespace obscura
