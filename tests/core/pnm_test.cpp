// Bit maps and grey maps: what the format allows, and every way to break it.

#include "core/pnm.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/error.h"

namespace obscura {
namespace {

using Codes = std::vector<std::uint16_t>;

GreyCodes read(const std::string& bytes, const ImageFileLimits& limits = {}) {
    return decode_pnm(bytes, "t.pgm", limits);
}

template <class Error>
std::string message(const std::string& bytes, const ImageFileLimits& limits = {}) {
    try {
        read(bytes, limits);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::string bad(const std::string& bytes) {
    return message<InputError>(bytes);
}

TEST(Pnm, PlainBitsNeedNoSpace) {
    for (const char* text :
         {"P1\n3 2\n010110", "P1 3 2 0 1 0\n1 1 0\n", "P1\n# a\n3 # b\n2\n01#c\n0 1 10 # end"}) {
        const GreyCodes image = read(text);
        EXPECT_EQ(image.codes.width, 3) << text;
        EXPECT_EQ(image.codes.height, 2);
        EXPECT_EQ(image.white, 1);
        EXPECT_EQ(image.codes.pixels, (Codes{1, 0, 1, 0, 0, 1})) << "bit 1 is black";
    }
}

TEST(Pnm, RawBitsPadTheirRows) {
    const GreyCodes image = read(std::string("P4\n10 2\n\x80\x7f\x01\x80", 12));
    EXPECT_EQ(image.codes.pixels, (Codes{0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 0, 0, 1}));
}

TEST(Pnm, GreysOfBothKinds) {
    EXPECT_EQ(read("P2\n2 2\n7\n0 1\n6 7").codes.pixels, (Codes{0, 1, 6, 7}));
    EXPECT_EQ(read("P2 1 1 65535 65535").codes.pixels, (Codes{65535}));
    const GreyCodes bytes = read(std::string("P5 # light\n2 1 200\n\x00\xc8", 21));
    EXPECT_EQ(bytes.white, 200);
    EXPECT_EQ(bytes.codes.pixels, (Codes{0, 200}));
    const GreyCodes words = read(std::string("P5\n2 1\n1000\n\x01\x02\x03\xe8", 16));
    EXPECT_EQ(words.white, 1000);
    EXPECT_EQ(words.codes.pixels, (Codes{258, 1000}));
    // The one white space is the last of the header, even when pixels look like more.
    EXPECT_EQ(read("P5\n2 1\n255\n\n\n").codes.pixels, (Codes{10, 10}));
}

TEST(Pnm, KnowsItsFamily) {
    EXPECT_TRUE(is_pnm("P1"));
    EXPECT_TRUE(is_pnm("P7\n"));
    EXPECT_FALSE(is_pnm("P"));
    EXPECT_FALSE(is_pnm("P8"));
    EXPECT_FALSE(is_pnm("PF"));
}

TEST(Pnm, BrokenHeaders) {
    EXPECT_EQ(bad(""), "t.pgm:1: not a PBM or PGM file: expected P1, P2, P4 or P5");
    EXPECT_EQ(bad("P7\n"), "t.pgm:1: not a PBM or PGM file: expected P1, P2, P4 or P5");
    EXPECT_EQ(bad("P6\n1 1\n255\nabc"),
              "t.pgm:1: P6 is a colour picture; a grey one is wanted (P2, P5) or bits (P1, P4)");
    EXPECT_EQ(bad("P5"), "t.pgm:1: truncated: the file ends at byte 2 before the width");
    EXPECT_EQ(bad("P53 2 255\n"), "t.pgm:1: no white space after P5");
    EXPECT_EQ(bad("P5\n3"), "t.pgm:2: truncated: the file ends at byte 4 before the height");
    EXPECT_EQ(bad("P5\n3 2\n# end"), "t.pgm:3: truncated: the file ends at byte 12 before the largest value");
    EXPECT_EQ(bad("P5\n3 two\n"), "t.pgm:2: byte 5: the height is not a number");
    EXPECT_EQ(bad("P5\n-3 2\n255\n"), "t.pgm:2: byte 3: the width is not a number");
    EXPECT_EQ(bad("P4\n0 2\n"), "t.pgm:2: size 0 x 2: there are no pixels");
    EXPECT_EQ(bad("P2 1 1 0 0"), "t.pgm:1: largest value 0 is not from 1 to 65535");
    EXPECT_EQ(bad("P2\n1\n1\n65536 0"), "t.pgm:4: largest value 65536 is not from 1 to 65535");
    EXPECT_EQ(bad("P5\n1 1\n255"), "t.pgm:3: byte 10: one white space must follow the header");
    EXPECT_EQ(bad("P5\n1 1\n255#\n1"), "t.pgm:3: byte 10: one white space must follow the header");
}

TEST(Pnm, BrokenPixels) {
    EXPECT_EQ(bad("P1\n3 2\n01012 0"), "t.pgm:3: byte 11: a bit is neither 0 nor 1");
    EXPECT_EQ(bad("P1\n3 2\n 0 101"), "t.pgm:3: truncated: the file ends at byte 13 before the last pixel");
    EXPECT_EQ(bad("P1\n3 2\n01"), "t.pgm: truncated: 3 x 2 pixels do not fit into 9 bytes");
    EXPECT_EQ(bad("P1\n1 2\n011"), "t.pgm:3: byte 9: more follows the last pixel");
    EXPECT_EQ(bad("P2\n2 1\n9\n3 10\n"), "t.pgm:4: byte 13: pixel 10 above the largest value, 9");
    EXPECT_EQ(bad("P2\n2 1\n9\n3 1.5\n"), "t.pgm:4: byte 12: a pixel is not a number");
    EXPECT_EQ(bad("P2\n2 1\n9\n3  \n"), "t.pgm:5: truncated: the file ends at byte 13 before the pixel");
    EXPECT_EQ(bad("P2\n1 1\n9\n3 4"), "t.pgm:4: byte 11: more follows the last pixel");
    EXPECT_EQ(bad("P5\n1 1\n9\n\x0a"), "t.pgm: byte 9: pixel 10 above the largest value, 9");
    EXPECT_EQ(bad("P5\n2 2\n255\nabc"), "t.pgm: 2 x 2 pixels need 4 bytes from byte 11 on, the file has 3");
    EXPECT_EQ(bad("P5\n2 2\n255\nabcde"), "t.pgm: 2 x 2 pixels need 4 bytes from byte 11 on, the file has 5");
    EXPECT_EQ(bad("P5\r\n1 1\r\n255\r\na"),
              "t.pgm: 1 x 1 pixels need 1 bytes from byte 13 on, the file has 2");
    EXPECT_EQ(bad("P4\n9 1\n\xff"), "t.pgm: 9 x 1 pixels need 2 bytes from byte 7 on, the file has 1");
}

TEST(Pnm, LargeClaimsCostNothing) {
    const auto limit = [](const std::string& bytes) { return message<LimitError>(bytes, {1000, 4000}); };
    EXPECT_EQ(limit("P4\n1001 1\n"), "t.pgm: claims 1001 x 1 pixels, the limit is 1000 a side");
    EXPECT_EQ(limit("P4\n99999999999999999999999999 1\n"),
              "t.pgm: claims 1000000000000 x 1 pixels, the limit is 1000 a side");
    EXPECT_EQ(limit("P5\n100 21\n255\n"), "t.pgm: claims 100 x 21 pixels, 4200 bytes, the limit is 4000");
    // Within limits, yet no bytes behind them.
    EXPECT_EQ(bad("P2\n16384 16384\n255\n1 2"),
              "t.pgm: truncated: 16384 x 16384 pixels do not fit into 22 bytes");
}

TEST(Pnm, EveryCutOfAFileIsRefused) {
    const std::string files[] = {"P1\n4 2\n0110 1001", "P2\n2 2\n300\n123 45 6 78",
                                 std::string("P4\n9 2\nabcd"),
                                 std::string("P5\n2 2\n300\n\0\1\0\2\0\3\0\4", 19)};
    for (const std::string& file : files) {
        ASSERT_NO_THROW(read(file)) << file;
        for (std::size_t n = 0; n < file.size(); ++n) {
            const std::string part = file.substr(0, n);
            // A plain number may lose its last digits unnoticed; all other cuts show.
            if (file[1] == '2' && n > 0 && n + 1 == file.size()) continue;
            EXPECT_THROW(read(part), InputError) << part;
        }
    }
}

}  // namespace
}  // namespace obscura
