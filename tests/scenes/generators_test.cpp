#include "scenes/generators.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/hash.h"
#include "core/image_io.h"
#include "scenes/city.h"
#include "scenes/patterns.h"
#include "tests/core/mesh_checks.h"

namespace obscura {
namespace {

using namespace mesh_checks;

/// Closed, outward, clean, within its slots, and the same bits as when the golden hash was written down.
void expect_good(const char* name, const GeneratedModel& model, const char* golden_hash) {
    SCOPED_TRACE(name);
    const Verdict v = inspect(model.mesh);
    EXPECT_TRUE(v.arrays_agree);
    EXPECT_GT(v.solids, 0u);
    EXPECT_EQ(v.open_parts, 0u);
    EXPECT_EQ(v.inside_out, 0u);
    EXPECT_EQ(v.degenerate, 0u);
    EXPECT_EQ(v.bad_normals, 0u);
    for (const std::uint32_t m : model.mesh.material)
        ASSERT_LT(m, model.materials.size());
    EXPECT_EQ(hash_text(hash(model.mesh)), golden_hash);
}

TEST(Generators, AreClosedOutwardAndReproducible) {
    expect_good("arcade", arcade({}), "915031604b199387");
    expect_good("stairs", stairs({}), "e9bfd380833dd69b");
    expect_good("fence", fence({}), "d9e10a6d9a6dd482");
    expect_good("tree", tree({}), "16d777a95a6a622f");
    expect_good("lamp_post", lamp_post({}), "073a1d2c8ab9d904");
    expect_good("planter", planter({}), "5c60722910b54586");
    expect_good("hedge", hedge({}), "1bf395af1d81f33b");
    expect_good("bench", bench({}), "48b30b54e2602942");
    expect_good("fountain", fountain({}), "0c579da44a89a553");
    expect_good("pavement", pavement({}), "e1b34dc2c49f5bb5");
    expect_good("roof_tiles", roof_tiles({}), "690f0ac3f6d37a9e");
    expect_good("window_frame", window_frame({}), "ec1790d2e4d29615");
    expect_good("pierced_wall", pierced_wall({}), "4637b7c999678ff5");
    expect_good("city", city({}), "faf86b00a6946c34");
    expect_good("house", house({}), "808da70d9f92aac7");
    expect_good("figure", figure({}), "daf004305870bbc2");
    expect_good("lion_head", lion_head({}), "ac0d9ec0a0bdbd1b");
    expect_good("cliffs", cliffs({}), "ae59a1b6fabe6ae2");
}

TEST(Patterns, AreWhatTheFilesHold) {
    for (const Pattern& pattern : patterns()) {
        const std::string path = std::string(OBSCURA_SOURCE_DIR) + "/scenes/" + pattern.file;
        std::stringstream bytes;
        bytes << std::ifstream(path, std::ios::binary).rdbuf();
        const Image<Rgba8> file = decode_png(bytes.str(), path);
        ASSERT_EQ(file.width, pattern.image.width);
        ASSERT_EQ(file.height, pattern.image.height);
        for (int y = 0; y < file.height; ++y) {
            for (int x = 0; x < file.width; ++x) {
                const Rgb8 code = pattern.image(x, y);
                ASSERT_TRUE(file(x, y).r == code.r && file(x, y).g == code.g && file(x, y).b == code.b)
                    << pattern.file << " at " << x << ", " << y
                    << "; if that is meant: obscura_textures scenes";
            }
        }
    }
}

TEST(City, HasAboutTheTrianglesThatWereAskedFor) {
    const auto ask = [](std::int64_t triangles, double extent_m, int seed) {
        CityParams p;
        p.triangles = triangles, p.extent_m = extent_m, p.seed = seed;
        const auto got = static_cast<double>(city(p).mesh.triangles.size());
        EXPECT_NEAR(got / static_cast<double>(triangles), 1, 0.05)
            << triangles << ' ' << extent_m << ' ' << seed;
    };
    for (const std::int64_t triangles : {1'000, 3'000, 10'000, 100'000, 1'000'000})
        ask(triangles, 0, 1);
    for (const int seed : {2, 3, 4, 5})
        ask(2'000, 0, seed);
    for (const double extent_m : {60.0, 400.0, 1500.0})
        ask(50'000, extent_m, 1);
}

TEST(City, IsClosedInEveryLevelOfDetail) {
    for (const std::int64_t triangles : {1'000, 10'000, 40'000}) {
        CityParams p;
        p.triangles = triangles, p.seed = 9;
        const Verdict v = inspect(city(p).mesh);
        EXPECT_EQ(v.open_parts + v.inside_out + v.degenerate + v.bad_normals, 0u) << triangles;
    }
    // Few houses, so that all of them reach the finest level.
    CityParams fine;
    fine.triangles = 200'000, fine.extent_m = 80;
    const Verdict v = inspect(city(fine).mesh);
    EXPECT_EQ(v.open_parts + v.inside_out + v.degenerate + v.bad_normals, 0u);
}

TEST(City, StaysWithinItsExtent) {
    CityParams p;
    p.triangles = 20'000, p.extent_m = 250;
    for (const Vec3f q : city(p).mesh.positions) {
        ASSERT_LE(std::fabs(q.x), 125.0f);
        ASSERT_LE(std::fabs(q.z), 125.0f);
        ASSERT_GE(q.y, -1.0f);
    }
}

TEST(Generators, SeedsGrowDifferentTrees) {
    TreeParams a, b;
    b.seed = 2;
    EXPECT_NE(hash(tree(a).mesh), hash(tree(b).mesh));
}

TEST(Generators, TreeHasItsSizeAndItsLeaves) {
    const TreeParams p;
    const GeneratedModel model = tree(p);
    float high = 0, wide = 0;
    for (const Vec3f q : model.mesh.positions) {
        high = std::max(high, q.y);
        wide = std::max(wide, std::max(std::fabs(q.x), std::fabs(q.z)));
    }
    EXPECT_NEAR(high, p.height_m, 0.15 * p.height_m);
    EXPECT_NEAR(wide, p.crown_radius_m, 0.25 * p.crown_radius_m);
    std::int64_t leaf_triangles = 0;
    for (const std::uint32_t m : model.mesh.material)
        leaf_triangles += m > 0;
    EXPECT_NEAR(static_cast<double>(leaf_triangles), 4.0 * p.leaves, 0.1 * 4 * p.leaves);
}

TEST(Generators, LampLightIsInTheOpen) {
    // Level rays from the light pass between the bars in most directions; only the bulb surrounds it.
    const LampPostParams p;
    const GeneratedModel model = lamp_post(p);
    const double y = lamp_light_height(p);
    int blocked = 0;
    for (int i = 0; i < 360; ++i) {
        const Vec2d c = on_circle((i + 0.37) / 360.0);
        for (std::size_t k = 0; k < model.mesh.triangles.size(); ++k) {
            if (model.mesh.material[k] == 1) continue;
            const Triangle& t = model.mesh.triangles[k];
            const Vec3d o{0, y, 0}, d{c.x, 0, c.y}, a = to_double(model.mesh.positions[t.v[0]]);
            const Vec3d e = to_double(model.mesh.positions[t.v[1]]) - a,
                        f = to_double(model.mesh.positions[t.v[2]]) - a;
            const Vec3d h = cross(d, f), s = o - a, q = cross(s, e);
            const double det = dot(e, h), u = dot(s, h) / det, v = dot(d, q) / det, at = dot(f, q) / det;
            if (det != 0 && u >= 0 && v >= 0 && u + v <= 1 && at > 0) {
                ++blocked;
                break;
            }
        }
    }
    EXPECT_GT(blocked, 0);
    EXPECT_LT(blocked, 60);
}

TEST(Generators, OpeningsGoRightThroughAWall) {
    const PiercedWallParams p;
    const GeneratedModel model = pierced_wall(p);
    const double solid = p.width_m * p.height_m - p.openings * p.opening_width_m * p.opening_height_m;
    EXPECT_NEAR(volume(model.mesh), solid * p.depth_m, 1e-5);
    EXPECT_NEAR(opening_x(p, 0), -opening_x(p, 1), 1e-12);
}

}  // namespace
}  // namespace obscura
