#include "bench/shadows/stack_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "bench/shadows/visible_points.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "hierarchy/build.h"
#include "hierarchy/stack/encode.h"
#include "hierarchy/stack/visible_share.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// A lamp over a scene.
struct Lit {
    const Mesh& mesh;
    Vec3d middle, lamp;
    double extent_m, ground_y;
    LightSamples samples;
};

Lit lit_scene(const Mesh& mesh, Vec3d sun, const StackSubject& subject) {
    const Bounds b = bounds_of(mesh);
    Lit lit{mesh, (b.low + b.high) * 0.5, {}, std::max(b.high.x - b.low.x, b.high.z - b.low.z), b.low.y, {}};
    const double side = 0.01 * subject.light_percent * lit.extent_m;
    lit.lamp = lit.middle - normalize(sun) * (2 * lit.extent_m);
    lit.samples = parallelogram_samples(lit.lamp, {side, 0, 0}, {0, 0, side}, subject.maps);
    return lit;
}

FocusedViews focused(const Lit& lit, const StackSubject& subject) {
    FocusParams params;
    params.resolution = subject.resolution;
    params.plane_point =
        subject.aim == StackAim::median ? median_plane_point(lit.mesh, {0, 1, 0}) : Vec3d{0, lit.ground_y, 0};
    if (subject.aim == StackAim::facing) {
        params.plane_point = lit.middle;
        params.plane_normal = lit.lamp - lit.middle;
    }
    return focused_views(lit.mesh, lit.samples, params);
}

std::vector<LightView> views_apart(const Lit& lit, const StackSubject& subject) {
    const Bounds b = bounds_of(lit.mesh);
    const Vec3d half = (b.high - b.low) * 0.5;
    const double radius = std::sqrt(dot(half, half));
    std::vector<LightView> views;
    for (const Vec3d& at : lit.samples.at) {
        const Vec3d way = lit.middle - at;
        const double distance = std::sqrt(dot(way, way));
        views.push_back(tangent_light_view(at, way, radius / distance, distance - radius, distance + radius,
                                           subject.resolution));
    }
    return views;
}

/// Covered points of a small picture, relative to its eye, sixteen that stand together from 16 x 1 pixels.
struct PictureReceivers {
    std::vector<float> px, py, pz, nx, ny, nz;
    std::vector<std::uint16_t> pattern;
    Vec3d eye;
    StackPoints view() const {
        return {px.data(), py.data(), pz.data(), nx.data(), ny.data(), nz.data(), pattern.data(), px.size()};
    }
};

PictureReceivers receivers_of(const Scene& scene, const Exec& exec) {
    const VisiblePoints points = visible_points(scene, exec);
    PictureReceivers r;
    r.eye = points.eye;
    for (const SurfaceBlock& block : points.blocks) {
        for (int at = 0; at < block_samples; ++at) {
            if (!is_covered(block, at)) continue;
            r.px.push_back(block.px[at]);
            r.py.push_back(block.py[at]);
            r.pz.push_back(block.pz[at]);
            r.nx.push_back(block.gx[at]);
            r.ny.push_back(block.gy[at]);
            r.nz.push_back(block.gz[at]);
            r.pattern.push_back(static_cast<std::uint16_t>(r.px.size() * 0x9e37u));
        }
    }
    return r;
}

/// Inner nodes on the way to a texel.
std::uint64_t quadtree_steps(const MultiresTree& tree, std::uint32_t x, std::uint32_t y) {
    const MultiresNode* node = &tree.root;
    std::uint64_t steps = 0;
    for (int level = tree.levels - 1; level >= 0 && node->kinds != 0; --level) {
        ++steps;
        const int child = static_cast<int>((x >> level & 1u) + 2 * (y >> level & 1u));
        if (node->child(child) == ChildKind::none) break;
        std::uint64_t place = node->first_child();
        for (int i = 0; i < child; ++i)
            place += node->child(i) != ChildKind::none;
        node = &tree.nodes[place];
    }
    return steps;
}

/// Those of every point in all maps.
std::vector<std::uint64_t> quadtree_steps(const Mesh& mesh, const FocusedViews& views,
                                          const PictureReceivers& receivers, const Exec& exec) {
    std::vector<std::uint64_t> steps(receivers.px.size(), 0);
    const double size = views.resolution;
    for (int k = 0; k < static_cast<int>(views.slices.size()); ++k) {
        const LightView view = views.view(k);
        const MultiresTree tree = build_shadow_tree(mesh, view, {}, exec);
        parallel_blocks(steps.size(), 4096, exec, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Vec3d p = receivers.eye + Vec3d{receivers.px[i], receivers.py[i], receivers.pz[i]};
                const Vec3d at = to_map_space(view, p);
                if (at.x < 0 || at.y < 0 || at.x >= size || at.y >= size) continue;
                steps[i] +=
                    quadtree_steps(tree, static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y));
            }
        });
    }
    return steps;
}

