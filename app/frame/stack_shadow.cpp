#include "app/frame/stack_shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "app/frame/shadow_cache.h"
#include "app/frame/shadow_text.h"
#include "app/frame/shadows.h"
#include "app/frame/stack_tile.h"
#include "core/count_text.h"
#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "hierarchy/build_memory.h"
#include "raster/light_samples.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// Anisotropies that are tried, side by side.
constexpr int tried = 3;

/// Of a node while octrees grow side by side, with maps and lists, and of one that is serialised, on average.
constexpr std::int64_t node_work_bytes = 32 * tried, stack_node_bytes = 5;

/// Share of what a light may shine on that its maps need not see.
constexpr double most_unseen = 1.0 / 8;

/// Texels a side, or the most that the picture may ask for.
std::int64_t side_of(const SceneLight& light) {
    return light.shadow.resolution == auto_resolution ? most_auto_stack_resolution : light.shadow.resolution;
}

/// Nodes of a stack, expected: of every map 100 for a texel of its side, or fewer where triangles are few
/// (README.md has what scenes have).
std::int64_t nodes_of(const SceneLight& light, std::int64_t triangles) {
    constexpr std::int64_t sides = 2048;  // at which scenes have about one for a triangle
    const std::int64_t side = side_of(light);
    return std::min(100 * side, triangles * side / sides) * light.shadow.samples;
}

Vec3d middle_of(const Mesh& mesh, const Triangle& t) {
    return (to_double(mesh.positions[t.v[0]]) + to_double(mesh.positions[t.v[1]]) +
            to_double(mesh.positions[t.v[2]])) *
           (1.0 / 3);
}

double area_of(const Mesh& mesh, const Triangle& t) {
    const Vec3d p = to_double(mesh.positions[t.v[0]]), q = to_double(mesh.positions[t.v[1]]),
                r = to_double(mesh.positions[t.v[2]]);
    return 0.5 * length(cross(q - p, r - p));
}

/// Whether the light may shine on what is there, were nothing else.
bool may_shine_on(const Light& light, Vec3d p) {
    if (is_parallel(light.kind)) return true;
    const Vec3d way = p - light.position;
    const double distance = length(way), along = dot(way, light.direction);
    if (distance > light.range_m) return false;
    if (light.kind == LightKind::spot) return along >= num::cos_deg(light.outer_cone_deg) * distance;
    return light.kind != LightKind::area || light.two_sided || along > 0;
}

/// A plane that the maps may be aimed at, and how far from it, along the light's way, things are on average.
struct Candidate {
    FocusParams focus;
    double mean_way = 0;
};

std::optional<Candidate> candidate_of(const Mesh& mesh, const Light& light, const LightSamples& samples,
                                      Vec3d normal) {
    double lowest = std::numeric_limits<double>::infinity();  // sample, above the origin
    if (!samples.directional) {
        for (const Vec3d& sample : samples.at)
            lowest = std::min(lowest, dot(normal, sample));
    }
    Candidate c;
    c.focus.plane_normal = normal;
    c.focus.plane_point = median_plane_point(mesh, normal, lowest);
    if (!can_focus(samples, c.focus)) return {};
    const double plane = dot(normal, c.focus.plane_point),
                 near = samples.directional ? lowest : lowest - c.focus.near_share * (lowest - plane);
    double all = 0, unseen = 0, way = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d p = middle_of(mesh, t);
        if (!may_shine_on(light, p)) continue;
        const double area = area_of(mesh, t), height = dot(normal, p);
        all += area;
        if (height >= near) {
            unseen += area;
            continue;
        }
        const Vec3d to_light =
            is_parallel(light.kind) ? -normalize(light.direction) : normalize(light.position - p);
        way += area * std::fabs(height - plane) / std::max(dot(normal, to_light), 1e-3);
    }
    if (unseen > most_unseen * all) return {};
    c.mean_way = all > 0 ? way / all : 0;
    return c;
}

/// A plane's axes, for places of points beside one another.
std::vector<Vec2d> places_of(const Light& light, const std::vector<Light>& points) {
    const Basis basis = look_basis(light.direction, {0, 1, 0});
    const bool area = light.kind == LightKind::area;
    const Vec3d u = area ? light.across : basis.right,
                v = area ? cross(light.direction, light.across) : basis.up;
    std::vector<Vec2d> places;
    for (const Light& point : points) {
        const Vec3d p =
            is_parallel(light.kind) ? normalize(point.direction) : point.position - light.position;
        places.push_back({dot(p, u), dot(p, v)});
    }
    return places;
}

/// Counts and bytes into the statistics.
void count_stack(LightShadow& shadow) {
    const ShadowStack& stack = *shadow.stack;
    shadow.stats.nodes = stack.counts;
    shadow.stats.bytes =
        stack.bytes + stack.slices->size() * sizeof(SliceView) + stack.ranges->size() * sizeof(SliceRange);
    shadow.stats.anisotropy = stack.code.shape.anisotropy;
}

