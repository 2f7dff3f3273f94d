#include "app/frame/surface_light.h"

#include <algorithm>
#include <cmath>

#include "app/frame/soft_light.h"
#include "app/frame/surface_blur.h"
#include "core/buffer.h"
#include "core/morton.h"
#include "core/num.h"
#include "core/parallel.h"
#include "core/vec_arrays.h"
#include "raster/depth_tile.h"
#include "raster/exact/caster_pool.h"
#include "raster/exact/exact_shadow.h"
#include "raster/light_samples.h"
#include "raster/lighting.h"
#include "raster/shade_terms.h"
#include "raster/texture.h"
#include "raster/view.h"

namespace obscura {
namespace {

constexpr std::size_t points_together = 8192;
/// Points that stand for a light with a size. Discs that are narrower than so many degrees are one point.
constexpr int most_light_points = 16;
constexpr double narrow_deg = 2;

/// A light as patches ask it.
struct Asked {
    Light light;
    double solid_angle_sr = 0;  ///< of the sky's
    bool shadows = true;
};

/// Middles of patches as exact shadows ask for them, in an order in which neighbours lie close together.
class PatchPoints {
  public:
    PatchPoints(const Mesh& mesh, const SurfacePatches& patches)
        : count_(patches.patches.size()),
          room_((count_ + 15) / 16 * 16),
          patch_(room_),
          px_(room_),
          py_(room_),
          pz_(room_),
          gx_(room_),
          gy_(room_),
          gz_(room_),
          face_(room_),
          triangle_(room_),
          covered_(room_ / 16),
          thin_(room_ / 16) {
        std::vector<PatchMiddle> middles;
        middles.reserve(count_);
        for (const SurfacePatch& patch : patches.patches)
            middles.push_back(patch_middle(mesh, patches, patch));
        const std::vector<std::uint32_t> order = order_of(mesh, middles);
        for (std::size_t i = 0; i < room_; ++i) {
            // What fills the last sixteen is not asked.
            patch_[i] = order[std::min(i, count_ - 1)];
            const PatchMiddle& m = middles[patch_[i]];
            const std::uint32_t triangle = patches.patches[patch_[i]].triangle;
            px_[i] = m.p.x;
            py_[i] = m.p.y;
            pz_[i] = m.p.z;
            gx_[i] = static_cast<float>(m.n.x);
            gy_[i] = static_cast<float>(m.n.y);
            gz_[i] = static_cast<float>(m.n.z);
            face_[i] = mesh.face[triangle];
            triangle_[i] = triangle;
        }
        for (std::size_t w = 0; w < room_ / 16; ++w) {
            const std::size_t left = std::min<std::size_t>(count_ - 16 * w, 16);
            covered_[w] = (1u << left) - 1u;
            thin_[w] = 0;
        }
    }

    std::size_t count() const { return count_; }
    std::uint32_t patch(std::size_t i) const { return patch_[i]; }
    Vec3d position(std::size_t i) const { return {px_[i], py_[i], pz_[i]}; }
    Vec3f normal(std::size_t i) const { return {gx_[i], gy_[i], gz_[i]}; }

    /// From the begin-th on, a multiple of sixteen; whole sixteens.
    ExactPoints part(std::size_t begin, std::size_t end) const {
        end = (end + 15) / 16 * 16;
        return {static_cast<std::int32_t>(end - begin),
                px_.data() + begin,
                py_.data() + begin,
                pz_.data() + begin,
                gx_.data() + begin,
                gy_.data() + begin,
                gz_.data() + begin,
                face_.data() + begin,
                triangle_.data() + begin,
                covered_.data() + begin / 16,
                thin_.data() + begin / 16};
    }

  private:
    /// Along a Morton curve of the scene's box, which is cut 1024 times along its longest side.
    static std::vector<std::uint32_t> order_of(const Mesh& mesh, const std::vector<PatchMiddle>& middles) {
        const Bounds box = bounds_of(mesh);
        const Vec3d size = box.high - box.low;
        const double cell = std::max({size.x, size.y, size.z, 1e-30}) / 1023;
        const auto step = [](double at) { return static_cast<std::uint32_t>(std::clamp(at, 0.0, 1023.0)); };
        std::vector<std::uint64_t> keys;
        keys.reserve(middles.size());
        for (std::size_t i = 0; i < middles.size(); ++i) {
            const Vec3d at = (middles[i].p - box.low) * (1 / cell);
            const std::uint64_t code = morton_code(step(at.x), step(at.y), step(at.z));
            keys.push_back(code << 32 | i);
        }
        std::sort(keys.begin(), keys.end());
        std::vector<std::uint32_t> order;
        order.reserve(keys.size());
        for (const std::uint64_t key : keys)
            order.push_back(static_cast<std::uint32_t>(key));
        return order;
    }

