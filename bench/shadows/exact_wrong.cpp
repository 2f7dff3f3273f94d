#include "bench/shadows/exact_wrong.h"

#include <cmath>

#include "raster/exact/exact_shadow.h"

namespace obscura {
namespace {

/// A block as points that ask.
struct BlockPoints {
    double px[block_samples], py[block_samples], pz[block_samples];
    std::uint32_t face[block_samples];
    ExactPoints points{};

    BlockPoints(const SurfaceBlock& s, const Mesh& mesh, const ExactLight& light) {
        exact_positions(s, mesh, {light.eye[0], light.eye[1], light.eye[2]}, px, py, pz, face);
        points = {block_samples, px, py, pz, s.gx, s.gy, s.gz, face, s.triangle, s.covered, s.thin};
    }
};

Vec3d vec(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

/// Where the ray of picture position (x, y) meets the plane; `otherwise` where it does not before the eye.
Vec3d seen_at(const CameraRays& c, double x, double y, const Plane& plane, Vec3d otherwise) {
    const Vec3d origin = vec(c.eye) + vec(c.origin0) + vec(c.origin_x) * x + vec(c.origin_y) * y;
    const Vec3d direction = vec(c.dir0) + vec(c.dir_x) * x + vec(c.dir_y) * y;
    const double t = -(dot(plane.n, origin) + plane.d) / dot(plane.n, direction);
    return t > 0 && std::isfinite(t) ? origin + direction * t : otherwise;
}

/// A wrong sample, and all that is asked of it.
class WrongSample {
  public:
    WrongSample(const ExactPicture& picture, std::size_t block, int at)
        : scene_(*picture.scene), light_(*picture.light), camera_(picture.camera), block_(block), at_(at) {
        const SurfaceBlock& s = scene_.points->blocks[block];
        const Vec3f p{s.px[at], s.py[at], s.pz[at]};
        triangle_ = s.triangle[at];
        face_ = scene_.mesh->face[triangle_];
        given_ = scene_.points->eye + to_double(p);
        place_ = seen_point(*scene_.mesh, triangle_, given_);
        const std::size_t pixel = scene_.points->pixel(block, at);
        const auto width = static_cast<std::size_t>(scene_.points->width);
        const std::size_t row = pixel / width;
        x_ = static_cast<double>(pixel % width) + 0.5;
        y_ = static_cast<double>(row) + 0.5;
        const float reach = std::fabs(dot(p, Vec3f{s.gx[at], s.gy[at], s.gz[at]}));
        uncertain_m_ = static_cast<double>(exact_depth_error * reach) + step_m();
    }

    bool is_off_its_triangle() const {
        const Vec3d p = seen_at(camera_, x_, y_, plane(), place_);
        Vec3d corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = to_double(scene_.mesh->positions[scene_.mesh->triangles[triangle_].v[k]]);
        const Vec3d n = cross(corner[1] - corner[0], corner[2] - corner[0]);
        for (int k = 0; k < 3; ++k) {
            const Vec3d edge = corner[(k + 1) % 3] - corner[k];
            if (dot(n, cross(edge, p - corner[k])) < 0) return true;
        }
        return false;
    }

    bool is_at_an_edge(Truth shown) const {
        // Any two directions across the light.
        const Vec3d apart = std::fabs(scene_.to_light.y) < 0.7 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
        const Vec3d u = normalize(cross(scene_.to_light, apart)), v = cross(scene_.to_light, u);
        for (int side = 0; side < 9; ++side) {
            const int row = side / 3 - 1;
            const double i = side % 3 - 1, j = row;
            if (side == 4) continue;
            const Vec3d on_picture = seen_at(camera_, x_ + i / 256, y_ + j / 256, plane(), place_);
            if (rays_say(on_picture, shown) || rays_say(place_ + (u * i + v * j) * step_m(), shown))
                return true;
        }
        return false;
    }

    bool is_beside(Truth shown) const {
        if (rays_say_beside(plane(), shown)) return true;
        // What is just as near by as the method allows rounds to either side.
        const double within = uncertain_m_ * (1 + 1e-6);
        if (shown == Truth::lit) {
            return !scene_.rays->occluded_beyond(place_, face_, scene_.to_light, within) ||
                   !scene_.rays->occluded_beyond(given_, face_, scene_.to_light, within);
        }
        const BlockPoints points(scene_.points->blocks[block_], *scene_.mesh, light_);
        const std::uint32_t caster = ref::exact_shadow(points.points, light_, at_).triangle;
        return rays_say_beside(scene_.mesh->faces[scene_.mesh->face[caster]], shown);
    }

  private:
    const Plane& plane() const { return scene_.mesh->faces[face_]; }
    double step_m() const { return light_.view[0].step_m; }
    bool rays_say(Vec3d p, Truth shown) const {
        return scene_.rays->occluded(p, face_, scene_.to_light) == (shown == Truth::dark);
    }
    bool rays_say_beside(const Plane& of, Truth shown) const {
        return rays_say(place_ + of.n * uncertain_m_, shown) || rays_say(place_ - of.n * uncertain_m_, shown);
    }

    const TrueShadows& scene_;
    const ExactLight& light_;
    const CameraRays& camera_;
    std::size_t block_;
    int at_;
    std::uint32_t triangle_ = 0, face_ = 0;
    Vec3d given_, place_;   ///< as floats have it; on its plane
    double x_ = 0, y_ = 0;  ///< of its pixel's centre
    double uncertain_m_ = 0;
};

}  // namespace

BlockLookup exact_lookup(const Mesh& mesh, const ExactLight& light, Isa isa) {
    return [&mesh, light, isa](const SurfaceBlock& surface, float* visibility) {
        const BlockPoints block(surface, mesh, light);
        std::uint32_t lit[block_groups];
        ExactCounts counts;
        ExactWork(block_samples).shadows(block.points, light, isa, lit, counts);
        for (int i = 0; i < block_samples; ++i)
            visibility[i] = (lit[i / 16] >> (i % 16) & 1u) != 0 ? 1.0f : 0.0f;
    };
}

Wrong kind_of_exact(const ExactPicture& picture, std::size_t block, int at, Truth shown) {
    const WrongSample sample(picture, block, at);
    if (sample.is_off_its_triangle()) return Wrong::off;
    if (sample.is_at_an_edge(shown)) return Wrong::edge;
    return sample.is_beside(shown) ? Wrong::beside : Wrong::unexplained;
}

}  // namespace obscura
