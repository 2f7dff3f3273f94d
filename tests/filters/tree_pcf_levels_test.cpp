// Hierarchical filtering: each level is the map that descents stopped there see, the blend lies between two
// of them, lit planes do not shade themselves, and pictures of fine detail far away stand still.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <tuple>

#include "app/frame/scene_light.h"
#include "filters/tree_pcf.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "raster/depth_tile.h"
#include "raster/view.h"
#include "scenes/generators.h"
#include "tests/filters/tree_pcf_samples.h"
#include "tests/frame/scenes.h"
#include "tests/hierarchy/code_cases.h"
#include "tests/hierarchy/tree_oracle.h"

namespace obscura {
namespace {

using Visibility = std::vector<float>;

Visibility visibility_of(const std::vector<SurfaceBlock>& blocks, const PcfLight& light, Isa isa) {
    Visibility v(blocks.size() * block_samples);
    for (std::size_t b = 0; b < blocks.size(); ++b)
        OBSCURA_DISPATCH(isa, pcf_block, blocks[b], light, v.data() + b * block_samples);
    return v;
}

void expect_same_bits(const Visibility& a, const Visibility& b, const std::string& what) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(a[i]), std::bit_cast<std::uint32_t>(b[i]))
            << what << ", sample " << i << ": " << a[i] << " and " << b[i];
    }
}

/// A camera that looks straight down, each pixel `texels` wide on the map of chosen::light_above().
CameraRays camera_above(double texels) {
    CameraRays rays{};
    rays.dir0[2] = -1;
    rays.origin_x[0] = texels;
    rays.origin_y[1] = 0.5 * texels;
    return rays;
}

class Levels : public testing::TestWithParam<std::tuple<int, CodeCase>> {};

TEST_P(Levels, AreTheMapsOfDescentsThatStopThere) {
    constexpr int size = 64, levels = 6;
    const int side = std::get<0>(GetParam()), squares = std::max(side - 1, 1);
    const MultiresTree built = build_bottom_up(chosen::patchy_intervals(size, 5).view());
    const ShadowTree code = encode_tree(built, {}, params_of(std::get<1>(GetParam())));
    const MultiresTree tree = tree_behind(code, built);
    const std::vector<SurfaceBlock> blocks = chosen::blocks_at(chosen::places_everywhere(size, 3), 0, 4);
    Visibility finer;
    int differing = 0;
    // Dense maps are no smaller than 4 x 4.
    for (int level = 0; level <= levels - 2; ++level) {
        PcfLight dense = chosen::light_above(size >> level, side, true);
        const StoredDepths map = chosen::dense(size >> level, [&](int x, int y) {
            return value_at_level(tree, static_cast<std::uint32_t>(x) << level,
                                  static_cast<std::uint32_t>(y) << level, level);
        });
        dense.view[0].stored = map.depth.data();
        dense.view[0].to_map[0][0] = dense.view[0].to_map[1][1] = 1.0 / (1 << level);
        const Visibility expected = visibility_of(blocks, dense, Isa::ref);

        PcfLight light = chosen::light_above(size, side, true);
        light.view[0].tree = &code.code;
        filter_hierarchically(light, camera_above(squares * (1 << level)));
        for (const Isa isa : supported_isas())
            expect_same_bits(visibility_of(blocks, light, isa), expected, std::string(isa_name(isa)));

        // Half way from the level before.
        if (level > 0) {
            filter_hierarchically(light, camera_above(1.5 * squares * (1 << (level - 1))));
            Visibility half = finer;
            for (std::size_t i = 0; i < half.size(); ++i) {
                half[i] = finer[i] + (expected[i] - finer[i]) * 0.5f;
                differing += finer[i] != expected[i];
            }
            for (const Isa isa : supported_isas())
                expect_same_bits(visibility_of(blocks, light, isa), half, std::string(isa_name(isa)));
        }
        finer = expected;
    }
    EXPECT_GT(differing, 200) << "the two samples of the blend must be two";
}
INSTANTIATE_TEST_SUITE_P(Kernels, Levels,
                         testing::Combine(testing::Values(1, 3, 5), testing::ValuesIn(code_cases)),
                         [](const auto& one) {
                             return std::to_string(std::get<0>(one.param)) + "_" +
                                    std::get<1>(one.param).name;
                         });

