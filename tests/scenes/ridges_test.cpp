// Mountains by chance: the committed model is what the generator makes, worn down but not torn.

#include "scenes/ridges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/hash.h"
#include "core/image_io.h"

namespace obscura {
namespace {

TEST(Ridges, CommittedModelIsTheGenerators) {
    std::ostringstream bytes;
    bytes << std::ifstream(OBSCURA_SOURCE_DIR "/scenes/textures/ridges.png", std::ios::binary).rdbuf();
    const Image<Rgba16> file = decode_png16(bytes.str(), "ridges.png");
    const Image<std::uint16_t> made = ridges(mountains_params());
    ASSERT_EQ(file.width, made.width);
    ASSERT_EQ(file.height, made.height);
    for (std::size_t i = 0; i < made.pixels.size(); ++i)
        ASSERT_EQ(file.pixels[i].r, made.pixels[i]) << "sample " << i;
}

TEST(Ridges, WaterWearsSlopesDown) {
    RidgesParams params;
    params.side_log2 = 6;
    params.drops = 0;
    const Image<std::uint16_t> dry = ridges(params);
    params.drops = 4000;
    const Image<std::uint16_t> worn = ridges(params);
    EXPECT_NE(dry, worn);
    EXPECT_EQ(*std::min_element(dry.pixels.begin(), dry.pixels.end()), 0);
    const auto greatest = [](const Image<std::uint16_t>& h) {
        return *std::max_element(h.pixels.begin(), h.pixels.end());
    };
    EXPECT_GT(greatest(dry), 0.8 * params.height_m / ridges_step_m);
    EXPECT_LE(greatest(worn), 1.1 * params.height_m / ridges_step_m);
    params.seed = 2;
    EXPECT_NE(ridges(params), worn);
}

}  // namespace
}  // namespace obscura
