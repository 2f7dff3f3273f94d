#include "app/models/faces_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <unordered_map>

#include "core/polygon.h"

namespace obscura {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

struct CornerHash {
    std::size_t operator()(const FaceCorner& c) const {
        const std::uint64_t h = (static_cast<std::uint64_t>(c.position) * 0x9e3779b97f4a7c15u) ^
                                (static_cast<std::uint64_t>(c.uv) * 0xc2b2ae3d27d4eb4fu) ^
                                (static_cast<std::uint64_t>(c.normal) * 0x165667b19e3779f9u);
        return static_cast<std::size_t>(h ^ h >> 29);
    }
};

/// Vertices by the corner they stand for: one chain per position, in order of first use. Where many meet in
/// one position, those behind the first few are hashed.
class VertexTable {
  public:
    explicit VertexTable(std::size_t positions) : head_(positions, none) {}

    std::uint32_t find_or_add(const FaceCorner& corner) {
        std::uint32_t* link = &head_[static_cast<std::size_t>(corner.position)];
        int length = 0;
        for (; *link != none && length < most_in_chain; ++length) {
            if (corners[*link] == corner) return *link;
            link = &next_[*link];
        }
        const auto vertex = static_cast<std::uint32_t>(corners.size());
        if (length == most_in_chain) {
            const auto [at, is_new] = crowded_.try_emplace(corner, vertex);
            if (!is_new) return at->second;
            corners.push_back(corner);
            next_.push_back(none);
            return vertex;
        }
        *link = vertex;  // before next_ grows and moves
        corners.push_back(corner);
        next_.push_back(none);
        return vertex;
    }

    std::vector<FaceCorner> corners;

  private:
    static constexpr int most_in_chain = 32;
    std::vector<std::uint32_t> head_, next_;
    std::unordered_map<FaceCorner, std::uint32_t, CornerHash> crowded_;
};

/// Objects that own faces, in the order of the file.
class ObjectTable {
  public:
    ObjectTable(const IndexedFaces& text, const std::string& fallback)
        : text_(text), fallback_(fallback), number_(text.object_names.size() + 1, none) {}

    std::uint32_t number(std::int32_t object) {
        std::uint32_t& n = number_[static_cast<std::size_t>(std::int64_t{object} + 1)];
        if (n == none) {
            n = static_cast<std::uint32_t>(objects.size());
            objects.push_back(
                {object < 0 ? fallback_ : text_.object_names[static_cast<std::size_t>(object)].name});
        }
        return n;
    }

    std::vector<Object> objects;

  private:
    const IndexedFaces& text_;
    const std::string& fallback_;
    std::vector<std::uint32_t> number_;
};

Vec3f unit_or_zero(Vec3f n) {
    return to_float(normalize(to_double(n), {0, 0, 0}));
}

Vec3f about(Vec3d origin, Vec3d p) {
    return to_float(p - origin);
}

/// Along one axis, whose used numbers reach from lo to hi, of a mesh of that extent.
double origin_along(double lo, double hi, double extent) {
    // Beyond either bound a float's step at the far end is more than 1/500,000 of the mesh, or a tenth of a
    // millimetre in metres.
    constexpr double far_in_extents = 16, far = 1024;
    const double nearest = lo > 0 ? lo : hi < 0 ? -hi : 0.0;
    return nearest > std::min(far, far_in_extents * extent) ? std::floor(0.5 * (lo + hi)) : 0.0;
}

/// Whether two corners of a triangle are one as floats, but not in the file.
bool merges(const IndexedFaces& text, Vec3d origin, const std::array<std::int32_t, 3>& corner) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = text.positions[static_cast<std::size_t>(corner[k])];
        const Vec3d b = text.positions[static_cast<std::size_t>(corner[(k + 1) % 3])];
        if (!(a == b) && about(origin, a) == about(origin, b)) return true;
    }
    return false;
}

void fill_vertices(Mesh& mesh, const IndexedFaces& text, Vec3d origin,
                   const std::vector<FaceCorner>& corners) {
    mesh.positions.resize(corners.size());
    mesh.normals.assign(corners.size(), {});
    if (!text.uvs.empty()) mesh.uvs.assign(corners.size(), {});
    for (std::size_t v = 0; v < corners.size(); ++v) {
        const FaceCorner& c = corners[v];
        mesh.positions[v] = about(origin, text.positions[static_cast<std::size_t>(c.position)]);
        if (c.uv >= 0) mesh.uvs[v] = text.uvs[static_cast<std::size_t>(c.uv)];
        if (c.normal >= 0) mesh.normals[v] = unit_or_zero(text.normals[static_cast<std::size_t>(c.normal)]);
    }
}

}  // namespace

