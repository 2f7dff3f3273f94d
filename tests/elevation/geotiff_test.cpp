// GeoTIFFs of every layout, code and type of sample come in as they were written; what is wrong with one is
// told.

#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

#include "app/elevation/elevation.h"
#include "core/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/fuzz/elevation_fuzz.h"

namespace obscura {
namespace {

constexpr std::uint32_t pixel_scale_tag = 33550, tie_points_tag = 33922, transformation_tag = 34264,
                        geo_keys_tag = 34735, nodata_tag = 42113;

/// For files that are being written; those that are read find libtiff as it is.
void add_geo_tags(TIFF* tiff) {
    const auto info = [](std::uint32_t tag, TIFFDataType type, const char* name) {
        return TIFFFieldInfo{tag, TIFF_VARIABLE2,         TIFF_VARIABLE2, type, FIELD_CUSTOM, 1,
                             1,   const_cast<char*>(name)};
    };
    static const TIFFFieldInfo infos[] = {
        info(pixel_scale_tag, TIFF_DOUBLE, "scale"), info(tie_points_tag, TIFF_DOUBLE, "tie"),
        info(transformation_tag, TIFF_DOUBLE, "transformation"), info(geo_keys_tag, TIFF_SHORT, "keys"),
        info(nodata_tag, TIFF_ASCII, "hole")};
    TIFFMergeFieldInfo(tiff, infos, 5);
}

struct Picture {
    int width = 37, height = 21;
    int bits = 16, format = SAMPLEFORMAT_INT, code = COMPRESSION_NONE, predictor = 1;
    int tile = 0, rows = 5;  ///< a tile's side, or rows of a strip
    int bands = 1, photometric = PHOTOMETRIC_MINISBLACK;
    bool big_endian = false, big_tiff = false;
    std::vector<double> scale{30, 25, 0}, tie{0, 0, 0, 500000, 4e6, 0}, map{};
    std::vector<std::uint16_t> keys{1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9001};
    std::string nodata{};
    int left_out = -1;  ///< a strip or tile that is not written
};

/// Metres that every type of sample can hold, some of them below 0 where it can.
double height_at(const Picture& p, int x, int y) {
    const int h = (x * 31 + y * 17) % 300 + 100;
    return p.format == SAMPLEFORMAT_UINT ? h : p.format == SAMPLEFORMAT_IEEEFP ? h - 150.25 : h - 200;
}

template <class T>
void put_as(double value, std::vector<std::uint8_t>& to) {
    // What a type cannot hold is its nearest number.
    const T v = static_cast<T>(std::clamp(value, static_cast<double>(std::numeric_limits<T>::lowest()),
                                          static_cast<double>(std::numeric_limits<T>::max())));
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&v);
    to.insert(to.end(), bytes, bytes + sizeof v);
}
void put(const Picture& p, double value, std::vector<std::uint8_t>& to) {
    if (p.format == SAMPLEFORMAT_IEEEFP)
        return p.bits == 32 ? put_as<float>(value, to) : put_as<double>(value, to);
    if (p.format == SAMPLEFORMAT_INT)
        return p.bits == 8    ? put_as<std::int8_t>(value, to)
               : p.bits == 16 ? put_as<std::int16_t>(value, to)
                              : put_as<std::int32_t>(value, to);
    return p.bits == 16 ? put_as<std::uint16_t>(value, to) : put_as<std::uint32_t>(value, to);
}

template <class Height>
std::string written(const Picture& p, Height&& height) {
    const TemporaryFolder folder;
    const std::string path = (folder.path / "a.tif").string();
    const TIFFExtendProc before = TIFFSetTagExtender(add_geo_tags);
    TIFF* t = TIFFOpen(path.c_str(),
                       (std::string("w") + (p.big_endian ? "b" : "l") + (p.big_tiff ? "8" : "")).c_str());
    TIFFSetTagExtender(before);
    EXPECT_NE(t, nullptr);
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, p.width);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, p.height);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, p.bits);
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, p.format);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, p.bands);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, p.photometric);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_COMPRESSION, p.code);
    if (p.predictor > 1) TIFFSetField(t, TIFFTAG_PREDICTOR, p.predictor);
    const auto values = [&](std::uint32_t tag, const auto& list) {
        if (!list.empty()) TIFFSetField(t, tag, static_cast<std::uint32_t>(list.size()), list.data());
    };
    values(pixel_scale_tag, p.scale);
    values(tie_points_tag, p.tie);
    values(transformation_tag, p.map);
    values(geo_keys_tag, p.keys);
    if (!p.nodata.empty())
        TIFFSetField(t, nodata_tag, static_cast<std::uint32_t>(p.nodata.size() + 1), p.nodata.c_str());
    if (p.tile > 0) {
        TIFFSetField(t, TIFFTAG_TILEWIDTH, p.tile);
        TIFFSetField(t, TIFFTAG_TILELENGTH, p.tile);
    } else {
        TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, p.rows);
    }
    const int wide = p.tile > 0 ? p.tile : p.width, high = p.tile > 0 ? p.tile : p.rows;
    int part = 0;
    for (int y0 = 0; y0 < p.height; y0 += high) {
        for (int x0 = 0; x0 < p.width; x0 += wide, ++part) {
            std::vector<std::uint8_t> bytes;
            const int rows = p.tile > 0 ? high : std::min(high, p.height - y0);
            for (int y = y0; y < y0 + rows; ++y) {
                for (int x = x0; x < x0 + wide; ++x) {
                    for (int band = 0; band < p.bands; ++band)
                        put(p, x < p.width && y < p.height ? height(x, y) : 0, bytes);
                }
            }
            if (part == p.left_out) continue;
            const auto size = static_cast<tmsize_t>(bytes.size());
            const auto number = static_cast<std::uint32_t>(part);
            EXPECT_EQ(p.tile > 0 ? TIFFWriteEncodedTile(t, number, bytes.data(), size)
                                 : TIFFWriteEncodedStrip(t, number, bytes.data(), size),
                      size);
        }
    }
    TIFFClose(t);
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string written(const Picture& p) {
    return written(p, [&](int x, int y) { return height_at(p, x, y); });
}