TEST(TreePcfLevels, ReachTheRootAndGoNoFurther) {
    const MultiresTree tree = build_bottom_up(chosen::patchy_intervals(16, 5).view());
    const ShadowTree code = encode_tree(tree, {});
    const std::vector<SurfaceBlock> blocks = chosen::blocks_at({{8, 8, 0.1f}, {3, 9, 0.99f}}, 0, 4);
    for (const bool parallel : {true, false}) {
        PcfLight light = chosen::light_above(16, 3, parallel);
        light.view[0].tree = &code.code;
        Visibility largest;
        for (const double footprint : {32.0, 33.0, 1e6, 1e30}) {
            filter_hierarchically(light, camera_above(footprint));
            for (const Isa isa : supported_isas()) {
                const Visibility v = visibility_of(blocks, light, isa);
                if (largest.empty()) largest = v;
                expect_same_bits(v, largest, std::string(isa_name(isa)));
            }
        }
        EXPECT_EQ(largest[0], 1.0f);
        EXPECT_LT(largest[1], 1.0f);
    }
}

TEST(TreePcfLevels, EveryOddSideAndMixedFootprintsAreTheSameOnEveryIsa) {
    const MultiresTree tree = build_bottom_up(chosen::patchy_intervals(64, 8).view());
    const ShadowTree trees[] = {encode_tree(tree, {}, {TreeLayout::bytes16, 2}),
                                encode_tree(tree, {}, params_of(code_cases[3], 2)),
                                encode_tree(tree, {}, params_of(code_cases[5], 2))};
    ASSERT_EQ(trees[1].code.code, ShadowCode::mmh);
    ASSERT_EQ(trees[2].code.code, ShadowCode::dag);
    std::vector<SurfaceBlock> blocks = chosen::blocks_at(chosen::places_everywhere(64, 3), 0.03f, 4);
    std::mt19937 rng(3);
    for (SurfaceBlock& b : blocks) {
        for (float& depth : b.depth)
            depth = -1.0f / static_cast<float>(1 + rng() % 40);
    }
    for (const int side : {1, 3, 5, 7, 15}) {
        for (const ShadowTree& encoded : trees) {
            PcfLight light = chosen::light_above(64, side, encoded.code.code != ShadowCode::mh);
            light.view[0].tree = &encoded.code;
            CameraRays rays = camera_above(0);
            // Distances vary from lane to lane, and with them the levels.
            rays.perspective = true;
            rays.z_scale = -1;
            rays.dir_x[0] = rays.dir_y[1] = 0.7;
            filter_hierarchically(light, rays);
            const Visibility expected = visibility_of(blocks, light, Isa::ref);
            EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](float f) { return f > 0 && f < 1; }),
                      50);
            for (const Isa isa : supported_isas())
                expect_same_bits(visibility_of(blocks, light, isa), expected, std::string(isa_name(isa)));
        }
    }
}

// --- scenes ------------------------------------------------------------------------------------------------

/// A scene ready for the surfaces of its pixels.
class Picture {
  public:
    explicit Picture(const Scene& scene) : scene_(scene) {
        FrameStats stats;
        prepare_scene(scene, Exec{}, cache_, stats);
        tiles_ = prepare_tiles(scene, Exec{}, cache_);
    }
    /// Of samples that lie so in their pixels.
    std::vector<SurfaceBlock> surfaces(SamplePosition sample) {
        std::vector<SurfaceBlock> blocks;
        for (int row = 0; row * frame_tile_side < scene_.render.height; ++row) {
            for (int column = 0; column * frame_tile_side < scene_.render.width; ++column) {
                const TileRect tile = tile_visibility(tiles_, column, row, sample, best_isa(), *work_);
                for (int y = 0; y < frame_tile_side; y += block_rows) {
                    block_surface(tiles_, tile, y, best_isa(), *work_);
                    blocks.push_back(work_->surface);
                }
            }
        }
        return blocks;
    }

  private:
    const Scene& scene_;
    FrameCache cache_;
    TileScene tiles_;
    std::unique_ptr<TileWork> work_ = std::make_unique<TileWork>();
};

