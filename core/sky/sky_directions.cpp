// Partition of the sky into parts of equal importance.
//
// Hierarchical sample warping (P. Clarberg et al.: Wavelet importance sampling, SIGGRAPH 2005, section 4),
// without samples: the square is halved by importance along one axis, each half along the other, and so on;
// what is left are the parts. Order: D. Hilbert 1891, with the quadrants of this division. Square to
// hemisphere: P. Shirley, K. Chiu: A low distortion map between disk and square, JGT 2(3), 1997.

#include "core/sky/sky_directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "core/error.h"
#include "core/num.h"
#include "core/observer.h"
#include "core/parallel.h"

namespace obscura {

namespace {

constexpr int side = SkyGrid::side;
constexpr double cell_solid_angle = 2 * num::pi / (side * side);

std::size_t cell_index(int x, int y) {
    return static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x);
}

/// The unit direction of a point of the square [-1, 1]^2: radius and azimuth on the disc, then height 1 -
/// radius^2.
Vec3d direction_of(double a, double b) {
    const bool wide = std::abs(a) > std::abs(b);
    const double radius = wide ? a : b;
    if (radius == 0) return {0, 1, 0};
    const double turn_deg = wide ? 45 * (b / a) : 90 - 45 * (a / b);
    const double level = radius * std::sqrt(2 - radius * radius);
    return {level * num::cos_deg(turn_deg), 1 - radius * radius, level * num::sin_deg(turn_deg)};
}

Vec3d direction_of_cell(int x, int y) {
    return direction_of((x + 0.5) * 2 / side - 1, (y + 0.5) * 2 / side - 1);
}

/// The cell below a direction of this height and turn (from +X towards +Z, degrees in [0, 360)).
std::size_t cell_towards(double height, double turn_deg) {
    const double radius = std::sqrt(std::max(0.0, 1 - height));
    const double octant = std::floor((turn_deg + 45) / 90);
    const double across = radius * (turn_deg - 90 * octant) / 45;
    const std::array<Vec2d, 4> sides = {
        {{radius, across}, {-across, radius}, {-radius, -across}, {across, -radius}}};
    const Vec2d at = sides[static_cast<std::size_t>(octant) % 4];
    const auto cell = [](double v) { return std::clamp(static_cast<int>((v + 1) / 2 * side), 0, side - 1); };
    return cell_index(cell(at.x), cell(at.y));
}

void add(SkyCell& cell, Vec3d light, Vec3d direction) {
    cell.red = cell.red + direction * light.x;
    cell.green = cell.green + direction * light.y;
    cell.blue = cell.blue + direction * light.z;
}

SkyCell operator+(const SkyCell& a, const SkyCell& b) {
    return {a.red + b.red, a.green + b.green, a.blue + b.blue};
}

Vec3d balanced(const SkyCell& cell, Vec3d scale) {
    return cell.red * scale.x + cell.green * scale.y + cell.blue * scale.z;
}

/// Vector irradiance of the luminance.
Vec3d luminance_of(const SkyCell& cell) {
    const auto of = [&](double r, double g, double b) { return srgb_luminance({r, g, b}); };
    return {of(cell.red.x, cell.green.x, cell.blue.x), of(cell.red.y, cell.green.y, cell.blue.y),
            of(cell.red.z, cell.green.z, cell.blue.z)};
}

/// [x0, x1) x [y0, y1) of the grid.
struct Part {
    int x0, y0, x1, y1;
};

struct Partition {
    const SkyGrid& grid;
    std::vector<double> importance;  ///< by cell
    double faint;                    ///< light that every cell has at least, for directions of dark parts
    Vec3d balance;                   ///< of the channels: each counts as a share of its own sum
    std::vector<SkyDirection> directions;
};

std::vector<double> importance_of(const SkyGrid& grid, SkyImportance kind) {
    std::vector<double> importance;
    double total = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double radiance = length(luminance_of(grid.cells[cell_index(x, y)]));
            importance.push_back(kind == SkyImportance::radiance ? radiance
                                 : kind == SkyImportance::root   ? std::sqrt(radiance)
                                                                 : direction_of_cell(x, y).y);
            total += importance.back();
        }
    }
    // A black sky, or a black part, is divided evenly.
    const double least = total > 0 ? 1e-6 * total / (side * side) : 1;
    for (double& value : importance)
        value += least;
    return importance;
}

/// Where to cut `sums` in two of nearly equal weight, each at least `least` long.
int middle_of(const std::vector<double>& sums, int least) {
    double total = 0;
    for (const double sum : sums)
        total += sum;
    const int length = static_cast<int>(sums.size());
    int cut = 0;
    double before = 0;
    while (cut < length && before + sums[static_cast<std::size_t>(cut)] / 2 < total / 2)
        before += sums[static_cast<std::size_t>(cut++)];
    return std::clamp(cut, least, length - least);
}

int middle_column(const Partition& p, const Part& part, int least) {
    std::vector<double> sums(static_cast<std::size_t>(part.x1 - part.x0));
    for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; ++x)
            sums[static_cast<std::size_t>(x - part.x0)] += p.importance[cell_index(x, y)];
    }
    return part.x0 + middle_of(sums, least);
}

int middle_row(const Partition& p, const Part& part, int least) {
    std::vector<double> sums(static_cast<std::size_t>(part.y1 - part.y0));
    for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; ++x)
            sums[static_cast<std::size_t>(y - part.y0)] += p.importance[cell_index(x, y)];
    }
    return part.y0 + middle_of(sums, least);
}