ElevationModel decoded(const Picture& p, const ElevationOptions& options = {}) {
    return decode_elevation(written(p), "a.tif", {}, options);
}

std::string error(const std::string& bytes, const ElevationOptions& options = {}) {
    try {
        decode_elevation(bytes, "a.tif", {}, options);
    } catch (const InputError& e) {
        EXPECT_EQ(e.file, "a.tif");
        return e.message;
    }
    return "no error";
}

void expect_error(const Picture& p, const std::string& message) {
    const std::string told = error(written(p));
    EXPECT_NE(told.find(message), std::string::npos) << told;
}

TEST(GeoTiff, EveryLayoutCodeAndTypeComesInAsItWasWritten) {
    int files = 0;
    const std::pair<int, int> types[] = {{16, SAMPLEFORMAT_INT},    {16, SAMPLEFORMAT_UINT},
                                         {32, SAMPLEFORMAT_INT},    {32, SAMPLEFORMAT_UINT},
                                         {32, SAMPLEFORMAT_IEEEFP}, {64, SAMPLEFORMAT_IEEEFP}};
    for (const auto& [bits, format] : types) {
        for (const int code :
             {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS}) {
            for (const int tile : {0, 16, 48}) {
                for (const int predictor : {1, 2, 3}) {
                    const bool has_predictor = code == COMPRESSION_LZW || code == COMPRESSION_ADOBE_DEFLATE;
                    if (predictor > 1 && !has_predictor) continue;
                    if (predictor == 3 && format != SAMPLEFORMAT_IEEEFP) continue;
                    Picture p{
                        .bits = bits, .format = format, .code = code, .predictor = predictor, .tile = tile};
                    // libtiff 4.5 writes what it does not read itself with both of these.
                    p.big_endian = files % 2 == 1 && predictor != 3;
                    p.big_tiff = files % 3 == 1;
                    const ElevationModel m = decoded(p);
                    ASSERT_EQ(m.field.width(), 37);
                    ASSERT_EQ(m.field.height(), 21);
                    ASSERT_EQ(m.field.cell_x_m, 30);
                    ASSERT_EQ(m.field.cell_y_m, 25);
                    for (int y = 0; y < 21; ++y) {
                        for (int x = 0; x < 37; ++x)
                            ASSERT_EQ(metres_of(m.field.height_q16(x, y)), height_at(p, x, y))
                                << bits << " bits, format " << format << ", code " << code << ", tile "
                                << tile << ", predictor " << predictor << ": " << x << ", " << y;
                    }
                    ++files;
                }
            }
        }
    }
    EXPECT_GT(files, 100);
}

