#include "app/models/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "app/models/faces_mesh.h"
#include "app/models/gltf_buffers.h"
#include "app/models/gltf_document.h"
#include "app/models/point_index.h"
#include "app/models/text_lines.h"
#include "core/error.h"

namespace obscura {
namespace {

/// Its text becomes a tree of values that takes many times as much.
constexpr std::size_t most_json_bytes = std::size_t{64} << 20;

Vec3d point(const GltfMatrix& m, Vec3d p) {
    const auto row = [&](int i) {
        return (m.m[i][0] * p.x + m.m[i][1] * p.y) + (m.m[i][2] * p.z + m.m[i][3]);
    };
    return {row(0), row(1), row(2)};
}

GltfMatrix operator*(const GltfMatrix& a, const GltfMatrix& b) {
    GltfMatrix out;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 4; ++j) {
            out.m[i][j] = (a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j]) +
                          (a.m[i][2] * b.m[2][j] + (j == 3 ? a.m[i][3] : 0));
        }
    }
    return out;
}

Vec3d column(const GltfMatrix& m, int j) {
    return {m.m[0][j], m.m[1][j], m.m[2][j]};
}

/// Normals go by the cofactors, whose columns are the cross products of the matrix' own.
struct NormalMap {
    Vec3d x, y, z;
    bool mirrors = false;
    explicit NormalMap(const GltfMatrix& m)
        : x(cross(column(m, 1), column(m, 2))),
          y(cross(column(m, 2), column(m, 0))),
          z(cross(column(m, 0), column(m, 1))),
          mirrors(dot(column(m, 0), x) < 0) {}
    Vec3d operator()(Vec3d n) const {
        const Vec3d out = (x * n.x + y * n.y) + z * n.z;
        return normalize(mirrors ? -out : out, {0, 0, 0});
    }
};

/// Names that are shown in messages and chosen in scenes: all different, without control characters.
class UniqueNames {
  public:
    std::string unique(std::string name) {
        for (char& c : name)
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
        const std::string stem = name;
        while (!taken_.insert(name).second)
            name = fmt::format("{}_{}", stem, ++last_.try_emplace(stem, 1).first->second);
        return name;
    }

  private:
    std::set<std::string> taken_;
    std::map<std::string, int> last_;  ///< number given to a stem
};

class Reader {
  public:
    Reader(const GltfDocument& document, const GltfBuffers& buffers, const std::string& file,
           const Limits& limits)
        : is_used(document.materials.size()),
          document_(document),
          buffers_(buffers),
          file_(file),
          limits_(limits),
          drawn_(document.meshes.size()) {}

    IndexedFaces run() {
        for (std::size_t i = 0; i < document_.materials.size(); ++i)
            out_.material_names.push_back({document_.materials[i].name, 0});
        struct Entry {
            GltfIndex node;
            GltfMatrix world;
        };
        std::vector<Entry> open;
        for (auto root = document_.roots.rbegin(); root != document_.roots.rend(); ++root)
            open.push_back({*root, {}});
        while (!open.empty()) {
            const Entry at = open.back();
            open.pop_back();
            const GltfNode& node = document_.nodes[static_cast<std::size_t>(at.node)];
            const GltfMatrix world = at.world * node.local;
            if (node.mesh >= 0) add_mesh(node, at.node, world);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                open.push_back({*child, world});
        }
        return std::move(out_);
    }

    std::int64_t skipped_primitives = 0;  ///< of points and lines, of meshes that are shown
    bool any_without_material = false;
    std::vector<bool> is_used;  ///< material by material

