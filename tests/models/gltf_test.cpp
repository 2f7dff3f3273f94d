#include "app/models/gltf_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "app/models/model_file.h"
#include "app/models/obj_file.h"
#include "core/error.h"
#include "core/image_io.h"
#include "tests/core/shared_folder.h"
#include "tests/core/temporary_folder.h"
#include "tests/fuzz/model_fuzz.h"
#include "tests/models/model_bytes.h"

namespace obscura {
namespace {

std::string bytes_of(const auto& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

/// The cube's eight points, then its 36 indices of 16 bits.
std::string cube_buffer() {
    std::vector<std::uint16_t> indices;
    for (const Triangle& t : cube().triangles)
        for (const std::uint32_t v : t.v)
            indices.push_back(static_cast<std::uint16_t>(v));
    return bytes_of(cube().positions) + bytes_of(indices);
}

std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t v = 0;
        for (std::size_t k = 0; k < 3; ++k)
            v = v << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? digits[v >> (18 - 6 * k) & 63u] : '=';
    }
    return out;
}

/// Everything of a file with the cube; parts may be put in place of others.
struct CubeJson {
    std::string uri = "\"uri\":\"data:application/octet-stream;base64," + base64(cube_buffer()) + "\",";
    std::string nodes = R"([{"mesh":0,"name":"block"}])";
    std::string primitive = R"({"attributes":{"POSITION":0},"indices":1})";
    std::string accessors =
        R"([{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"},
            {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}])";
    std::string views = R"([{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}])";
    std::string more;
    std::string version = "2.0";

    std::string text() const {
        return "{\"asset\":{\"version\":\"" + version + "\"},\"buffers\":[{" + uri +
               "\"byteLength\":168}],\"bufferViews\":" + views + ",\"accessors\":" + accessors +
               ",\"meshes\":[{\"primitives\":[" + primitive + "]}],\"nodes\":" + nodes + more + "}";
    }
};

std::string glb(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string out = "glTF";
    const auto put = [&](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        out.append(reinterpret_cast<const char*>(&v), 4);
    };
    put(2);
    put(28 + json.size() + binary.size());
    put(json.size());
    out += "JSON" + json;
    put(binary.size());
    return out + std::string("BIN\0", 4) + binary;
}

Model read_gltf(const std::string& bytes, const Limits& limits = {}) {
    return gltf_from_bytes(bytes, "model.gltf", limits, {}, [](const std::string& uri) {
        return uri == "a cube.bin" ? cube_buffer() : throw InputError(uri, "not found");
    });
}

