// What a frame looks up: kernels' boxes are the same on every instruction set, and needed_texels finds just
// the squares that lookups one by one read.

#include "app/frame/needed_texels.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "core/radix_sort.h"
#include "filters/kernel_box.h"
#include "filters/shadow_lookup.h"
#include "tests/frame/stage.h"

namespace obscura {
namespace {

using namespace frame_scenes;

struct Case {
    LightKind kind;
    bool orthographic;
    PcfFilter filter;
    int side, resolution, samples;
};

std::string name_of(const Case& c) {
    return fmt::format("light kind {}, {}, filter {}, side {}, {} texels, {} samples",
                       static_cast<int>(c.kind), c.orthographic ? "orthographic" : "perspective",
                       static_cast<int>(c.filter), c.side, c.resolution, c.samples);
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        all.push_back({kind, false, PcfFilter::pcf, 3, 512, 4});
        all.push_back({kind, true, PcfFilter::pcf, 1, 1 << 17, 1});
        all.push_back({kind, false, PcfFilter::pcf, 15, 64, 1});
        all.push_back({kind, false, PcfFilter::hierarchical, 3, 1 << 14, 4});
        all.push_back({kind, true, PcfFilter::hierarchical, 9, 256, 1});
        all.push_back({kind, false, PcfFilter::hierarchical, 1, 1 << 20, 1});
    }
    return all;
}

/// A picture and its light as lookups see it, without stored depths. The parallel light's map is moved aside,
/// so that some receivers are off it, others on its border.
struct Asking {
    explicit Asking(const Case& c) : scene(scene_of(c)), stage(scene) {
        const SceneLight& l = scene.lights[0];
        const auto views = fitted_shadow_views(l, caster_box(scene.mesh, l.light.direction), c.resolution);
        light = pcf_light(l, views, scene.camera.eye);
        if (light.directional) {
            for (double& m : light.view[0].to_map[0])
                m *= 1.25;
            light.view[0].to_map[1][3] -= 0.125 * c.resolution;
        }
        if (c.filter == PcfFilter::hierarchical) filter_hierarchically(light, stage.tiles.rays);
    }
    static Scene scene_of(const Case& c) {
        Scene s = staged(c.kind, c.orthographic);
        s.lights[0].shadow.filter_px = c.side;
        s.render.samples = c.samples;
        return s;
    }
    Scene scene;
    Stage stage;
    PcfLight light;
};

/// Tap by tap, sample by sample.
std::vector<NeededNodes> needed_by_taps(const Asking& asking) {
    const PcfLight& light = asking.light;
    std::vector<NeededNodes> needed(static_cast<std::size_t>(light.views));
    const auto add = [&](const ref::PcfPlace& place, int level) {
        const ref::Kernel kernel(place, light.side, level);
        const std::int32_t last = (light.view[place.view].size >> level) - 1;
        for (int j = 0; j < kernel.side; ++j) {
            for (int i = 0; i < kernel.side; ++i) {
                std::int32_t x = kernel.x0 + i, y = kernel.y0 + j;
                if (!light.directional) {
                    x = std::clamp(x, 0, last);
                    y = std::clamp(y, 0, last);
                }
                if (x < 0 || y < 0 || x > last || y > last) continue;
                NeededNodes& of_view = needed[static_cast<std::size_t>(place.view)];
                const auto ux = static_cast<std::uint32_t>(x), uy = static_cast<std::uint32_t>(y);
                if (level == 0) {
                    of_view.add_texels(ux / 8, uy / 8, 3);
                } else {
                    of_view.add(ux, uy, level);
                }
            }
        }
    };
    for (const SamplePosition sample : asking.stage.tiles.pattern) {
        asking.stage.walk(sample, [&](int, int, int at, const SurfaceBlock& s) {
            const ref::PcfPlace place = ref::pcf_place(s, light, at);
            if (place.kind != ref::PcfPlace::on_map) return;
            const ref::Levels levels = light.filter == PcfFilter::pcf ? ref::Levels{} : ref::levels_of(place);
            add(place, levels.fine);
            if (levels.blend != 0.0f) add(place, levels.fine + 1);
        });
    }
    for (NeededNodes& of_view : needed)
        of_view.finish();
    return needed;
}

TEST(NeededTexels, AreThoseThatTheTapsOfAllSamplesRead) {
    for (const Case& c : cases()) {
        const Asking asking(c);
        const std::vector<NeededNodes> expected = needed_by_taps(asking);
        std::size_t squares = 0;
        for (const Isa isa : supported_isas()) {
            // Another light before it must not matter, nor may threads.
            const std::vector<PcfLight> lights{asking.light, asking.light};
            const auto found = needed_texels(asking.stage.tiles, lights, {isa, isa == Isa::ref ? 1 : 3});
            for (const auto& of_light : found) {
                ASSERT_TRUE(of_light);
                ASSERT_EQ(of_light->size(), expected.size());
                for (std::size_t v = 0; v < expected.size(); ++v) {
                    const auto a = (*of_light)[v].all(), b = expected[v].all();
                    ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()))
                        << name_of(c) << ", view " << v << ", " << isa_name(isa) << ": " << a.size()
                        << " and " << b.size() << " squares";
                    squares += a.size();
                }
            }
        }
        EXPECT_GT(squares, 100u) << name_of(c);
    }
}

