// Lookups in a stack: all maps at once say what one lookup per map says, on every instruction set, by fewer
// steps.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hierarchy/stack/answered_runs.h"
#include "hierarchy/stack/encode.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/stack/stack_oracle.h"
#include "tests/stack/stack_scenes.h"

namespace obscura {
namespace {

using lit::Lamp;
constexpr Lamp lamps[] = {Lamp::level, Lamp::tilted, Lamp::sun, Lamp::path};

std::vector<std::uint16_t> all_of(const StackLookup& lookup, const StackPoints& points, Isa isa,
                                  StackWork& work) {
    std::vector<std::uint16_t> lit(points.count);
    OBSCURA_DISPATCH(isa, lit_samples, lookup, points, lit.data(), work);
    return lit;
}

std::vector<std::uint16_t> some_of(const StackLookup& lookup, const StackPoints& points, int samples, Isa isa,
                                   StackWork& work) {
    std::vector<std::uint16_t> lit(points.count);
    OBSCURA_DISPATCH(isa, lit_of_subset, lookup, points, samples, lit.data(), work);
    return lit;
}

std::size_t differences(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += a[i] != b[i];
    return count;
}

/// Millions of pairs of a point and a map; forty times as many with OBSCURA_SLOW_TESTS=1.
TEST(StackQuery, AllMapsAtOnceAreOneByOne) {
    const int count = slow_tests() ? 400000 : 10000;
    const Vec3d eye{-3, 5, 9};
    int scene = 0;
    for (const Lamp lamp : lamps) {
        ++scene;
        const Mesh mesh = lit::scene(static_cast<std::uint32_t>(scene), scene % 2 == 1);
        // Also numbers of maps that are no power of two.
        const LightSamples samples = lit::samples_of(lamp, lamp == Lamp::path ? 39 : 64);
        for (const int a : {-1, 1}) {
            StackBuildParams params;
            params.tree.anisotropies = {a};
            const ShadowStack stack =
                build_stack(mesh, focused_views(mesh, samples, lit::focus(128)), params, Exec{});
            const StackLookup lookup = stack_lookup(stack, eye);
            const lit::Points points = lit::drawn_points(mesh, eye, count, 5);
            StackWork at_once, one_by_one;
            const auto all = all_of(lookup, points.view(), best_isa(), at_once);
            EXPECT_EQ(differences(all, some_of(lookup, points.view(), lookup.slices, best_isa(), one_by_one)),
                      0u)
                << static_cast<int>(lamp) << ' ' << a;
            EXPECT_LT(at_once.nodes * 3, one_by_one.nodes * 2) << "headers";
            EXPECT_LT(at_once.lookups, one_by_one.lookups) << "runs";
            // Neither all dark nor all lit: there is something to get wrong.
            const auto partly =
                std::count_if(all.begin(), all.end(), [&](int n) { return n > 0 && n < lookup.slices; });
            EXPECT_GT(partly, count / 50);
        }
    }
}

TEST(StackQuery, EveryInstructionSetAgreesWithTheReference) {
    const Vec3d eye{2, 1, -4};
    for (const Lamp lamp : lamps) {
        const Mesh mesh = lit::scene(6, true);
        StackBuildParams params;
        params.tree.anisotropies = {1, -1};
        ShadowStack stack = build_stack(mesh, focused_views(mesh, lit::samples_of(lamp, 32), lit::focus(128)),
                                        params, Exec{});
        const lit::Points points = lit::drawn_points(mesh, eye, 3001, 9);
        for (const StackLayout layout : {StackLayout::narrow, StackLayout::wide}) {
            StackEncodeParams encode;
            encode.layout = layout;
            const StackTree tree{stack.code.shape, decode_stack(stack)};
            encode_stack(tree, encode, stack);
            const StackLookup lookup = stack_lookup(stack, eye);
            StackWork work, subset_work;
            const auto all = all_of(lookup, points.view(), Isa::ref, work);
            const auto some = some_of(lookup, points.view(), 9, Isa::ref, subset_work);
            for (const Isa isa : supported_isas()) {
                StackWork own, own_subset;
                EXPECT_EQ(differences(all_of(lookup, points.view(), isa, own), all), 0u) << isa_name(isa);
                EXPECT_EQ(differences(some_of(lookup, points.view(), 9, isa, own_subset), some), 0u);
                EXPECT_EQ(own.nodes, work.nodes) << isa_name(isa);
                EXPECT_EQ(own.lookups, work.lookups);
                EXPECT_EQ(own_subset.nodes, subset_work.nodes);
                EXPECT_EQ(own_subset.lookups, subset_work.lookups);
            }
            for (const int threads : {1, 7}) {
                const auto share = visible_share(lookup, points.view(), 0, Exec{best_isa(), threads});
                for (std::size_t i = 0; i < share.size(); ++i)
                    ASSERT_EQ(share[i], static_cast<float>(all[i]) / 32.0f);
            }
        }
    }
}

/// The runs that answered are all maps, in order, at the steps of all; several maps each, mostly.
TEST(StackQuery, AnsweredRunsAreAllMapsInOrder) {
    const Vec3d eye{-1, 2, 5};
    for (const auto& [lamp, slices] : {std::pair{Lamp::level, 64}, {Lamp::tilted, 32}, {Lamp::path, 39}}) {
        const Mesh mesh = lit::scene(4, true);
        const ShadowStack stack = build_stack(
            mesh, focused_views(mesh, lit::samples_of(lamp, slices), lit::focus(128)), {}, Exec{});
        const StackLookup lookup = stack_lookup(stack, eye);
        const lit::Points points = lit::drawn_points(mesh, eye, 2000, 7);
        StackWork work, own;
        const auto all = all_of(lookup, points.view(), Isa::ref, work);
        std::size_t answers = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            int next = 0, lit = 0;
            for (const AnsweredRun& run : ref::answered_runs(lookup, points.view(), i, own)) {
                ASSERT_EQ(run.first, next);
                ASSERT_GT(run.maps, 0);
                next += run.maps;
                lit += run.lit ? run.maps : 0;
                ++answers;
            }
            ASSERT_EQ(next, lookup.slices);
            ASSERT_EQ(lit, all[i]);
        }
        EXPECT_EQ(own.nodes, work.nodes);
        EXPECT_EQ(own.lookups, work.lookups);
        EXPECT_LT(answers * 2, all.size() * static_cast<std::size_t>(lookup.slices));
    }
}

/// Of parts of the light: each asks its own maps, at the steps of all, and down to single maps.
TEST(StackQuery, PartsOfTheLightAreRunsOfMaps) {
    const Vec3d eye{1, 2, 3};
    for (const auto& [lamp, slices] :
         {std::pair{Lamp::level, 64}, {Lamp::tilted, 16}, {Lamp::sun, 64}, {Lamp::path, 39}}) {
        const Mesh mesh = lit::scene(9, true);
        const ShadowStack stack = build_stack(
            mesh, focused_views(mesh, lit::samples_of(lamp, slices), lit::focus(128)), {}, Exec{});
        const StackLookup lookup = stack_lookup(stack, eye);
        const lit::Points points = lit::drawn_points(mesh, eye, 2001, 4);
        const std::size_t count = points.view().count;
        StackWork at_once;
        const auto all = all_of(lookup, points.view(), Isa::ref, at_once);
        for (const int parts : {1, 4, 16, 64}) {
            if (parts > 1 << stack.code.shape.slice_levels) continue;
            std::vector<std::uint16_t> expected(count * static_cast<std::size_t>(parts), 7);
            StackWork work;
            ref::lit_of_parts(lookup, points.view(), parts, expected.data(), work);
            EXPECT_EQ(work.nodes, at_once.nodes);
            for (std::size_t i = 0; i < count; ++i) {
                int sum = 0;
                for (std::size_t part = 0; part < static_cast<std::size_t>(parts); ++part)
                    sum += expected[part * count + i];
                ASSERT_EQ(sum, all[i]) << parts;
            }
            for (const Isa isa : supported_isas()) {
                std::vector<std::uint16_t> lit(expected.size(), 9);
                StackWork own;
                OBSCURA_DISPATCH(isa, lit_of_parts, lookup, points.view(), parts, lit.data(), own);
                EXPECT_EQ(differences(lit, expected), 0u) << isa_name(isa) << ' ' << parts;
                EXPECT_EQ(own.nodes, work.nodes);
            }
            if (parts != slices) continue;
            // A map each: as many of the first of them reach a point as one by one.
            StackLookup some = lookup;
            for (some.slices = 1; some.slices <= slices; some.slices += 9) {
                const auto one_by_one = some_of(some, points.view(), some.slices, Isa::ref, work);
                for (std::size_t i = 0; i < count; ++i) {
                    int sum = 0;
                    for (std::size_t k = 0; k < static_cast<std::size_t>(some.slices); ++k)
                        sum += expected[k * count + i];
                    ASSERT_EQ(sum, one_by_one[i]) << some.slices;
                }
            }
        }
    }
}

/// Lookups by the definition, in doubles and with the texels of the views themselves: where no texel's border
/// and no depth is near, floats say the same.
TEST(StackQuery, TexelsAndDepthsAreThoseOfTheViews) {
    const Mesh mesh = lit::scene(2, false);
    for (const Lamp lamp : lamps) {
        const LightSamples samples = lit::samples_of(lamp, 16);
        const FocusedViews views = focused_views(mesh, samples, lit::focus(256));
        StackBuildParams params;
        params.tree.anisotropies = {0};
        const ShadowStack stack = build_stack(mesh, views, params, Exec{});
        const StackLookup lookup = stack_lookup(stack, {0, 0, 0});
        const lit::Points points = lit::drawn_points(mesh, {0, 0, 0}, 4000, 3);
        StackWork work;
        const auto lit = all_of(lookup, points.view(), best_isa(), work);
        int compared = 0, wrong = 0;
        for (std::size_t i = 0; i < lit.size(); ++i) {
            const Vec3d p{points.px[i], points.py[i], points.pz[i]},
                n{points.nx[i], points.ny[i], points.nz[i]};
            int expected = 0;
            bool clear = true;
            for (int k = 0; k < 16; ++k) {
                const LightView view = views.view(k);
                if (p.y >= views.frame.near_h) {
                    ++expected;
                    continue;
                }
                const Vec3d at = to_map_space(view, p);
                const double fx = at.x - std::floor(at.x), fy = at.y - std::floor(at.y);
                clear = clear && std::min({fx, 1 - fx, fy, 1 - fy}) > 1e-3;
                if (at.x < 0 || at.y < 0 || at.x >= 256 || at.y >= 256) {
                    ++expected;
                    continue;
                }
                const Vec3d sample = samples.at[static_cast<std::size_t>(k)];
                const Vec3d l = samples.directional ? -sample : sample - p;
                clear = clear && std::fabs(dot(n, normalize(l))) > 0.05;
                if (dot(n, l) <= 0) continue;
                // The receiver's plane along the ray of the texel's middle.
                const Vec3d q = p + cross(n, Vec3d{1, 0, 0}) * 0.01, r = p + cross(n, Vec3d{0, 0, 1}) * 0.01;
                const Vec3d aq = to_map_space(view, q) - at, ar = to_map_space(view, r) - at;
                const double area = aq.x * ar.y - aq.y * ar.x;
                clear = clear && std::fabs(area) > 1e-6;
                const double sx = (aq.z * ar.y - ar.z * aq.y) / area, sy = (ar.z * aq.x - aq.z * ar.x) / area;
                const double rise = sx * (0.5 - fx) + sy * (0.5 - fy);
                const double depth = std::min(at.z + std::min(rise, 0.0), 1.0);
                const float stored = stack_value(stack.code, static_cast<unsigned>(at.x),
                                                 static_cast<unsigned>(at.y), static_cast<unsigned>(k));
                clear = clear && std::fabs(depth - static_cast<double>(stored)) >
                                     (std::fabs(sx) + std::fabs(sy)) / 200 + 1e-4;
                expected += depth <= static_cast<double>(stored);
            }
            if (!clear) continue;
            ++compared;
            wrong += expected != lit[i];
        }
        EXPECT_GT(compared, 1500);
        EXPECT_EQ(wrong, 0) << "of " << compared << ", lamp " << static_cast<int>(lamp);
    }
}

/// Casters that are thin and stand alone: whatever they shade lies far beyond the range of depths that their
/// maps have. Points below are dark or lit as a ray says, however steep their surface; those above are lit.
TEST(StackQuery, ReceiversFarBeyondTheCastersAreShadedAsRaysSay) {
    Mesh mesh;
    solids::add(mesh, solids::shifted(box({6, 0.02, 6}), {1, 4, -1}));
    std::mt19937 rng(17);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(rng()) / 4294967296.0);
    };
    for (const Lamp lamp : {Lamp::level, Lamp::tilted, Lamp::sun}) {
        const LightSamples samples = lit::samples_of(lamp, 16);
        StackBuildParams params;
        params.tree.anisotropies = {0};
        const ShadowStack stack =
            build_stack(mesh, focused_views(mesh, samples, lit::focus(256)), params, Exec{});
        lit::Points points;
        std::vector<int> expected;
        for (int i = 0; expected.size() < 6000; ++i) {
            const double y = i % 3 == 0 ? uniform(4.1, 9) : i % 3 == 1 ? uniform(-3, 3.5) : -uniform(3, 300);
            const Vec3d aim{uniform(-3.5, 5.5), 4, uniform(-5.5, 3.5)};
            const Vec3d middle = samples.at[samples.at.size() / 2];
            const Vec3d way = samples.directional ? middle : normalize(aim - middle);
            const Vec3d p = aim + way * ((y - aim.y) / way.y);
            const Vec3d n =
                normalize(Vec3d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)} * uniform(0, 3) - way);
            // Where a texel's border or the surface's own horizon may decide, nothing is known.
            int count = 0;
            bool clear = true;
            for (const Vec3d& sample : samples.at) {
                const Vec3d l = samples.directional ? -sample : sample - p;
                clear = clear && (y > 4 || dot(n, normalize(l)) > 0.02);
                const Vec3d at = p + l * ((4 - p.y) / l.y);
                const double beside = std::max(std::fabs(at.x - 1), std::fabs(at.z + 1)) - 3;
                clear = clear && std::fabs(beside) > 0.15;
                count += y > 4 || beside > 0 ? 1 : 0;
            }
            if (!clear) continue;
            points.add(p, n, 0);
            expected.push_back(count);
        }
        const StackLookup lookup = stack_lookup(stack, {0, 0, 0});
        for (const Isa isa : {Isa::ref, best_isa()}) {
            StackWork work;
            const auto lit = all_of(lookup, points.view(), isa, work);
            int wrong = 0, dark = 0;
            for (std::size_t i = 0; i < lit.size(); ++i) {
                wrong += lit[i] != expected[i];
                dark += expected[i] == 0;
            }
            EXPECT_EQ(wrong, 0) << "lamp " << static_cast<int>(lamp) << ", " << isa_name(isa);
            EXPECT_GT(dark, 1000);
        }
    }
}

