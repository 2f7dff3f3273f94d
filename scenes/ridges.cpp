#include "scenes/ridges.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/random.h"

namespace obscura {
namespace {

using Heights = Image<double>;

/// In [0, 1].
Heights displaced_midpoints(const RidgesParams& p, Random random) {
    const int side = (1 << p.side_log2) + 1;
    Heights h(side, side);
    for (const int y : {0, side - 1}) {
        for (const int x : {0, side - 1})
            h(x, y) = random.range(-1, 1);
    }
    double reach = 1;
    for (int step = side - 1; step >= 2; step /= 2, reach *= p.roughness) {
        const int half = step / 2;
        for (int y = half; y < side; y += step) {
            for (int x = half; x < side; x += step) {
                const double mean = 0.25 * (h(x - half, y - half) + h(x + half, y - half) +
                                            h(x - half, y + half) + h(x + half, y + half));
                h(x, y) = mean + random.range(-reach, reach);
            }
        }
        for (int y = 0; y < side; y += half) {
            for (int x = (y / half) % 2 == 0 ? half : 0; x < side; x += step) {
                double sum = 0;
                int count = 0;
                const auto add = [&](int i, int j) {
                    if (i < 0 || j < 0 || i >= side || j >= side) return;
                    sum += h(i, j);
                    ++count;
                };
                add(x - half, y), add(x + half, y), add(x, y - half), add(x, y + half);
                h(x, y) = sum / count + random.range(-reach, reach);
            }
        }
    }
    const auto [least, most] = std::minmax_element(h.pixels.begin(), h.pixels.end());
    const double low = *least, range = *most - *least;
    for (double& v : h.pixels)
        v = (v - low) / range;
    return h;
}

/// Height and gradient between samples, bilinear.
struct Ground {
    double height, dx, dy;
};

Ground ground_at(const Heights& h, double x, double y) {
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const double u = x - i, v = y - j;
    const double a = h(i, j), b = h(i + 1, j), c = h(i, j + 1), d = h(i + 1, j + 1);
    return {a * (1 - u) * (1 - v) + b * u * (1 - v) + c * (1 - u) * v + d * u * v,
            (b - a) * (1 - v) + (d - c) * v, (c - a) * (1 - u) + (d - b) * u};
}

/// Adds to the four samples around a point, by their nearness.
void add_around(Heights& h, double x, double y, double amount) {
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const double u = x - i, v = y - j;
    h(i, j) += amount * (1 - u) * (1 - v);
    h(i + 1, j) += amount * u * (1 - v);
    h(i, j + 1) += amount * (1 - u) * v;
    h(i + 1, j + 1) += amount * u * v;
}

/// Takes away around a point, by nearness within three cells: where single samples were worn, the rest would
/// be left standing as needles.
void wear_around(Heights& h, double x, double y, double amount) {
    constexpr int reach = 3;
    const auto weigh = [&](int i, int j) {
        return std::max(0.0, reach - std::sqrt((i - x) * (i - x) + (j - y) * (j - y)));
    };
    const int i0 = std::max(0, static_cast<int>(x) - reach + 1),
              j0 = std::max(0, static_cast<int>(y) - reach + 1);
    const int i1 = std::min(h.width - 1, static_cast<int>(x) + reach),
              j1 = std::min(h.height - 1, static_cast<int>(y) + reach);
    double sum = 0;
    for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i)
            sum += weigh(i, j);
    }
    for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i)
            h(i, j) -= amount * weigh(i, j) / sum;
    }
}

/// One drop, from where it falls until it leaves the grid, lies still or has dried up. Heights are shares of
/// the whole.
void run_drop(Heights& h, Random& random) {
    constexpr double inertia = 0.1, capacity = 1, least_slope = 0.0005, erosion = 0.2, deposition = 0.1,
                     drying = 0.98, gravity = 1;
    constexpr int longest = 120;
    const double inner = h.width - 1.001;
    double x = random.range(0, inner), y = random.range(0, inner), dx = 0, dy = 0;
    double speed = 1, water = 1, load = 0;
    for (int step = 0; step < longest; ++step) {
        const Ground here = ground_at(h, x, y);
        dx = dx * inertia - here.dx * (1 - inertia);
        dy = dy * inertia - here.dy * (1 - inertia);
        const double length = std::sqrt(dx * dx + dy * dy);
        if (length < 1e-12) return;
        dx /= length, dy /= length;
        const double next_x = x + dx, next_y = y + dy;
        if (next_x < 0 || next_y < 0 || next_x >= inner || next_y >= inner) return;
        const double fall = here.height - ground_at(h, next_x, next_y).height;
        const double carried = std::max(fall, least_slope) * speed * water * capacity;
        if (fall < 0) {
            // Into a hollow: fill it as far as the load goes.
            const double dropped = std::min(-fall, load);
            add_around(h, x, y, dropped);
            load -= dropped;
        } else if (load > carried) {
            const double dropped = (load - carried) * deposition;
            add_around(h, x, y, dropped);
            load -= dropped;
        } else {
            const double taken = std::min((carried - load) * erosion, fall);
            wear_around(h, x, y, taken);
            load += taken;
        }
        speed = std::sqrt(std::max(0.0, speed * speed + fall * gravity));
        water *= drying;
        x = next_x, y = next_y;
    }
}

/// What drops have left standing or dug out sample by sample slides down: means of each sample and those
/// around it.
void settle(Heights& h) {
    const Heights before = h;
    for (int y = 0; y < h.height; ++y) {
        for (int x = 0; x < h.width; ++x) {
            double sum = 0, weights = 0;
            for (int j = std::max(0, y - 1); j <= std::min(h.height - 1, y + 1); ++j) {
                for (int i = std::max(0, x - 1); i <= std::min(h.width - 1, x + 1); ++i) {
                    const double weight = (i == x ? 4 : 1) * (j == y ? 4 : 1);
                    sum += weight * before(i, j);
                    weights += weight;
                }
            }
            h(x, y) = sum / weights;
        }
    }
}

}  // namespace

Image<std::uint16_t> ridges(const RidgesParams& params) {
    CHECK(params.side_log2 >= 3 && params.side_log2 <= 12 && params.height_m > 0);
    CHECK(params.roughness > 0 && params.roughness < 1 && params.drops >= 0);
    Random random(static_cast<std::uint64_t>(params.seed));
    Heights h = displaced_midpoints(params, random.fork(1));
    // Valleys are wider than summits.
    for (double& v : h.pixels)
        v = v * (0.25 + 0.75 * v);
    Random weather = random.fork(2);
    for (int i = 0; i < params.drops; ++i)
        run_drop(h, weather);

    settle(h);

    const double low = *std::min_element(h.pixels.begin(), h.pixels.end());
    Image<std::uint16_t> codes(h.width, h.height);
    std::transform(h.pixels.begin(), h.pixels.end(), codes.pixels.begin(), [&](double v) {
        const double code = (v - low) * params.height_m / ridges_step_m + 0.5;
        return static_cast<std::uint16_t>(std::clamp(code, 0.0, 65535.0));
    });
    return codes;
}

}  // namespace obscura
