#include "app/models/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/models/json_place.h"
#include "app/models/text_lines.h"
#include "core/error.h"

namespace obscura {
namespace {

GltfMatrix product(const GltfMatrix& a, const double (&r)[3][3], const std::array<double, 3>& scale) {
    GltfMatrix out = a;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out.m[i][j] = r[i][j] * scale[static_cast<std::size_t>(j)];
    return out;
}

GltfMatrix matrix_of(const JsonPlace& node) {
    GltfMatrix out;
    if (node.has("matrix")) {
        const auto m = node.numbers<16>("matrix", {});
        if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) node.at("matrix").fail("is not affine");
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                out.m[i][j] = m[4 * j + i];
        return out;
    }
    const auto t = node.numbers<3>("translation", {0, 0, 0});
    auto q = node.numbers<4>("rotation", {0, 0, 0, 1});
    const double norm = std::sqrt((q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]));
    if (!(std::fabs(norm - 1) < 0.01)) node.at("rotation").fail("is not a unit quaternion");
    for (double& v : q)
        v /= norm;
    const auto [x, y, z, w] = q;
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (std::size_t i = 0; i < 3; ++i)
        out.m[i][3] = t[i];
    return product(out, r, node.numbers<3>("scale", {1, 1, 1}));
}

class Reader {
  public:
    Reader(const Json& root, const std::string& file) : root_(root, "", file) {}

    GltfDocument run() {
        if (!root_.value().is_object()) root_.fail("its JSON is not an object");
        const std::string version = root_.at("asset").text("version");
        if (!version.starts_with("2."))
            root_.at("asset").fail(fmt::format("glTF {} is not read, 2.0 is", shown(version)));
        for (const JsonPlace& extension : root_.list("extensionsRequired")) {
            const std::string name =
                extension.value().is_string() ? extension.value().get<std::string>() : "";
            if (name != "KHR_mesh_quantization" && name != "KHR_materials_emissive_strength")
                extension.fail(fmt::format("'{}' is not read", shown(name)));
        }
        read_buffers();
        read_images();
        read_materials();
        read_meshes();
        read_nodes();
        for (const char* list : {"animations", "skins", "cameras"})
            if (root_.size(list) > 0) out_.ignored[list] = static_cast<int>(root_.size(list));
        return std::move(out_);
    }

  private:
    void ignore(const JsonPlace& place, std::initializer_list<const char*> keys, const char* of) {
        for (const char* key : keys)
            if (place.has(key)) ++out_.ignored[fmt::format("{} of {}", key, of)];
    }
    void ignore_extensions(const JsonPlace& place, const char* of, std::string_view but = {}) {
        if (!place.has("extensions")) return;
        for (const std::string& name : place.at("extensions").keys())
            if (name != but) ++out_.ignored[fmt::format("{} of {}", shown(name), of)];
    }

    void read_buffers() {
        for (const JsonPlace& p : root_.list("buffers")) {
            GltfBuffer b;
            b.uri = p.text("uri");
            p.at("byteLength");
            b.bytes = p.integer("byteLength", 0);
            out_.buffers.push_back(std::move(b));
        }
        for (const JsonPlace& p : root_.list("bufferViews")) {
            GltfView v;
            p.at("buffer");
            p.at("byteLength");
            v.buffer = p.index("buffer", out_.buffers.size());
            v.offset = p.integer("byteOffset", 0);
            v.bytes = p.integer("byteLength", 0);
            v.stride = p.integer("byteStride", 0);
            const std::int64_t there = out_.buffers[static_cast<std::size_t>(v.buffer)].bytes;
            if (v.offset > there || v.bytes > there - v.offset)
                p.fail(fmt::format("bytes {} to {} are not in the buffer's {}", v.offset, v.offset + v.bytes,
                                   there));
            if (v.stride != 0 && (v.stride < 4 || v.stride > 252 || v.stride % 4 != 0))
                p.at("byteStride").fail("is not a multiple of 4 from 4 to 252");
            out_.views.push_back(v);
        }
        for (const JsonPlace& p : root_.list("accessors"))
            out_.accessors.push_back(accessor(p));
    }

