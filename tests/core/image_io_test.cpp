// Image files: what is written reads back, every colour type decodes, and every broken file says where.

#include "core/image_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "core/error.h"
#include "tests/core/png_builder.h"
#include "tests/core/shared_folder.h"

namespace obscura {
namespace {

/// Message of the error that `action` must throw.
template <class Error, class Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const Error& e) {
        return e.what();
    } catch (const std::exception& e) {
        return std::string("another kind of error: ") + e.what();
    }
    return "no error";
}

std::string input_error(const std::string& bytes) {
    return message_of<InputError>([&] { decode_png(bytes, "t.png"); });
}
std::string limit_error(const std::string& bytes, const ImageFileLimits& limits = {}) {
    return message_of<LimitError>([&] { decode_png(bytes, "t.png", limits); });
}

template <class Pixel>
Image<Pixel> random_image(int width, int height, int smoothness) {
    std::mt19937 random(static_cast<unsigned>(width * 1000 + height));
    Image<Pixel> image(width, height);
    auto* bytes = reinterpret_cast<unsigned char*>(image.pixels.data());
    for (std::size_t i = 0; i < image.pixels.size() * sizeof(Pixel); ++i) {
        bytes[i] = static_cast<unsigned char>(i / 7 + random() % static_cast<unsigned>(smoothness));
    }
    return image;
}

TEST(Png, RgbAndRgbaReadBackAsWritten) {
    constexpr int sizes[][2] = {{1, 1}, {1, 9}, {17, 1}, {64, 33}, {255, 130}};
    for (const auto& [w, h] : sizes) {
        for (const int smoothness : {1, 4, 256}) {
            const auto rgb = random_image<Rgb8>(w, h, smoothness);
            const auto rgba = random_image<Rgba8>(w, h, smoothness);
            const Image<Rgba8> a = decode_png(encode_png(rgb.view()), "a.png");
            const Image<Rgba8> b = decode_png(encode_png(rgba.view()), "b.png");
            EXPECT_EQ(b, rgba);
            ASSERT_EQ(a.pixels.size(), rgb.pixels.size());
            for (std::size_t i = 0; i < a.pixels.size(); ++i) {
                const Rgb8 p = rgb.pixels[i];
                ASSERT_EQ(a.pixels[i], (Rgba8{p.r, p.g, p.b, 255}));
            }
        }
    }
}

TEST(Png, CropIsWrittenByItsStride) {
    auto image = random_image<Rgb8>(20, 10, 256);
    const ImageView<const Rgb8> crop = image.view().crop(3, 2, 5, 4);
    const Image<Rgba8> read = decode_png(encode_png(crop), "crop.png");
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x)
            EXPECT_EQ(read(x, y).g, image(x + 3, y + 2).g);
    }
}

TEST(Png, SixteenBitGreyKeepsItsUpperByteAndIsMarkedLinear) {
    Image<std::uint16_t> image(300, 2);
    for (int x = 0; x < 300; ++x)
        image(x, 0) = image(x, 1) = static_cast<std::uint16_t>(x * 218);
    const std::string file = encode_png(image.view());
    EXPECT_NE(file.find("gAMA"), std::string::npos);
    const Image<Rgba8> read = decode_png(file, "grey.png");
    for (int x = 0; x < 300; ++x)
        EXPECT_EQ(read(x, 1).r, image(x, 1) >> 8);
}

TEST(Png, BytesAreTheSameEachTimeAndCarrySrgb) {
    const auto image = random_image<Rgb8>(40, 40, 9);
    const std::string file = encode_png(image.view());
    EXPECT_EQ(file, encode_png(image.view()));
    EXPECT_LT(file.find("sRGB"), file.find("IDAT"));
    EXPECT_TRUE(is_png(file));
    EXPECT_FALSE(is_png("GIF89a"));
    EXPECT_FALSE(is_png(""));
}

TEST(Png, EveryColourTypeAndDepthDecodes) {
    // A row of 8 pixels that are alternately lowest and highest.
    struct Kind {
        int type, depth, samples;
    };
    for (const Kind k : {Kind{0, 1, 1},
                         {0, 2, 1},
                         {0, 4, 1},
                         {0, 8, 1},
                         {0, 16, 1},
                         {2, 8, 3},
                         {2, 16, 3},
                         {4, 8, 2},
                         {4, 16, 2},
                         {6, 8, 4},
                         {6, 16, 4}}) {
        std::string row(1, '\0');
        int bit = 0, byte = 0;
        for (int x = 0; x < 8; ++x) {
            for (int i = 0; i < k.samples * k.depth; ++i) {
                byte = byte << 1 | (x & 1);
                if (++bit % 8 == 0) row.push_back(static_cast<char>(byte & 0xff));
            }
        }
        const Image<Rgba8> image = decode_png(png_file(8, 1, k.depth, k.type, false, row), "kind.png");
        for (int x = 0; x < 8; ++x) {
            EXPECT_EQ(image(x, 0).r, x & 1 ? 255 : 0) << k.type << '/' << k.depth;
            EXPECT_EQ(image(x, 0).a, k.type >= 4 && !(x & 1) ? 0 : 255) << k.type << '/' << k.depth;
        }
    }
}

