// Dirt: seeded, bounded, of the same look at every size; areas and statistics as computed by hand.

#include "optics/aperture_dirt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/hash.h"
#include "optics/aperture_shapes.h"
#include "optics/outline_coverage.h"
#include "optics/perlin_noise.h"

namespace obscura {
namespace {

constexpr double pi = 3.14159265358979323846;

LensDirt everything() {
    LensDirt d;
    d.noise = 0.8;
    d.dust = 40;
    d.dust_softness = 0.5;
    d.scratches = 20;
    d.eyelashes = 12;
    d.occluder = Occluder::housing;
    d.occluder_x = 0.2;
    return d;
}

LensDirt only(int LensDirt::*kind, int count) {
    LensDirt d;
    d.*kind = count;
    return d;
}

/// Texels that are hidden.
double hidden(const Image<float>& light) {
    return static_cast<double>(light.width) * light.height - open_area(light.view());
}

/// Correlation of the fluctuations of pixels (dx, dy) apart.
double correlation(const Image<float>& image, int dx, int dy) {
    double mean = open_area(image.view()) / (static_cast<double>(image.width) * image.height);
    double both = 0, own = 0;
    for (int y = 0; y + dy < image.height; ++y) {
        for (int x = std::max(0, -dx); x + std::max(0, dx) < image.width; ++x) {
            const double a = static_cast<double>(image(x, y)) - mean;
            both += a * (static_cast<double>(image(x + dx, y + dy)) - mean);
            own += a * a;
        }
    }
    return both / own;
}

TEST(PerlinNoise, ZeroAtTheLatticeSmoothBetween) {
    double sum = 0, most = 0;
    constexpr int side = 256, per_cell = 8;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double px = double(x) / per_cell - 7, py = double(y) / per_cell - 9;
            const double v = perlin_noise(px, py, 5);
            if (x % per_cell == 0 && y % per_cell == 0) {
                ASSERT_EQ(v, 0);
            }
            // No jumps anywhere, across cells and across 0: slopes are below 2.5.
            ASSERT_NEAR(perlin_noise(px + 1e-4, py + 1e-4, 5), v, 5e-4);
            ASSERT_LE(std::fabs(fractal_noise(px, py, 5, 3)), std::sqrt(0.5));
            sum += v;
            most = std::max(most, std::fabs(v));
        }
    }
    EXPECT_NEAR(sum / (side * side), 0, 0.01);
    EXPECT_GT(most, 0.45);
    EXPECT_LE(most, std::sqrt(0.5));
}

TEST(PerlinNoise, NumbersOfItemsAreEvenAndTheirOwn) {
    double sum = 0, squares = 0, products = 0;
    constexpr int count = 20000;
    for (std::uint32_t k = 0; k < count; ++k) {
        ItemRandom random{k, 1, 7}, again{k, 1, 7}, other{k, 2, 7};
        const double a = random.next(), b = random.next();
        ASSERT_TRUE(a >= 0 && a < 1);
        ASSERT_EQ(a, again.next());
        ASSERT_NE(a, other.next());
        sum += a;
        squares += a * a;
        products += (a - 0.5) * (b - 0.5);
    }
    EXPECT_NEAR(sum / count, 0.5, 0.01);
    EXPECT_NEAR(squares / count, 1 / 3.0, 0.01);
    EXPECT_NEAR(products / count, 0, 0.003);
}

TEST(Dirt, SeededAndBounded) {
    const LensDirt d = everything();
    const Image<float> light = dirt_transmission(d, 200, 150);
    EXPECT_TRUE(light == dirt_transmission(d, 200, 150));
    LensDirt other = d;
    other.seed = 2;
    EXPECT_FALSE(light == dirt_transmission(other, 200, 150));
    for (const float v : light.pixels)
        ASSERT_TRUE(v >= 0 && v <= 1);
    // The same bits on every machine and compiler.
    EXPECT_EQ(hash_text(Hasher{}.values(light.pixels).state), "c4489d3c45cd9eae");
}

TEST(Dirt, KindsDoNotDisturbEachOther) {
    const Image<float> dust = dirt_transmission(only(&LensDirt::dust, 30), 128, 128);
    LensDirt more = only(&LensDirt::dust, 31);
    more.scratches = 5;
    const Image<float> both = dirt_transmission(more, 128, 128);
    for (std::size_t i = 0; i < dust.pixels.size(); ++i)
        ASSERT_LE(both.pixels[i], dust.pixels[i] + 1e-6f) << "only more is hidden";
    EXPECT_LT(open_area(both.view()), open_area(dust.view()));
}

