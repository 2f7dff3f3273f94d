// Elementary functions against the long double ones of the C library (64-bit mantissa: 2^-11 of our ulp),
// with random and hard arguments, and the special values of C99 annex F.

#include "core/num.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "core/hash.h"

namespace obscura {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

/// Error in units of the last place of the exact value rounded to double.
double ulps(double got, long double exact) {
    const double rounded = static_cast<double>(exact);
    if (got == rounded || (std::isnan(got) && std::isnan(rounded))) {
        if (!std::isfinite(rounded) || rounded == 0) return 0;
    }
    if (!std::isfinite(got) || !std::isfinite(rounded)) return inf;
    const double size = std::fabs(rounded);
    const double ulp = std::max(std::nextafter(size, inf) - size, smallest);
    return static_cast<double>(std::fabs(static_cast<long double>(got) - exact) / ulp);
}

using Argument = std::function<double(std::mt19937_64&)>;

Argument uniform(double low, double high) {
    return [=](std::mt19937_64& random) { return std::uniform_real_distribution<double>(low, high)(random); };
}

/// Sign and magnitude of any size between the powers of two.
Argument any_size(int low_exponent, int high_exponent, bool with_sign) {
    return [=](std::mt19937_64& random) {
        const double mantissa = std::uniform_real_distribution<double>(1.0, 2.0)(random);
        const int exponent = std::uniform_int_distribution<int>(low_exponent, high_exponent)(random);
        return std::ldexp(with_sign && (random() & 1) ? -mantissa : mantissa, exponent);
    };
}

struct Case {
    std::string name;
    double (*ours)(double);
    long double (*exact)(long double);
    Argument argument;
    double limit_ulps;
};

long double sin_deg_exact(long double x) {
    const long double within = std::fmod(x, 360.0L);
    return std::sin(within * 3.14159265358979323846264338327950288L / 180);
}

TEST(Num, RandomArgumentsStayWithinTheStatedError) {
    using L = long double;
    const auto lsin = [](L x) { return std::sin(x); };
    const auto lcos = [](L x) { return std::cos(x); };
    const auto ltan = [](L x) { return std::tan(x); };
    const auto lasin = [](L x) { return std::asin(x); };
    const auto lacos = [](L x) { return std::acos(x); };
    const auto latan = [](L x) { return std::atan(x); };
    const auto lexp = [](L x) { return std::exp(x); };
    const auto lexp2 = [](L x) { return std::exp2(x); };
    const auto llog = [](L x) { return std::log(x); };
    const auto llog2 = [](L x) { return std::log2(x); };
    const auto lcbrt = [](L x) { return std::cbrt(x); };
    const Case cases[] = {
        {"sin small", num::sin, lsin, uniform(-4, 4), 1},
        {"sin", num::sin, lsin, uniform(-1e6, 1e6), 1},
        {"sin tiny", num::sin, lsin, any_size(-1070, 2, true), 1},
        {"cos small", num::cos, lcos, uniform(-4, 4), 1},
        {"cos", num::cos, lcos, uniform(-1e6, 1e6), 1},
        {"tan small", num::tan, ltan, uniform(-4, 4), 1},
        {"tan", num::tan, ltan, uniform(-1e6, 1e6), 1},
        {"sin_deg", num::sin_deg, sin_deg_exact, uniform(-90, 90), 1},
        {"asin", num::asin, lasin, uniform(-1, 1), 1},
        {"asin sizes", num::asin, lasin, any_size(-1070, -1, true), 1},
        {"asin near 1", num::asin, lasin, uniform(0.999999, 1), 1},
        {"acos", num::acos, lacos, uniform(-1, 1), 1},
        {"acos near 1", num::acos, lacos, uniform(0.999999, 1), 1},
        {"atan", num::atan, latan, uniform(-4, 4), 1},
        {"atan sizes", num::atan, latan, any_size(-1070, 1000, true), 1},
        {"exp", num::exp, lexp, uniform(-745, 709.7), 1},
        {"exp near 0", num::exp, lexp, any_size(-60, 0, true), 1},
        {"exp2", num::exp2, lexp2, uniform(-1074, 1023.9), 1},
        {"log", num::log, llog, any_size(-1074, 1023, false), 1},
        {"log near 1", num::log, llog, uniform(0.6, 1.6), 1},
        {"log2", num::log2, llog2, any_size(-1074, 1023, false), 1},
        {"log2 near 1", num::log2, llog2, uniform(0.6, 1.6), 1},
        {"cbrt", num::cbrt, lcbrt, any_size(-1070, 1023, true), 1},
    };
    for (const Case& c : cases) {
        std::mt19937_64 random(1);
        double worst = 0, at = 0;
        for (int i = 0; i < 100'000; ++i) {
            const double x = c.argument(random);
            const double error = ulps(c.ours(x), c.exact(x));
            if (error > worst) worst = error, at = x;
        }
        EXPECT_LE(worst, c.limit_ulps) << c.name << " at " << at;
        RecordProperty(c.name, std::to_string(worst));
    }
}

TEST(Num, NeighboursOfMultiplesOfHalfPiKeepTheirSmallRemainder) {
    double worst = 0;
    for (int n = 1; n <= 636'000; n += (n < 2000 ? 1 : 37)) {
        const double near = static_cast<double>(n * 1.57079632679489661923132169163975144L);
        for (const double x : {near, std::nextafter(near, inf), std::nextafter(near, -inf), -near}) {
            const long double exact = x;
            worst = std::max({worst, ulps(num::sin(x), std::sin(exact)), ulps(num::cos(x), std::cos(exact))});
        }
    }
    EXPECT_LE(worst, 1.0);
}

TEST(Num, PowStaysWithinOneUlp) {
    std::mt19937_64 random(2);
    double worst = 0;
    for (int i = 0; i < 300'000; ++i) {
        const double x = any_size(-1074, 1023, false)(random);
        // Exponents that keep the result in range, small and large.
        const double y = uniform(-1, 1)(random) * 740 / std::max(std::fabs(std::log(x)), 1e-3);
        worst = std::max(worst, ulps(num::pow(x, y), std::pow(static_cast<long double>(x), y)));
    }
    for (int i = 0; i < 100'000; ++i) {  // next to 1, huge exponents
        const double x = 1.0 + uniform(-1e-6, 1e-6)(random);
        const double y = uniform(-7e8, 7e8)(random);
        worst = std::max(worst, ulps(num::pow(x, y), std::pow(static_cast<long double>(x), y)));
    }
    EXPECT_LE(worst, 1.0);
}

TEST(Num, Atan2StaysWithinOneUlpInEveryQuadrant) {
    std::mt19937_64 random(3);
    const Argument size = any_size(-1060, 1020, true), near = any_size(-40, 40, true);
    double worst = 0;
    for (int i = 0; i < 200'000; ++i) {
        const double y = (i & 1 ? size : near)(random), x = (i & 1 ? size : near)(random);
        worst = std::max(worst, ulps(num::atan2(y, x), std::atan2(static_cast<long double>(y), x)));
    }
    EXPECT_LE(worst, 1.0);
}

void expect_same(double got, double expected, const char* what) {
    if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(got)) << what << " is " << got;
    } else {
        EXPECT_EQ(got, expected) << what;
        EXPECT_EQ(std::signbit(got), std::signbit(expected)) << what;
    }
}
#define EXPECT_SAME(expression, expected) expect_same(expression, expected, #expression)

