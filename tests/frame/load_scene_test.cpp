// From documents to scenes: placement, materials, lights, textures, files that may not be read, limits.

#include "app/frame/load_scene.h"
#include "app/scene/build.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/image_io.h"
#include "core/texture.h"
#include "core/topology.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

const std::string header = "format = 1\ncamera = {eye_m = [0, 1, 5], look_at_m = [0, 0, 0]}\n";

/// A folder of its own for every test.
class SceneBuild : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "obscura_scene_XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
    }
    Scene build(const std::string& text, const std::vector<std::string>& overrides = {}) const {
        return load_scene(read_scene_text(header + text, "s.toml", overrides), FileAccess{folder_, {}});
    }
    template <class Error = InputError>
    std::string error(const std::string& text) const {
        try {
            build(text);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }

    fs::path folder_;
};

Vec3f least(const Mesh& mesh) {
    Vec3f low = mesh.positions.at(0);
    for (const Vec3f p : mesh.positions)
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    return low;
}
Vec3f greatest(const Mesh& mesh) {
    Vec3f high = mesh.positions.at(0);
    for (const Vec3f p : mesh.positions)
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    return high;
}

TEST_F(SceneBuild, TransformsScaleThenTurnThenMove) {
    const Scene scene = build(R"(
[[mesh]]
id = "slab"
shape = "box"
size_m = [2, 2, 2]
scale = [1, 2, 3]
rotate_deg = [90, 0, 90]
translate_m = [10, 0, 0])");
    // Scaled: 2 x 4 x 6. About x by 90: y -> z, so 2 x 6 x 4. About z by 90: x -> y, so 6 x 2 x 4.
    EXPECT_EQ(least(scene.mesh), (Vec3f{7, -1, -2}));
    EXPECT_EQ(greatest(scene.mesh), (Vec3f{13, 1, 2}));
}

TEST_F(SceneBuild, TurnsAreCounterClockwiseSeenFromTheTip) {
    const Scene scene = build(
        "[[mesh]]\nid = \"a\"\nshape = \"plane\"\ntranslate_m = [5, 0, 0]\n"
        "[[mesh.instance]]\nrotate_deg = [0, 90, 0]\n[[mesh.instance]]\nrotate_deg = [0, 0, 90]");
    ASSERT_EQ(scene.mesh.objects.size(), 2u);
    EXPECT_EQ(scene.mesh.objects[1].name, "a#1");
    // About y, x goes to -z; about z, x goes to y. The instance's turn comes after the mesh's move.
    EXPECT_EQ(scene.mesh.normals.front(), (Vec3f{0, 1, 0}));
    EXPECT_EQ(least(scene.mesh), (Vec3f{-0.5f, 0, -5.5f}));
    EXPECT_EQ(scene.mesh.normals.back(), (Vec3f{-1, 0, 0}));
    EXPECT_EQ(greatest(scene.mesh), (Vec3f{0.5f, 5.5f, 0.5f}));
}

TEST_F(SceneBuild, MirroredSolidsStayOutsideOutAndFlippedOnesDoNot) {
    const std::string sphere = "[[mesh]]\nid = \"a\"\nshape = \"sphere\"\nscale = [-1, 2, 1]\n";
    const Scene mirrored = build(sphere);
    ASSERT_EQ(mirrored.mesh.components.size(), 1u);
    EXPECT_TRUE(mirrored.mesh.components[0].closed);
    EXPECT_GT(signed_volumes(mirrored.mesh)[0], 1.0);
    for (const Triangle& t : mirrored.mesh.triangles) {
        const auto p = [&](int i) { return mirrored.mesh.positions[t.v[i]]; };
        const Vec3f n = cross(p(1) - p(0), p(2) - p(0));
        for (const std::uint32_t v : t.v)
            EXPECT_GE(dot(n, mirrored.mesh.normals[v]), 0);
    }
    EXPECT_LT(signed_volumes(build(sphere + "flip_faces = true").mesh)[0], -1.0);
}

