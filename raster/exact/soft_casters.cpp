#include "raster/exact/soft_casters.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "raster/record.h"
#include "raster/shadow_map.h"
#include "raster/view.h"

namespace obscura {

namespace {

/// Part k of a group as it sees the mesh: as its own casters would.
void set_part(const Mesh& mesh, const Light& light, std::size_t k, ExactParts& parts) {
    const ShadowViewParams params{exact_view_texels, 1023};
    const LightView view = fitted_shadow_views(light, params, caster_box(mesh, light.direction))[0];
    const Vec3d way = -light.direction;
    const Vec3f to_light = to_float(-normalize(light.direction));
    const double to[3] = {way.x, way.y, way.z};
    const float unit[3] = {to_light.x, to_light.y, to_light.z};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            parts.to_map[r][c][k] = view.to_map.m[r][c];
        parts.way[r][k] = to[r];
        parts.to_light[r][k] = unit[r];
    }
    parts.step_m[k] = static_cast<float>(texel_size_m(view) / subtexel_one);
}

/// How many of the middle's steps, the shorter way, the longest of a part may span: a view is fitted to what
/// casts, as it is seen from there.
std::int32_t coarsest_steps(const SoftParts& parts, const ExactView& middle) {
    const auto finest = [](const double(&row)[4]) { return length(Vec3d{row[0], row[1], row[2]}); };
    const double steps_per_m = std::max(finest(middle.to_map[0]), finest(middle.to_map[1]));
    double ratio = 1;
    for (const ExactParts& group : parts.groups) {
        for (std::size_t k = 0; k < 16; ++k) {
            for (int r = 0; r < 2; ++r) {
                const Vec3d row{group.to_map[r][0][k], group.to_map[r][1][k], group.to_map[r][2][k]};
                ratio = std::max(ratio, steps_per_m / length(row));
            }
        }
    }
    return static_cast<std::int32_t>(std::min(std::ceil(ratio), 0x1p20));
}

}  // namespace

SoftParts soft_parts(const Mesh& mesh, std::span<const Light> lights, const Exec& exec) {
    constexpr std::size_t group = 16, block = 4096;
    SoftParts all;
    all.groups.resize((lights.size() + group - 1) / group);
    all.vertices.resize(all.groups.size());
    parallel_for(all.groups.size() * group, exec, [&](std::size_t i) {
        const std::size_t first = i / group * group;
        set_part(mesh, lights[i < lights.size() ? i : first], i % group, all.groups[i / group]);
    });
    for (std::size_t g = 0; g < all.groups.size(); ++g) {
        ExactParts& parts = all.groups[g];
        parts.count = static_cast<std::int32_t>(std::min(lights.size() - g * group, group));
        all.vertices[g].reset(mesh.positions.size());
        parts.vertices = all.vertices[g].data();
        parallel_blocks(mesh.positions.size(), block, exec, [&](std::size_t begin, std::size_t end) {
            OBSCURA_DISPATCH(exec.isa, exact_see, &mesh.positions.data()->x, begin, end, parts,
                             all.vertices[g].data());
        });
    }
    return all;
}

std::int64_t soft_parts_bytes(std::int64_t vertices) {
    return vertices * std::int64_t{sizeof(PartVertex)} + std::int64_t{sizeof(ExactParts)};
}

ExactSoft exact_soft_light(const Light& light, const ExactLight& middle, const SoftParts& parts,
                           const Mesh& mesh) {
    static_assert(sizeof(Plane) == 4 * sizeof(double));
    CHECK(parts.groups.size() <= most_soft_groups);
    ExactSoft soft;
    soft.middle = middle;
    soft.spread = exact_spread(light, middle);
    soft.spread.slack += 2 * coarsest_steps(parts, middle.view[0]);
    soft.corners = mesh.triangles.empty() ? nullptr : &mesh.triangles[0].v[0];
    soft.planes = mesh.faces.empty() ? nullptr : reinterpret_cast<const double(*)[4]>(mesh.faces.data());
    soft.parts = parts.groups.data();
    soft.groups = static_cast<std::int32_t>(parts.groups.size());
    return soft;
}

}  // namespace obscura
