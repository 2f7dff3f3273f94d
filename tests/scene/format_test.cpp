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

/// Everything that rendering can see of a scene: at its frames, and between keyframes.
std::uint64_t fingerprint(const SceneDocument& document, const FileAccess& access) {
    Scene s = build_scene(document, access);
    Hasher h;
    const auto words = [&](const std::string& text) { h.bytes(text.data(), text.size()).value(text.size()); };
    const auto number = [&](auto v) { h.value(v); };
    h.values(s.mesh.positions)
        .values(s.mesh.normals)
        .values(s.mesh.uvs)
        .values(s.mesh.triangles)
        .values(s.mesh.material);
    for (const Object& o : s.mesh.objects)
        words(o.name + (o.casts_shadow ? "+" : "-"));
    for (const Material& m : s.materials) {
        h.value(m.base_color)
            .value(m.roughness)
            .value(m.metallic)
            .value(m.emission)
            .value(m.texture)
            .value(m.translucency);
        words(m.name);
    }
    for (const Texture& t : s.textures)
        h.values(t.levels.at(0).pixels);
    h.value(s.sky.zenith).value(s.sky.horizon).value(s.sky.ground).value(s.sky.ambient).value(s.sky.visible);
    h.value(s.render.width).value(s.render.height).value(s.render.samples).value(s.render.exposure_ev);
    h.value(s.render.tone).value(s.render.receivers);
    for (const Output& o : s.outputs)
        words(o.file + std::to_string(static_cast<int>(o.aov)));
    h.value(s.optics.enabled).value(s.optics.mask_px).value(s.optics.wavelengths).value(s.optics.tolerance);
    h.value(s.optics.radius_px).value(s.optics.bloom_scale).values(s.optics.mask.pixels);
    h.value(s.optics.from_file).value(s.optics.shape.kind).value(s.optics.light.source);
    h.value(s.limits.memory_mib)
        .value(s.limits.triangles)
        .value(s.limits.texture_px)
        .value(s.limits.texture_mib);
    h.value(s.limits.frames).value(s.limits.image_px);
    const FrameRange range = scene_frames(document);
    number(range.count());
    for (int i = 0; i < range.count(); ++i) {
        set_frame(s, document, range.at(i));
        const Camera& c = s.camera;
        h.value(c.kind)
            .value(c.eye)
            .value(c.look_at)
            .value(c.up)
            .value(c.vfov_deg)
            .value(c.height_m)
            .value(c.near_m);
        const OpticsSettings& o = s.optics;
        h.value(o.clip).value(o.shape.rotation_deg).value(o.shape.bow).value(o.shape.aspect);
        h.value(o.shape.obstruction);
        h.value(o.visibility).value(o.visibility_samples).value(o.neighbourhood_px);
        h.value(o.focus_m).value(o.focus_steps);
        const LensDirt& d = o.dirt;
        h.value(d.seed).value(d.noise).value(d.noise_cell).value(d.noise_stretch).value(d.noise_angle_deg);
        h.value(d.dust).value(d.dust_radius).value(d.dust_softness).value(d.occluder);
        h.value(d.scratches).value(d.scratch_width).value(d.scratch_length).value(d.scratch_spread_deg);
        h.value(d.eyelashes).value(d.eyelash_width).value(d.eyelash_length);
        h.value(d.occluder_diameter).value(d.occluder_x).value(d.occluder_y);
        h.value(o.shape.blades).value(o.shape.vanes).value(o.shape.slits).value(o.shape.lines);
        h.value(o.shape.rings);
        h.value(o.focal_length_mm).value(o.f_number).value(o.sensor_height_mm).value(o.light.kelvin);
        for (const auto& [l, shadow] : s.lights) {
            words(l.id);
            h.value(l.kind).value(l.direction).value(l.position).value(l.color).value(l.inner_cone_deg);
            h.value(l.outer_cone_deg)
                .value(l.near_m)
                .value(l.range_m)
                .value(l.below_horizon)
                .value(shadow.method);
            h.value(shadow.resolution).value(shadow.filter_px).value(shadow.receivers);
            h.value(shadow.normal_offset_texels).value(shadow.scope).value(shadow.filter);
            h.value(shadow.max_magnification).value(shadow.layout).value(shadow.top_levels);
            words(shadow.cache);
        }
    }
    return h.state;
}

class SceneKeys : public SceneKeyProbe {
  protected:
    std::uint64_t fingerprint_of(const SceneDocument& document) const override {
        return fingerprint(document, access_);
    }
};

const std::string start = "format = 1\n[limits]\n[material.main]\ntexture = \"one.png\"\n[material.other]\n";
const std::string camera = "[camera]\neye_m = [1, 2, 5]\nlook_at_m = [0, 0, 0]\n";
const std::string keyframes = "[frames]\nrange = \"1-5\"\n";

