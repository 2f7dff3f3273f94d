// Skies from pictures: orientation, what is refused, and that no light is lost on the way to directions.

#include "core/sky/image_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/num.h"
#include "core/sky/clear_sky.h"
#include "core/sky/sky_model.h"

namespace obscura {
namespace {

const Exec exec{};

ImageSky sky_of(const Image<Vec3f>& image, double scale = 1) {
    return image_sky(encode_pfm(image.view()), "sky.pfm", scale);
}

double difference(Vec3d a, Vec3d b) {
    return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}) /
           std::max({b.x, b.y, b.z});
}

TEST(ImageSky, NorthIsInTheMiddleAndEastIsRightOfIt) {
    Image<Vec3f> image(64, 32);
    image(32, 10) = {1, 0, 0};  // just right of the middle: north
    image(48, 10) = {0, 1, 0};  // east
    image(16, 10) = {0, 0, 1};  // west
    image(0, 0) = {4, 4, 4};    // straight up
    const ImageSky sky = sky_of(image, 2);
    const double elevation = 90 - 180 * 10.5 / 32, half = 360 * 0.5 / 64;
    EXPECT_NEAR(sky_radiance(sky, compass_direction(0 + half, elevation)).x, 2, 1e-5);
    EXPECT_NEAR(sky_radiance(sky, compass_direction(90 + half, elevation)).y, 2, 1e-5);
    EXPECT_NEAR(sky_radiance(sky, compass_direction(270 + half, elevation)).z, 2, 1e-5);
    EXPECT_NEAR(sky_radiance(sky, compass_direction(180 + half, 90 - 90.0 / 32)).x, 8, 1e-5);
    EXPECT_EQ(sky_radiance(sky, compass_direction(0 + half, -elevation)), Vec3f{});
}

TEST(ImageSky, InterpolatesAcrossTheSeam) {
    Image<Vec3f> image(8, 4, {1, 1, 1});
    for (int y = 0; y < 4; ++y)
        image(0, y) = {3, 3, 3};
    const ImageSky sky = sky_of(image);
    EXPECT_NEAR(sky_radiance(sky, compass_direction(180, 10)).x, 2, 1e-5);
    EXPECT_NEAR(sky_radiance(sky, compass_direction(180 - 22.5, 10)).x, 1, 1e-5);
}

TEST(ImageSky, RefusesWhatIsNoSky) {
    Image<Vec3f> square(4, 4), dark(8, 4), endless(8, 4), blinding(8, 4, {1e6f, 1e6f, 1e6f});
    dark(5, 1) = {0, -1, 0};
    endless(2, 3).z = std::numeric_limits<float>::infinity();
    const auto message = [](const Image<Vec3f>& image) -> std::string {
        try {
            sky_of(image);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(message(square).find("twice as wide"), std::string::npos);
    EXPECT_NE(message(dark).find("pixel 5, 1"), std::string::npos);
    EXPECT_NE(message(endless).find("pixel 2, 3"), std::string::npos);
    EXPECT_NO_THROW(sky_of(blinding, 1000));
    EXPECT_THROW(sky_of(blinding, 1001), InputError);  // sums of more would not be finite
    EXPECT_THROW(image_sky("P6 1 1", "sky.pfm", 1), InputError);
    EXPECT_NO_THROW(image_sky(encode_pfm(Image<float>(8, 4, 2.0f).view()), "grey.pfm", 1));
}

TEST(ImageSky, NoLightIsLost) {
    for (const int height : {4, 33, 256}) {
        const SkyGrid grid = sky_grid(sky_of(Image<Vec3f>(2 * height, height, {1, 2, 3})));
        EXPECT_LT(difference(unoccluded_irradiance(grid, {0, 1, 0}), Vec3d{1, 2, 3} * num::pi), 1e-3)
            << height;
        EXPECT_LT(difference(unoccluded_irradiance(grid, {0, 0, 1}), Vec3d{1, 2, 3} * (num::pi / 2)), 5e-3)
            << height;
    }
    // A sun of one pixel, by hand: radiance times solid angle, on a level surface times the sine.
    Image<Vec3f> image(512, 256);
    image(300, 80) = {1e4f, 9e3f, 5e3f};
    const ImageSky sky = sky_of(image);
    const double top = num::cos_deg(180 * 80 / 256.0), bottom = num::cos_deg(180 * 81 / 256.0);
    const double solid_angle = 2 * num::pi / 512 * (top - bottom), sine = (top + bottom) / 2;
    const Vec3d facing = Vec3d{1e4, 9e3, 5e3} * solid_angle;
    Vec3d level, wall;
    const Vec3d towards = compass_direction(180 + 360 * 300.5 / 512, 0);
    for (const SkyDirection& d : sky_directions(sky, 64, SkyImportance::radiance, exec)) {
        level = level + to_double(d.irradiance_w_m2) * d.direction.y;
        wall = wall + to_double(d.irradiance_w_m2) * std::max(0.0, dot(d.direction, towards));
    }
    EXPECT_LT(difference(level, facing * sine), 1e-4);
    EXPECT_LT(difference(wall, facing * std::sqrt(1 - sine * sine)), 1e-4);
}

// A clear sky, drawn as a picture and read again, sends the same light.
TEST(ImageSky, APictureOfASkyIsTheSky) {
    const ClearSky clear = clear_sky(clear_air({}, exec), 30, 25, exec);
    Image<Vec3f> image(512, 256);
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 512; ++x)
            image(x, y) = sky_radiance(
                clear, compass_direction(180 + 360 * (x + 0.5) / 512, 90 - 180 * (y + 0.5) / 256));
    }
    const SkyGrid grid = sky_grid(sky_of(image)), own = sky_grid(clear, exec);
    // Block by block of 8 x 8 cells, since every pixel has to find its own.
    const int blocks = SkyGrid::side / 8;
    std::vector<Vec3d> drawn(static_cast<std::size_t>(blocks * blocks)), seen = drawn;
    for (int y = 0; y < SkyGrid::side; ++y) {
        for (int x = 0; x < SkyGrid::side; ++x) {
            const auto cell = static_cast<std::size_t>(y * SkyGrid::side + x);
            const auto block = static_cast<std::size_t>(y / 8 * blocks + x / 8);
            drawn[block] = drawn[block] + grid.cells[cell].green;
            seen[block] = seen[block] + own.cells[cell].green;
        }
    }
    double off = 0, whole = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        off += length(drawn[i] - seen[i]);
        whole += length(seen[i]);
    }
    EXPECT_LT(off, 0.02 * whole);
    for (const Vec3d normal :
         {Vec3d{0, 1, 0}, compass_direction(30, 0), compass_direction(120, 0), compass_direction(250, 45)})
        EXPECT_LT(difference(unoccluded_irradiance(grid, normal), unoccluded_irradiance(own, normal)), 5e-3);
}

}  // namespace
}  // namespace obscura