TEST(NeededTexels, AreCountedExactlyBeforeTheyAreGivenUp) {
    const Asking asking(cases()[0]);
    const std::vector<PcfLight> lights{asking.light};
    // Squares that several tiles read count for each of them.
    const auto kept = [&](std::int64_t most, Exec exec) {
        return needed_texels(asking.stage.tiles, lights, exec, most)[0].has_value();
    };
    std::int64_t low = 0, high = std::int64_t{1} << 24;
    while (high - low > 1)
        (kept((low + high) / 2, {}) ? high : low) = (low + high) / 2;
    for (const Isa isa : supported_isas()) {
        EXPECT_TRUE(kept(high, {isa, 1}));
        EXPECT_FALSE(kept(low, {isa, 3}));
    }
    EXPECT_GE(high, static_cast<std::int64_t>(needed_by_taps(asking)[0].all().size()));
}

void expect_same_boxes(const BoxesOnLevel& a, const BoxesOnLevel& b, const std::string& what) {
    for (int at = 0; at < block_samples; ++at) {
        ASSERT_EQ(a.reading[at / 16], b.reading[at / 16]) << what << ", sample " << at;
        if ((a.reading[at / 16] >> (at & 15) & 1u) == 0) continue;
        ASSERT_EQ(a.level[at], b.level[at]) << what << ", sample " << at;
        ASSERT_EQ(a.x0[at], b.x0[at]) << what << ", sample " << at;
        ASSERT_EQ(a.x1[at], b.x1[at]) << what << ", sample " << at;
        ASSERT_EQ(a.y0[at], b.y0[at]) << what << ", sample " << at;
        ASSERT_EQ(a.y1[at], b.y1[at]) << what << ", sample " << at;
    }
}

TEST(KernelBoxes, AreTheSameOnEveryInstructionSet) {
    int coarse = 0;
    for (const Case& c : cases()) {
        const Asking asking(c);
        const TileScene& tiles = asking.stage.tiles;
        const auto work = std::make_unique<TileWork>();
        const auto expected = std::make_unique<KernelBoxes>(), boxes = std::make_unique<KernelBoxes>();
        for (std::size_t i = 0; i < tiles.bins->tiles(); ++i) {
            walk_blocks(tiles, i, tiles.pattern[0], Isa::ref, *work, [&](const TileRect&, int) {
                ref::kernel_boxes(work->surface, asking.light, *expected);
                for (const Isa isa : supported_isas()) {
                    OBSCURA_DISPATCH(isa, kernel_boxes, work->surface, asking.light, *boxes);
                    const std::string what = name_of(c) + ", " + std::string(isa_name(isa));
                    for (int k = 0; k < 2; ++k)
                        expect_same_boxes(boxes->kernel[k], expected->kernel[k], what);
                    for (int at = 0; at < block_samples; ++at) {
                        if ((expected->kernel[0].reading[at / 16] >> (at & 15) & 1u) == 0) continue;
                        ASSERT_EQ(boxes->view[at], expected->view[at]) << what;
                    }
                }
                for (const std::uint32_t reading : expected->kernel[1].reading)
                    coarse += reading != 0 ? 1 : 0;
            });
        }
    }
    EXPECT_GT(coarse, 100);
}

TEST(RadixSort, SortsByTheBitsAskedForAndKeepsTheOrderOfEqualOnes) {
    std::mt19937_64 rng(7);
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{50000}}) {
        for (const auto& [low, high] : {std::pair{0, 46}, std::pair{16, 58}, std::pair{5, 17}}) {
            std::vector<std::uint64_t> values(count);
            for (std::uint64_t& v : values)
                v = rng() & ((std::uint64_t{1} << high) - 1);
            std::vector<std::uint64_t> expected = values;
            std::stable_sort(
                expected.begin(), expected.end(),
                [shift = low](std::uint64_t a, std::uint64_t b) { return a >> shift < b >> shift; });
            sort_bits(values, low, high);
            EXPECT_EQ(values, expected);
        }
    }
}

}  // namespace
}  // namespace obscura
