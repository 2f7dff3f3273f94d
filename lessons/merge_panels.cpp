#include "lessons/merge_panels.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "core/error.h"
#include "hierarchy/codes/decode.h"

namespace obscura {
namespace {

constexpr int houses_map = 16, house_texels = 4;
constexpr int corner_of[2] = {0, 8};
constexpr Rgb8 near_grey{238, 238, 235}, far_grey{120, 122, 128};

/// Places the four nodes of subtree `next`, then what hangs below them.
void place(const SubtreeSet& set, std::size_t& next, const SubtreeSquare& square,
           std::vector<SubtreeSquare>& out) {
    const std::uint8_t kinds = set.subtrees[next++].kinds;
    out.push_back(square);
    const int half = square.side / 2;
    for (int i = 0; i < 4; ++i) {
        const auto kind = static_cast<ChildKind>(kinds >> (2 * i) & 3);
        if (kind != ChildKind::full && kind != ChildKind::empty) continue;
        place(set, next, {square.x + (i & 1) * half, square.y + (i >> 1) * half, half}, out);
    }
}

/// One of a few colours for each subtree that stands for others.
Rgb8 color_of(std::uint32_t subtree) {
    constexpr Rgb8 colors[] = {ink::orange, ink::sky, ink::green, ink::yellow,
                               ink::blue,   ink::red, ink::purple};
    return colors[(subtree * 2654435761u >> 16) % std::size(colors)];
}

}  // namespace

Image<DepthInterval> map_of(const std::array<House, 2>& houses) {
    Image<DepthInterval> map(houses_map, houses_map, DepthInterval{0.97f, 1.0f});
    for (std::size_t i = 0; i < houses.size(); ++i) {
        const int x0 = corner_of[i], y0 = corner_of[i];
        for (int y = 0; y < house_texels; ++y) {
            for (int x = 0; x < house_texels; ++x)
                map(x0 + x, y0 + y) = houses[i].roof;
        }
        map(x0 + 1, y0) = houses[i].first;
        map(x0 + 2, y0 + 3) = houses[i].second;
    }
    return map;
}

std::array<float, 3> decoded(const ShadowTree& tree, int i) {
    const auto at = static_cast<std::uint32_t>(corner_of[i]);
    return {tree_value(tree.code, at, at + 2), tree_value(tree.code, at + 1, at),
            tree_value(tree.code, at + 2, at + 3)};
}

void draw_bar(Figure& f, const Plot& plot, const DepthBar& bar) {
    const Vec2d top = plot.at(bar.x, -double{bar.interval.entry}),
                end = plot.at(bar.x, -double{bar.interval.exit});
    f.fill({top.x - bar.half_px, top.y, 2 * bar.half_px, std::max(end.y - top.y, 2.0)}, bar.color);
}

void draw_depth(Figure& f, const Plot& plot, double x, double depth, Rgb8 color, const std::string& text) {
    const Vec2d at = plot.at(x, -depth);
    f.disc(at, 5.5, ink::paper);
    f.disc(at, 4, color);
    if (!text.empty()) f.text(at + Vec2d{10, 4}, text, {8.5, color, Align::left, true, true});
}

Plot depth_plot(Figure& f, const Box& box, double columns, double least, double greatest) {
    const Plot plot{box, 0, columns, -greatest, -least};
    f.fill(box, ink::panel);
    return plot;
}

void draw_houses(Figure& f, const std::array<House, 2>& houses,
                 const std::array<std::array<float, 3>, 2>& depths, const Box& absolute,
                 const Box& relative) {
    const Plot whole = depth_plot(f, absolute, 7, 0.15, 1.0),
               differences = depth_plot(f, relative, 5, -0.32, 0.38);
    f.text({absolute.x, absolute.y - 8}, "depths, growing downwards", {9, ink::soft});
    f.text({relative.x, relative.y - 8}, "less that of the own roof", {9, ink::soft});
    f.line(differences.at(0, 0), differences.at(5, 0), {ink::grey, 1, 4});
    const char* names[] = {"roof", "well", "chimney"};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto column = static_cast<double>(k);
        for (std::size_t i = 0; i < 2; ++i) {
            const double x = 0.7 + 3.4 * static_cast<double>(i) + column;
            draw_bar(f, whole, {x, part_of(houses[i], k), house_colors[i]});
            draw_depth(f, whole, x, double{depths[i][k]}, ink::dark);
            f.text(whole.at(x, -1) + Vec2d{0, 20}, names[k], lettering::tick);
        }
        if (k == 0) continue;
        const DepthInterval of_a = moved(part_of(houses[0], k), depths[0][0]),
                            of_b = moved(part_of(houses[1], k), depths[1][0]);
        const double x = 2.2 * column - 1.3;
        draw_bar(f, differences, {x, of_a, house_colors[0]});
        draw_bar(f, differences, {x + 0.6, of_b, house_colors[1]});
        draw_bar(f, differences, {x + 1.2, common(of_a, of_b), ink::green});
        const float stored = depths[0][k] - depths[0][0];
        draw_depth(f, differences, x + 1.2, double{stored}, ink::dark);
        f.text(differences.at(x + 0.6, -0.38) + Vec2d{0, 20}, fmt::format("{}: {:+.3f}", names[k], stored),
               lettering::tick);
    }
    f.text(whole.at(1.7, -1) + Vec2d{0, 40}, "house A", {9.5, house_colors[0], Align::centre, true});
    f.text(whole.at(5.1, -1) + Vec2d{0, 40}, "house B", {9.5, house_colors[1], Align::centre, true});
}

