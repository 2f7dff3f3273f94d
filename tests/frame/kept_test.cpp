// What frames keep from those before: every key that changes a light, a camera or the picture is noticed,
// unless it is listed as of no account for shadows.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/frame/light_shadow.h"
#include "app/frame/scene_light.h"
#include "app/frame/shadow_cache.h"
#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/shadow_code.h"
#include "core/error.h"
#include "tests/scene/key_probe.h"

namespace obscura {
namespace {

const std::string start = "format = 1\n[camera]\neye_m = [1, 2, 5]\nlook_at_m = [0, 0, 0]\n[material.main]\n";

/// What the frame's shadow of light "l" is made for, and its picture.
struct Made {
    SceneLight light;
    Camera camera;
    RenderSettings render;
    friend bool operator==(const Made&, const Made&) = default;
};

Made made_for(const std::string& scene, const std::vector<std::string>& overrides = {}) {
    const SceneDocument document = read_scene_text(scene, "kept.toml", overrides);
    const auto lights = subtables(document.root, "light");
    return {lights.empty() ? SceneLight{} : light_of(*lights.at(0)), camera_of(camera_at(document, 1)),
            render_settings_of(document)};
}

bool is_kept(const Made& before, const Made& now) {
    LightShadow shadow;
    shadow.camera = before.camera;
    shadow.render = before.render;
    return same_shadow(before.light, now.light) && same_picture(shadow, now.camera, now.render, shadow.seen);
}

/// Changes every key once and sees that the shadow is made again, or kept where the key is `idle`.
void expect_noticed(const std::string& scene, const std::string& prefix, const std::vector<KeySpec>& keys,
                    const std::set<std::string>& idle) {
    const Made before = made_for(scene);
    for (const KeySpec& key : keys) {
        if (key.table != nullptr) continue;
        int changes = 0;
        for (const std::string& value : candidates(key)) {
            try {
                const Made now = made_for(scene, {prefix + key.name + "=" + value});
                if (now == before) continue;
                ++changes;
                EXPECT_EQ(is_kept(before, now), idle.contains(key.name))
                    << prefix << key.name << " = " << value;
            } catch (const InputError&) {
                // Not every candidate fits.
            }
        }
        EXPECT_GT(changes, 0) << prefix << key.name;
    }
}

TEST(Kept, ShadowsNoticeEveryKeyOfTheirLight) {
    for (const VariantSpec& kind : light_table().variants) {
        const std::string scene =
            start + "[[light]]\nid = \"l\"\ntype = \"" + kind.name + "\"\n" + required_keys(kind.keys);
        expect_noticed(scene, "light.l.", kind.keys,
                       {"irradiance_w_m2", "extraterrestrial_w_m2", "intensity_w_sr", "inner_cone_deg",
                        "radiance_w_m2_sr", "from", "to", "steps"});
        // A tree, whatever the key: one of maps alone would turn exact shadows into one.
        std::vector<KeySpec> of_trees = shadow_table().keys;
        std::erase_if(of_trees, [](const KeySpec& key) {
            return key.name == "samples" || key.name == "day_file" || key.name == "max_sun_deg";
        });
        expect_noticed(scene + "shadow = {resolution = \"auto\"}\n", "light.l.shadow.", of_trees,
                       {"max_magnification"});
    }
}

TEST(Kept, ShadowsOfADayNoticeItsKeys) {
    const std::string scene =
        start + "[[light]]\nid = \"l\"\ntype = \"directional\"\nazimuth_deg = 90\nelevation_deg = 20\n" +
        "shadow = {day_file = \"a.far\"}\n";
    const Made before = made_for(scene);
    EXPECT_EQ(before.light.shadow.method, ShadowMethod::day);
    EXPECT_EQ(before.light.shadow.day_file, "a.far");
    EXPECT_FALSE(is_kept(before, made_for(scene, {"light.l.shadow.day_file=\"b.far\""})));
    EXPECT_FALSE(is_kept(before, made_for(scene, {"light.l.shadow.max_sun_deg=0.5"})));
    EXPECT_FALSE(is_kept(before, made_for(scene, {"light.l.azimuth_deg=91"})));
    EXPECT_TRUE(is_kept(before, made_for(scene, {"light.l.irradiance_w_m2=7"})));
}

TEST(Kept, FilesOfTreesNoticeEveryKeyOfTheirLight) {
    const std::string scene = start + "[[light]]\nid = \"l\"\ntype = \"point\"\nposition_m = [0, 3, 0]\n" +
                              "intensity_w_sr = 1\nshadow = {resolution = 1024, scope = \"full\"}\n";
    // What decides about pictures, not about trees; and keys that a tree of a given resolution has not.
    const std::set<std::string> idle = {"normal_offset_texels", "scope", "filter", "cache"},
                                none = {"method", "samples", "max_magnification", "day_file", "max_sun_deg"};
    const auto key_of = [](const SceneLight& light) {
        const TreeFileKey key = shadow_key(TreeFileKey{1, 2}, light,
                                           fitted_shadow_views(light, Bounds{}, light.shadow.resolution));
        return std::pair{key.high, key.low};
    };
    const SceneLight before = made_for(scene).light;
    for (const KeySpec& key : shadow_table().keys) {
        if (none.contains(key.name)) continue;
        int changes = 0;
        for (const std::string& value : candidates(key)) {
            try {
                const SceneLight now = made_for(scene, {"light.l.shadow." + key.name + "=" + value}).light;
                if (now == before || now.shadow.resolution == auto_resolution) continue;
                // "auto" has the file of the code that it takes.
                if (key.name == "code" && chosen_code(now.shadow).code == chosen_code(before.shadow).code)
                    continue;
                ++changes;
                EXPECT_EQ(key_of(now) == key_of(before), idle.contains(key.name))
                    << key.name << " = " << value;
            } catch (const InputError&) {
                // Not every candidate fits.
            }
        }
        EXPECT_GT(changes, 0) << key.name;
    }
}

TEST(Kept, ShadowsForOnePictureNoticeEveryKeyOfIt) {
    const auto own = [](std::size_t kind, const std::set<std::string>& names) {
        std::vector<KeySpec> keys = camera_table().variants.at(kind).keys;
        std::erase_if(keys, [&](const KeySpec& key) { return !names.contains(key.name); });
        return keys;
    };
    expect_noticed(start, "camera.", own(0, {"vfov_deg", "focal_length_mm"}), {});
    const std::string lens =
        "format = 1\n[camera]\neye_m = [1, 2, 5]\nlook_at_m = [0, 0, 0]\nfocal_length_mm = 35\n";
    expect_noticed(lens, "camera.", own(0, {"focal_length_mm", "sensor_height_mm"}), {});
    expect_noticed(start, "render.", render_table().keys, {"exposure_ev", "tone", "receivers"});
    const std::string wide =
        "format = 1\n[camera]\nprojection = \"orthographic\"\nheight_m = 3\neye_m = [1, 2, 5]\n"
        "look_at_m = [0, 0, 0]\n";
    std::vector<KeySpec> keys = camera_table().keys;
    std::erase_if(keys, [](const KeySpec& key) { return key.name == "projection"; });
    expect_noticed(wide, "camera.", keys, {});
    expect_noticed(wide, "camera.", own(1, {"height_m"}), {});
}

}  // namespace
}  // namespace obscura
