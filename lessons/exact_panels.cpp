#include "lessons/exact_panels.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "lessons/drawing/panels.h"
#include "raster/coverage.h"

namespace obscura {
namespace {

constexpr Rgb8 bunch_colors[] = {ink::orange, ink::sky, ink::green, ink::purple, ink::red, ink::blue};

GridOnMap grid_on_map(const ExactView& grid, const LightView& map) {
    const auto stretch = [&](int r) {
        int k = 0;
        for (int i = 1; i < 3; ++i) {
            if (std::fabs(map.to_map.m[r][i]) > std::fabs(map.to_map.m[r][k])) k = i;
        }
        return map.to_map.m[r][k] / grid.to_map[r][k];
    };
    const double sx = stretch(0), sy = stretch(1);
    return {sx / subtexel_one, sy / subtexel_one, map.to_map.m[0][3] - sx * grid.to_map[0][3],
            map.to_map.m[1][3] - sy * grid.to_map[1][3]};
}

/// Corner k of a triangle of the view, in texels.
Vec2d corner(const SampledPicture& picture, std::size_t triangle, int k) {
    const CasterTriangle& t = picture.view.triangles[triangle];
    return picture.on_map.at(t.x[k], t.y[k]);
}

bool darkens(const SampledPicture& picture, std::size_t triangle, std::uint32_t sample) {
    const auto at = static_cast<int>(picture.samples.point[sample]);
    return ref::exact_darkens(picture.points, picture.light, at, triangle);
}

/// As kernels have it.
Vec3f seen_from_eye(const SampledPicture& picture, std::uint32_t sample) {
    const std::uint32_t i = picture.samples.point[sample];
    const double(&eye)[3] = picture.light.eye;
    return to_float(
        {picture.points.px[i] - eye[0], picture.points.py[i] - eye[1], picture.points.pz[i] - eye[2]});
}

/// What holds some places on the map.
struct Extent {
    Vec2d low{1e9, 1e9}, high{-1e9, -1e9};
    void add(Vec2d p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    double side() const { return std::max(high.x - low.x, high.y - low.y); }
};
Extent extent_of(const SampledPicture& picture, std::size_t triangle) {
    Extent e;
    for (int k = 0; k < 3; ++k)
        e.add(corner(picture, triangle, k));
    return e;
}
Extent extent_of(const SampledPicture& picture, std::span<const std::uint32_t> bunch) {
    Extent e;
    for (const std::uint32_t i : bunch)
        e.add(picture.place(i));
    return e;
}

void draw_triangle(Figure& f, const SampledPicture& picture, const MapWindow& window, std::size_t t,
                   const Pen& pen) {
    const auto at = [&](int k) { return window.at(corner(picture, t, k)); };
    f.polygon({at(0), at(1), at(2)}, pen.color, 0.07);
    f.polyline({at(0), at(1), at(2), at(0)}, pen);
}

void draw_bunches(Figure& f, const SampledPicture& picture, const MapWindow& window) {
    for (std::size_t b = 0; b < picture.bunches(); ++b) {
        std::vector<Vec2d> way;
        bool seen = false;
        for (const std::uint32_t i : picture.bunch(b)) {
            way.push_back(window.at(picture.place(i)));
            seen |= window.holds(picture.place(i));
        }
        if (!seen) continue;
        const Rgb8 color = bunch_colors[b % std::size(bunch_colors)];
        f.polyline(way, {mix(color, ink::panel, 0.35), 1.2});
        for (const Vec2d p : way)
            f.disc(p, 3, color);
    }
}

void draw_casters(Figure& f, const SampledPicture& picture, const MapWindow& window) {
    const auto count = static_cast<std::size_t>(picture.view.count);
    std::vector<Box> frames;
    for (std::size_t g = 0; 16 * g < count; ++g) {
        const CasterBoxes& boxes = picture.view.boxes[1][g / 16];
        const std::size_t k = g % 16;
        const Vec2d low = window.at(picture.on_map.at(boxes.x_low[k], boxes.y_low[k])),
                    high = window.at(picture.on_map.at(boxes.x_high[k], boxes.y_high[k]));
        const Box frame{low.x, low.y, high.x - low.x, high.y - low.y};
        if (frame.w > window.box.w || frame.h > window.box.h) continue;
        frames.push_back(frame);
        for (std::size_t t = 16 * g; t < std::min(16 * g + 16, count); ++t)
            draw_triangle(f, picture, window, t, {ink::grey, 0.8});
    }
    for (const Box& frame : frames)
        f.frame(frame, {ink::dark, 1.8});
}

}  // namespace

bool MapWindow::holds(Vec2d texel, double margin_px) const {
    const Vec2d p = at(texel);
    return p.x >= box.x + margin_px && p.x <= box.x + box.w - margin_px && p.y >= box.y + margin_px &&
           p.y <= box.y + box.h - margin_px;
}

SampledPicture exact_picture(const ExactLight& light, const ExactPoints& points, const ExactWork& work,
                             const std::vector<std::uint32_t>& lit, const LightView& map) {
    return {light, light.view[0], points, work.samples(), work.order(), lit, grid_on_map(light.view[0], map)};
}

void draw_samples(Figure& f, const SampledPicture& picture, const MapWindow& window, double dot_px,
                  bool grid) {
    f.fill(window.box, ink::panel);
    if (grid) {
        const Cells cells{{window.box.x, window.box.y},
                          window.px(),
                          static_cast<int>(window.texels),
                          static_cast<int>(window.texels)};
        f.grid(cells, {ink::grid, 1.2});
        cells.each([&](int x, int y) {
            const Vec2d c = cells.centre(x, y);
            f.line(c - Vec2d{4, 0}, c + Vec2d{4, 0}, {ink::dark, 1.2});
            f.line(c - Vec2d{0, 4}, c + Vec2d{0, 4}, {ink::dark, 1.2});
        });
    }
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(picture.samples.count); ++i) {
        const Vec2d texel = picture.place(i), at = window.at(texel);
        if (!window.holds(texel, 1 + 0.5 * dot_px)) continue;
        const Rgb8 color = picture.is_lit(i) ? lit_color : dark_color;
        if (grid) {
            f.disc(at, 0.5 * dot_px, color);
        } else {
            f.fill({at.x - 0.5 * dot_px, at.y - 0.5 * dot_px, dot_px, dot_px}, color, 0.6);
        }
    }
    f.frame(window.box, {ink::soft, 1});
}

void draw_sixteens(Figure& f, const SampledPicture& picture, const MapWindow& window) {
    // A figure of its own ends at the panel's border.
    Figure panel(static_cast<int>(window.box.w), static_cast<int>(window.box.h));
    MapWindow within = window;
    within.box.x = within.box.y = 0;
    panel.fill(within.box, ink::panel);
    draw_bunches(panel, picture, within);
    draw_casters(panel, picture, within);
    draw_picture(f, {window.box.x, window.box.y}, panel.picture);
}

Image<int> samples_per_texel(const SampledPicture& picture, int texels) {
    Image<int> count(texels, texels);
    for (const std::uint32_t i : picture.order)
        ++count(static_cast<int>(picture.place(i).x), static_cast<int>(picture.place(i).y));
    return count;
}

bool inside_edge(const CasterTriangle& t, int k, const SampledPicture& picture, std::uint32_t sample) {
    TriangleRecord r{};
    std::copy_n(t.x, 3, r.x);
    std::copy_n(t.y, 3, r.y);
    return edge_function(r, k).at(picture.samples.x[sample], picture.samples.y[sample]) >= 0;
}

bool covered_by(const CasterTriangle& t, const SampledPicture& picture, std::uint32_t sample) {
    return inside_edge(t, 0, picture, sample) && inside_edge(t, 1, picture, sample) &&
           inside_edge(t, 2, picture, sample);
}

TellingPair telling_pair(const SampledPicture& picture) {
    TellingPair best;
    double most = -1e9;
    for (std::size_t b = 0; b < picture.bunches(); ++b) {
        const Extent of_bunch = extent_of(picture, picture.bunch(b));
        for (std::size_t t = 0; t < static_cast<std::size_t>(picture.view.count); ++t) {
            const double spread = of_bunch.side() / extent_of(picture, t).side();
            if (spread > 1.6) continue;
            int covered = 0, outside[3] = {};
            for (const std::uint32_t i : picture.bunch(b)) {
                covered += covered_by(picture.view.triangles[t], picture, i) ? 1 : 0;
                for (int k = 0; k < 3; ++k)
                    outside[k] += inside_edge(picture.view.triangles[t], k, picture, i) ? 0 : 1;
            }
            if (outside[0] == 0 || outside[1] == 0 || outside[2] == 0) continue;
            const double score = std::min(covered, 16 - covered) - 4 * std::fabs(spread - 1);
            if (score <= most) continue;
            most = score;
            best = {t, b, covered};
        }
    }
    return best;
}

void draw_pair(Figure& f, const SampledPicture& picture, const TellingPair& pair, const Box& box) {
    const CasterTriangle& t = picture.view.triangles[pair.triangle];
    Extent both = extent_of(picture, pair.triangle);
    for (const std::uint32_t i : picture.bunch(pair.bunch))
        both.add(picture.place(i));
    const double texels = 1.2 * both.side();
    const MapWindow window{box, 0.5 * (both.low.x + both.high.x - texels),
                           0.5 * (both.low.y + both.high.y - texels), texels};
    f.fill(window.box, ink::panel);
    const auto at = [&](int k) { return window.at(corner(picture, pair.triangle, k)); };
    f.polygon({at(0), at(1), at(2)}, ink::grid);
    // Edges go on beyond their corners: each asks of a half plane.
    for (int k = 0; k < 3; ++k) {
        const Vec2d from = at(k), way = at((k + 1) % 3) - from;
        double low = -1e9, high = 1e9;
        const auto within = [&](double start, double step, double least, double most) {
            if (step == 0) return;
            const double a = (least - start) / step, b = (most - start) / step;
            low = std::max(low, std::min(a, b));
            high = std::min(high, std::max(a, b));
        };
        within(from.x, way.x, window.box.x, window.box.x + window.box.w);
        within(from.y, way.y, window.box.y, window.box.y + window.box.h);
        if (low < high) f.line(from + way * low, from + way * high, {ink::soft, 1, 5});
        f.line(from, from + way, {ink::dark, 2});
    }
    for (const std::uint32_t i : picture.bunch(pair.bunch)) {
        const Vec2d p = window.at(picture.place(i));
        if (covered_by(t, picture, i)) {
            const bool darkened = darkens(picture, pair.triangle, i);
            CHECK(!darkened || !picture.is_lit(i));
            f.disc(p, 5.5, darkened ? dark_color : lit_color);
        } else {
            f.ring(p, 5, {lit_color, 2.5});
        }
    }
    f.frame(window.box, {ink::soft, 1});
}

double height_over(const CasterTriangle& t, const SampledPicture& picture, std::uint32_t sample) {
    const std::uint32_t i = picture.samples.point[sample];
    const Vec3d p{picture.points.px[i], picture.points.py[i], picture.points.pz[i]};
    return dot(Vec3d{t.n[0], t.n[1], t.n[2]}, p) + t.d;
}

PlaneDistances plane_distances(const SampledPicture& picture) {
    PlaneDistances d;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(picture.samples.count); ++i) {
        const Vec3f p = seen_from_eye(picture, i);
        const float reach = (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z);
        d.rounding.add(static_cast<double>(picture.samples.rounding[i]));
        d.snapping.add(static_cast<double>(picture.light.snapping_m + picture.light.snapping_per_m * reach));
        for (std::size_t t = 0; t < static_cast<std::size_t>(picture.view.count); ++t) {
            const CasterTriangle& triangle = picture.view.triangles[t];
            if (triangle.face == picture.points.face[picture.samples.point[i]]) continue;
            if (!covered_by(triangle, picture, i)) continue;
            const double height = height_over(triangle, picture, i), size = std::fabs(height);
            const bool is_dark = height < 0 && darkens(picture, t, i);
            const int bin = size > 1e-8 ? static_cast<int>(2 * (decades_of(size) + 8)) : 0;
            ++(height >= 0 ? d.before : is_dark ? d.behind : d.same)[bin < d.bins ? bin : d.bins - 1];
            if (is_dark) d.nearest_dark = std::min(d.nearest_dark, size);
            if (height < 0 && !is_dark) d.farthest_same = std::max(d.farthest_same, size);
        }
    }
    return d;
}

