#include "app/frame/shadow_resolution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/frame/scene_light.h"
#include "app/frame/stack_shadow.h"
#include "core/parallel.h"
#include "core/vec_arrays.h"
#include "filters/shadow_lookup.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

/// Surfaces that light meets at a smaller cosine count as if it were this.
constexpr double least_cosine = 1.0 / 8.0;

Vec3d row_axis(const double (&m)[4]) {
    return {m[0], m[1], m[2]};
}

/// The least singular value of the matrix with columns (ax, ay) and (bx, by).
double least_singular_value(double ax, double ay, double bx, double by) {
    const double det = std::fabs(ax * by - ay * bx), square = ax * ax + ay * ay + bx * bx + by * by;
    const double largest =
        std::sqrt(0.5 * (square + std::sqrt(std::max(square * square - 4 * det * det, 0.0))));
    return largest > 0 ? det / largest : 0.0;
}

/// How the point that a pixel's ray meets moves over the surface's plane per pixel.
struct SurfaceSteps {
    Vec3d right, down;
    bool edge_on = false;
};

SurfaceSteps surface_steps(const CameraRays& rays, Vec3d normal, double z, double x, double y) {
    const Vec3d dir = vec(rays.dir0) + vec(rays.dir_x) * x + vec(rays.dir_y) * y;
    const double across = dot(normal, dir);
    SurfaceSteps steps;
    steps.edge_on = std::fabs(across) < 1e-9 * length(dir);
    if (steps.edge_on) return steps;
    const auto step = [&](Vec3d origin_step, Vec3d dir_step) {
        const Vec3d moved = origin_step + dir_step * z;
        return moved - dir * (dot(normal, moved) / across);
    };
    steps.right = step(vec(rays.origin_x), vec(rays.dir_x));
    steps.down = step(vec(rays.origin_y), vec(rays.dir_y));
    return steps;
}

Vec3d towards(const PcfLight& light, Vec3d p) {
    if (light.directional) return to_double(Vec3f{light.to_light[0], light.to_light[1], light.to_light[2]});
    return to_double(Vec3f{light.position[0], light.position[1], light.position[2]}) - p;
}

/// The pixel of a tile that needs most, light by light.
struct Need {
    double texels = std::numeric_limits<double>::infinity();
    int x = -1, y = -1;
};

/// Footprint of a sample on the largest map, as the rule counts it; infinity when it does not ask.
double needed_texels(const TileScene& tiles, const PcfLight& light, double range_m, const SurfaceBlock& s,
                     int at, double x, double y) {
    const double none = std::numeric_limits<double>::infinity();
    const ref::PcfPlace place = ref::pcf_place(s, light, at);
    const double size = light.view[place.view].size;
    if (place.kind != ref::PcfPlace::on_map || place.X < 0 || place.Y < 0 || place.X >= size ||
        place.Y >= size) {
        return none;
    }
    const Vec3d p = to_double(Vec3f{s.px[at], s.py[at], s.pz[at]}),
                n = to_double(Vec3f{s.gx[at], s.gy[at], s.gz[at]}), to_light = towards(light, p);
    const double distance = length(to_light), cosine = std::fabs(dot(n, to_light)) / distance;
    if (!light.directional && distance > range_m) return none;
    const double texels = footprint_texels(tiles.rays, light.view[place.view], s, at, x, y);
    if (!(texels > 0) || !(cosine > 0)) return none;
    return texels * std::max(1.0, least_cosine / cosine);
}

/// Tile by tile, light by light.
std::vector<Need> needs_of_tiles(const TileScene& tiles, std::span<const ResolutionQuery> queries,
                                 std::span<const PcfLight> lights, const Exec& exec) {
    const SamplePosition sample = tiles.pattern[0];
    std::vector<Need> needs(tiles.bins->tiles() * queries.size());
    parallel_for(tiles.bins->tiles(), exec, [&](std::size_t i) {
        TileWork work;  // not initialised: every stage writes what the next one reads
        walk_tile(tiles, i, sample, exec.isa, work, [&](int x, int y, int at) {
            // What is seen only as glare does not decide.
            if (!tiles.in_picture(x, y)) return;
            for (std::size_t l = 0; l < queries.size(); ++l) {
                Need& need = needs[i * queries.size() + l];
                const double texels =
                    needed_texels(tiles, lights[l], queries[l].light->light.range_m, work.surface, at,
                                  x + sample.x / 256.0, y + sample.y / 256.0);
                if (texels < need.texels) need = {texels, x, y};
            }
        });
    });
    return needs;
}

