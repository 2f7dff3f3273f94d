#include "raster/clip.h"

#include <array>
#include <tuple>
#include <utility>

namespace obscura {
namespace {

/// Signed distance-like function, linear in homogeneous coordinates; inside is >= 0.
struct ClipPlane {
    double x, y, z, w, constant;
    double at(const ClipVertex& v) const { return x * v.x + y * v.y + z * v.z + w * v.w + constant; }
};

ClipVertex crossing(const ClipPlane& plane, ClipVertex p, ClipVertex q) {
    if (std::tie(q.x, q.y, q.z, q.w) < std::tie(p.x, p.y, p.z, p.w)) std::swap(p, q);
    const double dp = plane.at(p), dq = plane.at(q);
    const double t = dp / (dp - dq);
    return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z), p.w + t * (q.w - p.w)};
}

std::vector<ClipVertex> clip_by(const ClipPlane& plane, const std::vector<ClipVertex>& in) {
    std::vector<ClipVertex> out;
    for (std::size_t i = 0; i < in.size(); ++i) {
        const ClipVertex& p = in[i];
        const ClipVertex& q = in[(i + 1) % in.size()];
        const bool p_inside = plane.at(p) >= 0, q_inside = plane.at(q) >= 0;
        if (p_inside) out.push_back(p);
        if (p_inside != q_inside) out.push_back(crossing(plane, p, q));
    }
    return out;
}

}  // namespace

std::vector<ClipVertex> clip_polygon(std::vector<ClipVertex> corners, const View& view) {
    const double g = guard_band_texels;
    const double right = view.width + g, bottom = view.height + g;
    const std::array<ClipPlane, 5> planes = {{
        // Near plane: w >= near for perspective; an orthographic view begins at Z = 0.
        view.perspective ? ClipPlane{0, 0, 0, 1, -view.near_w} : ClipPlane{0, 0, 1, 0, 0},
        {1, 0, 0, g, 0},        // X >= -g
        {-1, 0, 0, right, 0},   // X <= width + g
        {0, 1, 0, g, 0},        // Y >= -g
        {0, -1, 0, bottom, 0},  // Y <= height + g
    }};
    for (const ClipPlane& plane : planes) {
        corners = clip_by(plane, corners);
        if (corners.size() < 3) return {};
    }
    return corners;
}

}  // namespace obscura