ShadowTree tree_of(const Scene& scene, int resolution) {
    SceneLight light = scene.lights[0];
    light.shadow.resolution = resolution;
    const LightView view = shadow_views(light, bounds_of(scene.mesh))[0];
    return encode_tree(build_shadow_tree(scene.mesh, view, {}, Exec{}), view);
}

CameraRays rays_of(const Scene& scene) {
    return camera_rays(scene.camera, scene.render.width, scene.render.height);
}

/// A closed slab 1 cm thick under a low sun, seen from far enough away that pixels span many texels.
Scene slab_from(double distance_m) {
    Scene scene = frame_scenes::empty_scene(64, 64);
    scene.render.samples = 4;  // samples lie anywhere in pixels
    frame_scenes::add(scene, box({-15, -0.01, -15}, {15, 0, 15}), 0);
    scene.camera.vfov_deg = 20;
    scene.camera.eye = {0.3 * distance_m, 0.6 * distance_m, 0.7 * distance_m};
    scene.camera.look_at = {0, 0, 0};
    SceneLight sun = frame_scenes::directional({0.7, -0.25, 0.4}, {1, 1, 1}, 3, 1024);
    sun.shadow.method = ShadowMethod::none;
    scene.lights.push_back(sun);
    return scene;
}

TEST(TreePcfLevels, FootprintsAreTheWayToTheNeighbourPixelOnTheMap) {
    const Scene scene = slab_from(40);
    const std::vector<SurfaceBlock> blocks = Picture(scene).surfaces({});
    const ShadowTree tree = tree_of(scene, 1024);
    PcfLight light = pcf_light(scene.lights[0], std::span(&tree, 1), scene.camera.eye);
    filter_hierarchically(light, rays_of(scene));
    int compared = 0;
    for (const SurfaceBlock& b : blocks) {
        for (int at = 0; at < block_samples - frame_tile_side; ++at) {
            if (at % 64 == 63 || b.triangle[at] == no_triangle) continue;
            if (b.gy[at] < 0.9f || b.gy[at + 1] < 0.9f || b.gy[at + 64] < 0.9f) continue;
            const ref::PcfPlace here = ref::pcf_place(b, light, at), right = ref::pcf_place(b, light, at + 1),
                                down = ref::pcf_place(b, light, at + 64);
            if (!right.asks() || !down.asks()) continue;
            const double way = std::max(std::hypot(right.X - here.X, right.Y - here.Y),
                                        std::hypot(down.X - here.X, down.Y - here.Y));
            ASSERT_NEAR(2.0 * static_cast<double>(here.tap_texels) / way, 1.0, 0.03);
            ASSERT_GT(here.tap_texels, 1.1f);
            ++compared;
        }
    }
    EXPECT_GT(compared, 500);
}

TEST(TreePcfLevels, ALitPlaneDoesNotShadeItselfAtAnyLevel) {
    std::vector<int> asked(11, 0), saved(11, 0);
    for (const double distance : {30.0, 80.0, 200.0, 500.0, 1500.0}) {
        const Scene scene = slab_from(distance);
        const ShadowTree tree = tree_of(scene, 1024);
        PcfLight light = pcf_light(scene.lights[0], std::span(&tree, 1), scene.camera.eye);
        filter_hierarchically(light, rays_of(scene));
        for (const SurfaceBlock& b : Picture(scene).surfaces({40, 200})) {
            for (int at = 0; at < block_samples; ++at) {
                if (b.triangle[at] == no_triangle || b.gy[at] < 0.9f) continue;
                const ref::PcfTrace trace = ref::trace_pcf(b, light, at);
                const ref::PcfPlace place = ref::pcf_place(b, light, at);
                ASSERT_EQ(trace.visibility, 1.0f)
                    << "squares of " << place.tap_texels << " at " << place.X << ", " << place.Y;
                for (const ref::PcfTap& tap : trace.taps) {
                    const float bias = (std::fabs(place.slope_x) + std::fabs(place.slope_y)) * 0.5f *
                                       static_cast<float>((1 << tap.level) - 1);
                    const auto level = static_cast<std::size_t>(tap.level);
                    ++asked[level];
                    saved[level] += tap.inside && tap.receiver + bias > tap.stored;
                }
            }
        }
    }
    // The bias is needed: without it taps at coarse levels would be dark.
    for (std::size_t level = 0; level < 8; ++level)
        EXPECT_GT(asked[level], 0) << level;
    EXPECT_EQ(saved[0], 0);
    EXPECT_GT(saved[3] + saved[4] + saved[5], 100);
}

