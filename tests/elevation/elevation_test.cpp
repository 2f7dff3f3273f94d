// Elevation models come in as they are, and what is wrong with a file is told with its place.

#include <gtest/gtest.h>

#include <cmath>

#include "app/elevation/elevation.h"
#include "core/error.h"
#include "core/image_io.h"

namespace obscura {
namespace {

using namespace std::string_literals;

constexpr const char* esri =
    "NCOLS 3\nnrows 2\nxllcorner 4e5\nyllcorner 5e6\ncellsize 25\nNODATA_value -9999\n"
    "1 2.5 3\n-4 -9999 6\n";
const std::string pgm = "P5 3 2 65535\n\0\1\0\2\1\0\0\4\0\5\0\6"s;
constexpr const char* json =
    "{ \"width\": 3, \"height\": 2, \"cell_size_x_m\": 20.0, \"cell_size_y_m\": 30,\n"
    " \"elevation_scale_m\": 0.5, \"elevation_offset_m\": -10, \"file\": \"a \\\"b\\\"\" }";

std::string hgt(std::int16_t height) {
    std::string bytes;
    for (int i = 0; i < 1201 * 1201; ++i) {
        bytes += static_cast<char>(height >> 8 & 255);
        bytes += static_cast<char>(height & 255);
    }
    return bytes;
}

double metres(const ElevationModel& m, int x, int y) {
    return metres_of(m.field.height_q16(x, y));
}

TEST(Elevation, PgmWithItsDescription) {
    const ElevationModel m = decode_elevation(pgm, "a.pgm", json, {});
    EXPECT_EQ(m.field.width(), 3);
    EXPECT_EQ(m.field.cell_x_m, 20);
    EXPECT_EQ(m.field.cell_y_m, 30);
    EXPECT_EQ(metres(m, 0, 0), -9.5);
    EXPECT_EQ(metres(m, 2, 0), 118) << "most significant byte first";
    EXPECT_EQ(metres(m, 2, 1), -7);
    EXPECT_EQ(m.greatest_m, 118);
    EXPECT_EQ(sidecar_name("dir.pgm/a.PGM"), "dir.pgm/a.json");
    EXPECT_EQ(sidecar_name("a.asc"), "");
}

TEST(Elevation, WhatTheUserSaysComesBeforeTheFile) {
    ElevationOptions o;
    o.cell_x_m = 7;
    o.z_step_m = 2;
    o.exaggeration = 3;
    const ElevationModel m = decode_elevation(pgm, "a.pgm", json, o);
    EXPECT_EQ(m.field.cell_x_m, 7);
    EXPECT_EQ(m.field.cell_y_m, 7) << "one alone is for both";
    EXPECT_EQ(metres(m, 0, 0), 3 * (2 * 1 - 10));
    EXPECT_EQ(decode_elevation(pgm, "a.pgm", {}, o).least_m, 6) << "no description needed";
}

TEST(Elevation, EsriGrid) {
    ElevationOptions o;
    o.holes = HolePolicy::fill;
    const ElevationModel m = decode_elevation(esri, "a.asc", {}, o);
    EXPECT_EQ(m.field.cell_x_m, 25);
    EXPECT_EQ(metres(m, 1, 0), 2.5);
    EXPECT_EQ(m.holes, 1);
    EXPECT_NEAR(metres(m, 1, 1), (1 + 2.5 + 3 - 4 + 6) / 5, height_unit_m);
    o.holes = HolePolicy::level;
    o.hole_level_m = 77;
    EXPECT_EQ(metres(decode_elevation(esri, "a.asc", {}, o), 1, 1), 77);
}

TEST(Elevation, SrtmIsPlacedByItsName) {
    const ElevationModel m = decode_elevation(hgt(-12), "maps/N37E014.hgt", {}, {});
    EXPECT_EQ(m.field.width(), 1201);
    EXPECT_EQ(metres(m, 600, 7), -12);
    EXPECT_NEAR(m.field.cell_y_m, 92.49, 0.02) << "3 arc seconds at 37.5 degrees on WGS84";
    EXPECT_NEAR(m.field.cell_x_m, 73.69, 0.02);
    EXPECT_EQ(decode_elevation(hgt(1), "S37W014.hgt", {}, {}).field.cell_x_m,
              decode_elevation(hgt(1), "N36W014.hgt", {}, {}).field.cell_x_m);
}

TEST(Elevation, TheUsersLatitudeComesBeforeTheName) {
    ElevationOptions o;
    o.latitude_deg = 60.5;
    const double there = decode_elevation(hgt(1), "N60E014.hgt", {}, {}).field.cell_x_m;
    EXPECT_EQ(decode_elevation(hgt(1), "N37E014.hgt", {}, o).field.cell_x_m, there);
    EXPECT_EQ(decode_elevation(hgt(1), "etna.hgt", {}, o).field.cell_x_m, there) << "no name is needed then";
}

TEST(Elevation, EsriCellsBelowOneOnTheGlobeNeedAWord) {
    const std::string text = "ncols 2\nnrows 2\nxllcorner -5\nyllcorner 40\ncellsize 0.1\n1 2 -9999 4\n";
    ElevationOptions o;
    o.holes = HolePolicy::fill;
    EXPECT_THROW(decode_elevation(text, "a.asc", {}, o), InputError);
    o.cell_x_m = 0.1;
    const ElevationModel metric = decode_elevation(text, "a.asc", {}, o);
    EXPECT_EQ(metric.field.cell_x_m, 0.1);
    EXPECT_EQ(metric.holes, 1) << "-9999 is a hole when no NODATA_value is given";
    o.cell_x_m = {};
    o.latitude_deg = 40;
    EXPECT_NEAR(decode_elevation(text, "a.asc", {}, o).field.cell_y_m, 11103.6, 1);
}

TEST(Elevation, WhatAMeshTakesIsAskedFromTheHeader) {
    // 3000 x 3000, of which there is only the header.
    std::string png = encode_png(Image<std::uint16_t>(2, 2).view());
    png.replace(16, 8, "\0\0\x0b\xb8\0\0\x0b\xb8"s);
    ElevationOptions o;
    o.cell_x_m = o.z_step_m = 1;
    o.advice = " (limits.memory_mib)";
    const auto said = [&](const std::string& bytes, const std::string& name) -> std::string {
        try {
            decode_elevation(bytes, name, {}, o);
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "";
    };
    o.max_bytes = std::int64_t{104} << 20;
    EXPECT_NE(
        said(png, "a.png").find("take 171 MiB while they are read, more than 104 MiB (limits.memory_mib)"),
        std::string::npos)
        << said(png, "a.png");
    o.max_bytes = std::int64_t{2600} << 20;
    o.as_mesh = true;
    EXPECT_NE(said(png, "a.png").find("as a mesh of a scene, more than 2600 MiB (limits.memory_mib)"),
              std::string::npos)
        << said(png, "a.png");
    o.max_bytes = std::int64_t{100} << 20;
    EXPECT_NE(said("P5 3000 3000 65535\n", "a.pgm").find("(limits.memory_mib)"), std::string::npos);
}

TEST(Elevation, PngOfSixteenBits) {
    Image<std::uint16_t> grey(2, 2);
    grey(1, 0) = 40000;
    ElevationOptions o;
    o.cell_x_m = 10;
    o.z_step_m = 0.01;
    const ElevationModel m = decode_elevation(encode_png(grey.view()), "a.png", {}, o);
    EXPECT_NEAR(metres(m, 1, 0), 400, height_unit_m);
}

TEST(Elevation, HolesAreFilledFromTheirBorder) {
    std::string text = "ncols 9\nnrows 9\ncellsize 1\nnodata_value -1\n";
    for (int i = 0; i < 81; ++i)
        text += i == 0 || i == 80 ? "100 " : "-1 ";
    ElevationOptions o;
    o.holes = HolePolicy::fill;
    const ElevationModel m = decode_elevation(text, "a.asc", {}, o);
    EXPECT_EQ(m.holes, 79);
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 9; ++x)
            EXPECT_EQ(metres(m, x, y), 100);
    }
}

struct Bad {
    const char* what;
    std::string name, bytes;
    std::optional<std::string> sidecar;
    ElevationOptions options;
    std::string message;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

std::vector<Bad> bad_files() {
    const ElevationOptions none;
    ElevationOptions fill, high, tenths, tenfold, somewhere;
    fill.holes = HolePolicy::fill;
    tenths = tenfold = somewhere = fill;
    tenths.z_step_m = 0.1;
    tenfold.exaggeration = 10;
    somewhere.latitude_deg = 40;
    high.cell_x_m = high.z_step_m = 1;
    high.exaggeration = 1000;
    const std::string e = esri, j = json;
    return {
        {"ending", "a.gif", "II*", {}, none, "a.gif: an elevation model is a .pgm"},
        {"no cells", "a.pgm", pgm, {}, none, "a.pgm: says nothing about the size of its cells"},
        {"cut", "a.pgm", pgm.substr(0, pgm.size() - 1), json, none, "a.pgm"},
        {"json end", "a.pgm", pgm, j.substr(0, j.size() - 2), none,
         "a.json:2:72: the file ends within the object"},
        {"json twice", "a.pgm", pgm, replaced(j, "\"file\": \"a", "\"width\": 3, \"file\": \"a"), none,
         "said twice"},
        {"json key", "a.pgm", pgm, replaced(j, "elevation_scale_m", "scale"), none,
         "a.json: has no number 'elevation_scale_m'"},
        {"json size", "a.pgm", pgm, replaced(j, "3", "4"), none, "'width' is 4, and the picture has 3"},
        {"json list", "a.pgm", pgm, replaced(j, "30", "[30]"), none, "a.json:1:68: objects and lists"},
        {"json number", "a.pgm", pgm, replaced(j, "30", ".5e"), none, "a.json:1:68: not a number"},
        {"zero cells", "a.pgm", pgm, replaced(j, "20.0", "0.0"), none, "cells of 0 by 30 m"},
        {"hole", "a.asc", e, {}, none, "a.asc: 1 of 6 samples have no height, the first at column 1, row 1"},
        {"short", "a.asc", replaced(e, " 6\n", ""), {}, fill, "a.asc:8: the file ends after 5 of 6 heights"},
        {"long", "a.asc", e + "7", {}, fill, "a.asc:9: more follows the last height"},
        {"word", "a.asc", replaced(e, "2.5", "2,5"), {}, fill, "a.asc:7: a height: '2,5' is not a number"},
        {"nan", "a.asc", replaced(e, "2.5", "nan"), {}, fill, "a.asc:7: a height: 'nan' is not a number"},
        {"key", "a.asc", replaced(e, "nrows", "rows"), {}, fill, "a.asc:2: 'rows' is no key"},
        {"key twice", "a.asc", replaced(e, "nrows", "ncols"), {}, fill, "a.asc:2: ncols is said twice"},
        {"no rows", "a.asc", replaced(e, "nrows 2\n", ""), {}, fill, "the header has no nrows"},
        {"half a row", "a.asc", replaced(e, "nrows 2", "nrows 2.5"), {}, fill, "nrows is 2.5"},
        {"huge",
         "a.asc",
         replaced(e, "nrows 2", "nrows 20000"),
         {},
         fill,
         "3 by 20000 heights do not fit into"},
        {"degrees",
         "a.asc",
         replaced(replaced(replaced(e, "4e5", "14"), "5e6", "37"), "cellsize 25", "cellsize 0.000833"),
         {},
         fill,
         "has cells of 0.000833 by 0.000833, degrees"},
        {"sea of holes",
         "a.asc",
         "ncols 1\nnrows 1\ncellsize 1\nnodata_value 0\n0",
         {},
         fill,
         "nothing to fill holes from"},
        {"undeclared hole",
         "a.asc",
         replaced(e, " 6\n", " -32768\n"),
         {},
         fill,
         "column 2, row 1: -32768 marks holes, and the file does not declare it"},
        {"undeclared hole of another unit",
         "a.asc",
         replaced(e, " 6\n", " -32768\n"),
         {},
         tenths,
         "column 2, row 1: -32768 marks holes"},
        {"hole between infinities",
         "a.asc",
         "ncols 3\nnrows 5\ncellsize 25\nNODATA_value -9999\n1.7e308 1.7e308 1.7e308\n"
         "-9999 -9999 -9999\n-9999 -9999 -9999\n-9999 -9999 -9999\n-1.7e308 -1.7e308 -1.7e308\n",
         {},
         fill,
         "column 0, row 0: a height of 1.7e+308 m is beyond"},
        {"perhaps degrees",
         "a.asc",
         replaced(replaced(replaced(e, "4e5", "-5"), "5e6", "40"), "cellsize 25", "cellsize 0.1"),
         {},
         fill,
         "give latitude_deg, or cell_x_m and cell_y_m"},
        {"metres and a latitude", "a.asc", e, {}, somewhere, "has cells in metres, and latitude_deg is for"},
        {"json metres and a latitude", "a.pgm", pgm, json, somewhere,
         "has cells in metres, and latitude_deg is for"},
        {"json -nan", "a.pgm", pgm, replaced(j, "-10", "-nan"), none, "not a number"},
        {"json -inf", "a.pgm", pgm, replaced(j, "-10", "-inf"), none, "not a number"},
        {"json upside down", "a.pgm", pgm, replaced(j, "0.5", "-0.5"), none, "'elevation_scale_m' is -0.5"},
        {"exaggerated",
         "a.asc",
         replaced(e, " 6\n", " 4000\n"),
         {},
         tenfold,
         "column 2, row 1: 4000 m times exaggeration 10 is beyond 32767 m"},
        {"too high", "a.pgm", pgm, {}, high, "column 2, row 0: 256 m times exaggeration 1000 is beyond"},
        {"hgt name", "etna.hgt", hgt(0), {}, none, "says where it lies by its name"},
        {"hgt size", "N37E014.hgt", "123", {}, none, "has 3 bytes: an HGT file has"},
        {"png", "a.png", "P5", {}, none, "is no PNG"},
        {"png of 8 bits",
         "a.png",
         encode_png(Image<Rgb8>(2, 2).view()),
         {},
         none,
         "steps too coarse for heights"},
    };
}

TEST(Elevation, BadFilesAreToldWithTheirPlace) {
    for (const Bad& bad : bad_files()) {
        try {
            decode_elevation(bad.bytes, bad.name, bad.sidecar, bad.options);
            ADD_FAILURE() << bad.what << " was taken";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(bad.message), std::string::npos)
                << bad.what << ": " << error.what();
        }
    }
    ElevationOptions small;
    small.max_bytes = 70;
    EXPECT_THROW(decode_elevation(esri, "a.asc", {}, small), LimitError);
    EXPECT_THROW(decode_elevation(pgm, "a.pgm", json, small), LimitError);
}

}  // namespace
}  // namespace obscura
