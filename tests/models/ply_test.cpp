#include "app/models/ply_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "app/models/obj_file.h"
#include "app/models/stl_file.h"
#include "core/error.h"
#include "tests/fuzz/model_fuzz.h"
#include "tests/models/model_bytes.h"

namespace obscura {
namespace {

Model read_ply(const std::string& bytes) {
    return ply_from_bytes(bytes, "model.ply", Limits{});
}

std::string ply_error(const std::string& bytes) {
    try {
        read_ply(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

class Ply : public ::testing::TestWithParam<PlyKind> {};

TEST_P(Ply, IsReadInEveryFormat) {
    const Model model = read_ply(ply_of(cube(), GetParam()));
    EXPECT_EQ(corners_of(model.mesh), corners_of(cube()));
    EXPECT_EQ(model.file_positions, 8u);
    ASSERT_EQ(model.mesh.components.size(), 1u);
    EXPECT_TRUE(model.mesh.components[0].closed);
    ASSERT_EQ(model.materials.size(), 1u);
    EXPECT_EQ(model.materials[0].name, "default");
    ASSERT_EQ(model.mesh.objects.size(), 1u);
    EXPECT_EQ(model.mesh.objects[0].name, "model");
    EXPECT_TRUE(model.notes.empty());
}

TEST_P(Ply, PropertiesOfEveryTypeStandInAnyOrder) {
    // What is not read lies between what is; polygons; faces before vertices.
    PlyBytes body(GetParam());
    body.put(std::uint8_t{7}).put(std::uint16_t{4});
    for (std::uint16_t v = 0; v < 4; ++v)
        body.put(v);
    body.put(std::uint8_t{2}).put(0.5f).put(1.5f).end();
    for (int i = 0; i < 4; ++i) {
        body.put(static_cast<double>(i % 3)).put(std::int16_t{-5}).put(i < 2 ? 0.25 : 2.5).put(0.0f);
        body.put(0.0f).put(0.0f).put(1.0f).put(0.125f * static_cast<float>(i)).put(0.75f);
        body.put(std::int8_t{-1}).put(std::uint32_t{4'000'000'000u}).end();
    }
    body.put(std::int32_t{1}).end();
    const Model model = read_ply(
        ply_head(GetParam()) +
        "obj_info of no use\n"
        "element face 1\nproperty uchar flags\nproperty list ushort ushort vertex_index\n"
        "property list uint8 float32 texcoord\n"
        "element vertex 4\nproperty double x\nproperty short confidence\nproperty float64 y\nproperty "
        "float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
        "property int8 red\nproperty uint id\n"
        "element camera 1\nproperty int view\nend_header\n" +
        body.out);
    ASSERT_EQ(model.mesh.triangles.size(), 2u);
    EXPECT_EQ(model.mesh.positions[model.mesh.triangles[0].v[1]], (Vec3f{1, 0.25f, 0}));
    ASSERT_EQ(model.mesh.uvs.size(), model.mesh.positions.size());
    EXPECT_EQ(model.mesh.uvs[model.mesh.triangles[0].v[1]], (Vec2f{0.125f, 0.75f}));
    for (const Vec3f& n : model.mesh.normals)
        EXPECT_EQ(n, (Vec3f{0, 0, 1}));
    ASSERT_EQ(model.notes.size(), 6u);
    EXPECT_EQ(model.notes[0], "model.ply: property 'flags' of element 'face' is not read");
    EXPECT_EQ(model.notes[5], "model.ply: 1 element 'camera' is not read");
}

TEST_P(Ply, CutAnywhereIsRefused) {
    const std::string whole = ply_of(cube(), GetParam());
    // A text may lack its last line's end, and the blank before it.
    const std::size_t spare = GetParam() == PlyKind::ascii ? 2 : 0;
    for (std::size_t size = 0; size + spare < whole.size(); ++size) {
        const std::string error = ply_error(whole.substr(0, size));
        EXPECT_NE(error, "no error") << size;
    }
}

TEST_P(Ply, BytesByChanceAreReadOrRefused) {
    const std::string whole = ply_of(cube(), GetParam());
    std::mt19937 random(7);
    for (int i = 0; i < 3000; ++i) {
        std::string bytes = whole;
        for (int k = 0; k <= i % 4; ++k)
            bytes[random() % bytes.size()] = static_cast<char>(random());
        try_model({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, Ply, ::testing::Values(PlyKind::ascii, PlyKind::little, PlyKind::big));

TEST(PlyFile, BytesBehindTheLastElementAreTold) {
    const Model model = read_ply(ply_of(cube(), PlyKind::little) + "xyz");
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0], "model.ply: 3 bytes after the last element are not read");
}

TEST(PlyFile, LineEndsOfEverySystem) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text = ply_of(cube(), PlyKind::ascii), other;
        for (const char c : text)
            other += c == '\n' ? std::string(end) : std::string(1, c);
        EXPECT_EQ(corners_of(read_ply(other).mesh), corners_of(cube()));
    }
}

TEST(PlyFile, WhatIsLeftOutIsTold) {
    const Model model = read_ply(
        "ply\nformat ascii 1.0\ncomment TextureFile a brick.png\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float s\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2\n3 2 1 0\n");
    const std::vector<std::string> notes = {"model.ply: property 'nx' of element 'vertex' is not read",
                                            "model.ply: property 'ny' of element 'vertex' is not read",
                                            "model.ply: property 's' of element 'vertex' is not read",
                                            "model.ply: texture 'a brick.png' of a comment is not read",
                                            "model.ply: lines after the last element are not read"};
    EXPECT_EQ(model.notes, notes);
    EXPECT_TRUE(model.mesh.uvs.empty());
}

TEST(PlyFile, BinaryDataBeginBehindTheHeadersOwnLineEnd) {
    // A header of CRs, and a first byte that is an LF.
    std::string head = ply_head(PlyKind::big) +
                       "element face 1\nproperty uchar flags\nproperty list uchar uchar vertex_indices\n"
                       "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    std::replace(head.begin(), head.end(), '\n', '\r');
    PlyBytes body(PlyKind::big);
    body.put(std::uint8_t{10})
        .put(std::uint8_t{3})
        .put(std::uint8_t{0})
        .put(std::uint8_t{1})
        .put(std::uint8_t{2});
    for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
        body.put(v);
    EXPECT_EQ(read_ply(head + body.out).mesh.positions.at(1), (Vec3f{1, 0, 0}));
}

TEST(PlyFile, SurfacesWithoutNormalsAreSmoothUpToTheCreaseAngle) {
    const Mesh mesh = cube();
    ModelOptions smooth, flat;
    smooth.crease_angle_deg = 100;
    flat.crease_angle_deg = 80;
    const std::string bytes = ply_of(mesh, PlyKind::little), stl = binary_stl_of(mesh);
    EXPECT_EQ(ply_from_bytes(bytes, "c", Limits{}, smooth).mesh.positions.size(), 8u);
    EXPECT_EQ(ply_from_bytes(bytes, "c", Limits{}, flat).mesh.positions.size(), 24u);
    EXPECT_EQ(stl_from_bytes(stl, "c", Limits{}, smooth).mesh.positions.size(), 8u);
    EXPECT_EQ(stl_from_bytes(stl, "c", Limits{}, flat).mesh.positions.size(), 24u);
}

TEST(PlyFile, CloudsOfPointsHaveNoTriangles) {
    const Model model = read_ply(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n1 2 3\n");
    EXPECT_TRUE(model.mesh.triangles.empty());
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0], "model.ply: has no triangles");
}

struct Refused {
    const char* header;  ///< behind the vertex element of three vertices, or nothing
    const char* body;
    const char* error;
};

class PlyErrors : public ::testing::TestWithParam<Refused> {};

TEST_P(PlyErrors, SayWhereAndWhat) {
    const std::string text = std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n") +
                             GetParam().header + "end_header\n" + GetParam().body;
    EXPECT_EQ(ply_error(text), GetParam().error);
}

constexpr const char* yz = "property float y\nproperty float z\n";
#define FACES "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
#define POINTS "0 0 0\n1 0 0\n0 1 0\n"
INSTANTIATE_TEST_SUITE_P(
    Cases, PlyErrors,
    ::testing::Values(
        Refused{"property float y\n", "1 2\n3 4\n5 6\n", "model.ply:3: vertices have no property 'z'"},
        Refused{yz, "1.5 2.5\n3 4 5\n6 7 8\n",
                "model.ply:8: the line has fewer values than the header announces"},
        Refused{yz, "1 2 3 4\n3 4 5\n6 7 8\n", "model.ply:8: '4' is more than the header announces"},
        Refused{yz, "1 2 nan\n3 4 5\n6 7 8\n",
                "model.ply:8: 'nan' is not a finite number in single precision"},
        Refused{yz, "1 2 3\n3 4 5     \n", "model.ply:9: the file ends"},
        Refused{FACES, POINTS "3 0 1 3\n", "model.ply: face 0: there is no vertex 3, the last is 2"},
        Refused{FACES, POINTS "3 0 1 -1\n", "model.ply:13: -1 is no index of a vertex"},
        Refused{FACES, POINTS "3 0 1 1.5\n", "model.ply:13: '1.5' is no integer of the property's type"},
        Refused{FACES, POINTS "2 0 1\n", "model.ply:13: a face of 2 corners"},
        Refused{FACES, POINTS "300 0 1\n", "model.ply:13: '300' is no integer of the property's type"},
        Refused{"property list uchar int vertex_indices\nproperty list uchar int vertex_indices\n", "",
                "model.ply:6: a second property 'vertex_indices'"},
        Refused{"element vertex 3\n", "", "model.ply:5: a second element 'vertex'"},
        Refused{"element face 9999999999999\nproperty list uchar int vertex_indices\n", POINTS,
                "model.ply:5: 9999999999999 elements 'face' do not fit into the 18 bytes that follow"},
        Refused{"element face -1\n", "", "model.ply:5: '-1' is no number of elements"},
        Refused{"element face 1\n", POINTS, "model.ply:5: element 'face' has no properties"},
        Refused{"property float y\nproperty float z\nelement face 1\nproperty int a\n", POINTS "1\n",
                "model.ply:7: faces have no list 'vertex_indices'"},
        Refused{
            "property float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\n",
            POINTS "1 1\n", "model.ply:7: triangle strips are not read; write the model as faces"},
        Refused{"property list float int a\n", "", "model.ply:5: a list's length must be an integer"},
        Refused{"property half y\n", "", "model.ply:5: unknown type 'half'"},
        Refused{"properties\n", "", "model.ply:5: unknown word 'properties' in the header"}));

TEST(PlyFile, HeadsOfOtherFilesAreRefused) {
    EXPECT_EQ(ply_error("v 0 0 0\n"), "model.ply:1: is no PLY file: its first line is not 'ply'");
    EXPECT_EQ(ply_error("ply\nelement vertex 1\n"), "model.ply:2: expected 'format'");
    EXPECT_EQ(ply_error("ply\nformat ascii 2.0\n"), "model.ply:2: version '2.0' is not read, 1.0 is");
    EXPECT_EQ(ply_error("ply\nformat text 1.0\n"), "model.ply:2: unknown format 'text'");
    EXPECT_EQ(ply_error("ply\nformat ascii 1.0\nproperty int a\n"),
              "model.ply:3: a property before any element");
    EXPECT_EQ(ply_error("ply\nformat ascii 1.0\n"), "model.ply:3: ends within its header");
}

TEST(PlyFile, BinaryErrorsNameTheElement) {
    Mesh mesh = cube();
    mesh.positions[5].y = std::numeric_limits<float>::infinity();
    EXPECT_EQ(ply_error(ply_of(mesh, PlyKind::big)),
              "model.ply: vertex 5: property 'y' is no finite number within the range of floats");
    mesh = cube();
    mesh.triangles[3].v[1] = 8;
    EXPECT_EQ(ply_error(ply_of(mesh, PlyKind::little)),
              "model.ply: face 3: there is no vertex 8, the last is 7");
}

TEST(PlyFile, LimitsAreKept) {
    Limits limits;
    limits.triangles = 11;
    EXPECT_THROW(ply_from_bytes(ply_of(cube(), PlyKind::big), "model.ply", limits), LimitError);
    limits.triangles = 2;
    try {
        ply_from_bytes(ply_of(cube(), PlyKind::ascii), "model.ply", limits);
        FAIL();
    } catch (const LimitError& error) {
        EXPECT_STREQ(error.what(), "model.ply: has 8 vertices, more than three times limits.triangles = 2");
    }
}

}  // namespace
}  // namespace obscura
