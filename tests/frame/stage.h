#pragma once
// Pictures up to the point where shadows are made.

#include <memory>

#include "tests/frame/scenes.h"

namespace obscura::frame_scenes {

/// Solids and sheets under one light of the kind, its shadow compressed.
inline Scene staged(LightKind kind, bool orthographic) {
    Scene scene = everything(1, orthographic);
    scene.lights = {kind == LightKind::directional ? scene.lights[0]
                    : kind == LightKind::point     ? scene.lights[1]
                                                   : scene.lights[2]};
    scene.lights[0].shadow = ShadowSettings{};
    return scene;
}

/// A picture's tiles, ready for shadows.
struct Stage {
    explicit Stage(const Scene& s) : scene(s) {
        FrameStats stats;
        prepare_scene(scene, {}, cache, stats);
        tiles = prepare_tiles(scene, {}, cache);
    }
    /// visit(x, y, at, block) for every pixel that sees a surface there.
    template <class Visit>
    void walk(SamplePosition sample, Visit&& visit) const {
        const auto work = std::make_unique<TileWork>();
        for (std::size_t i = 0; i < tiles.bins->tiles(); ++i) {
            walk_tile(tiles, i, sample, Isa::ref, *work,
                      [&](int x, int y, int at) { visit(x, y, at, work->surface); });
        }
    }
    /// The same for the first sample of every pixel.
    template <class Visit>
    void walk(Visit&& visit) const {
        walk(tiles.pattern[0], visit);
    }
    const Scene& scene;
    FrameCache cache;
    TileScene tiles;
};

}  // namespace obscura::frame_scenes
