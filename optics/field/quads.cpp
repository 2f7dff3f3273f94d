// The quadtree from the bottom up (thesis, 2019, section 3.4.2, figure 3.2). Every node takes one value for
// the level above; what its children have beyond that is written down as quads. The paper's rules for binary
// texels are the cheapest choice of that value, 0 where two are equally cheap, and so is their extension to
// grey:
//
//     one open          0       a square            two diagonal     0       two squares
//     two side by side  0       a rectangle         three            open    a square less
//
// Weights are exact: parent + weight is the child without rounding, or else the parent is taken away first
// and the child's own value added. So the sum is the mask in exact arithmetic, and in float from coarse to
// fine.

#include "optics/field/quads.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/double_double.h"

namespace obscura {
namespace {

/// Upper left, upper right, lower left, lower right.
using Children = std::array<float, 4>;

struct Quad {
    std::int32_t x = 0, y = 0, width = 0, height = 0;
    float weight = 0;
};

/// Which children are written as one rectangle when both differ from the parent and are equal.
enum class Pairing { none, rows, columns };
constexpr std::array<std::array<std::size_t, 2>, 2> row_pairs{{{0, 1}, {2, 3}}};
constexpr std::array<std::array<std::size_t, 2>, 2> column_pairs{{{0, 2}, {1, 3}}};

const std::array<std::array<std::size_t, 2>, 2>& pairs_of(Pairing pairing) {
    return pairing == Pairing::columns ? column_pairs : row_pairs;
}

/// to - from is a float.
bool exact_difference(float from, float to) {
    const Dd d = two_sum(static_cast<double>(to), -static_cast<double>(from));
    return d.lo == 0 && static_cast<double>(static_cast<float>(d.hi)) == d.hi;
}

int steps(float parent, float child) {
    if (child == parent) return 0;
    return exact_difference(parent, child) ? 1 : 2;
}

int cost_of(const Children& c, float parent, Pairing pairing) {
    int cost = 0;
    for (const auto& [a, b] : pairs_of(pairing)) {
        const bool merged = pairing != Pairing::none && c[a] == c[b];
        cost += steps(parent, c[a]);
        if (!merged) cost += steps(parent, c[b]);
    }
    return cost;
}

struct Choice {
    float parent = 0;
    Pairing pairing = Pairing::none;
};

Choice cheapest(const Children& c) {
    Choice best;
    int least = cost_of(c, 0, Pairing::none);
    for (const float parent : {0.0f, c[0], c[1], c[2], c[3]}) {
        for (const Pairing pairing : {Pairing::none, Pairing::rows, Pairing::columns}) {
            const int cost = cost_of(c, parent, pairing);
            if (cost >= least) continue;
            least = cost;
            best = {parent, pairing};
        }
    }
    return best;
}

/// Turns the parent's value into the child's over one rectangle.
void append_steps(std::vector<Quad>& quads, Quad place, float parent, float child) {
    if (child == parent) return;
    const auto add = [&](float weight) {
        place.weight = weight;
        if (weight != 0) quads.push_back(place);
    };
    if (exact_difference(parent, child)) {
        add(child - parent);
    } else {
        add(-parent);
        add(child);
    }
}

/// The quads of one node whose children have sides of `side` texels, the first at (x, y).
void append_node(std::vector<Quad>& quads, const Children& c, const Choice& choice, int x, int y, int side) {
    for (const auto& [a, b] : pairs_of(choice.pairing)) {
        const float first = c[a], second = c[b];
        const auto place = [&](std::size_t child, int width, int height) {
            return Quad{child % 2 == 1 ? x + side : x, child >= 2 ? y + side : y, width, height, 0};
        };
        if (choice.pairing != Pairing::none && first == second) {
            const bool rows = choice.pairing == Pairing::rows;
            append_steps(quads, place(a, rows ? 2 * side : side, rows ? side : 2 * side), choice.parent,
                         first);
        } else {
            append_steps(quads, place(a, side, side), choice.parent, first);
            append_steps(quads, place(b, side, side), choice.parent, second);
        }
    }
}

/// One level up; texels outside the level below are 0.
Image<float> merge_level(ImageView<const float> below, int side, std::vector<Quad>& quads) {
    Image<float> above((below.width + 1) / 2, (below.height + 1) / 2);
    for (int y = 0; y < above.height; ++y) {
        const float* upper = below.row(2 * y);
        const float* lower = 2 * y + 1 < below.height ? below.row(2 * y + 1) : nullptr;
        for (int x = 0; x < above.width; ++x) {
            const bool right = 2 * x + 1 < below.width;
            const Children c{upper[2 * x], right ? upper[2 * x + 1] : 0, lower ? lower[2 * x] : 0,
                             lower && right ? lower[2 * x + 1] : 0};
            if (c[0] == c[1] && c[0] == c[2] && c[0] == c[3]) {
                above(x, y) = c[0];
                continue;
            }
            const Choice choice = cheapest(c);
            above(x, y) = choice.parent;
            append_node(quads, c, choice, 2 * x * side, 2 * y * side, side);
        }
    }
    return above;
}

void append(QuadList& list, const Quad& q, float sign) {
    list.x.push_back(q.x);
    list.y.push_back(q.y);
    list.width.push_back(q.width);
    list.height.push_back(q.height);
    list.weight.push_back(sign * q.weight);
}

/// Coarse to fine, weights times `sign`.
void append_decomposition(QuadList& list, ImageView<const float> mask, float sign) {
    CHECK(mask.width > 0 && mask.height > 0 && std::max(mask.width, mask.height) <= (1 << 29));
    std::vector<std::vector<Quad>> levels(1);
    Image<float> level = merge_level(mask, 1, levels[0]);
    int side = 2;
    for (; level.width > 1 || level.height > 1; side *= 2) {
        levels.emplace_back();
        level = merge_level(level.view(), side, levels.back());
    }
    if (level(0, 0) != 0) append(list, {0, 0, side, side, level(0, 0)}, sign);
    for (auto quads = levels.rbegin(); quads != levels.rend(); ++quads) {
        for (const Quad& q : *quads)
            append(list, q, sign);
    }
}

}  // namespace

QuadList quads_of(ImageView<const float> mask) {
    QuadList list;
    list.columns = mask.width;
    list.rows = mask.height;
    append_decomposition(list, mask, 1);
    return list;
}

QuadList difference_quads(ImageView<const float> before, ImageView<const float> after) {
    CHECK(before.width == after.width && before.height == after.height);
    QuadList list;
    list.columns = before.width;
    list.rows = before.height;
    // What closes and what opens, each on its own (section 3.4.3). A grey step that no float can hold closes
    // all that was and opens all that will be.
    Image<float> closing(before.width, before.height), opening(before.width, before.height);
    for (int y = 0; y < before.height; ++y) {
        for (int x = 0; x < before.width; ++x) {
            const float from = before(x, y), to = after(x, y);
            const bool exact = exact_difference(from, to);
            if (from == to) continue;
            closing(x, y) = exact ? std::max(from - to, 0.0f) : from;
            opening(x, y) = exact ? std::max(to - from, 0.0f) : to;
        }
    }
    append_decomposition(list, closing.view(), -1);
    append_decomposition(list, opening.view(), 1);
    return list;
}

Image<float> mask_of(const QuadList& quads) {
    Image<float> mask(quads.columns, quads.rows);
    for (std::size_t k = 0; k < quads.size(); ++k) {
        const int right = std::min(quads.x[k] + quads.width[k], quads.columns);
        const int bottom = std::min(quads.y[k] + quads.height[k], quads.rows);
        for (int y = quads.y[k]; y < bottom; ++y) {
            for (int x = quads.x[k]; x < right; ++x)
                mask(x, y) += quads.weight[k];
        }
    }
    return mask;
}

}  // namespace obscura
