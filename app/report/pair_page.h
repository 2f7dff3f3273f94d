#pragma once
// obscura stereo --report FILE: one self-contained page about a stereo pair. No script, no font, no picture
// comes from elsewhere; readable in light and dark surroundings.

#include <string>

#include "app/pair/pair.h"
#include "app/report/pair_stats.h"
#include "app/scene/scene.h"
#include "app/scene/stereo_settings.h"
#include "core/image.h"
#include "core/isa.h"

namespace obscura {

/// What the page is about. Pictures are display-referred linear light; `unedited_*`, what the rig alone
/// gives, may be empty: then the page shows no anaglyph of it.
struct StereoReportInput {
    const Scene& scene;
    const StereoSettings& settings;
    const StereoPair& pair;  ///< with its middle picture (StereoSettings::middle_picture)
    const StereoFrameReport& frame;
    std::string scene_name;
    Image<Vec3f> unedited_left, unedited_right;
};

/// Pictures wider than this are shown at a whole fraction of their size.
constexpr int report_picture_width = 1280;

/// The page, UTF-8. Names in it are escaped. The same bytes for any exec but for times.
std::string stereo_report(const StereoReportInput& input, const Exec& exec);

}  // namespace obscura
