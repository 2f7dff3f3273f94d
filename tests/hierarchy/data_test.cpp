// Shadow trees of real buildings, scans and a plant: every texel decodes to a depth of its own interval, the
// construction equals its definition, and its work and size grow as a line does.
//
// Takes minutes with CI=true or OBSCURA_SLOW_TESTS=1: larger maps, more texels.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <random>

#include "app/models/obj_file.h"
#include "bench/harness/recipes.h"
#include "bench/shadows/scenes.h"
#include "core/topology.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/query.h"
#include "hierarchy/combine.h"
#include "raster/view.h"
#include "tests/core/shared_folder.h"
#include "tests/hierarchy/region_oracle.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/raster/raster_solids.h"

namespace obscura {
namespace {

const std::filesystem::path data_folder = shared_folder("data");
constexpr int region_side = RegionOracle::side;

struct Lit {
    Mesh mesh;
    Vec3d sun;
    LightView view(int side) const { return orthographic_light_view(bounds_of(mesh), normalize(sun), side); }
};

/// A scene of the bench, as its charts show it, or solids that run through each other. Nothing: no data here.
std::optional<Lit> lit_scene(const std::string& name) {
    if (name == "random_solids") return Lit{solids::random_solids(77, 150, false, false), {0.3, -1, 0.2}};
    const bool have = std::filesystem::exists(data_folder);
    for (const ShadowRecipe& recipe :
         shadow_recipes(have ? std::optional(data_folder) : std::nullopt, false)) {
        if (recipe.name == name) return Lit{stage_shadows(recipe, {}).mesh, recipe.sun};
    }
    return {};
}

/// A model alone, as its file has it.
std::optional<Mesh> model(const std::string& file) {
    if (!std::filesystem::exists(data_folder / file)) return {};
    const FileAccess access{data_folder, {}};
    return load_obj(resolve_input(access, file), access, Limits{}).mesh;
}

/// Where the samples are taken: at random, along borders of nodes of every size, and round corners of the
/// mesh; on multiples of 32 texels.
std::vector<std::pair<int, int>> regions(const Lit& scene, const LightView& view, int count) {
    std::mt19937 rng(static_cast<unsigned>(count));
    const auto below = [&](int n) { return static_cast<int>(rng() % static_cast<unsigned>(n)); };
    const int last = view.width / 32 - 2;
    std::vector<std::pair<int, int>> at;
    for (int i = 0; i < count; ++i) {
        int x = below(last + 1), y = below(last + 1);
        if (i % 3 == 1) {
            const int node = 2 << below(static_cast<int>(std::bit_width(static_cast<unsigned>(last))) -
                                        1);  // in units of 32
            (i % 2 == 0 ? x : y) = (1 + below(std::max(view.width / 32 / node - 1, 1))) * node - 1;
        }
        if (i % 3 == 2) {
            const auto v = rng() % scene.mesh.positions.size();
            const Vec3d p = to_map_space(view, to_double(scene.mesh.positions[v]));
            x = static_cast<int>(p.x) / 32 - below(2);
            y = static_cast<int>(p.y) / 32 - below(2);
        }
        at.emplace_back(32 * std::clamp(x, 0, last), 32 * std::clamp(y, 0, last));
    }
    return at;
}

/// The texels of a picture of intervals whose decoded value is not in them.
class Decoded {
  public:
    explicit Decoded(const ShadowTree& tree) : tree_(tree) {}

    std::size_t failures(const DepthInterval* intervals, int x0, int y0, int width, int height) {
        const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        x_.resize(count);
        y_.resize(count);
        value_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            x_[i] = x0 + static_cast<int>(i) % width;
            y_[i] = y0 + static_cast<int>(i) / width;
        }
        OBSCURA_DISPATCH(Exec{}.isa, stored_values, tree_.code, x_.data(), y_.data(), count, 0,
                         value_.data());
        std::size_t outside = 0;
        for (std::size_t i = 0; i < count; ++i)
            outside += !contains(intervals[i], value_[i]);
        checked += count;
        return outside;
    }
    std::size_t checked = 0;

