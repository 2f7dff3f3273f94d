#include "bench/shadows/wrong_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "raster/view.h"

namespace obscura {
namespace {

constexpr double grazing_cosine = 0.05;

/// The point that a lookup without filter compares for a receiver: on the receiver's plane at its texel's
/// centre, but no deeper than the receiver (filters/pcf.h).
Vec3d tested_point(const LightView& view, const Mat4& from_map, const Plane& plane, Vec3d receiver) {
    const Vec3d at = to_map_space(view, receiver);
    // Texels are chosen on the lookup's grid of 1/256.
    const double x = std::floor(std::nearbyint(at.x * 256.0) / 256.0) + 0.5;
    const double y = std::floor(std::nearbyint(at.y * 256.0) / 256.0) + 0.5;
    const Vec4d o = from_map * Vec4d{x, y, 0, 1}, d = from_map * Vec4d{0, 0, 1, 0};
    const Vec3d origin{o.x, o.y, o.z}, direction{d.x, d.y, d.z};
    const double depth = -(dot(plane.n, origin) + plane.d) / dot(plane.n, direction);
    return origin + direction * std::min(depth, at.z);
}

Wrong kind_of(const TrueShadows& scene, const SurfaceBlock& s, int at, Truth shown, const LightView& view,
              const Mat4& from_map) {
    if ((s.open[at / 16] >> (at & 15) & 1u) != 0) return Wrong::open;
    const Vec3d normal = to_double(Vec3f{s.gx[at], s.gy[at], s.gz[at]});
    if (dot(normal, scene.to_light) < grazing_cosine) return Wrong::grazing;
    const std::uint32_t face = scene.mesh->face[s.triangle[at]];
    const Plane& plane = scene.mesh->faces[face];
    const Vec3d receiver =
        on_plane(plane, scene.points->eye + to_double(Vec3f{s.px[at], s.py[at], s.pz[at]}));
    const Vec3d tested = tested_point(view, from_map, plane, receiver);
    const Truth there = scene.rays->occluded(tested, face, scene.to_light) ? Truth::dark : Truth::lit;
    return there == shown ? Wrong::outline : Wrong::interval;
}

void add(WrongPixels& sum, const WrongPixels& part) {
    sum.facing += part.facing;
    sum.wrong += part.wrong;
    sum.leaks += part.leaks;
    for (std::size_t k = 0; k < wrong_kinds; ++k)
        sum.by_kind[k] += part.by_kind[k];
}

}  // namespace

const char* wrong_name(Wrong kind) {
    switch (kind) {
        case Wrong::open:
            return "open surface";
        case Wrong::grazing:
            return "grazing light";
        case Wrong::outline:
            return "outline";
        case Wrong::interval:
            return "inside";
        case Wrong::off:
            return "off its triangle";
        case Wrong::edge:
            return "edge";
        case Wrong::beside:
            return "beside";
        case Wrong::unexplained:
            return "unexplained";
    }
    return "";
}

std::string kinds_text(const WrongPixels& wrong) {
    std::string text;
    for (std::size_t k = 0; k < wrong_kinds; ++k) {
        if (wrong.by_kind[k] == 0) continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", wrong.by_kind[k],
                            wrong_name(static_cast<Wrong>(k)));
    }
    return text;
}

TrueShadows true_shadows_of(const Scene& scene, const VisiblePoints& points, const ExactRays& rays,
                            const Exec& exec) {
    TrueShadows result;
    result.mesh = &scene.mesh;
    result.points = &points;
    result.rays = &rays;
    result.to_light = -normalize(scene.lights[0].light.direction);
    result.truth = true_shadows(rays, scene.mesh, points, result.to_light, exec);
    return result;
}

std::vector<std::uint8_t> shown_shadows(const VisiblePoints& points, const BlockLookup& lookup,
                                        const Exec& exec) {
    std::vector<std::uint8_t> shown(
        static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height), 0);
    parallel_for(points.blocks.size(), exec, [&](std::size_t b) {
        alignas(64) float visibility[block_samples];
        lookup(points.blocks[b], visibility);
        for (int at = 0; at < block_samples; ++at)
            shown[points.pixel(b, at)] = visibility[at] > 0.5f ? 1 : 0;
    });
    return shown;
}

WrongPixels count_wrong(const TrueShadows& scene, const std::vector<std::uint8_t>& shown,
                        const KindOfWrong& kind_of, const Exec& exec, std::vector<std::uint8_t>* kinds) {
    const VisiblePoints& points = *scene.points;
    if (kinds != nullptr) kinds->assign(scene.truth.size(), 0);
    std::vector<WrongPixels> parts(points.blocks.size());
    parallel_for(points.blocks.size(), exec, [&](std::size_t b) {
        WrongPixels& part = parts[b];
        for (int at = 0; at < block_samples; ++at) {
            const std::size_t pixel = points.pixel(b, at);
            const Truth truth = scene.truth[pixel];
            if (truth != Truth::lit && truth != Truth::dark) continue;
            ++part.facing;
            const Truth map = shown[pixel] != 0 ? Truth::lit : Truth::dark;
            if (map == truth) continue;
            ++part.wrong;
            if (map == Truth::lit) ++part.leaks;
            const Wrong kind = kind_of(b, at, map);
            ++part.by_kind[static_cast<std::size_t>(kind)];
            if (kinds != nullptr) (*kinds)[pixel] = static_cast<std::uint8_t>(1 + static_cast<int>(kind));
        }
    });
    WrongPixels sum;
    sum.covered = points.covered;
    for (const WrongPixels& part : parts)
        add(sum, part);
    return sum;
}

WrongPixels wrong_pixels(const TrueShadows& scene, const std::vector<std::uint8_t>& shown,
                         const LightView& view, const Exec& exec, std::vector<std::uint8_t>* kinds) {
    const Mat4 from_map = inverse(view.to_map);
    const auto kind_of_pixel = [&](std::size_t b, int at, Truth map) {
        return kind_of(scene, scene.points->blocks[b], at, map, view, from_map);
    };
    return count_wrong(scene, shown, kind_of_pixel, exec, kinds);
}

}  // namespace obscura