/// Which are. Things that move by less than a texel from map to map want nodes that are long along the maps,
/// as many times as they move less; most move by a quarter of what moves most (hierarchy/stack/README.md has
/// what was best of many).
std::vector<int> anisotropies_for(double parallax) {
    const int middle = static_cast<int>(std::lround(num::log2(std::max(parallax, 1.0 / 8)))) - 2;
    return {middle, middle - 1, middle + 1};
}

}  // namespace

std::vector<Light> stack_points(const SceneLight& light) {
    const std::vector<Light> points = light_samples(light.light, light.shadow.samples);
    std::vector<Light> ordered;
    for (const std::size_t k : hilbert_order(places_of(light.light, points)))
        ordered.push_back(points[k]);
    return ordered;
}

StackPlan plan_stack(const Mesh& mesh, const SceneLight& light) {
    StackPlan plan;
    plan.points = stack_points(light);
    plan.samples.directional = is_parallel(light.light.kind);
    for (const Light& point : plan.points)
        plan.samples.at.push_back(plan.samples.directional ? normalize(point.direction) : point.position);

    const Bounds bounds = bounds_of(mesh);
    const Vec3d centre = bounds.empty() ? Vec3d{0, 0, 0} : (bounds.low + bounds.high) * 0.5,
                aside = light.light.position - centre;
    const bool ball = light.light.kind == LightKind::point && length(aside) > 1e-6;
    std::optional<Candidate> best;
    for (const Vec3d& normal : {Vec3d{0, 1, 0}, normalize(ball ? aside : -light.light.direction)}) {
        const std::optional<Candidate> c = candidate_of(mesh, light.light, plan.samples, normal);
        if (c && (!best || c->mean_way < best->mean_way)) best = c;
    }
    if (!best) {
        throw InputError(fmt::format("light '{}'", light.light.id),
                         "shadow.method = \"stack\" aims all maps at one plane below the light, and there is "
                         "none: the light "
                         "stands inside what it shines on; method = \"exact\" has its shadows");
    }
    plan.focus = best->focus;
    plan.focus.resolution = std::max(light.shadow.resolution, least_map_resolution);
    return plan;
}

void check_stack_plans(const Scene& scene,
                       const std::function<void(std::size_t light, const std::string& why)>& refuse) {
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const SceneLight& light = scene.lights[i];
        if (light.shadow.method != ShadowMethod::stack || !casts_shadows(light)) continue;
        try {
            plan_stack(scene.mesh, light);
        } catch (const InputError& error) {
            refuse(i, fmt::format("{}: {}", error.file, error.message));
        }
    }
}

FocusedViews stack_views(const Mesh& mesh, const StackPlan& plan, int resolution) {
    FocusParams focus = plan.focus;
    focus.resolution = resolution;
    return focused_views(mesh, plan.samples, focus);
}

std::vector<Light> stack_parts(const std::vector<Light>& points, std::size_t parts) {
    CHECK(parts > 0 && points.size() % parts == 0);
    const std::size_t run = points.size() / parts;
    std::vector<Light> lights;
    for (std::size_t part = 0; part < parts; ++part) {
        Light one = points[part * run];
        Vec3d position{}, direction{};
        Vec3f color{};
        double share = 0;
        for (std::size_t k = part * run; k < (part + 1) * run; ++k) {
            position = position + points[k].position;
            direction = direction + normalize(points[k].direction);
            color = color + points[k].color;
            share += points[k].part;
        }
        one.position = position * (1.0 / static_cast<double>(run));
        one.direction = normalize(direction);
        // Parts of a surface keep its radiance and have more of it.
        if (one.kind == LightKind::area) {
            one.part = share;
        } else {
            one.color = color;
        }
        lights.push_back(one);
    }
    return lights;
}

bool build_light_stack(const Mesh& mesh, const FocusedViews& views, const Exec& exec, std::int64_t most_bytes,
                       LightShadow& shadow, const std::atomic<bool>* cancel) {
    const Stopwatch watch;
    StackBuildParams params;
    params.receivers = shadow.light.shadow.receivers;
    params.tree.anisotropies = anisotropies_for(parallax_texels(mesh, views));
    params.tree.max_nodes = static_cast<std::uint64_t>(std::max<std::int64_t>(most_bytes, 0) /
                                                       (node_work_bytes + stack_node_bytes));
    try {
        shadow.stack = build_stack(mesh, views, params, exec, nullptr, cancel);
    } catch (const LimitError& error) {
        throw LimitError(fmt::format(
            "light '{}', {} maps of {} x {} texels: {}, more than fit into the {} MiB that limits.memory_mib "
            "leaves; lower its samples or its resolution, or use method = \"exact\", which keeps no maps",
            shadow.light.light.id, views.slices.size(), views.resolution, views.resolution, error.what(),
            most_bytes >> 20));
    }
    if (stopped(cancel)) {
        shadow.stack.reset();
        return false;
    }
    shadow.stats.build.build_s = watch.seconds();
    count_stack(shadow);
    return true;
}