/// Iron fences on a slab, 0.13 m from bar to bar, in pixels of about half a metre.
Scene distant_fences() {
    Scene scene = frame_scenes::empty_scene(192, 64);
    scene.render.samples = 4;
    frame_scenes::add(scene, box({-30, -0.5, -12}, {30, 0, 12}), 0);
    FenceParams params;
    params.length_m = 50;
    params.bar_radius_m = 0.025;
    for (const float z : {-8.0f, -3.0f, 2.0f, 7.0f})
        frame_scenes::add(scene, fence(params).mesh, 0, {0, 0, z});
    scene.mesh.uvs.clear();
    scene.camera.eye = {12, 60, 150};
    scene.camera.look_at = {0, 0, 0};
    scene.camera.vfov_deg = 9;
    SceneLight sun = frame_scenes::directional({0.35, -0.8, -0.5}, {1, 1, 1}, 3, 8192);
    sun.shadow.method = ShadowMethod::none;
    scene.lights.push_back(sun);
    return scene;
}

/// Of samples that see the ground in both: the slab's triangles are the first in the mesh.
double mean_difference(const std::vector<SurfaceBlock>& a, const std::vector<SurfaceBlock>& b,
                       const Visibility& va, const Visibility& vb) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < va.size(); ++i) {
        const auto at = i % block_samples;
        if (a[i / block_samples].triangle[at] >= 12 || b[i / block_samples].triangle[at] >= 12) continue;
        sum += std::fabs(static_cast<double>(va[i]) - static_cast<double>(vb[i]));
        ++count;
    }
    EXPECT_GT(count, 1500u);
    return sum / static_cast<double>(count);
}

/// Visibility of whole pixels: the mean of 8 x 8 samples of each, without hierarchy.
Visibility true_means(Picture& picture, const PcfLight& plain, std::int32_t shift) {
    Visibility mean;
    for (std::int32_t k = 0; k < 64; ++k) {
        const SamplePosition at{shift + k % 8 * 32 + 16, k / 8 * 32 + 16};
        const Visibility v = visibility_of(picture.surfaces(at), plain, best_isa());
        mean.resize(v.size(), 0.0f);
        for (std::size_t i = 0; i < v.size(); ++i)
            mean[i] += v[i] / 64.0f;
    }
    return mean;
}

TEST(TreePcfLevels, ADistantFenceDoesNotShimmerWhenTheCameraMovesHalfAPixel) {
    const Scene scene = distant_fences();
    const ShadowTree tree = tree_of(scene, 8192);
    Picture picture(scene);
    const std::vector<SurfaceBlock> before = picture.surfaces({64, 128}),
                                    after = picture.surfaces({192, 128});
    PcfLight light = pcf_light(scene.lights[0], std::span(&tree, 1), scene.camera.eye);
    const Visibility plain = visibility_of(before, light, best_isa());
    const double plain_change =
        mean_difference(before, after, plain, visibility_of(after, light, best_isa()));
    const Visibility truth = true_means(picture, light, -64);
    const double plain_error = mean_difference(before, before, plain, truth);
    EXPECT_GT(plain_change, 0.015);
    filter_hierarchically(light, rays_of(scene));
    double coarser_error = plain_error;
    for (const int side : {1, 3, 5, 9, 15}) {
        light.side = side;
        const Visibility v = visibility_of(before, light, best_isa());
        EXPECT_LT(mean_difference(before, after, v, visibility_of(after, light, best_isa())),
                  0.25 * plain_change)
            << "side " << side;
        // Squares answer as most of their texels do: the more squares a pixel has, the nearer to its mean.
        const double error = mean_difference(before, before, v, truth);
        EXPECT_LT(error, coarser_error) << "side " << side;
        coarser_error = error;
    }
    EXPECT_LT(coarser_error, 0.6 * plain_error);
}

}  // namespace
}  // namespace obscura