TEST(Dirt, NothingIsNothing) {
    Aperture aperture = make_aperture({}, 64, 1);
    const Aperture before = aperture;
    EXPECT_FALSE(has_dirt({}));
    add_dirt({}, aperture);
    EXPECT_TRUE(aperture.mask == before.mask);
    EXPECT_EQ(aperture.outline.loops.size(), 1u);
    add_dirt(only(&LensDirt::dust, 3), aperture);
    EXPECT_TRUE(aperture.outline.loops.empty()) << "no longer the opening's";
    EXPECT_FALSE(aperture.mask == before.mask);
    for (std::size_t i = 0; i < before.mask.pixels.size(); ++i)
        ASSERT_LE(aperture.mask.pixels[i], before.mask.pixels[i]);
}

/// Exact coverage: the hidden share does not know the size of the texels.
TEST(Dirt, OfTheSameLookAtEverySize) {
    for (const auto kind : {&LensDirt::dust, &LensDirt::scratches, &LensDirt::eyelashes}) {
        LensDirt d = only(kind, 25);
        d.scratch_width = 0.0007;  // far thinner than a texel of the small mask
        const double coarse = hidden(dirt_transmission(d, 64, 64)) / (64.0 * 64),
                     fine = hidden(dirt_transmission(d, 768, 768)) / (768.0 * 768);
        EXPECT_GT(fine, 1e-3);
        EXPECT_NEAR(coarse / fine, 1, 5e-4);
    }
    // Wide masks show the middle of the square.
    const Image<float> square = dirt_transmission(everything(), 128, 128),
                       wide = dirt_transmission(everything(), 128, 64);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 128; ++x)
            ASSERT_NEAR(wide(x, y), square(x, y + 32), 1e-6);
    }
}

TEST(Dirt, NoiseIsEvenAndIsotropic) {
    LensDirt d;
    d.noise = 0.6;
    d.noise_cell = 1.0 / 48;
    const Image<float> round = dirt_transmission(d, 768, 768);
    EXPECT_NEAR(open_area(round.view()) / (768.0 * 768), 1 - 0.3, 0.005);
    EXPECT_GE(*std::min_element(round.pixels.begin(), round.pixels.end()), 0.4f);
    // 8 texels along the axes and (6, 6) or (-6, 6), 8.5, across them: half a cell.
    const double x = correlation(round, 8, 0), y = correlation(round, 0, 8);
    const double down = correlation(round, 6, 6), up = correlation(round, -6, 6);
    EXPECT_GT(x, 0.1);
    EXPECT_NEAR(x, y, 0.03);
    EXPECT_NEAR(down, up, 0.03);
    EXPECT_NEAR(0.5 * (x + y), 0.5 * (down + up), 0.08);
    EXPECT_NEAR(correlation(round, 40, 0), 0, 0.05);
    // Stretched eightfold along y: the same correlation, farther.
    d.noise_stretch = 8;
    d.noise_angle_deg = 90;
    const Image<float> streaks = dirt_transmission(d, 768, 768);
    EXPECT_NEAR(correlation(streaks, 8, 0), x, 0.1);
    EXPECT_NEAR(correlation(streaks, 0, 64), x, 0.1);
    EXPECT_GT(correlation(streaks, 0, 8), 0.85);
    // Turned to the diagonal.
    d.noise_angle_deg = 45;
    const Image<float> turned = dirt_transmission(d, 768, 768);
    EXPECT_GT(correlation(turned, 6, 6), 0.85);
    EXPECT_LT(correlation(turned, -6, 6), 0.4);
}