std::string gltf_error(const std::string& bytes) {
    try {
        read_gltf(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void expect_cube(const Model& model) {
    EXPECT_EQ(corners_of(model.mesh), corners_of(cube()));
    ASSERT_EQ(model.mesh.components.size(), 1u);
    EXPECT_TRUE(model.mesh.components[0].closed);
    ASSERT_EQ(model.mesh.objects.size(), 1u);
    EXPECT_EQ(model.mesh.objects[0].name, "block");
    ASSERT_EQ(model.materials.size(), 1u);
    EXPECT_EQ(model.materials[0].name, "default");
    EXPECT_TRUE(model.notes.empty());
}

TEST(GltfFile, BuffersAreDataOrFilesOrTheFilesOwn) {
    CubeJson cube;
    expect_cube(read_gltf(cube.text()));
    cube.uri = "\"uri\":\"a%20cube.bin\",";
    expect_cube(read_gltf(cube.text()));
    cube.uri = "";
    expect_cube(read_gltf(glb(cube.text(), cube_buffer())));
}

TEST(GltfFile, NodesPlaceWhatTheyHave) {
    CubeJson cube;
    // A quarter turn about y, twice as large, under a parent that moves; and once mirrored.
    cube.nodes = R"([{"children":[1,2],"translation":[10,0,0]},
        {"mesh":0,"rotation":[0,0.70710678118654752,0,0.70710678118654752],"scale":[2,2,2]},
        {"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1],"name":"mirrored"}])";
    const Model model = read_gltf(cube.text());
    ASSERT_EQ(model.mesh.triangles.size(), 24u);
    const std::vector<Vec3f> corners = corners_of(model.mesh), plain = corners_of(obscura::cube());
    for (std::size_t i = 0; i < 36; ++i) {
        EXPECT_NEAR(corners[i].x, 10 + 2 * plain[i].z, 1e-5);
        EXPECT_NEAR(corners[i].y, 2 * plain[i].y, 1e-5);
        EXPECT_NEAR(corners[i].z, -2 * plain[i].x, 1e-5);
    }
    ASSERT_EQ(model.mesh.components.size(), 2u);
    const std::vector<double> volumes = signed_volumes(model.mesh);
    EXPECT_NEAR(volumes[0], 64, 1e-3);
    // Turned the other way, its inside would be outside.
    EXPECT_NEAR(volumes[1], 8, 1e-3);
    EXPECT_EQ(model.mesh.objects[0].name, "node_1");
    EXPECT_EQ(model.mesh.objects[1].name, "mirrored");
}

TEST(GltfFile, TheSceneThatIsShown) {
    CubeJson cube;
    cube.nodes = R"([{"mesh":0},{"mesh":0,"name":"block"}])";
    cube.more = R"(,"scenes":[{"nodes":[0,1]},{"nodes":[1]}],"scene":1)";
    const Model model = read_gltf(cube.text());
    EXPECT_EQ(model.mesh.triangles.size(), 12u);
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0], "model.gltf: further scenes not read (1)");
}

TEST(GltfFile, StripsAndFans) {
    const std::vector<Vec3f> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    for (const int mode : {5, 6}) {
        CubeJson strip;
        strip.uri = "\"uri\":\"data:;base64," + base64(bytes_of(points) + std::string(120, '\0')) + "\",";
        strip.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}])";
        strip.primitive = fmt::format(R"({{"attributes":{{"POSITION":0}},"mode":{}}})", mode);
        const Mesh mesh = read_gltf(strip.text()).mesh;
        ASSERT_EQ(mesh.triangles.size(), 2u) << mode;
        const std::vector<Vec3f> c = corners_of(mesh);
        const std::vector<Vec3f> strip_corners = {points[0], points[1], points[2],
                                                  points[1], points[3], points[2]};
        const std::vector<Vec3f> fan_corners = {points[1], points[2], points[0],
                                                points[2], points[3], points[0]};
        EXPECT_EQ(c, mode == 5 ? strip_corners : fan_corners);
    }
}

TEST(GltfFile, MaterialsAndTextures) {
    Image<Rgba8> red(2, 2);
    red.pixels.assign(4, {255, 0, 0, 255});
    const std::string png = encode_png(red.view());
    CubeJson cube;
    cube.primitive = R"({"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":1})";
    cube.accessors.back() = ',';
    cube.accessors += R"({"componentType":5126,"count":8,"type":"VEC2"}])";
    cube.more =
        R"(,"materials":[{"name":"m","emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}}},
        {"name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"metallicFactor":0,"roughnessFactor":0,
        "baseColorTexture":{"index":0}},"normalTexture":{"index":0},"alphaMode":"BLEND"}],
        "textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,)" +
        base64(png) + R"("}],"animations":[{},{}])";
    const Model model = read_gltf(cube.text());
    ASSERT_EQ(model.materials.size(), 2u);
    EXPECT_EQ(model.materials[0].name, "m");
    EXPECT_EQ(model.materials[0].emission, (Vec3f{4, 2, 0}));
    EXPECT_EQ(model.materials[0].metallic, 1);
    EXPECT_EQ(model.materials[1].name, "m_2");
    EXPECT_EQ(model.materials[1].base_color, (Vec3f{0.5f, 0.25f, 1}));
    EXPECT_EQ(model.materials[1].roughness, 0.02f);
    EXPECT_EQ(model.materials[1].texture, 0);
    ASSERT_EQ(model.texture_bytes.size(), 1u);
    EXPECT_EQ(model.texture_bytes[0], png);
    EXPECT_EQ(model.texture_files[0], "model.gltf#images[0]");
    EXPECT_EQ(model.mesh.material[0], 1u);
    // v runs downwards in the file.
    EXPECT_EQ(model.mesh.uvs.at(0), (Vec2f{0, 1}));
    const std::vector<std::string> notes = {"model.gltf: alphaMode BLEND of materials not read (1)",
                                            "model.gltf: animations not read (2)",
                                            "model.gltf: normalTexture of materials not read (1)"};
    EXPECT_EQ(model.notes, notes);
}

