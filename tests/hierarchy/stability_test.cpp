// Where shadow trees grow large or coarse, with numbers: the tables of hierarchy/limits.md are what this
// program prints, and with OBSCURA_PICTURES=FOLDER it writes that page's picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "core/file_output.h"
#include "core/image_io.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/query.h"
#include "hierarchy/combine.h"
#include "lessons/drawing/figure.h"
#include "tests/hierarchy/stability_cases.h"
#include "tests/hierarchy/tree_compare.h"

namespace obscura {
namespace {

using namespace stability;

/// One line of a table.
struct Row {
    std::uint64_t nodes = 0, texels_rasterized = 0;
    double per_texel = 0;  ///< nodes
};

Row build_row(const std::string& name, const Mesh& mesh, const LightView& view,
              Receivers receivers = Receivers::any) {
    BuildParams params;
    params.receivers = receivers;
    BuildStats stats;
    const MultiresTree tree = build_shadow_tree(mesh, view, params, Exec{}, &stats);
    const double texels = static_cast<double>(view.width) * view.height;
    const Row row{tree.nodes.size() + 1, stats.texels_rasterized,
                  static_cast<double>(tree.nodes.size() + 1) / texels};
    std::cout << "| " << std::setw(24) << std::left << name << " | "
              << (receivers == Receivers::any ? "any   " : "static") << " | " << std::setw(5) << std::right
              << view.width << " | " << std::setw(9) << row.nodes << " | " << std::setw(6) << std::fixed
              << std::setprecision(2) << 100 * static_cast<double>(row.texels_rasterized) / texels
              << " % |\n";
    return row;
}

/// However large the tree: it is the one of the definition, and every texel finds a depth of its interval.
void expect_exact(const Mesh& mesh, const LightView& view, Receivers receivers = Receivers::any) {
    BuildParams params;
    params.receivers = receivers;
    const MultiresTree tree = build_shadow_tree(mesh, view, params, Exec{});
    IntervalParams of_map;
    of_map.receivers = receivers;
    const Image<DepthInterval> map = interval_map(mesh, view, of_map, Exec{});
    EXPECT_TRUE(same_tree(tree, build_bottom_up(map.view())));
    std::size_t outside = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const float value = value_at(tree, static_cast<unsigned>(x), static_cast<unsigned>(y));
            outside += !contains(map(x, y), value);
        }
    }
    EXPECT_EQ(outside, 0u);
}

double ratio(std::uint64_t a, std::uint64_t b) {
    return static_cast<double>(a) / static_cast<double>(b);
}

const Vec3d from_above{0.02, -1, 0.03};

TEST(ShadowStability, SlopedOpenSheetsCostTheArea) {
    const Mesh mesh = sloped_sheet();
    for (const Receivers receivers : {Receivers::any, Receivers::static_only}) {
        expect_exact(mesh, sun_view(mesh, from_above, 512), receivers);
        Row before = build_row("sloped sheet", mesh, sun_view(mesh, from_above, 1024), receivers);
        for (const int side : {2048, 4096}) {
            const Row row = build_row("sloped sheet", mesh, sun_view(mesh, from_above, side), receivers);
            const double growth = ratio(row.nodes, before.nodes);
            if (receivers == Receivers::any) {
                EXPECT_GT(growth, 3.9) << "zero-width intervals at as many depths as texels";
            } else {
                EXPECT_LT(growth, 2.2);
            }
            before = row;
        }
    }
}

TEST(ShadowStability, FinsWithoutThicknessCostTheArea) {
    // To receivers that may be anywhere; a plate of any thickness mends it, in the end. To the scene's own
    // surfaces a fin is a sheet: one solid fewer, the same tree as that of the open sheet.
    const Mesh fin = sloped_fin();
    expect_exact(fin, sun_view(fin, from_above, 512));
    const Row fin_1k = build_row("fin", fin, sun_view(fin, from_above, 1024));
    const Row fin_2k = build_row("fin", fin, sun_view(fin, from_above, 2048));
    EXPECT_GT(ratio(fin_2k.nodes, fin_1k.nodes), 3.9);
    const Row as_static = build_row("fin", fin, sun_view(fin, from_above, 2048), Receivers::static_only);
    EXPECT_LT(ratio(as_static.nodes, fin_2k.nodes), 0.02);
    for (const double thickness : {0.001, 0.01, 0.1}) {
        const Mesh plate = sloped_plate(thickness);
        const std::string name = "plate of " + std::to_string(thickness).substr(0, 5) + " m";
        const Row small = build_row(name, plate, sun_view(plate, from_above, 1024));
        const Row large = build_row(name, plate, sun_view(plate, from_above, 2048));
        // At a millimetre, intervals are shorter than the step in depth from texel to texel: no gain yet.
        if (thickness < 0.005) {
            EXPECT_GT(ratio(large.nodes, fin_2k.nodes), 0.99);
        } else {
            EXPECT_LT(ratio(large.nodes, fin_2k.nodes), 0.25);
        }
        // Where intervals span several texels, the rest of the growth is the outline's.
        if (thickness > 0.05) {
            EXPECT_LT(ratio(large.nodes, small.nodes), 2.2);
        }
    }
}