    GltfAccessor accessor(const JsonPlace& p) const {
        constexpr std::pair<int, GltfComponent> components[] = {
            {5120, GltfComponent::int8},   {5121, GltfComponent::uint8},  {5122, GltfComponent::int16},
            {5123, GltfComponent::uint16}, {5125, GltfComponent::uint32}, {5126, GltfComponent::float32}};
        constexpr std::pair<std::string_view, int> widths[] = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
        if (p.has("sparse")) p.at("sparse").fail("sparse accessors are not read");
        GltfAccessor a;
        a.view = p.index("bufferView", out_.views.size());
        a.offset = p.integer("byteOffset", 0);
        p.at("count");
        a.count = p.integer("count", 0);
        a.normalized = p.flag("normalized");
        const std::int64_t code = p.integer("componentType", 0);
        const auto component = std::find_if(std::begin(components), std::end(components),
                                            [&](const auto& c) { return c.first == code; });
        if (component == std::end(components))
            p.at("componentType").fail(fmt::format("there is no {}", code));
        a.component = component->second;
        const std::string type = p.text("type");
        const auto width = std::find_if(std::begin(widths), std::end(widths),
                                        [&](const auto& w) { return w.first == type; });
        if (width == std::end(widths)) p.fail(fmt::format("there is no type '{}'", shown(type)));
        a.width = width->second;
        if (a.view < 0) return a;
        const GltfView& view = out_.views[static_cast<std::size_t>(a.view)];
        const std::int64_t element = gltf_size(a.component) * a.width,
                           stride = view.stride != 0 ? view.stride : element;
        if (stride < element) p.fail("its elements are longer than the view's byteStride");
        if (a.count > 0 && (a.offset > view.bytes || element > view.bytes - a.offset ||
                            a.count - 1 > (view.bytes - a.offset - element) / stride))
            p.fail(fmt::format("{} elements do not fit into the view's {} bytes", a.count, view.bytes));
        return a;
    }

    void read_images() {
        for (const JsonPlace& p : root_.list("images")) {
            GltfImage image;
            image.uri = p.text("uri");
            image.view = p.index("bufferView", out_.views.size());
            if (image.uri.empty() == (image.view < 0)) p.fail("needs either 'uri' or 'bufferView'");
            out_.images.push_back(std::move(image));
        }
        for (const JsonPlace& p : root_.list("textures")) {
            textures_.push_back(p.index("source", out_.images.size()));
            if (textures_.back() < 0) ++out_.ignored["textures without a source"];
            ignore_extensions(p, "textures");
            const GltfIndex sampler = p.index("sampler", root_.size("samplers"));
            if (sampler < 0) continue;
            const JsonPlace s = root_.list("samplers")[static_cast<std::size_t>(sampler)];
            for (const char* axis : {"wrapS", "wrapT"})
                if (s.integer(axis, 10497) != 10497) ++out_.ignored[fmt::format("{} of textures", axis)];
        }
    }