FoundResolution resolution_for(const ResolutionQuery& query, const Need& need) {
    FoundResolution found;
    if (!(need.texels < std::numeric_limits<double>::infinity())) return found;
    found.x = need.x;
    found.y = need.y;
    const auto texel = [&](int n) { return texel_size_m(query.views(n)[0]); };
    const double finest = texel(query.most);
    for (int n = least_map_resolution;; n *= 2) {
        found.resolution = n;
        found.magnification = texel(n) / finest / need.texels;
        found.capped = found.magnification > query.light->shadow.max_magnification;
        if (!found.capped || n == query.most) return found;
    }
}

}  // namespace

ResolutionQuery tree_query(const SceneLight& light, const Bounds& casters) {
    return {&light, most_map_resolution,
            [&light, casters](int n) { return fitted_shadow_views(light, casters, n); }};
}

ResolutionQuery stack_query(const Mesh& mesh, const SceneLight& light) {
    const StackPlan plan = plan_stack(mesh, light);
    const auto distance = [&](const Light& point) {
        return is_parallel(point.kind) ? length(normalize(point.direction) - normalize(light.light.direction))
                                       : length(point.position - light.light.position);
    };
    const auto middle =
        std::min_element(plan.points.begin(), plan.points.end(),
                         [&](const Light& a, const Light& b) { return distance(a) < distance(b); });
    const auto k = static_cast<int>(middle - plan.points.begin());
    return {&light, most_auto_stack_resolution,
            [&mesh, plan, k](int n) { return std::vector<LightView>{stack_views(mesh, plan, n).view(k)}; }};
}

double footprint_texels(const CameraRays& rays, const PcfView& view, const SurfaceBlock& s, int at, double x,
                        double y) {
    const Vec3d p = to_double(Vec3f{s.px[at], s.py[at], s.pz[at]}),
                n = to_double(Vec3f{s.gx[at], s.gy[at], s.gz[at]});
    const SurfaceSteps steps =
        surface_steps(rays, n, static_cast<double>(view_distance(rays, s.depth[at])), x, y);
    if (steps.edge_on) return 0;
    // X = (row 0 . p) / w, so dX = (row 0 - X row 3) . dp / w, and the same for Y.
    const double w = view.perspective ? row_at(view.to_map[3], p) : 1.0;
    Vec3d across = row_axis(view.to_map[0]), down = row_axis(view.to_map[1]);
    if (view.perspective) {
        across = across - row_axis(view.to_map[3]) * (row_at(view.to_map[0], p) / w);
        down = down - row_axis(view.to_map[3]) * (row_at(view.to_map[1], p) / w);
    }
    const double scale = 1.0 / w;
    return least_singular_value(dot(across, steps.right) * scale, dot(down, steps.right) * scale,
                                dot(across, steps.down) * scale, dot(down, steps.down) * scale);
}

std::vector<FoundResolution> find_resolutions(std::span<const TileScene> pictures, Vec3d eye,
                                              std::span<const ResolutionQuery> queries, const Exec& exec) {
    std::vector<PcfLight> lights;
    for (const ResolutionQuery& q : queries) {
        lights.push_back(pcf_light(*q.light, q.views(q.most), eye));
    }
    std::vector<Need> most(queries.size());
    for (const TileScene& tiles : pictures) {
        const std::vector<Need> needs = needs_of_tiles(tiles, queries, lights, exec);
        for (std::size_t i = 0; i < needs.size(); ++i) {
            Need& need = most[i % queries.size()];
            if (needs[i].texels < need.texels) need = needs[i];
        }
    }
    std::vector<FoundResolution> found;
    for (std::size_t l = 0; l < queries.size(); ++l)
        found.push_back(resolution_for(queries[l], most[l]));
    return found;
}

}  // namespace obscura
