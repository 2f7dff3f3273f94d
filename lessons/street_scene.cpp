#include "lessons/street_scene.h"

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"
#include "core/topology.h"
#include "lessons/seen_surfaces.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

constexpr double side = 0.5 * street_width;
constexpr Vec3d albedo[] = {
    {0.44, 0.42, 0.39}, {0.58, 0.50, 0.41}, {0.52, 0.09, 0.06}, {0.70, 0.68, 0.64}, {0.06, 0.07, 0.08}};

/// Points that are looked up together.
constexpr std::size_t chunk = 4096;

ExactPoints part_of(const SeenPoints& seen, std::size_t begin, std::size_t count) {
    ExactPoints e = seen.points();
    e.count = static_cast<std::int32_t>(count);
    for (const double** array : {&e.px, &e.py, &e.pz})
        *array += begin;
    for (const float** array : {&e.gx, &e.gy, &e.gz})
        *array += begin;
    e.face += begin;
    e.triangle += begin;
    e.covered += begin / 16;
    e.thin += begin / 16;
    return e;
}

void add_box(Mesh& mesh, Vec3d least, Vec3d greatest, std::uint32_t material) {
    add_part(mesh, box(least, greatest), translation(0, 0, 0), material);
}

/// An upper floor on pillars.
void add_arcade(Mesh& mesh, double z0, double z1) {
    constexpr double ceiling = 3.4, depth = 3, pillar = 0.55, step = 2.6;
    add_box(mesh, {-side - 8, ceiling, z0}, {-side, wall_height, z1}, 1);
    add_box(mesh, {-side - 8, 0, z0}, {-side - depth, ceiling, z1}, 1);
    for (double z = z0; z + pillar <= z1; z += step)
        add_box(mesh, {-side - pillar, 0, z}, {-side, ceiling, z + pillar}, 1);
}

void add_windows(Mesh& mesh, double z0, double z1) {
    for (double z = z0; z < z1; z += 2.6) {
        for (const double y : {4.4, 7.2})
            add_box(mesh, {side - 0.04, y, z}, {side + 0.01, y + 1.5, z + 1.0}, 4);
    }
}

double clamped_cosine(const SeenPoints& seen, std::size_t i, Vec3d towards) {
    return std::max(0.0, dot(to_double({seen.g[0][i], seen.g[1][i], seen.g[2][i]}), towards));
}

}  // namespace

Mesh plain_street() {
    Mesh mesh;
    add_box(mesh, {-30, -1, -200}, {30, 0, 200}, 0);
    for (const double x : {-side - 8, side})
        add_box(mesh, {x, 0, -200}, {x + 8, wall_height, 200}, 1);
    analyse_topology(mesh);
    return mesh;
}

StreetScene street_scene() {
    StreetScene street;
    Mesh& mesh = street.mesh;
    add_box(mesh, {-30, -1, -60}, {30, 0, 40}, 0);
    add_arcade(mesh, -60, -10.4);
    add_arcade(mesh, -7.4, 40);
    add_box(mesh, {side, 0, -60}, {side + 8, wall_height, 40}, 1);
    add_windows(mesh, -40, 8);
    add_box(mesh, {side - 1.9, 2.7, -4.6}, {side, 2.8, 0.2}, 2);
    for (const double z : {-4.5, 0.0})
        add_box(mesh, {side - 1.85, 0, z}, {side - 1.75, 2.7, z + 0.1}, 2);
    add_box(mesh, {side - 1.3, 0, -3.2}, {side - 0.5, 0.8, -1.2}, 1);
    add_part(mesh, sphere(0.55, 40, 20), translation(1.9, 0.55, 0.9), 3);
    analyse_topology(mesh);
    street.camera.eye = {-0.4, 1.8, 8.2};
    street.camera.look_at = {0.35, 2.3, -6};
    street.camera.vfov_deg = 50;
    return street;
}

double sky_view_factor(double x) {
    const auto sine = [](double across) {
        return across / std::sqrt(across * across + wall_height * wall_height);
    };
    return 0.5 * (sine(side + x) + sine(side - x));
}

SeenPoints ground_points(const Mesh& street, const std::vector<double>& xs) {
    const auto on_ground = [&](std::size_t t, double x) {
        if (street.material[t] != 0 || street.faces[street.face[t]].n.y < 0.5) return false;
        const auto corner = [&](int k) { return to_double(street.positions[street.triangles[t].v[k]]); };
        double low = 0, high = 0;
        for (int k = 0; k < 3; ++k) {
            const Vec3d a = corner(k), b = corner((k + 1) % 3);
            const double turn = (b.x - a.x) * (0.5 - a.z) - (b.z - a.z) * (x - a.x);
            low = std::min(low, turn);
            high = std::max(high, turn);
        }
        return low == 0 || high == 0;
    };
    SeenPoints seen;
    const std::size_t count = (xs.size() + 15) / 16 * 16;
    seen.covered.assign(count / 16, 0);
    seen.thin.assign(count / 16, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = i < xs.size() ? xs[i] : 0;
        std::size_t t = 0;
        while (!on_ground(t, x))
            ++t;
        seen.p[0].push_back(x);
        seen.p[1].push_back(0);
        seen.p[2].push_back(0.5);
        for (int k = 0; k < 3; ++k)
            seen.g[k].push_back(k == 1 ? 1.0f : 0.0f);
        seen.face.push_back(street.face[t]);
        seen.triangle.push_back(static_cast<std::uint32_t>(t));
        if (i < xs.size()) seen.covered[i / 16] |= 1u << (i % 16);
    }
    return seen;
}