    void read_materials() {
        for (const JsonPlace& p : root_.list("materials")) {
            GltfMaterial m;
            m.name = p.text("name");
            if (p.has("pbrMetallicRoughness")) {
                const JsonPlace pbr = p.at("pbrMetallicRoughness");
                m.base_color = pbr.numbers<4>("baseColorFactor", m.base_color);
                m.metallic = pbr.number("metallicFactor", 1, 0, 1);
                m.roughness = pbr.number("roughnessFactor", 1, 0, 1);
                if (pbr.has("baseColorTexture")) {
                    const JsonPlace t = pbr.at("baseColorTexture");
                    t.at("index");
                    m.image = textures_.at(
                        static_cast<std::size_t>(std::max(t.index("index", textures_.size()), GltfIndex{0})));
                    m.texture_set = static_cast<int>(std::min<std::int64_t>(t.integer("texCoord", 0), 1000));
                    ignore_extensions(t, "textures");
                }
                if (pbr.has("metallicRoughnessTexture")) {
                    // Its factors are all there is to take away from: most of them are 1.
                    m.metallic = 0;
                    ++out_.ignored["metallicRoughnessTexture of materials, which are no metal then,"];
                }
            }
            m.emission = p.numbers<3>("emissiveFactor", m.emission);
            if (p.has("extensions") && p.at("extensions").has("KHR_materials_emissive_strength")) {
                const double strength = p.at("extensions")
                                            .at("KHR_materials_emissive_strength")
                                            .number("emissiveStrength", 1, 0, 1e30);
                for (double& e : m.emission)
                    e *= strength;
            }
            if (p.has("emissiveTexture")) {
                // Most of it is black as a rule.
                m.emission = {};
                ++out_.ignored["emissiveTexture of materials, which do not shine then,"];
            }
            for (const double v : m.base_color)
                if (!(v >= 0 && v <= 1)) p.fail("baseColorFactor is not within 0 to 1");
            for (const double v : m.emission)
                if (!(v >= 0 && v <= 1e9)) p.fail("emission is not within 0 to 1e9");
            ignore(p, {"normalTexture", "occlusionTexture"}, "materials");
            const std::string alpha = p.text("alphaMode");
            if (!alpha.empty() && alpha != "OPAQUE")
                ++out_.ignored[fmt::format("alphaMode {} of materials", shown(alpha))];
            ignore_extensions(p, "materials", "KHR_materials_emissive_strength");
            out_.materials.push_back(std::move(m));
        }
    }

    GltfIndex attribute(const JsonPlace& attributes, const char* name, int width) const {
        const GltfIndex i = attributes.index(name, out_.accessors.size());
        if (i >= 0 && out_.accessors[static_cast<std::size_t>(i)].width != width)
            attributes.at(name).fail(fmt::format("its accessor has {} numbers an element, not {}",
                                                 out_.accessors[static_cast<std::size_t>(i)].width, width));
        return i;
    }

    GltfPrimitive primitive(const JsonPlace& p) {
        GltfPrimitive out;
        const std::int64_t mode = p.integer("mode", 4);
        if (mode > 6) p.at("mode").fail(fmt::format("there is no {}", mode));
        out.mode = static_cast<GltfMode>(mode);
        out.material = p.index("material", out_.materials.size());
        out.indices = p.index("indices", out_.accessors.size());
        if (out.indices >= 0) {
            const GltfAccessor& a = out_.accessors[static_cast<std::size_t>(out.indices)];
            if (a.width != 1 ||
                (a.component != GltfComponent::uint8 && a.component != GltfComponent::uint16 &&
                 a.component != GltfComponent::uint32))
                p.at("indices").fail("its accessor has no unsigned integers");
        }
        const JsonPlace attributes = p.at("attributes");
        out.positions = attribute(attributes, "POSITION", 3);
        if (out.positions < 0) attributes.fail("'POSITION' is missing");
        for (const GltfIndex i : {out.positions, out.indices}) {
            if (i >= 0 && out_.accessors[static_cast<std::size_t>(i)].view < 0)
                p.fail(fmt::format("accessor {} has no bufferView", i));
        }
        out.normals = attribute(attributes, "NORMAL", 3);
        for (int set = 0;; ++set) {
            const std::string name = fmt::format("TEXCOORD_{}", set);
            if (!attributes.has(name.c_str())) break;
            out.texture_coordinates.push_back(attribute(attributes, name.c_str(), 2));
        }
        const std::int64_t vertices = out_.accessors[static_cast<std::size_t>(out.positions)].count;
        const auto check = [&](GltfIndex i) {
            if (i >= 0 && out_.accessors[static_cast<std::size_t>(i)].count != vertices)
                attributes.fail("have different counts");
        };
        check(out.normals);
        for (const GltfIndex i : out.texture_coordinates)
            check(i);
        for (const std::string& name : attributes.keys())
            if (name != "POSITION" && name != "NORMAL" && name != "TANGENT" && !name.starts_with("TEXCOORD_"))
                ++out_.ignored[shown(name) + " of meshes"];
        ignore(p, {"targets"}, "meshes");
        ignore_extensions(p, "meshes");
        return out;
    }

