#include "app/pair/realised.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// The middle camera's frame and focal length.
struct Projection {
    Vec3d eye;
    Basis basis;
    double focal_px, centre_x, centre_y;

    Projection(const Camera& camera, int width, int height)
        : eye(camera.eye),
          basis(look_basis(camera.look_at - camera.eye, camera.up)),
          focal_px(disparity_law({}, camera, height).focal_px),
          centre_x(0.5 * width),
          centre_y(0.5 * height) {}
    double column(Vec3d relative) const {
        return centre_x + focal_px * dot(relative, basis.right) / dot(relative, basis.forward);
    }
    Vec3d ray(double x, double y) const {
        return basis.forward + basis.right * ((x - centre_x) / focal_px) -
               basis.up * ((y - centre_y) / focal_px);
    }
};

/// Weights of a triangle's corners where a ray from the origin meets it: Moeller and Trumbore's volumes,
/// clamped to the triangle as rendering clamps them.
struct Weights {
    double b0 = 1, b1 = 0, b2 = 0;
};
Weights weights_of(const Vec3d (&corner)[3], Vec3d dir) {
    const Vec3d e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], s = -corner[0];
    const double det = dot(dir, cross(e2, e1));
    Weights w;
    if (det == 0) return w;
    w.b1 = std::clamp(dot(dir, cross(e2, s)) / det, 0.0, 1.0);
    w.b2 = std::clamp(dot(dir, cross(s, e1)) / det, 0.0, 1.0 - w.b1);
    w.b0 = 1 - w.b1 - w.b2;
    return w;
}

Vec3d mixed(const Triangle& t, const Weights& w, const std::vector<Vec3f>& positions, Vec3d eye) {
    return (to_double(positions[t.v[0]]) - eye) * w.b0 + (to_double(positions[t.v[1]]) - eye) * w.b1 +
           (to_double(positions[t.v[2]]) - eye) * w.b2;
}

}  // namespace

void ErrorSum::add(double difference_px) {
    const double size = std::fabs(difference_px);
    ++pixels_;
    within_ += size <= tolerance_px_ ? 1 : 0;
    max_ = std::max(max_, size);
    squares_ += size * size;
}

void ErrorSum::add(const ErrorSum& part) {
    pixels_ += part.pixels_;
    within_ += part.within_;
    max_ = std::max(max_, part.max_);
    squares_ += part.squares_;
}

DisparityError ErrorSum::error() const {
    const double mean = pixels_ == 0 ? 0.0 : squares_ / static_cast<double>(pixels_);
    return {pixels_, within_, max_, std::sqrt(mean)};
}

RealisedDisparity realised_disparity(const Scene& scene, const MovedMesh& moved, const EyeStage& left,
                                     const EyeStage& right, const MiddleView& view,
                                     const DisparityMap& optimised, double tolerance_px, const Exec& exec,
                                     RasterScratch& scratch) {
    CHECK(view.reduction == 1 && optimised.width == view.width() && optimised.height == view.height());
    const int width = view.picture_width, height = view.picture_height;
    RealisedDisparity realised;
    realised.disparity = DisparityMap(width, height, std::numeric_limits<float>::quiet_NaN());
    if (moved.mesh.triangles.empty()) return realised;

    // Which moved triangle the middle camera sees: its corners where they truly are.
    TileScene tiles = tile_scene(scene, width, height, 1);
    set_up_triangles(moved.mesh, exec, scratch, tiles);
    const Projection projection(scene.camera, width, height);
    std::vector<ErrorSum> sums(tiles.bins->tiles(), ErrorSum(tolerance_px));
    parallel_for(tiles.bins->tiles(), exec, [&](std::size_t i) {
        TileWork work;  // not initialised: visibility writes what is read
        const Region inside = tiles.bins->inside(i);
        const int column = static_cast<int>(i) % tiles.bins->columns;
        const TileRect tile = tile_visibility(tiles, column, static_cast<int>(i) / tiles.bins->columns,
                                              {128, 128}, exec.isa, work);
        for (int row = 0; row < inside.height; ++row) {
            for (int c = 0; c < inside.width; ++c) {
                const std::uint32_t id = work.triangle[row * frame_tile_side + c];
                const int x = tile.x0 + c, y = tile.y0 + row;
                if (id == nothing_seen) continue;
                const Triangle& t = moved.mesh.triangles[id];
                const Vec3d corner[3] = {to_double(moved.mesh.positions[t.v[0]]) - projection.eye,
                                         to_double(moved.mesh.positions[t.v[1]]) - projection.eye,
                                         to_double(moved.mesh.positions[t.v[2]]) - projection.eye};
                const Weights w = weights_of(corner, projection.ray(x + 0.5, y + 0.5));
                const double d = projection.column(mixed(t, w, left.seen, projection.eye)) -
                                 projection.column(mixed(t, w, right.seen, projection.eye));
                realised.disparity(x, y) = static_cast<float>(d);
                const int map_x = x + view.margin_px;
                if (view.triangle(map_x, y) != nothing_seen)
                    sums[i].add(d - static_cast<double>(optimised(map_x, y)));
            }
        }
    });
    ErrorSum all(tolerance_px);
    for (const ErrorSum& part : sums)
        all.add(part);
    realised.error = all.error();
    return realised;
}

DisparityError picture_error(const EyeMap& map, Eye eye, const MiddleView& view,
                             const DisparityMap& optimised, double tolerance_px) {
    ErrorSum sum(tolerance_px);
    const double side = eye == Eye::left ? 0.5 : -0.5;
    for (int y = 0; y < map.triangle.height; ++y) {
        for (int x = 0; x < map.triangle.width; ++x) {
            const std::uint32_t t = map.triangle(x, y);
            if (t == nothing_seen) continue;
            // Where the middle camera sees the point, from the centre of the pixel to the left of it.
            const double d = static_cast<double>(map.disparity(x, y));
            const double at = x + 0.5 - side * d + view.margin_px - 0.5;
            if (!(at >= 0 && at < view.width() - 1)) continue;
            const int i = static_cast<int>(at);
            if (view.triangle(i, y) != t || view.triangle(i + 1, y) != t) continue;
            const double share = at - i;
            sum.add(d - ((1 - share) * static_cast<double>(optimised(i, y)) +
                         share * static_cast<double>(optimised(i + 1, y))));
        }
    }
    return sum.error();
}

}  // namespace obscura