  private:
    /// Primitives of a mesh that have triangles.
    const std::vector<std::size_t>& drawn(GltfIndex mesh) {
        auto& known = drawn_[static_cast<std::size_t>(mesh)];
        if (known) return *known;
        known.emplace();
        const auto& primitives = document_.meshes[static_cast<std::size_t>(mesh)].primitives;
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            const GltfPrimitive& p = primitives[k];
            if (p.mode != GltfMode::triangles && p.mode != GltfMode::triangle_strip &&
                p.mode != GltfMode::triangle_fan) {
                ++skipped_primitives;
            } else if (accessor(p.indices >= 0 ? p.indices : p.positions).count >=
                       (p.mode == GltfMode::triangles ? 1 : 3)) {
                known->push_back(k);
            }
        }
        return *known;
    }

    void add_mesh(const GltfNode& node, GltfIndex index, const GltfMatrix& world) {
        const GltfMesh& mesh = document_.meshes[static_cast<std::size_t>(node.mesh)];
        if (drawn(node.mesh).empty()) return;
        const auto object = static_cast<std::int32_t>(out_.object_names.size());
        out_.object_names.push_back({objects_.unique(!node.name.empty()   ? node.name
                                                     : !mesh.name.empty() ? mesh.name
                                                                          : fmt::format("node_{}", index)),
                                     0});
        points_.forget();
        for (const std::size_t k : drawn(node.mesh)) {
            const std::string where =
                fmt::format("nodes[{}], meshes[{}].primitives[{}]", index, node.mesh, k);
            add_primitive(mesh.primitives[k], world, object, where);
        }
    }

    const GltfAccessor& accessor(GltfIndex i) const {
        return document_.accessors[static_cast<std::size_t>(i)];
    }

    Vec3d vec3(const GltfAccessor& a, std::int64_t i) const {
        return {buffers_.number(a, i, 0), buffers_.number(a, i, 1), buffers_.number(a, i, 2)};
    }

    static bool is_float(Vec3d p) {
        constexpr auto most = static_cast<double>(std::numeric_limits<float>::max());
        return std::fabs(p.x) <= most && std::fabs(p.y) <= most && std::fabs(p.z) <= most;
    }

    void add_primitive(const GltfPrimitive& p, const GltfMatrix& world, std::int32_t object,
                       const std::string& where) {
        const GltfAccessor& positions = accessor(p.positions);
        const std::int64_t vertices = positions.count,
                           corners = p.indices >= 0 ? accessor(p.indices).count : vertices;
        if (p.mode == GltfMode::triangles && corners % 3 != 0)
            throw InputError(file_, fmt::format("{}: {} corners are no triangles", where, corners));
        const std::int64_t triangles =
            p.mode == GltfMode::triangles ? corners / 3 : std::max<std::int64_t>(corners - 2, 0);
        out_.triangles += triangles;
        vertices_ += vertices;
        if (out_.triangles > most_triangles(limits_) || vertices_ > most_vertices(limits_)) {
            throw LimitError(fmt::format(
                "{}: has more than limits.triangles = {} triangles, or three times as many vertices", file_,
                limits_.triangles));
        }
        const GltfIndex uv = texture_coordinates_of(p);
        const auto first = static_cast<std::int32_t>(place_.size());
        const NormalMap normal_map(world);
        for (std::int64_t i = 0; i < vertices; ++i)
            add_vertex(p, world, normal_map, uv, i, where);
        const auto vertex = [&](std::int64_t corner) {
            if (p.indices < 0) return first + static_cast<std::int32_t>(corner);
            const double v = buffers_.number(accessor(p.indices), corner, 0);
            if (!(v < static_cast<double>(vertices)))
                throw InputError(file_, fmt::format("{}: there is no vertex {} of {}", where, v, vertices));
            return first + static_cast<std::int32_t>(v);
        };
        any_without_material |= p.material < 0;
        if (p.material >= 0) is_used[static_cast<std::size_t>(p.material)] = true;
        for (std::int64_t t = 0; t < triangles; ++t) {
            std::array<std::int64_t, 3> c = {3 * t, 3 * t + 1, 3 * t + 2};
            // Of a strip every second triangle turns the other way.
            if (p.mode == GltfMode::triangle_strip) c = {t, t + 1 + t % 2, t + 2 - t % 2};
            if (p.mode == GltfMode::triangle_fan) c = {t + 1, t + 2, 0};
            if (normal_map.mirrors) std::swap(c[1], c[2]);
            IndexedFace face;
            face.first_corner = static_cast<std::uint32_t>(out_.corners.size());
            face.corner_count = 3;
            face.material = p.material;
            face.object = object;
            // Where the file has no normals, its triangles are flat.
            face.smoothing = smooth_none;
            for (const std::int64_t corner : c)
                out_.corners.push_back(place_[static_cast<std::size_t>(vertex(corner))]);
            out_.faces.push_back(face);
        }
    }

    /// The set that the material's texture asks for, else the first.
    GltfIndex texture_coordinates_of(const GltfPrimitive& p) const {
        const auto set = p.material < 0
                             ? 0
                             : static_cast<std::size_t>(
                                   document_.materials[static_cast<std::size_t>(p.material)].texture_set);
        return set < p.texture_coordinates.size() ? p.texture_coordinates[set] : -1;
    }

    void add_vertex(const GltfPrimitive& p, const GltfMatrix& world, const NormalMap& normal_map,
                    GltfIndex uv, std::int64_t i, const std::string& where) {
        const Vec3d at = point(world, vec3(accessor(p.positions), i));
        if (!is_float(at)) throw InputError(file_, fmt::format("{}: vertex {} is not finite", where, i));
        FaceCorner corner;
        corner.position = points_.index_of(at, out_.positions);
        if (p.normals >= 0) {
            const Vec3d n = normal_map(vec3(accessor(p.normals), i));
            if (!is_float(n)) throw InputError(file_, fmt::format("{}: normal {} is not finite", where, i));
            corner.normal = static_cast<std::int32_t>(out_.normals.size());
            out_.normals.push_back(to_float(n));
        }
        if (uv >= 0) {
            // The origin is at the top here, at the bottom in a mesh.
            const Vec3d t{buffers_.number(accessor(uv), i, 0), 1 - buffers_.number(accessor(uv), i, 1), 0};
            if (!is_float(t))
                throw InputError(file_, fmt::format("{}: texture coordinate {} is not finite", where, i));
            corner.uv = static_cast<std::int32_t>(out_.uvs.size());
            out_.uvs.push_back({static_cast<float>(t.x), static_cast<float>(t.y)});
        }
        place_.push_back(corner);
    }

    const GltfDocument& document_;
    const GltfBuffers& buffers_;
    const std::string& file_;
    const Limits& limits_;
    std::vector<std::optional<std::vector<std::size_t>>> drawn_;
    UniqueNames objects_;
    PointIndex points_;
    std::vector<FaceCorner> place_;  ///< of all vertices so far
    std::int64_t vertices_ = 0;
    IndexedFaces out_;
};

