// Frames whose ground is shaded by a day's file: every sample's bit, the picture of exact shadows but at
// edges, with what stands on the ground; the same bits however they are rendered; refused where the file is
// not of this ground or of this sun.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "app/elevation/elevation.h"
#include "app/frame/day_shadow.h"
#include "app/frame/frame_checks.h"
#include "app/frame/load_scene.h"
#include "app/scene/build.h"
#include "core/error.h"
#include "hierarchy/terrain/far_file.h"
#include "raster/heights/height_sweep.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

constexpr int side_x = 70, side_y = 60;

class DayFrame : public testing::Test {
  protected:
    void SetUp() override {
        write("hill.asc", grid_text(0));
        write("other.asc", grid_text(1));
        field = decode_elevation(grid_text(0), "hill.asc", {}, {}).field;
        std::vector<FarSun> suns;
        for (int i = 0; i < 5; ++i) {
            FarSun s{8.0 + i, 1, 70.0 + 37 * i, 12.0 + 4 * i, {}};
            s.direction = height_sun(field, s.azimuth_deg, s.elevation_deg);
            suns.push_back(s);
        }
        const FarDayParams params{4, 64, 3};
        day = make_far_day(field, suns, params, {});
        write_far_file(folder / "hill.far", day, {far_day_hash(field, suns, params), far_file_kind});
    }

    static std::string grid_text(int more) {
        std::string grid = fmt::format("ncols {}\nnrows {}\ncellsize 8\n", side_x, side_y);
        for (int y = 0; y < side_y; ++y) {
            for (int x = 0; x < side_x; ++x) {
                const int tower = std::max(0, 9 - std::max(std::abs(x - 40), std::abs(y - 25)));
                const int ridge = std::max(0, 6 - std::abs(x + y / 3 - 22));
                grid += fmt::format("{} ", 9 * tower + 7 * ridge + (x * 5 + y * 3 + more) % 4);
            }
        }
        return grid;
    }
    static std::string scene_text(int sun, const std::string& shadow, const std::string& more = "") {
        return fmt::format(
            "format = 1\n[camera]\neye_m = [60, 330, 420]\nlook_at_m = [0, 0, 20]\nvfov_deg = 50\n"
            "[render]\nsize_px = [200, 150]\nsamples = 4\n[[terrain]]\nid = \"t\"\nfile = \"hill.asc\"\n"
            "[[light]]\nid = \"sun\"\ntype = \"directional\"\nazimuth_deg = {}\nelevation_deg = {}\n"
            "[shadow.sun]\n{}\n{}",
            70.0 + 37 * sun, 12.0 + 4 * sun, shadow, more);
    }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder / name, std::ios::binary) << bytes;
    }
    Scene load(const std::string& text) const {
        return load_scene(read_scene_text(text, "s.toml", {}), FileAccess{folder, {}});
    }
    template <class Error = InputError>
    std::string error(const std::string& text) const {
        try {
            const SceneDocument document = read_scene_text(text, "s.toml", {});
            const Scene scene = load_scene(document, FileAccess{folder, {}});
            FrameChecks(document, {}).check(scene, 1);
        } catch (const Error& e) {
            return e.what();
        }
        return "no error";
    }

    TemporaryFolder temporary;
    const fs::path folder = temporary.path;
    HeightField field;
    FarDay day;
};

const std::string of_day = "day_file = \"hill.far\"";
const std::string of_picture = "method = \"exact\"";
/// A tower on the ridge, and a roof over the ground.
const std::string objects =
    "[[mesh]]\nid = \"tower\"\nshape = \"box\"\nsize_m = [12, 90, 12]\ntranslate_m = [-90, 60, 60]\n"
    "[[mesh]]\nid = \"roof\"\nshape = \"box\"\nsize_m = [60, 3, 40]\ntranslate_m = [150, 70, 120]\n";

