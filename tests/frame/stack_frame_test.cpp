// Frames whose lights with a size have stacks: the pictures of as many lights without but at edges, the same
// bits however they are rendered, kept, in files, refused.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/frame/load_scene.h"
#include "app/frame/memory.h"
#include "app/frame/shadow_cache.h"
#include "app/frame/shadows.h"
#include "app/frame/stack_shadow.h"
#include "app/frame/stack_tile.h"
#include "core/error.h"
#include "raster/light_samples.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

SceneLight stacked(SceneLight light, int samples, int resolution) {
    light.shadow = {};
    light.shadow.method = ShadowMethod::stack;
    light.shadow.samples = samples;
    light.shadow.resolution = resolution;
    return light;
}

SceneLight exact(SceneLight light) {
    light.shadow.method = ShadowMethod::exact;
    return light;
}

SceneLight area_lamp(AreaShape shape) {
    SceneLight lamp = at_point(LightKind::area, {1, 5, 2}, {-0.2, -1, -0.3}, {20, 19, 17});
    lamp.light.across = normalize(cross(lamp.light.direction, Vec3d{0, 0, 1}));
    lamp.light.shape = shape;
    lamp.light.width_m = 1.0;
    lamp.light.height_m = 0.6;
    return lamp;
}

/// Solids, sheets, leaves and metal under lights with a size of every kind.
Scene stacked_everything(int samples, int points, int resolution) {
    Scene scene = everything(samples);
    scene.lights[0].light.angular_diameter_deg = 4;
    scene.lights[1].light.radius_m = 0.15;
    scene.lights[1].light.position = {-1.5, 5, 2};
    scene.lights[2].light.radius_m = 0.3;
    scene.lights.push_back(area_lamp(AreaShape::rectangle));
    scene.lights.push_back(area_lamp(AreaShape::disc));
    scene.lights[4].light.position = {-2, 4, -1};
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        scene.lights[i].light.id = std::string(1, static_cast<char>('a' + i));
        scene.lights[i] = stacked(scene.lights[i], points, resolution);
    }
    return scene;
}

double mean_difference(const Frame& a, const Frame& b) {
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < a.radiance.pixels.size(); ++i) {
        const Vec3f p = a.radiance.pixels[i], q = b.radiance.pixels[i];
        sum += static_cast<double>(std::fabs(p.x - q.x) + std::fabs(p.y - q.y) + std::fabs(p.z - q.z));
        all += static_cast<double>(p.x + p.y + p.z);
    }
    return sum / all;
}

/// Pairs of a pixel and a point of the light that differ, of all: the shadow channel counts points. Only
/// where light may come to: beside a spot's cone there are shadows of nothing.
double differing_pairs(const Frame& a, const Frame& b, const Frame& unshadowed) {
    double sum = 0;
    for (std::size_t i = 0; i < a.shadow.pixels.size(); ++i)
        if (unshadowed.radiance.pixels[i].y > 0)
            sum += static_cast<double>(std::fabs(a.shadow.pixels[i] - b.shadow.pixels[i]));
    return sum / static_cast<double>(a.shadow.pixels.size());
}

/// With one sample a pixel both ways ask all points. What differs is near an edge: half as much with texels
/// of half the side, and little.
TEST(StackFrame, PicturesAreThoseOfAsManyLightsButAtEdges) {
    FrameOptions options;
    options.shadow = true;
    for (std::size_t l = 0; l < 5; ++l) {
        Scene scene = stacked_everything(1, 16, 0);
        scene.lights = {scene.lights[l]};
        scene.sky.ambient = 0;
        scene.sky.visible = false;
        Scene reference = scene;
        reference.lights[0].shadow.method = ShadowMethod::none;
        const Frame unshadowed = render_frame(reference);
        reference.lights[0] = exact(reference.lights[0]);
        const Frame expected = render_frame(reference, options);
        double coarse = 0;
        for (const int resolution : {256, 2048}) {
            scene.lights[0].shadow.resolution = resolution;
            const Frame frame = render_frame(scene, options);
            const double differ = differing_pairs(frame, expected, unshadowed),
                         mean = mean_difference(frame, expected);
            if (resolution == 256) {
                coarse = differ;
                continue;
            }
            EXPECT_LT(differ, 0.0015) << "light " << l;
            EXPECT_LT(differ, coarse / 2) << "light " << l;
            EXPECT_LT(mean, 0.003) << "light " << l;
            EXPECT_EQ(frame.stats.lights[0].samples, 16);
            EXPECT_GT(frame.stats.lights[0].bytes, 1000u);
        }
    }
}