    std::size_t count_, room_;
    Buffer<std::uint32_t> patch_;
    Buffer<double> px_, py_, pz_;
    Buffer<float> gx_, gy_, gz_;
    Buffer<std::uint32_t> face_, triangle_, covered_, thin_;
};

/// Texture or paint of a patch, about as wide as it.
Vec3f albedo_of(const Scene& scene, const SurfacePatches& patches, const SurfacePatch& patch) {
    const Mesh& mesh = scene.mesh;
    const Material& m = scene.materials[mesh.material[patch.triangle]];
    if (m.texture < 0 || mesh.uvs.empty()) return m.base_color;
    const Texture& texture = scene.textures[static_cast<std::size_t>(m.texture)];
    const PatchMiddle middle = patch_middle(mesh, patches, patch);
    const auto& v = mesh.triangles[patch.triangle].v;
    const Vec2f a = mesh.uvs[v[0]], ab = mesh.uvs[v[1]] - a, ac = mesh.uvs[v[2]] - a;
    const float step = 0.7f / static_cast<float>(patches.triangles[patch.triangle].side);
    const auto level = static_cast<int>(std::ceil(mip_level(texture, {ab * step, ac * step})));
    return m.base_color *
           sample_level(texture, level,
                        a + ab * static_cast<float>(middle.u) + ac * static_cast<float>(middle.v));
}

class Exchange {
  public:
    Exchange(const Scene& scene, const FrameSky& sky, const Exec& exec, const std::atomic<bool>* cancel)
        : scene_(scene), sky_(sky), exec_(exec), cancel_(cancel), patches_(surface_patches(scene.mesh)) {}

    /// None when cancelled.
    SurfaceLight run() {
        if (patches_.patches.empty()) return black();
        const PatchPoints points(scene_.mesh, patches_);
        // Patches have no camera. Its place says how exact depths are: that of the scene's middle.
        const Bounds box = bounds_of(scene_.mesh);
        rays_.perspective = true;
        set(rays_.eye, (box.low + box.high) * 0.5);
        std::vector<Vec3f> direct(patches_.patches.size());
        for (const SceneLight& light : scene_.lights) {
            if (sheds_light(light.light) && !ask(points, points_of(light), nullptr, direct)) return {};
        }
        const std::vector<Asked> sky = sky_lights();
        if (!ask(points, sky, nullptr, direct)) return {};
        SurfaceLight sent = send(direct);
        for (int bounce = 1; bounce < sky_.sky.bounces; ++bounce) {
            std::vector<Vec3f> arriving = direct;
            if (!ask(points, sky, &sent, arriving)) return {};
            sent = send(arriving);
        }
        sent.patches = std::move(patches_);
        return sent;
    }

  private:
    /// Nothing casts shadows, so nothing hides the sky.
    SurfaceLight black() const {
        SurfaceLight sent;
        sent.patches = patches_;
        for (std::vector<Vec3f>& level : sent.sent)
            level.assign(1, Vec3f{0, 0, 0});
        return sent;
    }

    static std::vector<Asked> points_of(const SceneLight& light) {
        const bool narrow = is_parallel(light.light.kind) && light.light.angular_diameter_deg < narrow_deg;
        const bool sized = has_size(light.light) && light.shadow.samples != 1 && !narrow;
        // Surfaces face all ways.
        const int most = light.light.kind == LightKind::surface ? 4 * most_light_points : most_light_points;
        std::vector<Asked> points;
        for (const Light& point : light_samples(light.light, sized ? most : 1))
            points.push_back({point, 0, light.shadow.method != ShadowMethod::none});
        return points;
    }