TEST(GltfFile, PicturesThatAreNoPngAreTold) {
    CubeJson cube;
    cube.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    cube.more =
        R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
        "images":[{"uri":"data:image/jpeg;base64,/9j/"}])";
    const Model model = read_gltf(cube.text());
    EXPECT_EQ(model.materials.at(0).texture, -1);
    ASSERT_EQ(model.notes.size(), 1u);
    EXPECT_EQ(model.notes[0],
              "model.gltf: images[0] is no PNG and is not read; its materials show their colour alone");
}

struct Spoiled {
    std::string CubeJson::*part;
    const char* text;
    const char* error;
};

class GltfErrors : public ::testing::TestWithParam<Spoiled> {};

TEST_P(GltfErrors, SayWhereAndWhat) {
    CubeJson cube;
    cube.*GetParam().part = GetParam().text;
    EXPECT_EQ(gltf_error(cube.text()), std::string("model.gltf: ") + GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, GltfErrors,
    ::testing::Values(
        Spoiled{&CubeJson::version, "1.0", "asset: glTF 1.0 is not read, 2.0 is"},
        Spoiled{&CubeJson::uri, "", "buffers[0]: has 0 bytes, not the 168 that it says"},
        Spoiled{&CubeJson::uri, R"("uri":"data:,abc",)", "buffers[0]: its data URI is not base64"},
        Spoiled{&CubeJson::uri, R"("uri":"data:;base64,a-c",)", "buffers[0]: its data URI is not base64"},
        Spoiled{&CubeJson::views, R"([{"buffer":0,"byteOffset":100,"byteLength":96}])",
                "bufferViews[0]: bytes 100 to 196 are not in the buffer's 168"},
        Spoiled{&CubeJson::views, R"([{"buffer":1,"byteLength":96}])",
                "bufferViews[0].buffer: there is no 1 of 1"},
        Spoiled{&CubeJson::views, R"([{"buffer":0}])", "bufferViews[0]: 'byteLength' is missing"},
        Spoiled{&CubeJson::views, R"([{"buffer":0,"byteLength":96,"byteStride":6}])",
                "bufferViews[0].byteStride: is not a multiple of 4 from 4 to 252"},
        Spoiled{&CubeJson::accessors, R"([{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3"}])",
                "accessors[0]: 9 elements do not fit into the view's 96 bytes"},
        Spoiled{&CubeJson::accessors, R"([{"bufferView":0,"componentType":5126,"count":-1,"type":"VEC3"}])",
                "accessors[0].count: is not a whole number from 0 on"},
        Spoiled{&CubeJson::accessors, R"([{"bufferView":0,"componentType":5124,"count":1,"type":"VEC3"}])",
                "accessors[0].componentType: there is no 5124"},
        Spoiled{&CubeJson::accessors, R"([{"bufferView":0,"componentType":5126,"count":1,"type":"VEC5"}])",
                "accessors[0]: there is no type 'VEC5'"},
        Spoiled{&CubeJson::accessors, R"([{"sparse":{},"componentType":5126,"count":1,"type":"VEC3"}])",
                "accessors[0].sparse: sparse accessors are not read"},
        Spoiled{&CubeJson::primitive, R"({"attributes":{"POSITION":1},"indices":1})",
                "meshes[0].primitives[0].attributes.POSITION: its accessor has 1 numbers an element, not 3"},
        Spoiled{&CubeJson::primitive, R"({"attributes":{},"indices":1})",
                "meshes[0].primitives[0].attributes: 'POSITION' is missing"},
        Spoiled{&CubeJson::primitive, R"({"attributes":{"POSITION":0},"indices":0})",
                "meshes[0].primitives[0].indices: its accessor has no unsigned integers"},
        Spoiled{&CubeJson::primitive, R"({"attributes":{"POSITION":0},"indices":7})",
                "meshes[0].primitives[0].indices: there is no 7 of 2"},
        Spoiled{&CubeJson::primitive, R"({"attributes":{"POSITION":0}})",
                "nodes[0], meshes[0].primitives[0]: 8 corners are no triangles"},
        Spoiled{&CubeJson::nodes, R"([{"mesh":0,"rotation":[0,0,0,2]}])",
                "nodes[0].rotation: is not a unit quaternion"},
        Spoiled{&CubeJson::nodes, R"([{"mesh":0,"scale":[1e999,1,1]}])",
                "has a number in its JSON that is too large"},
        Spoiled{&CubeJson::nodes, R"([{"mesh":0,"scale":[1,1]}])", "nodes[0].scale: has 2 numbers, not 3"},
        Spoiled{&CubeJson::nodes, R"([{"mesh":0,"children":[1]},{"children":[1]}])",
                "nodes[1].children[0]: node 1 has two parents"},
        Spoiled{&CubeJson::nodes, R"([{"mesh":0,"scale":[3e38,1,1]}])",
                "nodes[0], meshes[0].primitives[0]: vertex 1 is not finite"},
        Spoiled{&CubeJson::more, R"(,"extensionsRequired":["KHR_draco_mesh_compression"])",
                "extensionsRequired[0]: 'KHR_draco_mesh_compression' is not read"},
        Spoiled{&CubeJson::more, R"(,"materials":[{"pbrMetallicRoughness":{"metallicFactor":2}}])",
                "materials[0].pbrMetallicRoughness.metallicFactor: 2 is not within 0 to 1"}));