/// Materials by names that are all different; `with_default`: some faces have none, and so that name is
/// taken.
void name_materials(bool with_default, GltfDocument& document) {
    UniqueNames names;
    if (with_default) names.unique("default");
    for (std::size_t i = 0; i < document.materials.size(); ++i) {
        std::string& name = document.materials[i].name;
        name = names.unique(name.empty() ? fmt::format("material_{}", i) : name);
    }
}

/// Pictures of materials, each read once.
class ImageReader {
  public:
    ImageReader(const GltfDocument& document, const GltfBuffers& buffers, const std::string& file,
                const Limits& limits, const ModelOptions& options,
                const std::function<std::string(const std::string&)>& read, Model& model)
        : document_(document),
          buffers_(buffers),
          file_(file),
          limits_(limits),
          options_(options),
          read_(read),
          model_(model),
          known_(document.images.size()) {}

    /// Index of the texture that holds an image; -1, and a note, for one that is no PNG or may be missing.
    std::int32_t texture_of(GltfIndex index) {
        auto& at = known_[static_cast<std::size_t>(index)];
        if (at) return *at;
        const std::string where = fmt::format("images[{}]", index);
        std::string bytes;
        try {
            bytes = bytes_of(document_.images[static_cast<std::size_t>(index)], where);
        } catch (const MissingFile& error) {
            if (!options_.allow_missing && options_.textures) {
                throw InputError(
                    file_, fmt::format("{}: {} (--allow-missing reads on without it)", where, error.message));
            }
            model_.missing.push_back(fmt::format("{}: {}: {}", file_, where, error.message));
            return *(at = -1);
        }
        if (!bytes.starts_with("\x89PNG")) {
            model_.notes.push_back(fmt::format(
                "{}: {} is no PNG and is not read; its materials show their colour alone", file_, where));
            return *(at = -1);
        }
        held_ += static_cast<std::int64_t>(bytes.size());
        check_held(held_, "images", limits_, file_);
        at = static_cast<std::int32_t>(model_.texture_files.size());
        model_.texture_files.push_back(fmt::format("{}#{}", file_, where));
        model_.texture_bytes.push_back(std::move(bytes));
        return *at;
    }

