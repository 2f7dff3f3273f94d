// A person in a coat, simplified to turned and rounded pieces, and a lion's head on a wall.

#include <cmath>

#include "core/error.h"
#include "scenes/generators.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

enum FigureSlot : std::uint32_t { coat, trim, skin, hair, boot, eye };

/// A ball stretched to these half axes.
void add_ball(Mesh& mesh, Vec3d at, Vec3d half, std::uint32_t slot, const Affine& turn = {}, int fine = 32) {
    add_part(mesh, sphere(1, fine, fine / 2), translation(at) * turn * scaling(half), slot);
}

void add_legs(Mesh& mesh) {
    for (const double side : {-1.0, 1.0}) {
        const double x = side * 0.058;
        add_part(mesh, tube({{{x, 0.03, 0}, 0.036}, {{x, 0.3, 0}, 0.05}}, 20), {}, boot);
        add_ball(mesh, {x, 0.025, 0.028}, {0.046, 0.032, 0.078}, boot);
    }
}

void add_coat(Mesh& mesh) {
    add_part(mesh,
             lathe({{0, 0.2},
                    {0.165, 0.2},
                    {0.17, 0.215},
                    {0.15, 0.32},
                    {0.118, 0.455},
                    {0.125, 0.56},
                    {0.132, 0.63},
                    {0.118, 0.685},
                    {0.06, 0.73},
                    {0, 0.74}},
                   56, 40),
             scaling({1, 1, 0.82}), coat);
    add_part(mesh, torus(0.117, 0.014, 56, 14), translation(0, 0.455, 0) * scaling({1, 1, 0.83}), trim);
    add_part(mesh, torus(0.166, 0.012, 56, 14), translation(0, 0.21, 0) * scaling({1, 1, 0.82}), trim);
    // A scarf with one end that hangs down.
    add_part(mesh, torus(0.062, 0.026, 40, 16), translation(0, 0.728, 0) * rotation_x(6), trim);
    add_ball(mesh, {0.035, 0.655, 0.098}, {0.024, 0.078, 0.014}, trim, rotation_z(8) * rotation_x(-9), 24);
    for (int i = 0; i < 3; ++i)
        add_ball(mesh, {-0.014, 0.405 - 0.06 * i, 0.110 + 0.0085 * i}, {0.011, 0.011, 0.008}, trim, {}, 16);
}

void add_arm(Mesh& mesh, double side, double raised_deg) {
    // From the shoulder hangs an arm with a bent elbow, turned up about the shoulder.
    const Vec3d shoulder{side * 0.112, 0.672, 0};
    const Affine turn = translation(shoulder) * rotation_z(side * raised_deg);
    const Vec3d elbow{side * 0.045, -0.15, 0}, hand{side * 0.035, -0.27, 0.075};
    add_part(mesh, tube({{{0, 0.012, 0}, 0.043}, {elbow, 0.037}, {hand, 0.034}}, 20), turn, coat);
    add_ball(mesh, shoulder, {0.046, 0.046, 0.046}, coat, {}, 24);
    const Affine wrist = turn * translation(hand);
    add_part(mesh, sphere(0.038, 24, 12), wrist * scaling({1, 0.8, 1}), trim);
    add_part(mesh, sphere(0.036, 24, 12), wrist * translation(0, -0.028, 0.02), skin);
}

void add_head(Mesh& mesh) {
    const double y = 0.845;
    add_ball(mesh, {0, y, 0}, {0.1, 0.106, 0.1}, skin, {}, 48);
    add_ball(mesh, {0, y + 0.022, -0.022}, {0.107, 0.104, 0.096}, hair, rotation_x(-18), 48);
    add_ball(mesh, {0, y - 0.012, 0.1}, {0.017, 0.02, 0.02}, skin, {}, 20);
    for (const double side : {-1.0, 1.0}) {
        add_ball(mesh, {side * 0.036, y + 0.012, 0.0905}, {0.0115, 0.016, 0.008}, eye, {}, 16);
        add_ball(mesh, {side * 0.1, y - 0.008, 0.004}, {0.016, 0.026, 0.02}, skin, {}, 20);
    }
}

void add_hat(Mesh& mesh, int kind) {
    if (kind == 1) {  // pointed, with a band of fur
        const Affine lean = translation(0, 0.895, -0.012) * rotation_x(-9);
        add_part(mesh,
                 lathe({{0, 0}, {0.1, 0}, {0.088, 0.06}, {0.055, 0.14}, {0.022, 0.21}, {0, 0.225}}, 40, 40),
                 lean, coat);
        add_part(mesh, torus(0.096, 0.025, 40, 16), lean, trim);
        add_part(mesh, sphere(0.03, 24, 12), lean * translation(0, 0.225, 0), trim);
    } else if (kind == 2) {  // brimmed
        add_part(mesh,
                 lathe({{0, 0},
                        {0.175, 0.012},
                        {0.178, 0.02},
                        {0.1, 0.022},
                        {0.092, 0.1},
                        {0.07, 0.115},
                        {0, 0.112}},
                       56, 30),
                 translation(0, 0.9, -0.01) * rotation_x(-6), coat);
        add_part(mesh, torus(0.098, 0.011, 48, 12), translation(0, 0.932, -0.012) * rotation_x(-6), trim);
    }
}

