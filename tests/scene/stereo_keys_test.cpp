// [stereo] and [[stereo.edit]]: what is refused and how, that every key is read, what settings they come to.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/stereo_settings.h"
#include "core/hash.h"
#include "tests/scene/key_probe.h"

namespace obscura {
namespace {

const std::string start =
    "format = 1\n[camera]\neye_m = [0, 1, 5]\nlook_at_m = [0, 1, 0]\nvfov_deg = 30\n"
    "[[mesh]]\nid = \"m\"\nshape = \"box\"\nmaterial = \"main\"\n"
    "[[mesh]]\nid = \"other\"\nshape = \"sphere\"\nmaterial = \"other\"\ntranslate_m = [1, 1, -3]\n"
    "[[mesh]]\nid = \"row\"\nshape = \"box\"\n[[mesh.instance]]\n[[mesh.instance]]\ntranslate_m = [2, 0, 0]\n"
    "[material.main]\n[material.other]\n[render]\nsize_px = [64, 36]\n";

// --- refusals

/// What reading `start + text` throws as InputError; "" when it throws none.
std::string input_error(const std::string& text) {
    try {
        read_scene_text(start + text, "s.toml");
    } catch (const InputError& error) {
        return error.message;
    }
    return "";
}

std::string edit(const std::string& keys) {
    return "[stereo]\n[[stereo.edit]]\nid = \"e\"\n" + keys;
}

struct BadStereo {
    const char* name;
    std::string text;
    std::string message;
};

const std::vector<BadStereo>& bad_scenes() {
    static const std::string match = "type = \"match\"\nsource_px = [1, 1]\n";
    static const std::string frames = "[frames]\nrange = \"1-4\"\n";
    static const std::vector<BadStereo> all = {
        {"UnknownKey", "[stereo]\ninteraxal_m = 1",
         "unknown key 'interaxal_m' in [stereo]; did you mean 'interaxial_m'?"},
        {"NoInteraxial", "[stereo]\ninteraxial_m = 0", "'interaxial_m' must be in (0, 1000000], not 0"},
        {"MapScale", "[stereo]\nmap_scale = 3", "'map_scale' must be one of 1, 2, 4, 8, not 3"},
        {"MarginWord", "[stereo]\nmargin_px = \"wide\"",
         "'margin_px' must be an integer or \"auto\", not the string \"wide\""},
        {"Solver", "[stereo]\nsolver = \"multgrid\"",
         "'solver' must be one of \"multigrid\", \"fmg\", \"vcycle\", \"cascade\", not \"multgrid\"; did you "
         "mean 'multigrid'?"},
        {"TwoNearLimits", "[stereo]\ncomfort_near_percent = 1\ncomfort_near_deg = 1",
         "give either 'comfort_near_percent' or 'comfort_near_deg', not both"},
        {"TwoFarLimits", "[stereo]\ncomfort_far_deg = -1\ncomfort_far_percent = -1",
         "give either 'comfort_far_percent' or 'comfort_far_deg', not both"},
        {"FarBeforeTheScreen", "[stereo]\ncomfort_far_percent = 2",
         "'comfort_far_percent' must be in [-100, 0], not 2"},
        {"RemapTurnedRound", "[stereo]\nremap_near_percent = -2",
         "'remap_near_percent' must not be less than 'remap_far_percent'"},
        {"NoType", edit(""),
         "[[stereo.edit]] needs 'type': one of \"roundness\", \"anchor\", \"interface\", \"match\""},
        {"NoRoundness", edit("type = \"roundness\"\nobjects = [\"m\"]"), "[[stereo.edit]] needs 'roundness'"},
        {"RoundnessOfAnchor", edit("type = \"anchor\"\nobjects = [\"m\"]\nroundness = 2"),
         "'roundness' does not apply to [[stereo.edit]] with type = \"anchor\""},
        {"NoTarget", edit("type = \"anchor\""), "edit 'e' needs 'objects' or 'materials'"},
        {"EmptyTarget", edit("type = \"anchor\"\nobjects = []"), "'objects' must name something"},
        {"TargetNumber", edit("type = \"anchor\"\nobjects = 3"),
         "'objects' must be a list of names, not an integer"},
        {"TargetNumbers", edit("type = \"anchor\"\nobjects = [\"m\", 3]"),
         "'objects' holds names, not an integer"},
        {"EmptyName", edit("type = \"anchor\"\nobjects = [\"\"]"),
         "a name in 'objects' must be 1 to 256 characters"},
        {"UnknownObject", edit("type = \"anchor\"\nobjects = [\"othre\"]"),
         "there is no mesh 'othre'; did you mean 'other'?"},
        {"UnknownMaterial", edit("type = \"anchor\"\nmaterials = [\"mian\"]"),
         "there is no material 'mian'; did you mean 'main'?"},
        {"UnknownSlotOwner", edit("type = \"anchor\"\nmaterials = [\"n/bark\"]"), "there is no mesh 'n'"},
        {"PartOfShape", edit("type = \"anchor\"\nobjects = [\"m/lid\"]"),
         "mesh 'm' is one object; name parts of it by 'materials'"},
        {"NoInstances", edit("type = \"anchor\"\nobjects = [\"m#0\"]"),
         "mesh 'm' has no instances to be numbered"},
        {"UnknownInstance", edit("type = \"anchor\"\nobjects = [\"row#2\"]"),
         "there is no object 'row#2'; mesh 'row' has instances #0 to #1"},
        {"TwoOffsets", edit("type = \"anchor\"\nobjects = [\"m\"]\noffset_px = 1\noffset_percent = 1"),
         "give either 'offset_px' or 'offset_percent', not both"},
        {"NoInterface", edit("type = \"interface\""), "edit 'e' needs 'objects' or 'materials', or a 'mask'"},
        {"OverShare", edit("type = \"roundness\"\nroundness = 2\nobjects = [\"m\"]\nweight = 2"),
         "'weight' of type = \"roundness\" is the share that is applied: at most 1, not 2"},
        {"NegativeWeight", edit("type = \"anchor\"\nobjects = [\"m\"]\nweight = -1"),
         "'weight' must be in [0, 1000000], not -1"},
        {"NoDestination", edit(match), "edit 'e' needs 'destination_px' or 'destination_m'"},
        {"TwoSources", edit(match + "source_m = [0, 0, 0]\ndestination_px = [2, 2]"),
         "give either 'source_px' or 'source_m', not both"},
        {"SourceOutside", edit("type = \"match\"\ndestination_px = [1, 1]\nsource_px = [64, 1]"),
         "'source_px' lies outside of the picture of 64 x 36 pixels; 'source_m' fits pictures of any size"},
        {"PointOfThree", edit(match + "destination_px = [1, 2, 3]"),
         "'destination_px' must be two numbers, not a list of 3"},
        {"FadeAlone", edit("type = \"anchor\"\nobjects = [\"m\"]\nfade_angle_deg = [10, 20]"),
         "'fade_angle_deg' needs 'fade_direction'"},
        {"FadePositionAlone", edit("type = \"anchor\"\nobjects = [\"m\"]\nfade_position_m = [1, 2, 3]"),
         "'fade_position_m' needs 'fade_distance_m'"},
        {"FadeAtOnce",
         edit("type = \"anchor\"\nobjects = [\"m\"]\nfade_distance_m = [3, 3]\nfade_position_m = [1, 2, 3]"),
         "the two numbers of 'fade_distance_m' must differ"},
        {"FadeNowhere",
         edit("type = \"anchor\"\nobjects = [\"m\"]\nfade_angle_deg = [3, 4]\nfade_direction = [0, 0, 0]"),
         "'fade_direction' has no direction"},
        {"SameIds",
         edit("type = \"anchor\"\nobjects = [\"m\"]\n[[stereo.edit]]\nid = \"e\"\ntype = \"anchor\"\nobjects "
              "= [\"m\"]"),
         "two edits have the id 'e'"},
        {"NothingToAnimate", frames + "[[frames.stereo]]\nframe = 1\ninteraxial_m = 1",
         "there is no [stereo] to be animated"},
        {"NoEditToAnimate", frames + "[[frames.stereo_edit]]\nframe = 1\nid = \"e\"\nweight = 1",
         "there is no [stereo] to be animated"},
        {"UnknownEdit",
         edit("type = \"anchor\"\nobjects = [\"m\"]\n") + frames +
             "[[frames.stereo_edit]]\nframe = 1\nid = \"f\"\nweight = 1",
         "there is no edit 'f'"},
        {"KeyOfOtherType",
         edit("type = \"anchor\"\nobjects = [\"m\"]\n") + frames +
             "[[frames.stereo_edit]]\nframe = 1\nid = \"e\"\nroundness = 1",
         "edit 'e' has no 'roundness'"},
        {"FramesFall",
         "[stereo]\n" + frames +
             "[[frames.stereo]]\nframe = 2\ninteraxial_m = 1\n[[frames.stereo]]\nframe = 1\ninteraxial_m = 1",
         "keyframes of [stereo] must rise: 1 follows 2"},
        {"TwoLimitsLater",
         "[stereo]\ncomfort_near_percent = 1\n" + frames +
             "[[frames.stereo]]\nframe = 3\ncomfort_near_deg = 1",
         "give either 'comfort_near_percent' or 'comfort_near_deg', not both"},
        {"MovesOutside",
         edit(match + "destination_px = [2, 2]\n") + frames +
             "[[frames.stereo_edit]]\nframe = 1\nid = \"e\"\nsource_px = [2, "
             "2]\n[[frames.stereo_edit]]\nframe = 3\nid = \"e\"\nsource_px = [-2, 2]",
         "'source_px' lies outside of the picture of 64 x 36 pixels; 'source_m' fits pictures of any size"},
    };
    return all;
}

class StereoErrors : public testing::TestWithParam<BadStereo> {};

TEST_P(StereoErrors, IsRefusedInWords) {
    EXPECT_EQ(input_error(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(All, StereoErrors, testing::ValuesIn(bad_scenes()),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(StereoScene, NeedsAPerspectiveCamera) {
    try {
        read_scene_text(
            "format = 1\n[camera]\neye_m = [0, 1, 5]\nlook_at_m = [0, 1, 0]\nprojection = \"orthographic\"\n"
            "height_m = 3\n[stereo]\n",
            "s.toml");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "s.toml:7:2: [stereo] needs a camera with projection = \"perspective\": parallel views "
                     "have no disparity");
    }
}

// --- every key is read

void add(Hasher& h, const EditTarget& target) {
    h.values(target.objects).values(target.materials).value(target.objects.size());
}

struct AddWish {
    Hasher& h;
    void operator()(const RoundnessEdit& e) const {
        add(h, e.target), h.value(e.roundness).value(e.together);
    }
    void operator()(const AnchorEdit& e) const { add(h, e.target), h.value(e.offset_px); }
    void operator()(const InterfaceEdit& e) const {
        add(h, e.first), add(h, e.second), h.values(e.mask.pixels).value(e.keep);
    }
    void operator()(const MatchEdit& e) const {
        h.value(e.source_px)
            .value(e.destination_px)
            .value(e.offset_px)
            .value(e.radius_px)
            .value(e.any_object)
            .value(e.hold_source);
    }
};

void add(Hasher& h, const StereoSettings& s) {
    h.value(s.rig.interaxial_m).value(s.rig.zero_parallax_m).value(s.rig.screen_width_m);
    h.value(s.rig.viewing_distance_m).value(s.rig.eye_separation_m).value(s.margin_px).value(s.map_scale);
    h.value(s.edit.gradient_weight).value(s.edit.anchor_weight).value(s.edit.match_weight);
    h.value(s.edit.epsilon).value(s.edit.comfort.nearest_px).value(s.edit.comfort.farthest_px);
    h.value(s.edit.comfort_weight).value(s.edit.window_weight).value(s.edit.reset_inversions);
    h.value(s.edit.interfaces).value(s.edit.window_inherited).value(s.edit.limit_folds).value(s.shading);
    h.value(s.solver.method).value(s.solver.tolerance_max_px).value(s.solver.max_iterations);
    h.value(s.solver.sweeps).value(s.solver.half_storage).value(s.warm_start).value(s.reproject.tolerance_px);
    h.value(s.compare_remap.kind)
        .value(s.compare_remap.nearest_px)
        .value(s.compare_remap.farthest_px)
        .value(s.compare_remap.curvature);
    h.value(s.compare_remap.strength)
        .value(s.compare_remap.first_px)
        .value(s.compare_remap.second_px)
        .value(s.compare_remap.matched_px);
    for (const StereoEdit& e : s.edits) {
        h.bytes(e.name.data(), e.name.size()).value(e.weight).value(e.what.index());
        std::visit(AddWish{h}, e.what);
    }
}

class StereoKeys : public SceneKeyProbe<std::uint64_t> {
  protected:
    std::uint64_t look_of(const SceneDocument& document) const override {
        Scene scene = build_scene(document, access_);
        Hasher h;
        const FrameRange range = scene_frames(document);
        for (int i = 0; i < range.count(); ++i) {
            set_frame(scene, document, range.at(i));
            add(h, stereo_settings(document, scene, range.at(i), access_));
        }
        return h.state;
    }
};

const std::vector<std::pair<std::string, std::string>> edit_keys = {
    {"roundness", "roundness = 2.5\nobjects = [\"row\"]\n"},
    {"anchor", "objects = [\"row\"]\n"},
    {"interface", "objects = [\"row\"]\nsecond_objects = [\"row#1\"]\n"},
    {"match", "source_px = [1, 2]\ndestination_px = [3, 4]\n"},
};

TEST_F(StereoKeys, OfStereoAreRead) {
    const std::string wide = start + "[stereo]\n";
    expect_all_matter({wide, wide + "comfort_near_deg = 1\ncomfort_far_deg = -1\n"}, "stereo.",
                      stereo_table().keys);
    EXPECT_EQ(look_of(read_scene_text(start, "a")), look_of(read_scene_text(wide, "a")))
        << "a scene without [stereo] has its defaults";
}

TEST_F(StereoKeys, OfEditsAreRead) {
    for (const VariantSpec& variant : stereo_edit_table().variants) {
        const auto keys = std::find_if(edit_keys.begin(), edit_keys.end(),
                                       [&](const auto& k) { return k.first == variant.name; });
        ASSERT_NE(keys, edit_keys.end()) << variant.name;
        const std::string base =
            start + edit("weight = 0.5\ntype = \"" + variant.name + "\"\n" + keys->second);
        const std::string faded = base +
                                  "fade_angle_deg = [1, 100]\nfade_direction = [1, 0, -1]\n"
                                  "fade_distance_m = [2, 10]\nfade_position_m = [0, 0, 0]\n";
        expect_all_matter({base, faded}, "stereo.edit.e.", stereo_edit_table().keys, {"type"});
        std::vector<std::string> bases{base};
        if (variant.name == "interface")
            bases.push_back(start + edit("type = \"interface\"\nmask = \"one.pgm\"\n"));
        if (variant.name == "match") {
            bases.push_back(start +
                            edit("type = \"match\"\nsource_m = [0, 1, 0]\ndestination_m = [0.1, 1, 0]"));
        }
        expect_all_matter(bases, "stereo.edit.e.", variant.keys);
    }
    const auto masked = [&](const char* file) {
        return look_of(read_scene_text(
            start + edit(std::string("type = \"interface\"\nmask = \"") + file + "\"\n"), "a"));
    };
    EXPECT_NE(masked("one.pgm"), masked("other.pgm"));
}

TEST_F(StereoKeys, OfFramesAreRead) {
    const auto list = [](const char* name) -> const std::vector<KeySpec>& {
        for (const KeySpec& key : frames_table().keys) {
            if (key.name == name) return key.table->keys;
        }
        throw UsageError(name);
    };
    const std::string frames = "[frames]\nrange = \"1-5\"\n";
    expect_all_matter({start + "[stereo]\n" + frames +
                       "[[frames.stereo]]\nframe = 1\ninteraxial_m = 0.01\nzero_parallax_m = 2\n"
                       "[[frames.stereo]]\nframe = 4\ninteraxial_m = 0.2\n"},
                      "frames.stereo.0.", list("stereo"));
    std::vector<std::string> bases;
    for (const auto& [type, keys] : edit_keys) {
        const std::string own = "type = \"" + type + "\"\n" + keys;
        bases.push_back(start + edit(own) + "[[stereo.edit]]\nid = \"second\"\n" + own + frames +
                        "[[frames.stereo_edit]]\nframe = 1\nid = \"e\"\nweight = 0.1\n"
                        "[[frames.stereo_edit]]\nframe = 4\nid = \"e\"\nweight = 0.9\n");
    }
    bases.push_back(start + edit("type = \"match\"\nsource_m = [0, 1, 0]\ndestination_m = [0.1, 1, 0]\n") +
                    frames + "[[frames.stereo_edit]]\nframe = 1\nid = \"e\"\nweight = 0.1\n");
    expect_all_matter(bases, "frames.stereo_edit.0.", list("stereo_edit"));
}

// --- what they come to

class StereoSettingsOf : public StereoKeys {
  protected:
    StereoSettings settings(const std::string& text, int width = 0, double frame = 1) const {
        const SceneDocument document = read_scene_text(start + text, "s.toml");
        Scene scene = build_scene(document, access_);
        set_frame(scene, document, frame);
        if (width > 0) scene.render.height = scene.render.height * width / scene.render.width;
        if (width > 0) scene.render.width = width;
        return stereo_settings(document, scene, frame, access_);
    }
    void TestBody() override {}
};

TEST_F(StereoSettingsOf, TheScreenStandsWhereTheCameraLooks) {
    EXPECT_EQ(settings("").rig.zero_parallax_m, 5);
    EXPECT_EQ(settings("[stereo]\nzero_parallax_m = 3").rig.zero_parallax_m, 3);
}

TEST_F(StereoSettingsOf, ComfortIsCountedInPixelsOfThePicture) {
    const EditParams p = settings("[stereo]\ncomfort_near_percent = 2\ncomfort_far_percent = -1").edit;
    EXPECT_NEAR(p.comfort.nearest_px, 1.28, 1e-12);
    EXPECT_NEAR(p.comfort.farthest_px, -0.64, 1e-12);
    const StereoSettings s = settings("[stereo]\ncomfort_near_deg = 1\ncomfort_far_deg = -0.5");
    EXPECT_NEAR(vergence_deg(s.edit.comfort.nearest_px, 64, s.rig), 1, 1e-9);
    EXPECT_NEAR(vergence_deg(s.edit.comfort.farthest_px, 64, s.rig), -0.5, 1e-9);
    EXPECT_LT(settings("[stereo]").edit.comfort.farthest_px, -1e8);
}

TEST_F(StereoSettingsOf, PointsOfTheSceneLandOnTheirPixels) {
    // Straight ahead is the middle; half the height up lies tan(15 degrees) of the distance above.
    const StereoSettings s =
        settings(edit("type = \"match\"\nsource_m = [0, 1, 0]\ndestination_m = [0, 2.33974596, 0]"));
    const auto& match = std::get<MatchEdit>(s.edits.at(0).what);
    EXPECT_NEAR(match.source_px.x, 32, 1e-9);
    EXPECT_NEAR(match.source_px.y, 18, 1e-9);
    EXPECT_NEAR(match.destination_px.x, 32, 1e-9);
    EXPECT_NEAR(match.destination_px.y, 0, 1e-6);
    const StereoSettings behind =
        settings(edit("type = \"match\"\nsource_m = [0, 1, 6]\ndestination_m = [0, 1, 0]"));
    EXPECT_TRUE(behind.edits.empty());
    ASSERT_EQ(behind.notes.size(), 1u);
    EXPECT_NE(behind.notes[0].find("'e'"), std::string::npos);
}

TEST_F(StereoSettingsOf, PixelsFollowTheSizeOfThePicture) {
    const std::string text = edit(
        "type = \"match\"\nsource_px = [8, 4]\ndestination_px = [16, 8]\n"
        "offset_px = 3\nradius_px = 5");
    const auto full = std::get<MatchEdit>(settings(text).edits.at(0).what);
    const auto half = std::get<MatchEdit>(settings(text, 32).edits.at(0).what);
    EXPECT_EQ(full.source_px, (Vec2d{8, 4}));
    EXPECT_EQ(half.source_px, (Vec2d{4, 2}));
    EXPECT_EQ(half.offset_px, 1.5);
    EXPECT_EQ(half.radius_px, 2.5);
}

TEST_F(StereoSettingsOf, NamesMeanObjectsTheirInstancesAndSlots) {
    const auto objects = [&](const std::string& list) {
        return std::get<AnchorEdit>(settings(edit("type = \"anchor\"\nobjects = " + list)).edits.at(0).what)
            .target.objects;
    };
    using Indices = std::vector<std::uint32_t>;
    EXPECT_EQ(objects("[\"m\"]"), (Indices{0}));
    EXPECT_EQ(objects("\"row\""), (Indices{2, 3}));
    EXPECT_EQ(objects("[\"row#1\", \"other\", \"row\"]"), (Indices{1, 2, 3}));
    const auto slot = std::get<AnchorEdit>(
        settings(edit("type = \"anchor\"\nmaterials = [\"row/default\"]")).edits.at(0).what);
    EXPECT_EQ(slot.target.materials, (Indices{2}));
    try {
        settings(edit("type = \"anchor\"\nmaterials = [\"row/defalt\"]"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.message, "there is no material 'row/defalt'; did you mean 'row/default'?");
    }
}

TEST_F(StereoSettingsOf, WeightsFadeAndMove) {
    const std::string anchor = "type = \"anchor\"\nobjects = [\"m\"]\nweight = 4\n";
    EXPECT_EQ(settings(edit(anchor)).edits.at(0).weight, 4);
    const auto faded = [&](const char* ends) {
        return settings(edit(anchor + "fade_distance_m = " + ends + "\nfade_position_m = [0, 1, 0]"))
            .edits.at(0)
            .weight;
    };
    EXPECT_EQ(faded("[6, 10]"), 4);
    EXPECT_NEAR(faded("[4, 6]"), 2, 1e-9);
    EXPECT_EQ(faded("[1, 2]"), 0);
    const StereoSettings half =
        settings(edit(anchor + "offset_px = 3\nfade_distance_m = [4, 6]\nfade_position_m = [0, 1, 0]"));
    EXPECT_NEAR(std::get<AnchorEdit>(half.edits.at(0).what).offset_px, 1.5, 1e-9) << "goes with the weight";
    const std::string moving = edit(anchor) +
                               "[frames]\nrange = \"1-5\"\n[[frames.stereo_edit]]\nframe = 1\nid = \"e\"\n"
                               "weight = 0\n[[frames.stereo_edit]]\nframe = 5\nid = \"e\"\nweight = 8\n";
    EXPECT_EQ(settings(moving, 0, 2).edits.at(0).weight, 2);
}

}  // namespace
}  // namespace obscura
