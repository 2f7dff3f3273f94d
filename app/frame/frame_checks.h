#pragma once
// What rendering would refuse in one frame of many, found before the first of them is rendered.

#include <optional>
#include <vector>

#include "app/frame/frame.h"
#include "app/scene/scene.h"
#include "app/scene/scene_file.h"

namespace obscura {

/// Goes through the frames of a run. What is the same as in the frame before is not looked at again. What
/// only building tells (nodes of trees and stacks, what `auto` comes to when the camera has moved) is left to
/// it.
class FrameChecks {
  public:
    /// `channels` is what the frames are rendered with.
    FrameChecks(const SceneDocument& document, const FrameOptions& channels);

    /// Those of `frames`, at least one, that may differ from the one before in what is refused: the first
    /// alone where no keyframe touches it.
    std::vector<int> worth_checking(const std::vector<int>& frames) const;

    /// `scene` is set to `frame`; `further_bytes`: what is wanted beside a picture. Throws InputError or
    /// LimitError, with the place of the key that makes it so, when the aperture is closed, its pattern out
    /// of reach or a stack of shadow maps has no plane to be aimed at; LimitError when memory does not
    /// suffice.
    void check(const Scene& scene, int frame, std::int64_t further_bytes = 0);

  private:
    void check_lens(const Scene& scene, int frame) const;
    void check_stacks(const Scene& scene, int frame) const;
    void check_days(const Scene& scene, int frame) const;

    const SceneDocument& document;
    FrameOptions channels;
    /// What memory depends on.
    struct Needs {
        OpticsSettings optics;    ///< without its mask, which no frame changes
        std::optional<Sky> seen;  ///< whose brightness makes margins wide
        std::vector<bool> sheds;  ///< light by light, whether it has anything to shadow
        std::int64_t further_bytes = 0;
        friend bool operator==(const Needs&, const Needs&) = default;
    };
    std::optional<Needs> last;
    std::optional<std::vector<SceneLight>> last_lights;
};

}  // namespace obscura