TEST_F(SceneKeys, OfCameraAreRead) {
    const std::string fov = start + camera, lens = fov + "focal_length_mm = 35\n",
                      flat = fov + "projection = \"orthographic\"\nheight_m = 2\n";
    expect_all_matter({flat}, "camera.", camera_table().keys, {"projection"});
    EXPECT_NE(fingerprint(read_scene_text(fov, "a"), access_),
              fingerprint(read_scene_text(flat, "a"), access_));
    expect_all_matter({fov, lens}, "camera.", camera_table().variants.at(0).keys);
    expect_all_matter({flat}, "camera.", camera_table().variants.at(1).keys);
}

TEST_F(SceneKeys, OfMeshesAreRead) {
    const auto with = [](const std::string& keys) {
        return start + camera + "[[mesh]]\nid = \"m\"\n" + keys;
    };
    const std::string box = with("shape = \"box\"\n[[mesh.instance]]\n"), file = with("file = \"tent.obj\"");
    expect_all_matter({box}, "mesh.m.", mesh_table().keys, {"shape"});
    EXPECT_NE(fingerprint(read_scene_text(box, "a"), access_),
              fingerprint(read_scene_text(file, "a"), access_));
    for (const KeySpec& key : mesh_table().keys) {
        if (key.name == "instance") expect_all_matter({box}, "mesh.m.instance.0.", key.table->keys);
    }
    expect_all_matter({file}, "mesh.m.", mesh_table().variants.at(0).keys);
    for (const ShapeSpec& shape : shapes()) {
        expect_all_matter({with("shape = \"" + shape.variant.name + "\"")}, "mesh.m.", shape.variant.keys);
    }
}

const std::map<std::string, std::string> lights = {
    {"directional", "azimuth_deg = 20\nelevation_deg = 30\n"},
    {"sun", "latitude_deg = 48\nlongitude_deg = 16\ntime = 2026-06-21T12:00:00Z\n"},
    {"point", "position_m = [0, 3, 0]\nintensity_w_sr = 5\n"},
    {"spot", "position_m = [0, 3, 0]\nintensity_w_sr = 5\nlook_at_m = [0, 0, 0]\n"},
};

TEST_F(SceneKeys, OfLightsAndShadowsAreRead) {
    for (const VariantSpec& variant : light_table().variants) {
        const std::string base = start + camera + "[[light]]\nid = \"l\"\ntype = \"" + variant.name + "\"\n" +
                                 lights.at(variant.name);
        expect_all_matter({base}, "light.l.", light_table().keys, {"type"});
        expect_all_matter({base}, "light.l.", variant.keys);
        expect_all_matter({base}, "light.l.shadow.", shadow_table().keys);
        expect_all_matter({base}, "shadow.l.", shadow_table().keys);
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
    const std::map<std::string, std::string> other = {{"directional", "azimuth_deg = 90\n"},
                                                      {"sun", "time = 2026-06-21T15:00:00Z\n"},
                                                      {"point", "position_m = [1, 3, 0]\n"},
                                                      {"spot", "position_m = [1, 3, 0]\n"}};
    const std::map<std::string, std::string> first = {{"directional", "azimuth_deg = 20\n"},
                                                      {"sun", "time = 2026-06-21T12:00:00Z\n"},
                                                      {"point", "position_m = [0, 3, 0]\n"},
                                                      {"spot", "position_m = [0, 3, 0]\n"}};
    std::vector<std::string> bases;
    for (const auto& [type, keys] : lights) {
        const std::string light = "type = \"" + type + "\"\n" + keys;
        bases.push_back(start + camera + "[[light]]\nid = \"l\"\n" + light + "[[light]]\nid = \"second\"\n" +
                        light + keyframes + "[[frames.light]]\nframe = 1\nid = \"l\"\n" + first.at(type) +
                        "[[frames.light]]\nframe = 4\nid = \"l\"\n" + other.at(type));
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
        EXPECT_NE(fingerprint(read_scene_text(bases[0], "a"), access_),
                  fingerprint(read_scene_text(bases[i], "a"), access_));
    EXPECT_NE(fingerprint(read_scene_text(base, "a"), access_),
              fingerprint(read_scene_text(bases[0], "a"), access_));
    for (const KeySpec& key : frames_table().keys) {
        if (key.name == "optics") expect_all_matter(animated, "frames.optics.0.", key.table->keys);
    }
}

TEST_F(SceneKeys, OfEverythingElseAreRead) {
    const std::string base =
        start + camera + "[[output]]\nfile = \"a_####.png\"\n[[mesh]]\nid = \"m\"\nshape = \"box\"\n";
    for (const KeySpec& key : scene_schema_root().keys) {
        if (key.name == "material") expect_all_matter({base}, "material.main.", key.table->keys);
        if (key.name == "sky" || key.name == "render" || key.name == "limits") {
            expect_all_matter({base}, key.name + ".", key.table->keys);
        }
        if (key.name == "output") expect_all_matter({base}, "output.0.", key.table->keys);
    }
}

}  // namespace
}  // namespace obscura
