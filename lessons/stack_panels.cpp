#include "lessons/stack_panels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "hierarchy/stack/encode.h"
#include "lessons/drawing/panels.h"

namespace obscura {
namespace {

/// Frames the nodes of a decoded octree that a row of texels meets.
class RowNodes {
  public:
    RowNodes(Figure& f, const Box& box, const ShadowStack& stack, int row)
        : f_(f),
          box_(box),
          shape_(stack.code.shape),
          tree_(decode_stack(stack)),
          row_(row),
          texel_px_(box.w / (1 << shape_.map_levels)),
          map_px_(box.h / (1 << shape_.slice_levels)) {}

    int draw() {
        visit(tree_.root, shape_.levels(), 0, 0, 0);
        return count_;
    }

  private:
    /// A node of this height, its first texel and first map.
    void visit(const MultiresNode& node, int height, int x, int y, int k) {
        frame(height, x, k);
        if (height == 0 || node.kinds == 0) return;
        const int side = 1 << shape_.side_exponent(height - 1),
                  maps = 1 << shape_.slices_exponent(height - 1);
        std::uint64_t place = node.first_child();
        for (int i = 0; i < 8; ++i) {
            if (node.child(i) == ChildKind::none) continue;
            const MultiresNode& child = tree_.nodes[place++];
            const int cy = y + (i >> 1 & 1) * side;
            if (row_ < cy || row_ >= cy + side) continue;
            visit(child, height - 1, x + (i & 1) * side, cy, k + (i >> 2 & 1) * maps);
        }
    }

    void frame(int height, int x, int k) {
        ++count_;
        const double w = texel_px_ * (1 << shape_.side_exponent(height)),
                     h = map_px_ * (1 << shape_.slices_exponent(height));
        f_.frame({box_.x + x * texel_px_, box_.y + k * map_px_, w, h}, {ink::paper, height > 3 ? 1.4 : 0.7});
    }

    Figure& f_;
    Box box_;
    StackShape shape_;
    MultiresTree tree_;
    int row_;
    double texel_px_, map_px_;
    int count_ = 0;
};

}  // namespace

void draw_curve(Figure& f, const Box& box, int count) {
    f.fill(box, ink::panel);
    std::vector<Vec2d> way;
    for (const Vec2d& p : hilbert_samples(count))
        way.push_back({box.x + 12 + p.x * (box.w - 24), box.y + 12 + p.y * (box.h - 24)});
    const int first = count / 4, last = count / 2;
    f.polyline(way, {ink::grey, 1.2});
    f.polyline({way.begin() + first, way.begin() + last}, {ink::orange, 2.5});
    for (int i = 0; i < count; ++i)
        f.disc(way[static_cast<std::size_t>(i)], i >= first && i < last ? 4 : 3,
               i >= first && i < last ? ink::orange : ink::soft);
    f.frame(box, {ink::soft, 1});
}

Image<float> row_of(const ShadowStack& stack, int row) {
    const StackShape& shape = stack.code.shape;
    Image<float> depths(1 << shape.map_levels, 1 << shape.slice_levels);
    for (int k = 0; k < depths.height; ++k) {
        for (int x = 0; x < depths.width; ++x)
            depths(x, k) = stack_value(stack.code, static_cast<std::uint32_t>(x),
                                       static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(k));
    }
    return depths;
}

void draw_row(Figure& f, const Box& box, const Image<float>& depths) {
    float near = 1, far = 0;
    for (const float z : depths.pixels) {
        if (z >= 1) continue;
        near = std::min(near, z);
        far = std::max(far, z);
    }
    Image<Rgb8> picture(static_cast<int>(box.w), static_cast<int>(box.h));
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const float z = depths(x * depths.width / picture.width, y * depths.height / picture.height);
            const double t = static_cast<double>((z - near) / std::max(far - near, 1e-6f));
            picture(x, y) = z >= 1 ? ink::grid : mix({236, 226, 190}, {52, 62, 92}, std::sqrt(t));
        }
    }
    f.image(static_cast<int>(box.x), static_cast<int>(box.y), picture, 1);
    f.frame(box, {ink::soft, 1});
}

int draw_row_nodes(Figure& f, const Box& box, const ShadowStack& stack, int row) {
    return RowNodes(f, box, stack, row).draw();
}

double column_of(const SliceView& map, double a, double h) {
    const double sigma = static_cast<double>(map.sigma_x), tau = static_cast<double>(map.tau);
    return (a + sigma * h) / (1 - tau * h);
}

void draw_runs(Figure& f, const Box& box, const std::vector<AnsweredRun>& runs, int maps) {
    const double map_px = box.h / maps;
    for (const AnsweredRun& run : runs) {
        const Box part{box.x, box.y + run.first * map_px, box.w, run.maps * map_px};
        const Rgb8 color = run.lit ? ink::orange : ink::blue;
        f.fill(part, color);
        f.frame(part, {ink::paper, 1.2});
        if (part.h >= 16) f.label(part, fmt::format("{}", run.maps), {8, readable_on(color), Align::centre});
    }
}

void draw_nodes_read(Figure& f, Vec2d at, const std::vector<double>& nodes, int columns, int zoom,
                     double least, double most) {
    Image<Rgb8> picture(columns, static_cast<int>(nodes.size()) / columns);
    const double low = decades_of(least), high = decades_of(most);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double t = (decades_of(std::max(nodes[i], 1.0)) - low) / (high - low);
        picture.pixels[i] = heat(std::clamp(t, 0.0, 1.0));
    }
    draw_picture(f, at, picture, zoom);
}

void draw_heat_scale(Figure& f, const Box& box, double least, double most, const std::string& name) {
    for (int x = 0; x < static_cast<int>(box.w); ++x)
        f.fill({box.x + x, box.y, 1, box.h}, heat((x + 0.5) / box.w));
    f.frame(box, {ink::soft, 1});
    f.text({box.x - 8, box.y + box.h - 2}, fmt::format("{:.0f}", least), {8.5, ink::soft, Align::right});
    f.text({box.x + box.w + 8, box.y + box.h - 2}, fmt::format("{:.0f} {}", most, name),
           {8.5, ink::soft, Align::left});
}

}  // namespace obscura