TEST(GltfFile, FilesThatAreNotThereAreNamed) {
    CubeJson cube;
    cube.uri = R"("uri":"b.bin",)";
    EXPECT_EQ(gltf_error(cube.text()), "b.bin: not found");
    const TemporaryFolder folder;
    std::ofstream(folder.path / "cube.gltf") << cube.text();
    try {
        load_model(folder.path / "cube.gltf", FileAccess{folder.path, {}}, Limits{});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.file, (folder.path / "cube.gltf").string());
        EXPECT_EQ(error.message.substr(0, 7), "b.bin: ");
    }
    // Nor may they lie anywhere.
    cube.uri = R"("uri":"../../etc/passwd",)";
    std::ofstream(folder.path / "cube.gltf") << cube.text();
    EXPECT_THROW(load_model(folder.path / "cube.gltf", FileAccess{folder.path, {}}, Limits{}), InputError);
}

TEST(GltfFile, NodesAreTrees) {
    CubeJson cube;
    cube.nodes = R"([{"mesh":0},{"mesh":0,"children":[2]},{"children":[1]}])";
    EXPECT_EQ(gltf_error(cube.text()), "model.gltf: nodes: some are their own descendants");
    cube.nodes = R"([{"mesh":0}])";
    cube.more = R"(,"scenes":[{"nodes":[0,0]}])";
    EXPECT_EQ(gltf_error(cube.text()), "model.gltf: scenes[0].nodes[1]: node 0 stands there twice");
}

