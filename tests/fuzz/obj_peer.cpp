#include "tests/fuzz/obj_peer.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "app/models/obj_file.h"
#include "app/models/obj_text.h"
#include "core/polygon.h"

namespace obscura {
namespace {

struct Difference : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <class... Args>
void expect(bool holds, fmt::format_string<Args...> message, Args&&... args) {
    if (!holds) throw Difference(fmt::format(message, std::forward<Args>(args)...));
}

bool within_ulp(float a, float b) {
    return a == b || std::nextafter(a, b) == b;
}
bool within_ulp(Vec3f a, Vec3f b) {
    return within_ulp(a.x, b.x) && within_ulp(a.y, b.y) && within_ulp(a.z, b.z);
}

/// Gives the library one text for every mtllib, and the last of two materials of one name.
class TextMaterials : public tinyobj::MaterialReader {
  public:
    TextMaterials(std::string text, Feed feed) : text_(std::move(text)), feed_(feed) {}

    bool operator()(const std::string& /*file*/, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* number, std::string* warning, std::string* error) override {
        std::istringstream stream(text_);
        tinyobj::LoadMtl(number, materials, &stream, warning, error);
        if (feed_ == Feed::raw) return true;
        for (std::size_t i = 0; i < materials->size(); ++i)
            (*number)[(*materials)[i].name] = static_cast<int>(i);
        return true;
    }

  private:
    std::string text_;
    Feed feed_;
};

struct PeerFace {
    const std::string* object = nullptr;
    int material = -1;
    std::uint8_t corner_count = 0;  ///< modulo 256
};

/// What the library read, its shapes strung together in the order of the file.
struct PeerModel {
    tinyobj::attrib_t attrib;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::vector<PeerFace> faces;
    std::vector<FaceCorner> corners;
};

PeerModel read_by_library(const std::string& obj, const std::string& mtl, Feed feed) {
    PeerModel peer;
    std::istringstream stream(obj);
    TextMaterials reader(mtl, feed);
    std::string warning, error;
    const bool read = tinyobj::LoadObj(&peer.attrib, &peer.shapes, &peer.materials, &warning, &error, &stream,
                                       &reader, /*triangulate=*/false, /*default_vcols_fallback=*/false);
    expect(read, "the library refuses the file: {}", error);
    for (const tinyobj::shape_t& shape : peer.shapes) {
        for (const tinyobj::index_t& i : shape.mesh.indices)
            peer.corners.push_back({i.vertex_index, i.texcoord_index, i.normal_index});
        for (std::size_t f = 0; f < shape.mesh.num_face_vertices.size(); ++f)
            peer.faces.push_back({&shape.name, shape.mesh.material_ids[f], shape.mesh.num_face_vertices[f]});
    }
    return peer;
}

void compare_numbers(std::string_view what, const float* ours, std::size_t count,
                     const std::vector<float>& theirs) {
    expect(count == theirs.size(), "{} numbers of {}, the library has {}", count, what, theirs.size());
    for (std::size_t i = 0; i < count; ++i)
        expect(within_ulp(ours[i], theirs[i]), "{}, number {}: {}, the library has {}", what, i, ours[i],
               theirs[i]);
}

void compare_elements(const ObjText& text, const tinyobj::attrib_t& attrib) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Vec2f) == 2 * sizeof(float));
    const auto flat = [](const auto& vectors) { return reinterpret_cast<const float*>(vectors.data()); };
    std::vector<Vec3f> positions;
    for (const Vec3d p : text.positions)
        positions.push_back(to_float(p));
    compare_numbers("v", flat(positions), positions.size() * 3, attrib.vertices);
    compare_numbers("vt", flat(text.uvs), text.uvs.size() * 2, attrib.texcoords);
    compare_numbers("vn", flat(text.normals), text.normals.size() * 3, attrib.normals);
}

