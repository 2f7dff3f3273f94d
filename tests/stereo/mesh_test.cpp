// Vertices follow the map: what they gather, what hidden ones do instead, and where eyes see them.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "scenes/shapes.h"
#include "stereo/eye_mesh.h"
#include "stereo/moved_mesh.h"
#include "tests/stereo/views.h"

namespace obscura {
namespace {

using stereo_views::add;
using stereo_views::wall;

struct Stage {
    Mesh mesh;
    Camera camera;
    StereoRig rig{0.065, 4.0, 0.6, 0.7, 0.063};
    int width = 160, height = 120, margin = 8;
    MiddleView view;
    DisparityMap optimised;
    ReprojectParams params;
    ReprojectStats stats;

    Stage() {
        camera.eye = {0, 0, 5};
        camera.look_at = {0, 0, 0};
        camera.near_m = 0.1;
    }
    void look() {
        view = stereo_views::middle_view(mesh, camera, width, height, margin, rig);
        optimised = view.disparity;
    }
    /// Adds change(column, row) wherever something is seen.
    void edit(const std::function<double(double, double)>& change) {
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                if (view.triangle(x, y) != nothing_seen)
                    optimised(x, y) += static_cast<float>(change(x + 0.5, y + 0.5));
            }
        }
    }
    MovedMesh moved(const Exec& exec = {Isa::ref, 1}) {
        return moved_mesh(mesh, camera, view, optimised, params, exec, stats);
    }
};

Stage ball_before_wall(int wall_quads) {
    Stage s;
    add(s.mesh, wall(12, 9, wall_quads, wall_quads), {0, 0, -3});
    add(s.mesh, sphere(0.8, 24, 16), {0, 0, 1});
    s.look();
    return s;
}

/// Where a world point lies in the picture of an eye that stands beside the camera and looks parallel, its
/// frustum shifted so that the screen plane stays.
Vec2d off_axis(const Stage& s, Vec3d p, Eye eye) {
    Camera camera = s.camera;
    const double side = eye == Eye::left ? -0.5 : 0.5;
    const Basis basis = look_basis(camera.look_at - camera.eye, camera.up);
    camera.eye = camera.eye + basis.right * (side * s.rig.interaxial_m);
    camera.look_at = camera.look_at + basis.right * (side * s.rig.interaxial_m);
    const Vec3d q = to_map_space(camera_view(camera, s.width, s.height), p);
    const DisparityLaw law = disparity_law(s.rig, camera, s.height);
    return {q.x + side * law.offset, q.y};
}

TEST(MovedMesh, WithoutChangeIsTheMeshAndEyesSeeItOffAxis) {
    Stage s = ball_before_wall(3);
    // A floor that runs under and behind the camera.
    add(s.mesh, wall(30, 20, 1, 1), {0, 0, 0});
    for (std::size_t v = s.mesh.positions.size() - 4; v < s.mesh.positions.size(); ++v) {
        Vec3f& p = s.mesh.positions[v];
        p = {p.x, -2, -p.y};
    }
    analyse_topology(s.mesh);
    s.look();
    const MovedMesh moved = s.moved();
    EXPECT_EQ(moved.mesh.triangles, s.mesh.triangles);
    EXPECT_EQ(s.stats.triangles_out, s.stats.triangles_in);
    EXPECT_EQ(s.stats.within, 1.0);
    for (const float c : moved.change_px)
        EXPECT_EQ(c, 0.0f);
    const View middle = camera_view(s.camera, s.width, s.height);
    for (const Eye eye : {Eye::left, Eye::right}) {
        const std::vector<Vec3f> positions = eye_positions(moved, s.camera, s.height, s.rig, eye);
        for (std::size_t v = 0; v < positions.size(); ++v) {
            const Vec3d p = to_double(s.mesh.positions[v]);
            if (s.camera.eye.z - p.z < s.camera.near_m) {
                // Behind the camera the same affine map goes on.
                const double half = eye == Eye::left ? 0.5 : -0.5, z = s.camera.eye.z - p.z;
                EXPECT_NEAR(static_cast<double>(positions[v].x),
                            p.x + half * s.rig.interaxial_m * (1 - z / s.rig.zero_parallax_m), 1e-5);
                continue;
            }
            const Vec3d seen = to_map_space(middle, to_double(positions[v]));
            const Vec2d wanted = off_axis(s, p, eye);
            EXPECT_NEAR(seen.x, wanted.x, 2e-4);
            EXPECT_NEAR(seen.y, wanted.y, 2e-4);
        }
    }
}