TEST_F(SceneBuild, MaterialsReachTheirTriangles) {
    write("two.obj",
          "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 4\n");
    write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    const std::string mesh = "[[mesh]]\nid = \"m\"\nfile = \"two.obj\"\n";
    const std::string green = "[material.green]\nbase_color = [0, 1, 0]\n";
    const auto colors = [](const Scene& s) {
        return std::vector<Vec3f>{s.materials.at(s.mesh.material.at(0)).base_color,
                                  s.materials.at(s.mesh.material.at(1)).base_color};
    };
    EXPECT_EQ(colors(build(mesh + green)), (std::vector<Vec3f>{{1, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(colors(build(mesh + "material = \"green\"\n" + green)),
              (std::vector<Vec3f>{{0, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(colors(build(mesh + "materials = {blue = \"green\"}\n" + green)),
              (std::vector<Vec3f>{{1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(error(mesh + "materials = {bleu = \"green\"}\n" + green),
              "s.toml:6:14: mesh 'm' has no material slot 'bleu'; did you mean 'blue'?; it has: red, blue");
}

TEST_F(SceneBuild, SrgbColoursBecomeLinear) {
    const Scene scene =
        build("[material.a]\nbase_color = 0.5\ncolor_space = \"srgb\"\n[material.b]\nbase_color = 0.5");
    EXPECT_FLOAT_EQ(scene.materials.at(0).base_color.x, 0.21404114f);
    EXPECT_EQ(scene.materials.at(1).base_color.x, 0.5f);
}

TEST_F(SceneBuild, AzimuthIsClockwiseFromNorth) {
    const auto direction = [&](const std::string& keys) {
        return build("[[light]]\nid = \"a\"\ntype = \"directional\"\n" + keys).lights.at(0).light.direction;
    };
    // North is -Z and east is +X; light travels away from where it comes from.
    EXPECT_EQ(direction("azimuth_deg = 0\nelevation_deg = 0"), (Vec3d{0, 0, 1}));
    EXPECT_EQ(direction("azimuth_deg = 90\nelevation_deg = 0"), (Vec3d{-1, 0, 0}));
    EXPECT_EQ(direction("azimuth_deg = 0\nelevation_deg = 90"), (Vec3d{0, -1, 0}));
    EXPECT_NEAR(direction("azimuth_deg = 180\nelevation_deg = 30").z, -0.8660254037844386, 1e-15);
}

TEST_F(SceneBuild, SunStandsInTheSouthAtNoonAndReddensTowardsEvening) {
    const auto sun = [&](const std::string& time) {
        return build(
                   "[[light]]\nid = \"a\"\ntype = \"sun\"\nlatitude_deg = 48.2\nlongitude_deg = 16.37\ntime "
                   "= " +
                   time)
            .lights.at(0)
            .light;
    };
    // Vienna, summer solstice: the sun culminates at 90 - 48.2 + 23.44 degrees at about 12:56 summer time.
    const Light noon = sun("2026-06-21T12:56:30+02:00"), evening = sun("2026-06-21T20:00:00+02:00");
    EXPECT_NEAR(-noon.direction.y, 0.9085, 0.001);  // sin 65.3
    EXPECT_NEAR(noon.direction.x, 0, 0.005);
    EXPECT_LT(noon.direction.z, 0) << "light from the south travels north";
    EXPECT_GT(noon.color.x, noon.color.z);
    EXPECT_GT(evening.color.x / evening.color.z, 1.5f * noon.color.x / noon.color.z);
    EXPECT_GT(noon.color.z, 3 * evening.color.z);
    const Light night = sun("2026-06-21T23:00:00+02:00");
    EXPECT_TRUE(night.below_horizon);
    EXPECT_EQ(night.color, (Vec3f{0, 0, 0}));
    // The same moment by another clock.
    EXPECT_EQ(sun("2026-06-21T10:56:30Z").direction, noon.direction);
}

TEST_F(SceneBuild, FocalLengthGivesTheAngleOfView) {
    const Scene scene = build("", {"camera.focal_length_mm=50", "camera.sensor_height_mm=20.25"});
    EXPECT_NEAR(scene.camera.vfov_deg, 22.8952, 1e-4);  // 2 atan(20.25 / 100)
}

TEST_F(SceneBuild, FramesMoveCameraAndLightsOnly) {
    const std::string text = header + R"(
[[mesh]]
id = "a"
shape = "box"
[[light]]
id = "l"
type = "sun"
latitude_deg = 0
longitude_deg = 0
time = 2026-03-20T12:00:00Z
[frames]
range = "0-10"
[[frames.camera]]
frame = 0
eye_m = [0, 0, 10]
[[frames.camera]]
frame = 10
eye_m = [10, 0, 10]
[[frames.light]]
id = "l"
frame = 0
time = 2026-03-20T08:00:00Z
[[frames.light]]
id = "l"
frame = 10
time = 2026-03-20T16:00:00Z
)";
    const SceneDocument document = read_scene_text(text, "s.toml");
    Scene scene = build_scene(document, FileAccess{folder_, {}});
    EXPECT_EQ(scene.camera.eye, (Vec3d{0, 0, 10}));
    const Vec3d morning = scene.lights.at(0).light.direction;
    const Vec3f* positions = scene.mesh.positions.data();
    set_frame(scene, document, 5);
    EXPECT_EQ(scene.camera.eye, (Vec3d{5, 0, 10}));
    EXPECT_NEAR(scene.lights.at(0).light.direction.y, -1, 0.01) << "noon at the equator at equinox";
    EXPECT_LT(morning.x, -0.8) << "in the morning light comes from the east";
    EXPECT_EQ(scene.mesh.positions.data(), positions);
    set_frame(scene, document, 0);
    EXPECT_EQ(scene.lights.at(0).light.direction, morning);
}

TEST_F(SceneBuild, TexturesAreDecodedOnce) {
    Image<Rgb8> image(2, 2, Rgb8{255, 0, 0});
    image(0, 0) = {255, 255, 255};
    write("t.png", encode_png(image.view()));
    const Scene scene = build("[material.a]\ntexture = \"t.png\"\n[material.b]\ntexture = \"./t.png\"");
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.materials.at(1).texture, 0);
    ASSERT_EQ(scene.textures[0].levels.size(), 2u);
    EXPECT_EQ(scene.textures[0].levels[1](0, 0), (Vec3f{1, 0.25f, 0.25f}));
}

TEST_F(SceneBuild, FilesThatMayNotBeReadAreNamedWithTheirPlace) {
    const auto mesh = [&](const std::string& file) {
        return error("[[mesh]]\nid = \"a\"\nfile = \"" + file + "\"");
    };
    const std::string place = "s.toml:5:8: '";
    const auto starts_with = [](const std::string& s, const std::string& front) {
        return s.substr(0, front.size()) == front;
    };
    EXPECT_TRUE(starts_with(mesh("none.obj"), place + "none.obj'")) << mesh("none.obj");
    EXPECT_TRUE(starts_with(mesh("../../etc/passwd"), place + "../../etc/passwd'"))
        << mesh("../../etc/passwd");
    EXPECT_TRUE(starts_with(mesh("/etc/passwd"), place + "/etc/passwd'")) << mesh("/etc/passwd");
    fs::create_symlink("/etc/passwd", folder_ / "link.obj");
    EXPECT_TRUE(starts_with(mesh("link.obj"), place + "link.obj'")) << mesh("link.obj");
    ASSERT_EQ(mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
    EXPECT_NE(mesh("pipe.obj").find("FIFO"), std::string::npos) << mesh("pipe.obj");
    fs::create_directory(folder_ / "folder.obj");
    EXPECT_NE(mesh("folder.obj").find("folder"), std::string::npos);
    write("cut.png", encode_png(Image<Rgb8>(8, 8).view()).substr(0, 50));
    EXPECT_NE(error("[material.a]\ntexture = \"cut.png\"").find("cut.png"), std::string::npos);
}

TEST_F(SceneBuild, SceneFilesMustBeRegularFiles) {
    const auto read_error = [&](const fs::path& file) -> std::string {
        try {
            read_scene(file);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_NE(read_error(folder_ / "none.toml").find("none.toml"), std::string::npos);
    EXPECT_NE(read_error(folder_).find("folder"), std::string::npos) << read_error(folder_);
    EXPECT_NE(read_error("/dev/zero").find("device"), std::string::npos) << read_error("/dev/zero");
    ASSERT_EQ(mkfifo((folder_ / "pipe.toml").c_str(), 0600), 0);
    EXPECT_NE(read_error(folder_ / "pipe.toml").find("FIFO"), std::string::npos);
    write("empty.toml", "");
    EXPECT_EQ(read_error(folder_ / "empty.toml"),
              (folder_ / "empty.toml").string() + ": no camera: the scene is empty");
    write("big.toml", std::string((16 << 20) + 1, '\n'));
    EXPECT_EQ(read_error(folder_ / "big.toml"),
              (folder_ / "big.toml").string() + ": scene file is larger than 16777216 bytes");
}

TEST_F(SceneBuild, LimitsStopBeforeAllocating) {
    const std::string maps =
        "[[light]]\nid = \"a\"\ntype = \"point\"\nposition_m = [0, 0, 0]\nintensity_w_sr = 1\n"
        "shadow = {method = \"map\", resolution = 16384}\n";
    EXPECT_EQ(error<LimitError>(maps),
              "s.toml: needs about 6156 MiB (meshes 0, textures 0, shadow maps 6144, frame 12), more than "
              "limits.memory_mib = 4096");
    EXPECT_EQ(error<LimitError>(maps + "[limits]\nmemory_mib = 7000"), "");

    write("t.png", encode_png(Image<Rgb8>(64, 64).view()));
    const std::string texture = "[material.a]\ntexture = \"t.png\"\n[limits]\n";
    EXPECT_NE(error<LimitError>(texture + "texture_px = 63").find("64"), std::string::npos);
    EXPECT_EQ(error<LimitError>(texture + "texture_px = 64"), "");

    // Shapes are refused by their bound, before they are made.
    const std::string ball =
        "[render]\nsize_px = [8, 8]\n[[mesh]]\nid = \"a\"\nshape = \"sphere\"\nsegments = 100\n"
        "rings = 100\n[limits]\nmemory_mib = ";
    EXPECT_EQ(error<LimitError>(ball + "2"),
              "s.toml: needs about 3 MiB (meshes 3, textures 0, shadow maps 0, frame 0), more than "
              "limits.memory_mib = 2");
    EXPECT_EQ(error<LimitError>(ball + "64"), "");

    write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const std::string quads =
        "[[mesh]]\nid = \"q\"\nfile = \"q.obj\"\n[[mesh.instance]]\n[[mesh.instance]]\n[limits]\n";
    EXPECT_EQ(error<LimitError>(quads + "triangles = 3"),
              "s.toml: mesh 'q' brings the scene to 4 triangles, more than limits.triangles = 3");
    EXPECT_EQ(error<LimitError>(quads + "triangles = 4"), "");
}

TEST(Texture, LevelsKeepTheMean) {
    Image<Rgba8> image(5, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i] = {static_cast<std::uint8_t>(17 * i), static_cast<std::uint8_t>(255 - 9 * i), 128,
                           255};
    }
    const Texture texture = make_texture("t", image.view());
    std::int64_t bytes = 0;
    Vec3d mean_of_base;
    for (const Image<Vec3f>& level : texture.levels) {
        Vec3d mean;
        for (const Vec3f c : level.pixels)
            mean = mean + to_double(c) * (1.0 / static_cast<double>(level.pixels.size()));
        if (bytes == 0) mean_of_base = mean;
        EXPECT_NEAR(mean.x, mean_of_base.x, 1e-6);
        EXPECT_NEAR(mean.y, mean_of_base.y, 1e-6);
        bytes += static_cast<std::int64_t>(level.pixels.size() * sizeof(Vec3f));
    }
    EXPECT_EQ(texture.levels.size(), 3u);  // 5 x 3, 2 x 1, 1 x 1
    EXPECT_EQ(bytes, texture_bytes(5, 3));
}

TEST(Texture, SixteenBitsAreEightSpreadAndWhatLiesBetween) {
    Image<Rgba8> eight(256, 1);
    Image<Rgba16> sixteen(256, 1);
    for (int i = 0; i < 256; ++i) {
        eight(i, 0) = {static_cast<std::uint8_t>(i), 0, 255, 255};
        sixteen(i, 0) = {static_cast<std::uint16_t>(257 * i), 0, 65535, 65535};
    }
    const Texture a = make_texture("a", eight.view()), b = make_texture("b", sixteen.view());
    for (std::size_t level = 0; level < a.levels.size(); ++level)
        EXPECT_EQ(a.levels[level].pixels, b.levels.at(level).pixels);
}

TEST_F(SceneBuild, TexturesOfSixteenBitsKeepThem) {
    Image<std::uint16_t> dark(2, 2, 100);
    write("dark.png", encode_png(dark.view()));
    const Scene scene = build(R"(
[[mesh]]
id = "a"
shape = "box"
material = "m"
[material.m]
texture = "dark.png")");
    const Vec3f texel = scene.textures.at(0).levels[0](0, 0);
    // Below 0.04045 an sRGB code is 12.92 times what it stands for.
    EXPECT_FLOAT_EQ(texel.x, 100.0f / 65535.0f / 12.92f);
    EXPECT_EQ(texel.z, texel.x);
    EXPECT_EQ(scene.notes, std::vector<std::string>{});
}

TEST_F(SceneBuild, KeysOfASkyThatDoNothingAreTold) {
    const std::string sun =
        "[[light]]\nid = \"s\"\ntype = \"directional\"\nazimuth_deg = 0\nelevation_deg = 40\n";
    const auto notes = [&](const std::string& sky) { return build(sun + "[sky]\n" + sky).notes; };
    using Notes = std::vector<std::string>;
    EXPECT_EQ(
        notes("model = \"clear\"\nocclusion = false\nbounces = 2\nsamples = 16"),
        (Notes{"sky.bounces does nothing without occlusion", "sky.samples does nothing without occlusion"}));
    EXPECT_EQ(notes("bounces = 1"), (Notes{"sky.bounces does nothing without occlusion"}));
    EXPECT_EQ(notes("model = \"overcast\"\nzenith_w_m2_sr = 1\nturbidity = 3"),
              (Notes{"sky.zenith_w_m2_sr does nothing with model = \"overcast\"",
                     "sky.turbidity does nothing with model = \"overcast\""}));
    EXPECT_EQ(notes("ground_albedo = 0.3"),
              (Notes{"sky.ground_albedo does nothing with model = \"gradient\""}));
    EXPECT_EQ(notes("model = \"clear\"\nbounces = 2\nsamples = 16\nturbidity = 2\nground_albedo = 0.1"),
              Notes{});
    EXPECT_EQ(notes("occlusion = true\nbounces = 0\nhorizon_w_m2_sr = 1"), Notes{});
}

}  // namespace
}  // namespace obscura