TEST(GeoTiff, CellsAreInMetresFeetOrDegreesAtTheirLatitude) {
    Picture feet;
    feet.keys = {1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9002};
    EXPECT_DOUBLE_EQ(decoded(feet).field.cell_x_m, 30 * 0.3048);
    feet.keys = {1, 1, 0, 3, 1024, 0, 1, 1, 3076, 0, 1, 9001, 4099, 0, 1, 9003};
    EXPECT_NEAR(metres_of(decoded(feet).field.height_q16(0, 0)), -100 * 1200.0 / 3937, 2e-5);
    feet.keys = {1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, 9036};
    expect_error(feet, "has cells in unit 9036: metres and feet are read");

    // 21 rows of a thousandth of a degree below 60.0105 north: their middle is at 60.
    Picture degrees;
    degrees.scale = {0.001, 0.001, 0};
    degrees.tie = {0, 0, 0, 10, 60.0105, 0};
    degrees.keys = {1, 1, 0, 2, 1024, 0, 1, 2, 2054, 0, 1, 9102};
    const HeightField at_60 = decoded(degrees).field;
    EXPECT_NEAR(at_60.cell_x_m, 55.8, 0.01) << "a degree of longitude at 60 is 55,800 m";
    EXPECT_NEAR(at_60.cell_y_m, 111.412, 0.01);
    ElevationOptions at_0;
    at_0.latitude_deg = 0;
    EXPECT_NEAR(decoded(degrees, at_0).field.cell_x_m, 111.319, 0.01) << "what the user says comes first";
    degrees.tie = {};
    expect_error(degrees, "give latitude_deg, or cell_x_m and cell_y_m");
    degrees.keys[11] = 9101;
    expect_error(degrees, "has cells in unit 9101: degrees are read");
    // A file that does not say what its cells are.
    degrees.keys = {};
    degrees.tie = {0, 0, 0, 10, 60.0105, 0};
    expect_error(degrees, "degrees by where it lies");
    Picture metres;
    metres.keys = {};
    EXPECT_EQ(decoded(metres).field.cell_y_m, 25);
    metres.scale = {};
    expect_error(metres, "says nothing about the size of its cells");
    ElevationOptions own;
    own.cell_x_m = 12;
    EXPECT_EQ(decoded(metres, own).field.cell_y_m, 12);
    own.latitude_deg = 50;
    EXPECT_EQ(error(written(metres), own),
              "latitude_deg is for cells in degrees, and cell_x_m or cell_y_m says metres");
    metres.map = {20, 0, 0, 5e5, 0, -15, 0, 4e6, 0, 0, 0, 0, 0, 0, 0, 1};
    EXPECT_EQ(decoded(metres).field.cell_y_m, 15);
    metres.map[1] = 3;
    expect_error(metres, "is turned against the north");
    metres.map[1] = 0;
    metres.map[5] = 15;
    expect_error(metres, "has its first row in the south");
}