TEST(ShadowStability, GrazingLightCostsNodesPerCoveredTexel) {
    const Mesh mesh = small_city(0);
    double at_60 = 0;
    for (const double elevation : {60.0, 10.0, 3.0, 1.0, 0.2}) {
        const std::string name = "sun at " + std::to_string(elevation).substr(0, 4) + " degrees";
        expect_exact(mesh, sun_view(mesh, sun_at(elevation), 256));
        const Row small = build_row(name, mesh, sun_view(mesh, sun_at(elevation), 2048));
        const Row large = build_row(name, mesh, sun_view(mesh, sun_at(elevation), 4096));
        EXPECT_LT(ratio(large.nodes, small.nodes), 2.3);
        // Seen from the side, the city fills only a strip of its map, which has more borders for its size.
        const Image<DepthInterval> map =
            interval_map(mesh, sun_view(mesh, sun_at(elevation), 2048), {}, Exec{});
        const auto covered = static_cast<std::uint64_t>(
            std::count_if(map.pixels.begin(), map.pixels.end(),
                          [](const DepthInterval& i) { return i != DepthInterval{}; }));
        std::cout << "|   covered texels at 2048: " << covered
                  << ", nodes per 1000 of them: " << 1000 * ratio(small.nodes, covered) << " |\n";
        if (at_60 == 0) at_60 = ratio(small.nodes, covered);
        EXPECT_LT(ratio(small.nodes, covered), 2 * at_60);
        if (elevation < 20) {
            EXPECT_GT(ratio(small.nodes, covered), 1.2 * at_60);
        }
    }
}

TEST(ShadowStability, FoliageCostsTheArea) {
    const std::optional<Mesh> mesh = ficus();
    if (!mesh) GTEST_SKIP() << "no shared data: ficus_tree";
    // Static receivers mend little of this plant: most of its leaves are closed, sheets back to back.
    std::size_t open = 0;
    for (const std::uint32_t c : mesh->component)
        open += !mesh->components[c].closed;
    std::cout << "ficus_tree: " << open << " of " << mesh->triangles.size() << " triangles are open\n";
    std::uint64_t any = 0, fixed = 0;
    for (const Receivers receivers : {Receivers::any, Receivers::static_only}) {
        for (const int side : {1024, 2048, 4096}) {
            const Row row = build_row("ficus_tree", *mesh, sun_view(*mesh, {0.3, -1, 0.2}, side), receivers);
            (receivers == Receivers::any ? any : fixed) = row.nodes;
        }
    }
    EXPECT_LT(fixed, any);
    EXPECT_LT(ratio(any, fixed), 1.1);
}

TEST(ShadowStability, ALightInsideASolidCostsTheArea) {
    const Mesh solid = lamp_room(false), hollow = lamp_room(true);
    expect_exact(solid, lamp_view(256));
    expect_exact(hollow, lamp_view(256));
    const Row solid_1k = build_row("lamp inside a solid", solid, lamp_view(1024));
    const Row solid_2k = build_row("lamp inside a solid", solid, lamp_view(2048));
    EXPECT_GT(ratio(solid_2k.nodes, solid_1k.nodes), 3.9);
    EXPECT_GT(solid_2k.per_texel, 0.5);
    const Row static_2k = build_row("lamp inside a solid", solid, lamp_view(2048), Receivers::static_only);
    EXPECT_LT(static_2k.per_texel, 0.02);
    const Row hollow_2k = build_row("lamp between walls", hollow, lamp_view(2048));
    EXPECT_LT(hollow_2k.per_texel, 0.02);
}

