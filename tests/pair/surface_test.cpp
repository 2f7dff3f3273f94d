// The surface stage where surfaces are seen elsewhere than they are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "tests/frame/stage.h"
#include "tests/frame/undefined.h"
#include "tests/pair/eyes.h"

namespace obscura {
namespace {

using namespace frame_scenes;
using namespace stereo_eyes;

/// Calls check(block) with the surfaces of each block of a picture, as one kernel has them.
template <class Check>
void each_block(const TileScene& tiles, const std::vector<Isa>& isas, Check&& check) {
    const auto work = std::make_unique<TileWork>();
    std::vector<SurfaceBlock> blocks(isas.size());
    for (int tile_row = 0; tile_row < tiles.bins->rows; ++tile_row) {
        for (int column = 0; column < tiles.bins->columns; ++column) {
            for (int row = 0; row < frame_tile_side; row += block_rows) {
                for (std::size_t i = 0; i < isas.size(); ++i) {
                    std::memset(static_cast<void*>(work.get()), 0, sizeof(TileWork));
                    const TileRect tile =
                        tile_visibility(tiles, column, tile_row, tiles.pattern[0], best_isa(), *work);
                    block_geometry(tiles, tile, row, isas[i], *work);
                    forget_undefined(work->surface);
                    blocks[i] = work->surface;
                }
                check(blocks);
            }
        }
    }
}

TEST(SeenSurfaces, KernelsAgreeWithTheReferenceBitForBit) {
    const Scene scene = everything(4);
    const StereoRig rig = rig_with_offset(scene, 0.3, 7);
    const auto bend = [](std::size_t v) { return 3.0 * static_cast<double>(v % 3); };
    const OneEye eye(scene, rig, Eye::left, positions_of(scene, rig, Eye::left, bend));
    std::int64_t covered = 0, textured = 0, background = 0;
    const std::vector<Isa> isas = supported_isas();
    each_block(eye.tiles, isas, [&](const std::vector<SurfaceBlock>& blocks) {
        for (std::size_t i = 1; i < blocks.size(); ++i) {
            ASSERT_EQ(0, std::memcmp(&blocks[0], &blocks[i], sizeof(SurfaceBlock))) << isa_name(isas[i]);
        }
        for (int g = 0; g < block_groups; ++g) {
            covered += blocks[0].covered[g] != 0;
            textured += blocks[0].textured[g] != 0;
            background += blocks[0].covered[g] != 0xffff;
        }
    });
    EXPECT_GT(covered, 100);
    EXPECT_GT(textured, 100);
    EXPECT_GT(background, 100);
}

TEST(SeenSurfaces, WhatIsSeenWhereItIsStaysAsItIs) {
    const Scene scene = everything(1);
    const Stage plain(scene);
    OneEye eye(scene, {}, Eye::left, scene.mesh.positions);
    eye.tiles.surface.background_shift_px = 0;
    std::vector<SurfaceBlock> expected;
    each_block(plain.tiles, {best_isa()},
               [&](const std::vector<SurfaceBlock>& b) { expected.push_back(b[0]); });
    std::size_t next = 0;
    int differ = 0, seen = 0, moved = 0;
    each_block(eye.tiles, {best_isa()}, [&](const std::vector<SurfaceBlock>& blocks) {
        const SurfaceBlock &a = expected[next++], &b = blocks[0];
        for (int at = 0; at < block_samples; ++at) {
            if (a.triangle[at] != b.triangle[at]) {
                ++differ;  // planes of their own: ties of touching faces may fall the other way
                continue;
            }
            const float off = std::max({std::fabs(a.px[at] - b.px[at]), std::fabs(a.py[at] - b.py[at]),
                                        std::fabs(a.pz[at] - b.pz[at])});
            ASSERT_LT(off, 1e-3f);
            moved += off > 1e-5f;  // past an edge that snapped: clamped to the triangle
            if (a.triangle[at] == 0xffffffffu) continue;
            ++seen;
            ASSERT_EQ(a.nx[at], b.nx[at]);
            ASSERT_EQ(a.ny[at], b.ny[at]);
            ASSERT_EQ(a.nz[at], b.nz[at]);
            ASSERT_EQ(a.gx[at], b.gx[at]);
            ASSERT_EQ(a.u[at], b.u[at]);
            ASSERT_EQ(a.vy[at], b.vy[at]);
        }
    });
    EXPECT_GT(seen, 10000);
    EXPECT_LE(differ, 5);
    EXPECT_LE(moved, seen / 200);
}

}  // namespace
}  // namespace obscura
