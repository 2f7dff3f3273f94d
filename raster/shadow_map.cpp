#include "raster/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/emitter_surface.h"
#include "core/num.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// tan 85 degrees.
constexpr double widest_tangent = 11.430052302761343;

/// Middles of the tile's intervals, block by block.
void store_tile(const DepthInterval* interval, const TileRect& tile, StoredDepths& stored) {
    const int width = std::min(layer_tile_side, stored.size - tile.x0);
    const int height = std::min(layer_tile_side, stored.size - tile.y0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; x += 4) {
            const DepthInterval* from = interval + y * layer_tile_side + x;
            std::transform(from, from + 4, &stored.depth[stored.index(tile.x0 + x, tile.y0 + y)],
                           stored_depth);
        }
    }
}

void render_view(const Mesh& mesh, const LightView& view, Receivers receivers, const Exec& exec,
                 RasterScratch& scratch, const std::atomic<bool>* cancel, StoredDepths& stored) {
    CHECK(view.width == view.height && view.width % 4 == 0);
    SetupParams params;
    params.only_casters = true;
    params.pair_faces = true;
    setup_triangles(mesh, view, params, exec, scratch.setup);
    bin_records(scratch.setup, region_of(view, {}), layer_tile_side, exec, scratch.bins);
    stored.size = view.width;
    stored.depth.reset(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    const TileBins& bins = scratch.bins;
    parallel_for(static_cast<std::size_t>(bins.rows), exec, [&](std::size_t tile_row) {
        if (stopped(cancel)) return;
        IntervalTiler tiler;
        alignas(64) DepthInterval interval[layer_tile_texels];
        const auto row = static_cast<int>(tile_row);
        for (int column = 0; column < bins.columns; ++column) {
            const TileRect tile{column * layer_tile_side, row * layer_tile_side, layer_tile_side,
                                layer_tile_side};
            tiler.run(scratch.setup, bins.list(column, row), tile, receivers, exec.isa, interval);
            store_tile(interval, tile, stored);
        }
    });
}

/// What is nearer to the light's middle casts no shadow: what shines, above all, where that lies around it.
double nearest_caster_m(const Light& light) {
    if (light.kind != LightKind::surface || light.surface == nullptr) return light.near_m;
    return std::max(light.near_m, std::min(1.000001 * light.surface->radius_m, 0.5 * light.range_m));
}

/// Of points and spots: to their own range.
std::vector<LightView> lamp_views(const Light& light, const ShadowViewParams& params) {
    // What a kernel reaches beyond its receiver's texel, and one more; of maps that are hardly larger than
    // the kernel a quarter a side at most, since the map's border serves taps beyond it too.
    const int margin = std::min(params.filter_px / 2 + 1, params.resolution / 4);
    if (shadow_view_count(light.kind) == 6) {
        return cube_light_views(light.position, nearest_caster_m(light), light.range_m, params.resolution,
                                margin);
    }
    // Wider than the cone by the margin. Nothing is wider than 170 degrees; beyond, the cone's rim takes the
    // map's border.
    const double cone = num::tan(light.outer_cone_deg * (num::pi / 180.0));
    return {tangent_light_view(light.position, light.direction,
                               std::min(cone * margin_factor(params.resolution, margin), widest_tangent),
                               light.near_m, light.range_m, params.resolution)};
}

}  // namespace

std::vector<LightView> shadow_views(const Light& light, const ShadowViewParams& params,
                                    const Bounds& bounds) {
    if (!is_parallel(light.kind)) return lamp_views(light, params);
    return {orthographic_light_view(bounds, light.direction, params.resolution)};
}

std::vector<LightView> fitted_shadow_views(const Light& light, const ShadowViewParams& params,
                                           const Bounds& casters) {
    if (!is_parallel(light.kind)) return lamp_views(light, params);
    return {fitted_light_view(casters, light.direction, params.resolution)};
}

std::int64_t dense_map_bytes(LightKind kind, int resolution) {
    return std::int64_t{shadow_view_count(kind)} * resolution * resolution *
           static_cast<std::int64_t>(sizeof(float));
}

bool build_shadow_map(const Mesh& mesh, std::vector<LightView> views, Receivers receivers, const Exec& exec,
                      RasterScratch& scratch, ShadowMap& map, const std::atomic<bool>* cancel) {
    map.views = std::move(views);
    map.stored.resize(map.views.size());
    for (std::size_t i = 0; i < map.views.size() && !stopped(cancel); ++i) {
        render_view(mesh, map.views[i], receivers, exec, scratch, cancel, map.stored[i]);
    }
    if (!stopped(cancel)) return true;
    map.views.clear();
    return false;
}

double texel_size_m(const LightView& view) {
    double longest = 0;
    for (int r = 0; r < 2; ++r) {
        const auto& row = view.to_map.m[r];
        Vec3d across{row[0], row[1], row[2]};
        if (view.perspective) {
            // The X row is right * texels per tangent + forward * width / 2.
            const auto& w = view.to_map.m[3];
            const Vec3d forward{w[0], w[1], w[2]};
            across = across - forward * (dot(across, forward) / dot(forward, forward));
        }
        longest = std::max(longest, 1.0 / length(across));
    }
    return longest;
}

}  // namespace obscura