TEST(StackFrame, SamePictureOnEveryIsaThreadCountAndCrop) {
    for (const int samples : {1, 4}) {
        Scene scene = stacked_everything(samples, 16, 128);
        scene.render.width = 90;
        scene.render.height = 70;
        expect_one_picture(scene, {17, 11, 60, 43});
    }
}

TEST(StackFrame, AutoResolutionFollowsThePicture) {
    Scene scene = stacked_everything(1, 4, auto_resolution);
    scene.lights = {scene.lights[0]};
    scene.render.width = 40;
    scene.render.height = 26;
    scene.lights[0].shadow.max_magnification = 20;
    const Frame small = render_frame(scene);
    scene.render.width = 320;
    scene.render.height = 208;
    const Frame large = render_frame(scene);
    EXPECT_GT(small.stats.lights[0].resolution, least_map_resolution);
    EXPECT_GT(large.stats.lights[0].resolution, small.stats.lights[0].resolution);
    EXPECT_LE(large.stats.lights[0].resolution, most_auto_stack_resolution);
}

TEST(StackFrame, KeptWhileTheLightStands) {
    Scene scene = stacked_everything(1, 4, 64);
    FrameCache cache;
    Frame frame;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 5 * 4);
    scene.camera.eye = {-3, 2, 5};
    scene.lights[1].light.color = {1, 2, 3};
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 0);
    for (const LightShadowStats& s : frame.stats.lights)
        EXPECT_TRUE(s.kept);
    EXPECT_EQ(hash(frame), hash(render_frame(scene)));
    scene.lights[0].light.direction = normalize(Vec3d{0.1, -1, 0.2});
    scene.lights[3].light.width_m = 0.5;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 2 * 4);
    EXPECT_EQ(hash(frame), hash(render_frame(scene)));
}

class StackCache : public testing::Test {
  protected:
    StackCache() {
        folder = testing::TempDir() + "obscura_stacks_" + std::to_string(getpid());
        std::filesystem::create_directories(folder);
        scene.lights = {scene.lights[3]};
        scene.lights[0].shadow.cache = "cache";
        expected = hash(rendered());
    }
    ~StackCache() override { std::filesystem::remove_all(folder); }

    /// By a program that has just begun.
    Frame rendered() const {
        FrameCache cache;
        cache.access.root = folder;
        Frame frame;
        render_frame(scene, {}, {}, cache, frame);
        return frame;
    }
    std::filesystem::path file() const { return folder / "cache" / "d.shadowstack"; }

    std::filesystem::path folder;
    Scene scene = stacked_everything(1, 16, 64);
    std::uint64_t expected = 0;
};

TEST_F(StackCache, IsReadAgain) {
    ASSERT_TRUE(std::filesystem::exists(file()));
    const Frame again = rendered();
    EXPECT_TRUE(again.stats.lights[0].from_cache);
    EXPECT_EQ(again.stats.shadow_maps, 0);
    EXPECT_TRUE(again.stats.notices.empty());
    EXPECT_EQ(hash(again), expected);
    scene.lights[0].light.color = {1, 1, 1};
    EXPECT_TRUE(rendered().stats.lights[0].from_cache) << "its colour does not matter";
}

