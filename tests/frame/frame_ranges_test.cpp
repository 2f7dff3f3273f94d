// Cameras, lights, shadows, skies, materials, lenses, places of meshes, keyframes and [render] over the whole
// ranges of their keys: what the rows allow is refused with a reason or makes finite pictures.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>

#include "app/frame/frame_checks.h"
#include "app/frame/load_scene.h"
#include "app/frame/render_frame.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "core/error.h"
#include "tests/scene/key_draw.h"

namespace obscura {
namespace {

/// The scene at work, for whom a broken precondition ends the program.
std::string scene_at_work;

extern "C" void tell_scene(int) {
    static_cast<void>(!::write(2, scene_at_work.data(), scene_at_work.size()));
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string lines(Draw& draw, const std::vector<KeySpec>& keys, double share,
                  const std::vector<std::string>& without) {
    std::string text;
    for (const KeySpec& key : keys)
        if (!is_among(without, key.name)) text += draw.line(key, share);
    return text;
}

/// Keys of a table and, if it has kinds, of one of them; `share` of those that need not be given.
std::string drawn(Draw& draw, const TableSpec& spec, double share, const std::string& header,
                  std::vector<std::string> without) {
    std::string text = header;
    if (!spec.variants.empty()) {
        const VariantSpec& variant = spec.variants[draw.below(spec.variants.size())];
        text += spec.discriminator + " = \"" + variant.name + "\"\n";
        text += lines(draw, variant.keys, share, without);
    }
    without.push_back(spec.discriminator);
    return text + lines(draw, spec.keys, share, without);
}

/// Where a mesh stands and what its triangles do; keys of its shape are drawn by tests/scene.
std::string drawn_place(Draw& draw, double share) {
    std::string text = lines(draw, mesh_table().keys, share, {"id", "shape", "material"});
    for (const KeySpec& key : mesh_table().keys) {
        if (key.type == KeyType::table_list && draw.chance() < share)
            text += "[[mesh.instance]]\n" + lines(draw, key.table->keys, share, {}) + "[[mesh.instance]]\n";
    }
    return text;
}

/// [frames], with keyframes of the camera and of the light, whose keys are those of `kind`.
std::string drawn_frames(Draw& draw, double share, const VariantSpec& kind) {
    std::string text = "[frames]\nrange = \"1-3\"\n";
    if (draw.chance() < 0.5) text += "interpolation = \"smooth\"\n";
    const auto animated = [](const std::vector<KeySpec>& all) {
        std::vector<KeySpec> keys;
        for (KeySpec key : all) {
            key.required = false;
            if (key.animated) keys.push_back(key);
        }
        return keys;
    };
    for (std::size_t i = 0, count = draw.below(3); i < count; ++i)
        text += fmt::format("[[frames.camera]]\nframe = {}\n", 1 + i) +
                lines(draw, animated(camera_table().keys), share, {}) +
                lines(draw, animated(camera_table().variants[0].keys), share, {"focal_length_mm"});
    for (std::size_t i = 0; i < 3; ++i)
        text +=
            fmt::format("[[frames.light]]\nid = \"sun\"\nframe = {}\n", 1 + 0.75 * static_cast<double>(i)) +
            lines(draw, animated(kind.keys), 2 * share, {});
    return text;
}

struct Subject {
    const char* name;
    double share;          ///< of its keys
    int few;               ///< scenes that are made
    int more;              ///< times as many of all cases, and OBSCURA_SLOW_TESTS times that
    int memory_mib = 700;  ///< limit of the scenes behind the first `few` draws, which have 700
};

const std::string sane_camera = "[camera]\neye_m = [4, 3, 6]\nlook_at_m = [0, 0.5, 0]\n";
const std::string sane_sun =
    "[[light]]\nid = \"sun\"\ntype = \"directional\"\nazimuth_deg = 135\nelevation_deg = 40\n";

std::string drawn_scene(Draw& draw, const std::string& subject, double share, int memory_mib) {
    const std::string shadow = drawn(draw, shadow_table(), share, "[shadow.sun]\n", {"cache"});
    const auto if_it = [&](const char* name, const TableSpec& table, const std::string& header,
                           const std::vector<std::string>& without, const std::string& otherwise) {
        return subject == name ? drawn(draw, table, share, header, without) : otherwise;
    };
    std::string text = "format = 1\n" + if_it("camera", camera_table(), "[camera]\n", {}, sane_camera);
    text += if_it("render", render_table(), "[render]\n", {"size_px"}, "[render]\nsamples = 1\n");
    text += "size_px = [32, 18]\n[limits]\nmemory_mib = " + std::to_string(memory_mib) + "\n";
    if (subject == "frames") {
        const VariantSpec& kind = light_table().variants[draw.below(light_table().variants.size())];
        text += "[[light]]\nid = \"sun\"\ntype = \"" + kind.name + "\"\n" +
                lines(draw, kind.keys, share, {}) + drawn_frames(draw, share, kind);
    } else if (subject == "light" || (subject == "shadow" && draw.chance() < 0.6)) {
        text += drawn(draw, light_table(), subject == "light" ? share : 0.1, "[[light]]\nid = \"sun\"\n",
                      {"id", "shadow"});
    } else {
        text += sane_sun;
    }
    if (subject == "shadow") text += shadow;
    text += if_it("sky", sky_table(), "[sky]\n", {"sun", "file"}, "");
    // What a pattern costs is not taken to its ends.
    text += if_it("optics", optics_table(), "[optics]\n",
                  {"mask_px", "wavelengths", "tolerance", "radius_px"}, "");
    if (subject == "optics") text += "mask_px = 64\nwavelengths = 2\nradius_px = 12\n";
    text += if_it("material", material_table(), "[material.clay]\n", {"texture"},
                  "[material.clay]\nemission_w_m2_sr = 3\n");
    return text +
           "[[mesh]]\nid = \"ground\"\nshape = \"plane\"\nwidth_m = 20\ndepth_m = 20\n"
           "[[mesh]]\nid = \"ball\"\nshape = \"sphere\"\nsegments = 12\nrings = 8\ntranslate_m = [0, 0.5, "
           "0]\n"
           "material = \"clay\"\n[[mesh]]\nid = \"box\"\nshape = \"box\"\n" +
           (subject == "mesh" ? drawn_place(draw, share) : "translate_m = [1.2, 0.5, -1]\n");
}

template <class Picture>
std::int64_t not_finite(const Picture& image) {
    return std::count_if(image.pixels.begin(), image.pixels.end(), [](Vec3f v) {
        return !(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
    });
}

void expect_finite_frames(const SceneDocument& document) {
    Scene scene = load_scene(document, FileAccess{});
    FrameOptions options;
    options.sun_hours = std::any_of(scene.lights.begin(), scene.lights.end(),
                                    [](const SceneLight& l) { return l.light.path.has_value(); });
    FrameChecks checks(document, options);
    std::vector<int> numbers;
    for (int i = scene_frames(document).first; i <= scene_frames(document).last; ++i)
        numbers.push_back(i);
    for (const int number : checks.worth_checking(numbers)) {
        set_frame(scene, document, number);
        checks.check(scene, number);
    }
    for (const int number : numbers) {
        set_frame(scene, document, number);
        const Frame frame = render_frame(scene, options, Exec{});
        EXPECT_EQ(not_finite(frame.radiance), 0) << "frame " << number;
        EXPECT_TRUE(std::all_of(frame.sun_hours.pixels.begin(), frame.sun_hours.pixels.end(),
                                [](float h) { return std::isnan(h) || (h >= 0 && h <= 24.001f); }));
    }
}

class FrameRanges : public testing::TestWithParam<Subject> {};

TEST_P(FrameRanges, WhatTheRowsAllowIsMadeOrRefused) {
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    const int wanted =
        GetParam().few * (slow != nullptr ? GetParam().more * std::max(std::atoi(slow), 1) : 1);
    const auto before = std::signal(SIGABRT, tell_scene);
    int made = 0, refused = 0, too_large = 0;
    for (int i = 0; i < 100 * wanted && made < wanted && !HasFailure(); ++i) {
        Draw draw(static_cast<std::uint64_t>(i));
        const int memory_mib = i < GetParam().few ? 700 : GetParam().memory_mib;
        const std::string text = drawn_scene(draw, GetParam().name, GetParam().share, memory_mib);
        scene_at_work = "draw " + std::to_string(i) + ":\n" + text;
        SCOPED_TRACE(scene_at_work);
        try {
            expect_finite_frames(read_scene_text(text, "s.toml"));
            ++made;
        } catch (const InputError& error) {
            EXPECT_FALSE(error.message.empty());
            ++refused;
        } catch (const LimitError&) {
            ++too_large;
        }
    }
    std::signal(SIGABRT, before);
    fmt::print("{}: {} made, {} refused, {} beyond limits\n", GetParam().name, made, refused, too_large);
    EXPECT_EQ(made, wanted);
}

// A lens's pattern takes seconds where limits let it, however small the picture is.
INSTANTIATE_TEST_SUITE_P(Tables, FrameRanges,
                         testing::Values(Subject{"camera", 0.3, 20, 25}, Subject{"render", 0.5, 15, 25},
                                         Subject{"light", 0.3, 40, 25}, Subject{"shadow", 0.15, 60, 25},
                                         Subject{"sky", 0.3, 10, 25}, Subject{"optics", 0.1, 4, 25, 150},
                                         Subject{"mesh", 0.4, 30, 25}, Subject{"frames", 0.2, 20, 25},
                                         Subject{"material", 0.5, 15, 25}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace obscura