TEST(ShadowStability, FarFromTheOriginPositionsRunOutNotTrees) {
    std::uint64_t here = 0;
    for (const double shift : {0.0, 1e5, 1e6}) {
        const Mesh mesh = small_city(shift);
        expect_exact(mesh, sun_view(mesh, {0.31, -1, 0.23}, 256));
        const Row row = build_row(std::to_string(static_cast<int>(shift)) + " m from the origin", mesh,
                                  sun_view(mesh, {0.31, -1, 0.23}, 4096));
        if (here == 0) here = row.nodes;
        EXPECT_LT(ratio(row.nodes, here), 1.5);
    }
}

TEST(ShadowStability, WallsAHairApartAreRasterized) {
    std::uint64_t touching = 0;
    for (const double gap : {0.0, 1e-7, 1e-6, 1e-5, 1e-4, -1e-4, -1e-6}) {
        const Mesh mesh = party_wall(gap);
        expect_exact(mesh, sun_view(mesh, {1, -0.1, 0.15}, 512));
        std::ostringstream name;
        name << "gap of " << gap << " m";
        const Row row = build_row(name.str(), mesh, sun_view(mesh, {1, -0.1, 0.15}, 2048));
        if (gap == 0.0) touching = row.texels_rasterized;
        EXPECT_GE(row.texels_rasterized, touching) << "nothing is easier than faces on one plane";
    }
}

/// Points beside the cubes that are rightly lit, and rightly dark.
struct Found {
    int lit = 0, dark = 0;
    static constexpr int all = cubes_a_side * cubes_a_side;
};
Found look_beside_cubes(double size_m, int side) {
    const Mesh mesh = plain_with_cubes(size_m);
    const LightView view = sun_view(mesh, {1, -1, 0}, side);
    std::vector<std::int32_t> x, y;
    std::vector<float> depth;
    const int cubes = Found::all;
    NeededNodes needed;
    for (int i = 0; i < 2 * cubes; ++i) {
        // Behind the cube, in the middle of its shadow; before it, in the sun.
        const Vec3d p = cube_base(i % cubes, size_m) + Vec3d{size_m * (i < cubes ? 1.0 : -1.5), 0, 0};
        const Vec3d m = to_map_space(view, p);
        x.push_back(static_cast<int>(m.x));
        y.push_back(static_cast<int>(m.y));
        depth.push_back(static_cast<float>(m.z));
        needed.add(static_cast<unsigned>(x.back()), static_cast<unsigned>(y.back()), 0);
    }
    needed.finish();
    BuildParams params;
    params.needed = &needed;
    const ShadowTree tree = encode_tree(build_shadow_tree(mesh, view, params, Exec{}), view);
    std::vector<std::uint16_t> lit((x.size() + 15) / 16);
    OBSCURA_DISPATCH(Exec{}.isa, visibility, tree.code, MapPoints{x.data(), y.data(), depth.data(), x.size()},
                     0, lit.data());
    Found found;
    for (int i = 0; i < 2 * cubes; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const bool is_lit = (lit[at / 16] >> (at % 16) & 1) != 0;
        if (i < cubes) found.dark += !is_lit;
        if (i >= cubes) found.lit += is_lit;
    }
    std::cout << "| cubes of " << std::lround(size_m * 100) << " cm | " << side << " | " << found.dark
              << " | " << found.lit << " | of " << Found::all << "\n";
    return found;
}

TEST(ShadowStability, TenKilometresWithCentimetres) {
    // A texel of the largest map covers 10 x 13 mm here: details of some texels are there, those below come
    // and go.
    const int largest = 1 << 20;
    const Found four = look_beside_cubes(0.04, largest), ten = look_beside_cubes(0.1, largest);
    EXPECT_EQ(ten.dark, Found::all);
    EXPECT_EQ(ten.lit, Found::all);
    EXPECT_EQ(four.dark, Found::all);
    EXPECT_EQ(four.lit, Found::all);
    const Found two = look_beside_cubes(0.02, largest), one = look_beside_cubes(0.01, largest);
    EXPECT_GE(two.dark, one.dark);
    EXPECT_LT(one.dark, Found::all) << "a shadow thinner than a texel cannot all be found";
    const Found coarse = look_beside_cubes(0.1, 1 << 14);
    EXPECT_LT(coarse.dark, Found::all / 2);
}