void draw_shares(Figure& f, const std::vector<LimitedShare>& shares, const Plot& plot) {
    f.axes(plot, "", "bytes, of MH's");
    std::vector<Vec2d> curve;
    for (const LimitedShare& s : shares) {
        const auto x = static_cast<double>(curve.size());
        curve.push_back(plot.at(x, s.share));
        f.text(plot.at(x, plot.y0) + Vec2d{0, 20}, s.limit == 0 ? "all" : std::to_string(s.limit),
               lettering::tick);
    }
    f.text(plot.at(0.5 * (plot.x0 + plot.x1), plot.y0) + Vec2d{0, 44}, "subtrees that each is compared with",
           lettering::tick);
    f.polyline(curve, {ink::blue, 2});
    for (std::size_t i = 0; i < curve.size(); ++i) {
        f.disc(curve[i], 4, ink::blue);
        f.text(curve[i] - Vec2d{0, 12}, fmt::format("{:.2f}", shares[i].share),
               {8.5, ink::dark, Align::centre, true, true});
    }
}

std::vector<SubtreeSquare> subtree_squares(const SubtreeSet& set, int side) {
    std::vector<SubtreeSquare> squares;
    std::size_t next = 0;
    if (!set.subtrees.empty()) place(set, next, {0, 0, side}, squares);
    CHECK(next == set.subtrees.size());
    return squares;
}

Image<Rgb8> merged_town(const Image<DepthInterval>& map, const SubtreeSet& set, const Merged& merged) {
    float least = 1, greatest = 0;
    for (const DepthInterval& i : map.pixels) {
        if (i.entry >= 1) continue;
        least = std::min(least, i.entry);
        greatest = std::max(greatest, i.entry);
    }
    Image<Rgb8> town(map.width, map.height, ink::paper);
    for (std::size_t p = 0; p < map.pixels.size(); ++p) {
        const float entry = map.pixels[p].entry;
        if (entry < 1)
            town.pixels[p] = mix(near_grey, far_grey, double{entry - least} / double{greatest - least});
    }
    const std::vector<SubtreeSquare> squares = subtree_squares(set, map.width);
    for (std::size_t s = 0; s < squares.size(); ++s) {
        if (merged.alive[s] == 0 || merged.stands_for[s] == no_subtree) continue;
        const Rgb8 color = color_of(merged.stands_for[s]);
        for (int y = 0; y < squares[s].side; ++y) {
            for (int x = 0; x < squares[s].side; ++x) {
                Rgb8& pixel = town(squares[s].x + x, squares[s].y + y);
                pixel = mix(pixel, color, 0.7);
            }
        }
    }
    return town;
}

}  // namespace obscura