void compare_faces(const ObjText& text, const PeerModel& peer) {
    expect(text.faces.size() == peer.faces.size(), "{} faces, the library has {}", text.faces.size(),
           peer.faces.size());
    for (std::size_t f = 0; f < text.faces.size(); ++f) {
        expect(text.faces[f].corner_count % 256 == peer.faces[f].corner_count,
               "face {} has {} corners, in the library {}", f, text.faces[f].corner_count,
               peer.faces[f].corner_count);
    }
    expect(text.corners.size() == peer.corners.size(), "{} corners, the library has {}", text.corners.size(),
           peer.corners.size());
    for (std::size_t c = 0; c < text.corners.size(); ++c) {
        const FaceCorner &ours = text.corners[c], &theirs = peer.corners[c];
        expect(ours == theirs, "corner {}: {}/{}/{} from 0, the library has {}/{}/{}", c, ours.position,
               ours.uv, ours.normal, theirs.position, theirs.uv, theirs.normal);
    }
}

/// One vertex of the model against the elements that the library's corner names.
void compare_vertex(const Model& model, std::uint32_t v, const ObjText& text, const FaceCorner& corner,
                    std::size_t triangle) {
    const Mesh& mesh = model.mesh;
    const Vec3d position = text.positions[static_cast<std::size_t>(corner.position)];
    expect(mesh.positions[v] == to_float(position - model.origin),
           "triangle {}: another position than the library's corner", triangle);
    Vec2f uv{};
    if (corner.uv >= 0) uv = text.uvs[static_cast<std::size_t>(corner.uv)];
    const Vec2f has = mesh.uvs.empty() ? Vec2f{} : mesh.uvs[v];
    expect(has == uv, "triangle {}: another texture coordinate than the library's corner", triangle);
    if (corner.normal < 0) return;
    const Vec3d n = to_double(text.normals[static_cast<std::size_t>(corner.normal)]);
    if (n == Vec3d{0, 0, 0}) return;  // no direction: computed
    expect(mesh.normals[v] == to_float(normalize(n, {0, 0, 0})),
           "triangle {}: another normal than the library's corner", triangle);
}

/// load_obj()'s account of materials (obj_file.h), from the library's numbers; -1 = not in the file.
Material expected_material(const tinyobj::material_t& m) {
    const auto colour = [](const float(&c)[3]) { return Vec3f{c[0], c[1], c[2]}; };
    const Vec3f kd = colour(m.diffuse), ks = colour(m.specular), none{0, 0, 0};
    const bool metal = m.metallic < 0 && kd == none && ks != none && m.diffuse_texname.empty();
    const Vec3f base = metal ? ks : kd;
    Material expected;
    expected.base_color = {std::fmin(base.x, 1.0f), std::fmin(base.y, 1.0f), std::fmin(base.z, 1.0f)};
    expected.metallic = m.metallic >= 0 ? m.metallic : metal ? 1.0f : 0.0f;
    expected.emission = colour(m.emission);
    float roughness = 1;
    if (m.shininess >= 0 && ks != none) {
        const double alpha = std::sqrt(2 / (static_cast<double>(m.shininess) + 2));
        roughness = static_cast<float>(std::sqrt(alpha));
    }
    if (m.roughness >= 0) roughness = m.roughness;
    expected.roughness = std::clamp(roughness, 0.02f, 1.0f);
    return expected;
}

void compare_material(const Model& model, const Material& ours, const tinyobj::material_t& theirs) {
    const Material expected = expected_material(theirs);
    expect(within_ulp(ours.base_color, expected.base_color), "material '{}': base colour", ours.name);
    expect(within_ulp(ours.emission, expected.emission), "material '{}': emission", ours.name);
    expect(within_ulp(ours.metallic, expected.metallic), "material '{}': metallic {}, the library's {}",
           ours.name, ours.metallic, expected.metallic);
    expect(within_ulp(ours.roughness, expected.roughness), "material '{}': roughness {}, the library's {}",
           ours.name, ours.roughness, expected.roughness);
    const std::string& texture = theirs.diffuse_texname;
    const std::string has =
        ours.texture < 0 ? "" : model.texture_files[static_cast<std::size_t>(ours.texture)];
    expect(has == texture, "material '{}': texture '{}', in the library '{}'", ours.name, has, texture);
}