TEST(Png, SixteenBitsAreKept) {
    Image<std::uint16_t> image(256, 256);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<std::uint16_t>(i);
    const std::string file = encode_png(image.view());
    EXPECT_TRUE(has_16_bit_samples(file));
    const Image<Rgba16> decoded = decode_png16(file, "deep.png");
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::uint16_t v = image.pixels[i];
        ASSERT_EQ(decoded.pixels[i], (Rgba16{v, v, v, 65535}));
    }
    // Alpha and colours, by hand.
    const Image<Rgba16> rgba =
        decode_png16(png_file(1, 1, 16, 6, false, std::string("\0\1\2\3\4\5\6\7\x8", 9)), "rgba.png");
    EXPECT_EQ(rgba(0, 0), (Rgba16{0x102, 0x304, 0x506, 0x708}));
    // Fewer bits are spread.
    const std::string shallow = encode_png(Image<Rgb8>(1, 1, {0, 1, 255}).view());
    EXPECT_FALSE(has_16_bit_samples(shallow));
    EXPECT_EQ(decode_png16(shallow, "shallow.png")(0, 0), (Rgba16{0, 257, 65535, 65535}));
    EXPECT_FALSE(has_16_bit_samples(file.substr(0, 24)));
    EXPECT_THROW(decode_png16(file, "deep.png", {16384, 256 * 256 * 8 - 1}), LimitError);
}

TEST(Png, PaletteWithTransparencyDecodes) {
    std::string file = png_begin(4, 1, 2, 3, false);
    file += png_chunk("PLTE", std::string("\x10\x20\x30\xff\x00\x00\x00\xff\x00\x00\x00\xff", 12));
    file += png_chunk("tRNS", std::string("\x00\x80", 2));
    file += png_chunk("IDAT", zlib_stored(std::string("\0\x1b", 2)));  // 00 01 10 11
    file += png_chunk("IEND", "");
    const Image<Rgba8> image = decode_png(file, "palette.png");
    EXPECT_EQ(image(0, 0), (Rgba8{0x10, 0x20, 0x30, 0}));
    EXPECT_EQ(image(1, 0), (Rgba8{255, 0, 0, 0x80}));
    EXPECT_EQ(image(2, 0), (Rgba8{0, 255, 0, 255}));
    EXPECT_EQ(image(3, 0), (Rgba8{0, 0, 255, 255}));
}

TEST(Png, InterlacedDecodesWhateverPassesAreEmpty) {
    for (int w = 1; w <= 9; ++w) {
        for (int h = 1; h <= 9; ++h) {
            // Adam7 by its definition: the pass of a pixel from its place in the 8 x 8 pattern.
            constexpr int pass_of[8][8] = {{1, 6, 4, 6, 2, 6, 4, 6}, {7, 7, 7, 7, 7, 7, 7, 7},
                                           {5, 6, 5, 6, 5, 6, 5, 6}, {7, 7, 7, 7, 7, 7, 7, 7},
                                           {3, 6, 4, 6, 3, 6, 4, 6}, {7, 7, 7, 7, 7, 7, 7, 7},
                                           {5, 6, 5, 6, 5, 6, 5, 6}, {7, 7, 7, 7, 7, 7, 7, 7}};
            std::string rows;
            for (int pass = 1; pass <= 7; ++pass) {
                for (int y = 0; y < h; ++y) {
                    std::string row;
                    for (int x = 0; x < w; ++x) {
                        if (pass_of[y % 8][x % 8] == pass) row.push_back(static_cast<char>(16 * y + x));
                    }
                    if (!row.empty()) rows += '\0' + row;
                }
            }
            const Image<Rgba8> image = decode_png(png_file(w, h, 8, 0, true, rows), "adam7.png");
            for (int y = 0; y < h; ++y) {
                for (int x = 0; x < w; ++x)
                    ASSERT_EQ(image(x, y).g, 16 * y + x) << w << 'x' << h;
            }
        }
    }
}