TEST(Num, SpecialValuesOfTrigonometry) {
    EXPECT_SAME(num::sin(0.0), 0.0);
    EXPECT_SAME(num::sin(-0.0), -0.0);
    EXPECT_SAME(num::tan(-0.0), -0.0);
    EXPECT_SAME(num::cos(0.0), 1.0);
    EXPECT_SAME(num::sin(inf), nan);
    EXPECT_SAME(num::cos(-inf), nan);
    EXPECT_SAME(num::tan(nan), nan);
    EXPECT_SAME(num::asin(1.0), num::pi / 2);
    EXPECT_SAME(num::asin(-1.0), -num::pi / 2);
    EXPECT_SAME(num::asin(-0.0), -0.0);
    EXPECT_SAME(num::asin(1.0000001), nan);
    EXPECT_SAME(num::acos(1.0), 0.0);
    EXPECT_SAME(num::acos(-1.0), num::pi);
    EXPECT_SAME(num::acos(0.0), num::pi / 2);
    EXPECT_SAME(num::acos(-2.0), nan);
    EXPECT_SAME(num::atan(inf), num::pi / 2);
    EXPECT_SAME(num::atan(-inf), -num::pi / 2);
    EXPECT_SAME(num::atan(-0.0), -0.0);
    EXPECT_SAME(num::atan(1.0), num::pi / 4);
    EXPECT_SAME(num::atan(nan), nan);
}