TEST_F(StackCache, IsMadeAgainWhenAlteredOrOfAnotherScene) {
    const auto is_made_again = [&](const char* notice) {
        const Frame frame = rendered();
        EXPECT_FALSE(frame.stats.lights[0].from_cache) << notice;
        ASSERT_EQ(frame.stats.notices.size(), 1u) << notice;
        EXPECT_NE(frame.stats.notices[0].find(notice), std::string::npos) << frame.stats.notices[0];
        EXPECT_TRUE(rendered().stats.lights[0].from_cache) << notice;
    };
    for (const double share : {0.1, 0.5, 0.9}) {
        const auto bytes = static_cast<double>(std::filesystem::file_size(file()));
        std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(static_cast<std::streamoff>(bytes * share));
        const int c = stream.get();
        stream.seekp(static_cast<std::streamoff>(bytes * share));
        stream.put(static_cast<char>(c ^ 4));
        stream.close();
        is_made_again("is damaged");
        EXPECT_EQ(hash(rendered()), expected);
    }
    std::filesystem::resize_file(file(), 1000);
    is_made_again("cut short");
    for (Vec3f& p : scene.mesh.positions)
        p.x += 0.01f;
    is_made_again("another scene");
    scene.lights[0].light.height_m = 0.7;
    is_made_again("another scene");
    scene.lights[0].shadow.samples = 4;
    is_made_again("another scene");
}

std::string refusal_of(const Mesh& mesh, const SceneLight& light) {
    try {
        plan_stack(mesh, light);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(StackPlan, LightsInsideWhatTheyLightHaveNone) {
    // A closed room, 4 m wide and 3 m high.
    Scene room = empty_scene(8, 8);
    add(room, box({4, 3, 4}), 0, {0, 1.5f, 0});
    SceneLight lamp = stacked(at_point(LightKind::point, {0, 1.6, 0}, {0, -1, 0}, {1, 1, 1}), 16, 64);
    lamp.light.radius_m = 0.1;
    EXPECT_NE(refusal_of(room.mesh, lamp).find("stands inside what it shines on"), std::string::npos);
    lamp.light.kind = LightKind::area;
    lamp.light.two_sided = true;
    EXPECT_NE(refusal_of(room.mesh, lamp), "");
    // Down from the ceiling, or in its cone, it sees all that it lights.
    lamp.light.two_sided = false;
    lamp.light.position = {0, 2.9, 0};
    EXPECT_EQ(refusal_of(room.mesh, lamp), "");
    lamp.light.kind = LightKind::spot;
    EXPECT_EQ(refusal_of(room.mesh, lamp), "");
    // The sun always does.
    SceneLight sun = stacked(directional({-1, -0.001, 0}, {1, 1, 1}), 16, 64);
    sun.light.angular_diameter_deg = 1;
    EXPECT_EQ(refusal_of(room.mesh, sun), "");
}

TEST(StackPlan, LevelForTownsFacingForSingleThings) {
    SceneLight sun = stacked(directional({-0.4, -1, 0.3}, {1, 1, 1}), 16, 64);
    sun.light.angular_diameter_deg = 1;
    Scene town = empty_scene(8, 8);
    add(town, plane(200, 200), 0);
    for (int i = 0; i < 9; ++i)
        add(town, box({4, 6, 4}), 0, {-40.0f + 10.0f * static_cast<float>(i), 3, 0});
    EXPECT_EQ(plan_stack(town.mesh, sun).focus.plane_normal, (Vec3d{0, 1, 0}));
    EXPECT_NEAR(plan_stack(town.mesh, sun).focus.plane_point.y, 0, 1e-9);
    Scene pole = empty_scene(8, 8);
    add(pole, box({1, 60, 1}), 0, {0, 30, 0});
    sun.light.direction = normalize(Vec3d{-1, -0.1, 0});
    EXPECT_NE(plan_stack(pole.mesh, sun).focus.plane_normal, (Vec3d{0, 1, 0}));
}

TEST(StackPlan, AsksThePointsThatExactAsksAndLosesNoLight) {
    const Scene scene = stacked_everything(1, 64, 64);
    for (const SceneLight& light : scene.lights) {
        const StackPlan plan = plan_stack(scene.mesh, light);
        std::vector<Light> points = light_samples(light.light, 64);
        ASSERT_EQ(plan.points.size(), points.size());
        double steps = 0, shuffled = 0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            EXPECT_EQ(std::count(plan.points.begin(), plan.points.end(), points[k]), 1);
            if (k == 0) continue;
            const auto way = [](const Light& a, const Light& b) {
                return length(a.position - b.position) + length(a.direction - b.direction);
            };
            steps += way(plan.points[k], plan.points[k - 1]);
            shuffled += way(points[k], points[k - 1]);
        }
        EXPECT_LT(steps, 0.7 * shuffled) << light.light.id << ": neighbours follow one another";
        for (const std::size_t parts : {1, 16, 64}) {
            Vec3f color{};
            double share = 0;
            for (const Light& part : stack_parts(plan.points, parts)) {
                color = color + part.color;
                share += part.part;
            }
            if (light.light.kind == LightKind::area) {
                EXPECT_NEAR(share, 1, 1e-12);
            } else {
                Vec3f all{};
                for (const Light& point : points)
                    all = all + point.color;
                EXPECT_NEAR(color.x, all.x, 1e-4 * static_cast<double>(all.x));
            }
        }
    }
}

TEST(StackFrame, MemoryIsHeldToTheLimit) {
    Scene scene = stacked_everything(1, 64, 1024);
    scene.lights = {scene.lights[0]};
    scene.lights[0].light.angular_diameter_deg = 40;
    try {
        Limits limits;
        limits.memory_mib = 8;
        check_memory(estimate_memory(scene), limits, "s");
        ADD_FAILURE() << "the frame fits into 8 MiB";
    } catch (const LimitError& error) {
        EXPECT_NE(std::string(error.what()).find("of it: lower their samples or resolution"),
                  std::string::npos)
            << error.what();
    }
    LightShadow shadow;
    shadow.light = scene.lights[0];
    const StackPlan plan = plan_stack(scene.mesh, shadow.light);
    const FocusedViews views = stack_views(scene.mesh, plan, 1024);
    try {
        build_light_stack(scene.mesh, views, {}, std::int64_t{1} << 20, shadow, nullptr);
        ADD_FAILURE() << "a stack of more than 1 MiB was built";
    } catch (const LimitError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("light 'a', 64 maps of 1024 x 1024 texels"), std::string::npos) << text;
        EXPECT_NE(text.find("lower its samples or its resolution, or use method = \"exact\""),
                  std::string::npos)
            << text;
    }
}

