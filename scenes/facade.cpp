#include "scenes/facade.h"

#include "core/error.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// Grid lines 0, every opening's borders, length.
std::vector<double> grid_lines(const std::vector<Vec2d>& openings, double length_m) {
    std::vector<double> lines{0};
    for (const Vec2d o : openings) {
        CHECK(o.x > lines.back() && o.y > o.x);
        lines.push_back(o.x), lines.push_back(o.y);
    }
    CHECK(length_m > lines.back());
    lines.push_back(length_m);
    return lines;
}

/// A front: its lower left corner seen from outside, unit steps to the right and outwards.
struct Front {
    Vec3d corner, right, out;
    Vec3d at(double u, double v, double in) const { return corner + right * u + Vec3d{0, v, 0} - out * in; }
};

/// The wall cells of a front, and for each window its four reveals down to `reveal_m`.
void add_front(Mesh& m, const Front& f, const std::vector<double>& us, const std::vector<double>& vs,
               double reveal_m, std::uint32_t slot) {
    for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        for (std::size_t i = 0; i + 1 < us.size(); ++i) {
            const double u0 = us[i], u1 = us[i + 1], v0 = vs[j], v1 = vs[j + 1], in = reveal_m;
            if (i % 2 == 0 || j % 2 == 0) {
                add_facet(m, {f.at(u0, v0, 0), f.at(u1, v0, 0), f.at(u1, v1, 0), f.at(u0, v1, 0)}, slot);
                continue;
            }
            add_facet(m, {f.at(u0, v0, 0), f.at(u1, v0, 0), f.at(u1, v0, in), f.at(u0, v0, in)}, slot);
            add_facet(m, {f.at(u0, v1, in), f.at(u1, v1, in), f.at(u1, v1, 0), f.at(u0, v1, 0)}, slot);
            add_facet(m, {f.at(u0, v0, 0), f.at(u0, v0, in), f.at(u0, v1, in), f.at(u0, v1, 0)}, slot);
            add_facet(m, {f.at(u1, v0, in), f.at(u1, v0, 0), f.at(u1, v1, 0), f.at(u1, v1, in)}, slot);
        }
    }
}

void add_panes(Mesh& m, const Front& f, const std::vector<double>& us, const std::vector<double>& vs,
               double in, std::uint32_t slot) {
    for (std::size_t j = 1; j + 1 < vs.size(); j += 2) {
        for (std::size_t i = 1; i + 1 < us.size(); i += 2) {
            add_facet(m,
                      {f.at(us[i], vs[j], in), f.at(us[i + 1], vs[j], in), f.at(us[i + 1], vs[j + 1], in),
                       f.at(us[i], vs[j + 1], in)},
                      slot);
        }
    }
}

/// Floor or lid over the rectangle: a fan from its centre over all grid points of its rim.
void add_lid(Mesh& m, const std::vector<Vec3d>& rim, Vec3d centre, bool up, std::uint32_t slot) {
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const Vec3d a = rim[i], b = rim[(i + 1) % rim.size()];
        add_facet(m, {centre, up ? a : b, up ? b : a}, slot);
    }
}

}  // namespace

std::vector<Vec2d> even_openings(double length_m, int count, double window_m) {
    std::vector<Vec2d> openings;
    for (int i = 0; i < count; ++i) {
        const double middle = length_m * (i + 0.5) / count;
        openings.push_back({middle - 0.5 * window_m, middle + 0.5 * window_m});
    }
    return openings;
}

Mesh building_body(const BodyParams& p, std::uint32_t wall_slot, std::uint32_t pane_slot) {
    const double w = 0.5 * p.width_m, d = 0.5 * p.depth_m;
    Mesh m;
    if (p.wide.rows.empty() || (p.wide.columns.empty() && p.deep.columns.empty())) {
        add_part(m, box({-w, 0, -d}, {w, p.height_m, d}), {}, wall_slot);
        return m;
    }
    const std::vector<double> vs = grid_lines(p.wide.rows, p.height_m);
    const Front fronts[4] = {{{-w, 0, d}, {1, 0, 0}, {0, 0, 1}},
                             {{w, 0, d}, {0, 0, -1}, {1, 0, 0}},
                             {{w, 0, -d}, {-1, 0, 0}, {0, 0, -1}},
                             {{-w, 0, -d}, {0, 0, 1}, {-1, 0, 0}}};
    std::vector<Vec3d> floor, roof;
    for (int side = 0; side < 4; ++side) {
        const bool wide = side % 2 == 0;
        const std::vector<double> us =
            grid_lines((wide ? p.wide : p.deep).columns, wide ? p.width_m : p.depth_m);
        add_front(m, fronts[side], us, vs, p.reveal_m, wall_slot);
        add_panes(m, fronts[side], us, vs, p.reveal_m, pane_slot);
        for (std::size_t i = 0; i + 1 < us.size(); ++i) {
            floor.push_back(fronts[side].at(us[i], 0, 0));
            roof.push_back(fronts[side].at(us[i], p.height_m, 0));
        }
    }
    add_lid(m, floor, {0, 0, 0}, false, wall_slot);
    add_lid(m, roof, {0, p.height_m, 0}, true, wall_slot);
    return m;
}

Mesh pierced_slab(double width_m, double height_m, double depth_m, const WindowGrid& openings) {
    const double w = 0.5 * width_m, d = 0.5 * depth_m;
    const std::vector<double> us = grid_lines(openings.columns, width_m),
                              vs = grid_lines(openings.rows, height_m);
    const Front front{{-w, 0, d}, {1, 0, 0}, {0, 0, 1}};
    Mesh m;
    add_front(m, front, us, vs, depth_m, 0);
    const double in = depth_m;
    for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        for (std::size_t i = 0; i + 1 < us.size(); ++i) {
            if (i % 2 == 1 && j % 2 == 1) continue;
            add_facet(m, {front.at(us[i + 1], vs[j], in), front.at(us[i], vs[j], in),
                          front.at(us[i], vs[j + 1], in), front.at(us[i + 1], vs[j + 1], in)});
        }
    }
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
        add_facet(m, {front.at(us[i], 0, in), front.at(us[i + 1], 0, in), front.at(us[i + 1], 0, 0),
                      front.at(us[i], 0, 0)});
        add_facet(m, {front.at(us[i], height_m, 0), front.at(us[i + 1], height_m, 0),
                      front.at(us[i + 1], height_m, in), front.at(us[i], height_m, in)});
    }
    for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        add_facet(m, {front.at(0, vs[j], in), front.at(0, vs[j], 0), front.at(0, vs[j + 1], 0),
                      front.at(0, vs[j + 1], in)});
        add_facet(m, {front.at(width_m, vs[j], 0), front.at(width_m, vs[j], in),
                      front.at(width_m, vs[j + 1], in), front.at(width_m, vs[j + 1], 0)});
    }
    return m;
}

}  // namespace obscura
