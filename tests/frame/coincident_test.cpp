// Shadows where surfaces touch, coincide or enclose: whatever a map stores there, what is lit stays lit and
// what is dark stays dark. Drawn at random; each scene with dense maps and with trees.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <tuple>

#include "tests/frame/scenes.h"
#include "tests/frame/shadow_rays.h"

namespace obscura {
namespace {

using namespace frame_scenes;

struct Source {
    std::mt19937 bits;
    explicit Source(unsigned seed) : bits(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits()) / 4294967296.0);
    }
    int below(int n) { return static_cast<int>(bits() % static_cast<unsigned>(n)); }
};

/// Faces of the lattice that boxes are put on; not dyadic, so planes round.
struct Lattice {
    double step, origin;
    float at(int i) const { return static_cast<float>(origin + step * i); }
};

/// Boxes that fill cells of a lattice, so that neighbours have a face, an edge or a corner in common.
Scene touching_boxes(Source& source, const Lattice& lattice) {
    Scene scene = empty_scene(96, 72);
    std::set<std::tuple<int, int, int>> taken;
    while (taken.size() < 7) {
        const std::tuple cell{source.below(3), source.below(3), source.below(3)};
        if (!taken.insert(cell).second) continue;
        const auto [i, j, k] = cell;
        add(scene,
            box({lattice.at(i), lattice.at(j), lattice.at(k)},
                {lattice.at(i + 1), lattice.at(j + 1), lattice.at(k + 1)}),
            0);
    }
    const double middle = lattice.origin + 1.5 * lattice.step, far = 4.5 * lattice.step;
    scene.camera.eye = {middle + far * source.between(0.3, 1), middle + far * source.between(0.5, 1),
                        middle + far * source.between(0.3, 1)};
    scene.camera.look_at = {middle, middle, middle};
    scene.camera.vfov_deg = 45;
    return scene;
}

SceneLight light_over(Source& source, const Lattice& lattice) {
    const double middle = lattice.origin + 1.5 * lattice.step;
    const int kind = source.below(4);
    if (kind == 0) return directional({0, -1, 0}, {1, 1, 1}, 3, 1024);
    if (kind == 1) {
        return directional({source.between(-1, 1), source.between(-1, -0.2), source.between(-1, 1)},
                           {1, 1, 1}, 3, 1024);
    }
    // On the plane of a face, or anywhere.
    const double height =
        source.below(2) == 0 ? static_cast<double>(lattice.at(3)) : middle + 4 * lattice.step;
    const Vec3d place{middle + lattice.step * source.between(1.8, 3), height,
                      middle + lattice.step * source.between(1.8, 3)};
    SceneLight light = at_point(kind == 2 ? LightKind::point : LightKind::spot, place,
                                Vec3d{middle, middle, middle} - place, {1, 1, 1});
    light.light.outer_cone_deg = 45;
    light.shadow.resolution = 1024;
    return light;
}

/// Each has about 1200 receivers whose surroundings are lit or dark, and asks for them seven times.
constexpr unsigned slow_scenes = 240;

void expect_agreement(Scene& scene, double margin_m, int& lit, int& dark) {
    struct Way {
        ShadowMethod method;
        int filter;
        Receivers receivers = Receivers::static_only;
    };
    for (const auto& [method, filter, receivers] :
         {Way{ShadowMethod::exact, 1}, Way{ShadowMethod::map, 1}, Way{ShadowMethod::map, 3},
          Way{ShadowMethod::compressed, 1}, Way{ShadowMethod::compressed, 3},
          Way{ShadowMethod::map, 1, Receivers::any}, Way{ShadowMethod::compressed, 1, Receivers::any}}) {
        const bool exact = method == ShadowMethod::exact;
        scene.lights[0].shadow.method = method;
        scene.lights[0].shadow.filter_px = filter;
        scene.lights[0].shadow.receivers = receivers;
        // Exact shadows need no texel's margin, but the rays start a millimetre off the surface.
        const RayCount count = compare_with_rays(scene, exact ? 3e-3 : margin_m);
        const std::string how = std::string(name_of(shadow_method_words, method)) + ", filter " +
                                std::to_string(filter) + ", receivers " + name_of(receivers_words, receivers);
        EXPECT_EQ(count.acne, 0) << "of " << count.lit << ", " << how;
        // Between sheets a tree may store any depth; taps that miss the lower one's edge are then lit.
        const bool beside_edges = method == ShadowMethod::compressed && filter > 1;
        EXPECT_LE(count.leaks, beside_edges ? 2 : 0) << "of " << count.dark << ", " << how;
        lit += count.lit;
        dark += count.dark;
    }
}