/// The part as one distant light, along the middle of its luminance.
SkyDirection light_of(const Partition& p, const Part& part) {
    SkyCell sum;
    Vec3d middle;
    for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; ++x) {
            sum = sum + p.grid.cells[cell_index(x, y)];
            middle = middle + direction_of_cell(x, y);
        }
    }
    const Vec3d direction = normalize(balanced(sum, p.balance) + middle * p.faint);
    const auto facing = [&](Vec3d channel) { return std::max(0.0, dot(channel, direction)); };
    return {direction, to_float(Vec3d{facing(sum.red), facing(sum.green), facing(sum.blue)}),
            cell_solid_angle * (part.x1 - part.x0) * (part.y1 - part.y0)};
}

/// How a quadrant's piece of the Hilbert curve lies: axes exchanged, both axes reversed.
struct Turn {
    bool exchanged = false, reversed = false;
};

/// Divides a part into 4^levels and lists them along the curve.
void divide(Partition& p, const Part& part, int levels, Turn turn) {
    if (levels == 0) {
        p.directions.push_back(light_of(p, part));
        return;
    }
    const int least = 1 << (levels - 1);
    const int column = middle_column(p, part, least);
    const Part left{part.x0, part.y0, column, part.y1}, right{column, part.y0, part.x1, part.y1};
    const int left_row = middle_row(p, left, least), right_row = middle_row(p, right, least);
    const Part quadrant[2][2] = {
        {{left.x0, left.y0, left.x1, left_row}, {left.x0, left_row, left.x1, left.y1}},
        {{right.x0, right.y0, right.x1, right_row}, {right.x0, right_row, right.x1, right.y1}}};
    // The curve's own quadrants in its order; the first and the last are turned.
    struct Piece {
        int x, y;
        bool exchanged, reversed;
    };
    constexpr std::array<Piece, 4> pieces = {
        {{0, 0, true, false}, {0, 1, false, false}, {1, 1, false, false}, {1, 0, true, true}}};
    for (const Piece& piece : pieces) {
        const int flip = turn.reversed ? 1 : 0;
        const int x = (turn.exchanged ? piece.y : piece.x) ^ flip,
                  y = (turn.exchanged ? piece.x : piece.y) ^ flip;
        divide(p, quadrant[x][y], levels - 1,
               {turn.exchanged != piece.exchanged, turn.reversed != piece.reversed});
    }
}

}  // namespace

SkyGrid sky_grid(const std::function<Vec3f(Vec3d)>& radiance, const Exec& exec) {
    SkyGrid grid;
    grid.cells.resize(static_cast<std::size_t>(side) * side);
    parallel_for(side, exec, [&](std::size_t y) {
        for (int x = 0; x < side; ++x) {
            const Vec3d direction = direction_of_cell(x, static_cast<int>(y));
            add(grid.cells[cell_index(x, static_cast<int>(y))],
                to_double(radiance(direction)) * cell_solid_angle, direction);
        }
    });
    return grid;
}

SkyGrid sky_grid(const ImageSky& sky) {
    const Image<Vec3f>& image = sky.pixels;
    // Pixels larger than a cell are taken apart, so that no cell between them stays empty.
    const int finest = 8 * side, across = (finest + image.width - 1) / image.width;
    const int columns = image.width * across, rows = image.height * across;
    SkyGrid grid;
    grid.cells.resize(static_cast<std::size_t>(side) * side);
    std::vector<Vec3d> level;
    std::vector<double> turns;
    for (int i = 0; i < columns; ++i) {
        const double azimuth = sky.left_edge_azimuth_deg + 360 * (i + 0.5) / columns;
        level.push_back({num::sin_deg(azimuth), 0, -num::cos_deg(azimuth)});
        const double turn = (azimuth - 90) / 360;  // from east, which is +X, on to south
        turns.push_back((turn - std::floor(turn)) * 360);
    }
    for (int j = 0; j < rows / 2 + rows % 2; ++j) {
        const double above = num::cos_deg(180.0 * j / rows);
        const double below = std::max(0.0, num::cos_deg(180.0 * (j + 1) / rows));
        const double height = (above + below) / 2, flat = std::sqrt(1 - height * height);
        const double solid_angle = 2 * num::pi / columns * (above - below);
        for (int i = 0; i < columns; ++i) {
            const auto column = static_cast<std::size_t>(i);
            add(grid.cells[cell_towards(height, turns[column])],
                to_double(image(i / across, j / across)) * solid_angle,
                {level[column].x * flat, height, level[column].z * flat});
        }
    }
    return grid;
}

Vec3d unoccluded_irradiance(const SkyGrid& grid, Vec3d normal) {
    Vec3d sum;
    for (const SkyCell& cell : grid.cells) {
        const auto arriving = [&](Vec3d channel) { return std::max(0.0, dot(channel, normal)); };
        sum = sum + Vec3d{arriving(cell.red), arriving(cell.green), arriving(cell.blue)};
    }
    return sum;
}

std::vector<SkyDirection> sky_directions(const SkyGrid& grid, int count, SkyImportance importance) {
    CHECK(count == 16 || count == 64 || count == 256 || count == 1024, fmt::format("count={}", count));
    Vec3d total;
    for (const SkyCell& cell : grid.cells)
        total = total + Vec3d{length(cell.red), length(cell.green), length(cell.blue)};
    const auto share = [](double sum) { return sum > 0 ? 1 / sum : 0; };
    Partition partition{grid,
                        importance_of(grid, importance),
                        1e-9 / (side * side),
                        {share(total.x), share(total.y), share(total.z)},
                        {}};
    int levels = 0;
    while (1 << (2 * levels) < count)
        ++levels;
    divide(partition, {0, 0, side, side}, levels, {});
    return partition.directions;
}

}  // namespace obscura
