#include "app/scene/keyframes.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "app/scene/keys.h"
#include "core/error.h"

namespace obscura {
namespace {

/// A whole number at the front of `text`, which it is taken off.
std::optional<int> take_integer(std::string_view& text) {
    int value = 0;
    if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || value > 999'999'999) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

std::vector<double> components(const SceneValue& value) {
    if (const auto* time = std::get_if<DateTime>(&value.data)) return {epoch_seconds(*time)};
    if (const auto* v = std::get_if<double>(&value.data)) return {*v};
    std::vector<double> all;
    for (const SceneValue& item : std::get<SceneList>(value.data))
        all.push_back(std::get<double>(item.data));
    return all;
}

/// The date of a number of seconds; a smooth curve through the first and last years may swing beyond them.
DateTime date_within(const Range& years, double seconds, int offset_minutes) {
    const DateTime first{static_cast<int>(years.lo), 1, 1, 0, 0, 0, 0, true, offset_minutes};
    const DateTime last{static_cast<int>(years.hi), 12, 31, 23, 59, 59, 0, true, offset_minutes};
    return from_epoch_seconds(std::clamp(seconds, epoch_seconds(first), epoch_seconds(last)), offset_minutes);
}

SceneValue from_components(const KeySpec& key, const std::vector<double>& v, const SceneValue& like) {
    if (key.type == KeyType::date_time) {
        return {date_within(key.range, v[0], std::get<DateTime>(like.data).offset_minutes), like.place};
    }
    const auto clamped = [&](double x) {
        // An open end (fov 0) is approached, not reached.
        const double lo = key.range.open_lo ? std::nextafter(key.range.lo, key.range.hi) : key.range.lo;
        const double hi = key.range.open_hi ? std::nextafter(key.range.hi, key.range.lo) : key.range.hi;
        return std::clamp(x, lo, hi);
    };
    SceneValue result = v.size() == 1   ? value_of(clamped(v[0]))
                        : v.size() == 2 ? value_of(Vec2d{clamped(v[0]), clamped(v[1])})
                                        : value_of(Vec3d{clamped(v[0]), clamped(v[1]), clamped(v[2])});
    result.place = like.place;
    return result;
}

/// Puts every key that `keyframes` set to its value at `frame`.
void animate(SceneTable& target, const std::vector<const SceneTable*>& keyframes, const TableSpec& spec,
             double frame, Interpolation interpolation) {
    for (const KeySpec& key : spec.keys) {
        if (!key.animated) continue;
        Track track;
        const SceneValue* last_set = nullptr;  // the keyframe that errors at this frame point to
        for (const SceneTable* keyframe : keyframes) {
            const SceneEntry* entry = keyframe->find(key.name);
            if (entry == nullptr) continue;
            track.frames.push_back(number(*keyframe, "frame"));
            track.values.push_back(components(entry->value));
            if (last_set == nullptr || track.frames.back() <= frame) last_set = &entry->value;
        }
        if (last_set == nullptr) continue;
        target.set(key.name, from_components(key, evaluate(track, frame, interpolation), *last_set));
    }
}

Interpolation interpolation_of(const SceneTable& frames) {
    return text(frames, "interpolation") == "smooth" ? Interpolation::smooth : Interpolation::linear;
}

const TableSpec& keyframe_spec(const char* list) {
    for (const KeySpec& key : frames_table().keys) {
        if (key.name == list) return *key.table;
    }
    CHECK(false, list);
    return frames_table();
}

/// `element` of a list with the keyframes of its id.
SceneTable animated_one(const SceneDocument& document, const SceneTable& element, const char* list,
                        double frame) {
    SceneTable result = element;
    const SceneTable& frames = subtable(document.root, "frames");
    std::vector<const SceneTable*> keyframes = subtables(frames, list);
    std::erase_if(keyframes, [&](const SceneTable* k) { return text(*k, "id") != text(element, "id"); });
    animate(result, keyframes, keyframe_spec(list), frame, interpolation_of(frames));
    return result;
}

/// Slope at keyframe i.
double tangent(const Track& track, std::size_t i, std::size_t component) {
    const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, track.frames.size() - 1);
    return (track.values[b][component] - track.values[a][component]) / (track.frames[b] - track.frames[a]);
}

}  // namespace

