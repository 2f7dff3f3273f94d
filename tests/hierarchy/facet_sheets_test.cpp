// The code facet where two sheets part at an edge, so that values rise behind the first of them along a ramp:
// beside a third that lies a little behind the first one's plane, and a few units in the last place apart.

#include <gtest/gtest.h>

#include <cstddef>
#include <random>

#include "hierarchy/codes/decode.h"
#include "hierarchy/facet/facet.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/raster/raster_solids.h"

namespace obscura {
namespace {

constexpr int map_side = 128;
constexpr double height = 20;

int trials() {
    return slow_tests() ? 6000 : 500;
}

double draw(std::mt19937& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) * 0x1p-32);
}

void add_quad(Mesh& mesh, Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
    Mesh quad;
    for (const Vec3d& p : {a, b, c, d})
        quad.positions.push_back(to_float(p));
    quad.triangles = {{{0, 1, 2}}, {{0, 2, 3}}};
    solids::add(mesh, quad);
}

/// Two slivers in the corners of a block of 128 x 20 x 128, which the light then sees from above.
Mesh corners_of_the_map() {
    Mesh mesh;
    add_quad(mesh, {0, 0, 0}, {0.02, 0, 0}, {0.02, 0, 0.02}, {0, 0, 0.02});
    add_quad(mesh, {128, height, 128}, {127.98, height, 128}, {127.98, height, 127.98},
             {128, height, 127.98});
    return mesh;
}

LightView from_above(const Mesh& mesh) {
    return orthographic_light_view(bounds_of(mesh), {0, -1, 0}, map_side);
}

/// Texels whose decoded depth is none of their interval.
std::size_t outside(const Mesh& mesh, Receivers receivers) {
    const LightView view = from_above(mesh);
    BuildParams build;
    build.receivers = receivers;
    const ShadowTree tree = encode_facet(build_facet_tree(mesh, view, build, {}), view, {});
    IntervalParams params;
    params.receivers = receivers;
    const Image<DepthInterval> map = interval_map(mesh, view, params, Exec{});
    std::size_t wrong = 0;
    for (int y = 0; y < map_side; ++y) {
        for (int x = 0; x < map_side; ++x) {
            const float depth = tree_value(tree.code, x, y);
            wrong += map(x, y).entry <= depth && depth <= map(x, y).exit ? 0 : 1;
        }
    }
    return wrong;
}

/// Where texel column X lies.
struct Columns {
    double first, last;
    explicit Columns(const LightView& view)
        : first(to_map_space(view, {0, 0, 0}).x), last(to_map_space(view, {128, 0, 0}).x) {}
    double at(double X) const { return (X - first) / (last - first) * 128; }
    bool mirrored() const { return last < first; }
};

TEST(FacetSheets, ASheetBehindTheExtensionOfARampsPlane) {
    std::mt19937 random(5);
    for (int t = 0; t < trials(); ++t) {
        Mesh mesh = corners_of_the_map();
        const Columns column(from_above(mesh));
        const int q = 8 << (t % 3),
                  base = 2 * q * static_cast<int>(random() % static_cast<unsigned>(128 / (2 * q)));
        double edge = column.at(base + q * draw(random, 0.03, 0.48)), end = column.at(base + 1.5 * q);
        if (column.mirrored()) {
            edge = column.at(base + 2 * q - q * draw(random, 0.03, 0.48));
            end = column.at(base + 0.5 * q);
        }
        const double slope = draw(random, -0.05, 0.05), parting = draw(random, 0.002, 0.02),
                     level = draw(random, 8, 12);
        const auto first = [&](double x) { return level + slope * (x - edge); };
        const auto second = [&](double x) { return first(x) - parting * (x - edge); };
        add_quad(mesh, {edge, first(edge), 0}, {end, first(end), 0}, {end, first(end), 128},
                 {edge, first(edge), 128});
        add_quad(mesh, {edge, second(edge), 0}, {end, second(end), 0}, {end, second(end), 128},
                 {edge, second(edge), 128});
        // Bumps beside the first sheet, behind its plane.
        const double behind = parting * (end - edge) * draw(random, 0.2, 0.45),
                     far_end = end + q * draw(random, 0.5, 1);
        const std::uint32_t across = 1 + static_cast<std::uint32_t>(t) % 8,
                            along = 2 + static_cast<std::uint32_t>(t) % 40;
        Mesh bumps;
        for (std::uint32_t j = 0; j <= along; ++j) {
            for (std::uint32_t i = 0; i <= across; ++i) {
                const double x = end + (far_end - end) * i / across;
                bumps.positions.push_back(
                    to_float(Vec3d{x, first(x) - behind * draw(random, 0.9, 1), 128.0 * j / along}));
            }
        }
        for (std::uint32_t j = 0; j < along; ++j) {
            for (std::uint32_t i = 0; i < across; ++i) {
                const std::uint32_t a = j * (across + 1) + i, c = a + across + 1;
                bumps.triangles.push_back({{a, a + 1, c + 1}});
                bumps.triangles.push_back({{a, c + 1, c}});
            }
        }
        solids::add(mesh, bumps);
        for (const Receivers receivers : {Receivers::static_only, Receivers::any})
            EXPECT_EQ(outside(mesh, receivers), 0u) << "trial " << t;
    }
}

TEST(FacetSheets, AFewUnitsInTheLastPlaceApartAcrossAPowerOfTwo) {
    std::mt19937 random(5);
    const auto units = [&](int low, int high) {
        return (low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1))) * 0x1p-20;
    };
    for (int t = 0; t < trials(); ++t) {
        Mesh mesh = corners_of_the_map();
        const LightView view = from_above(mesh);
        const Columns column(view);
        const double low = to_map_space(view, {0, 0, 0}).z, high = to_map_space(view, {0, height, 0}).z;
        const double level = ((t % 2 != 0 ? 0.5 : 0.25) - low) / (high - low) * height;
        const double edge = column.at(column.mirrored() ? draw(random, 68, 127) : draw(random, 1, 60)),
                     end = column.at(column.mirrored() ? 2 : 126);
        const double near0 = level + units(-3, 3), near1 = near0 + units(-20, 20), rise = units(-30, 30),
                     parting = units(1, 60), far0 = near0 + rise, far1 = near1 + rise;
        add_quad(mesh, {edge, near0, 0}, {end, far0, 0}, {end, far1, 128}, {edge, near1, 128});
        add_quad(mesh, {edge, near0, 0}, {end, far0 - parting, 0}, {end, far1 - parting, 128},
                 {edge, near1, 128});
        EXPECT_EQ(outside(mesh, Receivers::static_only), 0u) << "trial " << t;
    }
}

}  // namespace
}  // namespace obscura
