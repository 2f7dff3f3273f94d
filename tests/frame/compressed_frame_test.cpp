// Frames with compressed shadows: the resolution that a picture asks for, what of a map it builds, what is
// kept.

#include <gtest/gtest.h>

#include <cmath>

#include "app/frame/needed_texels.h"
#include "app/frame/shadow_resolution.h"
#include "app/frame/shadows.h"
#include "app/frame/tree_shadow.h"
#include "core/error.h"
#include "filters/shadow_lookup.h"
#include "raster/interval_map.h"
#include "tests/frame/stage.h"

namespace obscura {
namespace {

using namespace frame_scenes;

Vec3d ray_origin(const CameraRays& r, double x, double y) {
    const auto at = [&](int k) { return r.origin0[k] + x * r.origin_x[k] + y * r.origin_y[k] + r.eye[k]; };
    return {at(0), at(1), at(2)};
}
Vec3d ray_direction(const CameraRays& r, double x, double y) {
    const auto at = [&](int k) { return r.dir0[k] + x * r.dir_x[k] + y * r.dir_y[k]; };
    return {at(0), at(1), at(2)};
}

/// Pixels that a texel spans, by moving the ray a hundredth of a pixel in all directions; 0 off the map.
double magnification_by_rays(const CameraRays& rays, const LightView& view, Vec3d p, Vec3d n, double x,
                             double y) {
    const auto on_map = [&](double X, double Y) {
        const Vec3d o = ray_origin(rays, X, Y), d = ray_direction(rays, X, Y);
        return to_map_space(view, o + d * (dot(n, p - o) / dot(n, d)));
    };
    const Vec3d c = on_map(x, y);
    if (c.x < 0 || c.y < 0 || c.x >= view.width || c.y >= view.height) return 0;
    constexpr double step = 0.01;
    double least = 1e300;
    for (int k = 0; k < 720; ++k) {
        const double a = k * num::pi / 720;
        const Vec3d q = on_map(x + step * num::cos(a), y + step * num::sin(a));
        least = std::min(least, std::hypot(q.x - c.x, q.y - c.y) / step);
    }
    return 1 / least;
}

struct Case {
    LightKind kind;
    bool orthographic;
    double most;
};

class AutoResolution : public testing::TestWithParam<Case> {};

TEST_P(AutoResolution, IsTheLeastAtWhichNoPixelIsMagnifiedMore) {
    Scene scene = staged(GetParam().kind, GetParam().orthographic);
    SceneLight& light = scene.lights[0];
    light.shadow.max_magnification = GetParam().most;
    const Stage stage(scene);
    const auto found = auto_resolutions(scene, stage.tiles, {});
    ASSERT_TRUE(found[0]);
    ASSERT_FALSE(found[0]->capped);
    ASSERT_GT(found[0]->resolution, least_map_resolution);
    const Bounds casters = caster_box(scene.mesh, light.light.direction);
    const auto views = fitted_shadow_views(light, casters, found[0]->resolution),
               coarser = fitted_shadow_views(light, casters, found[0]->resolution / 2);
    double worst = 0, worst_coarser = 0;
    stage.walk([&](int x, int y, int at, const SurfaceBlock& s) {
        const Vec3d p = scene.camera.eye + to_double(Vec3f{s.px[at], s.py[at], s.pz[at]});
        const Vec3d n = to_double(Vec3f{s.gx[at], s.gy[at], s.gz[at]});
        const Vec3d l =
            light.light.kind == LightKind::directional ? -light.light.direction : light.light.position - p;
        const double cosine = dot(n, l) / length(l);
        const bool thin = (s.thin[at / 16] >> (at & 15) & 1u) != 0;
        if ((cosine <= 0 && !thin) ||
            length(l) > (light.light.kind == LightKind::directional ? 1e300 : light.light.range_m))
            return;
        const std::size_t face =
            views.size() == 6 ? static_cast<std::size_t>(cube_face(to_float(-l))) : std::size_t{0};
        const double grazing = std::min(1.0, std::fabs(cosine) * 8);
        worst = std::max(
            worst, grazing * magnification_by_rays(stage.tiles.rays, views[face], p, n, x + 0.5, y + 0.5));
        worst_coarser = std::max(
            worst_coarser,
            grazing * magnification_by_rays(stage.tiles.rays, coarser[face], p, n, x + 0.5, y + 0.5));
    });
    EXPECT_LE(worst, GetParam().most * 1.001);
    EXPECT_GT(worst_coarser, GetParam().most * 0.999);
    EXPECT_NEAR(found[0]->magnification, worst, 0.01 * worst);
}
INSTANTIATE_TEST_SUITE_P(
    Kinds, AutoResolution,
    testing::Values(Case{LightKind::directional, false, 1.0}, Case{LightKind::directional, true, 1.0},
                    Case{LightKind::directional, false, 3.0}, Case{LightKind::point, false, 1.0},
                    Case{LightKind::spot, false, 1.0}, Case{LightKind::spot, true, 0.5}));

TEST(AutoResolutionLimits, StopAtTheLargestMapAndAtPicturesThatAskNothing) {
    Scene scene = staged(LightKind::directional, false);
    scene.lights[0].shadow.max_magnification = 1e-4;
    const Stage near(scene);
    const auto capped = auto_resolutions(scene, near.tiles, {});
    EXPECT_EQ(capped[0]->resolution, most_map_resolution);
    EXPECT_TRUE(capped[0]->capped);
    scene.camera.look_at = scene.camera.eye + Vec3d{0, 1, 0.01};  // nothing but sky
    const Stage sky(scene);
    const auto nothing = auto_resolutions(scene, sky.tiles, {});
    EXPECT_EQ(nothing[0]->resolution, least_map_resolution);
    EXPECT_EQ(nothing[0]->x, -1);
}

// --- scope
// -------------------------------------------------------------------------------------------------------

struct ScopeCount {
    int taps = 0;     ///< looked at
    int inside = 0;   ///< of these, judged differently, the receiver inside the texel's interval
    int wrong = 0;    ///< judged differently elsewhere
    int samples = 0;  ///< with a tap that is judged differently
};

/// Compares every tap of every pixel's lookup in two sets of trees of the same light.
ScopeCount compare_trees(const Stage& stage, const SceneLight& light, const std::vector<ShadowTree>& a,
                         const std::vector<ShadowTree>& b) {
    const Vec3d eye = stage.scene.camera.eye;
    const PcfLight one = pcf_light(light, std::span(a), eye), other = pcf_light(light, std::span(b), eye);
    std::vector<Image<DepthInterval>> intervals;
    IntervalParams params;
    params.receivers = light.shadow.receivers;
    for (const ShadowTree& tree : a)
        intervals.push_back(interval_map(stage.scene.mesh, tree.view, params, {}));
    ScopeCount count;
    stage.walk([&](int, int, int at, const SurfaceBlock& s) {
        const ref::PcfTrace x = ref::trace_pcf(s, one, at), y = ref::trace_pcf(s, other, at);
        ASSERT_EQ(x.taps.size(), y.taps.size());
        bool differs = false;
        for (std::size_t k = 0; k < x.taps.size(); ++k) {
            const ref::PcfTap &p = x.taps[k], &q = y.taps[k];
            ++count.taps;
            if (p.lit == q.lit) continue;
            differs = true;
            const DepthInterval i = intervals[static_cast<std::size_t>(x.view)](p.x, p.y);
            ++(i.entry < p.receiver && p.receiver <= i.exit ? count.inside : count.wrong);
        }
        count.samples += differs ? 1 : 0;
    });
    return count;
}

std::vector<ShadowTree> trees_of(const Stage& stage, SceneLight light,
                                 const std::vector<NeededNodes>* needed) {
    LightShadow shadow;
    shadow.light = light;
    shadow.casters = caster_box(stage.scene.mesh, light.light.direction);
    EXPECT_TRUE(build_light_trees(stage.scene.mesh, needed, {}, std::int64_t{1} << 32, shadow, nullptr));
    return shadow.trees;
}

TEST(Scope, OfAFrameChangesOnlyReceiversStrictlyInsideTheirInterval) {
    int differing = 0;
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        for (const int side : {1, 5}) {
            Scene scene = staged(kind, false);
            scene.lights[0].shadow.filter_px = side;
            scene.lights[0].shadow.resolution = 512;
            const Stage stage(scene);
            const SceneLight& light = scene.lights[0];
            const auto views = fitted_shadow_views(light, caster_box(scene.mesh, light.light.direction),
                                                   light.shadow.resolution);
            const std::vector<PcfLight> asking{pcf_light(light, views, scene.camera.eye)};
            const auto needed = needed_texels(stage.tiles, asking, {});
            ASSERT_TRUE(needed[0]);
            const auto full = trees_of(stage, light, nullptr), frame = trees_of(stage, light, &*needed[0]);
            const ScopeCount count = compare_trees(stage, light, frame, full);
            EXPECT_EQ(count.wrong, 0) << "of " << count.taps;
            EXPECT_GT(count.taps, 5000);
            differing += count.samples;

            std::uint64_t nodes_full = 0, nodes_frame = 0;
            for (std::size_t i = 0; i < full.size(); ++i) {
                nodes_full += full[i].counts.leaf + full[i].counts.full;
                nodes_frame += frame[i].counts.leaf + frame[i].counts.full;
            }
            EXPECT_LT(nodes_frame, nodes_full);
            if (kind == LightKind::point) continue;
            // Were a part forgotten, it would be seen.
            std::vector<NeededNodes> nothing(full.size());
            EXPECT_GT(compare_trees(stage, light, trees_of(stage, light, &nothing), full).wrong, 100);
        }
    }
    // 200 x 130 pixels, six frames: few pixels see a receiver inside its interval at all.
    EXPECT_LE(differing, 6 * 200 * 130 / 1000);
}

TEST(Scope, OfAFrameGivesUpWhenItAsksForTooMuch) {
    Scene scene = staged(LightKind::directional, false);
    scene.lights[0].shadow.resolution = 4096;
    const Stage stage(scene);
    const auto views =
        fitted_shadow_views(scene.lights[0], caster_box(scene.mesh, scene.lights[0].light.direction), 4096);
    const std::vector<PcfLight> asking{pcf_light(scene.lights[0], views, scene.camera.eye)};
    EXPECT_TRUE(needed_texels(stage.tiles, asking, {})[0]);
    EXPECT_FALSE(needed_texels(stage.tiles, asking, {}, 100)[0]);
}

// --- frames
// ------------------------------------------------------------------------------------------------------

/// Lights of every kind, every kind of compressed shadow.
Scene all_compressed(int samples = 1) {
    Scene scene = everything(samples);
    for (SceneLight& light : scene.lights) {
        light.shadow.method = ShadowMethod::compressed;
        light.shadow.resolution = auto_resolution;
        light.shadow.max_magnification = 2;
    }
    scene.lights[0].shadow.filter = ShadowFilter::hierarchical;
    scene.lights[1].shadow.resolution = 512;
    scene.lights[2].shadow.scope = ShadowScope::full;
    scene.lights[2].shadow.layout = TreeLayout::bytes16;
    return scene;
}

TEST(CompressedFrame, IsTheSameForEveryExecAndCrop) {
    expect_one_picture(all_compressed(4), {37, 21, 90, 70});
}

/// All of them, one tap, written in this code.
Scene whole_trees(ShadowCode code) {
    Scene scene = all_compressed();
    for (SceneLight& light : scene.lights) {
        light.shadow.scope = ShadowScope::full;
        light.shadow.filter = ShadowFilter::pcf;
        light.shadow.filter_px = 1;
        light.shadow.layout = TreeLayout::words24;
        light.shadow.code = code;
    }
    return scene;
}

TEST(CompressedFrame, ShowsTheSameInEveryCodeButInsideSolids) {
    // Without top grids, which are no part of a code and outweigh trees as small as these.
    const auto without_grids = [](ShadowCode code) {
        Scene scene = whole_trees(code);
        for (SceneLight& light : scene.lights)
            light.shadow.top_levels = 0;
        return render_frame(scene);
    };
    const Frame plain = without_grids(ShadowCode::mh);
    for (const ShadowCode code : {ShadowCode::mmh, ShadowCode::dag, ShadowCode::facet}) {
        const Frame other = without_grids(code);
        std::uint64_t mh_bytes = 0, bytes = 0;
        for (std::size_t i = 0; i < plain.stats.lights.size(); ++i) {
            EXPECT_EQ(other.stats.lights[i].code, code);
            EXPECT_NE(other.stats.lights[i].code_text, "");
            mh_bytes += plain.stats.lights[i].bytes;
            bytes += other.stats.lights[i].bytes;
        }
        EXPECT_LT(bytes, mh_bytes) << name_of(code);
        int differing = 0;
        for (int y = 0; y < plain.height; ++y) {
            for (int x = 0; x < plain.width; ++x)
                differing += pixel(plain, x, y) != pixel(other, x, y);
        }
        EXPECT_LT(differing, plain.width * plain.height / 100) << name_of(code);
    }
}

TEST(CompressedFrame, OfMergedTreesIsTheSameForEveryExecAndCrop) {
    for (const ShadowCode code : {ShadowCode::mmh, ShadowCode::dag, ShadowCode::facet})
        expect_one_picture(whole_trees(code), {37, 21, 90, 70}, {Isa::ref, 1}, {3});
}

TEST(CompressedFrame, KeepsWhatStillServes) {
    Scene scene = all_compressed();
    FrameCache cache;
    Frame frame;
    const auto kept = [&] {
        render_frame(scene, {}, {}, cache, frame);
        EXPECT_EQ(hash(frame), hash(render_frame(scene)));
        std::string text;
        for (const LightShadowStats& light : frame.stats.lights)
            text += light.kept ? 'k' : 'b';
        return text;
    };
    EXPECT_EQ(kept(), "bbb");
    EXPECT_EQ(kept(), "kkk");
    scene.lights[0].light.color = {1, 2, 3};
    EXPECT_EQ(kept(), "kkk");
    scene.camera.eye.x += 0.01;  // not enough for another resolution
    EXPECT_EQ(kept(), "bbk");
    scene.lights[2].shadow.max_magnification = 0.5;
    EXPECT_EQ(kept(), "kkb");
    scene.lights[1].shadow.filter_px = 5;
    EXPECT_EQ(kept(), "kbk");
}

TEST(CompressedFrame, CountsItsWork) {
    const Scene scene = all_compressed();
    const Frame frame = render_frame(scene);
    ASSERT_EQ(frame.stats.lights.size(), 3u);
    for (const LightShadowStats& s : frame.stats.lights) {
        EXPECT_GT(s.nodes.full + s.nodes.empty, 0u);
        EXPECT_GT(s.nodes.leaf, 0u);
        EXPECT_GT(s.bytes, 4 * s.nodes.leaf);
        EXPECT_GT(s.build.nodes_visited, 0u);
        EXPECT_GT(s.build.texels_rasterized, 0u);
        EXPECT_GT(s.lookup_s, 0.0);
        EXPECT_EQ(s.needed > 0, s.scope == ShadowScope::frame);
    }
    EXPECT_EQ(frame.stats.lights[1].views, 6);
    EXPECT_EQ(frame.stats.shadow_maps, 1 + 6 + 1);
}

TEST(CompressedFrame, StopsBeforeItTakesMoreMemoryThanItMay) {
    Scene scene = all_compressed();
    scene.lights[2].shadow.resolution = 1 << 18;  // an open sheet: a node for every few texels
    scene.lights[2].shadow.receivers = Receivers::any;
    scene.limits.memory_mib = 400;
    try {
        render_frame(scene);
        FAIL() << "not refused";
    } catch (const LimitError& error) {
        const std::string what = error.what();
        for (const char* part :
             {"light '", "MiB that limits.memory_mib leaves", "receivers = \"static\"", "method = \"map\""})
            EXPECT_NE(what.find(part), std::string::npos) << what;
    }
}

}  // namespace
}  // namespace obscura