/// With OBSCURA_SLOW_TESTS=1, ten million receivers.
TEST(CoincidentShadows, TouchingBoxes) {
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    const unsigned scenes =
        slow != nullptr ? slow_scenes * static_cast<unsigned>(std::max(1, std::atoi(slow))) : 24;
    int lit = 0, dark = 0;
    for (unsigned seed = 0; seed < scenes && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Source source(seed);
        const Lattice lattice{source.between(0.1, 3), source.between(-5, 5)};
        Scene scene = touching_boxes(source, lattice);
        scene.lights.push_back(light_over(source, lattice));
        expect_agreement(scene, 0.06 * lattice.step, lit, dark);
    }
    EXPECT_GT(lit, 50'000);
    EXPECT_GT(dark, 20'000);
    std::printf("%d lit and %d dark receivers in %u scenes\n", lit, dark, scenes);
}

/// Both orientations of one sheet, as leaves and signs are modelled: as one part and as two, coincident or
/// nearly so.
TEST(CoincidentShadows, SheetsBackToBack) {
    int lit = 0, dark = 0;
    for (unsigned seed = 0; seed < 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Source source(100 + seed);
        Scene scene = empty_scene(96, 72);
        add(scene, box({-3, -0.5, -3}, {3, 0, 3}), 0);
        for (int sheet = 0; sheet < 3; ++sheet) {
            const float x = static_cast<float>(source.between(-1, 1)),
                        y = static_cast<float>(source.between(0.4, 2)),
                        z = static_cast<float>(source.between(-1, 1)),
                        tilt = static_cast<float>(source.between(-0.3, 0.3));
            Mesh quad = plane(1.2, 0.9);
            for (Vec3f& p : quad.positions)
                p.y += tilt * p.x;
            compute_normals(quad, 0);
            Mesh back = quad;
            for (Triangle& t : back.triangles)
                std::swap(t.v[1], t.v[2]);
            for (Vec3f& n : back.normals)
                n = -n;
            // On one another, or apart by less than floats tell to a millimetre.
            if (source.below(2) == 0) {
                const auto apart = static_cast<float>(std::pow(10, source.between(-8, -3)));
                for (Vec3f& p : back.positions)
                    p.y -= apart;
            }
            if (source.below(2) == 0) {
                append_mesh(quad, back);
                add(scene, quad, 0, {x, y, z});
            } else {
                add(scene, quad, 0, {x, y, z});
                add(scene, back, 0, {x, y, z});
            }
        }
        scene.camera.eye = {2.5, 4, 3.5};
        scene.camera.look_at = {0, 0.5, 0};
        scene.lights.push_back(
            directional({source.between(-0.6, 0.6), -1, source.between(-0.6, 0.6)}, {1, 1, 1}, 3, 1024));
        expect_agreement(scene, 0.05, lit, dark);
    }
    EXPECT_GT(lit, 10'000);
    EXPECT_GT(dark, 1'000);
}

/// A lamp and the camera inside a box whose faces look outwards, with a crate in it: nothing but the crate's
/// shadow.
TEST(CoincidentShadows, RoomsModelledAsSolids) {
    int lit = 0, dark = 0;
    for (unsigned seed = 0; seed < 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Source source(200 + seed);
        Scene scene = empty_scene(96, 72);
        add(scene, box({-2, 0, -1.5}, {2, 2, 1.5}), 0);
        add(scene, box({-0.7, 0, -0.5}, {-0.1, static_cast<float>(source.between(0.3, 1.4)), 0.1f}), 0);
        scene.camera.eye = {1.7, 1.5, 1.3};
        scene.camera.look_at = {-0.5, 0.6, -0.5};
        scene.camera.vfov_deg = 70;
        SceneLight lamp = at_point(LightKind::point, {source.between(0.2, 1.5), 1.7, source.between(-1, 1)},
                                   {0, -1, 0}, {1, 1, 1});
        lamp.shadow.resolution = 1024;
        scene.lights.push_back(lamp);
        for (const ShadowMethod method : {ShadowMethod::map, ShadowMethod::compressed, ShadowMethod::exact}) {
            scene.lights[0].shadow.method = method;
            const RayCount count = compare_with_rays(scene, method == ShadowMethod::exact ? 0.003 : 0.05);
            EXPECT_EQ(count.acne, 0) << "of " << count.lit;
            EXPECT_EQ(count.leaks, 0) << "of " << count.dark;
            lit += count.lit;
            dark += count.dark;
        }
    }
    EXPECT_GT(lit + dark, 20'000);
}

/// The same room, sealed, under a sun outside: away from its edges nothing is lit, not even what stands in
/// it.
TEST(CoincidentShadows, NothingInsideASolidIsLitFromOutside) {
    for (unsigned seed = 0; seed < 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Source source(300 + seed);
        Scene scene = empty_scene(96, 72);
        add(scene, box({-2, 0, -1.5}, {2, 2, 1.5}), 0);
        add(scene, box({-0.8, 0, -0.6}, {-0.2, 1.6f, 0}), 0);
        scene.camera.eye = {1.7, 1.5, 1.3};
        scene.camera.look_at = {-0.5, 0.6, -0.5};
        scene.camera.vfov_deg = 40;
        scene.lights.push_back(
            directional({source.between(-1, 1), -1, source.between(-1, 1)}, {1, 1, 1}, 3, 2048));
        for (const ShadowMethod method : {ShadowMethod::map, ShadowMethod::compressed, ShadowMethod::exact}) {
            const bool exact = method == ShadowMethod::exact;
            scene.lights[0].shadow.method = method;
            const Frame frame = render_frame(scene, all_channels());
            const CameraRays rays = camera_rays(scene.camera, frame.width, frame.height);
            int looked_at = 0, lit = 0;
            for (int y = 0; y < frame.height; ++y) {
                for (int x = 0; x < frame.width; ++x) {
                    const auto along = [&](int k) {
                        const double dir =
                            rays.dir0[k] + (x + 0.5) * rays.dir_x[k] + (y + 0.5) * rays.dir_y[k];
                        return rays.eye[k] + dir * static_cast<double>(frame.depth_m(x, y));
                    };
                    const Vec3d p{along(0), along(1), along(2)};
                    // A map ends a texel or two beyond the room's edges: how many of its walls are near?
                    const int walls =
                        (std::fabs(p.x) > 1.97) + (p.y < 0.03 || p.y > 1.97) + (std::fabs(p.z) > 1.47);
                    // Faces that light grazes reach through the roof within a texel.
                    const double facing =
                        -dot(to_double(frame.normal(x, y)), scene.lights[0].light.direction);
                    if (!exact && (walls > 1 || std::fabs(facing) < 0.3)) continue;
                    ++looked_at;
                    lit += frame.shadow(x, y) != 0.0f;
                }
            }
            // As above, beside the crate.
            EXPECT_LE(lit, method == ShadowMethod::compressed ? 2 : 0);
            EXPECT_GT(looked_at, 2000);
        }
    }
}

/// Rooms whose walls have no thickness, or overlap, seen from inside: exact shadows let nothing in, not even
/// at the edges.
TEST(CoincidentShadows, ClosedRoomsAreDarkToTheirEdges) {
    const auto sides = [](double thick) {
        Mesh room;
        const auto wall = [&](Vec3d lo, Vec3d hi) { append_mesh(room, box(lo, hi)); };
        const double a = 2, b = a + thick;
        wall({-b, -thick, -b}, {b, 0, b});
        wall({-b, 2, -b}, {b, 2 + thick, b});
        wall({-b, -thick, -b}, {-a, 2 + thick, b});
        wall({a, -thick, -b}, {b, 2 + thick, b});
        wall({-b, -thick, -b}, {b, 2 + thick, -a});
        wall({-b, -thick, a}, {b, 2 + thick, b});
        return room;
    };
    Mesh inward = box({-2, 0, -2}, {2, 2, 2});
    for (Triangle& t : inward.triangles)
        std::swap(t.v[1], t.v[2]);
    for (Vec3f& n : inward.normals)
        n = -n;
    const std::pair<const char*, Mesh> rooms[] = {{"outward faces", box({-2, 0, -2}, {2, 2, 2})},
                                                  {"inward faces", inward},
                                                  {"walls of 10 cm", sides(0.1)},
                                                  {"walls of a micrometre", sides(1e-6)}};
    for (const auto& [name, room] : rooms) {
        for (unsigned seed = 0; seed < 6; ++seed) {
            SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
            Source source(400 + seed);
            Scene scene = empty_scene(96, 72);
            add(scene, room, 0);
            scene.camera.eye = {1.7, 1.5, 1.3};
            scene.camera.look_at = {source.between(-1, 0), 0.6, -0.5};
            scene.camera.vfov_deg = 70;
            scene.lights.push_back(
                directional({source.between(-1, 1), -1, source.between(-1, 1)}, {1, 1, 1}, 3, 4096));
            for (const ShadowMethod method :
                 {ShadowMethod::exact, ShadowMethod::map, ShadowMethod::compressed}) {
                scene.lights[0].shadow.method = method;
                const Frame frame = render_frame(scene, all_channels());
                const auto lit = std::count_if(frame.shadow.pixels.begin(), frame.shadow.pixels.end(),
                                               [](float v) { return v != 0; });
                std::printf("%s, %s: %d lit\n", name, name_of(shadow_method_words, method),
                            static_cast<int>(lit));
                if (method == ShadowMethod::exact) {
                    EXPECT_EQ(lit, 0);
                }
            }
        }
    }
}

/// What casts none receives all the same: it is in no map, so no interval may reach down to it.
TEST(CoincidentShadows, FallOnWhatCastsNone) {
    for (const bool fin : {false, true}) {
        Scene scene = empty_scene(96, 72);
        Mesh canopy = plane(2, 2);
        if (fin) {
            Mesh back = canopy;
            for (Triangle& t : back.triangles)
                std::swap(t.v[1], t.v[2]);
            append_mesh(canopy, back);
        }
        add(scene, canopy, 0, {0, 2, 0});
        add(scene, plane(6, 6), 0);
        scene.mesh.objects[scene.mesh.object.back()].casts_shadow = false;
        scene.camera.eye = {3, 5, 5};
        scene.camera.look_at = {0, 0.5, 0};
        scene.lights.push_back(directional({0.2, -1, 0.1}, {1, 1, 1}, 3, 1024));
        int lit = 0, dark = 0;
        expect_agreement(scene, 0.05, lit, dark);
        EXPECT_GT(dark, 500) << "fin " << fin;
    }
}

/// A sheet of 1 cm is the whole depth range of its tree: a steep ground far below lies beyond it, and its
/// plane comes back into it within a texel only where it does so in the scene.
TEST(CoincidentShadows, OfAThinRoofFallOnSteepGroundThatCastsNone) {
    Scene scene = empty_scene(96, 72);
    add(scene, box({-1, 2, -1}, {1, 2.01f, 1}), 0);
    Mesh ground = plane(6, 6);
    for (Vec3f& p : ground.positions)
        p.y = p.x;
    ground.normals.clear();
    compute_normals(ground, 0);
    add(scene, ground, 0, {0, -1, 0});
    scene.mesh.objects[scene.mesh.object.back()].casts_shadow = false;
    scene.camera.eye = {-4, 4, 4};
    scene.camera.look_at = {0, -0.5, 0};
    scene.lights.push_back(directional({0.02, -1, 0.01}, {1, 1, 1}, 3, 256));
    int lit = 0, dark = 0;
    expect_agreement(scene, 0.1, lit, dark);
    EXPECT_GT(lit, 1'000);
    EXPECT_GT(dark, 500);
}

}  // namespace
}  // namespace obscura
