#pragma once
// glTF files made for tests: a cube, whose parts may be put in place of others.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "app/models/gltf_file.h"
#include "core/error.h"
#include "tests/models/model_bytes.h"

namespace obscura {

inline std::string bytes_of(const auto& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

/// The cube's eight points, then its 36 indices of 16 bits.
inline std::string cube_buffer() {
    std::vector<std::uint16_t> indices;
    for (const Triangle& t : cube().triangles)
        for (const std::uint32_t v : t.v)
            indices.push_back(static_cast<std::uint16_t>(v));
    return bytes_of(cube().positions) + bytes_of(indices);
}

inline std::string base64(const std::string& bytes) {
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

inline std::string glb(std::string json, std::string binary) {
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

inline Model read_gltf(const std::string& bytes, const Limits& limits = {}) {
    return gltf_from_bytes(bytes, "model.gltf", limits, {}, [](const std::string& uri) {
        return uri == "a cube.bin" ? cube_buffer() : throw InputError(uri, "not found");
    });
}

inline std::string gltf_error(const std::string& bytes) {
    try {
        read_gltf(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

inline void expect_block(const Model& model) {
    EXPECT_EQ(corners_of(model.mesh), corners_of(cube()));
    ASSERT_EQ(model.mesh.components.size(), 1u);
    EXPECT_TRUE(model.mesh.components[0].closed);
    ASSERT_EQ(model.mesh.objects.size(), 1u);
    EXPECT_EQ(model.mesh.objects[0].name, "block");
    ASSERT_EQ(model.materials.size(), 1u);
    EXPECT_EQ(model.materials[0].name, "default");
    EXPECT_TRUE(model.notes.empty());
}

}  // namespace obscura
