#include "app/report/pixel_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/frame/exact_tile.h"
#include "app/frame/frame_sky.h"
#include "app/frame/shadows.h"
#include "app/scene/light_kinds.h"
#include "core/count_text.h"
#include "core/num.h"
#include "filters/shadow_lookup.h"
#include "filters/tonemap.h"
#include "raster/depth_tile.h"
#include "raster/exact/exact_shadow.h"
#include "raster/layers.h"
#include "raster/shade_terms.h"
#include "raster/surface.h"
#include "raster/texture.h"

namespace obscura {
namespace {

std::string text_of(Vec3f v) {
    return fmt::format("({:.7g}, {:.7g}, {:.7g})", v.x, v.y, v.z);
}

std::string text_of(Vec3d v) {
    return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z);
}

/// The account while it grows.
class PixelStory {
  public:
    PixelStory(const Scene& scene, const TileScene& tiles, const FrameCache& cache, const Exec& exec)
        : scene_(scene), tiles_(tiles), cache_(cache), exec_(exec), work_(std::make_unique<TileWork>()) {}

    /// Runs every stage on the block that holds the pixel and tells of this one sample.
    Vec3f soft_sample(const TileScene& pass, int x, int y, std::size_t sample);
    Vec3f sample(int x, int y, SamplePosition position);

    template <class... Args>
    void say(fmt::format_string<Args...> format, Args&&... args) {
        text_ += fmt::format(format, std::forward<Args>(args)...);
        text_ += '\n';
    }
    const std::string& text() const { return text_; }

  private:
    void tell_surface(int at);
    void tell_barycentrics(std::uint32_t triangle, Vec3f position);
    void tell_material(int at);
    void tell_exact(const TileLight& light, int at);
    void tell_stack(const TileLight& light, int at);
    void tell_day(const TileLight& light, int at);
    void tell_light(const TileLight& light, std::size_t shadow, int at);
    void tell_lookup(const TileLight& light, std::size_t shadow, int at);
    bool is(const std::uint32_t* masks, int at) const { return (masks[at / 16] >> (at & 15) & 1u) != 0; }
    Vec3f radiance(int at) const { return {work_->shade.r[at], work_->shade.g[at], work_->shade.b[at]}; }

