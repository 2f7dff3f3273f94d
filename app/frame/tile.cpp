#include "app/frame/tile.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "app/frame/channels.h"
#include "app/frame/exact_tile.h"
#include "app/frame/frame_sky.h"
#include "core/stopwatch.h"
#include "raster/depth_tile.h"
#include "raster/resolve.h"
#include "raster/texture.h"

namespace obscura {
namespace {

constexpr int tile_samples = frame_tile_side * frame_tile_side;

TileRect tile_of(const TileScene& scene, int column, int row, SamplePosition sample) {
    const Region& region = scene.bins->region;
    return {region.x0 + column * frame_tile_side,
            region.y0 + row * frame_tile_side,
            frame_tile_side,
            frame_tile_side,
            sample.x,
            sample.y};
}

/// The part of a tile that the frame wants, in pixels of the tile.
struct TileWindow {
    int x0, y0, x1, y1;
};

TileWindow window_of(const TileRect& tile, const Frame& frame) {
    return {std::max(frame.x0 - tile.x0, 0), std::max(frame.y0 - tile.y0, 0),
            std::min(frame.x0 + frame.width - tile.x0, frame_tile_side),
            std::min(frame.y0 + frame.height - tile.y0, frame_tile_side)};
}

bool is_covered(const SurfaceBlock& s, int at) {
    return (s.covered[at / 16] >> (at & 15) & 1u) != 0;
}

Vec3f albedo_of(const TileScene& scene, const SurfaceBlock& s, int at) {
    const ShadeMaterial& m = scene.materials[static_cast<std::size_t>(s.material[at])];
    const Vec3f base{m.base[0], m.base[1], m.base[2]};
    const bool textured = (s.textured[at / 16] >> (at & 15) & 1u) != 0;
    return textured ? base * Vec3f{s.texel_r[at], s.texel_g[at], s.texel_b[at]} : base;
}

/// From a sample's own column to where the camera sees the point that it shows, in pixels to the right.
float shift_of(const CameraRays& rays, const SurfaceBlock& s, int at, double column) {
    const auto axis = [](const double(&v)[3]) { return Vec3d{v[0], v[1], v[2]}; };
    const Vec3d p = to_double(Vec3f{s.px[at], s.py[at], s.pz[at]}), right = axis(rays.dir_x);
    const Vec3d forward = cross(axis(rays.dir_y), right);
    // p = z (dir0 + X dir_x + Y dir_y); dir_x is at right angles to dir_y and to what is straight ahead.
    const double z = dot(p, forward) / dot(axis(rays.dir0), forward);
    const Vec3d aside = p * (1.0 / z) - axis(rays.dir0);
    return static_cast<float>(dot(aside, right) / dot(right, right) - column);
}

/// Channels other than radiance, of one block of one sample.
void write_channels(const TileScene& scene, const TileRect& tile, int first_row, const TileWindow& window,
                    int sample, const TileWork& work, const FrameOptions& wanted, Frame& frame) {
    const SurfaceBlock& s = work.surface;
    const auto samples = static_cast<float>(scene.pattern.size());
    for (int y = std::max(window.y0, first_row); y < std::min(window.y1, first_row + block_rows); ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            const int at = (y - first_row) * frame_tile_side + x;
            const int px = tile.x0 + x - frame.x0, py = tile.y0 + y - frame.y0;
            const bool covered = is_covered(s, at);
            if (sample == 0) {
                if (wanted.depth) {
                    frame.depth_m(px, py) = covered ? view_distance(scene.rays, s.depth[at])
                                                    : std::numeric_limits<float>::infinity();
                }
                if (wanted.normal && covered) frame.normal(px, py) = {s.nx[at], s.ny[at], s.nz[at]};
                if (wanted.shift && covered) {
                    frame.shift_px(px, py) = shift_of(scene.rays, s, at, tile.x0 + x + tile.sample_x / 256.0);
                }
                if (wanted.object) {
                    const auto& object = scene.mesh->object;
                    frame.object(px, py) = covered && !object.empty() ? object[s.triangle[at]] : no_object;
                }
            }
            if (wanted.albedo && covered) {
                Vec3f& mean = frame.albedo(px, py);
                mean = mean + albedo_of(scene, s, at) * (1.0f / samples);
            }
            if (wanted.shadow) {
                frame.shadow(px, py) += (covered ? work.shadow_sum[at] : 1.0f) / samples;
            }
        }
    }
}

/// Rows [first_row, first_row + rows) of the tile; the planes begin at first_row.
void write_pixels(const TileRect& tile, int first_row, int rows, const TileWindow& window, const float* r,
                  const float* g, const float* b, float scale, Isa isa, Frame& frame) {
    const int count = window.x1 - window.x0;
    if (count <= 0) return;
    for (int y = std::max(window.y0, first_row); y < std::min(window.y1, first_row + rows); ++y) {
        const int from = (y - first_row) * frame_tile_side + window.x0;
        Vec3f& out = frame.radiance.view()(tile.x0 + window.x0 - frame.x0, tile.y0 + y - frame.y0);
        OBSCURA_DISPATCH(isa, resolve_pixels, r + from, g + from, b + from, count, scale, &out.x);
    }
}

void add_block(const ShadeBlock& shade, int first_row, bool first, TileWork& work) {
    const auto add = [&](const float* from, float* to) {
        to += first_row * frame_tile_side;
        for (int i = 0; i < block_samples; ++i)
            to[i] = first ? from[i] : to[i] + from[i];
    };
    add(shade.r, work.r);
    add(shade.g, work.g);
    add(shade.b, work.b);
}

/// Adds a block of one sample, whose share of the pixel is `scale`, to what the frame has.
void add_pixels(const TileRect& tile, int first_row, const TileWindow& window, float scale, bool shadow,
                const TileWork& work, Frame& frame) {
    for (int y = std::max(window.y0, first_row); y < std::min(window.y1, first_row + block_rows); ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            const int at = (y - first_row) * frame_tile_side + x;
            if (!is_covered(work.surface, at)) continue;
            const int px = tile.x0 + x - frame.x0, py = tile.y0 + y - frame.y0;
            Vec3f& sum = frame.radiance.view()(px, py);
            sum = sum + Vec3f{work.shade.r[at], work.shade.g[at], work.shade.b[at]} * scale;
            if (shadow) frame.shadow(px, py) += work.shadow_sum[at] * scale;
        }
    }
}