/// The names and looks of triangles.
class Labels {
  public:
    Labels(const Model& model, const PeerModel& peer, Feed feed, bool objects)
        : model_(model), peer_(peer), feed_(feed), objects_(objects), paired_(model.materials.size(), none) {}

    void compare(std::size_t triangle, const PeerFace& face) {
        compare_material_of(triangle, face.material);
        if (!objects_) return;
        const std::string ours = said(model_.mesh.objects[model_.mesh.object[triangle]].name);
        // Before any o or g the object has the file's name with us, none with the library.
        const bool same = ours == *face.object || (face.object->empty() && ours == "text");
        expect(same, "triangle {} is of object '{}', in the library '{}'", triangle, ours, *face.object);
    }

  private:
    static constexpr int none = -2;

    std::string said(const std::string& name) const { return feed_ == Feed::raw ? name : plain_name(name); }

    void compare_material_of(std::size_t triangle, int theirs) {
        const std::uint32_t number = model_.mesh.material[triangle];
        int& paired = paired_[number];
        if (paired == theirs) return;
        const Material& material = model_.materials[number];
        expect(paired == none, "triangle {}: '{}' is two materials in the library", triangle, material.name);
        paired = theirs;
        if (theirs < 0) {
            expect(material.name == "default", "triangle {} is of material '{}', in the library of none",
                   triangle, material.name);
            return;
        }
        const tinyobj::material_t& peer = peer_.materials[static_cast<std::size_t>(theirs)];
        expect(said(material.name) == peer.name, "triangle {} is of material '{}', in the library '{}'",
               triangle, material.name, peer.name);
        compare_material(model_, material, peer);
    }

    const Model& model_;
    const PeerModel& peer_;
    Feed feed_;
    bool objects_;
    std::vector<int> paired_;  ///< by our material, the library's; -1 = before any usemtl
};

void compare_triangles(const ObjText& text, const Model& model, const PeerModel& peer, Labels labels) {
    std::size_t t = 0, first = 0;
    std::vector<Vec3f> outline;
    for (std::size_t f = 0; f < peer.faces.size(); first += text.faces[f].corner_count, ++f) {
        const FaceCorner* corner = &peer.corners[first];
        outline.clear();
        for (std::uint32_t k = 0; k < text.faces[f].corner_count; ++k)
            outline.push_back(
                to_float(text.positions[static_cast<std::size_t>(corner[k].position)] - model.origin));
        for (const auto& cut : triangulate_polygon(outline)) {
            expect(t < model.mesh.triangles.size(), "only {} triangles", t);
            for (std::size_t k = 0; k < 3; ++k)
                compare_vertex(model, model.mesh.triangles[t].v[k], text, corner[cut[k]], t);
            labels.compare(t, peer.faces[f]);
            ++t;
        }
    }
    expect(t == model.mesh.triangles.size(), "{} triangles, of the library's polygons {}",
           model.mesh.triangles.size(), t);
}

}  // namespace

PeerResult read_by_both(std::string_view obj, std::string_view mtl, const Limits& limits, Feed feed) {
    const ObjText text = parse_obj_text(obj, "text.obj", limits);
    const Model model = obj_from_text(obj, mtl, limits);
    PeerResult result;
    result.triangles = model.mesh.triangles.size();
    std::string peer_obj = plain_obj(obj, result.quirks), peer_mtl;
    // An MTL that no mtllib names was never read by us: anything may stand there.
    if (!text.libraries.empty()) peer_mtl = plain_mtl(mtl, result.quirks);
    if (feed == Feed::raw) {
        peer_obj = obj;
        peer_mtl = mtl;
    } else if (keeps_from_comparing(result.quirks)) {
        result.compared = false;
        return result;
    }
    const bool both = result.quirks[static_cast<std::size_t>(Quirk::objects_and_groups)];
    try {
        const PeerModel peer = read_by_library(peer_obj, peer_mtl, feed);
        compare_elements(text, peer.attrib);
        compare_faces(text, peer);
        compare_triangles(text, model, peer, Labels(model, peer, feed, feed == Feed::raw || !both));
    } catch (const Difference& difference) {
        result.difference = difference.what();
    }
    return result;
}

}  // namespace obscura
