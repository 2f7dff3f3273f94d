#pragma once
// code = "auto": in what a compressed map is written when the scene leaves that open.

#include "app/scene/shadow_settings.h"

namespace obscura {

struct CodeChoice {
    ShadowCode code = ShadowCode::mh;
    const char* reason = nullptr;  ///< why "auto" takes it; null: the scene says so itself
};

/// The code of a light's tree. "auto": the smallest that is at least as fast to look up and that is waited
/// for once, by what was measured (hierarchy/mmh/limits.md, hierarchy/dag/limits.md). dag is smaller than mmh
/// and never as fast.
CodeChoice chosen_code(const ShadowSettings& shadow);

}  // namespace obscura
