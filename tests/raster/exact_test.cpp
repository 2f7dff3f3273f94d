// Shadows of a picture's own samples against brute force that shares nothing with raster/exact but what a
// sample and a mesh are: corners snapped in quadruple precision, coverage in integers of 128 bits, sides of
// planes in quadruple precision from the mesh's own floats.

#include "raster/exact/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "core/topology.h"
#include "raster/camera_rays.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"
#include "raster/view.h"
#include "tests/raster/raster_oracle.h"

namespace obscura {
namespace {

using Quad = __float128;

struct Source {
    std::mt19937 bits;
    explicit Source(unsigned seed) : bits(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits()) / 4294967296.0);
    }
    int below(int n) { return static_cast<int>(bits() % static_cast<unsigned>(n)); }
    Vec3d in(double low, double high) { return {between(low, high), between(low, high), between(low, high)}; }
};

struct Vec3q {
    Quad x, y, z;
};
Vec3q quad(Vec3d v) {
    return {v.x, v.y, v.z};
}
Vec3q operator-(Vec3q a, Vec3q b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Quad dot(Vec3q a, Vec3q b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3q cross(Vec3q a, Vec3q b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Quad square_root(Quad v) {
    Quad r = std::sqrt(static_cast<double>(v));
    for (int k = 0; k < 3; ++k)
        r = r > 0 ? (r + v / r) / 2 : r;
    return r;
}

/// Points on a mesh, in the form that exact shadows ask for.
struct Points {
    std::vector<float> p[3], g[3];
    std::vector<std::uint32_t> face, covered, thin;

    void add(Vec3f at, Vec3f normal, std::uint32_t face_id, bool is_thin) {
        const std::size_t i = face.size();
        for (int k = 0; k < 3; ++k) {
            p[k].push_back(k == 0 ? at.x : k == 1 ? at.y : at.z);
            g[k].push_back(k == 0 ? normal.x : k == 1 ? normal.y : normal.z);
        }
        face.push_back(face_id);
        if (i % 16 == 0) {
            covered.push_back(0);
            thin.push_back(0);
        }
        covered.back() |= 1u << i % 16;
        thin.back() |= is_thin ? 1u << i % 16 : 0u;
    }
    void fill_up() {
        while (face.size() % 16 != 0) {
            for (int k = 0; k < 3; ++k) {
                p[k].push_back(0);
                g[k].push_back(0);
            }
            face.push_back(0);
        }
    }
    ExactPoints view() const {
        return {static_cast<std::int32_t>(face.size()),
                p[0].data(),
                p[1].data(),
                p[2].data(),
                g[0].data(),
                g[1].data(),
                g[2].data(),
                face.data(),
                covered.data(),
                thin.data()};
    }
    int count() const {
        int n = 0;
        for (const std::uint32_t word : covered)
            n += __builtin_popcount(word);
        return n;
    }
};

void add_triangle(Mesh& mesh, Vec3d a, Vec3d b, Vec3d c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& v : {a, b, c})
        mesh.positions.push_back(to_float(v));
    mesh.triangles.push_back({{first, first + 1, first + 2}});
}

void add_quad(Mesh& mesh, Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
}

void add_box(Mesh& mesh, Vec3d low, Vec3d high, bool inside_out = false) {
    const auto at = [&](int k) {
        return Vec3d{(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                     (k & 4) != 0 ? high.z : low.z};
    };
    constexpr int side[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& s : side) {
        if (inside_out) {
            add_quad(mesh, at(s[3]), at(s[2]), at(s[1]), at(s[0]));
        } else {
            add_quad(mesh, at(s[0]), at(s[1]), at(s[2]), at(s[3]));
        }
    }
}

/// Scenes in which strangers' meshes differ from solids apart from one another.
Mesh draw_mesh(Source& source, double unit, Vec3d origin) {
    Mesh mesh;
    const auto place = [&](double x, double y, double z) { return origin + Vec3d{x, y, z} * unit; };
    const auto anywhere = [&] {
        return place(source.between(0, 3), source.between(0, 3), source.between(0, 3));
    };
    switch (source.below(7)) {
        case 0:  // Boxes in the cells of a lattice: faces, edges, corners in common.
            for (int n = 0; n < 8; ++n) {
                const int i = source.below(3), j = source.below(3), k = source.below(3);
                add_box(mesh, place(i, j, k), place(i + 1, j + 1, k + 1), source.below(8) == 0);
            }
            break;
        case 1:  // Boxes in boxes, some inside out.
            for (int n = 0; n < 6; ++n) {
                const double inset = 0.25 * n;
                add_box(mesh, place(inset, inset, inset), place(3 - inset, 3 - inset, 3 - inset),
                        source.below(2) == 0);
            }
            break;
        case 2:  // Sheets twice, back to back or the same way round, and others a hair apart.
            for (int n = 0; n < 10; ++n) {
                const Vec3d a = anywhere(), b = anywhere(), c = anywhere();
                const Vec3d apart = source.below(2) == 0 ? Vec3d{} : source.in(-1e-6, 1e-6) * unit;
                add_triangle(mesh, a, b, c);
                source.below(2) == 0 ? add_triangle(mesh, a + apart, c + apart, b + apart)
                                     : add_triangle(mesh, b + apart, c + apart, a + apart);
            }
            break;
        case 3:  // Slivers and needles.
            for (int n = 0; n < 60; ++n) {
                const Vec3d a = anywhere(), b = anywhere();
                const double t = source.between(-0.2, 1.2);
                add_triangle(
                    mesh, a, b,
                    a + (b - a) * t + source.in(-1, 1) * (unit * std::pow(10, source.between(-6, -1))));
            }
            break;
        case 4: {  // A fan around one corner, its rim up and down.
            const Vec3d tip = anywhere();
            const int rays = 40;
            for (int n = 0; n < rays; ++n) {
                const auto rim = [&](int k) {
                    const double a = 2 * 3.14159265358979 * (k % rays) / rays;
                    return tip + Vec3d{2 * std::cos(a), 0.3 * ((k % rays) % 3 - 1), 2 * std::sin(a)} * unit;
                };
                add_triangle(mesh, tip, rim(n + 1), rim(n));
            }
            add_box(mesh, anywhere(), anywhere());
            break;
        }
        case 5:  // Soup of all sizes.
            for (int n = 0; n < 120; ++n) {
                const Vec3d a = anywhere();
                const double size = unit * std::pow(10, source.between(-3, 0.3));
                add_triangle(mesh, a, a + source.in(-1, 1) * size, a + source.in(-1, 1) * size);
            }
            break;
        default: {  // A field of heights over a floor: concave edges everywhere.
            constexpr int n = 9;
            double height[n][n];
            for (auto& row : height) {
                for (double& h : row)
                    h = source.between(0, 1);
            }
            const auto at = [&](int i, int j) {
                return place(3.0 * i / (n - 1), height[i][j], 3.0 * j / (n - 1));
            };
            for (int i = 0; i + 1 < n; ++i) {
                for (int j = 0; j + 1 < n; ++j)
                    add_quad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
            }
            break;
        }
    }
    analyse_topology(mesh);
    return mesh;
}

Light draw_light(Source& source, const Mesh& mesh, double unit, Vec3d origin) {
    Light light;
    const int kind = source.below(5);
    const Vec3d middle = origin + Vec3d{1.5, 1.5, 1.5} * unit;
    light.near_m = 1e-3 * unit;
    light.range_m = 100 * unit;
    if (kind < 3) {
        light.kind = LightKind::directional;
        light.direction = source.in(-1, 1);
        if (kind == 1) {  // Along an axis: on the planes of faces.
            constexpr Vec3d axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
            light.direction = axes[source.below(6)];
        }
        if (kind == 2) {  // Nearly in some face's plane: down to 0.01 degrees.
            const Plane& plane =
                mesh.faces[static_cast<std::size_t>(source.below(static_cast<int>(mesh.faces.size())))];
            const Vec3d along = normalize(cross(plane.n, source.in(-1, 1)));
            light.direction = along - plane.n * std::pow(10, source.between(-3.76, -1));
        }
        light.direction = normalize(light.direction);
        return light;
    }
    light.kind = kind == 3 ? LightKind::point : LightKind::spot;
    light.position = middle + source.in(-2.5, 2.5) * unit;
    // On the planes of the lattice, or on a corner, or so near that the near plane cuts.
    if (source.below(3) == 0) light.position.y = origin.y + unit * source.below(4);
    if (source.below(4) == 0)
        light.position = to_double(mesh.positions[static_cast<std::size_t>(
                             source.below(static_cast<int>(mesh.positions.size())))]) +
                         source.in(-2e-3, 2e-3) * unit;
    light.direction = normalize(middle + source.in(-0.5, 0.5) * unit - light.position);
    light.outer_cone_deg = source.between(10, 80);
    return light;
}

/// A camera's rays, as far as exact shadows ask: where the eye is, and how large a pixel.
CameraRays rays_from(Vec3d eye, double pixel) {
    CameraRays rays{};
    rays.perspective = true;
    rays.eye[0] = eye.x;
    rays.eye[1] = eye.y;
    rays.eye[2] = eye.z;
    rays.dir_x[0] = rays.dir_y[1] = pixel;
    return rays;
}

Points draw_points(Source& source, const Mesh& mesh, Vec3d eye, int count) {
    Points points;
    for (int i = 0; i < count; ++i) {
        const auto t = static_cast<std::size_t>(source.below(static_cast<int>(mesh.triangles.size())));
        const Triangle& tri = mesh.triangles[t];
        const Vec3d a = to_double(mesh.positions[tri.v[0]]), b = to_double(mesh.positions[tri.v[1]]),
                    c = to_double(mesh.positions[tri.v[2]]);
        double u = source.between(0, 1), v = source.between(0, 1);
        if (source.below(4) == 0) u = source.below(2);  // on an edge, or a corner
        if (source.below(4) == 0) v = source.below(2);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Vec3f p = to_float(a + (b - a) * u + (c - a) * v - eye);
        Vec3f n = to_float(mesh.faces[mesh.face[t]].n);
        if (dot(n, p) > 0) n = -n;
        points.add(p, n, mesh.face[t], source.below(8) == 0);
    }
    points.fill_up();
    return points;
}

/// The definition at the top of raster/exact/exact.h, told once more.
class BruteForce {
  public:
    BruteForce(const Mesh& mesh, const Light& light, const std::vector<Casters>& casters)
        : mesh_(mesh), light_(light), casters_(casters), snapped_(casters.size()) {
        for (std::size_t v = 0; v < casters.size(); ++v) {
            for (const Triangle& tri : mesh.triangles) {
                Snapped& s = snapped_[v].emplace_back();
                for (int k = 0; k < 3; ++k)
                    s.corners += snap(casters[v].view, mesh.positions[tri.v[k]], s.x[k], s.y[k], s.z_low);
            }
        }
    }

    /// 1 lit, 0 dark, -1 closer to the limit than quadruple precision of the planes' doubles can tell.
    int lit(Vec3d p, const ref::ExactShadow& s, std::uint32_t face) const {
        const View& view = casters_[static_cast<std::size_t>(s.view)].view;
        bool unsure = false;
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (mesh_.face[t] == face) continue;
            const Snapped& on_grid = snapped_[static_cast<std::size_t>(s.view)][t];
            const bool whole = on_grid.corners == 3;
            const int covered =
                whole ? oracle::covers(on_grid.x, on_grid.y, s.x, s.y) : meets_clipped(view, t, p);
            unsure |= covered < 0;
            if (covered <= 0) continue;
            const int side = behind(t, p, static_cast<double>(s.uncertain_m));
            if (side < 0) unsure = true;
            if (side <= 0) continue;
            // Nearer to the light than the triangle's nearest corner: only where its plane is extrapolated.
            const Quad deeper = depth_of(view, p) - (on_grid.z_low - Quad(0x1p-22));
            if (!whole || deeper > 0x1p-23) return 0;
            unsure |= deeper > -0x1p-23;
        }
        return unsure ? -1 : 1;
    }

  private:
    /// A triangle on the grid of one view, as far as its corners need no clipping, and its nearest corner.
    struct Snapped {
        std::int32_t x[3] = {}, y[3] = {};
        int corners = 0;
        Quad z_low = 2;
    };
    /// Whether the light's ray through p meets a triangle that must be clipped, beyond the near plane: 1 yes,
    /// 0 no, -1 near an edge, whose cut corners are the clipper's to snap.
    int meets_clipped(const View& view, std::size_t t, Vec3d p) const {
        const Triangle& tri = mesh_.triangles[t];
        Vec3q corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = quad(to_double(mesh_.positions[tri.v[k]]));
        const Vec3q way = is_parallel(light_.kind) ? quad(light_.direction) : quad(p) - quad(light_.position);
        Quad volume[3], sum = 0;
        for (int k = 0; k < 3; ++k) {
            volume[k] = dot(way, cross(corner[(k + 1) % 3] - quad(p), corner[(k + 2) % 3] - quad(p)));
            sum += volume[k];
        }
        if (sum == 0) return -1;
        bool inside = true, clear = true;
        Quad w = 0;
        for (int k = 0; k < 3; ++k) {
            const Quad share = volume[k] / sum;
            inside = inside && share > 0;
            if (share < -1e-5) return 0;
            clear = clear && share > 1e-5;
            const Vec3f at = mesh_.positions[tri.v[k]];
            w += share * (view.perspective ? row(matrix_row(view, 3), to_double(at)) : Quad(1));
        }
        if (!clear) return -1;
        const Quad beyond = view.perspective ? w / view.near_w - 1 : Quad(1);
        if (beyond < -1e-6) return 0;
        return beyond > 1e-6 ? 1 : -1;
    }
    static Quad row(const Vec4d& m, Vec3d p) {
        return Quad(m.x) * p.x + Quad(m.y) * p.y + Quad(m.z) * p.z + Quad(m.w);
    }
    static Vec4d matrix_row(const View& view, int r) {
        const auto& m = view.to_map.m[r];
        return {m[0], m[1], m[2], m[3]};
    }
    static Quad depth_of(const View& view, Vec3d p) {
        const Quad w = view.perspective ? row(matrix_row(view, 3), p) : Quad(1);
        return row(matrix_row(view, 2), p) / w;
    }
    /// False when the corner must be clipped.
    static bool snap(const View& view, Vec3f corner, std::int32_t& x, std::int32_t& y, Quad& z_low) {
        const Vec3d p = to_double(corner);
        const Quad w = view.perspective ? row(matrix_row(view, 3), p) : Quad(1);
        if (view.perspective && w < Quad(view.near_w) * 1.000001) return false;
        const Quad X = row(matrix_row(view, 0), p) / w * 256, Y = row(matrix_row(view, 1), p) / w * 256;
        const Quad limit = Quad(1 << 20) * 256;
        if (X < -limit || Y < -limit || X > 2 * limit || Y > 2 * limit) return false;
        x = static_cast<std::int32_t>(std::nearbyint(static_cast<double>(X)));
        y = static_cast<std::int32_t>(std::nearbyint(static_cast<double>(Y)));
        z_low = std::min(z_low, row(matrix_row(view, 2), p) / w);
        return true;
    }
    /// Whether p lies behind the triangle's plane, seen from the light, by more than `uncertain`: 1 yes, 0
    /// no, -1 too close to tell.
    int behind(std::size_t t, Vec3d p, double uncertain) const {
        const Triangle& tri = mesh_.triangles[t];
        const Vec3q a = quad(to_double(mesh_.positions[tri.v[0]])),
                    b = quad(to_double(mesh_.positions[tri.v[1]])),
                    c = quad(to_double(mesh_.positions[tri.v[2]]));
        const Vec3q n = cross(b - a, c - a);
        const Quad length = square_root(dot(n, n));
        if (length == 0) return -1;
        const Quad height = dot(n, quad(p) - a) / length;
        const Vec3q way = is_parallel(light_.kind) ? quad(-light_.direction) : quad(light_.position) - a;
        const Quad towards = dot(n, way) / length;
        // Triangles that the light sees edge on, and planes of slivers, are rounding alone.
        const Quad longest = square_root(std::max({dot(b - a, b - a), dot(c - a, c - a), dot(c - b, c - b)}));
        const Quad least_height = length / longest;
        // Triangles of one planar face have one plane, which passes by their corners (core/planar_faces.h).
        const Plane& plane = mesh_.faces[mesh_.face[t]];
        Quad off = 0;
        for (const std::uint32_t v : tri.v)
            off = std::max<Quad>(off, std::fabs(dot(plane.n, to_double(mesh_.positions[v])) + plane.d));
        const Quad doubt =
            2 * off + 1e-12 * (1 + std::fabs(static_cast<double>(a.x)) + longest) / (least_height / longest);
        const Quad signed_height = towards > 0 ? height : -height;
        const Quad over = signed_height + uncertain;
        if ((towards < 0 ? -towards : towards) <= doubt) return -1;
        if ((over < 0 ? -over : over) <= doubt) return -1;
        return over < 0 ? 1 : 0;
    }

    const Mesh& mesh_;
    const Light& light_;
    const std::vector<Casters>& casters_;
    std::vector<std::vector<Snapped>> snapped_;
};

struct Outcome {
    std::int64_t points = 0, lit = 0, dark = 0, unsure = 0;
};

void compare(unsigned seed, int count, Outcome& sum) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Source source(seed);
    const bool far_off = source.below(6) == 0;
    // Far off the floats of a mesh are 1/16 m apart; nothing else changes.
    const double unit = far_off ? 64 : std::pow(10, source.between(-2, 3));
    const Vec3d origin = far_off ? Vec3d{1e6, 2e6, -1e6} : source.in(-3, 3) * unit;
    const Mesh mesh = draw_mesh(source, unit, origin);
    const Light light = draw_light(source, mesh, unit, origin);
    const Vec3d eye = origin + source.in(-4, 7) * unit;
    TriangleSetup scratch;
    const Exec exec;
    const auto casters = build_casters(mesh, light, exec, scratch);
    const CameraRays rays = rays_from(eye, std::pow(10, source.between(-4, -2)));
    const ExactLight exact = exact_light(light, casters, rays);
    const Points drawn = draw_points(source, mesh, eye, count);
    const ExactPoints points = drawn.view();

    // Kernels and ref agree, whatever the isa.
    std::vector<std::uint32_t> lit(drawn.covered.size());
    ExactWork work(drawn.face.size());
    ExactCounts counts;
    work.shadows(points, exact, Isa::ref, lit.data(), counts);
    std::optional<ExactCounts> of_kernels;
    for (const Isa isa : supported_isas()) {
        std::vector<std::uint32_t> other(lit.size());
        ExactCounts work_done;
        work.shadows(points, exact, isa, other.data(), work_done);
        ASSERT_EQ(other, lit) << isa_name(isa);
        EXPECT_EQ(work_done.samples, counts.samples);
        if (isa == Isa::ref) continue;
        if (!of_kernels) of_kernels = work_done;
        EXPECT_EQ(work_done.groups, of_kernels->groups) << isa_name(isa);
        EXPECT_EQ(work_done.triangles, of_kernels->triangles) << isa_name(isa);
    }

    const BruteForce brute(mesh, light, casters);
    for (int i = 0; i < drawn.count(); ++i) {
        const ref::ExactShadow s = ref::exact_shadow(points, exact, i);
        const bool is_lit = (lit[static_cast<std::size_t>(i) / 16] >> (i % 16) & 1u) != 0;
        ASSERT_EQ(is_lit, s.asks && s.lit) << "point " << i;
        if (!s.asks) continue;
        const auto at = static_cast<std::size_t>(i);
        const Vec3d p = eye + to_double(Vec3f{drawn.p[0][at], drawn.p[1][at], drawn.p[2][at]});
        ++sum.points;
        if (is_lit && !s.on_map) {
            ++sum.lit;
            continue;
        }
        const int truth = brute.lit(p, s, drawn.face[at]);
        if (truth < 0) {
            ++sum.unsure;
            continue;
        }
        ++(truth == 1 ? sum.lit : sum.dark);
        ASSERT_EQ(is_lit, truth == 1)
            << "point " << i << " at " << p.x << ' ' << p.y << ' ' << p.z << ", grid " << s.x << ' ' << s.y;
    }
}

TEST(ExactShadows, AreThoseOfBruteForceOnDrawnScenes) {
    Outcome sum;
    // OBSCURA_SLOW_TESTS=45000 draws ten million points, in two minutes.
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    const unsigned scenes = slow != nullptr ? static_cast<unsigned>(std::max(3000, std::atoi(slow))) : 120;
    for (unsigned seed = 0; seed < scenes && !testing::Test::HasFatalFailure(); ++seed)
        compare(seed, 400, sum);
    EXPECT_GT(sum.lit, sum.points / 4);
    EXPECT_GT(sum.dark, sum.points / 4);
    EXPECT_LT(sum.unsure, sum.points / 20);
    RecordProperty("points", std::to_string(sum.points));
    RecordProperty("unsure", std::to_string(sum.unsure));
}

}  // namespace
}  // namespace obscura
