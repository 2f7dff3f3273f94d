// Lamps that stand in a solid are told of; lamps in hollows, in the open, at walls and beside shadows are
// not.

#include <gtest/gtest.h>

#include "app/scene/build.h"
#include "app/scene/enclosed_lamps.h"
#include "core/topology.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

using LampNotes = std::vector<std::string>;

LampNotes notes_of(const std::string& more) {
    const std::string text = "format = 1\n[camera]\neye_m = [0, 0, 9]\nlook_at_m = [0, 0, 0]\n" + more;
    return build_scene(read_scene_text(text, "s.toml"), {}).notes;
}

const std::string crate = "[[mesh]]\nid = \"crate\"\nshape = \"box\"\nsize_m = 2\n";

std::string lamp(const std::string& place, const std::string& more = "") {
    return "[[light]]\nid = \"lamp\"\ntype = \"point\"\nintensity_w_sr = 1\nposition_m = " + place + "\n" +
           more;
}

const LampNotes in_crate = {
    "light 'lamp' is inside the solid 'crate' and lights nothing outside of it; casts_shadow = false of that "
    "mesh lets light through"};

TEST(EnclosedLamps, AreTold) {
    EXPECT_EQ(notes_of(crate + lamp("[0.9, 0.2, -0.3]")), in_crate);
    EXPECT_EQ(notes_of(crate + "[[light]]\nid = \"lamp\"\ntype = \"spot\"\nintensity_w_sr = 1\n"
                               "position_m = [0, 0, 0]\nlook_at_m = [0, 0, 5]\n"),
              in_crate);
    EXPECT_EQ(notes_of(crate + "[[light]]\nid = \"lamp\"\ntype = \"area\"\nradiance_w_m2_sr = 1\n"
                               "position_m = [0, 0, 0]\nlook_at_m = [0, 0, 5]\n"),
              in_crate);
    // The nearest of several.
    const std::string hall = "[[mesh]]\nid = \"hall\"\nshape = \"box\"\nsize_m = 20\n";
    EXPECT_EQ(notes_of(hall + crate + lamp("[0, 0, 0]")), in_crate);
    EXPECT_EQ(notes_of(hall + crate + lamp("[0, 3, 0]")).size(), 1u);
}

TEST(EnclosedLamps, ThatAreSurfacesAreNotInThemselves) {
    const std::string bulb =
        "[[mesh]]\nid = \"bulb\"\nshape = \"sphere\"\nradius_m = 0.1\nmaterial = \"hot\"\n"
        "[material.hot]\nemission_w_m2_sr = 5\n"
        "[[light]]\nid = \"lamp\"\ntype = \"surface\"\nmaterial = \"hot\"\n";
    EXPECT_EQ(notes_of(bulb), LampNotes{});
    EXPECT_EQ(notes_of(crate + bulb), in_crate);
}

TEST(EnclosedLamps, AreNotThoseInTheOpenAtWallsOrWithoutShadows) {
    EXPECT_EQ(notes_of(crate + lamp("[0, 1.01, 0]")), LampNotes{});
    for (const char* on : {"[0, 1, 0]", "[1, 0.3, 0]", "[-1, -1, 0]", "[1, 1, 1]"})
        EXPECT_EQ(notes_of(crate + lamp(on)), LampNotes{}) << on;
    EXPECT_EQ(notes_of(crate + lamp("[0, 0, 0]", "shadow = {method = \"none\"}\n")), LampNotes{});
    EXPECT_EQ(notes_of(crate + "casts_shadow = false\n" + lamp("[0, 0, 0]")), LampNotes{});
    // A room of inward faces is made for its lamp, and a sheet has no inside.
    EXPECT_EQ(notes_of(crate + "flip_faces = true\n" + lamp("[0, 0, 0]")), LampNotes{});
    EXPECT_EQ(notes_of("[[mesh]]\nid = \"floor\"\nshape = \"plane\"\nwidth_m = 9\ndepth_m = 9\n" +
                       lamp("[0, -0.1, 0]")),
              LampNotes{});
}

TEST(EnclosedLamps, AreNotThoseInTheHollowOfAShell) {
    Scene scene;
    scene.mesh = box({4, 4, 4});
    Mesh hollow = box({3, 3, 3});
    for (Triangle& t : hollow.triangles)
        std::swap(t.v[1], t.v[2]);
    append_mesh(scene.mesh, hollow);
    scene.mesh.objects = {{"shell", true}};
    scene.mesh.object.assign(scene.mesh.triangles.size(), 0);
    analyse_topology(scene.mesh);
    SceneLight light;
    light.light.kind = LightKind::point;
    scene.lights = {light};
    EXPECT_EQ(enclosed_lamp_notes(scene), LampNotes{});
    scene.lights[0].light.position = {1.7, 0, 0};
    EXPECT_EQ(enclosed_lamp_notes(scene).size(), 1u) << "in its wall";
}

}  // namespace
}  // namespace obscura
