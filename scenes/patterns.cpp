#include "scenes/patterns.h"

#include <cmath>

#include "core/vec.h"
#include "scenes/random.h"

namespace obscura {
namespace {

/// Random value of a lattice point that repeats every (nx, ny) points.
double lattice(int x, int y, int nx, int ny, std::uint64_t seed) {
    const auto wrap = [](int a, int n) { return static_cast<std::uint64_t>((a % n + n) % n); };
    return Random(seed * 7919 + wrap(x, nx) * 1009 + wrap(y, ny)).fork(3).uniform();
}

/// Smooth noise in [0, 1], seamless over the unit square with nx x ny cells in it.
double noise(double u, double v, int nx, int ny, std::uint64_t seed) {
    const double x = u * nx, y = v * ny, fx = x - std::floor(x), fy = y - std::floor(y);
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const double sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
    const double a = lattice(i, j, nx, ny, seed), b = lattice(i + 1, j, nx, ny, seed);
    const double c = lattice(i, j + 1, nx, ny, seed), d = lattice(i + 1, j + 1, nx, ny, seed);
    return (a + (b - a) * sx) * (1 - sy) + (c + (d - c) * sx) * sy;
}

/// Grain that runs along u: broad bands, fine fibres. In [0, 1].
double grain(double u, double v, std::uint64_t seed) {
    const double bands = noise(u, v + 0.06 * noise(u, v, 2, 3, seed + 1), 2, 14, seed + 2);
    return 0.62 * bands + 0.38 * noise(u, v, 6, 90, seed + 3);
}

/// sRGB in 0..255 between two paints, in steps of 8 so that the files stay small.
Rgb8 paint(Vec3d dark, Vec3d light, double t) {
    const auto channel = [&](double a, double b) {
        return static_cast<std::uint8_t>(8 * std::floor((a + (b - a) * t) / 8));
    };
    return {channel(dark.x, light.x), channel(dark.y, light.y), channel(dark.z, light.z)};
}

/// The pattern at size x size pixels, each the mean of grid x grid points.
template <class F>
Image<Rgb8> picture(int size, int grid, F&& colour) {
    Image<Rgb8> image(size, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            int r = 0, g = 0, b = 0;
            for (int k = 0; k < grid * grid; ++k) {
                const int i = k % grid, j = k / grid;
                const double u = (x + (i + 0.5) / grid) / size, v = (y + (j + 0.5) / grid) / size;
                const Rgb8 c = colour(u, v);
                r += c.r, g += c.g, b += c.b;
            }
            const auto mean = [&](int sum) { return static_cast<std::uint8_t>(sum / (grid * grid)); };
            image(x, y) = {mean(r), mean(g), mean(b)};
        }
    }
    return image;
}

Rgb8 wood(double u, double v) {
    return paint({140, 96, 60}, {206, 162, 112}, grain(u, v, 11));
}

/// Squares of 25 cm, each of four strips that lie across those of its neighbours.
Rgb8 parquet(double u, double v) {
    const int i = static_cast<int>(u * 4), j = static_cast<int>(v * 4);
    const bool turned = (i + j) % 2;
    const double along = turned ? v : u, across = turned ? u : v;
    const double strip = across * 16 - std::floor(across * 16), place = along * 4 - std::floor(along * 4);
    const double edge = 0.04;
    if (strip < edge || strip > 1 - edge || place < 0.25 * edge || place > 1 - 0.25 * edge)
        return {72, 48, 32};
    const int number = static_cast<int>(across * 16) * 4 + static_cast<int>(along * 4);
    const double tint = lattice(number, turned, 64, 2, 5);
    return paint({116, 76, 46}, {200, 148, 98}, 0.25 + 0.35 * tint + 0.4 * grain(along, across, 21) - 0.1);
}

/// Glazed tiles: quarter circles in blue around a diamond, mirrored from tile to tile.
Rgb8 tiles(double u, double v) {
    double x = u * 4 - std::floor(u * 4), y = v * 4 - std::floor(v * 4);
    if (x < 0.02 || y < 0.02 || x > 0.98 || y > 0.98) return {150, 144, 132};
    if (static_cast<int>(u * 4) % 2) x = 1 - x;
    if (static_cast<int>(v * 4) % 2) y = 1 - y;
    const double r = std::sqrt(x * x + y * y), diamond = std::fabs(x - 0.5) + std::fabs(y - 0.5);
    if ((r > 0.40 && r < 0.47) || (r > 0.84 && r < 0.95)) return {36, 72, 140};
    if (r < 0.30 || (diamond < 0.16 && r > 0.5)) return {70, 118, 180};
    if (r > 0.52 && r < 0.58) return {214, 168, 72};
    return {238, 234, 222};
}

/// Checks: white and blue threads, crossing.
Rgb8 cloth(double u, double v) {
    const bool across = static_cast<int>(u * 16) % 2, up = static_cast<int>(v * 16) % 2;
    const bool over = (static_cast<int>(u * 128) + static_cast<int>(v * 128)) % 2;
    const bool blue = over ? across : up;
    const double shade = over ? 1.0 : 0.93;
    return paint({0, 0, 0}, blue ? Vec3d{60, 92, 148} : Vec3d{240, 236, 226}, shade);
}

Rgb8 checks(double u, double v) {
    const bool white = (static_cast<int>(u * 8) + static_cast<int>(v * 8)) % 2;
    return white ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0};
}

struct Lash {
    double root = 0, tip = 0, bend = 0, width = 0;
};

/// Tapered hairs of about 0.1 mm that hang down from the upper lid and bend outwards. Units: half pupils.
std::vector<Lash> lashes() {
    constexpr int count = 11;
    std::vector<Lash> all;
    for (int i = 0; i < count; ++i) {
        Random dice = Random(41).fork(static_cast<std::uint64_t>(i));
        Lash& lash = all.emplace_back();
        lash.root = -1.05 + 2.1 * (i + dice.range(0.2, 0.8)) / count;
        lash.tip = dice.range(-0.25, 0.75);
        lash.bend = 0.34 * lash.root + dice.range(-0.1, 0.1);
        lash.width = dice.range(0.018, 0.03);
    }
    return all;
}

/// The pupil of a screwed-up eye, 5 mm wide, behind its lashes. White is open.
Rgb8 eye(double u, double v) {
    static const std::vector<Lash> all = lashes();
    constexpr Rgb8 open{255, 255, 255}, closed{0, 0, 0};
    const double x = 2 * u - 1, y = 2 * v - 1;
    if (x * x + y * y > 1) return closed;
    for (const Lash& lash : all) {
        const double along = (y + 1.1) / (lash.tip + 1.1);
        if (along > 1) continue;
        if (std::fabs(x - lash.root - lash.bend * along * along) < lash.width * (1 - 0.75 * along))
            return closed;
    }
    return open;
}

}  // namespace

std::vector<Pattern> patterns() {
    return {
        {"textures/wood.png", picture(256, 1, wood)},   {"textures/parquet.png", picture(256, 1, parquet)},
        {"textures/tiles.png", picture(512, 4, tiles)}, {"textures/cloth.png", picture(128, 1, cloth)},
        {"textures/eye.png", picture(2048, 2, eye)},    {"tests/checks.png", picture(64, 1, checks)}};
}

}  // namespace obscura
