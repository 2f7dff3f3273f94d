// Runions, Lane, Prusinkiewicz: "Modeling trees with a space colonization algorithm", Eurographics Workshop
// on Natural Phenomena 2007. Points of attraction fill the crown; every growth step, each point pulls the
// nearest node of the skeleton, and points that have been reached are removed. Girth follows the pipe model
// (r^n = sum of the children's r^n, n = 2.4). Our leaves sit on the thin ends, where a real crown has its
// leaves.

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"
#include "scenes/foliage.h"
#include "scenes/generators.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

enum Slot : std::uint32_t { bark, leaf, young_leaf };

struct Node {
    Vec3d at;
    int parent = -1;
    double radius_m = 0;
    double grown_m = 0;  ///< length of the path from the root
};

/// Points inside the crown: an ellipsoid, flattened below and denser towards its skin.
std::vector<Vec3d> attractors(const TreeParams& p, Random& random, int count) {
    const double low = p.trunk_m, high = p.height_m, centre = low + 0.46 * (high - low);
    std::vector<Vec3d> points;
    while (points.size() < static_cast<std::size_t>(count)) {
        const Vec3d d = random_direction(random);
        const double depth = std::sqrt(random.range(0.06, 1.0));
        // Lobes: a crown is a heap of rounded masses rather than an egg.
        const Vec2d lobe = on_circle(0.5 * d.x + 0.9 * d.z + 0.7 * d.y + 0.37 * p.seed);
        const double reach = depth * (0.90 + 0.10 * lobe.x + 0.06 * lobe.y * d.x);
        const double vertical = d.y > 0 ? high - centre : 0.86 * (centre - low);
        points.push_back({p.crown_radius_m * reach * d.x, centre + vertical * reach * d.y,
                          p.crown_radius_m * reach * d.z});
    }
    return points;
}

/// The trunk up to the crown, slightly bent.
std::vector<Node> trunk(const TreeParams& p, double step, Random& random) {
    std::vector<Node> nodes{{{0, -0.08, 0}, -1, 0, 0}};
    const Vec2d lean = on_circle(random.uniform()) * 0.035;
    while (nodes.back().at.y < p.trunk_m + 0.12 * (p.height_m - p.trunk_m)) {
        const Node& last = nodes.back();
        const Vec2d bend = on_circle(0.35 * last.at.y + 0.1 * p.seed) * 0.07;
        const Vec3d along = normalize(Vec3d{lean.x + bend.x, 1, lean.y + bend.y});
        nodes.push_back({last.at + along * step, static_cast<int>(nodes.size()) - 1, 0, last.grown_m + step});
    }
    return nodes;
}

/// Grows the skeleton until the points are used up or out of reach.
std::vector<Node> grow(const TreeParams& p, Random& random) {
    const double size = num::cbrt(p.crown_radius_m * p.crown_radius_m * (p.height_m - p.trunk_m));
    const double step = 0.055 * size, reached = 2.0 * step;
    std::vector<Vec3d> points = attractors(p, random, std::clamp(p.leaves / 6, 300, 2400));
    std::vector<Node> nodes = trunk(p, step, random);
    std::vector<int> nearest(points.size(), 0);
    std::vector<double> distance(points.size(), 1e30);
    std::size_t seen = 0;  // nodes that the points have been compared with
    for (int round = 0; round < 120 && !points.empty(); ++round) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t k = seen; k < nodes.size(); ++k) {
                const double d = length(points[i] - nodes[k].at);
                if (d < distance[i]) distance[i] = d, nearest[i] = static_cast<int>(k);
            }
        }
        seen = nodes.size();
        // Reached points have done their work.
        std::size_t kept = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (distance[i] < reached) continue;
            points[kept] = points[i], nearest[kept] = nearest[i], distance[kept] = distance[i];
            ++kept;
        }
        points.resize(kept), nearest.resize(kept), distance.resize(kept);
        // Every pulled node sends out one new node, towards the mean of its points and a little upwards.
        std::vector<Vec3d> pull(seen);
        std::vector<char> pulled(seen, 0);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto k = static_cast<std::size_t>(nearest[i]);
            pull[k] = pull[k] + normalize(points[i] - nodes[k].at);
            pulled[k] = 1;
        }
        for (std::size_t k = 0; k < seen; ++k) {
            if (!pulled[k]) continue;
            const Vec3d wander = random_direction(random) * 0.18;
            const Vec3d along = normalize(normalize(pull[k]) + wander + Vec3d{0, 0.08, 0});
            nodes.push_back({nodes[k].at + along * step, static_cast<int>(k), 0, nodes[k].grown_m + step});
        }
        if (nodes.size() == seen) break;
    }
    return nodes;
}

