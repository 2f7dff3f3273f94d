#include "app/scene/format_doc.h"

#include <fmt/format.h>

#include "app/scene/keys.h"
#include "app/scene/toml_text.h"

namespace obscura {
namespace {

constexpr const char* introduction = R"(# The scene format

This page is written by `obscura dump --format` from the declarations that read scene files
(`app/scene/keys*.cpp`, `app/scene/light_kinds.cpp`, `app/scene/shapes.cpp`); do not edit it by hand.

A scene is a TOML 1.0 file. The world is right-handed, +Y up, in metres; north is -Z and east is +X. Units stand in
the names of keys (`_deg`, `_m`, `_mm`, `_px`). Colours are linear Rec. 709 triples, or one number for grey.
Light is counted in watts per channel on a scale of the scene's own: a white wall that faces a sun of irradiance 3
has a radiance of about 1, and an exposure of 0 EV and the default sky are made for that. A scene in true watts (a sun
of 330 W/m2 per channel) needs `exposure_ev = -6.8` and a sky 110 times as bright.
Paths are relative to the scene file and may not leave its folder unless `--allow-path DIR` says so.
Unknown keys, wrong types and values out of range are errors with file, line and column.

`-D key=value` replaces or adds a value: `-D camera.vfov_deg=30`, `-D light.sun.elevation_deg=12`,
`-D 'render.size_px=[320, 180]'`. Elements of a list are named by their `id`, or by their number from 0. The value is
TOML; a bare word is a string.

A file is at most 16 MiB of UTF-8, nested at most 64 deep, with keys of at most 16 parts.

A small scene:

```toml
format = 1
[camera]
eye_m = [4, 3, 6]
look_at_m = [0, 0.5, 0]
[[mesh]]
id = "ball"
shape = "sphere"
translate_m = [0, 0.5, 0]
material = "clay"
[[mesh]]
id = "ground"
shape = "plane"
width_m = 20
depth_m = 20
[material.clay]
base_color = [0.55, 0.25, 0.15]
[[light]]
id = "sun"
type = "directional"
azimuth_deg = 135
elevation_deg = 40
```
)";

const char* type_name(KeyType type) {
    switch (type) {
        case KeyType::boolean:
            return "true or false";
        case KeyType::integer:
            return "integer";
        case KeyType::number:
            return "number";
        case KeyType::text:
            return "text";
        case KeyType::file:
            return "file";
        case KeyType::name:
            return "name";
        case KeyType::choice:
            return "text";
        case KeyType::size2:
            return "2 integers";
        case KeyType::vec2:
            return "2 numbers";
        case KeyType::vec3:
            return "3 numbers";
        case KeyType::vec3_or_number:
            return "3 numbers, or 1";
        case KeyType::date_time:
            return "date and time";
        case KeyType::time_of_day:
            return "text";
        case KeyType::name_list:
            return "list of names";
        case KeyType::name_map:
            return "table of names";
        case KeyType::table:
        case KeyType::table_list:
        case KeyType::table_map:
            return "table";
    }
    return "";
}

std::string type_text(const KeySpec& key) {
    return key.word.empty() ? type_name(key.type) : fmt::format("{} or text", type_name(key.type));
}

/// Keys as rows; tables have sections of their own.
void add_keys(std::string& out, const std::vector<KeySpec>& keys) {
    out += "\n| key | type | unit | values | default | meaning |\n|---|---|---|---|---|---|\n";
    for (const KeySpec& key : keys) {
        if (key.table != nullptr) continue;
        const std::string fallback = key.required   ? "required"
                                     : key.fallback ? fmt::format("`{}`", toml_text(*key.fallback))
                                                    : "";
        out += fmt::format("| `{}`{} | {} | {} | {} | {} | {} |\n", key.name, key.animated ? " ~" : "",
                           type_text(key), unit_of(key.name), allowed_text(key), fallback, key.doc);
    }
}

void add_table(std::string& out, const TableSpec& spec) {
    if (!spec.path.empty()) out += fmt::format("\n## `{}`\n\n{}\n", spec.path, spec.doc);
    if (spec.path.empty()) out += "\n## At the top\n";
    add_keys(out, spec.keys);
    for (const VariantSpec& variant : spec.variants) {
        out += fmt::format("\n### `{}` with `{} = \"{}\"`\n", spec.path, spec.discriminator, variant.name);
        if (!variant.doc.empty()) out += fmt::format("\n{}\n", variant.doc);
        if (!variant.keys.empty()) add_keys(out, variant.keys);
    }
    for (const KeySpec& key : spec.keys) {
        // The shadow of a light is documented once, as [shadow.LIGHT].
        const bool again = key.table == &shadow_table() && key.type == KeyType::table;
        if (key.table == nullptr || again) continue;
        if (!key.beside_tables.empty()) {
            out += fmt::format("\n## `[{}]`\n\nBeside the tables below.\n", key.name);
            add_keys(out, key.beside_tables);
        }
        add_table(out, *key.table);
    }
}

}  // namespace

std::string scene_format_doc() {
    std::string out = introduction;
    out += "\nKeys marked ~ can be set by `[frames]`.\n";
    add_table(out, scene_schema_root());
    return out;
}

}  // namespace obscura
