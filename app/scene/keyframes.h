#pragma once
// What camera, lens and lights are at a frame.

#include <optional>
#include <string_view>
#include <vector>

#include "app/scene/scene_file.h"

namespace obscura {

/// Frames first, first + step, ... up to last. 0 <= first <= last, step >= 1.
struct FrameRange {
    int first = 1, last = 1, step = 1;

    int count() const { return (last - first) / step + 1; }
    int at(int index) const { return first + index * step; }
    bool contains(int frame) const { return frame >= first && frame <= last && (frame - first) % step == 0; }
    friend bool operator==(const FrameRange&, const FrameRange&) = default;
};

/// "7", "1-48" or "1-48x2"; empty when `text` is none of these.
std::optional<FrameRange> parse_frame_range(std::string_view text);

/// The frames the scene asks for.
FrameRange scene_frames(const SceneDocument& document);

/// The [camera] table with the keys that keyframes set put to their values at `frame`.
SceneTable camera_at(const SceneDocument& document, double frame);
/// The same for [optics], which must be there.
SceneTable optics_at(const SceneDocument& document, double frame);
/// The same for [stereo], which must be there.
SceneTable stereo_at(const SceneDocument& document, double frame);
/// The same for one of its edits.
SceneTable stereo_edit_at(const SceneDocument& document, const SceneTable& edit, double frame);
/// The same for one of the document's lights.
SceneTable light_at(const SceneDocument& document, const SceneTable& light, double frame);

/// One key over time: values of 1 or 3 components at strictly increasing frames.
struct Track {
    std::vector<double> frames;
    std::vector<std::vector<double>> values;
};
enum class Interpolation {
    linear,
    smooth,  ///< cubic Hermite with the tangents of Catmull and Rom (1974), for uneven spacing: the slope
             ///< between both neighbours, at the ends the slope to the only one
};
/// Value of the track at `frame`; held before the first and after the last keyframe. At least one keyframe.
std::vector<double> evaluate(const Track& track, double frame, Interpolation interpolation);

/// Seconds since 1970-01-01T00:00:00Z, and back with a given offset.
double epoch_seconds(const DateTime& time);
DateTime from_epoch_seconds(double seconds, int offset_minutes);

}  // namespace obscura
