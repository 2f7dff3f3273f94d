// glTF files that are wrong, cut, or ask for much.

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "app/models/model_file.h"
#include "core/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/fuzz/model_fuzz.h"
#include "tests/models/gltf_bytes.h"

namespace obscura {
namespace {

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
    expect_block(read_gltf(cube.text()));
    // A chain of nodes, one below the other.
    cube.nodes = "[";
    for (int i = 1; i < 100'000; ++i)
        cube.nodes += fmt::format("{{\"children\":[{}]}},", i);
    cube.nodes += R"({"mesh":0,"name":"block"}])";
    cube.more = "";
    expect_block(read_gltf(cube.text()));
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

}  // namespace
}  // namespace obscura
