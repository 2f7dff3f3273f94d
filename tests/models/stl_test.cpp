#include "app/models/stl_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "tests/fuzz/model_fuzz.h"
#include "tests/models/model_bytes.h"

namespace obscura {
namespace {

Model read_stl(const std::string& bytes) {
    return stl_from_bytes(bytes, "model.stl", Limits{});
}

std::string stl_error(const std::string& bytes) {
    try {
        read_stl(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void expect_cube(const Model& model) {
    EXPECT_EQ(corners_of(model.mesh), corners_of(cube()));
    EXPECT_EQ(model.file_positions, 8u);
    ASSERT_EQ(model.mesh.components.size(), 1u);
    EXPECT_TRUE(model.mesh.components[0].closed);
    EXPECT_EQ(model.mesh.objects.size(), 1u);
}

TEST(StlFile, EqualCornersAreOneVertex) {
    expect_cube(read_stl(binary_stl_of(cube())));
    expect_cube(read_stl(text_stl_of(cube(), "a cube")));
    EXPECT_EQ(read_stl(text_stl_of(cube(), "a cube")).mesh.objects[0].name, "a cube");
    EXPECT_EQ(read_stl(binary_stl_of(cube())).mesh.objects[0].name, "model");
    // 0 and -0 are one number.
    Mesh mesh = cube();
    for (Vec3f& p : mesh.positions)
        p = p - Vec3f{1, 2, 3};
    std::string bytes = binary_stl_of(mesh);
    const float minus = -0.0f;
    std::memcpy(&bytes[84 + 12], &minus, 4);
    EXPECT_TRUE(read_stl(bytes).mesh.components[0].closed);
}

TEST(StlFile, ATextThatBeginsWithSolidMayBeBinary) {
    std::string bytes = binary_stl_of(cube());
    bytes.replace(0, 5, "solid");
    expect_cube(read_stl(bytes));
}

TEST(StlFile, SolidsAreObjects) {
    const Model model = read_stl("\r\n" + text_stl_of(cube(), "one") + text_stl_of(cube(), "two") +
                                 text_stl_of(cube(), "one"));
    ASSERT_EQ(model.mesh.objects.size(), 2u);
    EXPECT_EQ(model.mesh.objects[1].name, "two");
    EXPECT_EQ(model.mesh.object[12], 1u);
    EXPECT_EQ(model.mesh.object[24], 0u);
}

TEST(StlFile, AttributesAreTold) {
    std::string bytes = binary_stl_of(cube());
    bytes[84 + 50 * 4 + 48] = 1;
    const Model model = read_stl(bytes);
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0], "model.stl: attributes (colours) of 1 triangle are not read");
}

TEST(StlFile, NormalsNeedNotBeNumbers) {
    std::string text = text_stl_of(cube(), "");
    text.replace(text.find("normal 0 0 0"), 12, "normal -1.#IND nan 1.#QNAN");
    expect_cube(read_stl(text));
}

TEST(StlFile, KeywordsMayBeLargeAndNamesMayEndInBackslashes) {
    std::string text = text_stl_of(cube(), "C:\\parts\\");
    EXPECT_EQ(read_stl(text).mesh.objects[0].name, "C:\\parts\\");
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    expect_cube(read_stl(text));
}

TEST(StlFile, CutAnywhereIsRefused) {
    const std::string bytes = binary_stl_of(cube()), text = text_stl_of(cube(), "cube");
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_NE(stl_error(bytes.substr(0, size)), "no error") << size;
    // Up to the last line's name and end.
    for (std::size_t size = 0; size + 6 < text.size(); ++size)
        EXPECT_NE(stl_error(text.substr(0, size)), "no error") << size;
}

TEST(StlFile, BytesByChanceAreReadOrRefused) {
    std::mt19937 random(3);
    for (const std::string& whole : {binary_stl_of(cube()), text_stl_of(cube(), "cube")}) {
        for (int i = 0; i < 3000; ++i) {
            std::string bytes = whole;
            for (int k = 0; k <= i % 4; ++k)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            try_model({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
        }
    }
}

TEST(StlFile, ErrorsSayWhereAndWhat) {
    const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
    EXPECT_EQ(stl_error("solid\n" + facet + "vertex 1 1 0\nendloop\nendfacet\nendsolid\n"),
              "model.stl:7: a facet of more than three corners");
    EXPECT_EQ(stl_error("solid\n" + facet + "endfacet\nendsolid\n"),
              "model.stl:7: expected 'endloop', not 'endfacet'");
    EXPECT_EQ(stl_error("solid\nfacet normal 0 0\n"), "model.stl:2: three numbers are expected");
    EXPECT_EQ(stl_error("solid\nfacet normal 0 0 1 1\n"), "model.stl:2: '1' is too much here");
    EXPECT_EQ(stl_error("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0,5 0\n"),
              "model.stl:4: '0,5' is not a number (decimals are written with a point)");
    EXPECT_EQ(stl_error("solid\n" + facet + "endloop\nendfacet\n"),
              "model.stl:8: the file ends where 'facet' or 'endsolid' is expected");
    std::string cut = binary_stl_of(cube());
    cut.replace(0, 5, "solid");
    EXPECT_EQ(stl_error(cut.substr(0, 600)),
              "model.stl: is no STL file, or cut: a binary one of 12 triangles has 684 bytes, not 600");
    EXPECT_EQ(stl_error("v 0 0 0\n"), "model.stl: is no STL file: 8 bytes and no 'solid'");
    EXPECT_EQ(stl_error(binary_stl_of(cube()) + "x"),
              "model.stl: is no STL file, or cut: a binary one of 12 triangles has 684 bytes, not 685");
    Mesh mesh = cube();
    mesh.positions[7].z = std::nanf("");
    EXPECT_EQ(stl_error(binary_stl_of(mesh)), "model.stl: triangle 2: a coordinate is not finite");
}

TEST(StlFile, LimitsAreKept) {
    Limits limits;
    limits.triangles = 11;
    EXPECT_THROW(stl_from_bytes(binary_stl_of(cube()), "model.stl", limits), LimitError);
    EXPECT_THROW(stl_from_bytes(text_stl_of(cube(), ""), "model.stl", limits), LimitError);
}

}  // namespace
}  // namespace obscura
