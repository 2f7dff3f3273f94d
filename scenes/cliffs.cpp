// A rocky coast: a profile from the seabed over beach, face and ledge to the plateau, carried along a
// meandering shore and roughened by noise. Not a height field: rows lie as dense on the face as on the level.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "scenes/generators.h"
#include "scenes/noise.h"

namespace obscura {
namespace {

/// Where the coast is when nothing disturbs it: inland and up in heights of the cliff, the share of the rows
/// below, and how rough it is.
struct Station {
    double inland, up, row, rough;
};
constexpr std::array<Station, 10> profile{{{-1.6, -0.25, 0.00, 0.0},
                                           {-0.15, -0.01, 0.05, 0.1},
                                           {0.06, 0.03, 0.11, 0.2},
                                           {0.20, 0.15, 0.19, 0.7},
                                           {0.34, 0.50, 0.42, 1.0},
                                           {0.48, 0.54, 0.48, 0.9},
                                           {0.58, 0.92, 0.74, 1.0},
                                           {0.70, 1.00, 0.82, 0.5},
                                           {1.30, 1.03, 0.90, 0.12},
                                           {4.00, 1.05, 1.00, 0.0}}};

/// `ledge`: how much of the ledge there is, in [0, 1].
Station station_at(double row, double ledge) {
    std::size_t i = 1;
    while (i + 1 < profile.size() && row > profile[i].row)
        ++i;
    const Station &a = profile[i - 1], &b = profile[i];
    const double t = (row - a.row) / (b.row - a.row);
    const auto mix = [t](double p, double q) { return p + (q - p) * t; };
    Station s{mix(a.inland, b.inland), mix(a.up, b.up), row, mix(a.rough, b.rough)};
    // Where the ledge ends, what lies above moves forward, and the face runs on.
    constexpr double begin = 0.42, end = 0.48, width = 0.12;
    s.inland -= (1 - ledge) * width * std::clamp((row - begin) / (end - begin), 0.0, 1.0);
    return s;
}

/// Points of the coast, row by row from the sea inland; x rises within a row.
struct Grid {
    int columns = 0, rows = 0;  ///< of points
    std::vector<Vec3d> points;
    const Vec3d& at(int i, int j) const {
        return points[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(i)];
    }
};

Grid coast_of(const CliffsParams& p) {
    const double h = p.height_m;
    const std::int64_t seed = p.seed;  // sums may pass the largest int
    Grid grid{p.columns + 1, p.rows + 1, {}};
    for (int j = 0; j <= p.rows; ++j) {
        for (int i = 0; i <= p.columns; ++i) {
            const double x = p.width_m * (static_cast<double>(i) / p.columns - 0.5);
            const double ledge =
                std::clamp(0.3 + 1.4 * value_noise({x / (0.8 * h), 1.5, 2.5}, seed + 5), 0.0, 1.0);
            Station s = station_at(static_cast<double>(j) / p.rows, ledge);
            // The ledge, and all between shore and rim with it, lies higher or lower along the coast.
            const double middle = std::clamp(4 * s.up * (1 - s.up), 0.0, 1.0);
            s.up += 0.16 * middle * value_noise({x / (0.9 * h), 4.5, 1.5}, seed + 6);
            // Bays and headlands, then buttresses, which reach all the way up the face.
            const double shore = p.meander_m * fractal_noise({x / (1.7 * h), 0.5, 0}, 2, seed);
            const double buttress = 0.16 * h * value_noise({x / (0.45 * h), s.up * 0.7, 3.5}, seed + 10) +
                                    0.07 * h * value_noise({x / (0.17 * h), s.up * 1.5, 7.5}, seed + 11);
            const Vec3d q{x / (0.22 * h), s.up * 4.5, s.inland * 2};
            const double crag = 0.085 * h * fractal_noise(q, 5, seed + 20);
            // Layers of harder rock stand out.
            const double layer = 0.03 * h * value_noise({x / (2 * h), s.up * 13, 0.5}, seed + 30);
            const double push = s.rough * (p.roughness * (crag + layer) + buttress);
            const double lift = (0.25 * s.rough + 0.06) * 0.12 * h *
                                fractal_noise({x / (0.5 * h), s.inland * 1.6, 9.5}, 4, seed + 40) *
                                std::min(1.0, std::max(0.0, s.up * 5));
            grid.points.push_back({x, s.up * h + lift, shore - s.inland * h + push});
        }
    }
    return grid;
}

/// What the ground is made of at q with the smooth normal n.
std::uint32_t slot_at(Vec3d q, Vec3d n, const CliffsParams& p) {
    const std::int64_t seed = p.seed;
    const double up = q.y / p.height_m, chance = fractal_noise(q * (7 / p.height_m), 3, seed + 50);
    if (n.y > 0.62 + 0.05 * chance && up < 0.06 + 0.012 * chance) return 3;
    if (n.y > 0.80 + 0.07 * chance && up > 0.3) return 2;
    const double band = value_noise({q.x * 0.4 / p.height_m, up * 9 + 0.3 * chance, 0.5}, seed + 60);
    return up > 0.15 + 0.04 * chance && band > 0.12 ? 1 : 0;
}

/// Triangles facing up and out, their vertices shared.
void add_surface(Mesh& mesh, const Grid& g, const CliffsParams& p) {
    const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * g.columns + i); };
    std::vector<Vec3d> normals(g.points.size());
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vec3d area = cross(g.points[b] - g.points[a], g.points[c] - g.points[a]);
        for (const std::uint32_t v : {a, b, c})
            normals[v] = normals[v] + area;
        mesh.triangles.push_back({{a, b, c}});
        mesh.object.push_back(0);
    };
    for (int j = 0; j + 1 < g.rows; ++j) {
        for (int i = 0; i + 1 < g.columns; ++i) {
            add(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            add(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    }
    for (std::size_t v = 0; v < g.points.size(); ++v) {
        const Vec3d q = g.points[v];
        normals[v] = normalize(normals[v]);
        mesh.positions.push_back(stored(q));
        mesh.normals.push_back(to_float(normals[v]));
        // A cliff has no good unfolding; u along the shore, v up and inland.
        mesh.uvs.push_back({static_cast<float>(q.x), static_cast<float>(q.y - q.z)});
    }
    for (const Triangle& t : mesh.triangles) {
        const Vec3d q = (g.points[t.v[0]] + g.points[t.v[1]] + g.points[t.v[2]]) * (1.0 / 3);
        mesh.material.push_back(
            slot_at(q, normalize(normals[t.v[0]] + normals[t.v[1]] + normals[t.v[2]]), p));
    }
}

/// Sides and bottom: a flat foot below every point of the rim, and a fan over them.
void add_foot(Mesh& mesh, const Grid& g, double low) {
    std::vector<Vec3d> rim;
    for (int i = 0; i + 1 < g.columns; ++i)
        rim.push_back(g.at(i, 0));
    for (int j = 0; j + 1 < g.rows; ++j)
        rim.push_back(g.at(g.columns - 1, j));
    for (int i = g.columns - 1; i > 0; --i)
        rim.push_back(g.at(i, g.rows - 1));
    for (int j = g.rows - 1; j > 0; --j)
        rim.push_back(g.at(0, j));
    // On the foot the sides are straight, so that the fan around its middle turns one way.
    const auto count = rim.size();
    const auto sides = static_cast<std::size_t>(g.rows - 1), ends = static_cast<std::size_t>(g.columns - 1);
    std::vector<Vec3d> foot = rim;
    const double front = g.at(0, 0).z, back = g.at(0, g.rows - 1).z;
    const double front_right = g.at(g.columns - 1, 0).z, back_right = g.at(g.columns - 1, g.rows - 1).z;
    for (std::size_t j = 0; j < sides; ++j) {
        const double t = static_cast<double>(j) / static_cast<double>(sides);
        foot[ends + j].z = front_right + (back_right - front_right) * t;
        foot[2 * ends + sides + j].z = back + (front - back) * t;
    }
    Vec3d middle{0, low, 0};
    for (Vec3d& q : foot) {
        q.y = low;
        middle.z += q.z / static_cast<double>(count);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = (i + 1) % count;
        add_facet(mesh, {rim[k], rim[i], foot[i]});
        add_facet(mesh, {rim[k], foot[i], foot[k]});
        add_facet(mesh, {middle, foot[k], foot[i]});
    }
}

}  // namespace

GeneratedModel cliffs(const CliffsParams& p) {
    CHECK(p.columns >= 2 && p.rows >= 2 && p.height_m > 0 && p.width_m > 0);
    GeneratedModel model;
    model.materials = {material_slot("rock", 142, 129, 113, 0.95f),
                       material_slot("layer", 113, 98, 86, 0.95f), material_slot("grass", 86, 106, 52, 1.0f),
                       material_slot("sand", 188, 172, 140, 1.0f)};
    const Grid grid = coast_of(p);
    add_surface(model.mesh, grid, p);
    double low = 0;
    for (const Vec3d& q : grid.points)
        low = std::min(low, q.y);
    add_foot(model.mesh, grid, low - 0.2 * p.height_m);
    return model;
}

}  // namespace obscura
