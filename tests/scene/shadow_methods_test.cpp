// Which shadows a light gets that names no method, why, and which keys go with which method.

#include <gtest/gtest.h>

#include <string>

#include "app/scene/build.h"
#include "app/scene/rules_shadow.h"
#include "app/scene/scene_file.h"
#include "app/scene/shadow_code.h"
#include "app/scene/shadow_settings.h"
#include "core/error.h"

namespace obscura {
namespace {

struct Planned {
    std::string method, scope, reason;
};

Planned planned(const std::string& shadow, const std::string& frames = "", const std::string& extra = "") {
    const SceneDocument scene = read_scene_text(
        "format = 1\n"
        "camera = {eye_m = [0, 2, 8], look_at_m = [0, 1, 0]}\n"
        "[[light]]\n"
        "id = \"l\"\n"
        "type = \"directional\"\n"
        "azimuth_deg = 120\n"
        "elevation_deg = 30\n" +
            shadow + "\n" + frames + "\n" + extra + "\n",
        "s.toml");
    const SceneTable& light = *subtables(scene.root, "light").at(0);
    const SceneTable& settings = subtable(light, "shadow");
    // A dumped scene names its method and is not planned again.
    const std::string dumped = dump_scene(scene);
    EXPECT_EQ(dump_scene(read_scene_text(dumped, "dump.toml")), dumped);
    return {text(settings, "method"), settings.has("scope") ? text(settings, "scope") : "",
            shadow_method_reason(scene.root, light)};
}

TEST(ShadowMethods, OneFrameIsExact) {
    const Planned p = planned("");
    EXPECT_EQ(p.method, "exact");
    EXPECT_EQ(p.reason, "one frame");
}

TEST(ShadowMethods, AFileOfADayIsAskedForOneFrameAndForMany) {
    for (const char* frames : {"", "[frames]\nrange = \"1-24\"", "[frames]\nrange = \"1-100\""}) {
        const Planned p = planned("shadow = {day_file = \"d.far\"}", frames);
        EXPECT_EQ(p.method, "day");
        EXPECT_EQ(p.reason, "'day_file' has the suns of a day");
    }
    EXPECT_EQ(planned("shadow = {day_file = \"d.far\", method = \"day\"}").reason, "as asked");
}

// Where a picture looks single texels up they may be small; whole trees, soft filters and large pictures pay
// for it.
TEST(ShadowMethods, TreesOfOnePictureHaveSmallTexels) {
    const auto magnification = [](const std::string& keys, const std::string& more = "") {
        const SceneDocument scene = read_scene_text(
            "format = 1\ncamera = {eye_m = [0, 2, 8], look_at_m = [0, 1, 0]}\n[[light]]\nid = \"l\"\n"
            "type = \"directional\"\nazimuth_deg = 120\nelevation_deg = 30\n"
            "shadow = {method = \"compressed\"" +
                keys + "}\n" + more,
            "s.toml");
        const SceneTable& settings = subtable(*subtables(scene.root, "light").at(0), "shadow");
        return settings.has("max_magnification") ? number(settings, "max_magnification") : 0;
    };
    EXPECT_EQ(magnification(""), frame_magnification);
    EXPECT_EQ(magnification(", filter_px = 1"), frame_magnification);
    EXPECT_EQ(magnification(", filter_px = 5"), 1);
    EXPECT_EQ(magnification(", filter = \"hierarchical\""), 1);
    EXPECT_EQ(magnification(", scope = \"full\""), 1);
    EXPECT_EQ(magnification(", cache = \"maps\""), 1);
    EXPECT_EQ(magnification(", max_magnification = 2"), 2);
    EXPECT_EQ(magnification(", resolution = 512"), 0);
    EXPECT_EQ(magnification("", "[render]\nsize_px = [1920, 1080]\nsamples = 4"), frame_magnification);
    EXPECT_EQ(magnification("", "[render]\nsize_px = [1920, 1080]\nsamples = 16"), 1);
    EXPECT_EQ(magnification("", "[stereo]\n[render]\nsize_px = [1920, 1080]\nsamples = 4"), 1);
}

TEST(ShadowMethods, KeysOfMapsAskForOne) {
    for (const char* key :
         {"resolution = 1024", "filter_px = 5", "normal_offset_texels = 1.5", "filter = \"hierarchical\"",
          "scope = \"full\"", "max_magnification = 2", "layout = \"words16\"", "top_levels = 3",
          "receivers = \"any\"", "resolution = \"auto\"", "cache = \"maps\""}) {
        const std::string setting = key;
        const Planned p = planned("shadow = {" + setting + "}");
        EXPECT_EQ(p.method, "compressed") << setting;
        EXPECT_NE(p.reason.find("'" + setting.substr(0, setting.find(' ')) + "'"), std::string::npos)
            << setting << ": " << p.reason;
    }
}

TEST(ShadowMethods, ATreePaysWhereALightStandsStillForLong) {
    EXPECT_EQ(planned("", "[frames]\nrange = \"1-49\"").method, "exact");
    const Planned still = planned("", "[frames]\nrange = \"1-50\"");
    EXPECT_EQ(still.method, "compressed");
    EXPECT_EQ(still.scope, "full");
    const Planned moving = planned("",
                                   "[frames]\nrange = \"1-50\"\n[[frames.light]]\nid = \"l\"\nframe = 1\n"
                                   "elevation_deg = 10");
    EXPECT_EQ(moving.method, "exact");
    EXPECT_EQ(moving.reason, "the light has keyframes");
    // A tree that moves with its light is built for what each frame looks up.
    const Planned tree = planned("shadow = {receivers = \"any\"}",
                                 "[frames]\nrange = \"1-50\"\n[[frames.light]]\nid = \"l\"\nframe = 1\n"
                                 "elevation_deg = 10");
    EXPECT_EQ(tree.method, "compressed");
    EXPECT_EQ(tree.scope, "frame");
    const Planned camera =
        planned("", "[frames]\nrange = \"1-100x2\"\n[[frames.camera]]\nframe = 1\neye_m = [0, 2, 9]");
    EXPECT_EQ(camera.method, "compressed");
}

TEST(ShadowMethods, ACacheForAllLightsKeepsTrees) {
    const Planned p = planned("", "[shadow]\ncache = \"maps\"");
    EXPECT_EQ(p.method, "compressed");
    EXPECT_EQ(p.scope, "full");
}

// The smallest code that is as fast and is waited for once; no reason to build more than a frame asks for.
TEST(ShadowMethods, CodeAutoIsMergedWhereTheWholeMapIsKept) {
    const auto chosen = [](const std::string& keys, const std::string& extra = "") {
        EXPECT_EQ(planned("shadow = {" + keys + "}", "", extra).method, "compressed") << keys;
        const SceneDocument scene = read_scene_text(
            "format = 1\ncamera = {eye_m = [0, 2, 8], look_at_m = [0, 1, 0]}\n[[light]]\nid = \"l\"\n"
            "type = \"directional\"\nazimuth_deg = 120\nelevation_deg = 30\nshadow = {" +
                keys + "}\n" + extra + "\n",
            "s.toml");
        return chosen_code(light_of(*subtables(scene.root, "light").at(0)).shadow);
    };
    const std::string automatic = "code = \"auto\"", one_tap = automatic + ", filter_px = 1",
                      for_all = "[shadow]\ncache = \"maps\"";
    EXPECT_EQ(chosen(automatic).code, ShadowCode::mh);
    EXPECT_EQ(chosen(automatic + ", scope = \"full\"").code, ShadowCode::mh);
    EXPECT_EQ(chosen(one_tap + ", cache = \"maps\"").code, ShadowCode::mmh);
    EXPECT_EQ(chosen(one_tap, for_all).code, ShadowCode::mmh);
    EXPECT_EQ(chosen(one_tap + ", scope = \"frame\"", for_all).code, ShadowCode::mh);
    EXPECT_EQ(chosen(one_tap + ", cache = \"maps\", top_levels = 5").code, ShadowCode::mh);
    EXPECT_EQ(chosen(one_tap + ", cache = \"maps\", top_levels = 7").code, ShadowCode::mmh);
    EXPECT_EQ(chosen(automatic + ", cache = \"maps\"").code, ShadowCode::mh) << "the default kernel";
    EXPECT_EQ(chosen(automatic + ", cache = \"maps\", filter_px = 5").code, ShadowCode::mh);
    for (const char* keys : {"", ", cache = \"maps\"", ", cache = \"maps\", top_levels = 2"})
        EXPECT_NE(chosen(one_tap + keys).reason, nullptr) << keys;

    // What is asked for is taken, and nothing is to be told.
    for (const ShadowCodeName& row : shadow_code_names) {
        const CodeChoice asked = chosen(std::string("cache = \"maps\", code = \"") + row.name + "\"");
        EXPECT_EQ(asked.code, row.code);
        EXPECT_EQ(asked.reason, nullptr);
    }
    EXPECT_THROW(chosen(automatic + ", layout = \"words16\""), InputError) << "of mh alone";
    const CodeChoice plain = chosen("cache = \"maps\"");
    EXPECT_EQ(plain.code, ShadowCode::mh);
    EXPECT_EQ(plain.reason, nullptr);
}

TEST(ShadowMethods, WhatIsAskedForStays) {
    for (const char* method : {"none", "exact", "map", "compressed"}) {
        const Planned p =
            planned("shadow = {method = \"" + std::string(method) + "\"}", "[frames]\nrange = \"1-500\"");
        EXPECT_EQ(p.method, method);
        EXPECT_EQ(p.reason, "as asked");
    }
}

TEST(ShadowMethods, WhatHasASizeHasPenumbraeInLongSequences) {
    const std::string frames = "[frames]\nrange = \"1-200\"";
    const Planned sized = planned("angular_diameter_deg = 0.5", frames);
    EXPECT_EQ(sized.method, "exact");
    EXPECT_EQ(sized.reason, "the light has a size, which maps of its middle do not show");
    // Its middle alone needs no more than a tree.
    EXPECT_EQ(
        planned("angular_diameter_deg = 0.5\nshadow = {samples = 1, method = \"exact\"}", frames).method,
        "exact");
    EXPECT_EQ(planned("angular_diameter_deg = 0", frames).method, "compressed");
    EXPECT_EQ(planned("angular_diameter_deg = 0.5\nshadow = {resolution = 1024}", frames).method,
              "compressed");
}

TEST(ShadowMethods, KeysThatAMethodDoesNotReadAreRefused) {
    const auto message = [](const std::string& settings) -> std::string {
        try {
            planned("shadow = {" + settings + "}");
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(message("method = \"exact\", resolution = 1024")
                  .find("'resolution' needs method = \"map\", \"compressed\" or \"stack\""),
              std::string::npos);
    for (const std::string setting : {"cache = \"c\"", "max_magnification = 1"})
        EXPECT_NE(
            message("method = \"exact\", " + setting).find("needs method = \"compressed\" or \"stack\""),
            std::string::npos)
            << setting;
    EXPECT_NE(message("method = \"exact\", filter_px = 3").find("'filter_px' needs"), std::string::npos);
    EXPECT_NE(message("method = \"exact\", scope = \"full\"").find("'scope' needs method = \"compressed\""),
              std::string::npos);
    EXPECT_EQ(message("method = \"exact\", receivers = \"any\""), "");
    EXPECT_NE(
        message("method = \"map\", samples = 16").find("'samples' needs method = \"exact\" or \"stack\""),
        std::string::npos);
    EXPECT_EQ(message("method = \"exact\", samples = 16"), "");
}

}  // namespace
}  // namespace obscura