  private:
    const ShadowTree& tree_;
    std::vector<std::int32_t> x_, y_;
    std::vector<float> value_;
};

void check_every_texel(const Lit& scene, int side, Receivers receivers) {
    const LightView view = scene.view(side);
    BuildParams params;
    params.receivers = receivers;
    params.keep_intervals = true;
    const MultiresTree tree = build_shadow_tree(scene.mesh, view, params, Exec{});
    std::vector<ShadowTree> encoded;
    for (const ShadowCodeRow& row : shadow_codes) {
        EncodeParams encode;
        encode.code = row.code;
        encoded.push_back(is_from_mesh(row, params)
                              ? row.from_mesh(scene.mesh, view, params, encode, nullptr, nullptr)
                              : encode_tree(tree, view, encode));
    }
    std::vector<Decoded> decoded(encoded.begin(), encoded.end());
    const int rows = std::min(side, 1024);
    RasterScratch scratch;
    Image<DepthInterval> strip(side, rows);
    std::vector<std::size_t> outside(encoded.size(), 0);
    for (int y = 0; y < side; y += rows) {
        IntervalParams of_strip;
        of_strip.receivers = receivers;
        of_strip.region = {0, y, side, rows};
        interval_map(scene.mesh, view, of_strip, Exec{}, scratch, strip.view());
        for (std::size_t i = 0; i < encoded.size(); ++i)
            outside[i] += decoded[i].failures(strip.pixels.data(), 0, y, side, rows);
    }
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        EXPECT_EQ(outside[i], 0u) << name_of(shadow_codes[i].code) << ", of " << decoded[i].checked
                                  << " texels";
    }
    EXPECT_LT(encoded[1].bytes, encoded[0].bytes) << "merging found something";
    if (side <= 4096) {
        EXPECT_TRUE(same_tree(tree, bottom_up_tree(scene.mesh, view, receivers)));
    }
}

/// `whole`: of a tree of everything; else of one that is only what the samples need, which open scenes at
/// these sizes need, too: their whole trees follow the area.
void check_samples(const Lit& scene, int side, bool whole, int count) {
    const LightView view = scene.view(side);
    const auto at = regions(scene, view, count);
    BuildParams params;
    NeededNodes needed;
    for (const auto& [x, y] : at) {
        for (int k = 0; k < 4; ++k)
            needed.add_texels(static_cast<unsigned>(x / 32 + k % 2), static_cast<unsigned>(y / 32 + k / 2),
                              5);
    }
    needed.finish();
    if (!whole) params.needed = &needed;
    std::vector<ShadowTree> trees{encode_tree(build_shadow_tree(scene.mesh, view, params, Exec{}), view)};
    for (const ShadowCodeRow& row : shadow_codes) {
        if (is_from_mesh(row, params))
            trees.push_back(row.from_mesh(scene.mesh, view, params, {}, nullptr, nullptr));
    }
    RegionOracle oracle(scene.mesh, view, Receivers::any);
    std::vector<Decoded> decoded(trees.begin(), trees.end());
    std::vector<std::size_t> outside(trees.size(), 0);
    std::size_t covered = 0;
    for (const auto& [x, y] : at) {
        const std::vector<DepthInterval>& intervals = oracle.intervals(x, y);
        for (std::size_t i = 0; i < trees.size(); ++i)
            outside[i] += decoded[i].failures(intervals.data(), x, y, region_side, region_side);
        covered += intervals[0] != DepthInterval{};
    }
    for (std::size_t i = 0; i < trees.size(); ++i) {
        EXPECT_EQ(outside[i], 0u) << name_of(trees[i].code.code) << ", of " << decoded[i].checked
                                  << " texels";
    }
    EXPECT_GT(covered, at.size() / 8) << "samples that see nothing prove nothing";
}

class ShadowData : public ::testing::TestWithParam<const char*> {};

TEST_P(ShadowData, EveryTexelDecodesToADepthOfItsInterval) {
    const std::string name = GetParam();
    const std::optional<Lit> scene = lit_scene(name);
    if (!scene) GTEST_SKIP() << "no shared data: " << name;
    const bool open = name == "bunny" || name == "ficus_tree";
    check_every_texel(*scene, 1024, Receivers::any);
    check_every_texel(*scene, 1024, Receivers::static_only);
    check_samples(*scene, 1 << 20, false, 60);
    if (!slow_tests()) return;
    check_every_texel(*scene, 4096, Receivers::static_only);
    check_every_texel(*scene, 8192, Receivers::any);
    // 10^8 samples over the eight scenes.
    check_samples(*scene, 65536, !open, 1600);
    check_samples(*scene, 1 << 20, name == "armadillo", 1600);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShadowData,
                         ::testing::Values("vienna_west", "city_large", "armadillo", "dragon_res2", "bunny",
                                           "ficus_tree", "fzk_house", "random_solids"),
                         [](const auto& scene) { return std::string(scene.param); });