/// Parts of the sky, after shade_begin().
void shade_sky(const TileScene& scene, const ExactBlock& exact, Isa isa, TileWork& work) {
    const std::vector<ShadeSkyPart>& all = scene.pass->sky;
    OBSCURA_DISPATCH(isa, shade_sky_begin, work.surface, scene.materials.data(), scene.sky, all.data(),
                     static_cast<std::int32_t>(all.size()), work.shade);
    // What is mirrored of it is in the picture already.
    for (float* sum : {work.shade.r, work.shade.g, work.shade.b})
        std::fill_n(sum, block_samples, 0.0f);
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        ShadeSkyPart part;
        std::copy_n(scene.lights[l].shade.to_light, 3, part.to_light);
        std::copy_n(scene.lights[l].shade.color, 3, part.color);
        part.per_sr = static_cast<float>(1 / scene.lights[l].solid_angle_sr);
        std::fill_n(work.visibility, block_samples, 1.0f);
        exact.tile->darken(l, exact.k, exact.first_row, work.visibility);
        if (scene.sent != nullptr) exact.tile->gather(scene, l, exact.first_row, work.sent);
        OBSCURA_DISPATCH(isa, shade_sky_part, work.surface, part, work.visibility,
                         scene.sent != nullptr ? &work.sent : nullptr, work.shade);
    }
}

}  // namespace

TileRect tile_visibility(const TileScene& scene, int column, int row, SamplePosition sample, Isa isa,
                         TileWork& work) {
    const TileRect tile = tile_of(scene, column, row, sample);
    std::fill_n(work.depth, tile_samples, scene.view.max_depth);
    std::fill_n(work.triangle, tile_samples, no_triangle);
    const auto list = scene.bins->list(column, row);
    OBSCURA_DISPATCH(isa, visibility_tile, scene.setup->records.data(), list.data(), list.size(), tile,
                     work.depth, work.triangle);
    return tile;
}

void block_geometry(const TileScene& scene, const TileRect& tile, int first_row, Isa isa, TileWork& work) {
    std::copy_n(work.depth + first_row * frame_tile_side, block_samples, work.surface.depth);
    std::copy_n(work.triangle + first_row * frame_tile_side, block_samples, work.surface.triangle);
    OBSCURA_DISPATCH(isa, surface_block, scene.surface, scene.rays, tile, first_row, work.surface);
}

void block_surface(const TileScene& scene, const TileRect& tile, int first_row, Isa isa, TileWork& work) {
    block_geometry(scene, tile, first_row, isa, work);
    if (scene.textured) sample_textures(work.surface, scene.materials, scene.textures);
}

void uncover_outside(int width, int rows, SurfaceBlock& surface) {
    if (width >= frame_tile_side && rows >= block_rows) return;
    for (int at = 0; at < block_samples; ++at) {
        if (at % frame_tile_side < width && at / frame_tile_side < rows) continue;
        surface.covered[at / 16] &= ~(1u << (at & 15));
    }
}