/// Small files that ask for much: each ends soon, with little memory.
TEST(GltfFile, SmallFilesCannotAskForMuch) {
    CubeJson cube;
    cube.accessors = R"([{"componentType":5126,"count":149999997,"type":"VEC3"}])";
    cube.primitive = R"({"attributes":{"POSITION":0}})";
    EXPECT_EQ(gltf_error(cube.text()), "model.gltf: meshes[0].primitives[0]: accessor 0 has no bufferView");
    // Ten thousand materials of one name, and as many nodes.
    CubeJson names;
    names.more = R"(,"materials":[)";
    names.nodes = "[";
    for (int i = 0; i < 10'000; ++i) {
        names.more += R"({"name":"a"},)";
        names.nodes += R"({"mesh":0,"name":"b"},)";
    }
    names.more.back() = ']';
    names.nodes.back() = ']';
    const Model model = read_gltf(names.text());
    EXPECT_EQ(model.materials.at(9999).name, "a_10000");
    EXPECT_EQ(model.mesh.objects.at(9999).name, "b_10000");
    // Nodes times primitives that draw nothing.
    CubeJson points;
    points.primitive = R"({"attributes":{"POSITION":0},"mode":0})";
    for (int i = 0; i < 10'000; ++i)
        points.primitive += R"(,{"attributes":{"POSITION":0},"mode":0})";
    points.nodes = "[";
    for (int i = 0; i < 10'000; ++i)
        points.nodes += R"({"mesh":0},)";
    points.nodes.back() = ']';
    EXPECT_EQ(read_gltf(points.text()).notes.at(1), "model.gltf: points and lines not read (10001)");
    // One file under many names of buffers is held once.
    Limits limits;
    limits.memory_mib = 1;
    CubeJson held;
    held.uri = "";
    for (int i = 0; i < 1000; ++i)
        held.uri += "\"uri\":\"a%20cube.bin\",\"byteLength\":168},{";
    held.uri += "\"uri\":\"a%20cube.bin\",";
    EXPECT_EQ(read_gltf(held.text(), limits).mesh.triangles.size(), 12u);
}

TEST(GltfFile, ManyCornersMayMeetInOnePoint) {
    // Twenty thousand triangles about one point, every corner there with a normal of its own.
    const int count = 20'000;
    std::vector<Vec3f> points, normals;
    for (int i = 0; i < count; ++i) {
        points.insert(points.end(),
                      {{0, 0, 0}, {1, static_cast<float>(i), 0}, {1, static_cast<float>(i) + 0.5f, 0}});
        const Vec3f n = to_float(normalize(Vec3d{1, 1.0 * i, 3}));
        normals.insert(normals.end(), {n, n, n});
    }
    CubeJson fan;
    fan.uri = "\"uri\":\"data:;base64," + base64(bytes_of(points) + bytes_of(normals)) + "\",";
    fan.views = fmt::format(
        R"([{{"buffer":0,"byteLength":{0}}},{{"buffer":0,"byteOffset":{0},"byteLength":{0}}}])", count * 36);
    fan.accessors = fmt::format(
        R"([{{"bufferView":0,"componentType":5126,"count":{0},"type":"VEC3"}},{{"bufferView":1,"componentType":5126,"count":{0},"type":"VEC3"}}])",
        3 * count);
    fan.primitive = R"({"attributes":{"POSITION":0,"NORMAL":1}})";
    std::string text = fan.text();
    text.replace(text.find("\"byteLength\":168"), 16, fmt::format("\"byteLength\":{}", count * 72));
    const Model model = read_gltf(text);
    EXPECT_EQ(model.mesh.triangles.size(), static_cast<std::size_t>(count));
    EXPECT_GT(model.mesh.positions.size(), static_cast<std::size_t>(2 * count));
}

TEST(GltfFile, TexturesThatAreMissing) {
    CubeJson cube;
    cube.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    cube.more =
        R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},
        {"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}],"textures":[{"source":0},{"source":1}],
        "images":[{"uri":"gone.png"},{"uri":"unused.png"}])";
    const TemporaryFolder folder;
    std::ofstream(folder.path / "cube.gltf") << cube.text();
    const FileAccess access{folder.path, {}};
    try {
        load_model(folder.path / "cube.gltf", access, Limits{});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.message.substr(0, 20), "images[0]: gone.png:");
        EXPECT_NE(error.message.find("--allow-missing"), std::string::npos);
    }
    ModelOptions options;
    options.allow_missing = true;
    const Model model = load_model(folder.path / "cube.gltf", access, Limits{}, options);
    EXPECT_EQ(model.materials.at(0).texture, -1);
    EXPECT_EQ(model.missing.size(), 1u);
}

TEST(GltfFile, WhatMapsWouldTakeAwayIsNotShown) {
    CubeJson cube;
    cube.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    cube.more =
        R"(,"materials":[{"name":"default","emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},
        "pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}}}])";
    const Model model = read_gltf(cube.text());
    EXPECT_EQ(model.materials.at(0).emission, (Vec3f{0, 0, 0}));
    EXPECT_EQ(model.materials.at(0).metallic, 0);
    ASSERT_EQ(model.notes.size(), 2u);
    EXPECT_EQ(model.notes[0],
              "model.gltf: emissiveTexture of materials, which do not shine then, not read (1)");
}

