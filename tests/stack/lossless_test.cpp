// Every texel of every map of a stack decodes to a depth of its own interval: drawn solids and open sheets,
// and where the data are, scans, a city and a plant. With OBSCURA_SLOW_TESTS=1: 256^3 and 64 x 1024^2.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "hierarchy/combine.h"
#include "hierarchy/stack/encode.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/core/shared_folder.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/stack/stack_scenes.h"
#ifdef OBSCURA_STACK_DATA
#include "bench/shadows/scenes.h"
#endif

namespace obscura {
namespace {

using lit::Lamp;

void check_lossless(const Mesh& mesh, const FocusedViews& views, Receivers receivers) {
    StackBuildParams params;
    params.receivers = receivers;
    const ShadowStack stack = build_stack(mesh, views, params, Exec{});
    std::size_t outside = 0;
    IntervalParams of_map;
    of_map.receivers = receivers;
    for (int k = 0; k < static_cast<int>(views.slices.size()); ++k) {
        const Image<DepthInterval> map = interval_map(mesh, views.view(k), of_map, Exec{});
        for (int y = 0; y < map.height; ++y) {
            for (int x = 0; x < map.width; ++x) {
                outside +=
                    !contains(map(x, y), stack_value(stack.code, static_cast<unsigned>(x),
                                                     static_cast<unsigned>(y), static_cast<unsigned>(k)));
            }
        }
    }
    EXPECT_EQ(outside, 0u) << "anisotropy " << stack.code.shape.anisotropy;
}

TEST(StackLossless, EveryTexelOfEveryMap) {
    const bool slow = slow_tests();
    int scene = 0;
    for (const Lamp lamp : {Lamp::level, Lamp::tilted, Lamp::sun, Lamp::path}) {
        ++scene;
        const Mesh mesh = lit::scene(static_cast<std::uint32_t>(scene), scene % 2 == 0);
        const Receivers receivers = scene < 3 ? Receivers::any : Receivers::static_only;
        const LightSamples samples = lit::samples_of(lamp, slow ? 256 : 16);
        check_lossless(mesh, focused_views(mesh, samples, lit::focus(slow ? 256 : 128)), receivers);
        if (slow)
            check_lossless(mesh, focused_views(mesh, lit::samples_of(lamp, 64), lit::focus(1024)), receivers);
    }
}

#ifdef OBSCURA_STACK_DATA
class StackData : public ::testing::TestWithParam<const char*> {};

/// A lamp of a twentieth of the scene, focused on its ground.
TEST_P(StackData, EveryTexelOfEveryMap) {
    const std::filesystem::path data = shared_folder("data");
    SKIP_WITHOUT(data);
    for (const ShadowRecipe& recipe : shadow_recipes(data, false)) {
        if (recipe.name != GetParam()) continue;
        const Mesh mesh = stage_shadows(recipe, {}).mesh;
        const Bounds b = bounds_of(mesh);
        const double extent = std::max(b.high.x - b.low.x, b.high.z - b.low.z), side = extent / 20;
        const Vec3d lamp = (b.low + b.high) * 0.5 - normalize(recipe.sun) * (2 * extent);
        const bool slow = slow_tests();
        for (const auto& [maps, resolution] :
             {std::pair{slow ? 256 : 16, slow ? 256 : 64}, std::pair{64, slow ? 1024 : 4}}) {
            FocusParams params = lit::focus(resolution);
            params.plane_point = {0, b.low.y, 0};
            const LightSamples samples = parallelogram_samples(lamp, {side, 0, 0}, {0, 0, side}, maps);
            check_lossless(mesh, focused_views(mesh, samples, params), Receivers::any);
        }
        return;
    }
    GTEST_SKIP() << "SKIPPED: ../shared/data has no " << GetParam();
}

INSTANTIATE_TEST_SUITE_P(Scenes, StackData,
                         ::testing::Values("armadillo", "dragon_res2", "vienna_west", "ficus_tree"),
                         [](const auto& scene) { return std::string(scene.param); });
#endif

}  // namespace
}  // namespace obscura
