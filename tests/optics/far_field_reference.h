#pragma once
// The far field in double, texel by texel, from libm: the oracle of every strategy. And masks to try.

#include <cmath>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "optics/far_field.h"
#include "optics/field/aperture.h"
#include "optics/field/quads.h"

namespace obscura::far_field_reference {

using Complex = std::complex<double>;

inline Complex turn(double t) {
    const double angle = -2 * M_PI * (t - std::round(t));
    return {std::cos(angle), std::sin(angle)};
}
inline double sinc(double t) {
    return t == 0 ? 1.0 : std::sin(M_PI * t) / (M_PI * t);
}

/// F at every pair of frequencies: element [j * u.size() + i] is F(u[i], v[j]).
inline std::vector<Complex> far_field_at(ImageView<const float> mask, const std::vector<double>& u,
                                         const std::vector<double>& v) {
    std::vector<Complex> rows(static_cast<std::size_t>(mask.height) * u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
        std::vector<Complex> phase;
        for (int x = 0; x < mask.width; ++x)
            phase.push_back(turn(u[i] * (x + 0.5 - mask.width * 0.5)) * sinc(u[i]));
        for (int y = 0; y < mask.height; ++y) {
            Complex sum = 0;
            for (int x = 0; x < mask.width; ++x)
                sum += static_cast<double>(mask(x, y)) * phase[static_cast<std::size_t>(x)];
            rows[static_cast<std::size_t>(y) * u.size() + i] = sum;
        }
    }
    std::vector<Complex> field(u.size() * v.size());
    for (std::size_t j = 0; j < v.size(); ++j) {
        for (int y = 0; y < mask.height; ++y) {
            const Complex phase = turn(v[j] * (y + 0.5 - mask.height * 0.5)) * sinc(v[j]);
            for (std::size_t i = 0; i < u.size(); ++i)
                field[j * u.size() + i] += rows[static_cast<std::size_t>(y) * u.size() + i] * phase;
        }
    }
    return field;
}

/// Largest |field - reference| over a grid (every pixel, or about `samples` columns and rows of it), as a
/// share of `unit`.
inline double worst_error(const Field& field, ImageView<const float> mask, const FrequencyGrid& grid,
                          double unit, int samples = 1 << 20) {
    std::vector<int> columns, rows;
    const int step_x = std::max(1, grid.width / samples), step_y = std::max(1, grid.height / samples);
    for (int x = 0; x < grid.width; x += step_x)
        columns.push_back(x);
    for (int y = 0; y < grid.height; y += step_y)
        rows.push_back(y);
    std::vector<double> u, v;
    for (const int x : columns)
        u.push_back(grid.first_u + x * grid.step_u);
    for (const int y : rows)
        v.push_back(grid.first_v + y * grid.step_v);
    const std::vector<Complex> truth = far_field_at(mask, u, v);
    double worst = 0;
    for (std::size_t j = 0; j < rows.size(); ++j) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const Complex ours(static_cast<double>(field.re(columns[i], rows[j])),
                               static_cast<double>(field.im(columns[i], rows[j])));
            worst = std::max(worst, std::abs(ours - truth[j * u.size() + i]));
        }
    }
    return worst / unit;
}

struct NamedMask {
    std::string name;
    Image<float> mask;
};

template <class Inside>
Image<float> mask_where(int width, int height, Inside&& inside) {
    Image<float> mask(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            mask(x, y) = inside(x + 0.5 - width * 0.5, y + 0.5 - height * 0.5) ? 1.0f : 0.0f;
    }
    return mask;
}

inline bool in_heptagon(double x, double y, double radius) {
    for (int k = 0; k < 7; ++k) {
        const double a = 2 * M_PI * k / 7 + 0.3;
        if (x * std::cos(a) + y * std::sin(a) > radius) return false;
    }
    return true;
}

/// The four shapes of the paper, binary, about 0.8 of `size` across.
inline std::vector<NamedMask> four_shapes(int size) {
    const double r = 0.4 * size;
    const auto whirl = [&](double x, double y) {
        const double d = std::hypot(x, y), a = std::atan2(y, x);
        return d < r && std::sin(3 * a + 6 * d / r) > -0.2;
    };
    return {
        {"box",
         mask_where(size, size, [&](double x, double y) { return std::fabs(x) < r && std::fabs(y) < r; })},
        {"circle", mask_where(size, size, [&](double x, double y) { return x * x + y * y < r * r; })},
        {"heptagon", mask_where(size, size, [&](double x, double y) { return in_heptagon(x, y, r); })},
        {"whirl", mask_where(size, size, whirl)},
    };
}