TEST(Num, QuadrantsAndAxesOfAtan2) {
    EXPECT_SAME(num::atan2(0.0, 1.0), 0.0);
    EXPECT_SAME(num::atan2(-0.0, 1.0), -0.0);
    EXPECT_SAME(num::atan2(0.0, -1.0), num::pi);
    EXPECT_SAME(num::atan2(-0.0, -1.0), -num::pi);
    EXPECT_SAME(num::atan2(0.0, 0.0), 0.0);
    EXPECT_SAME(num::atan2(-0.0, 0.0), -0.0);
    EXPECT_SAME(num::atan2(0.0, -0.0), num::pi);
    EXPECT_SAME(num::atan2(1.0, 0.0), num::pi / 2);
    EXPECT_SAME(num::atan2(-1.0, -0.0), -num::pi / 2);
    EXPECT_SAME(num::atan2(1.0, 1.0), num::pi / 4);
    EXPECT_SAME(num::atan2(1.0, -1.0), 3 * num::pi / 4);
    EXPECT_SAME(num::atan2(-1.0, -1.0), -3 * num::pi / 4);
    EXPECT_SAME(num::atan2(inf, inf), num::pi / 4);
    EXPECT_SAME(num::atan2(-inf, -inf), -3 * num::pi / 4);
    EXPECT_SAME(num::atan2(1.0, inf), 0.0);
    EXPECT_SAME(num::atan2(-1.0, -inf), -num::pi);
    EXPECT_SAME(num::atan2(inf, 3.0), num::pi / 2);
    EXPECT_SAME(num::atan2(smallest, 2.0), 0.0);
    EXPECT_SAME(num::atan2(nan, 1.0), nan);
}

TEST(Num, DegreesAreExactAtRightAngles) {
    for (int n = -1000; n <= 1000; ++n) {
        const double deg = 90.0 * n;
        const int quadrant = ((n % 4) + 4) % 4;
        constexpr double sines[4] = {0, 1, 0, -1};
        EXPECT_EQ(num::sin_deg(deg), sines[quadrant]) << deg;
        EXPECT_EQ(num::cos_deg(deg), sines[(quadrant + 1) % 4]) << deg;
    }
    EXPECT_EQ(num::sin_deg(30.0), 0.5);
    EXPECT_EQ(num::cos_deg(60.0), 0.5);
    EXPECT_EQ(num::sin_deg(9e15 + 30.0), num::sin_deg(std::fmod(9e15 + 30.0, 360.0)));
    EXPECT_SAME(num::sin_deg(inf), nan);
}