std::optional<FrameRange> parse_frame_range(std::string_view text) {
    FrameRange range;
    const auto first = take_integer(text);
    if (!first) return std::nullopt;
    range.first = range.last = *first;
    if (text.starts_with('-')) {
        text.remove_prefix(1);
        const auto last = take_integer(text);
        if (!last || *last < *first) return std::nullopt;
        range.last = *last;
        if (text.starts_with('x')) {
            text.remove_prefix(1);
            const auto step = take_integer(text);
            if (!step || *step < 1) return std::nullopt;
            range.step = *step;
        }
    }
    if (!text.empty()) return std::nullopt;
    return range;
}

FrameRange scene_frames(const SceneDocument& document) {
    const auto range = parse_frame_range(text(subtable(document.root, "frames"), "range"));
    CHECK(range.has_value());
    return *range;
}

SceneTable camera_at(const SceneDocument& document, double frame) {
    SceneTable camera = subtable(document.root, "camera");
    const SceneTable& frames = subtable(document.root, "frames");
    animate(camera, subtables(frames, "camera"), keyframe_spec("camera"), frame, interpolation_of(frames));
    return camera;
}

SceneTable optics_at(const SceneDocument& document, double frame) {
    SceneTable optics = subtable(document.root, "optics");
    const SceneTable& frames = subtable(document.root, "frames");
    animate(optics, subtables(frames, "optics"), keyframe_spec("optics"), frame, interpolation_of(frames));
    return optics;
}

SceneTable stereo_at(const SceneDocument& document, double frame) {
    SceneTable stereo = subtable(document.root, "stereo");
    const SceneTable& frames = subtable(document.root, "frames");
    animate(stereo, subtables(frames, "stereo"), keyframe_spec("stereo"), frame, interpolation_of(frames));
    return stereo;
}

SceneTable stereo_edit_at(const SceneDocument& document, const SceneTable& edit, double frame) {
    return animated_one(document, edit, "stereo_edit", frame);
}

SceneTable light_at(const SceneDocument& document, const SceneTable& light, double frame) {
    return animated_one(document, light, "light", frame);
}

std::vector<double> evaluate(const Track& track, double frame, Interpolation interpolation) {
    CHECK(!track.frames.empty() && track.frames.size() == track.values.size());
    if (frame <= track.frames.front()) return track.values.front();
    if (frame >= track.frames.back()) return track.values.back();
    const auto next = std::upper_bound(track.frames.begin(), track.frames.end(), frame);
    const auto i = static_cast<std::size_t>(next - track.frames.begin()) - 1;
    const double span = track.frames[i + 1] - track.frames[i], t = (frame - track.frames[i]) / span;

    std::vector<double> result;
    for (std::size_t c = 0; c < track.values[i].size(); ++c) {
        const double a = track.values[i][c], b = track.values[i + 1][c];
        if (interpolation == Interpolation::linear) {
            result.push_back(a + (b - a) * t);
        } else {
            // Hermite basis, written so that t = 0 gives a exactly.
            const double ma = tangent(track, i, c) * span, mb = tangent(track, i + 1, c) * span;
            result.push_back(a + t * (ma + t * ((3 * (b - a) - 2 * ma - mb) + t * (2 * (a - b) + ma + mb))));
        }
    }
    return result;
}

double epoch_seconds(const DateTime& t) {
    using namespace std::chrono;
    const year_month_day date{year{t.year}, month{static_cast<unsigned>(t.month)},
                              day{static_cast<unsigned>(t.day)}};
    const auto days = static_cast<double>(sys_days{date}.time_since_epoch().count());
    const double minutes = t.hour * 60.0 + t.minute - t.offset_minutes;
    return days * 86400.0 + minutes * 60.0 + t.second + static_cast<double>(t.nanosecond) * 1e-9;
}

DateTime from_epoch_seconds(double seconds, int offset_minutes) {
    using namespace std::chrono;
    const double local = seconds + offset_minutes * 60.0, days = std::floor(local / 86400.0);
    const auto second_of_day = std::clamp(local - days * 86400.0, 0.0, 86399.999999999);
    const year_month_day date{sys_days{std::chrono::days{static_cast<int>(days)}}};
    DateTime t;
    t.year = static_cast<int>(date.year());
    t.month = static_cast<int>(static_cast<unsigned>(date.month()));
    t.day = static_cast<int>(static_cast<unsigned>(date.day()));
    const int whole = static_cast<int>(second_of_day);
    t.hour = whole / 3600;
    t.minute = whole / 60 % 60;
    t.second = whole % 60;
    t.nanosecond = static_cast<std::int64_t>((second_of_day - whole) * 1e9);
    t.has_offset = true;
    t.offset_minutes = offset_minutes;
    return t;
}

}  // namespace obscura
