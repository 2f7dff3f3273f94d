#include "app/cli/info_command.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

TEST(InfoCommand, PrintsTheTable) {
    const TemporaryFolder folder;
    const auto file = folder.write("tetra.obj",
                                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -2.5\n"
                                   "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\nf 1 1 2\n");
    std::ostringstream out;
    EXPECT_EQ(info_command({file, {}, false, {}}, out), 0);
    EXPECT_EQ(out.str(), file.string() +
                             "\n"
                             "triangles             5\n"
                             "vertices              4\n"
                             "objects               1\n"
                             "materials             1\n"
                             "textures              0\n"
                             "components            1 closed, 0 open\n"
                             "  of the closed       0 with balanced multi-edges, 0 inside out\n"
                             "edges, by index       0 without a partner, 0 with more than two faces\n"
                             "edges, welded         0 without a partner, 0 with more than two faces\n"
                             "degenerate triangles  1\n"
                             "planar faces          4\n"
                             "bounding box          (0, 0, -2.5) / (1, 1, 0)\n");
}

}  // namespace
}  // namespace obscura
