#include "lessons/stack_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/topology.h"
#include "hierarchy/build.h"
#include "hierarchy/stack/encode.h"
#include "lessons/drawing/figure.h"
#include "lessons/seen_surfaces.h"
#include "raster/view.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

constexpr Rgb8 paint[] = {{236, 231, 219}, {196, 120, 84}, {240, 178, 60}, {104, 178, 222}};
constexpr Rgb8 backdrop{58, 66, 84};

void add_stool(LampScene& scene) {
    constexpr double half = 0.26, leg = 0.022, seat = 0.05;
    const auto place = translation(scene.stool) * rotation_y(20);
    const double under = scene.stool_height - seat;
    add_part(scene.mesh, box({-half, under, -half}, {half, scene.stool_height, half}), place, 1);
    for (const double x : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) {
            const Vec3d foot{x * (half - 2 * leg), 0, z * (half - 2 * leg)};
            add_part(scene.mesh, box({-leg, 0, -leg}, {leg, under, leg}), place * translation(foot), 1);
        }
    }
}

/// Which sixteenth of its share of the maps a pixel of a square of 4 x 4 asks: after B. Bayer, "An Optimum
/// Method for Two-Level Rendition of Continuous-Tone Pictures", ICC 1973.
std::uint16_t turn_of(int x, int y) {
    constexpr int order[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    return static_cast<std::uint16_t>(order[4 * (y & 3) + (x & 3)] << 12);
}

/// Views that keep the floor in place, of maps of `texels` a side.
FocusedViews views_on_floor(const LampScene& scene, const LightSamples& samples, int texels) {
    FocusParams focus;
    focus.resolution = texels;
    return focused_views(scene.mesh, samples, focus);
}

Stacked stacked_on_floor(const LampScene& scene, const LightSamples& samples, int texels, const Exec& exec) {
    StackBuildParams params;
    params.tree.anisotropies = {0, -1, -2, -3};
    params.tree.count_quadtrees = true;
    StackTreeStats stats;
    Stacked s;
    s.stack = build_stack(scene.mesh, views_on_floor(scene, samples, texels), params, exec, &stats);
    s.quadtree_bytes = word_bytes(stats.quadtrees);
    return s;
}

}  // namespace

LampScene lamp_scene() {
    LampScene scene;
    scene.stool = {0.42, 0, 0.12};
    scene.stool_height = 0.46;
    add_part(scene.mesh, box({-2.2, -0.2, -3.0}, {2.2, 0, 1.4}), translation(0, 0, 0), 0);
    add_stool(scene);
    add_part(scene.mesh, torus(0.36, 0.07, 40, 14),
             translation(-0.1, 0.43, -0.85) * rotation_y(24) * rotation_x(90), 2);
    add_part(scene.mesh, box({-0.13, 0, -0.012}, {0.13, 0.72, 0.012}),
             translation(-0.66, 0, 0.1) * rotation_y(24), 3);
    analyse_topology(scene.mesh);
    scene.camera.eye = {0.1, 1.35, 2.5};
    scene.camera.look_at = {-0.06, 0.2, -0.25};
    scene.camera.vfov_deg = 34;
    scene.lamp = {-1.2, 2.4, 0.5};
    scene.lamp_side = 0.6;
    return scene;
}

LightSamples lamp_samples(const LampScene& scene, int count) {
    return parallelogram_samples(scene.lamp, {scene.lamp_side, 0, 0}, {0, 0, scene.lamp_side}, count);
}

LightSamples tube_samples(const LampScene& scene, Vec3d along, int count) {
    LightSamples samples;
    for (int k = 0; k < count; ++k)
        samples.at.push_back(scene.lamp + along * (scene.lamp_side * ((k + 0.5) / count - 0.5)));
    return samples;
}

Stacked stacked(const LampScene& scene, int maps, const Exec& exec) {
    return stacked_on_floor(scene, lamp_samples(scene, maps), lamp_texels, exec);
}