void block_shade(const TileScene& scene, const ExactBlock& exact, Isa isa, bool shadow, TileWork& work) {
    OBSCURA_DISPATCH(isa, shade_begin, work.surface, scene.materials.data(), scene.sky, scene.rays,
                     work.shade);
    if (scene.sky_model != nullptr && scene.sky.background > 0) draw_sky(*scene.sky_model, work);
    if (scene.pass != nullptr && scene.pass->light->is_sky) return shade_sky(scene, exact, isa, work);
    // Of those too whose passes are still to come.
    const float with_shadow =
        scene.pass != nullptr ? scene.pass->shadow_lights : static_cast<float>(scene.shadow_lights());
    if (shadow) std::fill_n(work.shadow_sum, block_samples, 0.0f);
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const TileLight& light = scene.lights[l];
        if (light.stack) {
            const Stopwatch watch;
            shade_stack(*light.stack, work.surface, isa, work.visibility, shadow ? work.shadow_sum : nullptr,
                        work.shade);
            if (!work.lookup_s.empty()) work.lookup_s[l] += watch.seconds();
            continue;
        }
        if (!light.pcf) std::fill_n(work.visibility, block_samples, 1.0f);
        if (light.pcf) {
            const Stopwatch watch;
            OBSCURA_DISPATCH(isa, pcf_block, work.surface, *light.pcf, work.visibility);
            if (!work.lookup_s.empty()) work.lookup_s[l] += watch.seconds();
        }
        if (light.day) {
            const Stopwatch watch;
            darken_by_ground(*light.day, work.surface, work.visibility);
            if (!work.lookup_s.empty()) work.lookup_s[l] += watch.seconds();
        }
        if (light.exact) exact.tile->darken(l, exact.k, exact.first_row, work.visibility);
        OBSCURA_DISPATCH(isa, shade_light, work.surface, light.shade,
                         light.casts_shadows() ? work.visibility : nullptr, work.shade);
        if (!shadow || !light.casts_shadows()) continue;
        for (int i = 0; i < block_samples; ++i)
            work.shadow_sum[i] += work.visibility[i];
    }
    if (!shadow) return;
    for (float& sum : work.shadow_sum)
        sum = with_shadow == 0 ? 1.0f : sum / with_shadow;
}

std::int64_t render_tile(const TileScene& scene, int column, int row, const FrameOptions& options, Isa isa,
                         TileWork& work, ExactTile* exact, Frame& frame) {
    bool channels = false;
    for_each_channel([&](const auto& channel) { channels |= channel.by_tiles && options.*channel.wanted; });
    const auto samples = static_cast<int>(scene.pattern.size());
    std::int64_t covered = 0;
    const TileRect whole = tile_of(scene, column, row, {});
    const TileWindow window = window_of(whole, frame);
    const int begin_row = window.y0 / block_rows * block_rows;
    const bool has_exact = scene.has_exact();
    for (int sample = 0; sample < samples; ++sample) {
        const SamplePosition position = scene.pattern[static_cast<std::size_t>(sample)];
        const TileRect tile = tile_of(scene, column, row, position);
        const int k = sample % exact_samples_together;
        if (has_exact) {
            if (k == 0) {
                exact->run(scene, column, row, sample, std::min(exact_samples_together, samples - sample),
                           begin_row, window.y1, isa, work);
            }
            exact->restore(k, work);
        } else {
            tile_visibility(scene, column, row, position, isa, work);
        }
        for (int first_row = begin_row; first_row < window.y1; first_row += block_rows) {
            block_surface(scene, tile, first_row, isa, work);
            block_shade(scene, {exact, k, first_row}, isa, options.shadow, work);
            for (const std::uint32_t group : work.surface.covered)
                covered += std::popcount(group);
            if (channels) write_channels(scene, tile, first_row, window, sample, work, options, frame);
            if (samples == 1) {
                write_pixels(tile, first_row, block_rows, window, work.shade.r, work.shade.g, work.shade.b,
                             1.0f, isa, frame);
            } else {
                add_block(work.shade, first_row, sample == 0, work);
            }
        }
    }
    if (samples > 1) {
        write_pixels(whole, 0, frame_tile_side, window, work.r, work.g, work.b,
                     1.0f / static_cast<float>(samples), isa, frame);
    }
    return covered;
}

void add_tile(const TileScene& scene, int column, int row, bool shadow, Isa isa, TileWork& work,
              ExactTile& exact, Frame& frame) {
    const auto samples = static_cast<int>(scene.pattern.size());
    const float scale = 1.0f / static_cast<float>(samples);
    for (int sample = scene.pass->first; sample < samples; sample += scene.pass->stride) {
        const TileRect tile = tile_of(scene, column, row, scene.pattern[static_cast<std::size_t>(sample)]);
        const TileWindow window = window_of(tile, frame);
        const int begin_row = window.y0 / block_rows * block_rows;
        exact.run(scene, column, row, sample, 1, begin_row, window.y1, isa, work);
        exact.restore(0, work);
        for (int first_row = begin_row; first_row < window.y1; first_row += block_rows) {
            block_surface(scene, tile, first_row, isa, work);
            const bool of_shadow = shadow && !scene.pass->light->is_sky;
            block_shade(scene, {&exact, 0, first_row}, isa, of_shadow, work);
            add_pixels(tile, first_row, window, scale, of_shadow, work, frame);
        }
    }
}

}  // namespace obscura