    std::vector<Asked> sky_lights() const {
        std::vector<Asked> asked;
        for (std::size_t i = 0; i < sky_.few.size(); ++i)
            asked.push_back({sky_.few[i], sky_.few_sr[i]});
        return asked;
    }

    /// Adds what the lights shed on all patches, or, where they are hidden, what is `sent` instead. False
    /// when cancelled.
    bool ask(const PatchPoints& points, const std::vector<Asked>& lights, const SurfaceLight* sent,
             std::vector<Vec3f>& arriving) const {
        CasterPool pool;
        // As many at a time as a pass holds, or as there are threads to put their casters in order.
        const auto together =
            static_cast<std::size_t>(std::min(exec_.threads > 0 ? exec_.threads : hardware_threads(),
                                              soft_points_together(size_of(scene_.mesh), false)));
        for (std::size_t begin = 0; begin < lights.size(); begin += together) {
            const std::size_t end = std::min(begin + together, lights.size());
            std::vector<Light> some;
            for (std::size_t i = begin; i < end; ++i)
                some.push_back(lights[i].light);
            auto casters = pool.build(scene_.mesh, some, exec_, cancel_);
            if (casters.empty()) return false;
            for (std::size_t i = begin; i < end; ++i)
                ask_one(points, lights[i], casters[i - begin], sent, arriving);
            pool.give_back(std::move(casters));
        }
        return true;
    }

    void ask_one(const PatchPoints& points, const Asked& asked, std::span<const Casters> casters,
                 const SurfaceLight* sent, std::vector<Vec3f>& arriving) const {
        const ExactLight exact = exact_light(asked.light, casters, scene_.mesh, rays_);
        parallel_blocks(points.count(), points_together, exec_, [&](std::size_t begin, std::size_t end) {
            const ExactPoints part = points.part(begin, end);
            ExactWork work(static_cast<std::size_t>(part.count));
            ExactCounts counts;
            std::vector<std::uint32_t> lit(part.covered, part.covered + part.count / 16);
            if (sent == nullptr) {
                if (asked.shadows) work.shadows(part, exact, exec_.isa, lit.data(), counts);
                add_light(points, asked.light, lit, begin, end, arriving);
            } else {
                std::vector<std::uint32_t> triangle(static_cast<std::size_t>(part.count), no_triangle);
                std::vector<float> distance(triangle.size());
                work.nearest(part, exact, exec_.isa, lit.data(), {triangle.data(), distance.data()}, counts);
                add_sent(points, asked, vec(exact.to_light), *sent, {triangle.data(), distance.data()}, begin,
                         end, arriving);
            }
        });
    }

    void add_light(const PatchPoints& points, const Light& light, const std::vector<std::uint32_t>& lit,
                   std::size_t begin, std::size_t end, std::vector<Vec3f>& arriving) const {
        const Vec3d eye = vec(rays_.eye);
        const ShadeLight shade = shade_light_of(light, eye);
        for (std::size_t i = begin; i < end; ++i) {
            if ((lit[(i - begin) / 16] >> (i % 16) & 1u) == 0) continue;
            const ref::Incident incident = ref::incident_light(shade, to_float(points.position(i) - eye));
            const float cosine = std::max(dot(points.normal(i), incident.to_light), 0.0f);
            Vec3f& sum = arriving[points.patch(i)];
            sum = sum + incident.irradiance * cosine;
        }
    }

    void add_sent(const PatchPoints& points, const Asked& asked, Vec3f to_light, const SurfaceLight& sent,
                  const ExactHits& hits, std::size_t begin, std::size_t end,
                  std::vector<Vec3f>& arriving) const {
        const auto solid_angle = static_cast<float>(asked.solid_angle_sr);
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t triangle = hits.triangle[i - begin];
            if (triangle == no_triangle) continue;
            const Vec3f radiance =
                sent_radiance(scene_.mesh, sent, triangle, points.position(i), to_double(to_light),
                              hits.distance_m[i - begin], solid_angle);
            const float cosine = std::max(dot(points.normal(i), to_light), 0.0f);
            Vec3f& sum = arriving[points.patch(i)];
            sum = sum + radiance * (cosine * solid_angle);
        }
    }