std::string read_light_stack(const std::filesystem::path& file, const TreeFileKey& key,
                             const FocusedViews& views, LightShadow& shadow) {
    std::string notice;
    shadow.stack = load_stack_cache(file, key, notice);
    if (!shadow.stack) return notice;
    if (!(shadow.stack->frame == views.frame && *shadow.stack->slices == views.slices)) {
        shadow.stack.reset();
        return fmt::format("{} is damaged (it holds maps of other views than its key says); it is made again",
                           file.string());
    }
    shadow.stats.from_cache = true;
    count_stack(shadow);
    return notice;
}

ResolutionQuery stack_resolution(const Scene& scene, const SceneLight& light) {
    return stack_query(scene.mesh, light);
}

bool make_stack_shadow(const ShadowWork& work, const TreeNeeds*, std::int64_t most_bytes,
                       LightShadow& shadow) {
    const SceneLight& light = shadow.light;
    const Mesh& mesh = work.scene.mesh;
    const FocusedViews views = stack_views(mesh, plan_stack(mesh, light), light.shadow.resolution);
    const auto build = [&] {
        return build_light_stack(mesh, views, work.exec, most_bytes, shadow, work.cancel);
    };
    if (light.shadow.cache.empty()) return build();
    const auto file =
        shadow_cache_file(work.cache.access, light.shadow.cache, light.light.id, light.shadow.method);
    if (!work.cache.geometry) work.cache.geometry = geometry_key(mesh);
    const TreeFileKey key = shadow_key(*work.cache.geometry, light, views);
    const std::string notice = read_light_stack(file, key, views, shadow);
    if (!notice.empty()) work.stats.notices.push_back(notice);
    if (shadow.stack) return true;
    check_shadow_cache(file);
    if (!build()) return false;
    save_shadow_cache(file, *shadow.stack, key);
    return true;
}

void give_stack_shadow(const ShadowWork& work, const LightShadow& shadow, const TileScene&,
                       TileLight& light) {
    light.stack = stack_light(shadow, work.scene.camera.eye);
}

std::string stack_shadow_text(const LightShadowStats& s) {
    std::string out = fmt::format("a stack of {} maps of {} x {}", s.samples, s.resolution, s.resolution);
    if (s.found) out += " (" + resolution_text(*s.found) + ")";
    out += fmt::format(", {}{}\n", size_text(static_cast<std::int64_t>(s.bytes)),
                       s.kept         ? ", kept"
                       : s.from_cache ? ", from the cache"
                                      : "");
    return out + fmt::format(
                     "    nodes_full {} nodes_empty {} nodes_leaf {}, anisotropy {}; build {:.3f} s, "
                     "lookups and shading {:.3f} s (all threads)\n",
                     s.nodes.full, s.nodes.empty, s.nodes.leaf, s.anisotropy, s.build.build_s, s.lookup_s);
}

ShadowBytes stack_shadow_bytes(const SceneLight& light, const MeshSize& mesh, const RenderSettings&) {
    ShadowBytes bytes;
    bytes.kept = stack_bytes(light, mesh.triangles);
    // Maps are made side by side, by every thread with a setup of its own.
    bytes.making = hardware_threads() * construction_bytes(mesh) + stack_work_bytes(light, mesh.triangles);
    return bytes;
}

std::string stack_plan_text(const SceneLight& light, const std::optional<FoundResolution>& found,
                            const Scene& scene) {
    const ShadowSettings& s = light.shadow;
    std::string out = fmt::format(", a stack of {} shadow maps", s.samples);
    if (s.resolution == auto_resolution) return out + ", resolution auto";
    out += fmt::format(" of {} x {}", s.resolution, s.resolution);
    if (found) out += " (" + resolution_text(*found) + ")";
    const auto casters = static_cast<std::int64_t>(caster_count(scene.mesh));
    const Vec3d normal = plan_stack(scene.mesh, light).focus.plane_normal;
    out += normal == Vec3d{0, 1, 0} ? ", aimed at a level plane" : ", aimed at a plane that faces it";
    out += fmt::format(": {} to build {} times, once, {} to look up a frame, all maps each",
                       count_text(casters, "triangle"), s.samples, picture_samples_text(scene));
    if (!s.cache.empty()) out += fmt::format("; kept in {}", s.cache);
    return out + fmt::format("; about {}, {} more meanwhile", size_text(stack_bytes(light, casters)),
                             size_text(stack_work_bytes(light, casters)));
}

std::int64_t stack_bytes(const SceneLight& light, std::int64_t triangles) {
    return nodes_of(light, triangles) * stack_node_bytes + (std::int64_t{light.shadow.samples} << 10);
}

std::int64_t stack_work_bytes(const SceneLight& light, std::int64_t triangles) {
    // Beside octrees on their way, what texels of eight maps are certain of: 14 bytes where surfaces slope,
    // taken for a sixteenth of them.
    const std::int64_t side = side_of(light), maps = std::min(light.shadow.samples, 8);
    return nodes_of(light, triangles) * node_work_bytes + side * side * maps * 14 / 16;
}

}  // namespace obscura