TEST(MovedMesh, EyesAreAChangeFurtherApart) {
    Stage s = ball_before_wall(3);
    s.edit([](double, double) { return 3.5; });
    const MovedMesh moved = s.moved();
    const View middle = camera_view(s.camera, s.width, s.height);
    const auto left = eye_positions(moved, s.camera, s.height, s.rig, Eye::left);
    const auto right = eye_positions(moved, s.camera, s.height, s.rig, Eye::right);
    const DisparityLaw law = disparity_law(s.rig, s.camera, s.height);
    for (std::size_t v = 0; v < left.size(); ++v) {
        const Vec3d l = to_map_space(middle, to_double(left[v])),
                    r = to_map_space(middle, to_double(right[v]));
        const double z = s.camera.eye.z - static_cast<double>(moved.mesh.positions[v].z);
        EXPECT_NEAR(l.x - r.x, law.scale / z - law.offset + 3.5, 1e-3);
        EXPECT_NEAR(l.y, r.y, 1e-4);
    }
}

TEST(MovedMesh, ChangesGoOnLinearlyBehindTheCamera) {
    // A triangle that reaches there is drawn up to the near plane: between its corners nothing may bend.
    Stage s = ball_before_wall(3);
    MovedMesh moved;
    moved.mesh.positions = {{0.5f, -2, 2}, {0.5f, -2, 5}, {0.5f, -2, 8}};  // before, beside, behind the eye
    moved.change_px = {3.5f, 3.5f, 3.5f};
    for (const Eye eye : {Eye::left, Eye::right}) {
        const std::vector<Vec3f> seen = eye_positions(moved, s.camera, s.height, s.rig, eye);
        EXPECT_NE(seen[0].x, seen[1].x);
        EXPECT_NEAR(static_cast<double>(seen[2].x - seen[1].x), static_cast<double>(seen[1].x - seen[0].x),
                    1e-6);
    }
}

TEST(MovedMesh, CopiesOfAVertexGetTheSameBits) {
    Stage s;
    Mesh ball = sphere(1.2, 20, 12);
    // Every triangle its own vertices and normals.
    Mesh split;
    for (const Triangle& t : ball.triangles) {
        const auto v = static_cast<std::uint32_t>(split.positions.size());
        for (const std::uint32_t k : t.v) {
            split.positions.push_back(ball.positions[k]);
            split.normals.push_back(
                normalize(ball.normals[k] + Vec3f{0.1f * static_cast<float>(v % 7), 0, 0}));
        }
        split.triangles.push_back({{v, v + 1, v + 2}});
    }
    add(s.mesh, split, {0, 0, 0});
    add(s.mesh, wall(12, 9, 2, 2), {0, 0, -3});
    s.look();
    s.edit([](double x, double y) { return 0.0008 * ((x - 70) * (x - 70) + 0.7 * (y - 50) * (y - 50)); });
    const MovedMesh moved = s.moved();
    EXPECT_GT(moved.mesh.triangles.size(), s.mesh.triangles.size());
    std::map<std::array<float, 3>, float> change;
    std::int64_t copies = 0;
    for (std::size_t t = 0; t < moved.mesh.triangles.size(); ++t) {
        if (moved.mesh.object[t] != 0) continue;
        for (const std::uint32_t v : moved.mesh.triangles[t].v) {
            const Vec3f p = moved.mesh.positions[v];
            const auto [at, fresh] = change.emplace(std::array{p.x, p.y, p.z}, moved.change_px[v]);
            EXPECT_EQ(at->second, moved.change_px[v]);
            copies += fresh ? 0 : 1;
        }
    }
    EXPECT_GT(copies, 1000);
}

