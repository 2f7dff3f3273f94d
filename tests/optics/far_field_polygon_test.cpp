// The polygon transform: against the same sum in long double, a box's sincs, a fine raster, and itself under
// affine maps.

#include <gtest/gtest.h>

#include <cstring>

#include "optics/aperture_shapes.h"
#include "optics/far_field_methods.h"
#include "tests/optics/far_field_reference.h"

namespace obscura {
namespace {

using namespace far_field_reference;

constexpr double tolerance = 1e-6;

double signed_area(const Outline& outline) {
    double sum = 0;
    for (const auto& loop : outline.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2d a = loop[i], b = loop[(i + 1) % loop.size()];
            sum += 0.5 * (a.x * b.y - a.y * b.x);
        }
    }
    return sum;
}

/// The edge sum in long double: loses 1e-19 / |q| of its size, little enough down to |q| = 1e-10.
Complex polygon_at(const Outline& outline, double middle_x, double middle_y, double u, double v) {
    using Long = long double;
    const Long pi = 3.14159265358979323846264338327950288L;
    std::complex<Long> sum = 0;
    for (const auto& loop : outline.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2d a = loop[i], b = loop[(i + 1) % loop.size()];
            const Long dx = static_cast<Long>(b.x) - a.x, dy = static_cast<Long>(b.y) - a.y;
            const Long mx = (static_cast<Long>(b.x) + a.x) / 2 - middle_x,
                       my = (static_cast<Long>(b.y) + a.y) / 2 - middle_y;
            const Long t = u * dx + v * dy, phase = -2 * pi * (u * mx + v * my);
            const Long s = std::fabs(t) < 1e-9L ? 1 - pi * pi * t * t / 6 : std::sin(pi * t) / (pi * t);
            sum += (u * dy - v * dx) * s * std::complex<Long>(std::cos(phase), std::sin(phase));
        }
    }
    const Long q2 = static_cast<Long>(u) * u + static_cast<Long>(v) * v;
    const std::complex<Long> f = std::complex<Long>(0, 1) / (2 * pi * q2) * sum;
    return {static_cast<double>(f.real()), static_cast<double>(f.imag())};
}

Outline turned_box(double width, double height, double angle, double cx, double cy) {
    Outline outline;
    outline.disjoint = true;
    outline.loops.emplace_back();
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        const double px = 0.5 * width * x, py = 0.5 * height * y;
        outline.loops[0].push_back({cx + px * std::cos(angle) - py * std::sin(angle),
                                    cy + px * std::sin(angle) + py * std::cos(angle)});
    }
    return outline;
}

struct NamedOutline {
    std::string name;
    Outline outline;
};
std::vector<NamedOutline> outlines(int size) {
    std::vector<NamedOutline> all;
    ApertureShape iris, box, hexagons, slits;
    box.kind = ApertureKind::box;
    box.aspect = 0.3;
    box.rotation_deg = 30;
    hexagons.kind = ApertureKind::hexagons;
    slits.kind = ApertureKind::slit;
    slits.slits = 3;
    for (const ApertureShape& shape : {iris, box, hexagons, slits}) {
        const Outline outline = outline_of(shape, size);
        if (outline.disjoint) all.push_back({aperture_kind_name(shape.kind), outline});
    }
    all.push_back({"triangle far off", {{{{50, 50}, {53, 50.5}, {51, 54}}}, true}});
    // A square with a square hole, which turns the other way.
    all.push_back(
        {"frame",
         {{{{10, 10}, {54, 10}, {54, 50}, {10, 50}}, {{20, 20}, {20, 30}, {30, 30}, {30, 20}}}, true}});
    return all;
}

std::vector<FrequencyGrid> polygon_grids() {
    std::vector<FrequencyGrid> grids = all_grids(64);
    grids.push_back(centred_grid(17, 17, 1e-6));
    grids.push_back(centred_grid(17, 5, 1e-9));
    return grids;
}

TEST(FarFieldPolygon, NearTheExactSumAndTheAreaInTheMiddle) {
    const std::vector<NamedOutline> all = outlines(64);
    ASSERT_GE(all.size(), 5u);
    for (const NamedOutline& n : all) {
        const double area = signed_area(n.outline);
        ASSERT_GT(area, 0) << n.name;
        for (const FrequencyGrid& grid : polygon_grids()) {
            Field field = field_for(grid);
            far_field_polygon(n.outline, 64, 64, grid, target_of(field), Exec{});
            double worst = 0;
            for (int y = 0; y < grid.height; ++y) {
                for (int x = 0; x < grid.width; ++x) {
                    const double u = grid.first_u + x * grid.step_u, v = grid.first_v + y * grid.step_v;
                    const Complex truth =
                        u == 0 && v == 0 ? Complex(area, 0) : polygon_at(n.outline, 32, 32, u, v);
                    const Complex got(static_cast<double>(field.re(x, y)),
                                      static_cast<double>(field.im(x, y)));
                    worst = std::max(worst, std::abs(got - truth));
                }
            }
            EXPECT_LT(worst / area, tolerance)
                << n.name << " step " << grid.step_u << " from " << grid.first_u;
        }
    }
}