TEST(GltfFile, NamesAreShownAsOneLine) {
    CubeJson cube;
    cube.nodes = R"([{"mesh":0,"name":"a\nb\u001b[1m"}])";
    EXPECT_EQ(read_gltf(cube.text()).mesh.objects.at(0).name, "a?b?[1m");
}

TEST(GltfFile, IndicesBeyondTheVerticesAreRefused) {
    CubeJson cube;
    std::string buffer = cube_buffer();
    buffer[96 + 2 * 5] = 8;
    cube.uri = "";
    EXPECT_EQ(gltf_error(glb(cube.text(), buffer)),
              "model.gltf: nodes[0], meshes[0].primitives[0]: there is no vertex 8 of 8");
}

TEST(GltfFile, DeepAndLongJsonEndsNothing) {
    EXPECT_EQ(gltf_error(std::string(2'000'000, '[')), "model.gltf: is not sound JSON at byte 2000001");
    const std::string deep = std::string(500'000, '[') + std::string(500'000, ']');
    EXPECT_EQ(gltf_error(deep), "model.gltf: its JSON is not an object");
    CubeJson cube;
    cube.more = R"(,"extras":)" + deep;
    expect_cube(read_gltf(cube.text()));
    // A chain of nodes, one below the other.
    cube.nodes = "[";
    for (int i = 1; i < 100'000; ++i)
        cube.nodes += fmt::format("{{\"children\":[{}]}},", i);
    cube.nodes += R"({"mesh":0,"name":"block"}])";
    cube.more = "";
    expect_cube(read_gltf(cube.text()));
}

TEST(GltfFile, LimitsAreKept) {
    Limits limits;
    limits.triangles = 11;
    EXPECT_THROW(read_gltf(CubeJson().text(), limits), LimitError);
}

TEST(GltfFile, CutAnywhereIsRefused) {
    CubeJson cube;
    const std::string text = cube.text();
    for (std::size_t size = 0; size < text.size(); ++size)
        EXPECT_NE(gltf_error(text.substr(0, size)), "no error") << size;
    cube.uri = "";
    const std::string whole = glb(cube.text(), cube_buffer());
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_NE(gltf_error(whole.substr(0, size)), "no error") << size;
}

TEST(GltfFile, BytesByChanceAreReadOrRefused) {
    CubeJson cube;
    cube.uri = "";
    const std::string whole = glb(cube.text(), cube_buffer());
    std::mt19937 random(11);
    for (int i = 0; i < 3000; ++i) {
        std::string bytes = whole;
        // Digits for digits, that more is read than refused.
        for (int k = 0; k <= i % 3; ++k) {
            char& c = bytes[random() % bytes.size()];
            c = c >= '0' && c <= '9' ? static_cast<char>('0' + random() % 10) : static_cast<char>(random());
        }
        try_model({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    }
}

double volume_of(const Mesh& mesh) {
    double sum = 0;
    const std::vector<double> volumes = signed_volumes(mesh);
    for (std::size_t c = 0; c < volumes.size(); ++c)
        sum += mesh.components[c].closed ? volumes[c] : 0;
    return sum;
}

/// What another program makes of a published model has the same triangles and the same solids.
TEST(GltfFile, OthersWriteTheSameModel) {
    const std::filesystem::path source = shared_folder("data/cities/fzk_house.obj");
    SKIP_WITHOUT(source);
    if (std::system("assimp version > /dev/null 2>&1") != 0) GTEST_SKIP() << "SKIPPED: no assimp here";
    const TemporaryFolder folder;
    const Model obj = load_obj(source, FileAccess{source.parent_path(), {}}, Limits{});
    const auto closed = [](const Mesh& mesh) {
        return std::count_if(mesh.components.begin(), mesh.components.end(),
                             [](const Component& c) { return c.closed; });
    };
    for (const auto& [kind, name] : {std::pair{"glb2", "house.glb"}, std::pair{"gltf2", "house.gltf"}}) {
        const std::filesystem::path file = folder.path / name;
        const std::string command = fmt::format("assimp export '{}' '{}' -f{} > /dev/null 2>&1",
                                                source.string(), file.string(), kind);
        ASSERT_EQ(std::system(command.c_str()), 0);
        const Model model = load_model(file, FileAccess{folder.path, {}}, Limits{});
        EXPECT_EQ(model.mesh.triangles.size(), obj.mesh.triangles.size());
        EXPECT_EQ(model.mesh.objects.size(), obj.mesh.objects.size());
        EXPECT_EQ(closed(model.mesh), closed(obj.mesh));
        EXPECT_EQ(model.topology.welded.open, obj.topology.welded.open);
        // It cuts polygons along other diagonals, and rounds numbers once more.
        EXPECT_NEAR(volume_of(model.mesh), volume_of(obj.mesh), 1e-4 * volume_of(obj.mesh));
    }
}

}  // namespace
}  // namespace obscura
