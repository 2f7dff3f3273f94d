#pragma once
// Scenes of stereo/limits.md, and what is measured on their pairs.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/pair/pair.h"
#include "app/scene/build.h"
#include "core/error.h"
#include "stereo/conflict.h"
#include "stereo/map_projection.h"

namespace obscura::stereo_limits {

// --- scenes: a camera 5 m before the origin, the screen at the origin

constexpr double focal_px = 403.06;  ///< of pictures 216 pixels high

inline std::string list(Vec3d v) {
    return fmt::format("[{}, {}, {}]\n", v.x, v.y, v.z);
}

inline std::string mesh(const std::string& id, const std::string& shape, Vec3d at,
                        const std::string& material = "stone") {
    return "[[mesh]]\nid = \"" + id + "\"\nshape = \"" + shape + "\ntranslate_m = " + list(at) +
           (material.empty() ? "" : "material = \"" + material + "\"\n");
}
inline std::string box(const std::string& id, Vec3d size, Vec3d at, const std::string& material = "stone") {
    return mesh(id, "box\"\nsize_m = " + list(size), at, material);
}
inline std::string ball(const std::string& id, double radius, Vec3d at,
                        const std::string& material = "clay") {
    return mesh(id, fmt::format("sphere\"\nradius_m = {}\n", radius), at, material);
}
/// 7.9 m from the camera, wider than the picture; original disparity -2.96 pixels.
inline std::string wall() {
    return box("wall", {16, 10, 0.2}, {0, 0, -3}, "plaster");
}

inline std::string edit(const std::string& id, const std::string& type, const std::string& objects,
                        const std::string& keys) {
    return "[[stereo.edit]]\nid = \"" + id + "\"\ntype = \"" + type + "\"\n" +
           (objects.empty() ? "" : "objects = [\"" + objects + "\"]\n") + keys + "\n";
}
inline std::string anchor(const std::string& object, double offset_px, double weight = 1) {
    return edit(object + "_at", "anchor", object,
                fmt::format("offset_px = {}\nweight = {}", offset_px, weight));
}
inline std::string roundness(const std::string& object, double factor) {
    return edit(object + "_round", "roundness", object, fmt::format("roundness = {}", factor));
}

struct Case {
    SceneDocument document;
    Scene scene;
    StereoSettings settings;
    std::uint32_t object(const std::string& name) const {
        for (std::uint32_t i = 0; i < scene.mesh.objects.size(); ++i) {
            if (scene.mesh.objects[i].name == name) return i;
        }
        CHECK(false, name);
        return 0;
    }
    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const Object& o : scene.mesh.objects)
            all.push_back(o.name);
        return all;
    }
};

/// `keys` of [stereo], then meshes and edits.
inline Case made(const std::string& keys, const std::string& rest, int width = 384, int height = 216) {
    const std::string text =
        "format = 1\n[camera]\neye_m = [0, 0, 5]\nlook_at_m = [0, 0, 0]\nvfov_deg = 30\n"
        "[stereo]\ninteraxial_m = 0.1\n" +
        keys + fmt::format("\n[render]\nsize_px = [{}, {}]\nsamples = 1\n", width, height) +
        "[material.stone]\nbase_color = [0.62, 0.58, 0.5]\n[material.clay]\nbase_color = [0.6, 0.2, 0.1]\n"
        "[material.plaster]\nbase_color = [0.5, 0.53, 0.58]\n"
        "[[light]]\nid = \"sun\"\ntype = \"directional\"\nazimuth_deg = 215\nelevation_deg = 40\n"
        "irradiance_w_m2 = 2.6\n[shadow.sun]\nresolution = 512\n" +
        rest;
    Case made;
    made.document = read_scene_text(text, "s.toml");
    made.scene = build_scene(made.document, FileAccess{});
    made.settings = stereo_settings(made.document, made.scene, 1, FileAccess{});
    return made;
}

inline StereoPair pair_of(const Case& c, bool pictures = true) {
    StereoCache cache;
    StereoPair pair;
    StereoPairOptions options;
    options.pictures = pictures;
    render_stereo_pair(c.scene, c.settings, options, Exec{}, cache, pair);
    return pair;
}