TEST(FarFieldPolygon, ABoxIsAProductOfSincs) {
    const Outline box = turned_box(20, 34, 0, 32, 32);
    for (const FrequencyGrid& grid : polygon_grids()) {
        Field field = field_for(grid);
        far_field_polygon(box, 64, 64, grid, target_of(field), Exec{});
        for (int y = 0; y < grid.height; ++y) {
            for (int x = 0; x < grid.width; ++x) {
                const double u = grid.first_u + x * grid.step_u, v = grid.first_v + y * grid.step_v;
                ASSERT_NEAR(static_cast<double>(field.re(x, y)), 680 * sinc(u * 20) * sinc(v * 34),
                            680 * tolerance);
                ASSERT_NEAR(static_cast<double>(field.im(x, y)), 0, 680 * tolerance);
            }
        }
    }
}

TEST(FarFieldPolygon, AFineRasterAgreesAtLowFrequencies) {
    ApertureShape shape;
    const int size = 1024;
    const Aperture aperture = make_aperture(shape, size, 0.01);
    ASSERT_TRUE(aperture.outline.disjoint);
    const FrequencyGrid grid = centred_grid(33, 33, 0.5 / size);
    Field field = field_for(grid);
    far_field_polygon(aperture.outline, size, size, grid, target_of(field), Exec{});
    const double area = open_area(aperture.mask.view());
    // The raster blurs by a texel (exactly undone below 1e-4 here) and aliases a little.
    EXPECT_LT(worst_error(field, aperture.mask.view(), grid, area), 1e-4);
}

TEST(FarFieldPolygon, ScalesTurnsAndShiftsAsTransformsDo) {
    const Outline shape = outlines(64)[0].outline;
    const FrequencyGrid grid{31, 27, -0.11, -0.07, 0.007, 0.005};
    Field field = field_for(grid);
    far_field_polygon(shape, 64, 64, grid, target_of(field), Exec{});
    const double area = signed_area(shape);

    // f(x / 2, y / 3) has 6 F(2 u, 3 v).
    Outline stretched = shape;
    for (Vec2d& p : stretched.loops[0])
        p = {2 * p.x, 3 * p.y};
    Field wide = field_for(grid);
    const FrequencyGrid finer{31, 27, -0.11 / 2, -0.07 / 3, 0.007 / 2, 0.005 / 3};
    far_field_polygon(stretched, 128, 192, finer, target_of(wide), Exec{});
    // A quarter turn: x' = 64 - y, y' = x has F'(u, v) = F(v, -u).
    Outline turned = shape;
    for (Vec2d& p : turned.loops[0])
        p = {64 - p.y, p.x};
    const FrequencyGrid exchanged{27, 31, 0.07 - 26 * 0.005, -0.11, 0.005, 0.007};
    Field side = field_for(exchanged);
    far_field_polygon(turned, 64, 64, exchanged, target_of(side), Exec{});
    // A shift by (5, -3) multiplies by e^(-2 pi i (5 u - 3 v)).
    Outline shifted = shape;
    for (Vec2d& p : shifted.loops[0])
        p = {p.x + 5, p.y - 3};
    Field moved = field_for(grid);
    far_field_polygon(shifted, 64, 64, grid, target_of(moved), Exec{});

    for (int y = 0; y < grid.height; ++y) {
        for (int x = 0; x < grid.width; ++x) {
            const auto at = [](const Field& f, int i, int j) {
                return Complex(static_cast<double>(f.re(i, j)), static_cast<double>(f.im(i, j)));
            };
            const Complex f = at(field, x, y);
            ASSERT_LT(std::abs(at(wide, x, y) / 6.0 - f), 2 * tolerance * area);
            ASSERT_LT(std::abs(at(side, grid.height - 1 - y, x) - f), 2 * tolerance * area);
            const double u = grid.first_u + x * grid.step_u, v = grid.first_v + y * grid.step_v;
            ASSERT_LT(std::abs(at(moved, x, y) - f * turn(5 * u - 3 * v)), 2 * tolerance * area);
        }
    }
}

TEST(FarFieldPolygon, SameBitsEverywhereAndCrossingLoopsRefused) {
    for (const NamedOutline& n : outlines(64)) {
        for (const FrequencyGrid& grid : polygon_grids()) {
            Field first = field_for(grid);
            far_field_polygon(n.outline, 64, 64, grid, target_of(first), {Isa::ref, 1});
            for (const Isa isa : supported_isas()) {
                Field other = field_for(grid);
                far_field_polygon(n.outline, 64, 64, grid, target_of(other), {isa, 2});
                const std::size_t bytes = first.re.pixels.size() * sizeof(float);
                EXPECT_EQ(0, std::memcmp(first.re.pixels.data(), other.re.pixels.data(), bytes))
                    << isa_name(isa);
                EXPECT_EQ(0, std::memcmp(first.im.pixels.data(), other.im.pixels.data(), bytes))
                    << isa_name(isa);
            }
        }
    }
    Outline crossing = outlines(64)[0].outline;
    crossing.disjoint = false;
    Field field = field_for(centred_grid(4, 4, 0.1));
    EXPECT_THROW(far_field_polygon(crossing, 64, 64, centred_grid(4, 4, 0.1), target_of(field), Exec{}),
                 InputError);
}

}  // namespace
}  // namespace obscura
