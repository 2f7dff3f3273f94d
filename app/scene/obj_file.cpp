// tinyobjloader 2.0rc10 reads OBJ trustingly: indices out of range, words instead of numbers, polygons of
// more than 255 corners and paths anywhere pass it without an error, and its numbers go through libm's pow,
// whose bits vary by CPU. So the text is read by app/obj_text and, for the few MTL statements that a Material
// can hold, here; the library is left with what it does well, the option syntax of texture statements.
#include "app/scene/obj_file.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "app/scene/obj_mesh.h"
#include "app/scene/obj_text.h"
#include "app/scene/text_lines.h"
#include "core/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// What one newmtl block says, with the lines for messages.
struct MtlEntry {
    std::string name;
    Vec3f kd{0.8f, 0.8f, 0.8f}, ks{0, 0, 0}, ke{0, 0, 0};
    std::optional<float> ns, pr, pm;
    std::string texture;
    std::string file;
    int texture_line = 0;
};

Vec3f parse_colour(std::string_view keyword, std::string_view rest, const TextPlace& place) {
    std::array<float, 3> c = {};
    std::size_t count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
        if (count == 0 && (word == "spectral" || word == "xyz")) {
            throw InputError(place.file, place.line, 0,
                             fmt::format("{} {} is not supported, only RGB", keyword, word));
        }
        const float value = parse_float(word, place);
        if (value < 0)
            throw InputError(place.file, place.line, 0, fmt::format("{} must not be negative", keyword));
        if (count < 3) c[count] = value;
    }
    // One number stands for all three channels.
    if (count == 1) return {c[0], c[0], c[0]};
    if (count != 3) {
        throw InputError(place.file, place.line, 0,
                         fmt::format("{} takes 3 numbers, found {}", keyword, count));
    }
    return {c[0], c[1], c[2]};
}

float parse_scalar(std::string_view keyword, std::string_view rest, float largest, const TextPlace& place) {
    const float value = parse_float(take_word(rest), place);
    if (!(value >= 0 && value <= largest)) {
        throw InputError(place.file, place.line, 0,
                         fmt::format("{} must be in [0, {}], not {}", keyword, largest, value));
    }
    return value;
}

std::string parse_texture(std::string_view rest, const TextPlace& place) {
    const auto fail = [&](const std::string& message) {
        throw InputError(place.file, place.line, 0, message);
    };
    std::string name;
    tinyobj::texture_option_t options = {};
    options.scale[0] = options.scale[1] = options.scale[2] = 1;
    options.contrast = 1;
    const std::string statement(trimmed(rest));
    if (!tinyobj::ParseTextureNameAndOption(&name, &options, statement.c_str()) || trimmed(name).empty()) {
        fail("map_Kd names no file (-o, -s and -t take three numbers each)");
    }
    const auto all = [](const float(&v)[3], float value) {
        return v[0] == value && v[1] == value && v[2] == value;
    };
    if (!all(options.scale, 1) || !all(options.origin_offset, 0) || !all(options.turbulence, 0) ||
        options.clamp || options.brightness != 0 || options.contrast != 1) {
        fail("map_Kd: scaling, moving, clamping or recolouring a texture is not supported");
    }
    std::string file(trimmed(name));
    std::replace(file.begin(), file.end(), '\\', '/');
    return file;
}

std::vector<MtlEntry> parse_mtl(std::string_view text, const std::string& file) {
    std::vector<MtlEntry> entries;
    LineReader lines(text);
    constexpr std::array<std::string_view, 7> known = {"Kd", "Ks", "Ke", "Ns", "Pr", "Pm", "map_Kd"};
    while (lines.next()) {
        std::string_view rest = lines.line();
        const std::string_view keyword = take_word(rest);
        const TextPlace place{file, lines.number()};
        if (keyword == "newmtl") {
            const std::string name(trimmed(rest));
            if (name.empty()) throw InputError(file, place.line, 0, "newmtl without a name");
            entries.emplace_back();
            entries.back().name = name;
            entries.back().file = file;
            continue;
        }
        if (std::find(known.begin(), known.end(), keyword) == known.end()) continue;
        if (entries.empty())
            throw InputError(file, place.line, 0, fmt::format("{} before any newmtl", keyword));
        MtlEntry& entry = entries.back();
        if (keyword == "Kd") entry.kd = parse_colour(keyword, rest, place);
        if (keyword == "Ks") entry.ks = parse_colour(keyword, rest, place);
        if (keyword == "Ke") entry.ke = parse_colour(keyword, rest, place);
        if (keyword == "Ns") entry.ns = parse_scalar(keyword, rest, 1e6f, place);
        if (keyword == "Pr") entry.pr = parse_scalar(keyword, rest, 1.0f, place);
        if (keyword == "Pm") entry.pm = parse_scalar(keyword, rest, 1.0f, place);
        if (keyword == "map_Kd") {
            entry.texture = parse_texture(rest, place);
            entry.texture_line = place.line;
        }
    }
    return entries;
}

Vec3f clamped(Vec3f c) {
    return {std::min(c.x, 1.0f), std::min(c.y, 1.0f), std::min(c.z, 1.0f)};
}
bool black(Vec3f c) {
    return c.x <= 0 && c.y <= 0 && c.z <= 0;
}

Material to_material(const MtlEntry& entry) {
    Material m;
    m.name = entry.name;
    const bool metal = !entry.pm && black(entry.kd) && !black(entry.ks) && entry.texture.empty();
    m.base_color = clamped(metal ? entry.ks : entry.kd);
    m.metallic = entry.pm.value_or(metal ? 1.0f : 0.0f);
    m.emission = entry.ke;
    float roughness = 1.0f;
    if (entry.ns && !black(entry.ks)) roughness = std::sqrt(std::sqrt(2.0f / (*entry.ns + 2.0f)));
    m.roughness = std::clamp(entry.pr.value_or(roughness), 0.02f, 1.0f);
    return m;
}

