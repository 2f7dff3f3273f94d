// Outlines and their coverage: closed-form areas, an independent point-in-outline oracle, symmetry bit for
// bit.

#include "optics/aperture_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "core/error.h"
#include "optics/outline_coverage.h"

namespace obscura {
namespace {

constexpr double pi = 3.14159265358979323846;

constexpr ApertureKind all_kinds[] = {ApertureKind::iris,    ApertureKind::circle,  ApertureKind::box,
                                      ApertureKind::whirl,   ApertureKind::annulus, ApertureKind::slit,
                                      ApertureKind::grating, ApertureKind::hexagons};

ApertureShape shape_of(ApertureKind kind) {
    ApertureShape shape;
    shape.kind = kind;
    return shape;
}

double area_of(const ApertureShape& shape, int size) {
    return open_area(make_aperture(shape, size, 1).mask.view());
}

/// Winding number by angles, shared with nothing in the program: steps through half planes.
int winding(const Outline& outline, double x, double y) {
    int turns = 0;
    for (const auto& loop : outline.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2d a = loop[i], b = loop[(i + 1) % loop.size()];
            const double side = (b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y);
            if (a.y <= y && b.y > y && side > 0) ++turns;
            if (a.y > y && b.y <= y && side < 0) --turns;
        }
    }
    return turns;
}

TEST(Shapes, AreasAreThoseOfGeometry) {
    constexpr int size = 300;
    const double d = 0.9 * size, r = d / 2;
    EXPECT_NEAR(area_of(shape_of(ApertureKind::circle), size) / (pi * r * r), 1, 1e-8);
    EXPECT_NEAR(area_of(shape_of(ApertureKind::box), size) / (d * d), 1, 1e-9);
    ApertureShape iris = shape_of(ApertureKind::iris);
    for (const int n : {3, 4, 5, 7, 8, 9, 64}) {
        iris.blades = n;
        iris.rotation_deg = 3.7 * n;
        iris.bow = 0;
        const double straight = 0.5 * n * r * r * std::sin(2 * pi / n);
        EXPECT_NEAR(area_of(iris, size) / straight, 1, 1e-8) << n;
        iris.bow = 1;
        EXPECT_NEAR(area_of(iris, size) / (pi * r * r), 1, 1e-8) << n;
        iris.bow = 0.5;  // each edge adds a segment of a circle of radius 2 r
        const double half = std::asin(0.5 * std::sin(pi / n));
        const double segment = 0.5 * 4 * r * r * (2 * half - std::sin(2 * half));
        EXPECT_NEAR(area_of(iris, size) / (straight + n * segment), 1, 2e-8) << n;
    }
    ApertureShape annulus = shape_of(ApertureKind::annulus);
    annulus.vanes = 0;
    EXPECT_NEAR(area_of(annulus, size) / (pi * r * r * (1 - 0.09)), 1, 1e-8);
    EXPECT_NEAR(area_of(shape_of(ApertureKind::slit), size) / (0.1 * d * d), 1, 1e-8);
    EXPECT_NEAR(area_of(shape_of(ApertureKind::grating), size) / (0.5 * d * d), 1, 1e-8);
    // Whirl: a hub and half of a ring, since spirals only turn what lies at each radius.
    EXPECT_NEAR(
        area_of(shape_of(ApertureKind::whirl), size) / (pi * r * r * (0.16 * 0.16 + 0.5 * (1 - 0.16 * 0.16))),
        1, 1e-7);
}

TEST(Shapes, VanesTakeWhatGeometrySays) {
    // One vane along +x: a strip of width w between the two circles, each end a circle's arc.
    ApertureShape shape = shape_of(ApertureKind::annulus);
    shape.vanes = 1;
    shape.vane_width = 0.05;
    constexpr int size = 400;
    const double r = 0.45 * size, w = 0.05 * 2 * r;
    const auto strip = [&](double radius) {  // the part of the half disc within |y| < w / 2
        const double h = w / 2;
        return h * std::sqrt(radius * radius - h * h) + radius * radius * std::asin(h / radius);
    };
    const double expected = pi * r * r * (1 - 0.09) - (strip(r) - strip(0.3 * r));
    EXPECT_NEAR(area_of(shape, size) / expected, 1, 1e-8);
}

TEST(Shapes, HexagonsReachTheCircle) {
    for (const int rings : {1, 2, 3, 6}) {
        ApertureShape shape = shape_of(ApertureKind::hexagons);
        shape.rings = rings;
        shape.middle = rings == 1;
        const Outline outline = outline_of(shape, 512);
        EXPECT_EQ(outline.loops.size(), static_cast<std::size_t>(3 * rings * (rings + 1) + (rings == 1)));
        double reach = 0;
        for (const auto& loop : outline.loops) {
            EXPECT_EQ(loop.size(), 6u);
            for (const Vec2d& p : loop)
                reach = std::max(reach, std::hypot(p.x - 256, p.y - 256));
        }
        EXPECT_NEAR(reach, 0.45 * 512, 1e-9);
        // Neighbours keep the gap between their parallel sides.
        const double across = [&] {
            const auto& hexagon = outline.loops[0];
            return std::hypot(hexagon[0].x - hexagon[1].x, hexagon[0].y - hexagon[1].y) * std::sqrt(3.0);
        }();
        const double gap = 0.005 * 0.9 * 512;
        const double reach_formula =
            std::hypot((rings + 0.5) * (across + gap) - gap / 2, across / std::sqrt(12.0));
        EXPECT_NEAR(reach_formula, 0.45 * 512, 1e-9);
    }
}

/// Every shape, turned, moved partly out of the mask: texels are open by their area, not by samples.
TEST(Coverage, AgreesWithPointsInTheOutline) {
    constexpr int size = 24, grid = 24;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(0, 1);
    for (const ApertureKind kind : all_kinds) {
        for (const double offset : {0.0, 0.31}) {
            ApertureShape shape = shape_of(kind);
            shape.rotation_deg = 17.3;
            shape.offset_x = offset;
            shape.offset_y = -0.5 * offset;
            shape.hub = 0.4;
            Outline outline = outline_of(shape, size);
            for (auto& loop : outline.loops) {  // fewer points: the oracle walks them all
                std::vector<Vec2d> few;
                const std::size_t step = loop.size() > 100 ? loop.size() / 50 : 1;
                for (std::size_t i = 0; i < loop.size(); i += step)
                    few.push_back(loop[i]);
                loop = few;
            }
            const Image<float> mask = coverage_of(outline, size, size);
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < size; ++x) {
                    int inside = 0;
                    for (int j = 0; j < grid; ++j) {
                        for (int i = 0; i < grid; ++i) {
                            inside += winding(outline, x + (i + jitter(random)) / grid,
                                              y + (j + jitter(random)) / grid) > 0;
                        }
                    }
                    // Stratified samples: an error of a few cells along each boundary.
                    ASSERT_NEAR(mask(x, y), inside / double(grid * grid), 0.03)
                        << aperture_kind_name(kind) << " texel " << x << ' ' << y;
                }
            }
        }
    }
}