/// Nodes of a tree by where they stand, in squares of a map of `side` squares; those larger than a square do
/// not count.
Image<float> node_density(const MultiresTree& tree, int side) {
    Image<float> density(side, side, 0.0f);
    struct Place {
        const MultiresNode* node;
        int x, y, level;
    };
    const int square_level = tree.levels - std::countr_zero(static_cast<unsigned>(side));
    std::vector<Place> open = {{&tree.root, 0, 0, tree.levels}};
    while (!open.empty()) {
        const Place p = open.back();
        open.pop_back();
        if (p.level <= square_level)
            density(p.x >> (square_level - p.level), p.y >> (square_level - p.level)) += 1;
        std::uint64_t next = p.node->first_child();
        for (int i = 0; i < 4; ++i) {
            if (p.node->child(i) == ChildKind::none) continue;
            open.push_back({&tree.nodes[next++], 2 * p.x + i % 2, 2 * p.y + i / 2, p.level - 1});
        }
    }
    return density;
}

/// One map of node density with its name. Returns the share of its squares that have nodes.
double draw_panel(Figure& figure, int x, int y, const std::string& name, const Mesh& mesh,
                  const LightView& view, Receivers receivers) {
    constexpr int squares = 256;
    BuildParams params;
    params.receivers = receivers;
    const MultiresTree tree = build_shadow_tree(mesh, view, params, Exec{});
    const Image<float> density = node_density(tree, squares);
    const double most = std::log2(1.0 + 4.0 / 3 * (view.width / squares) * (view.width / squares));
    int busy = 0;
    Image<Rgb8> cells(squares, squares);
    for (std::size_t i = 0; i < density.pixels.size(); ++i) {
        const float nodes = density.pixels[i];
        busy += nodes > 0;
        cells.pixels[i] = nodes > 0 ? heat(std::log2(1.0 + static_cast<double>(nodes)) / most) : ink::panel;
    }
    figure.image(x, y, cells, 1);
    figure.text({x + 0.0, y + 275.0}, name, lettering::bold);
    figure.text({x + 0.0, y + 293.0}, std::to_string(tree.nodes.size() + 1) + " nodes");
    return static_cast<double>(busy) / (squares * squares);
}

TEST(ShadowStability, PictureOfWhereNodesAre) {
    Figure figure(868, 720);
    figure.text({24, 30}, "Where the nodes are: trees of 1024 x 1024 texels", lettering::head);
    figure.text({24, 52},
                "grey: no node as small as a pixel of 4 x 4 texels; dark blue to yellow: 1 node to 21");
    const Mesh sheet = sloped_sheet(), city = small_city(0);
    const auto panel = [&](int column, int row, const std::string& name, const Mesh& mesh,
                           const LightView& view, Receivers receivers) {
        return draw_panel(figure, 24 + column * 280, 72 + row * 320, name, mesh, view, receivers);
    };
    const LightView above = sun_view(sheet, from_above, 1024);
    const double open = panel(0, 0, "open sheet, any receivers", sheet, above, Receivers::any);
    const double fixed = panel(1, 0, "open sheet, static", sheet, above, Receivers::static_only);
    EXPECT_GT(open, 4 * fixed);
    const Mesh plate = sloped_plate(0.01);
    panel(2, 0, "plate of 1 cm", plate, sun_view(plate, from_above, 1024), Receivers::any);
    panel(0, 1, "city, sun at 10 degrees", city, sun_view(city, sun_at(10), 1024), Receivers::any);
    const Mesh solid = lamp_room(false);
    EXPECT_GT(panel(1, 1, "lamp inside a solid", solid, lamp_view(1024), Receivers::any), 0.9);
    if (const std::optional<Mesh> plant = ficus()) {
        panel(2, 1, "ficus, any receivers", *plant, sun_view(*plant, {0.3, -1, 0.2}, 1024), Receivers::any);
    }
    if (const char* folder = std::getenv("OBSCURA_PICTURES"); folder != nullptr) {
        const std::filesystem::path file = std::filesystem::path(folder) / "limits.png";
        write_file_atomically(file, encode_png(figure.picture.view()), Existing::replace);
        std::cout << "wrote " << file << "\n";
    }
}

}  // namespace
}  // namespace obscura
