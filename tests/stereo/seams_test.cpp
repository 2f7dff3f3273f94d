// Surfaces that are one before they are moved stay one, and solids that touch do not part by themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "scenes/shapes.h"
#include "stereo/eye_mesh.h"
#include "tests/stereo/moved_stage.h"

namespace obscura {
namespace {

using stereo_views::add;
using stereo_views::Stage;

/// Houses in a row, each an object and a closed solid.
Mesh terrace(int houses) {
    Mesh mesh;
    for (int i = 0; i < houses; ++i)
        add(mesh, box({0.5, 1.5, 1}), {0.5 * (i - 0.5 * (houses - 1)), 0, 0});
    return mesh;
}

/// Pixels of an eye, `fine` times as many each way as the picture has, that show a wall between two houses,
/// or nothing where a house is to either side.
int leaks(const Stage& s, const MovedMesh& moved, Eye eye, int fine) {
    const Mesh seen = eye_mesh(moved, eye_positions(moved, s.camera, s.height, s.rig, eye), {Isa::ref, 1});
    Image<std::uint32_t> triangle;
    Image<float> depth;
    stereo_views::rasterize(seen, camera_view(s.camera, fine * s.width, fine * s.height), triangle, depth);
    const auto ends = std::minmax_element(s.mesh.positions.begin(), s.mesh.positions.end(),
                                          [](const Vec3f& a, const Vec3f& b) { return a.x < b.x; });
    const auto between = [&](std::uint32_t t) {
        const auto& v = s.mesh.triangles[moved.source[t]].v;
        const auto x = [&](int k) { return s.mesh.positions[v[k]].x; };
        return x(0) == x(1) && x(1) == x(2) && x(0) > ends.first->x && x(0) < ends.second->x;
    };
    int count = 0;
    for (int y = 0; y < triangle.height; ++y) {
        for (int x = 1; x + 1 < triangle.width; ++x) {
            const std::uint32_t t = triangle(x, y);
            if (t != nothing_seen) {
                count += between(t) ? 1 : 0;
            } else {
                count += triangle(x - 1, y) != nothing_seen && triangle(x + 1, y) != nothing_seen ? 1 : 0;
            }
        }
    }
    return count;
}

TEST(Seams, NothingShowsBetweenSolidsThatTouch) {
    for (const double at : {0.0, 0.1, 1.0}) {
        Stage s;
        s.camera.eye = {at, 1, 6};
        s.mesh = terrace(6);
        Stage unedited = s;
        const MovedMesh still = unedited.moved([](double, double) { return 0.0; });
        const MovedMesh moved =
            s.moved([](double x, double y) { return 5 * std::sin(x / 19) * std::cos(y / 23); });
        EXPECT_GT(s.stats.triangles_out, 500);
        EXPECT_GE(s.stats.within, 0.99);
        for (const Eye eye : {Eye::left, Eye::right}) {
            // Where walls are seen along themselves, corners that snap show a few of 64 samples per pixel.
            const int before = leaks(unedited, still, eye, 8), after = leaks(s, moved, eye, 8);
            std::printf("camera %.1f, %s eye: %d samples unedited, %d edited\n", at,
                        eye == Eye::left ? "left" : "right", before, after);
            EXPECT_LE(before, 4);
            EXPECT_LE(after, 20) << "150 to 260, when each house follows the map alone";
        }
    }
}

TEST(Seams, SolidsThatTouchPartWhereTheMapDoes) {
    Stage s;
    s.camera.eye = {0, 0, 6};
    for (int i = 0; i < 2; ++i)
        add(s.mesh, box({1, 1.5, 1}), {1.0 * i - 0.5, 0, 0});
    const MovedMesh moved = s.moved([&](double x, double) { return x < 160 ? 0.0 : 1.5; });
    for (std::size_t v = 0; v < s.mesh.positions.size(); ++v)
        EXPECT_NEAR(moved.change_px[v], v < s.mesh.positions.size() / 2 ? 0.0f : 1.5f, 0.11f) << v;
}

TEST(Seams, FloorUnderTheCameraStaysOneSurface) {
    // Two triangles that reach far behind the camera, seen from many sides: their diagonal is cut where the
    // near plane crosses it, and once.
    for (int i = 0; i < 24; ++i) {
        Stage s;
        const double turn = 0.27 * i;
        s.camera.eye = {0.3 * i, 2, 0};
        s.camera.look_at = s.camera.eye + Vec3d{std::sin(turn), -0.3, std::cos(turn)};
        add(s.mesh, plane(400, 400, 1, 1), {0, 0, 0});
        const MovedMesh moved =
            s.moved([](double x, double y) { return 4 * std::sin(x / 23) * std::cos(y / 29); });
        EXPECT_GT(s.stats.triangles_out, 100);
        std::map<std::array<float, 3>, float> change;
        int apart = 0, points = 0;
        const auto at = [&](std::uint32_t v) {
            const Vec3f p = moved.mesh.positions[v];
            return std::array{p.x, p.y, p.z};
        };
        for (const Triangle& t : moved.mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                points += at(t.v[k]) == at(t.v[(k + 1) % 3]) ? 1 : 0;
                const auto [first, fresh] = change.emplace(at(t.v[k]), moved.change_px[t.v[k]]);
                apart += first->second != moved.change_px[t.v[k]] ? 1 : 0;
            }
        }
        EXPECT_EQ(points, 0) << "edges without length, camera " << i;
        EXPECT_EQ(apart, 0) << "corners at one place that move apart, camera " << i;
    }
}

}  // namespace
}  // namespace obscura
