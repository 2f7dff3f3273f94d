// [[terrain]] in scenes: where it stands, what it looks like, and what limits say to it.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/scene/build.h"
#include "app/scene/scene_file.h"
#include "core/error.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

class TerrainScene : public testing::Test {
  protected:
    void SetUp() override {
        std::ofstream(folder / "t.asc") << "ncols 4\nnrows 3\ncellsize 10\n1 2 3 4\n5 9 7 6\n1 2 3 2\n";
    }

    Scene build(const std::string& keys, const std::string& more = "") const {
        const SceneDocument document = read_scene_text(
            "format = 1\ncamera = {eye_m = [0, 90, 200], look_at_m = [0, 0, 0]}\n[[terrain]]\nid = \"t\"\n"
            "file = \"t.asc\"\n" +
                keys + "\n" + more,
            "s.toml");
        FileAccess access;
        access.root = folder;
        return build_scene(document, access);
    }
    std::string limit(const std::string& keys, const std::string& more) const {
        try {
            build(keys, more);
        } catch (const LimitError& error) {
            return error.what();
        }
        return "no error";
    }

    TemporaryFolder temporary;
    const fs::path folder = temporary.path;
};

TEST_F(TerrainScene, StandsWhereItIsPut) {
    const Scene scene = build("translate_m = [100, 20, -30]\nskirt_m = 4");
    Vec3f least{1e9f, 1e9f, 1e9f}, most{-1e9f, -1e9f, -1e9f};
    for (const Vec3f p : scene.mesh.positions) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    EXPECT_EQ(least, (Vec3f{85, 20 + 1 - 4, -40}));
    EXPECT_EQ(most, (Vec3f{115, 20 + 9, -20}));
    // 2 x 6 on the ground; two for a wall and one of the floor for each of 10 steps of the border.
    EXPECT_EQ(scene.mesh.triangles.size(), 12u + 30u);
    ASSERT_EQ(scene.mesh.objects.size(), 1u);
    EXPECT_EQ(scene.mesh.objects[0].name, "t");
    EXPECT_TRUE(scene.mesh.objects[0].casts_shadow);
    EXPECT_FALSE(build("casts_shadow = false").mesh.objects[0].casts_shadow);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
}

TEST_F(TerrainScene, HasItsMaterialOrALookOfItsOwn) {
    const Scene plain = build("material = \"clay\"", "[material.clay]\nbase_color = [0.5, 0.25, 0.125]\n");
    EXPECT_TRUE(plain.textures.empty());
    for (const std::uint32_t m : plain.mesh.material)
        EXPECT_EQ(plain.materials.at(m).name, "clay");
    const Scene own = build("");
    ASSERT_EQ(own.textures.size(), 1u);
    EXPECT_EQ(own.textures[0].levels[0].width, 4);
    for (const std::uint32_t m : own.mesh.material)
        EXPECT_EQ(own.materials.at(m).name, "t/ground");
}

TEST_F(TerrainScene, LimitsHold) {
    EXPECT_NE(limit("", "[limits]\ntriangles = 41\n")
                  .find("terrain 't' brings the scene to 42 triangles, more than limits.triangles = 41"),
              std::string::npos);
    EXPECT_EQ(build("", "[limits]\ntriangles = 42\n").mesh.triangles.size(), 42u);
    {
        std::ofstream large(folder / "t.asc");
        large << "ncols 100\nnrows 100\ncellsize 10\n";
        for (int i = 0; i < 100 * 100; ++i)
            large << "1 ";
    }
    EXPECT_NE(limit("", "[limits]\nmemory_mib = 1\n")
                  .find("as a mesh of a scene, more than 1 MiB (limits.memory_mib)"),
              std::string::npos);
    EXPECT_EQ(limit("", "[limits]\nmemory_mib = 8\n"), "no error");
    std::ofstream(folder / "t.asc", std::ios::app) << std::string(200'000, ' ');
    EXPECT_NE(limit("", "[limits]\nmemory_mib = 1\n").find("an eighth of limits.memory_mib"),
              std::string::npos);
}

TEST_F(TerrainScene, FarFromTheOriginRoundingIsTold) {
    const Scene scene = build("translate_m = [3e8, 0, 0]");
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0].find("terrain 't': single precision has steps of 32 m where it stands"), 0u)
        << scene.notes[0];
}

}  // namespace
}  // namespace obscura
