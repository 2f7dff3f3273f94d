#include "stereo/solver/thin_trees.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace obscura {
namespace {

struct Pixel {
    std::int32_t x = 0, y = 0;
};
constexpr std::array<Pixel, 4> ways = {{{0, -1}, {-1, 0}, {1, 0}, {0, 1}}};

/// Valid pixels of a system, and how many neighbours each has left.
class Neighbours {
  public:
    explicit Neighbours(const DisparitySystem& s) : there_(s.valid), count_(s.width(), s.height()) {
        for (int y = 0; y < s.height(); ++y) {
            for (int x = 0; x < s.width(); ++x) {
                for (const Pixel& way : ways)
                    count_(x, y) = static_cast<std::uint8_t>(count_(x, y) + there(x + way.x, y + way.y));
            }
        }
    }
    bool there(int x, int y) const {
        return x >= 0 && y >= 0 && x < there_.width && y < there_.height && there_(x, y) != 0;
    }
    bool is_end(int x, int y) const { return there(x, y) && count_(x, y) == 1; }
    /// Takes an end away and returns the neighbour it had.
    Pixel take(int x, int y) {
        there_(x, y) = 0;
        for (const Pixel& way : ways) {
            const Pixel q{x + way.x, y + way.y};
            if (!there(q.x, q.y)) continue;
            --count_(q.x, q.y);
            return q;
        }
        return {x, y};
    }

  private:
    Image<std::uint8_t> there_, count_;
};

Image<std::uint8_t> in_sets(const DisparitySystem& s) {
    Image<std::uint8_t> in(s.width(), s.height());
    for (const MatchingSet& set : s.sets) {
        in(set.source_x, set.source_y) = 1;
        for (const MatchedPixel& p : set.members)
            in(p.x, p.y) = 1;
    }
    return in;
}

/// Pixels of trees, ends first, each with the neighbour it hangs on.
std::vector<TreePixel> tree_pixels(const DisparitySystem& s) {
    std::vector<TreePixel> pixels;
    Neighbours neighbours(s);
    const Image<std::uint8_t> stays = in_sets(s);
    for (int y = 0; y < s.height(); ++y) {
        for (int x = 0; x < s.width(); ++x) {
            // From an end along its chain, as far as that goes.
            for (Pixel p{x, y}; neighbours.is_end(p.x, p.y) && stays(p.x, p.y) == 0;) {
                const Pixel q = neighbours.take(p.x, p.y);
                pixels.push_back({p.x, p.y, q.x, q.y});
                p = q;
            }
        }
    }
    return pixels;
}

/// Drops those of trees that are too small.
void keep_large_trees(const DisparitySystem& s, std::vector<TreePixel>& pixels) {
    // Where each pixel's tree hangs, the last taken first; and how many pixels hang there.
    const auto at = [&](int x, int y) { return static_cast<std::int32_t>(y * s.width() + x); };
    Image<std::int32_t> root(s.width(), s.height(), -1);
    std::vector<std::int64_t> hanging(root.pixels.size(), 0);
    for (auto p = pixels.rbegin(); p != pixels.rend(); ++p) {
        const std::int32_t above = root(p->root_x, p->root_y);
        root(p->x, p->y) = above >= 0 ? above : at(p->root_x, p->root_y);
        ++hanging[static_cast<std::size_t>(root(p->x, p->y))];
    }
    std::erase_if(pixels, [&](const TreePixel& p) {
        return hanging[static_cast<std::size_t>(root(p.x, p.y))] < least_tree;
    });
}

/// a (x - t)^2, of each pixel.
struct Pulls {
    Image<double> weight, weighted;  ///< a, a t

    explicit Pulls(const DisparitySystem& s)
        : weight(s.width(), s.height()), weighted(s.width(), s.height()) {
        for (std::size_t i = 0; i < weight.pixels.size(); ++i) {
            const auto anchor = static_cast<double>(s.anchor_weight.pixels[i]);
            weight.pixels[i] = anchor;
            weighted.pixels[i] = anchor > 0 ? anchor * static_cast<double>(s.anchor_value.pixels[i]) : 0.0;
        }
    }
};

/// Wanted x_q - x_p.
double rise_between(const DisparitySystem& s, const TreePixel& p) {
    const int x = std::min(p.x, p.root_x), y = std::min(p.y, p.root_y);
    const float step = p.x != p.root_x ? s.gradient_x(x, y) : s.gradient_y(x, y);
    return static_cast<double>(p.root_x > p.x || p.root_y > p.y ? step : -step);
}

}  // namespace

std::optional<WithoutTrees> without_trees(const DisparitySystem& s) {
    if (std::memchr(s.valid.pixels.data(), 0, s.valid.pixels.size()) == nullptr) return std::nullopt;
    WithoutTrees out;
    out.pixels = tree_pixels(s);
    keep_large_trees(s, out.pixels);
    if (out.pixels.empty()) return std::nullopt;

    // Each pixel's pull, with what already hangs on it, becomes one of its neighbour.
    Pulls pulls(s);
    const auto epsilon = static_cast<double>(s.epsilon);
    out.rest = s;
    for (TreePixel& p : out.pixels) {
        p.edge = 2.0 * static_cast<double>(s.gradient_weight);
        p.rise = rise_between(s, p);
        p.own_weight = pulls.weight(p.x, p.y) + epsilon;
        p.own_value =
            (pulls.weighted(p.x, p.y) + epsilon * static_cast<double>(s.original(p.x, p.y))) / p.own_weight;
        const double passed_on = p.own_weight * p.edge / (p.own_weight + p.edge);
        pulls.weight(p.root_x, p.root_y) += passed_on;
        pulls.weighted(p.root_x, p.root_y) += passed_on * (p.own_value + p.rise);
        out.rest.valid(p.x, p.y) = 0;
    }
    for (const TreePixel& p : out.pixels) {
        const double weight = pulls.weight(p.root_x, p.root_y);
        out.rest.anchor_weight(p.root_x, p.root_y) = static_cast<float>(weight);
        out.rest.anchor_value(p.root_x, p.root_y) =
            static_cast<float>(pulls.weighted(p.root_x, p.root_y) / weight);
    }
    return out;
}

void put_trees_back(const std::vector<TreePixel>& pixels, DisparityMap& x) {
    for (auto p = pixels.rbegin(); p != pixels.rend(); ++p) {
        const double from_root = static_cast<double>(x(p->root_x, p->root_y)) - p->rise;
        x(p->x, p->y) = static_cast<float>((p->own_weight * p->own_value + p->edge * from_root) /
                                           (p->own_weight + p->edge));
    }
}

}  // namespace obscura
