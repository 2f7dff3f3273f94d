#include "app/scene/shadow_code.h"

namespace obscura {

CodeChoice chosen_code(const ShadowSettings& shadow) {
    if (shadow.code) return {*shadow.code, nullptr};
    // What a merged tree stores depends on all that is in it.
    if (shadow.scope != ShadowScope::full)
        return {ShadowCode::mh, "parts of a map are written by themselves"};
    if (shadow.cache.empty())
        return {ShadowCode::mh, "without a cache every run would wait for others to be made"};
    // Merged trees read a value at every node on the way: a table of the first levels spares most, but taps
    // that share their way read each of them again.
    if (shadow.top_levels < ShadowSettings{}.top_levels)
        return {ShadowCode::mh, "with so few top_levels smaller ones are slower"};
    if (shadow.filter_px > 1)
        return {ShadowCode::mh, "for kernels of several texels smaller ones are slower"};
    return {ShadowCode::mmh, "smaller than mh and as fast, and made once for its file"};
}

}  // namespace obscura
