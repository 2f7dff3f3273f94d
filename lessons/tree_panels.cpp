#include "lessons/tree_panels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace obscura {
namespace {

/// Height of the lowest node over the 5 x 5 texels around (x, y): above it all their bits are equal.
int kernel_height(int x, int y) {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(((x - 2) ^ (x + 2)) | ((y - 2) ^ (y + 2)))));
}

}  // namespace

void draw_intervals(Figure& f, const Image<DepthInterval>& map, Vec2d origin, double side) {
    const Cells cells{origin, side / map.width, map.width, map.height};
    cells.each([&](int x, int y) {
        const DepthInterval i = map(x, y);
        const Box box = cells.cell(x, y);
        const double room = box.h - 12;
        f.fill(box, ink::panel);
        f.fill({box.x + 7, box.y + 6 + room * static_cast<double>(i.entry), 12,
                room * static_cast<double>(i.exit - i.entry)},
               ink::blue);
        f.text({box.x + 0.5 * box.w + 8, box.y + 0.5 * box.h - 2}, fmt::format("{:.2f}", i.entry),
               {8, ink::dark, Align::centre});
        f.text({box.x + 0.5 * box.w + 8, box.y + 0.5 * box.h + 14}, fmt::format("{:.2f}", i.exit),
               {8, ink::dark, Align::centre});
    });
    f.grid(cells, {ink::paper, 2});
}

void draw_nodes(Figure& f, const std::vector<TreeSquare>& squares, int level, const Cells& cells) {
    f.fill(cells.box(), ink::panel);
    for (const TreeSquare& s : squares) {
        if (s.level != level) continue;
        const Box box = cells.cell(static_cast<int>(s.x), static_cast<int>(s.y));
        f.fill({box.x + 2, box.y + 2, box.w - 4, box.h - 4}, kind_color(s.kind));
        const bool has_value = s.kind != ChildKind::empty;
        f.label(box, has_value ? fmt::format("{:.2f}", s.value) : "empty",
                {9, readable_on(kind_color(s.kind)), Align::centre, true});
    }
    f.grid(cells, {ink::grid, 1});
}

Vec2d telling_kernel(const std::vector<SurfaceBlock>& blocks, const std::vector<ref::PcfSteps>& steps,
                     const PcfLight& light) {
    Vec2d best;
    int most = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].shared <= most) continue;
        const auto at = static_cast<int>(i % block_samples);
        const ref::PcfPlace place = ref::pcf_place(blocks[i / block_samples], light, at);
        // Lookups round to 1/256 texel first.
        const auto texel_of = [](double X) { return std::floor(std::nearbyint(X * 256) / 256); };
        const Vec2d texel{texel_of(place.X), texel_of(place.Y)};
        if (kernel_height(static_cast<int>(texel.x), static_cast<int>(texel.y)) > 4) continue;
        most = steps[i].shared;
        best = texel;
    }
    return best;
}

void draw_kernel(Figure& f, const std::vector<TreeSquare>& squares, int kx, int ky, const Cells& cells) {
    const int x0 = kx - cells.columns / 2, y0 = ky - cells.rows / 2;
    f.fill(cells.box(), ink::panel);
    for (const TreeSquare& s : squares) {
        const int side = 1 << s.level, sx = static_cast<int>(s.x) * side - x0,
                  sy = static_cast<int>(s.y) * side - y0;
        if (sx + side <= 0 || sy + side <= 0 || sx >= cells.columns || sy >= cells.rows || side > 64)
            continue;
        const int cx0 = std::max(sx, 0), cy0 = std::max(sy, 0), cx1 = std::min(sx + side, cells.columns),
                  cy1 = std::min(sy + side, cells.rows);
        const Vec2d corner = cells.at(cx0, cy0);
        const Box box{corner.x, corner.y, (cx1 - cx0) * cells.side, (cy1 - cy0) * cells.side};
        f.fill(box, kind_color(s.kind), 0.25);
        f.frame(box, {kind_color(s.kind), 1});
    }
    f.grid(cells, {ink::grid, 0.6});
    const Vec2d low = cells.at(kx - 2 - x0, ky - 2 - y0);
    f.frame({low.x, low.y, 5 * cells.side, 5 * cells.side}, {ink::red, 3});
    const int common = kernel_height(kx, ky);
    const int size = 1 << common, nx = ((kx - 2) >> common) * size - x0,
              ny = ((ky - 2) >> common) * size - y0;
    const Vec2d corner = cells.at(std::max(nx, 0), std::max(ny, 0)),
                end = cells.at(std::min(nx + size, cells.columns), std::min(ny + size, cells.rows));
    f.frame({corner.x, corner.y, end.x - corner.x, end.y - corner.y}, {ink::dark, 3});
    f.paragraph(
        cells.at(0, cells.rows) + Vec2d{0, 26},
        fmt::format("x: {} XOR {} = {}, y: {} XOR {} = {}: the texels of the kernel\n(red) part ways in a "
                    "square of {} x {} texels (black)",
                    kx - 2, kx + 2, (kx - 2) ^ (kx + 2), ky - 2, ky + 2, (ky - 2) ^ (ky + 2), size, size));
}

}  // namespace obscura