TEST(Coverage, RandomLoopsThatCrossAndOverlap) {
    constexpr int size = 8, grid = 64;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-2, size + 2), jitter(0, 1);
    for (int round = 0; round < 30; ++round) {
        Outline outline;
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec2d> loop;
            for (int i = 0; i < 3 + k; ++i)
                loop.push_back({place(random), place(random)});
            outline.loops.push_back(loop);
        }
        const Image<float> mask = coverage_of(outline, size, size);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                int inside = 0;
                for (int j = 0; j < grid; ++j) {
                    for (int i = 0; i < grid; ++i) {
                        inside += winding(outline, x + (i + jitter(random)) / grid,
                                          y + (j + jitter(random)) / grid) > 0;
                    }
                }
                ASSERT_NEAR(mask(x, y), inside / double(grid * grid), 0.01) << round << ": " << x << ' ' << y;
            }
        }
    }
}

TEST(Coverage, KnownTexels) {
    const auto one = [](std::vector<Vec2d> loop) { return coverage_of({{loop}, true}, 3, 3); };
    const Image<float> triangle = one({{0, 0}, {3, 3}, {0, 3}});
    EXPECT_EQ(triangle.pixels, (std::vector<float>{0.5f, 0, 0, 1, 0.5f, 0, 1, 1, 0.5f}));
    const Image<float> box = one({{0.25, 0.5}, {2.5, 0.5}, {2.5, 1.75}, {0.25, 1.75}});
    EXPECT_EQ(box.pixels, (std::vector<float>{0.375f, 0.5f, 0.25f, 0.5625f, 0.75f, 0.375f, 0, 0, 0}));
    // The other way round it is a hole in nothing.
    EXPECT_EQ(coverage_of({{{{0, 0}, {0, 3}, {3, 3}}}, false}, 3, 3).pixels, std::vector<float>(9, 0.0f));
    // Two that cross, an hourglass and its mirror image: only what turns from x to y is open.
    EXPECT_EQ(coverage_of({{{{0, 0}, {2, 0}, {0, 2}, {2, 2}}}, false}, 2, 2).pixels,
              (std::vector<float>{0.5f, 0.5f, 0, 0}));
    // Outside, to the left and to the right.
    EXPECT_EQ(one({{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}).pixels, std::vector<float>(9, 1.0f));
    EXPECT_EQ(one({{4, 0}, {9, 0}, {9, 3}, {4, 3}}).pixels, std::vector<float>(9, 0.0f));
}

TEST(Coverage, DisjointLoopsNeedNoSorting) {
    for (const ApertureKind kind : all_kinds) {
        ApertureShape shape = shape_of(kind);
        shape.vanes = 0;
        shape.rotation_deg = 5;
        Outline outline = outline_of(shape, 128);
        ASSERT_TRUE(outline.disjoint) << aperture_kind_name(kind);
        const Image<float> fast = coverage_of(outline, 128, 128);
        outline.disjoint = false;
        const Image<float> sorted = coverage_of(outline, 128, 128);
        for (std::size_t i = 0; i < fast.pixels.size(); ++i)
            ASSERT_NEAR(fast.pixels[i], sorted.pixels[i], 1e-7) << aperture_kind_name(kind);
    }
    ApertureShape annulus = shape_of(ApertureKind::annulus);
    EXPECT_FALSE(outline_of(annulus, 64).disjoint);
    ApertureShape slits = shape_of(ApertureKind::slit);
    slits.slits = 2;
    EXPECT_TRUE(outline_of(slits, 64).disjoint);
    slits.slit_step = 0.05;
    EXPECT_FALSE(outline_of(slits, 64).disjoint);
    EXPECT_NEAR(area_of(slits, 64), 0.15 * 0.9 * 0.9 * 64 * 64, 1e-4);
}

TEST(Coverage, InsideIsOneAndOutsideZero) {
    for (const ApertureKind kind : all_kinds) {
        const Image<float> mask = make_aperture(shape_of(kind), 256, 1).mask;
        int grey = 0;
        for (const float v : mask.pixels) {
            ASSERT_TRUE(v >= 0 && v <= 1);
            grey += v > 0 && v < 1;
        }
        EXPECT_LT(grey, 16 * 2 * 256) << aperture_kind_name(kind);
    }
}

TEST(Symmetry, MirroredShapesAreMirroredBitForBit) {
    const auto check = [](const ApertureShape& shape, bool left_right, bool top_bottom) {
        for (const int size : {255, 256, 512}) {
            const MaskSymmetry found = mask_symmetry(make_aperture(shape, size, 1).mask.view());
            EXPECT_EQ(found.left_right, left_right) << aperture_kind_name(shape.kind) << ' ' << size;
            EXPECT_EQ(found.top_bottom, top_bottom) << aperture_kind_name(shape.kind) << ' ' << size;
        }
    };
    for (const ApertureKind kind : {ApertureKind::circle, ApertureKind::box, ApertureKind::annulus,
                                    ApertureKind::slit, ApertureKind::grating, ApertureKind::hexagons}) {
        ApertureShape shape = shape_of(kind);
        for (const double diameter : {0.9, 0.7123, 1.1}) {
            shape.diameter = diameter;
            check(shape, true, true);
        }
    }
    ApertureShape iris = shape_of(ApertureKind::iris);
    for (const double bow : {0.0, 0.3}) {
        iris.bow = bow;
        for (iris.blades = 3; iris.blades <= 9; ++iris.blades) {
            iris.rotation_deg = 0;
            check(iris, true, iris.blades % 2 == 0);
            iris.rotation_deg = 90;
            check(iris, iris.blades % 2 == 0, true);
            iris.rotation_deg = 7;
            check(iris, false, false);
        }
    }
    check(shape_of(ApertureKind::whirl), false, false);
}

TEST(Shapes, PitchAndSize) {
    ApertureShape shape = shape_of(ApertureKind::circle);
    shape.diameter = 0.5;
    const Aperture aperture = make_aperture(shape, 200, 0.01);
    EXPECT_EQ(aperture.mask.width, 200);
    EXPECT_EQ(aperture.mask.height, 200);
    EXPECT_DOUBLE_EQ(aperture.pitch_m, 1e-4);
    EXPECT_EQ(outline_of(shape_of(ApertureKind::iris), 4096).loops[0].size(), 7u);
    // Chords stay within 1e-6 texel of the circle.
    const Outline circle = outline_of(shape, 4096);
    const auto& loop = circle.loops[0];
    const double r = 0.25 * 4096;
    for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
        const double mx = 0.5 * (loop[i].x + loop[i + 1].x) - 2048,
                     my = 0.5 * (loop[i].y + loop[i + 1].y) - 2048;
        ASSERT_LT(r - std::hypot(mx, my), 1e-6);
    }
}

TEST(Shapes, BadParametersSayWhich) {
    const auto message = [](auto change) -> std::string {
        ApertureShape shape;
        change(shape);
        try {
            make_aperture(shape, 64, 1);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(message([](auto& s) { s.blades = 2; }), "aperture: blades is 2, must be 3 to 64");
    EXPECT_EQ(message([](auto& s) { s.bow = -0.5; }), "aperture: bow is -0.5, must be 0 to 1");
    EXPECT_EQ(message([](auto& s) { s.bow = std::nan(""); }), "aperture: bow is nan, must be 0 to 1");
    EXPECT_EQ(message([](auto& s) { s.diameter = 0; }),
              "aperture: diameter is 0, must be above 0 and at most 2");
    EXPECT_EQ(message([](auto& s) {
                  s.kind = ApertureKind::hexagons;
                  s.gap = 0.2;
              }),
              "aperture: gap is 0.2, must be 0 to half a segment's width");
    EXPECT_THROW(make_aperture({}, 0, 1), InputError);
    EXPECT_THROW(make_aperture({}, 40000, 1), InputError);
    EXPECT_THROW(make_aperture({}, 64, 0), InputError);
}

}  // namespace
}  // namespace obscura