Vec3d origin_of(const IndexedFaces& text) {
    if (text.corners.empty()) return {};
    Vec3d lo = text.positions[static_cast<std::size_t>(text.corners[0].position)], hi = lo;
    for (const FaceCorner& corner : text.corners) {
        const Vec3d p = text.positions[static_cast<std::size_t>(corner.position)];
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
    }
    const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
    return {origin_along(lo.x, hi.x, extent), origin_along(lo.y, hi.y, extent),
            origin_along(lo.z, hi.z, extent)};
}

FacesMesh build_faces_mesh(const IndexedFaces& text, const std::string& name, double crease_angle_deg) {
    FacesMesh result;
    result.origin = origin_of(text);
    Mesh& mesh = result.mesh;
    const auto count = static_cast<std::size_t>(text.triangles);
    mesh.triangles.reserve(count);
    mesh.material.reserve(count);
    mesh.object.reserve(count);
    std::vector<std::uint32_t> smoothing;
    smoothing.reserve(count);

    VertexTable vertices(text.positions.size());
    ObjectTable objects(text, name);
    std::vector<Vec3f> outline;
    bool any_lacks = false;
    for (const IndexedFace& face : text.faces) {
        const FaceCorner* corner = &text.corners[face.first_corner];
        outline.clear();
        for (std::uint32_t k = 0; k < face.corner_count; ++k) {
            outline.push_back(
                about(result.origin, text.positions[static_cast<std::size_t>(corner[k].position)]));
        }
        const std::uint32_t object = objects.number(face.object);
        for (const auto& cut : triangulate_polygon(outline)) {
            Triangle triangle;
            for (std::size_t k = 0; k < 3; ++k)
                triangle.v[k] = vertices.find_or_add(corner[cut[k]]);
            mesh.triangles.push_back(triangle);
            const bool lacks = std::any_of(cut.begin(), cut.end(), [&](auto k) { return corner[k].uv < 0; });
            result.without_uv.push_back(lacks);
            any_lacks |= lacks;
            result.merged +=
                merges(text, result.origin,
                       {corner[cut[0]].position, corner[cut[1]].position, corner[cut[2]].position});
            mesh.material.push_back(face.material >= 0
                                        ? static_cast<std::uint32_t>(face.material)
                                        : static_cast<std::uint32_t>(text.material_names.size()));
            mesh.object.push_back(object);
            smoothing.push_back(face.smoothing);
        }
    }
    if (!any_lacks) result.without_uv.clear();
    mesh.objects = std::move(objects.objects);
    fill_vertices(mesh, text, result.origin, vertices.corners);

    // Solids are judged by the file's own indices, before normals split vertices.
    std::vector<std::uint32_t> position_ids;
    position_ids.reserve(vertices.corners.size());
    for (const FaceCorner& c : vertices.corners)
        position_ids.push_back(static_cast<std::uint32_t>(c.position));
    result.topology = analyse_topology(mesh, position_ids);
    compute_normals(mesh, crease_angle_deg, smoothing);
    return result;
}

void note_mesh(const FacesMesh& mesh, const std::string& file, std::vector<std::string>& notes) {
    if (mesh.mesh.triangles.empty()) notes.push_back(fmt::format("{}: has no triangles", file));
    if (mesh.merged > 0) {
        notes.push_back(fmt::format(
            "{}: {} of {} triangles collapse: the file reaches too far for its details in single precision",
            file, mesh.merged, mesh.mesh.triangles.size()));
    }
}

void keep_few(std::vector<std::string>& notes, const std::string& file) {
    constexpr std::size_t few = 40;
    if (notes.size() <= few) return;
    const std::size_t more = notes.size() - few;
    notes.resize(few);
    notes.push_back(fmt::format("{}: {} more kinds of things are not read", file, more));
}

Model model_of_faces(const IndexedFaces& faces, const std::string& file, double crease_angle_deg) {
    FacesMesh built = build_faces_mesh(faces, std::filesystem::path(file).stem().string(), crease_angle_deg);
    Model model;
    note_mesh(built, file, model.notes);
    model.mesh = std::move(built.mesh);
    model.origin = built.origin;
    model.topology = built.topology;
    model.without_uv = std::move(built.without_uv);
    model.file_positions = faces.positions.size();
    model.materials.push_back(Material{.name = "default"});
    return model;
}

}  // namespace obscura