/// How the files that an OBJ names are reached: from disk, or from memory. Both throw MissingFile.
struct Surroundings {
    std::function<std::vector<MtlEntry>(const ObjName& library)> read_library;
    std::function<std::string(const MtlEntry& entry)> find_texture;
};

/// Runs fn; what it misses is noted instead, if the options allow.
template <class Fn>
void tolerate_missing(ObjModel& model, const ObjOptions& options, Fn&& fn) {
    try {
        fn();
    } catch (const MissingFile& error) {
        if (!options.allow_missing) {
            throw InputError(error.file, error.line, 0,
                             error.message + " (info --allow-missing reads on without it)");
        }
        model.missing.emplace_back(error.what());
    }
}

void add_materials(ObjModel& model, const ObjText& text, const std::string& file, const Surroundings& around,
                   const ObjOptions& options) {
    std::map<std::string, MtlEntry> entries;
    for (const ObjName& library : text.libraries) {
        tolerate_missing(model, options, [&] {
            for (MtlEntry& e : around.read_library(library))
                entries.insert_or_assign(e.name, std::move(e));
        });
    }
    std::map<std::string, std::int32_t> texture_number;
    for (const ObjName& used : text.material_names) {
        Material material;
        material.name = used.name;
        tolerate_missing(model, options, [&] {
            const auto at = entries.find(used.name);
            if (at == entries.end()) {
                throw MissingFile(
                    file, used.line, 0,
                    fmt::format("material '{}' is not defined in any mtllib", shown(used.name)));
            }
            material = to_material(at->second);
            if (at->second.texture.empty()) return;
            const std::string path = around.find_texture(at->second);
            const auto count = static_cast<std::int32_t>(model.texture_files.size());
            const auto [number, added] = texture_number.try_emplace(path, count);
            if (added) model.texture_files.push_back(path);
            material.texture = number->second;
        });
        model.materials.push_back(std::move(material));
    }
    const auto default_material = static_cast<std::uint32_t>(text.material_names.size());
    const auto& used = model.mesh.material;
    if (std::find(used.begin(), used.end(), default_material) != used.end()) {
        model.materials.emplace_back();
        model.materials.back().name = "default";
    }
}

ObjModel build(std::string_view obj, const std::string& file, const std::string& name,
               const Surroundings& around, const Limits& limits, const ObjOptions& options) {
    const ObjText text = parse_obj_text(obj, file, limits);
    ObjModel model;
    model.mesh = build_obj_mesh(text, name, options.crease_angle_deg, model.topology);
    model.file_positions = text.positions.size();
    add_materials(model, text, file, around, options);
    return model;
}

std::string read_limited(const fs::path& file, const Limits& limits) {
    try {
        return read_file(file, limits.memory_mib * (1024 * 1024 / 8));
    } catch (const LimitError& error) {
        throw LimitError(fmt::format("{}, an eighth of limits.memory_mib", error.what()));
    }
}

/// The error of a named file, told at the place that names it.
[[noreturn]] void rethrow_at(const std::string& file, int line, std::string_view what,
                             const InputError& error) {
    const std::string message = fmt::format("{}: {}", what, error.message);
    if (dynamic_cast<const MissingFile*>(&error) != nullptr) throw MissingFile(file, line, 0, message);
    throw InputError(file, line, 0, message);
}

/// The files that the rest of an mtllib line names: one whose name may have blanks, or several.
std::vector<fs::path> library_files(const ObjName& library, const fs::path& obj, const FileAccess& access) {
    const fs::path folder = obj.parent_path();
    const std::string what = fmt::format("mtllib {}", shown(library.name));
    std::vector<fs::path> files;
    try {
        return {resolve_beside(access, folder, library.name)};
    } catch (const InputError& error) {
        if (library.name.find_first_of(" \t") == std::string::npos)
            rethrow_at(obj.string(), library.line, what, error);
    }
    try {
        std::string_view rest = library.name;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            files.push_back(resolve_beside(access, folder, word));
        }
    } catch (const InputError& error) {
        rethrow_at(obj.string(), library.line, what, error);
    }
    return files;
}

}  // namespace

ObjModel load_obj(const fs::path& file, const FileAccess& access, const Limits& limits,
                  const ObjOptions& options) {
    const std::string bytes = read_limited(file, limits);
    Surroundings around;
    around.read_library = [&](const ObjName& library) {
        std::vector<MtlEntry> entries;
        for (const fs::path& path : library_files(library, file, access)) {
            for (MtlEntry& e : parse_mtl(read_limited(path, limits), path.string()))
                entries.push_back(std::move(e));
        }
        return entries;
    };
    around.find_texture = [&](const MtlEntry& entry) {
        try {
            return resolve_beside(access, fs::path(entry.file).parent_path(), entry.texture).string();
        } catch (const InputError& error) {
            rethrow_at(entry.file, entry.texture_line, fmt::format("map_Kd {}", shown(entry.texture)), error);
        }
    };
    return build(bytes, file.string(), file.stem().string(), around, limits, options);
}

ObjModel obj_from_text(std::string_view obj, std::string_view mtl, const Limits& limits,
                       const ObjOptions& options) {
    Surroundings around;
    around.read_library = [&](const ObjName&) { return parse_mtl(mtl, "text.mtl"); };
    around.find_texture = [](const MtlEntry& entry) { return entry.texture; };
    return build(obj, "text.obj", "text", around, limits, options);
}

}  // namespace obscura
