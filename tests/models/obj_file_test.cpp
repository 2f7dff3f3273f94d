#include "app/models/obj_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/core/temporary_folder.h"
#include "tests/fuzz/obj_peer.h"

namespace obscura {
namespace {

/// Every text of these tests is one that tinyobjloader must read alike.
Model read(std::string_view obj, std::string_view mtl = "", const ModelOptions& options = {}) {
    const PeerResult peer = read_by_both(obj, mtl, Limits{});
    EXPECT_TRUE(peer.compared) << obj;
    EXPECT_EQ(peer.difference, "") << obj << mtl;
    return obj_from_text(obj, mtl, Limits{}, options);
}

TEST(ObjFile, PositionsFacesAndRelativeIndices) {
    const Model model = read(
        "v 0 0 0\nv 1 0 0\nv +1 1.5e0 -0\nv .5 2. 1e-400\n"
        "f 1 2 3\nf -4 -2 -1\n");
    ASSERT_EQ(model.mesh.triangles.size(), 2u);
    ASSERT_EQ(model.mesh.positions.size(), 4u);
    EXPECT_EQ(model.mesh.positions[2], (Vec3f{1, 1.5f, 0}));
    EXPECT_EQ(model.mesh.positions[model.mesh.triangles[1].v[2]], (Vec3f{0.5f, 2, 0}));
    EXPECT_EQ(model.mesh.normals.size(), model.mesh.positions.size());
    EXPECT_EQ(model.materials.at(0).name, "default");
    ASSERT_EQ(model.mesh.objects.size(), 1u);
    EXPECT_EQ(model.mesh.objects[0].name, "text");
}

TEST(ObjFile, LineEndsMarksAndContinuations) {
    const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const std::string variants[] = {
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "\xEF\xBB\xBF" + plain,
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",  // no end of the last line
        "v 0 \\\n0 0\nv 1 0 \\\r\n 0\nv 0 1 0\nf 1 \\\n2 \\\n3\n",
        "# a comment\nv 0 0 0 # at the origin\n\n   \nv\t1 0  0\nv 0 1 0 1.0\nf 1 2 3 # done\n",
        "f 1 2 3\n" + plain.substr(0, 24),  // the face points ahead
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvp 0 0\nl 1 2\np 1\nlod 3\nf 1 2 3\n"};
    const Model expected = read(plain);
    for (const std::string& text : variants) {
        const Model model = read(text);
        EXPECT_EQ(model.mesh.positions, expected.mesh.positions) << text;
        EXPECT_EQ(model.mesh.triangles, expected.mesh.triangles) << text;
    }
}

TEST(ObjFile, CornersShareVerticesWhenAllIndicesAgree) {
    const Model model = read(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5\n"
        "vn 0 0 3\nvn 1 0 1\n"
        "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/5/1 4/4/2\n");
    ASSERT_EQ(model.mesh.positions.size(), 5u);  // corner 3 twice, for two texture coordinates
    ASSERT_EQ(model.mesh.uvs.size(), 5u);
    EXPECT_EQ(model.mesh.normals[0], (Vec3f{0, 0, 1})) << "made unit";
    EXPECT_EQ(model.mesh.uvs[model.mesh.triangles[1].v[1]], (Vec2f{0.5f, 0}));
    EXPECT_EQ(model.topology.by_index.open, 4u) << "the seam in uv is no open edge";
    EXPECT_NEAR(model.mesh.normals[model.mesh.triangles[1].v[2]].x, std::sqrt(0.5f), 1e-6f);
}

TEST(ObjFile, MixedCornersFillTheGaps) {
    const Model model = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nvn 0 1 0\nf 1/1 2//1 3\n");
    ASSERT_EQ(model.mesh.uvs.size(), 3u);
    EXPECT_EQ(model.mesh.uvs[0], (Vec2f{1, 1}));
    EXPECT_EQ(model.mesh.uvs[2], (Vec2f{0, 0}));
    EXPECT_EQ(model.mesh.normals[1], (Vec3f{0, 1, 0}));
    EXPECT_EQ(model.mesh.normals[2], (Vec3f{0, 0, 1})) << "computed";
}

TEST(ObjFile, ThreeHundredCornersAndConcavePolygons) {
    std::ostringstream text;
    for (int i = 0; i < 300; ++i) {
        const double a = i * 2 * 3.14159265358979 / 300, r = i % 2 ? 1 : 2;
        text << "v " << r * std::cos(a) << " " << r * std::sin(a) << " 5\n";
    }
    text << "f";
    for (int i = 1; i <= 300; ++i)
        text << " " << i;
    const Model model = read(text.str());
    ASSERT_EQ(model.mesh.triangles.size(), 298u);
    double area = 0;
    for (const Triangle& t : model.mesh.triangles) {
        const Vec3d a = to_double(model.mesh.positions[t.v[0]]), b = to_double(model.mesh.positions[t.v[1]]),
                    c = to_double(model.mesh.positions[t.v[2]]);
        const Vec3d n = cross(b - a, c - a);
        EXPECT_GT(n.z, 0);
        area += n.z / 2;
    }
    // Between a corner at radius 1 and one at 2 lies a triangle of area sin(360 / 300 degrees).
    EXPECT_NEAR(area, 300 * std::sin(2 * 3.14159265358979 / 300), 1e-3);
    EXPECT_EQ(model.mesh.faces.size(), 1u);
}

TEST(ObjFile, ObjectsGroupsAndSmoothing) {
    const std::string roof = "v 0 0 0\nv 0 0 1\nv 1 1 0\nv -1 1 0\n";
    const Model objects =
        read(roof + "o left wing\nf 1 2 3\no empty\no right\nf 2 1 4\no left wing\nf 1 3 2\n");
    ASSERT_EQ(objects.mesh.objects.size(), 2u);
    EXPECT_EQ(objects.mesh.objects[0].name, "left wing");
    EXPECT_EQ(objects.mesh.object, (std::vector<std::uint32_t>{0, 1, 0}));
    const Model groups = read(roof + "g a\nf 1 2 3\ng b\nf 2 1 4\n");
    ASSERT_EQ(groups.mesh.objects.size(), 2u);
    EXPECT_EQ(groups.mesh.objects[1].name, "b");

    // The ridge turns by 90 degrees: a crease unless a smoothing group says otherwise.
    const auto vertices = [&](const std::string& s) {
        return read(roof + s + "f 1 2 3\nf 2 1 4\n").mesh.positions.size();
    };
    EXPECT_EQ(vertices(""), 6u);
    EXPECT_EQ(vertices("s 1\n"), 4u);
    EXPECT_EQ(vertices("s off\n"), 6u);
    ModelOptions wide;
    wide.crease_angle_deg = 100;
    EXPECT_EQ(read(roof + "f 1 2 3\nf 2 1 4\n", "", wide).mesh.positions.size(), 4u);
}

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ObjFile, MaterialsFromMtl) {
    const std::string mtl =
        "# comment\nKa_ignored\n\nnewmtl matte red\nKd 0.8 0.1 1.5\nKs 0 0 0\nNs 200\nillum 2\n"
        "newmtl glossy\nKd .5\nKs 0.5 0.5 0.5\nNs 30\nmap_Kd -blendu on -bm 1 my wood.png\n"
        "newmtl gold\nKd 0 0 0\nKs 1 0.8 0.3\nNs 510\nKe 1 2 3\n"
        "newmtl pbr\nPr 0.25\nPm 0.5\nmap_Kd my wood.png\n"
        "newmtl unused\nmap_Kd other.png\n";
    const Model model = read(std::string("mtllib a.mtl\n") + triangle +
                                 "usemtl gold\nf 1 2 3\nusemtl matte red\nf 1 2 3\nusemtl glossy\nf 1 2 3\n"
                                 "usemtl pbr\nf 1 2 3\nusemtl gold\nf 1 2 3\n",
                             mtl);
    ASSERT_EQ(model.materials.size(), 4u);
    EXPECT_EQ(model.mesh.material, (std::vector<std::uint32_t>{0, 1, 2, 3, 0}));
    const Material &gold = model.materials[0], &red = model.materials[1], &glossy = model.materials[2];
    EXPECT_EQ(gold.base_color, (Vec3f{1, 0.8f, 0.3f}));
    EXPECT_EQ(gold.metallic, 1.0f);
    EXPECT_FLOAT_EQ(gold.roughness, 0.25f);  // alpha = sqrt(2 / 512) = 1/16
    EXPECT_EQ(gold.emission, (Vec3f{1, 2, 3}));
    EXPECT_EQ(red.name, "matte red");
    EXPECT_EQ(red.base_color, (Vec3f{0.8f, 0.1f, 1}));
    EXPECT_EQ(red.roughness, 1.0f);
    EXPECT_EQ(red.texture, -1);
    EXPECT_EQ(glossy.base_color, (Vec3f{0.5f, 0.5f, 0.5f}));
    EXPECT_FLOAT_EQ(glossy.roughness, 0.5f);  // alpha = sqrt(2 / 32) = 1/4
    EXPECT_EQ(glossy.metallic, 0.0f);
    EXPECT_EQ(model.materials[3].roughness, 0.25f);
    EXPECT_EQ(model.materials[3].metallic, 0.5f);
    ASSERT_EQ(model.texture_files, (std::vector<std::string>{"my wood.png"}));
    EXPECT_EQ(glossy.texture, 0);
    EXPECT_EQ(model.materials[3].texture, 0);
}

TEST(ObjFile, FilesBesideTheFile) {
    const TemporaryFolder folder;
    folder.write("models/wood.png", "");
    folder.write("models/lib/second one.mtl", "newmtl b\nmap_Kd ..\\wood.png\n");
    folder.write("models/first.mtl", "newmtl a\nKd 1 0 0\n");
    const auto file =
        folder.write("models/house.obj", std::string("mtllib first.mtl\nmtllib lib/second one.mtl\n") +
                                             triangle + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
    const FileAccess access{folder.path, {}};
    const Model model = load_obj(file, access, Limits{});
    ASSERT_EQ(model.materials.size(), 2u);
    EXPECT_EQ(model.mesh.objects[0].name, "house");
    EXPECT_EQ(model.texture_files, std::vector<std::string>{(folder.path / "models/wood.png").string()});

    // Several names on one line.
    folder.write("models/third.mtl", "newmtl b\n");
    const auto both = folder.write("models/two.obj", std::string("mtllib first.mtl third.mtl\n") + triangle +
                                                         "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
    EXPECT_EQ(load_obj(both, access, Limits{}).materials[0].base_color, (Vec3f{1, 0, 0}));
}

TEST(ObjFile, AllowMissingNotesWhatIsMissing) {
    const TemporaryFolder folder;
    folder.write("have.mtl", "newmtl a\nmap_Kd gone.png\n");
    const auto file = folder.write("x.obj", std::string("mtllib have.mtl\nmtllib gone.mtl\n") + triangle +
                                                "usemtl a\nf 1 2 3\nusemtl nowhere\nf 1 2 3\n");
    ModelOptions options;
    options.allow_missing = true;
    const Model model = load_obj(file, FileAccess{folder.path, {}}, Limits{}, options);
    ASSERT_EQ(model.missing.size(), 3u);
    EXPECT_NE(model.missing[0].find("x.obj:2: mtllib gone.mtl"), std::string::npos) << model.missing[0];
    EXPECT_NE(model.missing[1].find("have.mtl:2: map_Kd gone.png"), std::string::npos) << model.missing[1];
    EXPECT_NE(model.missing[2].find("x.obj:8: material 'nowhere'"), std::string::npos) << model.missing[2];
    EXPECT_EQ(model.materials.size(), 2u);
    EXPECT_TRUE(model.texture_files.empty());
}

TEST(ObjFile, CommentsAndLineEndsLoseNothing) {
    const std::string faces = "f 1 2 3\nf 1 3 2\n";
    for (const std::string& text : {
             triangle + std::string("# from C:\\models\\\n") + faces,
             "# C:\\models\\  \n" + std::string(triangle) + faces,
             triangle + std::string("f 1 2 3 # C:\\\nf 1 3 2\n"),
             triangle + std::string("f 1 2 3# C:\\\nf 1 3 2#last\n"),
             triangle + std::string("f 1 2 \\ \t\n 3\nf 1 \\\r\n 3 2\n"),
             std::string("# old\rv 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 \\\r3\rf 1 3 2\r"),
             std::string("# mixed\rv 0 0 0\nv 1 0 0\r\nv 0 1 0\r\rf 1 2 3\rf 1 3 2"),
             triangle + std::string("s\nf 1/ 2// 3\nvt 0 0\nvn 0 0 1\nf 1/1/ 3/1 2//1\n"),
         }) {
        EXPECT_EQ(read(text).mesh.triangles.size(), 2u) << text;
    }
    const Model model = read(std::string("mtllib a.mtl\r") + triangle + "usemtl m\rf 1 2 3\r",
                             "# C:\\mtl\\\rnewmtl m\r# Kd\\\rKd 1 0 0#red\r");
    EXPECT_EQ(model.materials[0].base_color, (Vec3f{1, 0, 0}));
}

TEST(ObjFile, CommentsBehindNames) {
    const auto used = [](const std::string& name, const std::string& mtl) {
        return obj_from_text(std::string("mtllib a.mtl\n") + triangle + "usemtl " + name + "\nf 1 2 3\n", mtl,
                             Limits{})
            .materials[0];
    };
    const std::string red = "Kd 1 0 0\n", blue = "Kd 0 0 1\n";
    EXPECT_EQ(used("red # door", "newmtl red # paint\n" + red).name, "red");
    EXPECT_EQ(used("red", "newmtl red\t# paint\n" + red).name, "red");
    EXPECT_EQ(used("red # door", "newmtl red\n" + red).name, "red");
    EXPECT_EQ(used("red#1", "newmtl red#1\n" + red + "newmtl red\n" + blue).name, "red#1");
    // The name with the # in it comes first.
    const Material whole = used("a # 2", "newmtl a\n" + red + "newmtl a # 2\n" + blue);
    EXPECT_EQ(whole.name, "a # 2");
    EXPECT_EQ(whole.base_color, (Vec3f{0, 0, 1}));
}

TEST(ObjFile, TextureOptionsMayLackNumbers) {
    for (const char* options : {"-s 1 -o 0 0", "-s 1 1 -t 0", "-o 0", "-clamp off -mm 0 1 -s 1 1 1", ""}) {
        const Model model =
            obj_from_text(std::string("mtllib a.mtl\n") + triangle + "usemtl m\nf 1 2 3\n",
                          std::string("newmtl m\nmap_Kd ") + options + " my t.png # wood\n", Limits{});
        EXPECT_EQ(model.texture_files, std::vector<std::string>{"my t.png"}) << options;
    }
}

TEST(ObjFile, WhatIsNotReadIsNotedOnceOfAKind) {
    const Model model = read(
        std::string("mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nl 1 2\nl 2 3\n") +
            "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl d\nf 1 2 3\n",
        "newmtl a\nd 0.2\nTr 0.8\nmap_d mask.png\nmap_Bump a.png\nmap_Bump b.png\n"
        "newmtl b\nTf 0.5 1 1\nmap_Bump c.png\nnewmtl c\nillum 4\n"
        "newmtl d\nd 1\nTr 1\nTf 1 1 1\nillum 2\nKa 1 1 1\nNi 1.5\nnewmtl unused\nd 0.5\nmap_Ks d.png\n");
    EXPECT_EQ(model.notes, (std::vector<std::string>{
                               "text.obj:2: colours of vertices are not read (3 lines)",
                               "text.obj:5: 'l' is not read (2 lines)",
                               "text.mtl: 'a', 'b', 'c' are transparent in the file; drawn opaque",
                               "text.mtl: 'a', 'b': 'map_Bump' is not read",
                           }));
    EXPECT_EQ(read("# nothing\n").notes, std::vector<std::string>{"text.obj: has no triangles"});
}

TEST(ObjFile, WhatChangesOnTheWayToAMaterialIsNotedOnceOfAKind) {
    using Notes = std::vector<std::string>;
    const auto notes = [&](const std::string& block, const std::string& before = "") {
        return read(std::string("mtllib a.mtl\n") + triangle + "usemtl m\nf 1 2 3\n",
                    before + "newmtl m\n" + block)
            .notes;
    };
    const auto one = [](const std::string& what) { return Notes{"text.mtl: 'm': " + what}; };
    EXPECT_EQ(notes("Kd 1.2 0.5 0.5\n"), one("Kd is above 1 and is cut to 1"));
    EXPECT_EQ(notes("Kd 0 0 0\nKs 2 2 2\n"), one("Ks is above 1 and is cut to 1"));
    EXPECT_EQ(notes("Kd 1 1 1\nKs 1 0.5 0.5\n"),
              one("the colour of Ks is not read beside Kd: highlights are white"));
    EXPECT_EQ(notes("Ns 200\n"), one("Ns does nothing without Ks"));
    EXPECT_EQ(notes("Kd 0 0 0\nKd 1 1 1\nKd 0 0 0\n"), one("Kd is given more than once; the last counts"));
    EXPECT_EQ(notes("Kd 1 1 1\n", "newmtl m\nKd 0 0 0\n"),
              one("newmtl is given more than once; the last counts"));
    EXPECT_EQ(notes("map_Kd -imfchan r -blendu off -blendv on -type sphere t.png\n"),
              (Notes{"text.mtl: 'm': '-imfchan' of map_Kd is not read",
                     "text.mtl: 'm': '-blendu' of map_Kd is not read",
                     "text.mtl: 'm': '-type' of map_Kd is not read"}));
    // What comes through whole is not talked about.
    EXPECT_EQ(notes("Kd 1 1 1\nKs 0.3 0.3 0.3\nNs 20\n"), Notes{});
    EXPECT_EQ(notes("Kd 1 1 1\nKs 0 0 0\nNs 20\n"), Notes{});
    EXPECT_EQ(notes("Kd 0 0 0\nKs 1 0.5 0.5\nKe 3 3 3\n"), Notes{});
    EXPECT_EQ(notes("Kd 1 1 1\nPr 0.3\nNs 20\n"), Notes{});
    const Model two =
        read(std::string("mtllib a.mtl\n") + triangle + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n",
             "newmtl a\nKd 2 2 2\nnewmtl b\nKd 3 3 3\nnewmtl unused\nKd 4 4 4\n");
    EXPECT_EQ(two.notes, Notes{"text.mtl: 'a', 'b': Kd is above 1 and is cut to 1"});
}

TEST(ObjFile, SurveyedCoordinatesKeepTheirDetails) {
    // A wall of 0.2 m at 5,400,000 m, where single precision has steps of half a metre.
    const Model model = read(
        "v 500000.000 0 5400000.300\nv 500000.000 0 5400000.500\nv 500000.000 1 5400000.300\n"
        "v 500002.000 0 5400000.300\nf 1 2 3\nf 1 2 4\n");
    EXPECT_EQ(model.topology.degenerate_triangles, 0u);
    EXPECT_TRUE(model.notes.empty());
    EXPECT_EQ(model.origin, (Vec3d{500001, 0, 5400000}));
    EXPECT_EQ(model.mesh.positions[0].z, 0.3f);
    EXPECT_EQ(model.mesh.positions[0].x, -1.0f);
    // Near the origin, or on both sides of it, floats are what they were.
    EXPECT_EQ(read("v 3 0 0\nv 4 0 0\nv 3 1 0\nf 1 2 3\n").origin, (Vec3d{}));
    // One file that has both: what merges is told.
    const Model torn = read(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5400000.3 0 0\nv 5400000.4 0 0\nv 5400000.3 1 0\nf 1 2 3\nf 4 5 6\n");
    ASSERT_EQ(torn.notes.size(), 1u);
    EXPECT_NE(torn.notes[0].find("1 of 2 triangles collapse"), std::string::npos) << torn.notes[0];
}

TEST(ObjFile, MaterialsThatAreReplacedNeedNotBeThere) {
    const TemporaryFolder folder;
    folder.write("c.mtl", "newmtl x\nmap_Kd gone.jpg\nnewmtl y\n");
    const FileAccess access{folder.path, {}};
    const auto load = [&](const std::string& head, const std::string& faces, const ModelOptions& options) {
        return load_obj(folder.write("a.obj", head + triangle + faces), access, Limits{}, options);
    };
    ModelOptions none, x_replaced;
    none.materials = false;
    x_replaced.replaced = {"x"};
    for (const char* head : {"mtllib gone.mtl\n", "", "mtllib c.mtl\n"}) {
        const std::string faces = "usemtl x\nf 1 2 3\n";
        EXPECT_THROW(load(head, faces, {}), InputError) << head;
        EXPECT_EQ(load(head, faces, none).mesh.material, std::vector<std::uint32_t>{0}) << head;
        EXPECT_EQ(load(head, faces, x_replaced).materials.at(0).name, "x") << head;
    }
    const std::string both = "usemtl x\nf 1 2 3\nusemtl y\nf 1 2 3\n";
    EXPECT_EQ(load("mtllib c.mtl\n", both, x_replaced).materials.size(), 2u);
    EXPECT_THROW(load("mtllib gone.mtl\n", both, x_replaced), InputError);  // y is wanted
}

TEST(ObjFile, BackslashesBetweenFolders) {
    const TemporaryFolder folder;
    folder.write("sub/m.mtl", "newmtl x\nKd 1 0 0\n");
    const auto file =
        folder.write("a.obj", std::string("mtllib sub\\m.mtl\n") + triangle + "usemtl x\nf 1 2 3\n");
    EXPECT_EQ(load_obj(file, FileAccess{folder.path, {}}, Limits{}).materials.at(0).base_color,
              (Vec3f{1, 0, 0}));
}

TEST(ObjFile, EmptyAndDegenerateModelsAreModels) {
    EXPECT_TRUE(read("").mesh.triangles.empty());
    EXPECT_TRUE(read("# nothing\nv 1 2 3\n").mesh.positions.empty());
    const Model flat = read("v 0 0 0\nv 1 1 1\nf 1 2 2\nf 1 2 1 2\n");
    EXPECT_EQ(flat.topology.degenerate_triangles, 3u);
    EXPECT_EQ(flat.mesh.triangles.size(), 3u);
}

}  // namespace
}  // namespace obscura