TEST(GeoTiff, HolesAreWhatGdalDeclaresWhatIsNaNAndWhatIsLeftOut) {
    ElevationOptions fill;
    fill.holes = HolePolicy::level;
    fill.hole_level_m = 7;
    Picture p{.bits = 32, .format = SAMPLEFORMAT_IEEEFP};
    const auto with = [&](double hole) {
        return decode_elevation(written(p, [&](int x, int y) { return x == 3 && y == 2 ? hole : 50.0; }),
                                "a.tif", {}, fill);
    };
    for (const char* declared : {"-3.4028234663852886e+38", " -3.4028234663852886e+38 ", "-3.40282347e38"}) {
        p.nodata = declared;
        const ElevationModel m = with(-std::numeric_limits<float>::max());
        EXPECT_EQ(m.holes, 1) << declared;
        EXPECT_EQ(metres_of(m.field.height_q16(3, 2)), 7);
    }
    p.nodata = "nan";
    EXPECT_EQ(with(std::numeric_limits<double>::quiet_NaN()).holes, 1);
    p.nodata = "";
    EXPECT_EQ(with(std::numeric_limits<double>::quiet_NaN()).holes, 1);
    EXPECT_THROW(with(-std::numeric_limits<float>::max()), InputError) << "not declared";
    EXPECT_THROW(with(std::numeric_limits<double>::infinity()), InputError);
    p.nodata = "none";
    expect_error(p, "declares samples without a height by 'none', which is no number");
    Picture sparse{.tile = 16, .left_out = 1};
    EXPECT_EQ(decoded(sparse, fill).holes, 16 * 16);
    expect_error(sparse, "256 of 777 samples have no height, the first at column 16, row 0");
    Picture short_one{.left_out = 4};
    EXPECT_EQ(decoded(short_one, fill).holes, 37);
}

TEST(GeoTiff, WhatIsNoModelIsToldAsSuch) {
    expect_error({.bands = 3, .photometric = PHOTOMETRIC_RGB}, "has 3 bands: heights are one");
    expect_error({.bits = 8}, "has samples of 8 bits, format 2: heights have 16 or 32 bits, or are floats");
    expect_error({.photometric = PHOTOMETRIC_MINISWHITE}, "has samples that mean colours (photometric 0)");
    EXPECT_NE(error("").find("is no TIFF that can be read"), std::string::npos);
    EXPECT_NE(error("II*").find("is no TIFF that can be read"), std::string::npos);
    EXPECT_NE(error("P5 1 1 255\n ").find("is no TIFF that can be read"), std::string::npos);
    const std::string whole = written({.code = COMPRESSION_ADOBE_DEFLATE, .tile = 16});
    ElevationOptions small;
    small.max_bytes = 4000;
    EXPECT_THROW(decode_elevation(whole, "a.tif", {}, small), LimitError);
}

/// Cut short and altered files are read or refused, and nothing else: also what the fuzzer tries.
TEST(GeoTiff, CutShortAndAlteredFilesAreReadOrRefused) {
    std::mt19937_64 random(5);
    int refused = 0;
    for (const int code : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
        for (const int tile : {0, 16}) {
            const std::string whole = written({.code = code, .tile = tile, .nodata = "-9999"});
            const auto attempt = [&](const std::string& bytes) {
                try_elevation({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
                ElevationOptions o;
                o.max_bytes = 1 << 20;
                try {
                    decode_elevation(bytes, "a.tif", {}, o);
                } catch (const InputError&) {
                    ++refused;
                } catch (const LimitError&) {
                    ++refused;
                }
            };
            for (std::size_t size = 0; size < whole.size(); size += 7)
                attempt(whole.substr(0, size));
            for (int i = 0; i < 400; ++i) {
                std::string bad = whole;
                for (int n = 0; n < 1 + i % 3; ++n)
                    bad[random() % bad.size()] = static_cast<char>(random());
                attempt(bad);
            }
        }
    }
    EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace obscura