  private:
    std::string bytes_of(const GltfImage& image, const std::string& where) const {
        if (image.view >= 0) return std::string(buffers_.view(image.view));
        bool is_data = false;
        std::string bytes = data_of_uri(image.uri, file_, where, is_data);
        return is_data ? bytes : read_(percent_decoded(image.uri));
    }

    const GltfDocument& document_;
    const GltfBuffers& buffers_;
    const std::string& file_;
    const Limits& limits_;
    const ModelOptions& options_;
    const std::function<std::string(const std::string&)>& read_;
    Model& model_;
    std::vector<std::optional<std::int32_t>> known_;
    std::int64_t held_ = 0;
};

/// `is_used`: material by material; what none shows is not asked for its texture.
void add_materials(const GltfDocument& document, const std::vector<bool>& is_used, bool with_default,
                   const ModelOptions& options, ImageReader& images, Model& model) {
    model.materials.clear();
    for (std::size_t i = 0; i < document.materials.size(); ++i) {
        const GltfMaterial& m = document.materials[i];
        Material out;
        out.name = m.name;
        const auto& c = m.base_color;
        out.base_color = to_float(Vec3d{c[0], c[1], c[2]});
        out.metallic = static_cast<float>(m.metallic);
        out.roughness = std::max(static_cast<float>(m.roughness), 0.02f);
        out.emission = to_float(Vec3d{m.emission[0], m.emission[1], m.emission[2]});
        const bool replaced =
            std::find(options.replaced.begin(), options.replaced.end(), m.name) != options.replaced.end();
        if (m.image >= 0 && is_used[i] && !replaced) out.texture = images.texture_of(m.image);
        model.materials.push_back(std::move(out));
    }
    if (with_default || model.materials.empty()) model.materials.push_back(Material{.name = "default"});
}

}  // namespace

Model gltf_from_bytes(std::string_view bytes, const std::string& file, const Limits& limits,
                      const ModelOptions& options,
                      const std::function<std::string(const std::string&)>& read) {
    const GltfParts parts = gltf_parts(bytes, file);
    if (parts.json.size() > most_json_bytes)
        throw InputError(
            file, fmt::format("its JSON has {} bytes, more than {}", parts.json.size(), most_json_bytes));
    GltfDocument document = parse_gltf_json(parts.json, file);
    const GltfBuffers buffers(document, parts, file, limits, read);
    Reader reader(document, buffers, file, limits);
    const IndexedFaces faces = reader.run();
    Model model = model_of_faces(faces, file, options.crease_angle_deg);
    if (options.materials) {
        name_materials(reader.any_without_material, document);
        ImageReader images(document, buffers, file, limits, options, read, model);
        add_materials(document, reader.is_used, reader.any_without_material, options, images, model);
    } else {
        model.mesh.material.assign(model.mesh.triangles.size(), 0);
    }
    if (reader.skipped_primitives > 0)
        model.notes.push_back(
            fmt::format("{}: points and lines not read ({})", file, reader.skipped_primitives));
    for (const auto& [what, times] : document.ignored)
        model.notes.push_back(fmt::format("{}: {} not read ({})", file, what, times));
    keep_few(model.notes, file);
    return model;
}

Model load_gltf(const std::filesystem::path& file, const FileAccess& access, const Limits& limits,
                const ModelOptions& options) {
    const auto read = [&](const std::string& uri) {
        try {
            return read_model_bytes(resolve_beside(access, file.parent_path(), uri), limits);
        } catch (const MissingFile& error) {
            throw MissingFile(file.string(), fmt::format("{}: {}", shown(uri), error.message));
        } catch (const InputError& error) {
            throw InputError(file.string(), fmt::format("{}: {}", shown(uri), error.message));
        }
    };
    return gltf_from_bytes(read_model_bytes(file, limits), file.string(), limits, options, read);
}

}  // namespace obscura
