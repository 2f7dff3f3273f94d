// [[mesh]]: the keys all meshes share, and one variant per registered shape.

#include "app/scene/build.h"
#include "app/scene/key_ranges.h"
#include "app/scene/key_row.h"
#include "app/scene/keys.h"
#include "app/scene/mesh_transform.h"
#include "app/scene/shapes.h"

namespace obscura {
namespace {

/// Scaled, turned, moved: in this order.
struct Placement {
    Vec3d scale{1, 1, 1}, rotate_deg, translate_m;
};

const KeyRows<Placement>& placement_rows() {
    static const KeyRows<Placement> rows{
        key_row(&Placement::scale,
                vec3_or_number_key(
                    "scale",
                    "Scale along x, y, z, first; a negative one mirrors, 0 and what is nearer to it "
                    "than 1e-9 are errors.")
                    .in({-1e6, 1e6})),
        key_row(&Placement::rotate_deg,
                vec3_key("rotate_deg",
                         "Then turned about x, then y, then z, counter-clockwise seen from the axis' tip.")
                    .in(key_ranges::turns)),
        key_row(&Placement::translate_m, vec3_key("translate_m", "Then moved.").in(key_ranges::anywhere)),
    };
    return rows;
}

/// Of files alone.
const KeyRows<MeshOptions>& file_rows() {
    static const KeyRows<MeshOptions> rows{
        {file_key("file", "OBJ, glTF, PLY or STL file, relative to the scene file and inside its folder.")
             .need()},
        key_row(&MeshOptions::crease_angle_deg,
                number_key(
                    "crease_angle_deg",
                    "Where the file has neither normals nor smoothing groups: smooth across edges "
                    "that bend less than this. 20 suits buildings, 180 scans. glTF without normals is flat.")
                    .in({0, 180})),
    };
    return rows;
}

const KeyRows<MeshOptions>& option_rows() {
    static const KeyRows<MeshOptions> rows{
        key_row(&MeshOptions::casts_shadow, boolean_key("casts_shadow", "false: light passes through.")),
        key_row(&MeshOptions::flip_faces, boolean_key("flip_faces", "Turns every triangle inside out.")),
    };
    return rows;
}

}  // namespace

const TableSpec& mesh_table() {
    static const TableSpec instance{
        "[[mesh.instance]]",
        "A copy of the mesh, placed by its own transform after the mesh's. Without any there is one copy.",
        keys_of(placement_rows()),
        "",
        {}};
    static const TableSpec spec = [] {
        TableSpec t{"[[mesh]]", "Triangles from a file, or a shape made here.", {}, "shape", {}};
        std::vector<std::string> names{"file"};
        t.variants.push_back({"file",
                              "A model: Wavefront OBJ with its MTL, glTF 2.0 (.gltf, .glb), PLY or STL.",
                              keys_of(file_rows())});
        for (const ShapeSpec& shape : shapes()) {
            names.push_back(shape.variant.name);
            t.variants.push_back(shape.variant);
        }
        t.keys = {
            name_key("id", "Name, unique among meshes.").need(),
            choice_key("shape", names, "What it is made of.").or_else("file"),
            name_key("material",
                     "A [material.NAME]; without it, files keep their own materials and shapes get the "
                     "default one."),
        };
        for (KeySpec& key : keys_of(placement_rows()) + keys_of(option_rows()))
            t.keys.push_back(std::move(key));
        t.keys.push_back(name_map_key(
            "materials",
            "Instead of material: a [material.NAME] per slot of the shape or material of the file; "
            "slots not named keep their own look."));
        t.keys.push_back(table_list_key("instance", instance));
        return t;
    }();
    return spec;
}

MeshOptions mesh_options_of(const SceneTable& mesh) {
    MeshOptions options;
    read_rows(file_rows(), mesh, options);
    read_rows(option_rows(), mesh, options);
    return options;
}

Affine placement_of(const SceneTable& mesh) {
    Placement p;
    read_rows(placement_rows(), mesh, p);
    return placement(p.scale, p.rotate_deg, p.translate_m);
}

}  // namespace obscura