TEST(MovedMesh, SeamOfTwoObjectsOfOneSurfaceStaysShut) {
    // Floor and wall as objects of their own that meet in an open edge, and hang together.
    Stage s;
    Mesh part = wall(8, 4, 1, 1);
    Mesh floor = wall(8, 4, 1, 1);
    for (Vec3f& p : floor.positions)
        p = {p.x, -2, p.y + 2};
    for (Triangle& t : floor.triangles)
        std::swap(t.v[1], t.v[2]);
    append_mesh(part, floor);
    part.object = {0, 0, 1, 1};
    part.objects = {{"wall", true}, {"floor", true}};
    part.material.assign(4, 0);
    analyse_topology(part);
    s.mesh = part;
    s.look();
    s.edit([](double x, double y) { return 0.002 * (x - 60) * (x - 60) - 0.01 * y; });
    const MovedMesh moved = s.moved();
    // Along the seam y = -2, z = 0 both have the same vertices with the same changes.
    std::array<std::map<float, float>, 2> seam;
    for (std::size_t t = 0; t < moved.mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : moved.mesh.triangles[t].v) {
            const Vec3f p = moved.mesh.positions[v];
            if (p.y == -2 && p.z == 0) seam[moved.mesh.object[t]].emplace(p.x, moved.change_px[v]);
        }
    }
    EXPECT_GT(seam[0].size(), 4u);
    EXPECT_EQ(seam[0], seam[1]);
}

TEST(MovedMesh, NeighboursOfOtherObjectsDoNotCount) {
    // Two panels side by side on one plane, edited apart: no border is blurred.
    Stage s;
    add(s.mesh, wall(3.998, 5, 6, 6), {-2, 0, 0});
    add(s.mesh, wall(3.998, 5, 6, 6), {2, 0, 0});
    s.look();
    s.edit([](double x, double) { return x < 88 ? -1.0 : 5.0; });
    const MovedMesh moved = s.moved();
    EXPECT_EQ(s.stats.triangles_out, s.stats.triangles_in);
    for (std::size_t v = 0; v < moved.change_px.size(); ++v)
        EXPECT_NEAR(static_cast<double>(moved.change_px[v]), moved.mesh.positions[v].x < 0 ? -1.0 : 5.0,
                    1e-5);
}

TEST(MovedMesh, FartherPartsOfTheSameObjectDoNotCount) {
    // One object of two panels, one before the other, edited apart: arms before a body.
    Stage s;
    add(s.mesh, wall(2, 2, 20, 20), {0, 0, 1});
    add(s.mesh, wall(8, 6, 80, 60), {0, 0, 0}, false);
    s.look();
    ASSERT_EQ(s.mesh.objects.size(), 1u);
    s.optimised = s.view.disparity;
    for (std::size_t i = 0; i < s.optimised.pixels.size(); ++i)
        s.optimised.pixels[i] += s.view.depth_m.pixels[i] < 4.5f ? 6.0f : -2.0f;
    const MovedMesh moved = s.moved();
    EXPECT_EQ(s.stats.triangles_out, s.stats.triangles_in);
    for (std::size_t v = 0; v < moved.change_px.size(); ++v) {
        EXPECT_NEAR(static_cast<double>(moved.change_px[v]), moved.mesh.positions[v].z > 0.5f ? 6.0 : -2.0,
                    1e-4);
    }
}

TEST(MovedMesh, HiddenWallFollowsTheWallNotWhatHidesIt) {
    Stage s = ball_before_wall(40);
    // The ball comes out by 6 px, the wall leans.
    for (int y = 0; y < s.view.height(); ++y) {
        for (int x = 0; x < s.view.width(); ++x)
            s.optimised(x, y) += s.view.object(x, y) == 1 ? 6.0f : static_cast<float>(0.02 * x);
    }
    const MovedMesh moved = s.moved();
    const View map = camera_view(s.camera, s.view.width(), s.height);
    int hidden = 0;
    for (std::size_t v = 0; v < 41 * 41; ++v) {
        const Vec3d p = to_map_space(map, to_double(moved.mesh.positions[v]));
        const bool inside = p.x > 0 && p.y > 0 && p.x < s.view.width() && p.y < s.view.height();
        if (inside && s.view.object(static_cast<int>(p.x), static_cast<int>(p.y)) == 1) {
            ++hidden;
            EXPECT_NEAR(static_cast<double>(moved.change_px[v]), 0.02 * p.x, 0.15);
        } else if (inside) {
            EXPECT_NEAR(static_cast<double>(moved.change_px[v]), 0.02 * p.x, 0.03);
        } else {
            // Off the screen: no further than the wall's range reaches, by as much again.
            EXPECT_GT(moved.change_px[v], -0.02 * s.view.width());
            EXPECT_LT(moved.change_px[v], 0.04 * s.view.width());
        }
    }
    EXPECT_GT(hidden, 50);
    // The ball, its back included, is all 6 px nearer.
    for (std::size_t t = 0; t < moved.mesh.triangles.size(); ++t) {
        if (moved.mesh.object[t] != 1) continue;
        for (const std::uint32_t v : moved.mesh.triangles[t].v)
            EXPECT_NEAR(static_cast<double>(moved.change_px[v]), 6.0, 1e-4);
    }
}

