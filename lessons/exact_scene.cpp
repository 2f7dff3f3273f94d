#include "lessons/exact_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/topology.h"
#include "filters/shadow_lookup.h"
#include "lessons/drawing/figure.h"
#include "lessons/seen_surfaces.h"
#include "raster/depth_map.h"
#include "raster/view.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// Where a ray meets a triangle (T. Moeller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", JGT 1997): its distance, or none.
constexpr double none = std::numeric_limits<double>::infinity();
double meets(const Mesh& mesh, std::size_t t, Vec3d origin, Vec3d way) {
    const auto corner = [&](int k) { return to_double(mesh.positions[mesh.triangles[t].v[k]]); };
    const Vec3d a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a, h = cross(way, e2);
    const double det = dot(e1, h);
    if (det == 0) return none;
    const Vec3d s = origin - a, q = cross(s, e1);
    const double u = dot(s, h) / det, v = dot(way, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 ? dot(e2, q) / det : none;
}

/// Planes closer than this hide nothing of one another: a little more than any sample's place is uncertain.
constexpr double same_surface_m = 1e-4;

bool sun_reaches(const ExactScene& scene, Vec3d p, std::uint32_t face) {
    const Mesh& mesh = scene.mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.face[t] == face) continue;
        const double distance = meets(mesh, t, p, -scene.sun.direction);
        if (distance == none || distance <= 0) continue;
        const double cosine = std::fabs(dot(mesh.faces[mesh.face[t]].n, scene.sun.direction));
        if (distance * cosine > same_surface_m) return false;
    }
    return true;
}

/// What the camera shows of a material in so much light.
Rgb8 shade(std::uint32_t material, double light) {
    constexpr Rgb8 paint[] = {{236, 231, 219}, {214, 222, 226}, {240, 178, 60}, {104, 178, 222}};
    return mix({38, 44, 62}, paint[material], 0.22 + 0.78 * std::min(light, 1.0));
}

/// Sums of what a pixel's samples show.
struct PixelSum {
    double light = 0, r = 0, g = 0, b = 0;
    void add(double visible, Rgb8 color) {
        light += visible;
        r += color.r;
        g += color.g;
        b += color.b;
    }
    Rgb8 mean(int count) const {
        const auto code = [&](double sum) { return static_cast<std::uint8_t>(sum / count + 0.5); };
        return {code(r), code(g), code(b)};
    }
};

}  // namespace

ExactScene exact_scene() {
    ExactScene scene;
    // The tile lies deeper than the floor by less than the camera's depths can tell, and comes first: of two
    // surfaces with one depth the camera shows the first.
    add_part(scene.mesh, box({0.3, -0.1, -0.1}, {0.85, -2e-8, 0.45}), translation(0, 0, 0), 1);
    add_part(scene.mesh, box({-3.6, -0.2, -6.4}, {3.6, 0, 1.8}), translation(0, 0, 0), 0);
    add_part(scene.mesh, torus(0.4, 0.09, 28, 10),
             translation(0.2, 0.49, -1.15) * rotation_y(24) * rotation_x(90), 2);
    add_part(scene.mesh, box({-0.09, 0, -0.01}, {0.09, 0.5, 0.01}),
             translation(-0.5, 0, 0.1) * rotation_y(14), 3);
    analyse_topology(scene.mesh);
    scene.sun.direction = normalize(Vec3d{0.3, -0.6, 0.52});
    scene.camera.eye = {0.05, 0.85, 2.1};
    scene.camera.look_at = {0.05, 0.27, -0.3};
    scene.camera.vfov_deg = 36;
    return scene;
}

ExactPoints SeenPoints::points() const {
    ExactPoints e{};
    e.count = static_cast<std::int32_t>(size());
    e.px = p[0].data();
    e.py = p[1].data();
    e.pz = p[2].data();
    e.gx = g[0].data();
    e.gy = g[1].data();
    e.gz = g[2].data();
    e.face = face.data();
    e.triangle = triangle.data();
    e.covered = covered.data();
    e.thin = thin.data();
    return e;
}