TEST(PngBad, BombIsRefusedByItsClaim) {
    // 30000 x 30000 in a few hundred bytes: the stream would inflate, nothing may try.
    std::string file = png_begin(30000, 30000, 8, 6, false);
    file += png_chunk("IDAT", std::string(280, '\0'));
    file += png_chunk("IEND", "");
    ASSERT_LT(file.size(), 354u);
    EXPECT_NE(limit_error(file).find("30000 x 30000"), std::string::npos) << limit_error(file);
    // Within the side limit, but too many bytes.
    EXPECT_NE(limit_error(png_file(2000, 2000, 8, 6, false, ""), {16384, 1'000'000}).find("16002000 bytes"),
              std::string::npos);
    EXPECT_NE(limit_error(png_file(2147483647, 2147483647, 16, 6, false, "")).find("2147483647"),
              std::string::npos);
}

TEST(PngBad, StreamLongerOrShorterThanTheClaimIsRefused) {
    const std::string row(5, '\0');  // 4 grey pixels
    EXPECT_EQ(input_error(png_file(4, 1, 8, 0, false, row + std::string(100'000, '\0'))),
              "t.png: PNG chunk IDAT: expected 5 bytes of pixel rows, the stream is damaged or longer");
    EXPECT_EQ(input_error(png_file(4, 1, 8, 0, false, "1234")),
              "t.png: PNG chunk IDAT: expected 5 bytes of pixel rows, the stream has 4");
}

TEST(PngBad, DamagedByteNamesChunkAndOffset) {
    const auto image = random_image<Rgb8>(16, 16, 256);
    const std::string good = encode_png(image.view());
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x20);
        EXPECT_NE(input_error(bad).find("byte "), std::string::npos)
            << "byte " << i << ": " << input_error(bad);
    }
    std::string bad = good;
    bad[good.find("IDAT") + 9] ^= 1;
    EXPECT_NE(
        input_error(bad).find("chunk IDAT at byte " + std::to_string(good.find("IDAT") - 4) + " is damaged"),
        std::string::npos);
}

TEST(PngBad, EveryTruncationIsSeen) {
    const auto image = random_image<Rgb8>(16, 16, 256);
    const std::string good = encode_png(image.view());
    for (std::size_t size = 8; size < good.size(); ++size) {
        EXPECT_NE(input_error(good.substr(0, size)).find("byte " + std::to_string(size)), std::string::npos)
            << size;
    }
    for (std::size_t size = 0; size < 8; ++size) {
        EXPECT_EQ(input_error(good.substr(0, size)), "t.png: not a PNG file: wrong signature at byte 0");
    }
}

TEST(PngBad, HeaderAndOrderErrors) {
    const std::string row(2, '\0');
    EXPECT_EQ(input_error(png_file(0, 1, 8, 0, false, row)), "t.png: PNG chunk IHDR at byte 8: size 0 x 1");
    EXPECT_EQ(input_error(png_file(1, 1, 3, 0, false, row)),
              "t.png: PNG chunk IHDR at byte 8: no colour type 0 with 3 bits");
    EXPECT_EQ(input_error(png_file(1, 1, 8, 5, false, row)),
              "t.png: PNG chunk IHDR at byte 8: no colour type 5 with 8 bits");
    EXPECT_EQ(input_error(png_file(1, 1, 4, 2, false, row)),
              "t.png: PNG chunk IHDR at byte 8: no colour type 2 with 4 bits");
    EXPECT_EQ(input_error(png_file(1, 1, 8, 0, false, row) + "garbage"),
              "t.png: 7 bytes follow the end of the PNG at byte 70");
    EXPECT_EQ(input_error(png_begin(1, 1, 8, 0, false) + png_chunk("IEND", "")),
              "t.png: PNG without pixels: no IDAT chunk");
    EXPECT_EQ(input_error(png_begin(1, 1, 8, 0, false) + png_chunk("CgBI", "") + png_chunk("IEND", "")),
              "t.png: PNG chunk CgBI at byte 33 is not understood");
    const std::string pixels = png_chunk("IDAT", zlib_stored(row));
    EXPECT_NE(input_error(png_begin(1, 1, 8, 0, false) + pixels + png_chunk("tEXt", "a") + pixels +
                          png_chunk("IEND", ""))
                  .find("apart from the others"),
              std::string::npos);
    EXPECT_EQ(input_error(png_file(1, 1, 8, 3, false, row)), "t.png: PNG cannot be decoded: no PLTE");
}

TEST(Pfm, FloatsReadBackBitByBitAndRowsRunUpwards) {
    Image<float> grey(3, 2);
    grey.pixels = {1.5f, -0.0f, std::numeric_limits<float>::infinity(), 1e-40f, -2.25f, 7.0f};
    const std::string file = encode_pfm(grey.view());
    EXPECT_EQ(file.substr(0, 12), "Pf\n3 2\n-1.0\n");
    float first = 0;
    std::memcpy(&first, file.data() + 12, 4);
    EXPECT_EQ(first, 1e-40f);  // the lowest row comes first
    const auto read = std::get<Image<float>>(decode_pfm(file, "a.pfm"));
    EXPECT_EQ(std::memcmp(read.pixels.data(), grey.pixels.data(), 24), 0);

    Image<Vec3f> colour(2, 2);
    for (int i = 0; i < 4; ++i)
        colour.pixels[static_cast<std::size_t>(i)] = {static_cast<float>(i), 0.5f, -1.0f};
    EXPECT_EQ(std::get<Image<Vec3f>>(decode_pfm(encode_pfm(colour.view()), "b.pfm")), colour);
}

TEST(Pfm, BigEndianFilesRead) {
    const auto image =
        std::get<Image<float>>(decode_pfm(std::string("Pf 1 1 1.0\n\x3f\x80\x00\x00", 15), "big.pfm"));
    EXPECT_EQ(image(0, 0), 1.0f);
}

TEST(Pfm, ValuesAreInTheUnitOfTheScale) {
    const std::string one("\0\0\x80\x3f", 4);
    const auto value = [&](const std::string& scale) {
        return std::get<Image<float>>(decode_pfm("Pf 1 1 " + scale + "\n" + one, "u.pfm"))(0, 0);
    };
    EXPECT_EQ(value("-1"), 1.0f);
    EXPECT_EQ(value("-2"), 2.0f);
    EXPECT_EQ(value("-0.1"), 0.1f);
    const auto colour = std::get<Image<Vec3f>>(decode_pfm("PF 1 1 -4\n" + one + one + one, "c.pfm"));
    EXPECT_EQ(colour(0, 0), (Vec3f{4, 4, 4}));
}

TEST(PfmBad, EveryBrokenHeaderIsRefused) {
    const auto error = [](const std::string& bytes) {
        return message_of<InputError>([&] { decode_pfm(bytes, "t.pfm"); });
    };
    const std::string data(4, '\0');
    EXPECT_EQ(error("P6\n1 1\n-1\n" + data), "t.pfm:1: not a PFM file: expected PF or Pf");
    EXPECT_EQ(error(""), "t.pfm:1: PFM header: no magic at byte 0");
    EXPECT_EQ(error("Pf\n1 x\n-1\n" + data), "t.pfm:2: PFM header: height 'x' is not a number");
    EXPECT_EQ(error("Pf\n1  1\n-1\n" + data), "t.pfm:2: PFM header: no height at byte 5");
    EXPECT_EQ(error("Pf\n1.5 1\n-1\n" + data), "t.pfm:2: PFM header: width '1.5' is not a number");
    EXPECT_EQ(error("Pf\n0 1\n-1\n"), "t.pfm:3: PFM header: size 0 x 1");
    EXPECT_EQ(error("Pf\n-1 -1\n-1\n" + data), "t.pfm:3: PFM header: size -1 x -1");
    EXPECT_EQ(error("Pf\n99999999999999999999 1\n-1\n"),
              "t.pfm:2: PFM header: width '99999999999999999999' is not a number");
    EXPECT_EQ(error("Pf\n1 1\n0\n" + data), "t.pfm:4: PFM header: scale 0");
    EXPECT_EQ(error("Pf\n1 1\nnan\n" + data), "t.pfm:4: PFM header: scale nan");
    EXPECT_EQ(error("Pf\n1 1\n-1\n123"),
              "t.pfm: PFM of 1 x 1 pixels needs 4 bytes from byte 10 on, the file has 3");
    EXPECT_EQ(error("Pf\n1 1\n-1\n12345"),
              "t.pfm: PFM of 1 x 1 pixels needs 4 bytes from byte 10 on, the file has 5");
    const auto limit = [](const std::string& bytes) {
        return message_of<LimitError>([&] { decode_pfm(bytes, "t.pfm"); });
    };
    EXPECT_NE(limit("PF\n30000 2\n-1\n").find("claims 30000 x 2"), std::string::npos);
    EXPECT_NE(limit("PF\n16384 16384\n-1\n").find("3221225472 bytes"), std::string::npos);
    EXPECT_NE(limit("PF\n9223372036854775807 9223372036854775807\n-1\n").find("claims"), std::string::npos);
}

TEST(Png, RealPicturesDecode) {
    const std::filesystem::path folder = shared_folder("data");
    SKIP_WITHOUT(folder);
    int seen = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".png") continue;
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        EXPECT_GT(decode_png(bytes, entry.path().string()).width, 0);
        ++seen;
    }
    EXPECT_GT(seen, 5);
}

}  // namespace
}  // namespace obscura