Tube tube_of(const LampScene& scene, const Exec& exec) {
    const StackFrame frame = views_on_floor(scene, lamp_samples(scene, 1), tube_texels).frame;
    const Vec3d along = normalize(Vec3d{frame.a[0], frame.a[1], frame.a[2]});
    Tube tube;
    tube.stacked = stacked_on_floor(scene, tube_samples(scene, along, tube_maps), tube_texels, exec);
    const auto& b = tube.stacked.stack.frame.b;
    tube.row = static_cast<int>(b[0] * scene.stool.x + b[1] * scene.stool.y + b[2] * scene.stool.z + b[3]);
    return tube;
}

Stacked stack_apart(const LampScene& scene, const LightSamples& samples, int texels, const Exec& exec) {
    const Bounds bounds = bounds_of(scene.mesh);
    const Vec3d middle = (bounds.low + bounds.high) * 0.5, half = (bounds.high - bounds.low) * 0.5;
    const double radius = std::sqrt(dot(half, half));
    StackTreeParams params;
    params.count_quadtrees = true;
    StackTreeStats stats;
    const StackTree tree = build_stack_tree(
        static_cast<int>(samples.at.size()), std::countr_zero(static_cast<unsigned>(texels)),
        [&](int k) {
            const Vec3d from = samples.at[static_cast<std::size_t>(k)], way = middle - from;
            const double distance = std::sqrt(dot(way, way));
            const LightView view = tangent_light_view(from, way, std::min(radius / distance, 0.9), 0.5,
                                                      distance + radius, texels);
            return build_certain_tree(scene.mesh, view, {}, Exec{exec.isa, 1});
        },
        params, exec, &stats);
    Stacked apart;
    apart.quadtree_bytes = word_bytes(stats.quadtrees);
    encode_stack(tree, {}, apart.stack);
    return apart;
}

void LampReceivers::add(Vec3f at, Vec3f normal, std::uint16_t turn, std::uint32_t of) {
    px.push_back(at.x);
    py.push_back(at.y);
    pz.push_back(at.z);
    nx.push_back(normal.x);
    ny.push_back(normal.y);
    nz.push_back(normal.z);
    pattern.push_back(turn);
    material.push_back(of);
}

StackPoints LampReceivers::points() const {
    return {px.data(), py.data(), pz.data(), nx.data(), ny.data(), nz.data(), pattern.data(), size()};
}

LampReceivers seen_receivers(const LampScene& scene, int width, int height, const PictureWindow& window,
                             const Exec& exec) {
    const std::vector<SurfaceBlock> blocks =
        seen_surfaces(SeenMesh(scene.mesh), scene.camera, width, height, exec);
    const int columns = (width + frame_tile_side - 1) / frame_tile_side;
    LampReceivers receivers;
    for (int y = window.y; y < window.y + window.height; y += window.step) {
        for (int x = window.x; x < window.x + window.width; x += window.step) {
            const int tile = y / frame_tile_side * columns + x / frame_tile_side, row = y % frame_tile_side,
                      at = row % block_rows * frame_tile_side + x % frame_tile_side;
            const SurfaceBlock& b = blocks[static_cast<std::size_t>(tile) * (frame_tile_side / block_rows) +
                                           static_cast<std::size_t>(row / block_rows)];
            const bool covered = (b.covered[at / 16] >> (at % 16) & 1u) != 0;
            receivers.add({b.px[at], b.py[at], b.pz[at]},
                          covered ? Vec3f{b.gx[at], b.gy[at], b.gz[at]} : Vec3f{0, 1, 0}, turn_of(x, y),
                          covered ? scene.mesh.material[b.triangle[at]] : LampReceivers::no_material);
        }
    }
    return receivers;
}

