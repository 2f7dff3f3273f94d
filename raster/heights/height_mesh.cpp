#include "raster/heights/height_mesh.h"

#include <algorithm>

#include "core/error.h"
#include "core/planar_faces.h"

namespace obscura {
namespace {

class Maker {
  public:
    Maker(const HeightField& field, const HeightMeshParams& params) : field_(field), params_(params) {
        floor_m_ = metres_of(height_range(field).least_q16) - params.skirt_m;
    }

    Mesh make() {
        reserve();
        add_ground();
        add_normals();
        add_walls_and_floor();
        mesh_.component.assign(mesh_.triangles.size(), 0);
        mesh_.components = {
            {.closed = true, .triangles = static_cast<std::uint32_t>(mesh_.triangles.size())}};
        make_faces_of_triangles(mesh_);
        return std::move(mesh_);
    }

  private:
    struct Sample {
        int x, y;
    };

    void reserve() {
        const auto w = static_cast<std::size_t>(field_.width()),
                   h = static_cast<std::size_t>(field_.height());
        const std::size_t vertices = w * h + 10 * (w + h);
        mesh_.positions.reserve(vertices);
        mesh_.normals.reserve(vertices);
        mesh_.uvs.reserve(vertices);
        mesh_.triangles.reserve(
            static_cast<std::size_t>(height_mesh_triangles(field_.width(), field_.height())));
    }

    Vec3f position(Sample s, double height_m) const {
        const Vec3d p{(s.x - 0.5 * (field_.width() - 1)) * field_.cell_x_m, height_m,
                      (s.y - 0.5 * (field_.height() - 1)) * field_.cell_y_m};
        // Adding 0 makes -0 a 0: equal positions shall have equal bits.
        return to_float(params_.middle_m + p) + Vec3f{};
    }

    std::uint32_t add_vertex(Sample s, double height_m, Vec3f normal) {
        mesh_.positions.push_back(position(s, height_m));
        mesh_.normals.push_back(normal);
        mesh_.uvs.push_back({static_cast<float>((s.x + 0.5) / field_.width()),
                             static_cast<float>(1.0 - (s.y + 0.5) / field_.height())});
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }

    double height_m(Sample s) const { return metres_of(field_.height_q16(s.x, s.y)); }

    void add_ground() {
        for (int y = 0; y < field_.height(); ++y) {
            for (int x = 0; x < field_.width(); ++x)
                add_vertex({x, y}, height_m({x, y}), {});
        }
        const auto down = static_cast<std::uint32_t>(field_.width());
        for (int y = 0; y + 1 < field_.height(); ++y) {
            for (int x = 0; x + 1 < field_.width(); ++x) {
                const std::uint32_t a = static_cast<std::uint32_t>(y) * down + static_cast<std::uint32_t>(x);
                const std::uint32_t b = a + 1, c = a + down, d = c + 1;
                if (field_.diagonal == Diagonal::falling) {
                    mesh_.triangles.push_back({{a, d, b}});
                    mesh_.triangles.push_back({{a, c, d}});
                } else {
                    mesh_.triangles.push_back({{a, c, b}});
                    mesh_.triangles.push_back({{b, c, d}});
                }
            }
        }
    }

    void add_normals() {
        std::vector<Vec3d> sums(mesh_.positions.size());
        for (const Triangle& t : mesh_.triangles) {
            const Vec3d a = to_double(mesh_.positions[t.v[0]]);
            const Vec3d area =
                cross(to_double(mesh_.positions[t.v[1]]) - a, to_double(mesh_.positions[t.v[2]]) - a);
            for (const std::uint32_t v : t.v)
                sums[v] = sums[v] + area;
        }
        for (std::size_t v = 0; v < sums.size(); ++v)
            mesh_.normals[v] = to_float(normalize(sums[v]));
    }

    /// A wall below each step of the border, walked as the ground's triangles walk it: counter-clockwise seen
    /// from above.
    void add_walls_and_floor() {
        const int right = field_.width() - 1, bottom = field_.height() - 1;
        const std::uint32_t middle = add_vertex({0, 0}, floor_m_, {0, -1, 0});
        mesh_.positions[middle] = to_float(params_.middle_m + Vec3d{0, floor_m_, 0}) + Vec3f{};
        for (int x = right; x > 0; --x)
            add_wall({x, 0}, {x - 1, 0}, {0, 0, -1}, middle);
        for (int y = 0; y < bottom; ++y)
            add_wall({0, y}, {0, y + 1}, {-1, 0, 0}, middle);
        for (int x = 0; x < right; ++x)
            add_wall({x, bottom}, {x + 1, bottom}, {0, 0, 1}, middle);
        for (int y = bottom; y > 0; --y)
            add_wall({right, y}, {right, y - 1}, {1, 0, 0}, middle);
    }

    void add_wall(Sample from, Sample to, Vec3f normal, std::uint32_t middle) {
        const std::uint32_t a = add_vertex(from, height_m(from), normal),
                            b = add_vertex(to, height_m(to), normal);
        const std::uint32_t below_a = add_vertex(from, floor_m_, normal),
                            below_b = add_vertex(to, floor_m_, normal);
        mesh_.triangles.push_back({{b, a, below_a}});
        mesh_.triangles.push_back({{b, below_a, below_b}});
        const std::uint32_t floor_a = add_vertex(from, floor_m_, {0, -1, 0});
        const std::uint32_t floor_b = add_vertex(to, floor_m_, {0, -1, 0});
        mesh_.triangles.push_back({{middle, floor_b, floor_a}});
    }

    const HeightField& field_;
    const HeightMeshParams& params_;
    double floor_m_ = 0;
    Mesh mesh_;
};

}  // namespace

Mesh height_mesh(const HeightField& field, const HeightMeshParams& params) {
    check_height_field(field);
    CHECK(field.width() >= 2 && field.height() >= 2 && params.skirt_m > 0);
    return Maker(field, params).make();
}

}  // namespace obscura