TEST_F(DayFrame, EverySampleHasItsBit) {
    for (int i = 0; i < 5; ++i) {
        const Scene scene = load(scene_text(i, of_day, "[[mesh]]\nid = \"far\"\nshape = \"box\"\n"));
        ASSERT_EQ(scene.lights[0].shadow.method, ShadowMethod::day);
        const SceneTerrain& terrain = scene.terrains.at(0);
        const auto sun = day_sun(scene.days.at("sun").ground, i, {});
        const Vec3d eye = scene.camera.eye;
        const DayLight light = day_light(*sun, terrain, scene.lights[0].light, eye);
        // A mesh that was moved for an eye has other triangles: its points are known by object and place.
        DayLight moved = light;
        moved.object = scene.mesh.object.data();
        moved.own_object = scene.mesh.object[terrain.first_triangle];
        const int whole[] = {0};
        const ShadowBits bits =
            sweep_shadows(field, day.suns[static_cast<std::size_t>(i)].direction, whole)[0];
        std::int64_t dark = 0, asked = 0;
        for (std::uint32_t t = 0; t < terrain.ground_triangles; ++t) {
            const std::uint32_t triangle = terrain.first_triangle + t;
            for (const std::uint32_t v : scene.mesh.triangles[triangle].v) {
                const Vec3d p = to_double(scene.mesh.positions[v]);
                const int x = static_cast<int>(std::floor(p.x / 8 + 0.5 * side_x)),
                          y = static_cast<int>(std::floor(p.z / 8 + 0.5 * side_y));
                ASSERT_EQ(day_dark(light, triangle, to_float(p - eye), {0, 1, 0}), bits(x, y))
                    << "sun " << i << ", sample " << x << ", " << y;
                ASSERT_EQ(day_dark(moved, triangle, to_float(p - eye), {0, 1, 0}), bits(x, y));
                dark += bits(x, y);
                ++asked;
            }
        }
        EXPECT_GT(dark, asked / 20);
        EXPECT_LT(dark, asked / 2);
    }
}

/// Pixels whose shadows differ, and pixels in shadow.
struct Differences {
    int shadow = 0, dark = 0;
};
Differences differences(const Frame& a, const Frame& b) {
    Differences d;
    for (std::size_t i = 0; i < a.shadow.pixels.size(); ++i) {
        d.shadow += a.shadow.pixels[i] != b.shadow.pixels[i];
        d.dark += a.shadow.pixels[i] < 0.5f;
    }
    return d;
}

TEST_F(DayFrame, IsThePictureOfExactShadowsButAtEdges) {
    FrameOptions options;
    options.shadow = true;
    for (const std::string& more : {std::string(), objects}) {
        for (int i = 0; i < 5; ++i) {
            const Frame exact = render_frame(load(scene_text(i, of_picture, more)), options, {});
            const Frame of = render_frame(load(scene_text(i, of_day, more)), options, {});
            const Differences d = differences(exact, of);
            EXPECT_GT(d.dark, 50) << "sun " << i;
            EXPECT_LT(d.shadow, 250) << "sun " << i << (more.empty() ? "" : ", with objects");
            // Whole pixels are wrong next to nowhere.
            int wrong = 0;
            for (std::size_t p = 0; p < exact.shadow.pixels.size(); ++p)
                wrong += std::fabs(exact.shadow.pixels[p] - of.shadow.pixels[p]) > 0.6f;
            EXPECT_LE(wrong, 40) << "sun " << i;
        }
    }
}

TEST_F(DayFrame, ObjectsShadeGroundAndGroundShadesObjects) {
    FrameOptions options;
    options.shadow = true;
    const Frame bare = render_frame(load(scene_text(0, of_day)), options, {});
    const Frame with = render_frame(load(scene_text(0, of_day, objects)), options, {});
    int darker = 0;
    for (std::size_t i = 0; i < bare.shadow.pixels.size(); ++i)
        darker += with.shadow.pixels[i] < bare.shadow.pixels[i];
    EXPECT_GT(darker, 100);
    // A box behind the hill, in its shadow, has no light on it.
    const Scene scene = load(scene_text(0, of_day, objects));
    const auto sun = day_sun(scene.days.at("sun").ground, 0, {});
    const DayLight light = day_light(*sun, scene.terrains[0], scene.lights[0].light, {0, 0, 0});
    const auto last = static_cast<std::uint32_t>(scene.mesh.triangles.size() - 1);
    const std::uint32_t box = scene.terrains[0].first_triangle > 0 ? 0 : last;
    const auto behind = [&](float up) {
        // The hill's top is column 40, row 25; its shadow goes west by south.
        const float away = 90;
        return Vec3f{8 * (40 - 34.5f) - away * 0.94f, up, 8 * (25 - 29.5f) + away * 0.34f};
    };
    EXPECT_TRUE(day_dark(light, box, behind(30), {0, 1, 0}));
    EXPECT_FALSE(day_dark(light, box, behind(90), {0, 1, 0}));
}