/// Shapes that are easily got wrong.
inline std::vector<NamedMask> odd_masks() {
    std::vector<NamedMask> masks;
    masks.push_back({"one texel", Image<float>(1, 1, 1.0f)});
    Image<float> lone(61, 47);
    lone(60, 3) = 1.0f;
    masks.push_back({"one open texel at the border", lone});
    masks.push_back({"full", Image<float>(33, 20, 1.0f)});
    Image<float> hole(40, 31, 1.0f);
    hole(7, 30) = 0.0f;
    masks.push_back({"one-texel hole", hole});
    Image<float> grey(37, 53);
    std::uint32_t state = 1;
    for (float& texel : grey.pixels) {
        state = state * 1664525u + 1013904223u;
        texel = static_cast<float>(state >> 24) / 255.0f;
    }
    masks.push_back({"grey noise", grey});
    masks.push_back({"disc touching the border",
                     mask_where(48, 64, [](double x, double y) { return x * x + y * y < 32 * 32; })});
    return masks;
}

/// Natural, half, odd and far away; `size` texels across.
inline std::vector<FrequencyGrid> all_grids(int size) {
    int natural = 1;
    while (natural < size)
        natural *= 2;
    const double step = 1.0 / natural;
    FrequencyGrid oblong = centred_grid(23, 50, 0.7 * step);
    oblong.step_v = 0.31 * step;
    return {
        centred_grid(natural, natural, step),
        half_grid(natural, natural, step),
        half_grid(45, 39, 1.3 * step),
        oblong,
        centred_grid(33, 18, step / 1000, 0.21, -0.13),
        centred_grid(20, 17, step / 4, 40.5, 1000.25),
        centred_grid(1, 1, step, 0, 0),
        {19, 22, -9.5 * step, -10.5 * step, step, step},
    };
}

/// A list of one quad per open texel: valid, if long.
inline QuadList texel_quads(ImageView<const float> mask) {
    QuadList list;
    list.columns = mask.width;
    list.rows = mask.height;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (mask(x, y) == 0.0f) continue;
            list.x.push_back(x);
            list.y.push_back(y);
            list.width.push_back(1);
            list.height.push_back(1);
            list.weight.push_back(mask(x, y));
        }
    }
    return list;
}

/// Quads of a plain quadtree: the largest aligned squares of one value, inside the mask.
inline void add_squares(ImageView<const float> mask, int x, int y, int side, QuadList& list) {
    if (x >= mask.width || y >= mask.height) return;
    bool even = x + side <= mask.width && y + side <= mask.height;
    for (int j = y; even && j < y + side; ++j) {
        for (int i = x; i < x + side; ++i)
            even = even && mask(i, j) == mask(x, y);
    }
    if (!even) {
        const int half = side / 2;
        for (const int k : {0, 1, 2, 3})
            add_squares(mask, x + (k & 1) * half, y + (k >> 1) * half, half, list);
        return;
    }
    if (mask(x, y) == 0.0f) return;
    list.x.push_back(x);
    list.y.push_back(y);
    list.width.push_back(side);
    list.height.push_back(side);
    list.weight.push_back(mask(x, y));
}
/// And a rectangle of 3 x 2 finest cells with its opposite, which no plain quadtree has.
inline QuadList tree_quads(ImageView<const float> mask) {
    QuadList list;
    list.columns = mask.width;
    list.rows = mask.height;
    int side = 1;
    while (side < mask.width || side < mask.height)
        side *= 2;
    add_squares(mask, 0, 0, side, list);
    if (open_area(mask) < 400) return list;  // rectangles that cancel must not be the larger part
    for (const float weight : {1.0f, -1.0f}) {
        list.x.push_back(4);
        list.y.push_back(10);
        list.width.push_back(6);
        list.height.push_back(4);
        list.weight.push_back(weight);
    }
    return list;
}

inline Field field_for(const FrequencyGrid& grid) {
    return {Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
}
inline FieldTarget target_of(Field& field) {
    return {field.re.pixels.data(), field.im.pixels.data(), nullptr, field.re.width};
}

}  // namespace obscura::far_field_reference