/// Pipe model from the tips down. Parents come before children, so one backward sweep does it.
void thicken(std::vector<Node>& nodes, double tip_radius_m, double root_radius_m) {
    std::vector<double> flow(nodes.size(), 0.0);
    for (std::size_t i = nodes.size(); i-- > 0;) {
        if (flow[i] == 0) flow[i] = 1;
        if (nodes[i].parent >= 0) flow[static_cast<std::size_t>(nodes[i].parent)] += flow[i];
    }
    // r = tip * flow^k, with k such that the root gets its girth.
    const double k = num::log(root_radius_m / tip_radius_m) / num::log(flow[0]);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        nodes[i].radius_m = tip_radius_m * num::pow(flow[i], k);
}

/// Chains of nodes: each starts inside its parent and follows the thickest child to a tip.
void add_branches(Mesh& mesh, const std::vector<Node>& nodes) {
    std::vector<std::vector<int>> children(nodes.size());
    for (std::size_t i = 1; i < nodes.size(); ++i) {
        children[static_cast<std::size_t>(nodes[i].parent)].push_back(static_cast<int>(i));
    }
    std::vector<int> starts{0};
    for (std::size_t s = 0; s < starts.size(); ++s) {
        std::vector<TubePoint> path;
        const Node& first = nodes[static_cast<std::size_t>(starts[s])];
        if (first.parent >= 0) {
            path.push_back({nodes[static_cast<std::size_t>(first.parent)].at, 1.1 * first.radius_m});
        }
        for (int i = starts[s]; i >= 0;) {
            const Node& node = nodes[static_cast<std::size_t>(i)];
            const double flare =
                node.grown_m < 0.5 ? 1 + 0.55 * (1 - node.grown_m / 0.5) * (1 - node.grown_m / 0.5) : 1.0;
            path.push_back({node.at, node.radius_m * flare});
            auto& next = children[static_cast<std::size_t>(i)];
            std::stable_sort(next.begin(), next.end(), [&](int a, int b) {
                return nodes[static_cast<std::size_t>(a)].radius_m >
                       nodes[static_cast<std::size_t>(b)].radius_m;
            });
            for (std::size_t k = 1; k < next.size(); ++k)
                starts.push_back(next[k]);
            i = next.empty() ? -1 : next[0];
        }
        if (path.size() < 2) continue;
        const double girth = path[path.size() / 3].radius_m;
        add_part(mesh, tube(path, girth > 0.08 ? 12 : girth > 0.03 ? 8 : girth > 0.012 ? 6 : 4), {}, bark);
    }
}

/// Leaves on the twigs, in sprays that droop a little; the thinner the twig, the more of them.
void add_leaves(Mesh& mesh, const TreeParams& p, const std::vector<Node>& nodes, double tip_radius_m,
                Random& random) {
    std::vector<std::size_t> twigs;
    for (std::size_t i = 1; i < nodes.size(); ++i) {
        if (nodes[i].at.y < p.trunk_m) continue;
        const int share = nodes[i].radius_m < 1.3 * tip_radius_m   ? 4
                          : nodes[i].radius_m < 2.2 * tip_radius_m ? 1
                                                                   : 0;
        twigs.insert(twigs.end(), static_cast<std::size_t>(share), i);
    }
    CHECK(!twigs.empty());
    for (int n = 0; n < p.leaves; ++n) {
        const Node& node = nodes[twigs[static_cast<std::size_t>(n) % twigs.size()]];
        const Vec3d twig = normalize(node.at - nodes[static_cast<std::size_t>(node.parent)].at);
        const Vec3d out = random_direction(random);
        const Vec3d at = node.at - twig * random.range(0, 0.22) + out * random.range(0.0, 2.6 * p.leaf_m);
        const Vec3d along = normalize(twig * 0.5 + out + Vec3d{0, -0.25, 0});
        const Vec3d up = normalize(Vec3d{0, 1, 0} + random_direction(random) * 0.65);
        if (std::fabs(dot(along, up)) > 0.98) continue;
        add_leaf(mesh, at, along, up, p.leaf_m * random.range(0.7, 1.25),
                 random.chance(0.3) ? young_leaf : leaf);
    }
}

}  // namespace

GeneratedModel tree(const TreeParams& p) {
    CHECK(p.trunk_m >= 0 && p.crown_radius_m > 0.2 && p.leaves >= 0 && p.leaf_m > 0.01 && problem(p).empty(),
          problem(p));
    GeneratedModel model;
    model.materials = {material_slot("bark", 98, 82, 66, 0.95f), material_slot("leaf", 88, 122, 48, 0.6f),
                       material_slot("young_leaf", 122, 148, 58, 0.6f)};
    model.materials[leaf].translucency = model.materials[young_leaf].translucency = 0.3f;
    const Random seed(static_cast<std::uint64_t>(p.seed));
    Random growth = seed.fork(1), foliage = seed.fork(2);
    const double tip_radius_m = 0.006;
    std::vector<Node> nodes = grow(p, growth);
    thicken(nodes, tip_radius_m, 0.022 * p.height_m);
    add_branches(model.mesh, nodes);
    add_leaves(model.mesh, p, nodes, tip_radius_m, foliage);
    return model;
}

}  // namespace obscura
