#include "app/models/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "app/models/faces_mesh.h"
#include "app/models/mtl_text.h"
#include "app/models/obj_text.h"
#include "app/models/text_lines.h"
#include "core/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// How the files that an OBJ names are reached: from disk, or from memory. Both throw MissingFile.
struct Surroundings {
    std::function<std::vector<MtlEntry>(const NameInFile& library)> read_library;
    std::function<std::string(const MtlEntry& entry)> find_texture;
};

/// Runs fn; what it misses is noted instead, where that is allowed.
template <class Fn>
void tolerate_missing(Model& model, bool allowed, Fn&& fn) {
    try {
        fn();
    } catch (const MissingFile& error) {
        if (!allowed) {
            throw InputError(error.file, error.line, 0,
                             error.message + " (--allow-missing reads on without it)");
        }
        model.missing.emplace_back(error.what());
    }
}

/// Materials of all libraries by the whole rest of their newmtl line.
using MtlEntries = std::map<std::string, MtlEntry, std::less<>>;

/// The material that a usemtl line means: the one of the same whole name, or else of the same name when what
/// stands behind a # is taken for a comment, on either side. Null when there is none.
const MtlEntry* find_entry(const MtlEntries& entries, const NameInFile& used, const std::string& file) {
    const std::string bare(without_comment(used.name));
    for (const std::string& name : {used.name, bare}) {
        if (const auto at = entries.find(name); at != entries.end()) return &at->second;
    }
    const MtlEntry* found = nullptr;
    for (const auto& [name, entry] : entries) {
        if (without_comment(name) != bare) continue;
        if (found != nullptr) {
            throw InputError(file, used.line, 0,
                             fmt::format("material '{}' may be '{}' or '{}'", shown(used.name),
                                         shown(found->name), shown(name)));
        }
        found = &entry;
    }
    return found;
}

bool is_replaced(const ModelOptions& options, const std::string& name) {
    return std::find(options.replaced.begin(), options.replaced.end(), name) != options.replaced.end();
}

/// The name under which the scene replaces the material of a usemtl line; empty when it does not.
std::string replaced_name(const ModelOptions& options, const NameInFile& used) {
    const std::string bare(without_comment(used.name));
    return is_replaced(options, used.name) ? used.name : is_replaced(options, bare) ? bare : "";
}

MtlEntries read_libraries(Model& model, const ObjText& text, const Surroundings& around,
                          const ModelOptions& options) {
    MtlEntries entries;
    for (const NameInFile& library : text.libraries) {
        tolerate_missing(model, options.allow_missing, [&] {
            for (MtlEntry& e : around.read_library(library)) {
                if (entries.contains(e.name))
                    e.changed.emplace_back("newmtl is given more than once; the last counts");
                entries.insert_or_assign(e.name, std::move(e));
            }
        });
    }
    return entries;
}

/// What a list of names says in a note: the first three.
std::string names_text(const std::vector<std::string>& names) {
    constexpr std::size_t most = 3;
    std::string out;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
        out += fmt::format("{}'{}'", i == 0 ? "" : ", ", shown(names[i]));
    return names.size() > most ? out + fmt::format(" and {} more", names.size() - most) : out;
}

/// What materials lose, one note for each kind of loss with the names of the materials.
class Losses {
  public:
    void add(const MtlEntry& entry, const std::string& name) {
        if (entry.transparent) add("transparent in the file; drawn opaque", entry.file, name);
        for (const std::string& keyword : entry.unread)
            add(fmt::format("'{}' is not read", shown(keyword)), entry.file, name);
        for (const std::string& what : entry.changed)
            add(what, entry.file, name);
    }

    void write(std::vector<std::string>& notes) const {
        for (const auto& [file, what, names] : rows_) {
            const bool of_all = what.starts_with("transparent");
            const char* verb = !of_all ? ":" : names.size() == 1 ? " is" : " are";
            notes.push_back(fmt::format("{}: {}{} {}", file, names_text(names), verb, what));
        }
    }

  private:
    struct Row {
        std::string file, what;
        std::vector<std::string> names;
    };

    void add(const std::string& what, const std::string& file, const std::string& name) {
        auto row = std::find_if(rows_.begin(), rows_.end(),
                                [&](const Row& r) { return r.file == file && r.what == what; });
        if (row == rows_.end()) row = rows_.insert(row, {file, what, {}});
        row->names.push_back(name);
    }

    std::vector<Row> rows_;
};

