// The format's description is complete, and every key it describes is read: changing it changes the scene.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "app/scene/build.h"
#include "app/scene/format_doc.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/shapes.h"
#include "app/scene/toml_text.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/sky/image_sky.h"
#include "tests/scene/key_probe.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

std::string committed_doc() {
    std::stringstream text;
    text << std::ifstream(fs::path(OBSCURA_SOURCE_DIR) / "app/scene/format.md").rdbuf();
    return text.str();
}

TEST(SceneFormat, DescriptionIsTheCommittedOne) {
    EXPECT_TRUE(scene_format_doc() == committed_doc())
        << "app/scene/format.md is stale; write it anew: obscura dump --format > app/scene/format.md";
}

/// Calls fn(table, keys of the table or of one of its variants) for everything below `spec`.
void for_each_key_list(const TableSpec& spec,
                       const std::function<void(const TableSpec&, const std::vector<KeySpec>&)>& fn) {
    fn(spec, spec.keys);
    for (const VariantSpec& variant : spec.variants)
        fn(spec, variant.keys);
    for (const KeySpec& key : spec.keys) {
        if (key.table != nullptr) for_each_key_list(*key.table, fn);
    }
}

TEST(SceneFormat, EveryKeyIsDescribed) {
    const std::string doc = committed_doc();
    for_each_key_list(scene_schema_root(), [&](const TableSpec& table, const std::vector<KeySpec>& keys) {
        for (const KeySpec& key : keys) {
            if (key.table != nullptr) {
                EXPECT_NE(doc.find("## `" + key.table->path + "`"), std::string::npos) << key.table->path;
                continue;
            }
            EXPECT_GE(key.doc.size(), 5u) << table.path << " " << key.name;
            EXPECT_NE(doc.find("| `" + key.name + "`"), std::string::npos) << table.path << " " << key.name;
        }
    });
}

// --- every key is read

/// Everything that rendering can see of a scene, compared by the structs' own equality.
struct SceneLook {
    std::uint64_t meshes = 0, textures = 0, sky_image = 0;  ///< hashes
    std::vector<Material> materials;
    Sky sky;
    RenderSettings render;
    std::vector<Output> outputs;
    Limits limits;
    // Frame by frame.
    std::vector<Camera> cameras;
    std::vector<OpticsSettings> lenses;
    std::vector<std::vector<SceneLight>> lights;
    friend bool operator==(const SceneLook&, const SceneLook&) = default;
};

SceneLook look_at_scene(const SceneDocument& document, const FileAccess& access) {
    Scene s = build_scene(document, access);
    Hasher mesh, textures;
    mesh.values(s.mesh.positions).values(s.mesh.normals).values(s.mesh.uvs);
    mesh.values(s.mesh.triangles).values(s.mesh.material);
    for (const Object& o : s.mesh.objects)
        mesh.bytes(o.name.data(), o.name.size()).value(o.name.size()).value(o.casts_shadow);
    for (const Texture& t : s.textures)
        textures.values(t.levels.at(0).pixels);
    Hasher sky_image;
    if (s.sky.image) sky_image.values(s.sky.image->pixels.pixels).value(s.sky.image->left_edge_azimuth_deg);
    SceneLook look{mesh.state, textures.state, sky_image.state, s.materials, s.sky,
                   s.render,   s.outputs,      s.limits,        {},          {},
                   {}};
    look.sky.image = nullptr;  // which differs with every reading
    const FrameRange range = scene_frames(document);
    for (int i = 0; i < range.count(); ++i) {
        set_frame(s, document, range.at(i));
        look.cameras.push_back(s.camera);
        look.lenses.push_back(s.optics);
        look.lights.push_back(s.lights);
        for (SceneLight& light : look.lights.back())
            light.light.surface = nullptr;  // as does this
    }
    return look;
}

class SceneKeys : public SceneKeyProbe<SceneLook> {
  protected:
    SceneLook look_of(const SceneDocument& document) const override {
        return look_at_scene(document, access_);
    }
    bool same(const std::string& a, const std::string& b) const {
        return look_of(read_scene_text(a, "a")) == look_of(read_scene_text(b, "b"));
    }
};

