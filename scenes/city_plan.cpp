#include "scenes/city_plan.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/random.h"

namespace obscura {
namespace {

constexpr double sidewalk_m = 3.0;

/// [from, to] of the blocks along one axis, with streets between and at both ends.
std::vector<Vec2d> block_lines(double extent_m, double scale, Random& random) {
    const double average = 62 * scale + 11;
    const int count = std::max(1, static_cast<int>(std::floor(extent_m / average + 0.5)));
    std::vector<double> blocks, streets;
    double blocks_sum = 0, streets_sum = 0;
    for (int i = 0; i < count; ++i)
        blocks.push_back(random.range(0.8, 1.25)), blocks_sum += blocks.back();
    for (int i = 0; i <= count; ++i) {
        const bool rim = i == 0 || i == count;
        streets.push_back(rim ? 6 : random.chance(0.3) ? 18 : 11);
        streets_sum += streets.back();
    }
    const double fit = (extent_m - streets_sum) / blocks_sum;
    CHECK(fit > 10);
    std::vector<Vec2d> lines;
    double at = -0.5 * extent_m;
    for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        at += streets[k];
        lines.push_back({at, at + fit * blocks[k]});
        at += fit * blocks[k];
    }
    return lines;
}

/// Lots of about piece_m along a row of length_m: their borders.
std::vector<double> lot_borders(double length_m, double piece_m, Random& random) {
    const int count = std::max(1, static_cast<int>(std::floor(length_m / piece_m + 0.5)));
    std::vector<double> borders{0};
    for (int i = 1; i < count; ++i)
        borders.push_back(length_m * (i + random.range(-0.22, 0.22)) / count);
    borders.push_back(length_m);
    return borders;
}

/// A row of houses along one side of a block. The row starts at (x, z) and runs along the front of a house
/// that has been turned; `outwards` is where the street is.
struct Row {
    Vec2d from, along, inwards;
    double length_m = 0, depth_m = 0;
    int turns = 0;
    bool open_ends = false;  ///< the first and the last house stand on a corner
};

void add_row(CityPlan& plan, const Row& row, double scale, Random& random) {
    const std::vector<double> borders = lot_borders(row.length_m, 14 * scale, random);
    for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
        const double middle = 0.5 * (borders[i] + borders[i + 1]);
        const bool corner = row.open_ends && (i == 0 || i + 2 == borders.size());
        CityItem item;
        item.seed = random.next();
        if (!corner && random.chance(0.04)) continue;  // a gap in the row
        item.depth_m = row.depth_m * (corner ? 1.0 : random.range(0.86, 1.0));
        item.width_m = borders[i + 1] - borders[i];
        const Vec2d p = row.from + row.along * middle + row.inwards * (0.5 * item.depth_m);
        item.x = p.x, item.z = p.y;
        item.turns = row.turns;
        item.detached = corner;
        item.kind = random.chance(0.42) ? CityItemKind::slab : CityItemKind::house;
        plan.items.push_back(item);
    }
}

void add_trees(CityPlan& plan, const CityRect& r, double spacing_m, Random& random) {
    const int nx = std::max(1, static_cast<int>((r.x1 - r.x0) / spacing_m)),
              nz = std::max(1, static_cast<int>((r.z1 - r.z0) / spacing_m));
    for (int j = 0; j < nz; ++j) {
        for (int i = 0; i < nx; ++i) {
            CityItem item;
            item.kind = CityItemKind::tree;
            item.seed = random.next();
            item.x = r.x0 + (r.x1 - r.x0) * (i + 0.5 + random.range(-0.2, 0.2)) / nx;
            item.z = r.z0 + (r.z1 - r.z0) * (j + 0.5 + random.range(-0.2, 0.2)) / nz;
            item.y = 0.15;
            if (random.chance(0.8)) plan.items.push_back(item);
        }
    }
}

/// Lamps and trees along the long sides of a block's sidewalk.
void add_street_furniture(CityPlan& plan, const CityRect& b, Random& random) {
    for (const double z : {b.z0 + 0.7, b.z1 - 0.7}) {
        const int count = static_cast<int>((b.x1 - b.x0) / 11);
        for (int i = 0; i < count; ++i) {
            CityItem item;
            item.kind = i % 2 ? CityItemKind::lamp : CityItemKind::tree;
            item.seed = random.next();
            item.width_m = 2.0;  // a street tree: narrow
            item.x = b.x0 + (b.x1 - b.x0) * (i + 0.5) / count;
            item.z = z, item.y = 0.15;
            plan.items.push_back(item);
        }
    }
}

void fill_block(CityPlan& plan, CityBlock& block, double scale, Random& random, bool tower) {
    const CityRect in{block.area.x0 + sidewalk_m, block.area.x1 - sidewalk_m, block.area.z0 + sidewalk_m,
                      block.area.z1 - sidewalk_m};
    const double w = in.x1 - in.x0, d = in.z1 - in.z0;
    const double shorter = std::min(w, d), depth = std::min(12 * scale, 0.36 * shorter);
    if (tower) {
        CityItem item;
        item.kind = CityItemKind::tower;
        item.seed = random.next();
        item.width_m = std::min(0.86 * w, 46.0 * scale), item.depth_m = std::min(0.86 * d, 46.0 * scale);
        item.x = 0.5 * (in.x0 + in.x1), item.z = 0.5 * (in.z0 + in.z1), item.y = 0.15;
        item.detached = true;
        plan.items.push_back(item);
        return;
    }
    add_row(plan, {{in.x0, in.z1}, {1, 0}, {0, -1}, w, depth, 0, true}, scale, random);
    add_row(plan, {{in.x1, in.z0}, {-1, 0}, {0, 1}, w, depth, 2, true}, scale, random);
    add_row(plan, {{in.x1, in.z1 - depth}, {0, -1}, {-1, 0}, d - 2 * depth, depth, 1, false}, scale, random);
    add_row(plan, {{in.x0, in.z0 + depth}, {0, 1}, {1, 0}, d - 2 * depth, depth, 3, false}, scale, random);
    if (shorter > 2 * depth + 8) {
        block.heart = {in.x0 + depth + 1, in.x1 - depth - 1, in.z0 + depth + 1, in.z1 - depth - 1};
        add_trees(plan, block.heart, 9 * scale, random);
    }
}

}  // namespace

CityPlan plan_city(double extent_m, double scale, std::uint64_t seed) {
    const Random dice(seed);
    Random streets = dice.fork(1), uses = dice.fork(2);
    CityPlan plan;
    plan.extent_m = extent_m;
    const std::vector<Vec2d> xs = block_lines(extent_m, scale, streets),
                             zs = block_lines(extent_m, scale, streets);
    const std::size_t count = xs.size() * zs.size();
    for (const Vec2d z : zs) {
        for (const Vec2d x : xs) {
            CityBlock block{{x.x, x.y, z.x, z.y}, {}, false};
            Random random = dice.fork(1000 + plan.blocks.size());
            const double use = uses.uniform();
            block.square = count >= 4 && use < 0.09;
            if (block.square) {
                const CityRect b = block.area;
                block.heart = {b.x0 + 6, b.x1 - 6, b.z0 + 6, b.z1 - 6};
                add_trees(plan, block.heart, 7.5 * scale, random);
            } else {
                fill_block(plan, block, scale, random, use > 0.86);
            }
            add_street_furniture(plan, block.area, random);
            plan.blocks.push_back(block);
        }
    }
    for (CityItem& item : plan.items)
        item.y = 0.15;
    return plan;
}

}  // namespace obscura