double SeenPoints::facing(const ExactScene& scene, std::size_t i) const {
    return -dot(to_double({g[0][i], g[1][i], g[2][i]}), scene.sun.direction);
}

SeenPoints seen_points(const ExactScene& scene, int finer, const Exec& exec) {
    SeenPoints seen = seen_points(scene.mesh, scene.camera, finer * exact_width, finer * exact_height, exec);
    seen.finer = finer;
    return seen;
}

SeenPoints seen_points(const Mesh& mesh, const Camera& camera, int width, int height, const Exec& exec) {
    SeenPoints seen;
    seen.blocks = seen_surfaces(SeenMesh(mesh), camera, width, height, exec);
    const std::size_t count = seen.blocks.size() * block_samples;
    for (int k = 0; k < 3; ++k)
        seen.p[k].resize(count);
    seen.face.resize(count);
    for (std::size_t i = 0; i < seen.blocks.size(); ++i) {
        const SurfaceBlock& b = seen.blocks[i];
        const std::size_t to = i * block_samples;
        exact_positions(b, mesh, camera.eye, seen.p[0].data() + to, seen.p[1].data() + to,
                        seen.p[2].data() + to, seen.face.data() + to);
        seen.g[0].insert(seen.g[0].end(), b.gx, b.gx + block_samples);
        seen.g[1].insert(seen.g[1].end(), b.gy, b.gy + block_samples);
        seen.g[2].insert(seen.g[2].end(), b.gz, b.gz + block_samples);
        seen.triangle.insert(seen.triangle.end(), b.triangle, b.triangle + block_samples);
        seen.covered.insert(seen.covered.end(), b.covered, b.covered + block_groups);
        seen.thin.insert(seen.thin.end(), b.thin, b.thin + block_groups);
    }
    return seen;
}

ShadowMap map_of(const ExactScene& scene, int texels, const Exec& exec) {
    const Bounds box = caster_box(scene.mesh, scene.sun.direction);
    RasterScratch scratch;
    ShadowMap map;
    build_shadow_map(scene.mesh, fitted_shadow_views(scene.sun, {texels, 3}, box), Receivers::any, exec,
                     scratch, map);
    return map;
}

Visibility of_bits(const std::vector<std::uint32_t>& lit) {
    Visibility v(lit.size() * 16);
    for (std::size_t i = 0; i < v.size(); ++i)
        v[i] = (lit[i / 16] >> (i % 16) & 1u) != 0 ? 1.0f : 0.0f;
    return v;
}

Visibility by_first_depth(const ExactScene& scene, const SeenPoints& seen, const LightView& view, float bias,
                          const Exec& exec) {
    const Image<float> map = depth_map(scene.mesh, view, exec);
    Visibility v(seen.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        if (!seen.is_covered(i) || !(seen.facing(scene, i) > 0)) continue;
        const Vec3d at = to_map_space(view, seen.at(i));
        const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
        const bool inside = x >= 0 && y >= 0 && x < map.width && y < map.height;
        v[i] = !inside || static_cast<float>(at.z) <= map(x, y) + bias ? 1.0f : 0.0f;
    }
    return v;
}

Visibility by_map(const ExactScene& scene, const SeenPoints& seen, const ShadowMap& map, int side,
                  const Exec& exec) {
    const PcfLight light = pcf_light(scene.sun, {side}, map, scene.camera.eye);
    Visibility v(seen.size());
    for (std::size_t b = 0; b < seen.blocks.size(); ++b)
        OBSCURA_DISPATCH(exec.isa, pcf_block, seen.blocks[b], light, v.data() + b * block_samples);
    return v;
}