/// Point by point, so that every point's own steps are known.
void count_steps(const ShadowStack& stack, const FocusedViews& views, const Scene& scene, const Exec& exec,
                 StackRow& row) {
    const PictureReceivers receivers = receivers_of(scene, exec);
    const StackLookup lookup = stack_lookup(stack, receivers.eye);
    const std::vector<std::uint64_t> quadtrees = quadtree_steps(scene.mesh, views, receivers, exec);
    const std::size_t count = quadtrees.size();
    std::vector<StackWork> all(count), each(count);
    std::vector<std::uint16_t> lit(count);
    parallel_blocks(count, 1024, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            StackPoints one = receivers.view();
            for (const float** array : {&one.px, &one.py, &one.pz, &one.nx, &one.ny, &one.nz})
                *array += i;
            one.pattern += i;
            one.count = 1;
            std::uint16_t again = 0;
            OBSCURA_DISPATCH(exec.isa, lit_samples, lookup, one, &lit[i], all[i]);
            OBSCURA_DISPATCH(exec.isa, lit_of_subset, lookup, one, lookup.slices, &again, each[i]);
            CHECK(again == lit[i], "all maps at once say what they say one by one");
        }
    });
    row.points = count;
    const auto add = [&](std::size_t i, StackSteps& to) {
        to.quadtrees += static_cast<double>(quadtrees[i]);
        to.each += static_cast<double>(each[i].nodes);
        to.all += static_cast<double>(all[i].nodes);
        to.all_runs += static_cast<double>(all[i].lookups);
    };
    for (std::size_t i = 0; i < count; ++i) {
        add(i, row.everywhere);
        if (lit[i] == 0 || lit[i] == lookup.slices) continue;
        ++row.penumbra;
        add(i, row.in_penumbra);
    }
    const auto divide = [](StackSteps& s, std::size_t by) {
        for (double* v : {&s.quadtrees, &s.each, &s.all, &s.all_runs})
            *v /= static_cast<double>(std::max<std::size_t>(by, 1));
    };
    divide(row.everywhere, row.points);
    divide(row.in_penumbra, row.penumbra);
}

}  // namespace

const char* aim_name(StackAim aim) {
    switch (aim) {
        case StackAim::apart:
            return "apart";
        case StackAim::ground:
            return "ground";
        case StackAim::median:
            return "median";
        default:
            return "facing";
    }
}

std::vector<StackSubject> stack_subjects(const std::string& scene, bool quick) {
    if (quick) return {{64, 16, 5, StackAim::apart}, {64, 16, 5, StackAim::ground, true}};
    std::vector<StackSubject> subjects{{512, 64, 5, StackAim::apart},
                                       {512, 64, 5, StackAim::ground, true},
                                       {512, 64, 5, StackAim::median},
                                       {512, 64, 5, StackAim::facing, true},
                                       {512, 256, 5, StackAim::ground, true}};
    // The paper's table 4.
    if (scene == "armadillo" || scene == "dragon_res2" || scene == "vienna_west") {
        for (const int side : {512, 1024}) {
            for (const double light : {5.0, 1.0})
                subjects.push_back({side, side, light, StackAim::median});
            if (scene != "vienna_west") subjects.push_back({side, side, 5, StackAim::facing});
        }
    }
    // Its table 5, of a city of 11 thousand triangles: more texels a side than maps.
    if (scene == "city") {
        for (const int side : {512, 1024, 2048})
            subjects.push_back({side, 256, 5, StackAim::median});
    }
    subjects.push_back({2048, 64, 5, StackAim::median});
    return subjects;
}

StackRow measure_stack(const ShadowRecipe& recipe, const StackSubject& subject, const BenchOptions& options) {
    const Exec exec{best_isa(), options.threads.back()};
    const PictureSize picture = options.quick ? PictureSize{64, 36} : PictureSize{320, 180};
    const Scene scene = stage_shadows(recipe, picture);
    const Lit lit = lit_scene(scene.mesh, recipe.sun, subject);
    StackRow row;
    row.scene = recipe.name;
    row.triangles = scene.mesh.triangles.size();
    row.subject = subject;
    StackBuildParams params;
    params.tree.count_quadtrees = true;
    // Octrees that are tried grow side by side: of the paper's large stacks, the cube and those that were
    // best.
    if (subject.resolution * subject.maps >= 1 << 19) params.tree.anisotropies = {0, -3, -4, -5};
    StackTreeStats stats;
    ShadowStack stack;
    const Stopwatch watch;
    if (subject.aim == StackAim::apart) {
        const std::vector<LightView> views = views_apart(lit, subject);
        const Exec alone{exec.isa, 1};
        const StackTree tree = build_stack_tree(
            subject.maps, std::countr_zero(static_cast<unsigned>(subject.resolution)),
            [&](int k) {
                return build_certain_tree(scene.mesh, views[static_cast<std::size_t>(k)], {}, alone);
            },
            params.tree, exec, &stats);
        encode_stack(tree, {}, stack);
    } else {
        const FocusedViews views = focused(lit, subject);
        row.parallax_texels = parallax_texels(scene.mesh, views);
        stack = build_stack(scene.mesh, views, params, exec, &stats);
        row.build_s = watch.seconds();
        if (subject.steps) count_steps(stack, views, scene, exec, row);
    }
    if (row.build_s == 0) row.build_s = watch.seconds();
    row.quadtree_bytes = word_bytes(stats.quadtrees);
    row.trials = stats.trials;
    row.anisotropy = stack.code.shape.anisotropy;
    row.bytes = stack.bytes;
    return row;
}

}  // namespace obscura