Arrivals arrivals(const Mesh& mesh, const Camera& camera, const SeenPoints& seen,
                  std::span<const SkyDirection> suns, const Exec& exec) {
    // Counts are not told, so the reference may be asked as well.
    const CameraRays rays = camera_rays(camera, 1080, 720);
    CasterScratch scratch;
    std::vector<std::vector<Casters>> casters;
    std::vector<ExactLight> lights;
    for (const SkyDirection& sun : suns) {
        Light light;
        light.direction = -sun.direction;
        casters.push_back(build_casters(mesh, light, exec, scratch));
        lights.push_back(exact_light(light, casters.back(), mesh, rays));
    }
    Arrivals arrive{seen.covered.size(), std::vector<std::uint32_t>(seen.covered.size() * suns.size())};
    parallel_blocks(seen.size(), chunk, exec, [&](std::size_t begin, std::size_t end) {
        ExactWork work(chunk);
        ExactCounts counts;
        const ExactPoints points = part_of(seen, begin, end - begin);
        for (std::size_t k = 0; k < lights.size(); ++k)
            work.shadows(points, lights[k], exec.isa, arrive.lit.data() + k * arrive.words + begin / 16,
                         counts);
    });
    return arrive;
}

int count_arrivals(const Arrivals& arrive, std::size_t suns, std::size_t i) {
    int count = 0;
    for (std::size_t k = 0; k < suns; ++k)
        count += arrive(k, i) ? 1 : 0;
    return count;
}

std::vector<Vec3d> irradiance(const SeenPoints& seen, std::span<const SkyDirection> suns,
                              const Arrivals& arrive) {
    std::vector<Vec3d> light(seen.size());
    for (std::size_t k = 0; k < suns.size(); ++k) {
        for (std::size_t i = 0; i < seen.size(); ++i) {
            if (seen.is_covered(i) && arrive(k, i))
                light[i] = light[i] +
                           to_double(suns[k].irradiance_w_m2) * clamped_cosine(seen, i, suns[k].direction);
        }
    }
    return light;
}

std::vector<Vec3d> irradiance(const SeenPoints& seen, std::span<const SkyDirection> suns) {
    std::vector<Vec3d> light(seen.size());
    for (const SkyDirection& sun : suns) {
        for (std::size_t i = 0; i < seen.size(); ++i)
            light[i] = light[i] + to_double(sun.irradiance_w_m2) * clamped_cosine(seen, i, sun.direction);
    }
    return light;
}

std::vector<double> even_sky_shares(const Mesh& mesh, const Camera& camera, const SeenPoints& seen, int suns,
                                    SkyImportance importance, const Exec& exec) {
    const auto even = sky_directions(sky_grid([](Vec3d) { return Vec3f{1, 1, 1}; }, exec), suns, importance);
    std::vector<double> shares;
    for (const Vec3d& light : irradiance(seen, even, arrivals(mesh, camera, seen, even, exec)))
        shares.push_back(light.y / num::pi);
    return shares;
}

std::vector<Vec3d> sun_and_sky(const Mesh& street, const Camera& camera, const std::vector<double>& xs,
                               const SkyDirection& sun, std::span<const SkyDirection> sky, const Exec& exec) {
    const SeenPoints ground = ground_points(street, xs);
    const std::span<const SkyDirection> one(&sun, 1);
    std::vector<Vec3d> light = irradiance(ground, sky, arrivals(street, camera, ground, sky, exec));
    const auto by_sun = irradiance(ground, one, arrivals(street, camera, ground, one, exec));
    for (std::size_t i = 0; i < light.size(); ++i)
        light[i] = light[i] + by_sun[i];
    return light;
}

Rgb8 exposed(Vec3d radiance) {
    constexpr double exposure = 1.7;
    return linear_to_srgb8(to_float(radiance * exposure));
}

Image<Rgb8> street_picture(const StreetScene& street, const SeenPoints& seen, const std::vector<Vec3d>& light,
                           const std::function<Vec3f(Vec3d)>& sky, int width, int height) {
    const CameraRays rays = camera_rays(street.camera, width, height);
    Image<Rgb8> picture(width, height);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const SeenPixel at = seen_pixel(i, width);
        if (at.x >= width || at.y >= height) continue;
        if (seen.is_covered(i)) {
            const Vec3d paint = albedo[street.mesh.material[seen.triangle[i]]];
            picture(at.x, at.y) = exposed(
                Vec3d{paint.x * light[i].x, paint.y * light[i].y, paint.z * light[i].z} * (1 / num::pi));
        } else {
            const auto along = [&](int k) {
                return rays.dir0[k] + (at.x + 0.5) * rays.dir_x[k] + (at.y + 0.5) * rays.dir_y[k];
            };
            picture(at.x, at.y) = exposed(to_double(sky(normalize(Vec3d{along(0), along(1), along(2)}))));
        }
    }
    return picture;
}

}  // namespace obscura