TEST(Dirt, GrainsAreDiscs) {
    int inside = 0;
    for (int seed = 1; seed <= 40; ++seed) {
        LensDirt d = only(&LensDirt::dust, 1);
        d.seed = seed;
        d.dust_radius = 0.1;
        const Image<float> light = dirt_transmission(d, 256, 256);
        const double area = hidden(light), largest = 0.1 * 256;
        double x = 0, y = 0, spread = 0;
        bool border = false;
        for (int j = 0; j < 256; ++j) {
            for (int i = 0; i < 256; ++i) {
                const double dark = 1 - static_cast<double>(light(i, j));
                x += dark * (i + 0.5) / area;
                y += dark * (j + 0.5) / area;
                border = border || (dark > 0 && (i == 0 || j == 0 || i == 255 || j == 255));
            }
        }
        if (border) continue;
        ++inside;
        for (int j = 0; j < 256; ++j) {
            for (int i = 0; i < 256; ++i) {
                const double dark = 1 - static_cast<double>(light(i, j));
                // Coverage is the disc blurred by a texel, whose own moment is one sixth.
                spread += dark * ((i + 0.5 - x) * (i + 0.5 - x) + (j + 0.5 - y) * (j + 0.5 - y) - 1 / 6.0);
            }
        }
        EXPECT_GE(area, pi * std::pow(0.15 * largest, 2) * 0.999);
        EXPECT_LE(area, pi * largest * largest * 1.001);
        // A disc has the least moment of inertia of all shapes of this area: A^2 / (2 pi).
        EXPECT_NEAR(spread / (area * area / (2 * pi)), 1, 0.005);
        // Soft ones fade to both sides of the same circle.
        d.dust_softness = 0.6;
        const Image<float> soft = dirt_transmission(d, 256, 256);
        EXPECT_GT(hidden(soft), area);
        EXPECT_LT(hidden(soft), 1.3 * area + 8);
        EXPECT_LT(soft(static_cast<int>(x), static_cast<int>(y)), 0.02f);
    }
    EXPECT_GT(inside, 20);
}

TEST(Dirt, ScratchesAreThinAndTurnAsTold) {
    LensDirt d = only(&LensDirt::scratches, 400);
    d.scratch_spread_deg = 0;
    d.scratch_width = 0.002;
    d.scratch_length = 0.2;
    const Image<float> upright = dirt_transmission(d, 512, 512);
    EXPECT_GT(correlation(upright, 0, 4), 3 * correlation(upright, 4, 0));
    // Mean width 0.7 * 2/3 of the widest, mean length 0.6 of the longest; some lie beyond the border or on
    // each other.
    const double share = hidden(upright) / (512.0 * 512),
                 expected = 400 * 0.002 * 0.7 * (2 / 3.0) * 0.2 * 0.6;
    EXPECT_NEAR(share / expected, 0.9, 0.15);
    d.scratch_spread_deg = 180;
    const Image<float> all_ways = dirt_transmission(d, 512, 512);
    EXPECT_NEAR(correlation(all_ways, 0, 4) / correlation(all_ways, 4, 0), 1, 0.35);
}

TEST(Dirt, EyelashesHangFromAboveAndTaper) {
    LensDirt d = only(&LensDirt::eyelashes, 1);
    d.eyelash_length = 0.5;
    d.eyelash_width = 0.05;
    const Image<float> one = dirt_transmission(d, 512, 512);
    const auto row = [&](const Image<float>& image, int y) {
        double dark = 0;
        for (int x = 0; x < image.width; ++x)
            dark += 1 - static_cast<double>(image(x, y));
        return dark;
    };
    EXPECT_GT(row(one, 0), 0.6 * 0.05 * 512);
    EXPECT_LT(row(one, 0), 1.2 * 0.05 * 512);
    int tip = 0;
    for (int y = 0; y < 512; ++y) {
        if (row(one, y) > 0) tip = y;
    }
    EXPECT_GT(tip, 60);
    EXPECT_LT(tip, 260);
    EXPECT_LT(row(one, tip - 3), 0.4 * row(one, 0));
    d.eyelashes = 30;
    d.eyelash_width = 0.01;
    const Image<float> many = dirt_transmission(d, 512, 512);
    for (int y = 270; y < 512; ++y)
        ASSERT_EQ(row(many, y), 0) << "nothing hangs farther than the longest";
    EXPECT_GT(row(many, 5), 2 * row(many, 180));
}

/// Area that two circles share, `d` apart.
double lens_area(double r, double s, double d) {
    const double a = (d * d + r * r - s * s) / (2 * d), b = d - a;
    return r * r * std::acos(a / r) - a * std::sqrt(r * r - a * a) + s * s * std::acos(b / s) -
           b * std::sqrt(s * s - b * b);
}

// All that the keys allow, on the smallest mask: one row of it holds thousands of edges.
TEST(Dirt, WorkGrowsWithTheEdgesNotWithTheirSquare) {
    const auto work_of = [](int LensDirt::*kind, int count) {
        CoverageWork work;
        coverage_of(dirt_outline(only(kind, count), 64, 64), 64, 64, &work);
        return work;
    };
    for (const auto& [kind, count] :
         {std::pair{&LensDirt::dust, 10000}, {&LensDirt::scratches, 1000}, {&LensDirt::eyelashes, 200}}) {
        const CoverageWork work = work_of(kind, count);
        std::int64_t edges = 0;
        for (const auto& loop : dirt_outline(only(kind, count), 64, 64).loops)
            edges += static_cast<std::int64_t>(loop.size());
        RecordProperty("strands", std::to_string(work.strands));
        // Work that grows with the edges of a row would be thousands of times theirs.
        EXPECT_LT(work.strands, 60 * edges)
            << count << ": " << work.slabs << " slabs, " << work.crossings << " crossings";
        EXPECT_GT(work.crossings, edges / 100);
    }
}

