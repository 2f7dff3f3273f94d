#include "app/scene/rules_stereo.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "app/scene/keyframe_rules.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/validate.h"

namespace obscura {
namespace {

using Sources = std::vector<std::string>;

struct Known {
    const SceneTable& root;
    const std::vector<std::string>& mesh_ids;
    const std::vector<std::string>& materials;
    const Sources& sources;
};

/// Two keys of which one may be given; says so at the one that was written last.
void check_one_of(const SceneTable& table, const char* a, const char* b, const Sources& sources) {
    if (!table.has(a) || !table.has(b)) return;
    const Place pa = place_of(table, a), pb = place_of(table, b);
    const bool a_later = std::pair(pa.line, pa.column) > std::pair(pb.line, pb.column);
    fail_at(a_later ? pa : pb, sources, fmt::format("give either '{}' or '{}', not both", a, b));
}

// --- targets

const SceneTable& mesh_named(const Known& known, const std::string& id) {
    for (const SceneTable* mesh : subtables(known.root, "mesh")) {
        if (text(*mesh, "id") == id) return *mesh;
    }
    return known.root;
}

/// "ID", "ID/OBJECT", "ID#0", "ID/OBJECT#0". The mesh and the instance are known, objects of files are not.
void check_object(const std::string& name, const Place& place, const Known& known) {
    const std::string id = name.substr(0, name.find_first_of("/#"));
    require_known(id, place, known.mesh_ids, "mesh", known.sources);
    const SceneTable& mesh = mesh_named(known, id);
    const std::size_t instances = subtables(mesh, "instance").size();
    const bool of_file = text(mesh, "shape") == "file";
    if (name.size() > id.size() && name[id.size()] == '/' && !of_file) {
        fail_at(place, known.sources,
                fmt::format("mesh '{}' is one object; name parts of it by 'materials'", id));
    }
    if (name.size() == id.size() || name[id.size()] != '#') return;
    std::size_t number = 0;
    const char *first = name.data() + id.size() + 1, *last = name.data() + name.size();
    const auto [end, status] = std::from_chars(first, last, number);
    if (status == std::errc{} && end == last && number < instances) return;
    fail_at(place, known.sources,
            instances == 0 ? fmt::format("mesh '{}' has no instances to be numbered", id)
                           : fmt::format("there is no object '{}'; mesh '{}' has instances #0 to #{}", name,
                                         id, instances - 1));
}

/// [material.NAME], or "ID/SLOT", whose slots are known when the mesh is made.
void check_material(const std::string& name, const Place& place, const Known& known) {
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) {
        require_known(name, place, known.materials, "material", known.sources);
    } else {
        require_known(name.substr(0, slash), place, known.mesh_ids, "mesh", known.sources);
    }
}

void check_names(const SceneTable& edit, const char* key, const Known& known,
                 void (*check)(const std::string&, const Place&, const Known&)) {
    if (!edit.has(key)) return;
    for (const SceneValue& item : std::get<SceneList>(edit.find(key)->value.data))
        check(std::get<std::string>(item.data), item.place, known);
}

void check_targets(const SceneTable& edit, const Known& known) {
    for (const char* key : {"objects", "second_objects"})
        check_names(edit, key, known, check_object);
    for (const char* key : {"materials", "second_materials"})
        check_names(edit, key, known, check_material);
    const std::string& type = text(edit, "type");
    if (type == "match") return;
    const Place place = place_of(edit, "id");
    const std::string who = fmt::format("edit '{}'", text(edit, "id"));
    const bool first = edit.has("objects") || edit.has("materials");
    const bool second = edit.has("second_objects") || edit.has("second_materials");
    if (first || (type == "interface" && (second || edit.has("mask")))) return;
    fail_at(
        place, known.sources,
        fmt::format("{} needs 'objects' or 'materials'{}", who, type == "interface" ? ", or a 'mask'" : ""));
}

// --- numbers

/// [full, none], which differ, and what they are measured from.
void check_fade(const SceneTable& edit, const char* range, const char* from, const Sources& sources) {
    if (edit.has(range) != edit.has(from)) {
        const char* given = edit.has(range) ? range : from;
        fail_at(place_of(edit, given), sources,
                fmt::format("'{}' needs '{}'", given, edit.has(range) ? from : range));
    }
    if (!edit.has(range)) return;
    const Vec2d ends = vec2(edit, range);
    if (ends.x == ends.y)
        fail_at(place_of(edit, range), sources, fmt::format("the two numbers of '{}' must differ", range));
}

/// A point of the picture or of the scene: one of the two, and a pixel of the picture.
void check_point(const SceneTable& edit, const std::string& name, const Known& known) {
    const std::string px = name + "_px", m = name + "_m";
    check_one_of(edit, px.c_str(), m.c_str(), known.sources);
    if (!edit.has(px) && !edit.has(m)) {
        fail_at(place_of(edit, "id"), known.sources,
                fmt::format("edit '{}' needs '{}' or '{}'", text(edit, "id"), px, m));
    }
    if (!edit.has(px)) return;
    const Vec2d p = vec2(edit, px);
    const Size2 size = size2(subtable(known.root, "render"), "size_px");
    if (p.x >= 0 && p.x < size.width && p.y >= 0 && p.y < size.height) return;
    fail_at(place_of(edit, px), known.sources,
            fmt::format("'{}' lies outside of the picture of {} x {} pixels; '{}' fits pictures of any size",
                        px, size.width, size.height, m));
}

/// `edit` as it is at some frame.
void check_edit_numbers(const SceneTable& edit, const Known& known) {
    const std::string& type = text(edit, "type");
    if ((type == "roundness" || type == "interface") && number(edit, "weight") > 1) {
        fail_at(place_of(edit, "weight"), known.sources,
                fmt::format("'weight' of type = \"{}\" is the share that is applied: at most 1, not {}", type,
                            number(edit, "weight")));
    }
    check_one_of(edit, "offset_px", "offset_percent", known.sources);
    check_fade(edit, "fade_angle_deg", "fade_direction", known.sources);
    check_fade(edit, "fade_distance_m", "fade_position_m", known.sources);
    if (edit.has("fade_direction") && vec3(edit, "fade_direction") == Vec3d{})
        fail_at(place_of(edit, "fade_direction"), known.sources, "'fade_direction' has no direction");
    if (type == "match") {
        check_point(edit, "source", known);
        check_point(edit, "destination", known);
    }
}

void check_edit_ids(const std::vector<const SceneTable*>& edits, const Sources& sources) {
    for (std::size_t i = 0; i < edits.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            if (text(*edits[i], "id") != text(*edits[k], "id")) continue;
            fail_at(place_of(*edits[i], "id"), sources,
                    fmt::format("two edits have the id '{}'", text(*edits[i], "id")));
        }
    }
}