// --- measures

inline double change_at(const StereoPair& pair, int x, int y) {
    return static_cast<double>(pair.optimised(x, y)) - static_cast<double>(pair.view.disparity(x, y));
}

struct Range {
    double mean = 0, low = 1e9, high = -1e9;
    std::int64_t pixels = 0;
};
/// Change of disparity over an object.
inline Range change_of(const StereoPair& pair, std::uint32_t object) {
    Range r;
    for (int y = 0; y < pair.view.height(); ++y) {
        for (int x = 0; x < pair.view.width(); ++x) {
            if (pair.view.object(x, y) != object) continue;
            const double c = change_at(pair, x, y);
            r.mean += c;
            r.low = std::min(r.low, c);
            r.high = std::max(r.high, c);
            ++r.pixels;
        }
    }
    r.mean /= static_cast<double>(std::max<std::int64_t>(r.pixels, 1));
    return r;
}

/// Steepest horizontal step of the change between neighbours that are both of `object`: an eye sees the
/// surface there wider or narrower by half of it.
inline double steepest(const StereoPair& pair, std::uint32_t object) {
    double most = 0;
    for (int y = 0; y < pair.view.height(); ++y) {
        for (int x = 0; x + 1 < pair.view.width(); ++x) {
            if (pair.view.object(x, y) == object && pair.view.object(x + 1, y) == object)
                most = std::max(most, std::fabs(change_at(pair, x + 1, y) - change_at(pair, x, y)));
        }
    }
    return most;
}

inline Conflicts left_over(const Case& c, const StereoPair& pair) {
    ConflictLimits limits;
    limits.comfort = c.settings.edit.comfort;
    return find_conflicts(pair.view, pair.optimised, limits, c.names());
}
inline std::int64_t before_solve(const StereoPair& pair, ConflictKind kind) {
    std::int64_t sum = 0;
    for (const Conflict& conflict : pair.edited.conflicts)
        sum += conflict.kind == kind ? conflict.pixels : 0;
    return sum;
}

/// "a 3.0 of 4.0 against b, gradients 1.2": what the report names.
inline std::string named(const SolveReport& report) {
    std::string text;
    for (const Unsatisfied& u : report.unsatisfied) {
        text += fmt::format("{}{} {:.1f}", text.empty() ? "" : ", ",
                            u.name.empty() ? std::string("steps") : u.name, u.worst_px);
        if (!u.against.empty()) text += " against " + u.against;
    }
    return text.empty() ? "nothing" : text;
}
inline const Unsatisfied* entry(const SolveReport& report, const std::string& name) {
    for (const Unsatisfied& u : report.unsatisfied) {
        if (u.name == name) return &u;
    }
    return nullptr;
}

/// Which object an eye sees; nothing_seen where none.
inline std::uint32_t seen_object(const Scene& scene, const EyeMap& map, int x, int y) {
    const std::uint32_t t = map.triangle(x, y);
    return t == nothing_seen ? nothing_seen : scene.mesh.object[t];
}
/// Mean pixels per row that an eye sees of an object, over the rows in the middle half of the picture.
inline double width_in(const Scene& scene, const EyeMap& map, std::uint32_t object) {
    std::int64_t pixels = 0;
    const int height = map.triangle.height, from = height / 4, to = height - height / 4;
    for (int y = from; y < to; ++y) {
        for (int x = 0; x < map.triangle.width; ++x)
            pixels += seen_object(scene, map, x, y) == object ? 1 : 0;
    }
    return static_cast<double>(pixels) / (to - from);
}

struct Difference {
    double rms = 0, max = 0;
    std::int64_t pixels = 0;
};
class DifferenceSum {
  public:
    void add(double difference) {
        squares_ += difference * difference;
        max_ = std::max(max_, std::fabs(difference));
        ++pixels_;
    }
    Difference result() const {
        return {pixels_ == 0 ? 0.0 : std::sqrt(squares_ / static_cast<double>(pixels_)), max_, pixels_};
    }

  private:
    double squares_ = 0, max_ = 0;
    std::int64_t pixels_ = 0;
};

}  // namespace obscura::stereo_limits
