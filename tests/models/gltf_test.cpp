#include "app/models/gltf_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/models/model_file.h"
#include "app/models/obj_file.h"
#include "core/error.h"
#include "core/image_io.h"
#include "tests/core/shared_folder.h"
#include "tests/core/temporary_folder.h"
#include "tests/models/gltf_bytes.h"

namespace obscura {
namespace {

TEST(GltfFile, BuffersAreDataOrFilesOrTheFilesOwn) {
    CubeJson cube;
    expect_block(read_gltf(cube.text()));
    cube.uri = "\"uri\":\"a%20cube.bin\",";
    expect_block(read_gltf(cube.text()));
    cube.uri = "";
    expect_block(read_gltf(glb(cube.text(), cube_buffer())));
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