TEST(Occluders, CatsEyeAndEclipse) {
    ApertureShape circle;
    circle.kind = ApertureKind::circle;
    constexpr int size = 400;
    const double r = 0.45 * size, s = 0.4 * size, distance = std::hypot(0.3, 0.1) * size;
    LensDirt d;
    d.occluder = Occluder::housing;
    d.occluder_diameter = 0.8;
    d.occluder_x = 0.3;
    d.occluder_y = -0.1;
    Aperture eye = make_aperture(circle, size, 1), eclipsed = eye;
    const double whole = open_area(eye.mask.view());
    add_dirt(d, eye);
    EXPECT_NEAR(open_area(eye.mask.view()) / lens_area(r, s, distance), 1, 1e-5);
    EXPECT_GT(eye.mask(280, 160), 0) << "right and above of the middle";
    EXPECT_EQ(eye.mask(60, 240), 0);
    d.occluder = Occluder::disc;
    add_dirt(d, eclipsed);
    EXPECT_NEAR(open_area(eclipsed.mask.view()) / (whole - lens_area(r, s, distance)), 1, 1e-5);
    // The same by a mask: whole texels and fractions.
    circle.diameter = 0.8;
    const Image<float> other = make_aperture(circle, size, 1).mask;
    Aperture moved = make_aperture({}, size, 1), exact = moved;
    d.occluder = Occluder::housing;
    add_occluder(other.view(), 120, -40, Occluder::housing, moved);
    add_dirt(d, exact);
    for (std::size_t i = 0; i < exact.mask.pixels.size(); ++i)
        ASSERT_NEAR(moved.mask.pixels[i], exact.mask.pixels[i], 1e-4);
    EXPECT_TRUE(moved.outline.loops.empty());
}

TEST(Occluders, MasksShiftByAreas) {
    Image<float> dot(3, 1, 1.0f);
    Aperture open;
    open.mask = Image<float>(9, 5, 1.0f);
    Aperture shadow = open, slot = open;
    add_occluder(dot.view(), 0.25, -1.5, Occluder::disc, shadow);
    EXPECT_NEAR(hidden(shadow.mask), 3, 1e-6);
    EXPECT_NEAR(shadow.mask(3, 0), 1 - 0.75 * 0.5, 1e-6);
    EXPECT_NEAR(shadow.mask(4, 1), 0.5, 1e-6);
    EXPECT_NEAR(shadow.mask(6, 0), 1 - 0.25 * 0.5, 1e-6);
    EXPECT_EQ(shadow.mask(4, 2), 1);
    add_occluder(dot.view(), 0.25, -1.5, Occluder::housing, slot);
    for (std::size_t i = 0; i < open.mask.pixels.size(); ++i)
        ASSERT_NEAR(slot.mask.pixels[i] + shadow.mask.pixels[i], 1, 1e-6);
    // Far away: all open, all closed.
    shadow = slot = open;
    add_occluder(dot.view(), 1e6, 0, Occluder::disc, shadow);
    add_occluder(dot.view(), 1e6, 0, Occluder::housing, slot);
    EXPECT_EQ(open_area(shadow.mask.view()), 45);
    EXPECT_EQ(open_area(slot.mask.view()), 0);
    add_occluder(dot.view(), 0, 0, Occluder::none, shadow);
    EXPECT_EQ(open_area(shadow.mask.view()), 45);
}

TEST(Dirt, BadNumbersSayWhich) {
    const auto message = [](auto change) -> std::string {
        LensDirt d;
        change(d);
        try {
            dirt_transmission(d, 8, 8);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(message([](LensDirt& d) { d.noise = 1.5; }), "aperture: noise is 1.5, must be 0 to 1");
    EXPECT_EQ(message([](LensDirt& d) { d.dust = -1; }), "aperture: dust is -1, must be 0 to 10000");
    EXPECT_EQ(message([](LensDirt& d) { d.seed = -1; }), "aperture: seed is -1, must be 0 to 2^32 - 1");
    EXPECT_EQ(message([](LensDirt& d) { d.eyelash_width = std::nan(""); }),
              "aperture: eyelash_width is nan, must be above 0 and at most 0.1");
}

}  // namespace
}  // namespace obscura