void add_materials(Model& model, const ObjText& text, const std::string& file, const Surroundings& around,
                   const ModelOptions& options) {
    const auto replaced = [&](const NameInFile& used) { return !replaced_name(options, used).empty(); };
    const bool all_replaced = !text.material_names.empty() &&
                              std::all_of(text.material_names.begin(), text.material_names.end(), replaced);
    const MtlEntries entries = all_replaced ? MtlEntries{} : read_libraries(model, text, around, options);
    std::map<std::string, std::int32_t> texture_number;
    Losses losses;
    for (const NameInFile& used : text.material_names) {
        Material material;
        material.name = used.name;
        if (replaced(used)) {
            material.name = replaced_name(options, used);
            model.materials.push_back(std::move(material));
            continue;
        }
        const MtlEntry* entry = nullptr;
        tolerate_missing(model, options.allow_missing, [&] {
            entry = find_entry(entries, used, file);
            if (entry == nullptr) {
                throw MissingFile(
                    file, used.line, 0,
                    fmt::format("material '{}' is not defined in any mtllib", shown(used.name)));
            }
            material = entry->material;
            // A name that is the same only without its comment is told without it.
            if (entry->name != used.name) material.name = without_comment(used.name);
            losses.add(*entry, material.name);
        });
        tolerate_missing(model, options.allow_missing || !options.textures, [&] {
            if (entry == nullptr || entry->texture.empty()) return;
            const std::string path = around.find_texture(*entry);
            const auto count = static_cast<std::int32_t>(model.texture_files.size());
            const auto [number, added] = texture_number.try_emplace(path, count);
            if (added) model.texture_files.push_back(path);
            material.texture = number->second;
        });
        model.materials.push_back(std::move(material));
    }
    losses.write(model.notes);
}

void add_default_material(Model& model, const ObjText& text) {
    const auto default_material = static_cast<std::uint32_t>(text.material_names.size());
    const auto& used = model.mesh.material;
    if (std::find(used.begin(), used.end(), default_material) == used.end()) return;
    model.materials.emplace_back();
    model.materials.back().name = "default";
}

/// What of the text the mesh does without.
void note_skipped(Model& model, const ObjText& text, const FacesMesh& mesh, const std::string& file) {
    for (const ObjSkipped& s : text.skipped) {
        model.notes.push_back(fmt::format("{}:{}: {} {} not read ({} line{})", file, s.line, s.what,
                                          s.what[0] == '\'' ? "is" : "are", s.count,
                                          s.count == 1 ? "" : "s"));
    }
    note_mesh(mesh, file, model.notes);
}

Model build(std::string_view obj, const std::string& file, const std::string& name,
            const Surroundings& around, const Limits& limits, const ModelOptions& options) {
    ObjText text = parse_obj_text(obj, file, limits);
    FacesMesh built = build_faces_mesh(text, name, options.crease_angle_deg);
    Model model;
    note_skipped(model, text, built, file);
    model.mesh = std::move(built.mesh);
    model.origin = built.origin;
    model.topology = built.topology;
    model.without_uv = std::move(built.without_uv);
    model.file_positions = text.positions.size();
    if (options.materials) {
        add_materials(model, text, file, around, options);
        add_default_material(model, text);
    } else {
        model.mesh.material.assign(model.mesh.triangles.size(), 0);
    }
    return model;
}

/// The error of a named file, told at the place that names it.
[[noreturn]] void rethrow_at(const std::string& file, int line, std::string_view what,
                             const InputError& error) {
    const std::string message = fmt::format("{}: {}", what, error.message);
    if (dynamic_cast<const MissingFile*>(&error) != nullptr) throw MissingFile(file, line, 0, message);
    throw InputError(file, line, 0, message);
}

/// The files that the rest of an mtllib line names: one whose name may have blanks, or several.
std::vector<fs::path> library_files(const NameInFile& library, const fs::path& obj,
                                    const FileAccess& access) {
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
        for (std::string_view word = take_name_word(rest); !word.empty(); word = take_name_word(rest)) {
            files.push_back(resolve_beside(access, folder, word));
        }
    } catch (const InputError& error) {
        rethrow_at(obj.string(), library.line, what, error);
    }
    return files;
}

}  // namespace

Model load_obj(const fs::path& file, const FileAccess& access, const Limits& limits,
               const ModelOptions& options) {
    const std::string bytes = read_model_bytes(file, limits);
    Surroundings around;
    around.read_library = [&](const NameInFile& library) {
        std::vector<MtlEntry> entries;
        for (const fs::path& path : library_files(library, file, access)) {
            for (MtlEntry& e : parse_mtl_text(read_model_bytes(path, limits), path.string()))
                entries.push_back(std::move(e));
        }
        return entries;
    };
    around.find_texture = [&](const MtlEntry& entry) {
        const fs::path folder = fs::path(entry.file).parent_path();
        const std::string bare(without_comment(entry.texture));
        try {
            // The whole rest of the line, or what stands before a comment.
            try {
                return resolve_beside(access, folder, entry.texture).string();
            } catch (const MissingFile&) {
                if (bare == entry.texture) throw;
                return resolve_beside(access, folder, bare).string();
            }
        } catch (const InputError& error) {
            rethrow_at(entry.file, entry.texture_line, fmt::format("map_Kd {}", shown(entry.texture)), error);
        }
    };
    return build(bytes, file.string(), file.stem().string(), around, limits, options);
}

Model obj_from_text(std::string_view obj, std::string_view mtl, const Limits& limits,
                    const ModelOptions& options) {
    Surroundings around;
    around.read_library = [&](const NameInFile&) { return parse_mtl_text(mtl, "text.mtl"); };
    around.find_texture = [](const MtlEntry& entry) { return std::string(without_comment(entry.texture)); };
    return build(obj, "text.obj", "text", around, limits, options);
}

}  // namespace obscura
