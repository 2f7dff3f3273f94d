#include "lessons/tree_scene.h"

#include <algorithm>
#include <iterator>

#include "core/topology.h"
#include "lessons/drawing/figure.h"
#include "raster/view.h"
#include "scenes/build.h"
#include "scenes/city.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

void add_squares(const MultiresTree& tree, const MultiresNode& node, const TreeSquare& square,
                 std::vector<TreeSquare>& out) {
    out.push_back(square);
    std::uint64_t next = node.first_child();
    for (int i = 0; i < 4; ++i) {
        const ChildKind kind = node.child(i);
        if (kind == ChildKind::none) continue;
        const MultiresNode& child = tree.nodes[next++];
        const auto bit = static_cast<std::uint32_t>(i);
        add_squares(
            tree, child,
            {square.level - 1, 2 * square.x + (bit & 1u), 2 * square.y + (bit >> 1), kind, child.value}, out);
    }
}

}  // namespace

Mesh lesson_town() {
    Mesh mesh = city({4000, 0, 5}).mesh;
    analyse_topology(mesh);
    return mesh;
}

Mesh lesson_solids() {
    Mesh mesh = box({-4, -0.6, -4}, {4, 0, 4});
    add_part(mesh, sphere(1.7, 160, 80), translation(-1.1, 2.0, -0.7));
    add_part(mesh, torus(1.3, 0.5, 160, 64), translation(1.9, 1.6, 1.5) * rotation_x(50));
    analyse_topology(mesh);
    return mesh;
}

Image<DepthInterval> small_map() {
    constexpr DepthInterval roof{.20f, .70f}, lower{.35f, .60f}, street{.80f, 1.0f}, wire{.40f, .42f};
    const DepthInterval texel[16] = {roof,   roof,   lower,  lower,   //
                                     roof,   street, lower,  wire,    //
                                     street, street, street, street,  //
                                     street, street, lower,  street};
    Image<DepthInterval> map(4, 4);
    std::copy(std::begin(texel), std::end(texel), map.pixels.begin());
    return map;
}

Vec3d lesson_sun() {
    return normalize(Vec3d{0.45, -0.8, -0.3});
}

LightView lesson_view(const Mesh& mesh, int texels) {
    return orthographic_light_view(bounds_of(mesh), lesson_sun(), texels);
}

std::vector<TreeSquare> squares_of(const MultiresTree& tree) {
    std::vector<TreeSquare> squares;
    const ChildKind kind = tree.root.kinds == 0 ? ChildKind::leaf : ChildKind::full;
    add_squares(tree, tree.root, {tree.levels, 0, 0, kind, tree.root.value}, squares);
    return squares;
}

Rgb8 kind_color(ChildKind kind) {
    switch (kind) {
        case ChildKind::full:
            return ink::blue;
        case ChildKind::leaf:
            return ink::green;
        case ChildKind::empty:
            return ink::orange;
        case ChildKind::none:
            break;
    }
    return ink::panel;
}

}  // namespace obscura
