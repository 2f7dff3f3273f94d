#pragma once
// Models written as PLY and STL, for tests: the formats' other ends.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace obscura {

enum class PlyKind { ascii, little, big };

/// Values of a PLY body.
class PlyBytes {
  public:
    explicit PlyBytes(PlyKind kind) : kind_(kind) {}

    template <class T>
    PlyBytes& put(T value) {
        if (kind_ == PlyKind::ascii) {
            if constexpr (sizeof(T) == 1)
                out += fmt::format("{} ", int{value});
            else
                out += fmt::format("{} ", value);
            return *this;
        }
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        if (kind_ == PlyKind::big) std::reverse(bytes, bytes + sizeof(T));
        out.append(bytes, sizeof(T));
        return *this;
    }
    PlyBytes& end() {
        if (kind_ == PlyKind::ascii) out += '\n';
        return *this;
    }

    std::string out;

  private:
    PlyKind kind_;
};

inline std::string ply_head(PlyKind kind) {
    const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    return fmt::format("ply\nformat {} 1.0\ncomment written by a test\n", names[static_cast<int>(kind)]);
}

/// Positions and triangles.
inline std::string ply_of(const Mesh& mesh, PlyKind kind) {
    PlyBytes body(kind);
    for (const Vec3f& p : mesh.positions)
        body.put(p.x).put(p.y).put(p.z).end();
    for (const Triangle& t : mesh.triangles) {
        body.put(std::uint8_t{3});
        for (const std::uint32_t v : t.v)
            body.put(static_cast<std::int32_t>(v));
        body.end();
    }
    return ply_head(kind) +
           fmt::format(
               "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
               "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
               mesh.positions.size(), mesh.triangles.size()) +
           body.out;
}

inline std::string binary_stl_of(const Mesh& mesh) {
    std::string out(80, ' ');
    const auto put = [&](const auto& value) {
        out.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
        put(Vec3f{0, 0, 0});
        for (const std::uint32_t v : t.v)
            put(mesh.positions[v]);
        put(std::uint16_t{0});
    }
    return out;
}

inline std::string text_stl_of(const Mesh& mesh, const std::string& name) {
    std::string out = "solid " + name + "\n";
    for (const Triangle& t : mesh.triangles) {
        out += "facet normal 0 0 0\n  outer loop\n";
        for (const std::uint32_t v : t.v) {
            const Vec3f p = mesh.positions[v];
            out += fmt::format("    vertex {} {} {}\n", p.x, p.y, p.z);
        }
        out += "  endloop\nendfacet\n";
    }
    return out + "endsolid " + name + "\n";
}

/// A cube of side 2 at (1, 2, 3): eight corners, twelve triangles, closed.
inline Mesh cube() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back({static_cast<float>(i & 1 ? 3 : 1), static_cast<float>(i & 2 ? 4 : 2),
                                  static_cast<float>(i & 4 ? 5 : 3)});
    }
    for (const auto& [a, b, c, d] :
         {std::array{0u, 2u, 3u, 1u}, std::array{4u, 5u, 7u, 6u}, std::array{0u, 1u, 5u, 4u},
          std::array{2u, 6u, 7u, 3u}, std::array{0u, 4u, 6u, 2u}, std::array{1u, 3u, 7u, 5u}}) {
        mesh.triangles.push_back({{a, b, c}});
        mesh.triangles.push_back({{a, c, d}});
    }
    return mesh;
}

/// The corners of all triangles, in order.
inline std::vector<Vec3f> corners_of(const Mesh& mesh) {
    std::vector<Vec3f> corners;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t.v)
            corners.push_back(mesh.positions[v]);
    return corners;
}

}  // namespace obscura