void check_edits(const SceneDocument& document, const FrameRange& range, const Known& known) {
    const SceneTable& frames = subtable(document.root, "frames");
    const std::vector<const SceneTable*> edits = subtables(subtable(document.root, "stereo"), "edit");
    check_edit_ids(edits, known.sources);
    std::vector<std::string> ids;
    for (const SceneTable* edit : edits) {
        const std::string& id = ids.emplace_back(text(*edit, "id"));
        check_targets(*edit, known);
        std::vector<const SceneTable*> own = subtables(frames, "stereo_edit");
        std::erase_if(own, [&](const SceneTable* k) { return text(*k, "id") != id; });
        check_keyframes(own, *edit, fmt::format("edit '{}'", id),
                        variant_of(*edit, stereo_edit_table())->keys, known.sources);
        for (int i = 0; i < (own.empty() ? 1 : range.count()); ++i)
            check_edit_numbers(stereo_edit_at(document, *edit, range.at(i)), known);
    }
    for (const SceneTable* keyframe : subtables(frames, "stereo_edit"))
        require_known(text(*keyframe, "id"), place_of(*keyframe, "id"), ids, "edit", known.sources);
}

}  // namespace

void check_stereo(const SceneDocument& document, const std::vector<std::string>& mesh_ids,
                  const std::vector<std::string>& materials) {
    const SceneTable& root = document.root;
    const SceneTable& frames = subtable(root, "frames");
    const std::vector<const SceneTable*> keyframes = subtables(frames, "stereo");
    if (!root.has("stereo")) {
        for (const char* list : {"stereo", "stereo_edit"}) {
            if (subtables(frames, list).empty()) continue;
            fail_at(place_of(*subtables(frames, list).front(), "frame"), document.sources,
                    "there is no [stereo] to be animated");
        }
        return;
    }
    if (text(subtable(root, "camera"), "projection") != "perspective") {
        fail_at(
            root.find("stereo")->place, document.sources,
            "[stereo] needs a camera with projection = \"perspective\": parallel views have no disparity");
    }
    const FrameRange range = scene_frames(document);
    const SceneTable& stereo = subtable(root, "stereo");
    if (number(stereo, "remap_near_percent") < number(stereo, "remap_far_percent")) {
        const bool near = place_of(stereo, "remap_near_percent").source >= 0;
        fail_at(place_of(stereo, near ? "remap_near_percent" : "remap_far_percent"), document.sources,
                "'remap_near_percent' must not be less than 'remap_far_percent'");
    }
    check_keyframes(keyframes, stereo, "[stereo]", stereo_table().keys, document.sources);
    for (int i = 0; i < (keyframes.empty() ? 1 : range.count()); ++i) {
        const SceneTable at = stereo_at(document, range.at(i));
        check_one_of(at, "comfort_near_percent", "comfort_near_deg", document.sources);
        check_one_of(at, "comfort_far_percent", "comfort_far_deg", document.sources);
    }
    check_edits(document, range, {root, mesh_ids, materials, document.sources});
}

}  // namespace obscura