/// The same counts as maps asked one by one, where a block's samples are told apart from their neighbours.
TEST(StackFrame, ABlockCountsWhatSingleLookupsSay) {
    Scene scene = stacked_everything(1, 64, 256);
    scene.lights = {scene.lights[3]};
    FrameCache cache;
    FrameStats stats;
    prepare_scene(scene, {}, cache, stats);
    TileScene tiles = prepare_tiles(scene, {}, cache);
    prepare_shadows(scene, 0, {}, cache, tiles, stats);
    ASSERT_TRUE(tiles.lights[0].stack.has_value());
    const StackLight& light = *tiles.lights[0].stack;
    ASSERT_EQ(light.parts.size(), 64u);
    std::vector<std::uint16_t> lit(light.parts.size() * block_samples);
    auto work = std::make_unique<TileWork>();
    int partly = 0;
    for (std::size_t tile = 0; tile < tiles.bins->tiles(); ++tile) {
        walk_blocks(tiles, tile, tiles.pattern[0], best_isa(), *work, [&](const TileRect&, int) {
            const SurfaceBlock& s = work->surface;
            stack_block(light, s, best_isa(), lit.data());
            for (int i = 0; i < block_samples; ++i) {
                if ((s.covered[i / 16] >> (i % 16) & 1u) == 0 || (s.thin[i / 16] >> (i % 16) & 1u) != 0)
                    continue;
                const std::uint16_t pattern = 0;
                const StackPoints point{s.px + i, s.py + i, s.pz + i, s.gx + i,
                                        s.gy + i, s.gz + i, &pattern, 1};
                std::uint16_t one_by_one = 0;
                StackWork counted;
                ref::lit_of_subset(light.lookup, point, 64, &one_by_one, counted);
                int sum = 0;
                for (std::size_t part = 0; part < 64; ++part)
                    sum += lit[part * block_samples + static_cast<std::size_t>(i)];
                ASSERT_EQ(sum, one_by_one);
                partly += sum > 0 && sum < 64;
            }
        });
    }
    EXPECT_GT(partly, 500);
}

}  // namespace
}  // namespace obscura
