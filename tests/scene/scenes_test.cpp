// The scenes that come with the project: they build, they are as big as they say, and what ought to be solid
// is.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "app/models/file_access.h"
#include "app/scene/build.h"
#include "app/scene/scene_file.h"
#include "scenes/generators.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

Scene load(const fs::path& file) {
    const SceneDocument document = read_scene(file);
    FileAccess access;
    access.root = document.folder;
    return build_scene(document, access);
}

std::vector<fs::path> scene_files() {
    std::vector<fs::path> files;
    for (const char* folder : {"scenes", "scenes/tests"}) {
        for (const auto& entry : fs::directory_iterator(fs::path(OBSCURA_SOURCE_DIR) / folder)) {
            if (entry.path().extension() == ".toml") files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

TEST(Scenes, AreSolidButForThePlanes) {
    const std::vector<fs::path> files = scene_files();
    EXPECT_GE(files.size(), 12u);
    for (const fs::path& file : files) {
        const Scene scene = load(file);
        const auto open = std::count_if(scene.mesh.components.begin(), scene.mesh.components.end(),
                                        [](const Component& c) { return !c.closed; });
        const std::string name = file.stem();
        EXPECT_EQ(open, name == "box_on_plane" || name == "textured_quad" ? 1 : 0) << file;
        EXPECT_GT(scene.mesh.triangles.size(), 0u) << file;
        const bool glows = std::any_of(scene.materials.begin(), scene.materials.end(),
                                       [](const Material& m) { return m.emission != Vec3f{}; });
        EXPECT_TRUE(glows || !scene.lights.empty()) << file;
    }
}

TEST(Scenes, HeroesHaveTheSizeTheirReadmeStates) {
    const auto triangles = [](const char* name) {
        return load(fs::path(OBSCURA_SOURCE_DIR) / "scenes" / name).mesh.triangles.size();
    };
    EXPECT_NEAR(static_cast<double>(triangles("courtyard.toml")), 200'000, 1'000);
    EXPECT_NEAR(static_cast<double>(triangles("city.toml")), 300'000, 15'000);
    EXPECT_NEAR(static_cast<double>(triangles("interior.toml")), 37'000, 1'000);
    EXPECT_NEAR(static_cast<double>(triangles("still_life.toml")), 118'000, 1'000);
}

TEST(Problems, AreNamedBeforeAnythingIsBuilt) {
    EXPECT_EQ(problem(ArcadeParams{}) + problem(FenceParams{}) + problem(TreeParams{}), "");
    EXPECT_EQ(problem(LampPostParams{}) + problem(PavementParams{}) + problem(RoofTilesParams{}), "");
    EXPECT_EQ(problem(WindowParams{}) + problem(PiercedWallParams{}), "");
    ArcadeParams stout;
    stout.column_radius_m = 0.9;
    EXPECT_NE(problem(stout).find("bay_m"), std::string::npos);
    FenceParams tight;
    tight.spacing_m = 0.03;
    EXPECT_NE(problem(tight).find("spacing_m"), std::string::npos);
    TreeParams stump;
    stump.height_m = 2.2;
    EXPECT_NE(problem(stump).find("height_m"), std::string::npos);
    LampPostParams low;
    low.height_m = 2;
    EXPECT_NE(problem(low).find("height_m"), std::string::npos);
    PavementParams wide_joints;
    wide_joints.joint_m = 0.5;
    EXPECT_NE(problem(wide_joints).find("joint_m"), std::string::npos);
    WindowParams barred;
    barred.columns = 30;
    EXPECT_NE(problem(barred).find("columns"), std::string::npos);
    PiercedWallParams full;
    full.openings = 9;
    EXPECT_NE(problem(full).find("width_m"), std::string::npos);
    RoofTilesParams narrow;
    narrow.width_m = 0.3;
    EXPECT_NE(problem(narrow).find("tile_m"), std::string::npos);
}

}  // namespace
}  // namespace obscura
