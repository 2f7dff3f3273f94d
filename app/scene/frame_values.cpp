// What depends on the frame.

#include "app/scene/build.h"
#include "app/scene/keyframes.h"

namespace obscura {

void set_frame(Scene& scene, const SceneDocument& document, double frame) {
    scene.camera = camera_of(camera_at(document, frame));
    Image<float> mask = std::move(scene.optics.mask);
    scene.optics = optics_of(document, frame);
    scene.optics.mask = std::move(mask);
    scene.lights.clear();
    for (const SceneTable* light : subtables(document.root, "light")) {
        scene.lights.push_back(light_of(light_at(document, *light, frame)));
    }
}

}  // namespace obscura
