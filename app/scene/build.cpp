// Meshes, materials and textures: whatever is the same in all frames.

#include "app/scene/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "app/models/model_file.h"
#include "app/scene/aperture_file.h"
#include "app/scene/days.h"
#include "app/scene/enclosed_lamps.h"
#include "app/scene/keyframes.h"
#include "app/scene/light_kinds.h"
#include "app/scene/mesh_transform.h"
#include "app/scene/rounding_note.h"
#include "app/scene/schema.h"
#include "app/scene/shapes.h"
#include "app/scene/terrain.h"
#include "app/scene/texture_notes.h"
#include "app/scene/validate.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/sky/image_sky.h"
#include "core/texture.h"
#include "core/topology.h"

namespace obscura {
namespace {

constexpr std::int64_t largest_texture_file = std::int64_t{1} << 30;
constexpr float farthest_m = 1e9f;

struct Builder {
    const SceneDocument& document;
    const FileAccess& access;
    Limits limits;
    Scene scene;
    std::map<std::filesystem::path, std::int32_t> textures;       // decoded so far
    std::map<std::string, std::uint32_t, std::less<>> materials;  // of the document, by name
    std::int64_t texture_memory = 0;
};

/// A note, once.
void add_note(Builder& b, const std::string& note) {
    std::vector<std::string>& notes = b.scene.notes;
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

/// Decodes and adds a texture of 8 or 16 bits a sample.
template <class Pixel>
void add_texture(Builder& b, const Image<Pixel>& image, const std::string& shown_name) {
    using Sample = decltype(Pixel::a);
    const bool clear = std::any_of(image.pixels.begin(), image.pixels.end(),
                                   [](Pixel p) { return p.a < std::numeric_limits<Sample>::max(); });
    if (clear) add_note(b, fmt::format("texture {} is transparent in places; drawn opaque", shown_name));
    b.texture_memory += texture_bytes(image.width, image.height);
    b.scene.textures.push_back(make_texture(shown_name, image.view()));
}

/// Index of a texture, which is decoded when it is met for the first time. `held`: the bytes of the file, or
/// null where they are still to be read.
std::int32_t texture_index(Builder& b, const std::filesystem::path& file, const std::string& shown_name,
                           const std::string* held = nullptr) {
    if (const auto known = b.textures.find(file); known != b.textures.end()) return known->second;
    const std::string bytes = held != nullptr ? *held : read_file(file, largest_texture_file);
    ImageFileLimits limits;
    limits.max_side_px = b.limits.texture_px;
    // A pixel has 4 or 8 bytes in the file's image, and 16 as linear floats with their mip chain.
    const std::int64_t left = (b.limits.texture_mib << 20) - b.texture_memory;
    if (has_16_bit_samples(bytes)) {
        limits.max_bytes = left / 2;
        add_texture(b, decode_png16(bytes, shown_name, limits), shown_name);
    } else {
        limits.max_bytes = left / 4;
        add_texture(b, decode_png(bytes, shown_name, limits), shown_name);
    }
    const auto index = static_cast<std::int32_t>(b.scene.textures.size()) - 1;
    b.textures.emplace(file, index);
    return index;
}

/// Runs `load` for a file that the scene names; errors about the file as such point to where it is named.
template <class Load>
auto load_named(const Builder& b, const SceneTable& table, const char* key, Load&& load) {
    std::filesystem::path path;
    try {
        path = resolve_input(b.access, text(table, key));
    } catch (const InputError& error) {
        fail_at(place_of(table, key), b.document.sources,
                fmt::format("'{}': {}", text(table, key), error.message));
    }
    return load(path);
}

Material textured_material(Builder& b, const std::string& name, const SceneTable& table) {
    Material m = material_of(name, table);
    if (table.has("texture")) {
        m.texture = load_named(b, table, "texture", [&](const std::filesystem::path& path) {
            return texture_index(b, path, text(table, "texture"));
        });
    }
    return m;
}

void add_materials(Builder& b) {
    if (!b.document.root.has("material")) return;
    for (const SceneEntry& entry : subtable(b.document.root, "material").entries) {
        b.materials.emplace(entry.key, static_cast<std::uint32_t>(b.scene.materials.size()));
        b.scene.materials.push_back(textured_material(b, entry.key, std::get<SceneTable>(entry.value.data)));
    }
}

/// A mesh before it is placed; its material ids index `materials`, whose textures are the scene's already.
struct Part {
    Mesh mesh;
    std::vector<Material> materials;
    Vec3d origin;                  ///< what `mesh` stands about
    std::vector<bool> without_uv;  ///< as Model has it
};

Part load_part(Builder& b, const SceneTable& table) {
    return load_named(b, table, "file", [&](const std::filesystem::path& path) {
        ModelOptions options;
        options.crease_angle_deg = mesh_options_of(table).crease_angle_deg;
        options.allow_missing = b.access.allow_missing;
        options.materials = !table.has("material");
        for (const SceneEntry& entry : subtable(table, "materials").entries)
            options.replaced.push_back(entry.key);
        Model model = load_model(path, b.access, b.limits, options);
        for (const auto* words : {&model.missing, &model.notes}) {
            for (const std::string& word : *words)
                add_note(b, word);
        }
        for (Material& material : model.materials) {
            if (material.texture < 0) continue;
            const auto at = static_cast<std::size_t>(material.texture);
            const std::string& file = model.texture_files.at(at);
            material.texture =
                texture_index(b, file, std::filesystem::path(file).filename().string(),
                              model.texture_bytes.empty() ? nullptr : &model.texture_bytes.at(at));
        }
        return Part{std::move(model.mesh), std::move(model.materials), model.origin,
                    std::move(model.without_uv)};
    });
}

Part make_part(const SceneTable& table) {
    GeneratedModel model = find_shape(text(table, "shape"))->make(table);
    analyse_topology(model.mesh);
    return {std::move(model.mesh), std::move(model.materials), {}, {}};
}

/// Points the part's triangles at the scene's materials: the mesh's `material` for all, else
/// `materials.SLOT`, else the part's own, which are added.
void assign_materials(Builder& b, const SceneTable& table, Part& part) {
    Mesh& mesh = part.mesh;
    mesh.material.resize(mesh.triangles.size(), 0);
    if (part.materials.empty()) part.materials.push_back(Material{.name = "default"});
    if (table.has("material")) {
        mesh.material.assign(mesh.triangles.size(), b.materials.find(text(table, "material"))->second);
        return;
    }
    std::vector<std::string> slots;
    for (const Material& m : part.materials)
        slots.push_back(m.name);
    const SceneTable& chosen = subtable(table, "materials");
    for (const SceneEntry& entry : chosen.entries) {
        if (std::find(slots.begin(), slots.end(), entry.key) == slots.end()) {
            fail_at(entry.place, b.document.sources,
                    fmt::format("mesh '{}' has no material slot '{}'{}; it has: {}", text(table, "id"),
                                entry.key, hint(entry.key, slots), fmt::join(slots, ", ")));
        }
    }
    std::vector<std::uint32_t> scene_index;
    for (Material& m : part.materials) {
        if (chosen.has(m.name)) {
            scene_index.push_back(b.materials.find(text(chosen, m.name))->second);
        } else {
            scene_index.push_back(static_cast<std::uint32_t>(b.scene.materials.size()));
            m.name = text(table, "id") + "/" + m.name;
            b.scene.materials.push_back(std::move(m));
        }
    }
    for (std::uint32_t& m : mesh.material)
        m = scene_index.at(m);
}

/// Objects are named after the mesh, and after the file's objects when it has several.
void set_objects(const SceneTable& table, bool casts_shadow, Mesh& mesh) {
    const std::string& id = text(table, "id");
    mesh.object.resize(mesh.triangles.size(), 0);
    if (mesh.objects.empty()) mesh.objects.emplace_back();
    for (Object& object : mesh.objects) {
        object.name = mesh.objects.size() == 1 ? id : id + "/" + object.name;
        object.casts_shadow = casts_shadow;
    }
}

void check_coordinates(const Builder& b, const SceneTable& table, const char* kind, const Mesh& mesh) {
    for (const Vec3f p : mesh.positions) {
        if (std::fabs(p.x) <= farthest_m && std::fabs(p.y) <= farthest_m && std::fabs(p.z) <= farthest_m)
            continue;
        fail_at(place_of(table, "id"), b.document.sources,
                fmt::format("{} '{}' reaches farther than {} m from the origin", kind, text(table, "id"),
                            farthest_m));
    }
}

void note_rounding(Builder& b, const std::string& whose, const Mesh* made, const Mesh& placed) {
    if (const std::string note = rounding_note(whose, made, placed); !note.empty()) add_note(b, note);
}

/// Before `more` triangles are added, a number of any type.
void check_total(const Builder& b, const std::string& whose, auto more) {
    const std::int64_t total = std::ssize(b.scene.mesh.triangles) + static_cast<std::int64_t>(more);
    if (total <= b.limits.triangles) return;
    throw LimitError(fmt::format("{}: {} brings the scene to {} triangles, more than limits.triangles = {}",
                                 b.document.sources[0], whose, total, b.limits.triangles));
}

void add_mesh(Builder& b, const SceneTable& table) {
    Part part = text(table, "shape") == "file" ? load_part(b, table) : make_part(table);
    const std::vector<const SceneTable*> instances = subtables(table, "instance");
    const std::size_t copies = std::max<std::size_t>(1, instances.size());
    check_total(b, fmt::format("mesh '{}'", text(table, "id")), copies * part.mesh.triangles.size());
    assign_materials(b, table, part);
    for (const std::string& note : texture_notes(
             fmt::format("mesh '{}'", text(table, "id")), part.mesh, part.without_uv, b.scene.materials,
             [&](std::int32_t t) { return b.scene.textures[static_cast<std::size_t>(t)].name; }))
        add_note(b, note);
    const MeshOptions options = mesh_options_of(table);
    set_objects(table, options.casts_shadow, part.mesh);
    if (options.flip_faces) flip_faces(part.mesh);

    const Affine own = placement_of(table) * translation(part.origin);
    for (std::size_t i = 0; i < copies; ++i) {
        Mesh copy = part.mesh;
        if (!instances.empty()) {
            for (Object& object : copy.objects)
                object.name += fmt::format("#{}", i);
        }
        transform_mesh(copy, instances.empty() ? own : placement_of(*instances[i]) * own);
        check_coordinates(b, table, "mesh", copy);
        note_rounding(b, fmt::format("mesh '{}'", text(table, "id")), &part.mesh, copy);
        append_mesh(b.scene.mesh, copy);
    }
}

std::uint32_t terrain_look(Builder& b, const std::string& id, const ElevationModel& model) {
    const std::uint32_t material =
        add_terrain_look(b.scene, id, model, (b.limits.texture_mib << 20) - b.texture_memory);
    const Image<Vec3f>& finest = b.scene.textures.back().levels[0];
    b.texture_memory += texture_bytes(finest.width, finest.height);
    return material;
}

void add_terrain(Builder& b, const SceneTable& table) {
    TerrainOptions options = terrain_options_of(table, b.limits);
    options.elevation.as_mesh = true;
    auto model = load_named(b, table, "file", [&](const auto& path) {
        return load_elevation(path, text(table, "file"), b.access, b.limits, options.elevation);
    });
    const std::string whose = fmt::format("terrain '{}'", text(table, "id"));
    check_total(b, whose, height_mesh_triangles(model.field.width(), model.field.height()));
    if (model.holes > 0) add_note(b, fmt::format("{}: {} samples without a height", whose, model.holes));
    Mesh mesh = height_mesh(model.field, options.mesh);
    set_objects(table, options.casts_shadow, mesh);
    mesh.material.assign(mesh.triangles.size(), table.has("material")
                                                    ? b.materials.find(text(table, "material"))->second
                                                    : terrain_look(b, text(table, "id"), model));
    check_coordinates(b, table, "terrain", mesh);
    keep_for_days(b.document, table, options.mesh.middle_m, std::move(model.field), mesh, b.scene);
    note_rounding(b, whose, nullptr, mesh);
    append_mesh(b.scene.mesh, mesh);
}

/// The lens's mask when it comes from a file, else nothing. Textures' limits hold for it, too.
Image<float> lens_mask(const Builder& b) {
    if (!b.document.root.has("optics")) return {};
    const SceneTable& optics = subtable(b.document.root, "optics");
    if (text(optics, "aperture") != "file") return {};
    return load_named(b, optics, "file", [&](const std::filesystem::path& path) {
        return read_mask(
            path, text(optics, "file"),
            {b.limits.texture_px, b.limits.texture_mib << 20, " (limits.texture_mib raises it)"});
    });
}

/// The sky's picture when it has one. Textures' limits hold for it, too.
std::shared_ptr<const ImageSky> sky_picture(Builder& b) {
    const SceneTable& sky = subtable(b.document.root, "sky");
    if (text(sky, "model") != "image") return nullptr;
    return load_named(b, sky, "file", [&](const std::filesystem::path& path) {
        const ImageFileLimits limits{b.limits.texture_px, b.limits.texture_mib << 20,
                                     " (limits.texture_mib raises it)"};
        const double scale = sky.has("file_scale") ? number(sky, "file_scale") : 1.0;
        ImageSky image = image_sky(read_file(path, largest_texture_file), text(sky, "file"), scale, limits);
        b.texture_memory += static_cast<std::int64_t>(image.pixels.pixels.size() * sizeof(Vec3f));
        if (sky.has("left_edge_azimuth_deg"))
            image.left_edge_azimuth_deg = number(sky, "left_edge_azimuth_deg");
        return std::make_shared<const ImageSky>(std::move(image));
    });
}

/// Keys that the file gives and that this kind of sky does not ask.
void note_idle_sky_keys(Builder& b) {
    const SceneTable& sky = subtable(b.document.root, "sky");
    const std::string& model = text(sky, "model");
    const auto note = [&](const char* key, bool asked, const std::string& needs) {
        if (!asked && sky.has(key) && place_of(sky, key).source >= 0)
            add_note(b, fmt::format("sky.{} does nothing {}", key, needs));
    };
    for (const char* key : {"zenith_w_m2_sr", "horizon_w_m2_sr", "ground_w_m2_sr"})
        note(key, model == "gradient", fmt::format("with model = \"{}\"", model));
    note("turbidity", model == "clear", fmt::format("with model = \"{}\"", model));
    note("ground_albedo", model == "clear" || model == "overcast", fmt::format("with model = \"{}\"", model));
    for (const char* key : {"bounces", "samples"})
        note(key, boolean(sky, "occlusion"), "without occlusion");
}

/// What lights of surfaces shine from.
void add_emitters(Builder& b) {
    for (const SceneTable* light : subtables(b.document.root, "light")) {
        if (light_kind_of(*light).kind != LightKind::surface) continue;
        const std::string& name = text(*light, "material");
        std::vector<std::string> names;
        for (const Material& m : b.scene.materials)
            names.push_back(m.name);
        const auto at = std::find(names.begin(), names.end(), name);
        if (at == names.end()) {
            fail_at(place_of(*light, "material"), b.document.sources,
                    fmt::format("the scene has no material '{}'{}", name, hint(name, names)));
        }
        if (b.scene.emitters.contains(name)) continue;
        const auto index = static_cast<std::size_t>(at - names.begin());
        auto surface = std::make_shared<const EmitterSurface>(
            emitter_surface(b.scene.mesh, static_cast<std::uint32_t>(index)));
        const Vec3f e = b.scene.materials[index].emission;
        const std::string& id = text(*light, "id");
        if (surface->pieces.empty()) {
            add_note(b, fmt::format("light '{}' is dark: no surface has the material '{}'", id, name));
        } else if (std::max({e.x, e.y, e.z}) <= 0) {
            add_note(b, fmt::format("light '{}' is dark: material '{}' has no emission_w_m2_sr", id, name));
        }
        b.scene.emitters[name] = std::move(surface);
    }
}

}  // namespace

Scene build_scene(const SceneDocument& document, const FileAccess& access) {
    Builder b{document, access, limits_of(document), {}, {}, {}, 0};
    b.scene.limits = b.limits;
    b.scene.render = render_settings_of(document);
    b.scene.sky = sky_of(document);
    b.scene.sky.image = sky_picture(b);
    note_idle_sky_keys(b);
    b.scene.outputs = outputs_of(document);
    add_materials(b);
    for (const SceneTable* mesh : subtables(document.root, "mesh"))
        add_mesh(b, *mesh);
    for (const SceneTable* terrain : subtables(document.root, "terrain"))
        add_terrain(b, *terrain);
    add_days(document, access, b.scene);
    add_emitters(b);
    b.scene.optics.mask = lens_mask(b);
    set_frame(b.scene, document, scene_frames(document).first);
    for (const std::string& note : enclosed_lamp_notes(b.scene))
        add_note(b, note);
    return std::move(b.scene);
}

}  // namespace obscura