TEST_F(DayFrame, SameBitsForThreadsAndInstructionSets) {
    const Scene scene = load(scene_text(1, of_day, objects));
    FrameOptions options;
    options.shadow = true;
    const Frame one = render_frame(scene, options, {Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        const Frame other = render_frame(scene, options, {isa, 3});
        EXPECT_TRUE(std::ranges::equal(other.radiance.pixels, one.radiance.pixels));
        EXPECT_TRUE(std::ranges::equal(other.shadow.pixels, one.shadow.pixels));
    }
}

TEST_F(DayFrame, RefusesOtherGroundOtherSunsAndOtherLights) {
    const std::string other = scene_text(0, of_day);
    const auto replaced = [](std::string s, const std::string& a, const std::string& b) {
        return s.replace(s.find(a), a.size(), b);
    };
    EXPECT_NE(error(replaced(other, "hill.asc", "other.asc")).find("has the shadows of other ground"),
              std::string::npos);
    EXPECT_NE(
        error(replaced(other, "file = \"hill.asc\"", "file = \"hill.asc\"\nvertical_exaggeration = 1.001"))
            .find("has the shadows of other ground"),
        std::string::npos);
    const std::string off = error(replaced(other, "azimuth_deg = 70", "azimuth_deg = 70.5"));
    EXPECT_NE(off.find("of 08:00:00"), std::string::npos) << off;
    EXPECT_NE(off.find("0.4891 degrees away"), std::string::npos) << off;
    EXPECT_EQ(error(replaced(replaced(other, "azimuth_deg = 70", "azimuth_deg = 70.5"), of_day,
                             of_day + "\nmax_sun_deg = 0.6")),
              "no error");
    EXPECT_NE(error(replaced(other, "hill.far", "none.far")).find("none.far"), std::string::npos);
    EXPECT_NE(error(replaced(other, "hill.far", "hill.asc")).find("is not a file of far shadows"),
              std::string::npos);
    EXPECT_NE(error(scene_text(0, "method = \"day\"")).find("needs 'day_file'"), std::string::npos);
    EXPECT_NE(error(scene_text(0, "method = \"exact\"\n" + of_day)).find("'day_file' needs method = \"day\""),
              std::string::npos);
    EXPECT_NE(error(scene_text(0, of_day + "\nresolution = 1024")).find("'resolution' needs"),
              std::string::npos);
    EXPECT_NE(error(replaced(other, "file = \"hill.asc\"", "file = \"hill.asc\"\ncasts_shadow = false"))
                  .find("casts no shadow"),
              std::string::npos);
    EXPECT_NE(error(replaced(replaced(replaced(other, "\"directional\"", "\"point\""), "azimuth_deg = 70",
                                      "position_m = [0, 300, 0]\nintensity_w_sr = [9, 9, 9]"),
                             "elevation_deg = 12", ""))
                  .find("a day's shadows are a sun's"),
              std::string::npos);
    // A file that is altered is refused when it is decoded, or before.
    std::string bytes;
    {
        std::ifstream in(folder / "hill.far", std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    bytes.back() = static_cast<char>(bytes.back() ^ 4);
    write("hill.far", bytes);
    EXPECT_THROW(render_frame(load(scene_text(4, of_day)), {}, {}), InputError);
}

}  // namespace
}  // namespace obscura