Visibility by_rays(const ExactScene& scene, const SeenPoints& seen, const Exec& exec) {
    Visibility v(seen.size());
    parallel_for(v.size(), exec, [&](std::size_t i) {
        const bool asks = seen.is_covered(i) && seen.facing(scene, i) > 0;
        v[i] = asks && sun_reaches(scene, seen.at(i), seen.face[i]) ? 1.0f : 0.0f;
    });
    return v;
}

WrongSamples wrong_samples(const Visibility& v, const Visibility& truth) {
    WrongSamples wrong;
    for (std::size_t i = 0; i < v.size(); ++i) {
        wrong.dark += truth[i] == 1.0f && v[i] < 0.5f ? 1 : 0;
        wrong.lit += truth[i] == 0.0f && v[i] >= 0.5f ? 1 : 0;
    }
    return wrong;
}

LitPixels lit_pixels(const ExactScene& scene, const SeenPoints& seen, const Visibility& visibility,
                     const Crop& crop) {
    Image<PixelSum> sums(crop.width, crop.height);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const SeenPixel at = seen_pixel(i, seen.finer * exact_width);
        const int x = at.x / seen.finer - crop.x, y = at.y / seen.finer - crop.y;
        if (x < 0 || y < 0 || x >= crop.width || y >= crop.height) continue;
        if (!seen.is_covered(i)) {
            sums(x, y).add(0, {176, 200, 222});
            continue;
        }
        const std::uint32_t t = seen.triangle[i];
        const auto visible = static_cast<double>(visibility[i]);
        sums(x, y).add(visible, shade(scene.mesh.material[t], 1.4 * visible * seen.facing(scene, i)));
    }
    LitPixels pixels{Image<double>(crop.width, crop.height), Image<Rgb8>(crop.width, crop.height)};
    const int count = seen.finer * seen.finer;
    for (std::size_t i = 0; i < sums.pixels.size(); ++i) {
        pixels.light.pixels[i] = sums.pixels[i].light / count;
        pixels.picture.pixels[i] = sums.pixels[i].mean(count);
    }
    return pixels;
}

LitPixels true_pixels(const ExactScene& scene, int side, const Crop& crop, const Exec& exec) {
    const CameraRays rays = camera_rays(scene.camera, exact_width, exact_height);
    const Mesh& mesh = scene.mesh;
    LitPixels pixels{Image<double>(crop.width, crop.height), Image<Rgb8>(crop.width, crop.height)};
    parallel_for(pixels.light.pixels.size(), exec, [&](std::size_t i) {
        PixelSum sum;
        for (int s = 0; s < side * side; ++s) {
            const double X = crop.x + static_cast<int>(i) % crop.width + (s % side + 0.5) / side,
                         Y = crop.y + static_cast<int>(i) / crop.width + (s / side + 0.5) / side;
            const auto along = [&](int k) { return rays.dir0[k] + X * rays.dir_x[k] + Y * rays.dir_y[k]; };
            const Vec3d way{along(0), along(1), along(2)};
            double nearest = none;
            std::size_t seen = 0;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
                const double distance = meets(mesh, t, scene.camera.eye, way);
                if (distance <= 0 || distance >= nearest) continue;
                nearest = distance;
                seen = t;
            }
            CHECK(nearest != none);
            const Vec3d n = mesh.faces[mesh.face[seen]].n;
            const double facing =
                dot(n, way) < 0 ? -dot(n, scene.sun.direction) : dot(n, scene.sun.direction);
            const bool lit =
                facing > 0 && sun_reaches(scene, scene.camera.eye + way * nearest, mesh.face[seen]);
            sum.add(lit ? 1 : 0, shade(mesh.material[seen], lit ? 1.4 * facing : 0));
        }
        pixels.light.pixels[i] = sum.light / (side * side);
        pixels.picture.pixels[i] = sum.mean(side * side);
    });
    return pixels;
}

double rms_between(const Image<double>& a, const Image<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        sum += (a.pixels[i] - b.pixels[i]) * (a.pixels[i] - b.pixels[i]);
    return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

}  // namespace obscura
