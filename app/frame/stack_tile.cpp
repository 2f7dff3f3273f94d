#include "app/frame/stack_tile.h"

#include <algorithm>

#include "app/frame/light_shadow.h"
#include "app/frame/stack_shadow.h"
#include "core/error.h"
#include "hierarchy/stack/visible_share.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

bool is_set(const std::uint32_t* masks, int at) {
    return (masks[at / 16] >> (at % 16) & 1u) != 0;
}

/// Normals of a block's samples, turned to the light where surfaces are thin; 0 where nothing is covered,
/// which lookups answer at once.
struct alignas(64) BlockNormals {
    float x[block_samples], y[block_samples], z[block_samples];

    BlockNormals(const StackLight& light, const SurfaceBlock& s) {
        for (int i = 0; i < block_samples; ++i) {
            const bool covered = is_set(s.covered, i), thin = is_set(s.thin, i);
            Vec3f n = covered ? Vec3f{s.gx[i], s.gy[i], s.gz[i]} : Vec3f{0, 0, 0};
            if (covered && thin) {
                const Vec3f l =
                    light.parallel ? light.middle : light.middle - Vec3f{s.px[i], s.py[i], s.pz[i]};
                if (dot(n, l) < 0) n = -n;
            }
            x[i] = n.x;
            y[i] = n.y;
            z[i] = n.z;
        }
    }
};

}  // namespace

StackLight stack_light(const LightShadow& shadow, Vec3d eye) {
    CHECK(shadow.stack.has_value());
    const Light& light = shadow.light.light;
    // Not kept with the stack: its colour may have changed.
    const std::vector<Light> points = stack_points(shadow.light);
    StackLight s;
    s.lookup = stack_lookup(*shadow.stack, eye);
    const std::size_t most = is_parallel(light.kind) ? most_shaded_parallel : most_shaded_parts;
    std::size_t parts = 1;
    while (2 * parts <= most && points.size() % (2 * parts) == 0)
        parts *= 2;
    for (const Light& part : stack_parts(points, parts))
        s.parts.push_back(shade_light_of(part, eye));
    s.per_point = static_cast<float>(parts) / static_cast<float>(points.size());
    s.parallel = is_parallel(light.kind);
    s.middle = to_float(s.parallel ? -normalize(light.direction) : light.position - eye);
    return s;
}

void stack_block(const StackLight& light, const SurfaceBlock& surface, Isa isa, std::uint16_t* lit) {
    const BlockNormals n(light, surface);
    const StackPoints points{surface.px, surface.py, surface.pz, n.x, n.y, n.z, nullptr, block_samples};
    StackWork work;
    const auto parts = static_cast<std::int32_t>(light.parts.size());
    OBSCURA_DISPATCH(isa, lit_of_parts, light.lookup, points, parts, lit, work);
    // Outside of the map is lit, even where nothing is.
    for (std::int32_t part = 0; part < parts; ++part) {
        for (int i = 0; i < block_samples; ++i)
            if (!is_set(surface.covered, i)) lit[part * block_samples + i] = 0;
    }
}

void part_visibility(const StackLight& light, std::size_t part, const SurfaceBlock& s,
                     const std::uint16_t* lit, float* visibility) {
    const ShadeLight& l = light.parts[part];
    lit += part * block_samples;
    for (int i = 0; i < block_samples; ++i) {
        Vec3f way{l.to_light[0], l.to_light[1], l.to_light[2]};
        if (!light.parallel)
            way = Vec3f{l.position[0], l.position[1], l.position[2]} - Vec3f{s.px[i], s.py[i], s.pz[i]};
        const bool asks = dot(Vec3f{s.gx[i], s.gy[i], s.gz[i]}, way) > 0 || is_set(s.thin, i);
        visibility[i] = asks && lit[i] != 0 ? static_cast<float>(lit[i]) * light.per_point : 0.0f;
    }
}

void shade_stack(const StackLight& light, const SurfaceBlock& surface, Isa isa, float* visibility,
                 float* shadow_sum, ShadeBlock& shade) {
    std::uint16_t lit[most_stack_parts * block_samples];
    stack_block(light, surface, isa, lit);
    const float share = 1.0f / static_cast<float>(light.parts.size());
    for (std::size_t part = 0; part < light.parts.size(); ++part) {
        part_visibility(light, part, surface, lit, visibility);
        if (std::all_of(visibility, visibility + block_samples, [](float v) { return v == 0; })) continue;
        OBSCURA_DISPATCH(isa, shade_light, surface, light.parts[part], visibility, shade);
        for (int i = 0; shadow_sum != nullptr && i < block_samples; ++i)
            shadow_sum[i] += visibility[i] * share;
    }
}

}  // namespace obscura