void draw_distances(Figure& f, const PlaneDistances& d, const Box& box) {
    constexpr double most = 5;  // powers of ten, up and down
    const Plot plot{box, -8, 1, -most, most};
    const auto at_size = [&](double metres) { return plot.at(decades_of(metres), 0).x; };
    f.fill(box, ink::panel);
    const auto band = [&](const ErrorRange& r, Rgb8 color) {
        f.fill({at_size(r.low), box.y, at_size(r.high) - at_size(r.low), box.h}, color);
    };
    band(d.rounding, rounding_color);
    band(d.snapping, snapping_color);
    for (const int e : {-4, -2, 2, 4}) {
        f.line(plot.at(-8, e), plot.at(1, e), {ink::grid, 1});
        f.text(plot.at(-8, e) + Vec2d{-8, 4}, power_of_ten_text(std::abs(e)), {8.5, ink::soft, Align::right});
    }
    // A bar begins a little off the middle line, so that one sample shows.
    const double width = box.w / d.bins, unit = box.h / (2 * most);
    const auto bar = [&](int bin, int count, bool up, Rgb8 color) {
        if (count == 0) return;
        const double height = std::max(decades_of(count), 0.2) * unit, y = plot.at(0, 0).y;
        f.fill({box.x + bin * width + 1, up ? y - height : y, width - 2, height}, color);
    };
    for (int b = 0; b < d.bins; ++b) {
        bar(b, d.before[b], true, lit_color);
        bar(b, d.behind[b], false, dark_color);
        bar(b, d.same[b], false, lit_color);
    }
    f.line(plot.at(-8, 0), plot.at(1, 0), {ink::dark, 1.5});
    f.text({box.x + 8, box.y + 18}, "before");
    f.text({box.x + 8, box.y + box.h - 9}, "behind");
    f.frame(box, {ink::soft, 1});
    for (const int e : {-8, -6, -4, -2, 0})
        f.text(plot.at(e, -most) + Vec2d{0, 18}, (e == -8 ? "<" : "") + power_of_ten_text(e),
               lettering::tick);
    f.text(plot.at(1, -most) + Vec2d{0, 18}, "m", {9, ink::soft, Align::right});
}

}  // namespace obscura