/// A penumbra whose every point is known: the level lamp over the edge of a half-plane of thickness next to
/// nothing.
TEST(StackQuery, PenumbraOfAnEdge) {
    Mesh mesh;
    solids::add(mesh, solids::shifted(box({20, 0.02, 20}), {-10, 4, 0}));
    solids::add(mesh, solids::shifted(box({24, 0.5, 24}), {0, -0.25, 0}));
    // 16 x 16 samples over 3 m of a lamp at height 14; the edge is at x = 0, y = 4.
    const LightSamples lamp = parallelogram_samples({0, 14, 0}, {3, 0, 0}, {0, 0, 3}, 256);
    StackBuildParams params;
    params.tree.anisotropies = {0};
    const ShadowStack stack = build_stack(mesh, focused_views(mesh, lamp, lit::focus(512)), params, Exec{});
    lit::Points points;
    for (int i = 0; i < 64; ++i)
        points.add({(i - 31.5) / 32 * 0.8, 0, 0.01 * i}, {0, 1, 0}, 0);
    const auto share = visible_share(stack_lookup(stack, {0, 0, 0}), points.view(), 0, Exec{});
    for (std::size_t i = 0; i < share.size(); ++i) {
        const auto x = static_cast<double>(points.px[i]);
        // The ray from (x, 0) over (0, 4) meets the lamp's height at x - 14 x / 4.
        const double over = x - 14 * x / 4, exact = std::clamp((1.5 - over) / 3, 0.0, 1.0);
        EXPECT_NEAR(share[i], exact, 1.0 / 16 + 0.03) << "at " << x;
    }
}