    /// The patch on the other side of the same place; itself when there is none.
    std::size_t other_side(std::size_t i) const {
        const SurfacePatch& patch = patches_.patches[i];
        const TrianglePatches& of = patches_.triangles[patch.triangle];
        const std::uint32_t first = patch.back ? of.front : of.back;
        return first == no_patch ? i : first + patch.cell;
    }

    /// What leaves the patches when so much arrives at them, and its means.
    SurfaceLight send(const std::vector<Vec3f>& arriving) const {
        SurfaceLight sent;
        const std::size_t count = patches_.patches.size();
        std::vector<BlurPatch> patches(count);
        sent.sent[0].resize(count);
        parallel_blocks(count, points_together, exec_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const SurfacePatch& patch = patches_.patches[i];
                const float through = scene_.materials[scene_.mesh.material[patch.triangle]].translucency;
                const Vec3f both = arriving[i] * (1 - through) + arriving[other_side(i)] * through;
                sent.sent[0][i] = albedo_of(scene_, patches_, patch) * inv_pi * both;
                const PatchMiddle middle = patch_middle(scene_.mesh, patches_, patch);
                patches[i] = {middle.p, facing_of(middle.n), patch.area_m2};
            }
        });
        for (std::size_t l = 1; l < SurfaceLight::levels; ++l)
            sent.sent[l] = mean_around(patches, sent.sent[0], patches_.size_m * static_cast<double>(1u << l));
        if (sky_.sky.bounces > 1) sent.patches = patches_;
        return sent;
    }

    const Scene& scene_;
    const FrameSky& sky_;
    const Exec exec_;
    const std::atomic<bool>* cancel_;
    SurfacePatches patches_;
    CameraRays rays_{};
};

}  // namespace

Vec3f sent_radiance(const Mesh& mesh, const SurfaceLight& light, std::uint32_t triangle, Vec3d p,
                    Vec3d to_light, float distance_m, float solid_angle_sr) {
    // Whoever looks along to_light sees the side that the normal points away from.
    const bool back = dot(mesh.faces[mesh.face[triangle]].n, to_light) > 0;
    const std::uint32_t patch =
        patch_at(mesh, light.patches, triangle, back, p + to_light * static_cast<double>(distance_m));
    if (patch == no_patch) return {0, 0, 0};
    // The side of a square as large as the cone is there, over a patch's: between two levels.
    const float wide = distance_m * std::sqrt(solid_angle_sr) / static_cast<float>(light.patches.size_m);
    const float level = std::clamp(wide > 1 ? fast_log2(wide) : 0.0f, 0.0f, SurfaceLight::levels - 1.0f);
    const auto low = static_cast<std::size_t>(level);
    const Vec3f fine = light.sent[low][patch];
    const std::size_t high = std::min<std::size_t>(low + 1, SurfaceLight::levels - 1);
    return fine + (light.sent[high][patch] - fine) * (level - static_cast<float>(low));
}

SurfaceLight surface_light(const Scene& scene, const FrameSky& sky, const Exec& exec,
                           const std::atomic<bool>* cancel) {
    return Exchange(scene, sky, exec, cancel).run();
}

namespace {

/// How many patches are expected: both sides of what is large, and a quarter of all triangles, since small
/// ones share theirs.
std::int64_t expected_patches(const MeshSize& mesh, int sides) {
    return sides * surface_cells + mesh.triangles / 4;
}

}  // namespace

std::int64_t surface_light_bytes(const MeshSize& mesh) {
    return expected_patches(mesh, 2) *
               (SurfaceLight::levels * std::int64_t{sizeof(Vec3f)} + std::int64_t{sizeof(SurfacePatch)}) +
           mesh.triangles * std::int64_t{sizeof(TrianglePatches)};
}

std::int64_t surface_light_work_bytes(const MeshSize& mesh) {
    constexpr std::int64_t point = 3 * sizeof(double) + 3 * sizeof(float) + 3 * sizeof(std::uint32_t);
    // Light that arrives, twice, what was sent before, and of a mean the corners around each patch: their
    // places and shares, and one corner of its own, which grow by doubling.
    return expected_patches(mesh, 1) * (point + (2 + SurfaceLight::levels) * std::int64_t{sizeof(Vec3f)} +
                                        std::int64_t{sizeof(BlurPatch)} + 64 + 2 * 56);
}

}  // namespace obscura
