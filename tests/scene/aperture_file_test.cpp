// Masks from pictures: what white means, how large they are, what is no mask.

#include "app/scene/aperture_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/pixel.h"
#include "tests/core/png_builder.h"
#include "tests/core/shared_folder.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

const fs::path apertures = shared_folder("data/apertures");

Image<float> decode(const std::string& bytes) {
    return decode_mask(bytes, "mask", {});
}

std::string bad(const std::string& bytes) {
    try {
        decode(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

/// 2 x 1 pixels.
std::string rgba(Rgba8 a, Rgba8 b) {
    Image<Rgba8> image(2, 1);
    image.pixels = {a, b};
    return encode_png(image.view());
}

constexpr Rgba8 white{255, 255, 255, 255}, black{0, 0, 0, 255};

TEST(ApertureFile, WhiteIsOpen) {
    EXPECT_EQ(decode("P1\n2 1\n1 0").pixels, (std::vector<float>{0, 1})) << "bit 1 is black";
    EXPECT_EQ(decode("P2\n3 1\n4\n0 1 4").pixels, (std::vector<float>{0, 0.25f, 1}));
    EXPECT_EQ(decode(rgba(black, white)).pixels, (std::vector<float>{0, 1}));
    EXPECT_EQ(decode(rgba({51, 51, 51, 255}, white)).pixels, (std::vector<float>{51 / 255.0f, 1}));
    // Grey of 1 and of 8 bits, without any sRGB curve.
    EXPECT_EQ(decode(png_file(3, 1, 1, 0, false, std::string("\0\xa0", 2))).pixels,
              (std::vector<float>{1, 0, 1}));
    EXPECT_EQ(decode(png_file(2, 1, 8, 0, false, std::string("\0\x80\xff", 3))).pixels,
              (std::vector<float>{128 / 255.0f, 1}));
    // All open: a box.
    EXPECT_EQ(decode("P1\n2 2\n0000").pixels, (std::vector<float>{1, 1, 1, 1}));
}

TEST(ApertureFile, SixteenBitsCount) {
    const auto deep = [](const std::string& row, int type = 0) {
        const int samples = type == 0 ? 1 : 3;
        return png_file(static_cast<int>(row.size()) / 2 / samples, 1, 16, type, false,
                        std::string(1, '\0') + row);
    };
    EXPECT_EQ(decode(deep(std::string("\0\1\x12\x34\xff\xff", 6))).pixels,
              (std::vector<float>{1 / 65535.0f, 0x1234 / 65535.0f, 1}));
    // Darker than one code of eight bits, but not closed; a colour in the low bytes is one.
    EXPECT_EQ(decode(deep(std::string("\0\xff", 2))).pixels, (std::vector<float>{255 / 65535.0f}));
    EXPECT_EQ(
        bad(deep(std::string("\x12\x34\x12\x34\x12\x35", 6), 2)),
        "mask: pixel (0, 0) has a colour (#123412341235): a mask is grey, white = open, black = closed");
}

TEST(ApertureFile, WhatIsNoMask) {
    EXPECT_EQ(bad("GIF89a"), "mask: a mask is a PNG, PBM or PGM file, and this is none by its first bytes");
    EXPECT_EQ(bad("P1\n2 2\n1111"),
              "mask: the aperture is closed: no pixel lets light through (white = open)");
    EXPECT_EQ(bad(rgba(black, black)),
              "mask: the aperture is closed: no pixel lets light through (white = open)");
    EXPECT_EQ(bad(rgba(white, {255, 255, 255, 254})),
              "mask: pixel (1, 0) is transparent: it could mean open or closed. Flatten the picture, white = "
              "open, black = closed, and save it without alpha");
    EXPECT_EQ(bad(rgba(white, {255, 0, 128, 255})),
              "mask: pixel (1, 0) has a colour (#ff0080): a mask is grey, white = open, black = closed");
    EXPECT_NE(bad("P6\n1 1\n255\nabc").find("P6 is a colour picture"), std::string::npos);
    const std::string png = rgba(black, white);
    EXPECT_NE(bad(png.substr(0, png.size() - 3)).find("truncated PNG"), std::string::npos);
    EXPECT_NE(bad(png + "x").find("1 bytes follow the end"), std::string::npos);
    EXPECT_THROW(decode_mask("P1\n2 2\n0000", "mask", {1, 100}), LimitError);
    EXPECT_THROW(decode_mask(png, "mask", {1, 100}), LimitError);
}

TEST(ApertureFile, TexelsAreSquare) {
    const auto with_density = [](std::uint32_t x, std::uint32_t y, bool whole = true) {
        std::string density;
        put_big_endian(density, x);
        put_big_endian(density, y);
        density += std::string(whole ? 1 : 2, '\1');
        return png_begin(1, 1, 8, 0, false) + png_chunk("pHYs", density) +
               png_chunk("IDAT", zlib_stored(std::string("\0\xff", 2))) + png_chunk("IEND", "");
    };
    EXPECT_EQ(decode(with_density(2835, 2835)).pixels, (std::vector<float>{1}));
    EXPECT_EQ(
        bad(with_density(2835, 1417)),
        "mask: pixels are not square: chunk pHYs has 2835 x 1417 per unit; resample the picture, or take "
        "the chunk out when it is wrong");
    EXPECT_EQ(bad(with_density(1, 1, false)), "mask: PNG chunk pHYs at byte 33: 10 bytes instead of 9");
}

TEST(ApertureFile, SizeByTexelOrByOpening) {
    // Three texels wide, two high, in a corner of five by four.
    Image<float> mask(5, 4);
    mask(0, 1) = 1;
    mask(2, 2) = 0.5f;
    EXPECT_EQ(scaled_aperture(mask, {1e-5, std::nullopt}).pitch_m, 1e-5);
    const Aperture aperture = scaled_aperture(mask, {std::nullopt, 6e-3});
    EXPECT_DOUBLE_EQ(aperture.pitch_m, 2e-3);
    EXPECT_EQ(aperture.mask, mask);
    EXPECT_TRUE(aperture.outline.loops.empty());
    EXPECT_THROW(scaled_aperture(mask, {}), UsageError);
    EXPECT_THROW(scaled_aperture(mask, {1.0, 1.0}), UsageError);
    EXPECT_THROW(scaled_aperture(mask, {0.0, std::nullopt}), UsageError);
    EXPECT_THROW(scaled_aperture(mask, {std::nullopt, -1.0}), UsageError);
    EXPECT_THROW(scaled_aperture(Image<float>(3, 3), {std::nullopt, 1.0}), InputError);
}

TEST(ApertureFile, TheOpeningInASquare) {
    Image<float> mask(5, 4);
    mask(1, 1) = 0.25f;
    mask(1, 3) = 1;
    const Image<float> square = square_opening(mask.view());
    ASSERT_EQ(square.width, 3);
    EXPECT_EQ(square.pixels, (std::vector<float>{0, 0.25f, 0, 0, 0, 0, 0, 1, 0}));
}

TEST(ApertureFile, FilesHaveDotsOrSlashes) {
    EXPECT_TRUE(names_mask_file("iris.png"));
    EXPECT_TRUE(names_mask_file("./iris"));
    EXPECT_FALSE(names_mask_file("iris"));
}

TEST(ApertureFile, RealPupils) {
    SKIP_WITHOUT(apertures);
    // Shares of the square that the published pupils leave open; of the ones made of circles by hand: Hubble
    // (1 - 0.33^2) less vanes and pads, of a disc 1 / 1.02 wide.
    const struct {
        const char* name;
        double low, high;
    } pupils[] = {{"gmt", 0.5, 0.62},  {"hst", 0.62, 0.68},  {"jwst", 0.5, 0.65},
                  {"keck", 0.5, 0.66}, {"subaru", 0.5, 0.7}, {"vlt_ut1", 0.7, 0.755}};
    for (const auto& pupil : pupils) {
        const std::string name = pupil.name;
        const Image<float> grey = read_mask(apertures / (name + "_1024.png"), name, {});
        const Image<float> bits = read_mask(apertures / (name + "_1024.pbm"), name, {});
        ASSERT_EQ(grey.width, 1024);
        ASSERT_EQ(bits.height, 1024);
        int differing = 0;
        for (std::size_t i = 0; i < grey.pixels.size(); ++i)
            differing += (grey.pixels[i] >= 0.5f) != (bits.pixels[i] == 1);
        EXPECT_EQ(differing, 0) << name << ": the bits are the greys cut at half";
        const double share = open_area(grey.view()) / (1024.0 * 1024.0);
        EXPECT_GT(share, pupil.low) << name;
        EXPECT_LT(share, pupil.high) << name;
        EXPECT_NEAR(open_area(bits.view()) / open_area(grey.view()), 1, 0.01) << name;
        // The pupil's diameter fills 1024 / 1.02 pixels.
        EXPECT_NEAR(scaled_aperture(grey, {std::nullopt, 1.0}).pitch_m, 1.02 / 1024, 0.05 / 1024) << name;
    }
}

}  // namespace
}  // namespace obscura
