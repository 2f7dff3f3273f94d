#include "filters/shadow_lookup.h"

#include "core/vec_arrays.h"

namespace obscura {
namespace {

Vec3d axis_of(const LightView& view, int row) {
    const auto& m = view.to_map.m[row];
    return {m[0], m[1], m[2]};
}

/// On the plane n . q = -n . l through the receiver, q from the light: with right / |right|^2 = R, forward F
/// and tangents x = (X - cx) |right| ..., 1/w = (n . R (X - cx) + ... + n . F) / n . q is affine in X, and so
/// is Z = k (1 - near / w). Parallel light: Z itself is, with n . F = -n . l below.
void set_slopes(const LightView& view, PcfView& v) {
    const double k = length(axis_of(view, 2));
    const double scale = view.perspective ? k * view.near_w : k;
    const Vec3d forward = axis_of(view, 2) * (1.0 / k);
    const auto slope = [&](int row) {
        Vec3d across = axis_of(view, row);
        across = across - forward * dot(across, forward);
        return to_float(across * (scale / dot(across, across)));
    };
    set(v.slope_x, slope(0));
    set(v.slope_y, slope(1));
    v.step = static_cast<float>(scale);
}

PcfView pcf_view(const LightView& view, Vec3d eye, double offset_texels) {
    CHECK(view.width == view.height);
    PcfView v{};
    for (int r = 0; r < 4; ++r) {
        const auto& m = view.to_map.m[r];
        for (int c = 0; c < 3; ++c)
            v.to_map[r][c] = m[c];
        v.to_map[r][3] = (m[0] * eye.x + m[1] * eye.y) + (m[2] * eye.z + m[3]);
    }
    v.size = view.width;
    v.perspective = view.perspective;
    v.near_w = view.near_w;
    v.offset_m = offset_texels * texel_size_m(view);
    set_slopes(view, v);
    return v;
}

}  // namespace

PcfLight pcf_light(const Light& light, const PcfParams& params, std::span<const LightView> views, Vec3d eye) {
    CHECK(views.size() == 1 || views.size() == 6);
    PcfLight p;
    p.views = static_cast<std::int32_t>(views.size());
    for (std::size_t i = 0; i < views.size(); ++i)
        p.view[i] = pcf_view(views[i], eye, params.normal_offset_texels);
    p.side = params.side;
    p.directional = is_parallel(light.kind);
    set(p.to_light, to_float(-normalize(light.direction)));
    set(p.position, to_float(light.position - eye));
    return p;
}

PcfLight pcf_light(const Light& light, const PcfParams& params, const ShadowMap& map, Vec3d eye) {
    PcfLight p = pcf_light(light, params, std::span(map.views), eye);
    for (std::size_t i = 0; i < map.views.size(); ++i) {
        CHECK(map.stored[i].size == p.view[i].size);
        p.view[i].stored = map.stored[i].depth.data();
    }
    return p;
}

PcfLight pcf_light(const Light& light, const PcfParams& params, std::span<const ShadowTree> trees,
                   Vec3d eye) {
    std::vector<LightView> views;
    for (const ShadowTree& tree : trees)
        views.push_back(tree.view);
    PcfLight p = pcf_light(light, params, views, eye);
    CHECK(p.side % 2 == 1 && p.side >= 1 && p.side <= max_tree_pcf_side);
    for (std::size_t i = 0; i < trees.size(); ++i) {
        CHECK(p.view[i].size == 1 << trees[i].code.levels);
        p.view[i].tree = &trees[i].code;
    }
    return p;
}

void filter_hierarchically(PcfLight& light, const CameraRays& camera) {
    CHECK(light.view[0].stored == nullptr, "dense maps have one level");
    light.filter = PcfFilter::hierarchical;
    light.camera = camera;
}

}  // namespace obscura