    const Scene& scene_;
    const TileScene& tiles_;
    const FrameCache& cache_;
    Exec exec_;
    std::unique_ptr<TileWork> work_;
    std::string text_;
};

void PixelStory::tell_barycentrics(std::uint32_t triangle, Vec3f position) {
    const Vec3d eye = scene_.camera.eye;
    Vec3f corner[3];
    for (int k = 0; k < 3; ++k) {
        corner[k] = to_float(to_double(scene_.mesh.positions[scene_.mesh.triangles[triangle].v[k]]) - eye);
    }
    const Vec3f axis = to_float(Vec3d{tiles_.rays.dir0[0], tiles_.rays.dir0[1], tiles_.rays.dir0[2]});
    const Barycentrics b = tiles_.rays.perspective
                               ? ref::barycentrics(corner, Vec3f{0, 0, 0}, position)
                               : ref::barycentrics(corner, position - axis * dot(axis, position), axis);
    const Triangle& t = scene_.mesh.triangles[triangle];
    say("    corners {} {} {}, barycentrics {:.6f} {:.6f} {:.6f}", t.v[0], t.v[1], t.v[2], 1.0f - b.b1 - b.b2,
        b.b1, b.b2);
}

void PixelStory::tell_surface(int at) {
    const SurfaceBlock& s = work_->surface;
    const Mesh& mesh = scene_.mesh;
    const std::uint32_t t = s.triangle[at], component = mesh.component[t],
                        object = mesh.object.empty() ? no_object : mesh.object[t];
    const std::string name = object < mesh.objects.size() ? mesh.objects[object].name : std::string();
    say("    triangle {} of object {} \"{}\", component {} ({}), face {}", t, object, name, component,
        mesh.components[component].closed ? "closed" : "open", mesh.face[t]);
    const Vec3f position{s.px[at], s.py[at], s.pz[at]};
    tell_barycentrics(t, position);
    say("    depth {:.9g}, {:.7g} m along the view axis", s.depth[at],
        view_distance(tiles_.rays, s.depth[at]));
    say("    position {} m", text_of(scene_.camera.eye + to_double(position)));
    say("    normal {}, of the face {}, n.v {:.6g}", text_of(Vec3f{s.nx[at], s.ny[at], s.nz[at]}),
        text_of(Vec3f{s.gx[at], s.gy[at], s.gz[at]}), work_->shade.nv[at]);
}

void PixelStory::tell_material(int at) {
    const SurfaceBlock& s = work_->surface;
    const auto index = static_cast<std::size_t>(s.material[at]);
    const Material& m = scene_.materials[index];
    say("    material {} \"{}\": base colour {}, roughness {:.4g}, metallic {:.4g}, translucency {:.4g}",
        index, m.name, text_of(m.base_color), m.roughness, m.metallic, m.translucency);
    if (is(s.textured, at)) {
        const Texture& texture = scene_.textures[static_cast<std::size_t>(m.texture)];
        const UvFootprint footprint{{s.ux[at], s.vx[at]}, {s.uy[at], s.vy[at]}};
        say("    texture \"{}\": uv ({:.6g}, {:.6g}), per pixel right ({:.4g}, {:.4g}) and down ({:.4g}, "
            "{:.4g}), level {:.4f} of 0..{}, texel {}",
            texture.name, s.u[at], s.v[at], s.ux[at], s.vx[at], s.uy[at], s.vy[at],
            mip_level(texture, footprint), texture.levels.size() - 1,
            text_of(Vec3f{s.texel_r[at], s.texel_g[at], s.texel_b[at]}));
    }
    say("    emission and sky {}", text_of(radiance(at)));
}

void PixelStory::tell_lookup(const TileLight& light, std::size_t shadow, int at) {
    const ref::PcfTrace look = ref::trace_pcf(work_->surface, *light.pcf, at);
    if (!look.looked_up) {
        say("      no lookup ({}), visibility {}",
            look.visibility > 0 ? "before the map's near plane" : "the face looks away", look.visibility);
        return;
    }
    const LightView& view = cache_.shadows[shadow].view(look.view);
    say("      map {} of {}, {} x {}: texel ({:.4f}, {:.4f}), receiver depth {:.9g}", look.view,
        light.pcf->views, view.width, view.height, look.X, look.Y, look.depth);
    if (light.pcf->filter == PcfFilter::hierarchical) {
        say("        taps of {:.6g} texels make a kernel as large as the pixel", look.tap_texels);
    }
    for (const ref::PcfTap& tap : look.taps) {
        const std::string level = tap.level == 0 ? "" : fmt::format("of level {} ", tap.level);
        say("        tap {}({}, {}) receiver {:.9g} stored {:.9g} {}{}", level, tap.x, tap.y, tap.receiver,
            tap.stored, tap.lit ? "lit" : "dark", tap.inside ? "" : ", outside the map");
    }
    if (look.steps.naive > 0) {
        say("        nodes visited: {}, each tap from the root {}", look.steps.shared, look.steps.naive);
    }
    const auto x = static_cast<int>(std::floor(look.X)), y = static_cast<int>(std::floor(look.Y));
    if (x >= 0 && y >= 0 && x < view.width && y < view.height) {
        const Layers layers = layers_of(scene_.mesh, view, {x, y, 1, 1}, exec_);
        std::vector<LayerCrossing> crossings;
        for (const LayerCrossing& c : layers.at(x, y)) {
            const Mesh& mesh = scene_.mesh;
            if (mesh.objects.empty() || mesh.objects[mesh.object[c.triangle]].casts_shadow)
                crossings.push_back(c);
        }
        const DepthInterval interval =
            interval_of(crossings, scene_.lights[light.scene_light].shadow.receivers);
        say("        own texel: interval [{:.9g}, {:.9g}] of {} crossings", interval.entry, interval.exit,
            crossings.size());
    }
    say("      visibility {:.6g}", look.visibility);
}

/// Finds the sample's own exact shadow, with the triangle that casts it.
void PixelStory::tell_exact(const TileLight& light, int at) {
    ExactTile tile(1);
    tile.begin(1);
    tile.keep_block(tiles_, 0, 1, 0, work_->surface);
    const ExactPoints points = tile.points();
    const ref::ExactShadow shadow = ref::exact_shadow(
        points, *light.exact, exact_point_index(0, 1, at % frame_tile_side, at / frame_tile_side));
    if (!light.pcf && !light.day) std::fill_n(work_->visibility, block_samples, 1.0f);
    if (!shadow.lit) work_->visibility[at] = 0.0f;
    if (!shadow.asks) {
        say("      exact: the face looks away, visibility 0");
        return;
    }
    if (!shadow.on_map) {
        say("      exact: before the near plane, or beyond everything that casts a shadow; visibility 1");
        return;
    }
    say("      exact: view {} of {}, step ({}, {}) of {} a side, place uncertain by {:.3g} m", shadow.view,
        light.exact->views, shadow.x, shadow.y, light.exact->view[shadow.view].steps, shadow.rounding_m);
    if (shadow.lit) {
        say("        nothing stands between, visibility 1");
        return;
    }
    const Mesh& mesh = scene_.mesh;
    const std::string object =
        mesh.objects.empty()
            ? ""
            : fmt::format(" of object \"{}\"", mesh.objects[mesh.object[shadow.triangle]].name);
    say("        {} darken it; nearest is triangle {}{}, {:.6g} m along the light; the sample lies {:.6g} m "
        "behind its plane",
        count_text(static_cast<std::size_t>(shadow.triangles), "triangle"), shadow.triangle, object,
        shadow.distance_m, shadow.behind_m);
    say("      visibility 0");
}

/// Whether ground hides the light, by a day's far bits and a ray.
void PixelStory::tell_day(const TileLight& light, int at) {
    const SurfaceBlock& s = work_->surface;
    std::fill_n(work_->visibility, block_samples, 1.0f);
    const bool dark =
        day_dark(*light.day, s.triangle[at], {s.px[at], s.py[at], s.pz[at]}, {s.gx[at], s.gy[at], s.gz[at]});
    darken_by_ground(*light.day, s, work_->visibility);
    say("      day: sun {} of {}; ground hides it: {}; visibility {:g}", light.day->sun->sun,
        light.day->sun->ground->day.suns.size(), dark ? "yes" : "no", work_->visibility[at]);
}

/// How many points of a light with a size reach the sample, and what its parts add.
void PixelStory::tell_stack(const TileLight& light, int at) {
    const StackLight& stack = *light.stack;
    std::vector<std::uint16_t> lit(stack.parts.size() * block_samples);
    stack_block(stack, work_->surface, Isa::ref, lit.data());
    std::string parts;
    int all = 0;
    for (std::size_t part = 0; part < stack.parts.size(); ++part) {
        const int count = lit[part * block_samples + static_cast<std::size_t>(at)];
        all += count;
        parts += fmt::format("{}{}", part == 0 ? "" : " ", count);
    }
    say("      stack: {} of {} points of the light reach it; of its {} parts {}", all, stack.lookup.slices,
        stack.parts.size(), parts);
    const Vec3f before = radiance(at);
    shade_stack(stack, work_->surface, Isa::ref, work_->visibility, nullptr, work_->shade);
    say("      adds {}", text_of(radiance(at) - before));
}

void PixelStory::tell_light(const TileLight& light, std::size_t shadow, int at) {
    const Light& source = scene_.lights[light.scene_light].light;
    const ref::LightTerms terms = ref::light_terms(work_->surface, light.shade, work_->shade, at);
    say("    light {} \"{}\" ({}): towards {}, n.l {:.6g}, irradiance {}", light.scene_light, source.id,
        light_kind_name(source.kind), text_of(terms.incident.to_light), terms.nl,
        text_of(terms.incident.irradiance));
    if (light.pcf) {
        tell_lookup(light, shadow, at);
        ref::pcf_block(work_->surface, *light.pcf, work_->visibility);
    }
    if (light.day) tell_day(light, at);
    if (light.exact) tell_exact(light, at);
    if (light.stack) return tell_stack(light, at);
    say("      per irradiance: diffuse {}, specular {}, through {}", text_of(terms.diffuse),
        text_of(terms.specular), text_of(terms.through));
    const Vec3f before = radiance(at);
    ref::shade_light(work_->surface, light.shade, light.casts_shadows() ? work_->visibility : nullptr,
                     work_->shade);
    say("      adds {}", text_of(radiance(at) - before));
}

Vec3f PixelStory::sample(int x, int y, SamplePosition position) {
    const Region& region = tiles_.bins->region;
    const TileRect tile = tile_visibility(tiles_, (x - region.x0) / frame_tile_side,
                                          (y - region.y0) / frame_tile_side, position, exec_.isa, *work_);
    const int first_row = (y - tile.y0) / block_rows * block_rows;
    const int at = (y - tile.y0 - first_row) * frame_tile_side + (x - tile.x0);
    block_surface(tiles_, tile, first_row, Isa::ref, *work_);
    ref::shade_begin(work_->surface, tiles_.materials.data(), tiles_.sky, tiles_.rays, work_->shade);
    if (tiles_.sky_model != nullptr && tiles_.sky.background > 0) draw_sky(*tiles_.sky_model, *work_);
    if (!is(work_->surface.covered, at)) {
        const ShadeBlock& shade = work_->shade;
        say("    nothing but sky in direction {}", text_of(-Vec3f{shade.vx[at], shade.vy[at], shade.vz[at]}));
        return radiance(at);
    }
    tell_surface(at);
    tell_material(at);
    for (const TileLight& light : tiles_.lights)
        tell_light(light, light.shadow, at);
    return radiance(at);
}

/// What a pass adds to one sample, as add_tile() finds it.
Vec3f PixelStory::soft_sample(const TileScene& pass, int x, int y, std::size_t sample) {
    const Region& region = pass.bins->region;
    const int column = (x - region.x0) / frame_tile_side, row = (y - region.y0) / frame_tile_side;
    const TileRect tile = tile_visibility(pass, column, row, pass.pattern[sample], exec_.isa, *work_);
    const int first_row = (y - tile.y0) / block_rows * block_rows;
    const int at = (y - tile.y0 - first_row) * frame_tile_side + (x - tile.x0);
    ExactTile exact(pass.lights.size(), pass.gathers());
    exact.run(pass, column, row, static_cast<int>(sample), 1, first_row, first_row + block_rows, exec_.isa,
              *work_);
    exact.restore(0, *work_);
    block_surface(pass, tile, first_row, Isa::ref, *work_);
    if (!is(work_->surface.covered, at)) return {0, 0, 0};
    int lit = 0;
    for (std::size_t l = 0; l < pass.lights.size(); ++l) {
        std::fill_n(work_->visibility, block_samples, 1.0f);
        exact.darken(l, 0, first_row, work_->visibility);
        lit += work_->visibility[at] > 0 ? 1 : 0;
    }
    block_shade(pass, {&exact, 0, first_row}, Isa::ref, false, *work_);
    if (pass.pass->light->is_sky) {
        say("  sample {}, sky: {} of {} directions reach it, radiance {}", sample, lit, pass.lights.size(),
            text_of(radiance(at)));
        return radiance(at);
    }
    const Light& source = pass.pass->light->whole;
    say("  sample {}, light \"{}\" ({}, with a size): {} of {} points reach it, radiance {}", sample,
        source.id, light_kind_name(source.kind), lit, pass.lights.size(), text_of(radiance(at)));
    return radiance(at);
}

}  // namespace