/// On a scene of penumbras, all maps cost fewer headers than the maps asked one by one, and fewer than a
/// quarter of them.
TEST(StackQuery, StepsOnAPenumbra) {
    const Mesh mesh = lit::scene(11, false);
    const ShadowStack stack = build_stack(
        mesh, focused_views(mesh, lit::samples_of(Lamp::level, 256), lit::focus(256)), {}, Exec{});
    const StackLookup lookup = stack_lookup(stack, {0, 0, 0});
    const lit::Points points = lit::ground_points(32, 7);
    StackWork all, subset, each;
    const auto lit = all_of(lookup, points.view(), best_isa(), all);
    some_of(lookup, points.view(), 64, best_isa(), subset);
    some_of(lookup, points.view(), 256, best_isa(), each);
    const auto partly = std::count_if(lit.begin(), lit.end(), [](int n) { return n > 0 && n < 256; });
    EXPECT_GT(partly, 100);
    EXPECT_LT(all.nodes, subset.nodes) << "a quarter of the maps";
    EXPECT_LT(all.nodes * 4, each.nodes);
    RecordProperty("nodes_all", static_cast<int>(all.nodes / points.view().count));
    RecordProperty("nodes_each", static_cast<int>(each.nodes / points.view().count));
}

TEST(StackQuery, ASubsetAsksEveryShareOnce) {
    for (const int slices : {16, 79, 256}) {
        for (const int samples : {1, 5, 16}) {
            for (std::uint32_t pattern = 0; pattern < 65536; pattern += 977) {
                for (int j = 0; j < samples; ++j) {
                    const int k = subset_slice(slices, samples, j, pattern);
                    EXPECT_GE(k, j * slices / samples);
                    EXPECT_LT(k, (j + 1) * slices / samples);
                }
            }
        }
    }
}

}  // namespace
}  // namespace obscura