const std::string start = "format = 1\n[limits]\n[material.main]\ntexture = \"one.png\"\n[material.other]\n";
const std::string camera = "[camera]\neye_m = [1, 2, 5]\nlook_at_m = [0, 0, 0]\n";
const std::string keyframes = "[frames]\nrange = \"1-5\"\n";

TEST_F(SceneKeys, OfCameraAreRead) {
    const std::string fov = start + camera, lens = fov + "focal_length_mm = 35\n",
                      flat = fov + "projection = \"orthographic\"\nheight_m = 2\n";
    expect_all_matter({flat}, "camera.", camera_table().keys, {"projection"});
    EXPECT_FALSE(same(fov, flat));
    expect_all_matter({fov, lens}, "camera.", camera_table().variants.at(0).keys);
    expect_all_matter({flat}, "camera.", camera_table().variants.at(1).keys);
}

TEST_F(SceneKeys, OfMeshesAreRead) {
    const auto with = [](const std::string& keys) {
        return start + camera + "[[mesh]]\nid = \"m\"\n" + keys;
    };
    const std::string box = with("shape = \"box\"\n[[mesh.instance]]\n"), file = with("file = \"tent.obj\"");
    expect_all_matter({box}, "mesh.m.", mesh_table().keys, {"shape"});
    EXPECT_FALSE(same(box, file));
    for (const KeySpec& key : mesh_table().keys) {
        if (key.name == "instance") expect_all_matter({box}, "mesh.m.instance.0.", key.table->keys);
    }
    expect_all_matter({file}, "mesh.m.", mesh_table().variants.at(0).keys);
    for (const ShapeSpec& shape : shapes()) {
        expect_all_matter({with("shape = \"" + shape.variant.name + "\"")}, "mesh.m.", shape.variant.keys);
    }
}

TEST_F(SceneKeys, OfTerrainsAreRead) {
    write("hill.asc", "ncols 3\nnrows 3\ncellsize 20\nnodata_value -9\n1 2 3 4 -9 5 2 0 1\n");
    const std::string head = start + camera + "[[terrain]]\nid = \"t\"\n";
    const std::string hill = head + "file = \"hill.asc\"\nholes = \"fill\"\n";
    const std::string level = head + "file = \"hill.asc\"\nholes = \"level\"\n";
    const std::string codes = head + "file = \"four.pgm\"\ncell_x_m = 2\nz_step_m = 1\n";
    write("four.pgm", "P2 2 2 9 1 3 4 5");
    write("other.pgm", "P2 2 2 9 1 3 4 9");
    const std::string degrees = head + "file = \"globe.asc\"\nlatitude_deg = 40\n";
    write("globe.asc", "ncols 2\nnrows 2\nxllcorner 14\nyllcorner 37\ncellsize 0.001\n1 2 3 4\n");
    expect_all_matter({hill, level, codes, degrees}, "terrain.t.", terrain_table().keys);
}

/// A light of the kind with what it needs, under the id.
std::string light_of_kind(const VariantSpec& kind, const std::string& id) {
    return "[[light]]\nid = \"" + id + "\"\ntype = \"" + kind.name + "\"\n" + required_keys(kind.keys);
}

TEST_F(SceneKeys, OfLightsAndShadowsAreRead) {
    for (const VariantSpec& variant : light_table().variants) {
        const std::string base = start + camera + light_of_kind(variant, "l");
        expect_all_matter({base}, "light.l.", light_table().keys, {"type"});
        expect_all_matter({base}, "light.l.", variant.keys);
        // Those of a day need ground and a file of its own (tests/frame/day_frame_test.cpp).
        const std::set<std::string> of_day = {"day_file", "max_sun_deg"};
        expect_all_matter({base}, "light.l.shadow.", shadow_table().keys, of_day);
        expect_all_matter({base}, "shadow.l.", shadow_table().keys, of_day);
    }
}