PixelTrace trace_pixel(const Scene& scene, int x, int y, const Exec& exec, FrameCache& cache) {
    const RenderSettings& render = scene.render;
    CHECK(x >= 0 && y >= 0 && x < render.width && y < render.height);
    FrameStats stats;
    prepare_scene(scene, exec, cache, stats);
    TileScene tiles = prepare_tiles(scene, exec, cache);
    prepare_shadows(scene, 0, exec, cache, tiles, stats);
    PixelStory story(scene, tiles, cache, exec);
    story.say("pixel ({}, {}) of {} x {}, {} sample{}", x, y, render.width, render.height, render.samples,
              render.samples == 1 ? "" : "s");

    // Samples add up in the order of the pattern, as in render_tile().
    PixelTrace trace;
    for (std::size_t i = 0; i < tiles.pattern.size(); ++i) {
        const SamplePosition position = tiles.pattern[i];
        story.say("  sample {} at ({}, {}) / 256 of the pixel", i, position.x, position.y);
        const Vec3f radiance = story.sample(x, y, position);
        story.say("    radiance {}", text_of(radiance));
        trace.radiance = i == 0 ? radiance : trace.radiance + radiance;
    }
    const float share = 1.0f / static_cast<float>(tiles.pattern.size());
    trace.radiance = trace.radiance * share;
    for (const LightShadow& shadow : cache.shadows)
        stats.lights.push_back(shadow.stats);
    walk_soft_passes(tiles, exec, nullptr, stats.lights, [&](const TileScene& pass) {
        for (auto i = static_cast<std::size_t>(pass.pass->first); i < pass.pattern.size();
             i += static_cast<std::size_t>(pass.pass->stride))
            trace.radiance = trace.radiance + story.soft_sample(pass, x, y, i) * share;
        return true;
    });
    const Vec3f& r = trace.radiance;
    trace.radiance = {std::max(r.x, 0.0f), std::max(r.y, 0.0f), std::max(r.z, 0.0f)};
    story.say("  mean radiance {}", text_of(trace.radiance));
    if (scene.optics.enabled) story.say("  without the glare that [optics] adds to the whole picture");

    const ToneParams tone{render.exposure_ev, render.tone};
    const double scale = num::exp2(render.exposure_ev);
    const auto display = [&](float v) { return tone_curve(render.tone, static_cast<double>(v) * scale); };
    story.say("  exposure {:+.3g} EV: times {:.6g}; {} curve: ({:.6f}, {:.6f}, {:.6f})", render.exposure_ev,
              scale, render.tone == ToneCurve::linear ? "linear" : "filmic", display(trace.radiance.x),
              display(trace.radiance.y), display(trace.radiance.z));
    trace.pixel = tonemap(trace.radiance, tone);
    story.say("  sRGB {} {} {}", trace.pixel.r, trace.pixel.g, trace.pixel.b);
    trace.text = story.text();
    return trace;
}

PixelTrace trace_pixel(const Scene& scene, int x, int y, const Exec& exec) {
    FrameCache cache;
    return trace_pixel(scene, x, y, exec, cache);
}

}  // namespace obscura