enum LionSlot : std::uint32_t { stone, pupil, ring };

/// Two crowns of locks around the face, each lock a stretched ball that leans outwards.
void add_mane(Mesh& mesh) {
    struct Crown {
        int locks;
        double radius, length, width, forward, lean_deg;
    };
    for (const Crown& c : {Crown{22, 0.40, 0.15, 0.062, 0.055, 18}, Crown{17, 0.31, 0.14, 0.06, 0.145, 34}}) {
        for (int i = 0; i < c.locks; ++i) {
            const double turn = (i + (c.locks == 17 ? 0.5 : 0.0)) / c.locks, deg = 360 * turn;
            const double jitter = 1 + 0.12 * on_circle(turn * 7).x;
            const Affine out = rotation_z(deg) * translation(0, c.radius * jitter, c.forward) *
                               rotation_x(c.lean_deg) * rotation_z(14);
            add_part(mesh, sphere(1, 24, 16), out * scaling({c.width, c.length * jitter, 0.065}), stone);
        }
    }
}

void add_face(Mesh& mesh) {
    add_ball(mesh, {0, 0, 0.14}, {0.27, 0.3, 0.2}, stone, {}, 64);
    add_ball(mesh, {0, 0.03, 0.31}, {0.062, 0.17, 0.075}, stone, rotation_x(-14), 40);  // bridge of the nose
    add_ball(mesh, {0, -0.045, 0.395}, {0.062, 0.038, 0.035}, pupil, {}, 32);
    add_ball(mesh, {0, -0.225, 0.255}, {0.085, 0.075, 0.085}, stone, {}, 32);  // chin
    for (const double side : {-1.0, 1.0}) {
        add_ball(mesh, {side * 0.068, -0.115, 0.325}, {0.092, 0.08, 0.085}, stone, {}, 40);  // muzzle
        add_ball(mesh, {side * 0.15, -0.06, 0.22}, {0.1, 0.09, 0.09}, stone, {}, 32);        // cheek
        add_ball(mesh, {side * 0.115, 0.125, 0.285}, {0.085, 0.034, 0.05}, stone, rotation_z(side * 16), 32);
        add_ball(mesh, {side * 0.108, 0.075, 0.292}, {0.037, 0.030, 0.026}, stone, {}, 24);
        add_ball(mesh, {side * 0.104, 0.073, 0.312}, {0.015, 0.016, 0.013}, pupil, {}, 16);
        add_ball(mesh, {side * 0.235, 0.235, 0.185}, {0.07, 0.085, 0.045}, stone, rotation_z(side * -28), 32);
    }
}

}  // namespace

GeneratedModel figure(const FigureParams& p) {
    CHECK(p.height_m > 0 && p.hat >= 0 && p.hat <= 2);
    GeneratedModel unit;
    add_legs(unit.mesh);
    add_coat(unit.mesh);
    add_arm(unit.mesh, -1, p.right_arm_deg);
    add_arm(unit.mesh, 1, p.left_arm_deg);
    add_head(unit.mesh);
    add_hat(unit.mesh, p.hat);
    GeneratedModel model;
    model.materials = {material_slot("coat", 150, 44, 40, 0.85f),  material_slot("trim", 226, 210, 178, 0.9f),
                       material_slot("skin", 222, 170, 138, 0.6f), material_slot("hair", 74, 48, 32, 0.8f),
                       material_slot("boot", 54, 40, 34, 0.5f),    material_slot("eye", 24, 20, 20, 0.15f)};
    const double across = p.height_m * p.girth;
    add_parts(model.mesh, unit.mesh, scaling({across, p.height_m, across}), 0);
    return model;
}

GeneratedModel lion_head(const LionHeadParams& p) {
    CHECK(p.size_m > 0);
    Mesh unit;
    // A round plate carries it; the ring hangs out of the mouth.
    add_part(unit, lathe({{0, 0}, {0.5, 0}, {0.5, 0.03}, {0.46, 0.06}, {0, 0.06}}, 64, 30), rotation_x(90),
             stone);
    add_mane(unit);
    add_face(unit);
    add_part(unit, torus(0.14, 0.02, 56, 16), translation(0, -0.32, 0.335) * rotation_x(78), ring);
    GeneratedModel model;
    model.materials = {material_slot("stone", 196, 182, 156, 0.8f), material_slot("dark", 70, 62, 54, 0.5f),
                       material_slot("ring", 168, 128, 70, 0.3f)};
    model.materials[2].metallic = 1;
    add_parts(model.mesh, unit, scaling({p.size_m, p.size_m, p.size_m}), 0);
    return model;
}

}  // namespace obscura