    void read_meshes() {
        for (const JsonPlace& p : root_.list("meshes")) {
            GltfMesh mesh;
            mesh.name = p.text("name");
            p.at("primitives");
            for (const JsonPlace& part : p.list("primitives"))
                mesh.primitives.push_back(primitive(part));
            out_.meshes.push_back(std::move(mesh));
        }
    }

    /// Every node must hang on one that has no parent: else some go round in a ring.
    void check_trees(const std::vector<bool>& has_parent) const {
        std::vector<GltfIndex> open;
        for (std::size_t i = 0; i < has_parent.size(); ++i)
            if (!has_parent[i]) open.push_back(static_cast<GltfIndex>(i));
        std::size_t reached = 0;
        while (!open.empty()) {
            const auto node = static_cast<std::size_t>(open.back());
            open.pop_back();
            ++reached;
            open.insert(open.end(), out_.nodes[node].children.begin(), out_.nodes[node].children.end());
        }
        if (reached < has_parent.size()) root_.fail("nodes: some are their own descendants");
    }

    void read_nodes() {
        const std::size_t count = root_.size("nodes");
        std::vector<bool> has_parent(count, false);
        const auto node_of = [&](const JsonPlace& p) {
            const auto i = p.value().is_number() ? p.number() : -1.0;
            if (!(i >= 0 && i < static_cast<double>(count) && i == std::floor(i)))
                p.fail(fmt::format("there is no such node of {}", count));
            return static_cast<GltfIndex>(i);
        };
        for (const JsonPlace& p : root_.list("nodes")) {
            GltfNode node;
            node.name = p.text("name");
            node.mesh = p.index("mesh", out_.meshes.size());
            node.local = matrix_of(p);
            for (const JsonPlace& child : p.list("children")) {
                const GltfIndex i = node_of(child);
                if (has_parent[static_cast<std::size_t>(i)])
                    child.fail(fmt::format("node {} has two parents", i));
                has_parent[static_cast<std::size_t>(i)] = true;
                node.children.push_back(i);
            }
            ignore_extensions(p, "nodes");
            out_.nodes.push_back(std::move(node));
        }
        check_trees(has_parent);
        std::set<GltfIndex> roots;
        if (root_.size("scenes") > 0) {
            const GltfIndex shown_scene = std::max(root_.index("scene", root_.size("scenes")), GltfIndex{0});
            for (const JsonPlace& p :
                 root_.list("scenes")[static_cast<std::size_t>(shown_scene)].list("nodes")) {
                const GltfIndex i = node_of(p);
                if (has_parent[static_cast<std::size_t>(i)]) p.fail(fmt::format("node {} is no root", i));
                if (!roots.insert(i).second) p.fail(fmt::format("node {} stands there twice", i));
                out_.roots.push_back(i);
            }
            if (root_.size("scenes") > 1)
                out_.ignored["further scenes"] = static_cast<int>(root_.size("scenes")) - 1;
            return;
        }
        for (std::size_t i = 0; i < count; ++i)
            if (!has_parent[i]) out_.roots.push_back(static_cast<GltfIndex>(i));
    }

    JsonPlace root_;
    std::vector<GltfIndex> textures_;  ///< their images
    GltfDocument out_;
};

}  // namespace

int gltf_size(GltfComponent component) {
    switch (component) {
        case GltfComponent::int8:
        case GltfComponent::uint8:
            return 1;
        case GltfComponent::int16:
        case GltfComponent::uint16:
            return 2;
        case GltfComponent::uint32:
        case GltfComponent::float32:
            return 4;
    }
    return 0;
}

GltfDocument parse_gltf_json(std::string_view json, const std::string& file) {
    Json root;
    try {
        root = Json::parse(json.begin(), json.end());
    } catch (const Json::parse_error& error) {
        throw InputError(file, fmt::format("is not sound JSON at byte {}", error.byte));
    } catch (const Json::exception&) {
        throw InputError(file, "has a number in its JSON that is too large");
    }
    return Reader(root, file).run();
}

}  // namespace obscura