TEST(MovedMesh, UnseenPartsMoveWhole) {
    Stage s = ball_before_wall(8);
    add(s.mesh, sphere(0.2, 12, 8), {0, 0, -1});         // an object behind the ball
    add(s.mesh, sphere(0.2, 12, 8), {0, 0, -2}, false);  // its other part, hidden, too
    add(s.mesh, sphere(0.2, 12, 8), {0, 0, 9});          // behind the camera
    s.look();
    s.edit([](double x, double) { return 0.05 * x; });
    const MovedMesh moved = s.moved();
    const auto range = [&](std::uint32_t component) {
        std::pair<float, float> r{1e9f, -1e9f};
        for (std::size_t t = 0; t < moved.mesh.triangles.size(); ++t) {
            if (moved.mesh.component[t] != component) continue;
            for (const std::uint32_t v : moved.mesh.triangles[t].v)
                r = {std::min(r.first, moved.change_px[v]), std::max(r.second, moved.change_px[v])};
        }
        return r;
    };
    for (const std::uint32_t c : {2u, 3u}) {
        EXPECT_EQ(range(c).first, range(c).second);
        EXPECT_NEAR(static_cast<double>(range(c).first), 0.05 * 88, 0.3);
    }
    EXPECT_EQ(range(4).first, range(4).second);
    EXPECT_GE(range(4).first, 0.0f);
    EXPECT_LE(range(4).second, 0.05f * 176);
}

TEST(MovedMesh, SameForAnyThreads) {
    Stage s = ball_before_wall(20);
    s.edit([](double x, double y) { return 2 * std::sin(0.07 * x) * std::cos(0.05 * y); });
    const MovedMesh one = s.moved({Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        const MovedMesh two = s.moved({isa, 2});
        EXPECT_EQ(one.mesh.triangles, two.mesh.triangles);
        EXPECT_EQ(one.mesh.positions, two.mesh.positions);
        EXPECT_EQ(one.change_px, two.change_px);
    }
}

TEST(EyeMesh, RasterizesWithoutHolesAndWithoutTrouble) {
    Stage s = ball_before_wall(2);
    s.edit([](double x, double y) { return 3 * std::sin(0.05 * x) + 2 * std::cos(0.04 * y); });
    MovedMesh moved = s.moved();
    // A triangle without area and one that repeats a corner must pass.
    for (const Triangle t : {Triangle{{0, 0, 1}}, Triangle{{0, 1, 1}}}) {
        moved.mesh.triangles.push_back(t);
        moved.mesh.component.push_back(0);
        moved.mesh.object.push_back(0);
        moved.mesh.material.push_back(0);
    }
    for (const Eye eye : {Eye::left, Eye::right}) {
        const Mesh mesh =
            eye_mesh(moved, eye_positions(moved, s.camera, s.height, s.rig, eye), {Isa::ref, 1});
        Image<std::uint32_t> triangle;
        Image<float> depth;
        stereo_views::rasterize(mesh, camera_view(s.camera, s.width, s.height), triangle, depth);
        for (int y = 0; y < s.height; ++y) {
            for (int x = 0; x < s.width; ++x)
                ASSERT_NE(triangle(x, y), nothing_seen) << x << " " << y;
        }
    }
}

}  // namespace
}  // namespace obscura