struct Growth {
    std::uint64_t texels = 0, nodes = 0, bytes = 0;
};
Growth growth_at(const Mesh& mesh, Vec3d sun, int side) {
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(sun), side);
    BuildStats stats;
    const MultiresTree tree = build_shadow_tree(mesh, view, {}, Exec{}, &stats);
    const MultiresCounts counts = count_nodes(tree);
    return {stats.texels_rasterized, tree.nodes.size(), 8 * counts.full + 4 * (counts.empty + counts.leaf)};
}

/// Texels rasterized from 4096 to 65536, and the size of the tree from doubling to doubling: all of them in
/// slow tests, else the first.
void check_growth(const char* name, const Mesh& mesh, Vec3d sun, double texel_exponent) {
    const auto measured = [&](int side) {
        const Growth g = growth_at(mesh, sun, side);
        std::cout << name << " " << side << ": " << g.texels << " texels rasterized, " << g.nodes
                  << " nodes, " << g.bytes << " bytes\n";
        return g;
    };
    const Growth first = measured(4096);
    Growth last = first;
    for (int side = 8192; side <= 65536; side *= 2) {
        if (!slow_tests() && side != 8192 && side != 65536) continue;
        const Growth now = measured(side);
        const double doublings = slow_tests() || side == 8192 ? 1 : 3;
        const double ratio = static_cast<double>(now.bytes) / static_cast<double>(last.bytes);
        EXPECT_GT(ratio, std::pow(1.9, doublings)) << side;
        EXPECT_LT(ratio, std::pow(2.3, doublings)) << side;
        last = now;
    }
    const double exponent =
        std::log2(static_cast<double>(last.texels) / static_cast<double>(first.texels)) / 4;
    std::cout << name << ": texels rasterized grow as N^" << exponent << "\n";
    EXPECT_LE(exponent, texel_exponent);
}

TEST(ShadowGrowth, ACityOfBoxes) {
    Mesh mesh = box_city(30, 30);
    if (mesh.component.empty()) analyse_topology(mesh);
    check_growth("city", mesh, {0.31, -1, 0.23}, 1.15);
}

TEST(ShadowGrowth, RealBuildings) {
    const std::optional<Mesh> mesh = model("cities/vienna_west.obj");
    if (!mesh) GTEST_SKIP() << "no shared data: vienna_west";
    check_growth("vienna_west", *mesh, {0.31, -1, 0.23}, 1.15);
    // A low sun looks along many party walls, which differ by less than depths can tell: see
    // hierarchy/limits.md.
    if (slow_tests()) check_growth("vienna_west, low sun", *mesh, {0.55, -0.62, -0.38}, 1.2);
}

/// Texels that see anything.
std::uint64_t covered_texels(const Mesh& mesh, const LightView& view) {
    RasterScratch scratch;
    const int rows = std::min(view.height, 512);
    Image<DepthInterval> strip(view.width, rows);
    std::uint64_t covered = 0;
    for (int y = 0; y < view.height; y += rows) {
        IntervalParams params;
        params.region = {0, y, view.width, rows};
        interval_map(mesh, view, params, Exec{}, scratch, strip.view());
        for (const DepthInterval& i : strip.pixels)
            covered += i != DepthInterval{};
    }
    return covered;
}

TEST(ShadowGrowth, ScansRasterizeLessThanATenthOfWhatTheyCover) {
    for (const char* file : {"meshes/armadillo.obj", "meshes/dragon_res2.obj"}) {
        if (!slow_tests() && file != std::string("meshes/armadillo.obj")) continue;
        const std::optional<Mesh> mesh = model(file);
        if (!mesh) GTEST_SKIP() << "no shared data: " << file;
        const LightView view =
            orthographic_light_view(bounds_of(*mesh), normalize(Vec3d{0.31, -1, 0.23}), 16384);
        BuildStats with, without;
        BuildParams params;
        build_shadow_tree(*mesh, view, params, Exec{}, &with);
        params.mesh_certificate = false;
        const std::uint64_t covered = covered_texels(*mesh, view);
        std::cout << file << ": " << with.texels_rasterized << " texels rasterized of " << covered
                  << " covered\n";
        EXPECT_LT(10 * with.texels_rasterized, covered);
        if (!slow_tests()) continue;
        build_shadow_tree(*mesh, view, params, Exec{}, &without);
        std::cout << file << ": " << without.texels_rasterized << " without the mesh certificate\n";
        EXPECT_GT(without.texels_rasterized, 5 * with.texels_rasterized);
    }
}

}  // namespace
}  // namespace obscura
