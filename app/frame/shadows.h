#pragma once
// The shadows of a frame: which lights have some, how fine, what of them is built, kept or read from files.

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "app/frame/frame.h"
#include "app/frame/render_frame.h"
#include "app/frame/tile.h"
#include "app/scene/scene.h"
#include "core/isa.h"

namespace obscura {

/// Whether the light has a shadow map of any kind.
bool casts_shadows(const SceneLight& light);

/// Finds what resolution = "auto" means for every light of the scene that says so, for these pictures of the
/// scene's camera (prepare_tiles()). One answer per light of the scene, without a value for the others.
std::vector<std::optional<FoundResolution>> auto_resolutions(const Scene& scene,
                                                             std::span<const TileScene> pictures,
                                                             const Exec& exec);
inline std::vector<std::optional<FoundResolution>> auto_resolutions(const Scene& scene,
                                                                    const TileScene& tiles,
                                                                    const Exec& exec) {
    return auto_resolutions(scene, std::span(&tiles, 1), exec);
}

/// Puts what was found in the lights' places. False when nothing was.
bool settle_resolutions(const std::vector<std::optional<FoundResolution>>& found,
                        std::vector<SceneLight>& lights);

/// Makes or keeps the shadows of every light and gives them to the lights of all `pictures`, which share
/// them. Adds to `stats`. `options`: what the frame will hold beside them, and options.cancel: false when it
/// was set before they were done. Throws LimitError when resolutions that were found make the frame too
/// large, or trees take more memory than is left after `other_bytes`, and what shadow caches throw. What was
/// built for a picture (scope "frame") is kept while camera and size stay: where more than these decides what
/// pictures show, forget_picture_shadows() first.
bool prepare_shadows(const Scene& scene, std::int64_t other_bytes, const Exec& exec, FrameCache& cache,
                     std::span<TileScene> pictures, FrameStats& stats, const FrameOptions& options = {});
inline bool prepare_shadows(const Scene& scene, std::int64_t other_bytes, const Exec& exec, FrameCache& cache,
                            TileScene& tiles, FrameStats& stats, const FrameOptions& options = {}) {
    return prepare_shadows(scene, other_bytes, exec, cache, std::span(&tiles, 1), stats, options);
}

/// Forgets the shadows that were built for one picture's lookups; others stay.
void forget_picture_shadows(FrameCache& cache);

}  // namespace obscura
