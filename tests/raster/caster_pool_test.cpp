// Casters of many lights, made side by side in memory that others had.

#include "raster/exact/caster_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <vector>

#include "tests/raster/exact_points.h"
#include "tests/raster/exact_scenes.h"

namespace obscura {
namespace {

using namespace exact_scenes;

bool same(const Casters& a, const Casters& b) {
    if (a.count != b.count || a.boxes.size() != b.boxes.size()) return false;
    if (a.count == 0) return true;
    if (std::memcmp(a.triangles.data(), b.triangles.data(), a.count * sizeof(CasterTriangle)) != 0)
        return false;
    for (std::size_t l = 0; l < a.boxes.size(); ++l) {
        if (a.boxes[l].size() != b.boxes[l].size() ||
            std::memcmp(a.boxes[l].data(), b.boxes[l].data(), a.boxes[l].size() * sizeof(CasterBoxes)) != 0)
            return false;
    }
    return true;
}

/// Parallel lights and points in turn: of one view and of six, some of which hold nothing.
std::vector<Light> drawn_lights(Source& source, int count) {
    std::vector<Light> lights;
    for (int i = 0; i < count; ++i) {
        Light& light = lights.emplace_back();
        light.kind = i % 3 == 0 ? LightKind::point : LightKind::directional;
        light.position = source.in(-2, 6);
        light.direction = normalize(source.in(-1, 1));
    }
    return lights;
}

TEST(CasterPool, GivesWhatEachLightHasAlone) {
    Source source(3);
    CasterPool one, several;
    // Meshes of other sizes after one another, so that memory is too small, and too large.
    for (int round = 0; round < 6; ++round) {
        const Mesh mesh = draw_mesh(source, 1, {});
        const std::vector<Light> lights = drawn_lights(source, 1 + 4 * (round % 3));
        auto by_one = one.build(mesh, lights, Exec{best_isa(), 1});
        auto by_three = several.build(mesh, lights, Exec{best_isa(), 3});
        ASSERT_EQ(by_one.size(), lights.size());
        ASSERT_EQ(by_three.size(), lights.size());
        for (std::size_t i = 0; i < lights.size(); ++i) {
            CasterScratch scratch;
            const auto alone = build_casters(mesh, lights[i], {}, scratch);
            ASSERT_EQ(by_one[i].size(), alone.size());
            ASSERT_EQ(by_three[i].size(), alone.size());
            for (std::size_t v = 0; v < alone.size(); ++v) {
                EXPECT_TRUE(same(by_one[i][v], alone[v])) << round << ' ' << i << ' ' << v;
                EXPECT_TRUE(same(by_three[i][v], alone[v])) << round << ' ' << i << ' ' << v;
            }
        }
        one.give_back(std::move(by_one));
        several.give_back(std::move(by_three));
    }
}

TEST(CasterPool, GivesNothingWhenCancelled) {
    Source source(4);
    const Mesh mesh = draw_mesh(source, 1, {});
    const std::atomic<bool> cancel = true;
    CasterPool pool;
    EXPECT_TRUE(pool.build(mesh, drawn_lights(source, 4), {}, &cancel).empty());
}

}  // namespace
}  // namespace obscura
