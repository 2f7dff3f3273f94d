#include "app/frame/light_shadow.h"

namespace obscura {
namespace {

// What a shadow is made from: everything except what is named here as of no account, so that a setting which
// is added later counts until someone finds that it need not.

SceneLight shadow_part(SceneLight light) {
    static const SceneLight d;
    light.light.color = d.light.color;
    light.light.inner_cone_deg = d.light.inner_cone_deg;
    light.light.path = d.light.path;
    light.shadow.max_magnification = d.shadow.max_magnification;  // has settled the resolution
    return light;
}

RenderSettings geometry_part(RenderSettings render) {
    static const RenderSettings d;
    render.exposure_ev = d.exposure_ev;
    render.tone = d.tone;
    render.receivers = d.receivers;  // a default that lights have taken
    return render;
}

}  // namespace

bool same_shadow(const SceneLight& a, const SceneLight& b) {
    return shadow_part(a) == shadow_part(b);
}

bool same_picture(const LightShadow& shadow, const Camera& camera, const RenderSettings& render,
                  const Region& seen) {
    return shadow.camera == camera && geometry_part(shadow.render) == geometry_part(render) &&
           shadow.seen == seen;
}

}  // namespace obscura