TEST_F(SceneKeys, OfFramesAreRead) {
    const auto list = [](const char* name) -> const std::vector<KeySpec>& {
        for (const KeySpec& key : frames_table().keys) {
            if (key.name == name) return key.table->keys;
        }
        throw UsageError(name);
    };
    const std::string smooth =
        start + camera + keyframes +
        "[[frames.camera]]\nframe = 1\neye_m = [0, 0, 5]\n[[frames.camera]]\nframe = 3\neye_m = [3, 1, 5]\n"
        "[[frames.camera]]\nframe = 5\neye_m = [4, 4, 5]\n";
    expect_all_matter({smooth}, "frames.", frames_table().keys);
    const std::string one =
        keyframes +
        "[[frames.camera]]\nframe = 1\neye_m = [0, 0, 5]\n[[frames.camera]]\nframe = 4\neye_m = [0, 1, 5]\n";
    expect_all_matter({start + camera + one, start + camera + "focal_length_mm = 35\n" + one,
                       start + camera + "projection = \"orthographic\"\nheight_m = 2\n" + one},
                      "frames.camera.0.", list("camera"));
    // Each kind moves in what it needs first of what can be animated.
    std::vector<std::string> bases;
    for (const VariantSpec& kind : light_table().variants) {
        const auto found = std::find_if(kind.keys.begin(), kind.keys.end(),
                                        [](const KeySpec& k) { return k.required && k.animated; });
        // Lights of surfaces stand where their meshes do.
        if (found == kind.keys.end()) continue;
        const KeySpec& key = *found;
        const auto moved = [&](int frame, std::size_t value) {
            return "[[frames.light]]\nframe = " + std::to_string(frame) + "\nid = \"l\"\n" + key.name +
                   " = " + candidates(key).at(value) + "\n";
        };
        bases.push_back(start + camera + light_of_kind(kind, "l") + light_of_kind(kind, "second") +
                        keyframes + moved(1, 0) + moved(4, 1));
    }
    expect_all_matter(bases, "frames.light.0.", list("light"));
}

TEST_F(SceneKeys, OfOpticsAreRead) {
    const std::string base = start + camera;
    std::vector<std::string> bases, animated;
    for (const VariantSpec& variant : optics_table().variants) {
        const std::string own = base + "[optics]\naperture = \"" + variant.name +
                                "\"\nlight = \"blackbody\"\n" +
                                (variant.name == "file" ? "file = \"one.pgm\"\n" : "");
        expect_all_matter({own}, "optics.", optics_table().keys, {"aperture"});
        expect_all_matter({own}, "optics.", variant.keys);
        animated.push_back(own + "focus_m = 3\n" + keyframes + "[[frames.optics]]\nframe = 1\nclip = 2\n" +
                           "[[frames.optics]]\nframe = 4\nclip = 3\n");
        bases.push_back(own);
    }
    for (std::size_t i = 1; i < bases.size(); ++i)
        EXPECT_FALSE(same(bases[0], bases[i]));
    EXPECT_FALSE(same(base, bases[0]));
    for (const KeySpec& key : frames_table().keys) {
        if (key.name == "optics") expect_all_matter(animated, "frames.optics.0.", key.table->keys);
    }
}

TEST_F(SceneKeys, OfEverythingElseAreRead) {
    const std::string base =
        start + camera + "[[output]]\nfile = \"a_####.png\"\n[[mesh]]\nid = \"m\"\nshape = \"box\"\n";
    const auto sun = [](const char* id, int azimuth) {
        return std::string("[[light]]\nid = \"") + id +
               "\"\ntype = \"directional\"\nelevation_deg = 20\nazimuth_deg = " + std::to_string(azimuth) +
               "\n";
    };
    const std::string under_suns =
        base + sun("first", 90) + sun("second", 200) + "[sky]\nmodel = \"clear\"\n";
    const std::string panorama = base + "[sky]\nmodel = \"image\"\nfile = \"one.pfm\"\n";
    for (const KeySpec& key : scene_schema_root().keys) {
        if (key.name == "material") expect_all_matter({base}, "material.main.", key.table->keys);
        if (key.name == "render" || key.name == "limits")
            expect_all_matter({base}, key.name + ".", key.table->keys);
        if (key.name == "sky") expect_all_matter({base, under_suns, panorama}, "sky.", key.table->keys);
        if (key.name == "output") expect_all_matter({base}, "output.0.", key.table->keys);
    }
}

}  // namespace
}  // namespace obscura