TEST(Num, SpecialValuesOfExponentials) {
    EXPECT_SAME(num::exp(0.0), 1.0);
    EXPECT_SAME(num::exp(-0.0), 1.0);
    EXPECT_SAME(num::exp(inf), inf);
    EXPECT_SAME(num::exp(-inf), 0.0);
    EXPECT_SAME(num::exp(709.79), inf);
    EXPECT_SAME(num::exp(-745.2), 0.0);
    EXPECT_SAME(num::exp(-745.1), smallest);
    EXPECT_SAME(num::exp(nan), nan);
    for (int k = -1074; k <= 1023; ++k) {
        EXPECT_EQ(num::exp2(k), std::ldexp(1.0, k));
        EXPECT_EQ(num::log2(std::ldexp(1.0, k)), k);
    }
    EXPECT_SAME(num::exp2(1024.0), inf);
    EXPECT_SAME(num::exp2(-1080.0), 0.0);
    EXPECT_SAME(num::log(1.0), 0.0);
    EXPECT_SAME(num::log(0.0), -inf);
    EXPECT_SAME(num::log(-0.0), -inf);
    EXPECT_SAME(num::log(-1.0), nan);
    EXPECT_SAME(num::log(inf), inf);
    EXPECT_SAME(num::log2(nan), nan);
    for (int k = -300; k <= 300; ++k) {
        EXPECT_EQ(num::cbrt(static_cast<double>(k) * k * k), k);
    }
    EXPECT_SAME(num::cbrt(-0.0), -0.0);
    EXPECT_SAME(num::cbrt(-inf), -inf);
}

TEST(Num, SpecialValuesOfPow) {
    for (const double x : {0.0, -0.0, 1.0, -3.0, inf, nan})
        EXPECT_SAME(num::pow(x, 0.0), 1.0);
    for (const double y : {1.5, -inf, inf, nan})
        EXPECT_SAME(num::pow(1.0, y), 1.0);
    EXPECT_SAME(num::pow(nan, 1.0), nan);
    EXPECT_SAME(num::pow(2.0, nan), nan);
    EXPECT_SAME(num::pow(0.0, 3.0), 0.0);
    EXPECT_SAME(num::pow(-0.0, 3.0), -0.0);
    EXPECT_SAME(num::pow(-0.0, 2.0), 0.0);
    EXPECT_SAME(num::pow(-0.0, -3.0), -inf);
    EXPECT_SAME(num::pow(0.0, -0.5), inf);
    EXPECT_SAME(num::pow(-inf, 3.0), -inf);
    EXPECT_SAME(num::pow(-inf, -3.0), -0.0);
    EXPECT_SAME(num::pow(inf, 0.5), inf);
    EXPECT_SAME(num::pow(-1.0, inf), 1.0);
    EXPECT_SAME(num::pow(0.5, inf), 0.0);
    EXPECT_SAME(num::pow(0.5, -inf), inf);
    EXPECT_SAME(num::pow(-2.0, 3.0), -8.0);
    EXPECT_SAME(num::pow(-2.0, 0.5), nan);
    EXPECT_SAME(num::pow(10.0, 22.0), 1e22);
    EXPECT_SAME(num::pow(3.0, 33.0), 5559060566555523.0);
    EXPECT_SAME(num::pow(0.25, 0.5), 0.5);
    EXPECT_SAME(num::pow(1.5, 1e300), inf);
    EXPECT_SAME(num::pow(-1.5, 1e300), inf);
    EXPECT_SAME(num::pow(std::nextafter(1.0, 0.0), 1e300), 0.0);
}

TEST(Num, BitsAreTheSameOnEveryMachine) {
    // One hash over all functions, for every compiler, build type and CPU.
    std::uint64_t state = 1;
    Hasher hash;
    for (int i = 0; i < 20'000; ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const double u = static_cast<double>(state >> 11) * 0x1p-53;
        const double x = (u - 0.5) * 2000;
        for (const double value :
             {num::sin(x), num::cos(x), num::tan(x), num::sin_deg(x), num::asin(2 * u - 1),
              num::acos(2 * u - 1), num::atan(x), num::atan2(u - 0.3, u * u - 0.4), num::exp(0.7 * x),
              num::exp2(x), num::log(u), num::log2(u), num::pow(u, 2.4), num::cbrt(x)}) {
            hash.value(value);
        }
    }
    EXPECT_EQ(hash_text(hash.state), "25223ac3bf764f90");
}

}  // namespace
}  // namespace obscura