LampReceivers receivers_over(const StackFrame& frame, const std::vector<Vec3d>& texels_and_heights) {
    LampReceivers receivers;
    for (const Vec3d& at : texels_and_heights) {
        // The rows of the frame are at right angles to each other.
        Vec3d place{0, 0, 0};
        const auto add = [&](const double(&row)[4], double value) {
            const Vec3d axis{row[0], row[1], row[2]};
            place = place + axis * ((value - row[3]) / dot(axis, axis));
        };
        add(frame.a, at.x);
        add(frame.b, at.y);
        add(frame.h, at.z);
        receivers.add(to_float(place), {0, 1, 0}, 0, 0);
    }
    return receivers;
}

Image<Rgb8> lit_picture(const LampScene& scene, const LampReceivers& receivers,
                        const std::vector<float>& share, int columns) {
    Image<Rgb8> picture(columns, static_cast<int>(receivers.size()) / columns);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (receivers.material[i] == LampReceivers::no_material) {
            picture.pixels[i] = backdrop;
            continue;
        }
        const Vec3d at = scene.camera.eye + to_double({receivers.px[i], receivers.py[i], receivers.pz[i]});
        const Vec3d normal = to_double({receivers.nx[i], receivers.ny[i], receivers.nz[i]});
        // The lamp shines downwards; its middle stands for its distance and for the cosines.
        const Vec3d way = scene.lamp - at;
        const double square = dot(way, way), length = std::sqrt(square);
        const double light = std::max(0.0, dot(normal, way) / length) * std::max(0.0, way.y / length) *
                             (scene.lamp.y * scene.lamp.y / square) * static_cast<double>(share[i]);
        picture.pixels[i] =
            mix({30, 34, 50}, paint[receivers.material[i]], 0.16 + 0.84 * std::min(1.25 * light, 1.0));
    }
    return picture;
}

NodesRead nodes_read(const StackLookup& stack, const LampReceivers& receivers, const Exec& exec) {
    const std::size_t count = receivers.size();
    NodesRead read{std::vector<double>(count), std::vector<double>(count), std::vector<int>(count)};
    parallel_blocks(count, 256, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            StackPoints one = receivers.points();
            for (const float** array : {&one.px, &one.py, &one.pz, &one.nx, &one.ny, &one.nz})
                *array += i;
            one.pattern += i;
            one.count = 1;
            StackWork all, each;
            std::uint16_t lit = 0, again = 0;
            OBSCURA_DISPATCH(exec.isa, lit_samples, stack, one, &lit, all);
            OBSCURA_DISPATCH(exec.isa, lit_of_subset, stack, one, stack.slices, &again, each);
            CHECK(lit == again, "all maps at once say what they say one by one");
            read.at_once[i] = static_cast<double>(all.nodes);
            read.one_by_one[i] = static_cast<double>(each.nodes);
            read.lit[i] = lit;
        }
    });
    return read;
}

TellingColumns telling_columns(const Tube& tube) {
    std::vector<Vec3d> places;
    for (int x = 0; x < tube_texels; ++x)
        places.push_back({x + 0.5, tube.row + 0.5, 0});
    const NodesRead floor = nodes_read(stack_lookup(tube.stacked.stack, {0, 0, 0}),
                                       receivers_over(tube.stacked.stack.frame, places), {Isa::ref, 1});
    const auto find = [&](double from, int least, int most) {
        auto x = static_cast<std::size_t>(from);
        while (x < floor.lit.size() && (floor.lit[x] < least || floor.lit[x] > most))
            ++x;
        CHECK(x < floor.lit.size(), "such a column");
        return static_cast<double>(x) + 0.5;
    };
    TellingColumns at;
    at.dark = find(0, 0, 0);
    at.partly = find(at.dark, tube_maps / 4, 3 * tube_maps / 4);
    at.lit = find(at.partly, tube_maps, tube_maps) + 6;
    const SliceView& middle = (*tube.stacked.stack.slices)[tube_maps / 2];
    at.raised = (at.partly + 3) * (1 - static_cast<double>(middle.tau) * raised_m) -
                static_cast<double>(middle.sigma_x) * raised_m;
    return at;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values)
        sum += v;
    return sum / static_cast<double>(values.size());
}

}  // namespace obscura
