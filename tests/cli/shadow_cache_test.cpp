// [shadow] cache: files of finished maps, as the program's users meet them.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "hierarchy/codes/tree_file.h"
#include "tests/cli/program.h"
#include "tests/report/json_reader.h"

namespace obscura::test {
namespace {

using Names = std::vector<std::string>;

/// A folder with the small scene, its lamp's map cached in `maps`.
struct CachedScene {
    explicit CachedScene(const std::string& lamp = "scope = \"full\"") {
        std::string text = small_scene;
        if (lamp.find("stack") != std::string::npos)
            text.replace(text.find("[shadow.lamp]"), 0, "angular_diameter_deg = 3\n");
        text.replace(text.find("[shadow.lamp]"), 13, "[shadow]\ncache = \"maps\"\n[shadow.lamp]\n" + lamp);
        folder.write("s.toml", text);
    }
    /// Renders and returns what the statistics say of the lamp.
    Outcome render(std::vector<std::string> more = {}) const {
        std::vector<std::string> line{"render", "s.toml",       "--overwrite", "-o",
                                      "s.png",  "--stats-json", "s.json"};
        line.insert(line.end(), more.begin(), more.end());
        return run_in(folder, line);
    }
    bool from_cache() const {
        const Json stats = parse_json(file_text(folder / "s.json"));
        return stats.at("frames").list.at(0).at("lights").list.at(0).at("from_cache").truth;
    }
    std::string map() const { return file_text(folder / "maps/lamp.shadowtree"); }

    Folder folder;
};

TEST(ShadowCache, GivesTheSamePictureWithoutBuilding) {
    const CachedScene scene;
    ASSERT_EQ(scene.render().code, 0);
    EXPECT_FALSE(scene.from_cache());
    const std::string picture = file_text(scene.folder / "s.png"), map = scene.map();
    EXPECT_GT(map.size(), 64u);
    const Outcome second = scene.render();
    ASSERT_EQ(second.code, 0) << second.err;
    EXPECT_EQ(second.err.find("note"), std::string::npos) << second.err;
    EXPECT_TRUE(scene.from_cache());
    EXPECT_EQ(file_text(scene.folder / "s.png"), picture);
    EXPECT_EQ(scene.map(), map);
    // The camera does not matter.
    ASSERT_EQ(scene.render({"-D", "camera.eye_m=[1,2,8]"}).code, 0);
    EXPECT_TRUE(scene.from_cache());
}

TEST(ShadowCache, KeepsWhatCodeAutoTakes) {
    const CachedScene scene("code = \"auto\"\nfilter_px = 1");
    const Outcome first = scene.render({"-v"});
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_NE(first.err.find("    mmh: auto, smaller than mh and as fast, and made once for its file\n"),
              std::string::npos)
        << first.err;
    EXPECT_FALSE(scene.from_cache());
    EXPECT_EQ(read_tree_file(scene.folder / "maps/lamp.shadowtree").trees.at(0).code.code, ShadowCode::mmh);
    const std::string picture = file_text(scene.folder / "s.png"), map = scene.map();
    ASSERT_EQ(scene.render().code, 0);
    EXPECT_TRUE(scene.from_cache());
    EXPECT_EQ(file_text(scene.folder / "s.png"), picture);
    // The same code by its name has the same file.
    ASSERT_EQ(scene.render({"-D", "shadow.lamp.code=mmh"}).code, 0);
    EXPECT_TRUE(scene.from_cache());
    EXPECT_EQ(scene.map(), map);
    // With few top levels auto means another.
    ASSERT_EQ(scene.render({"-D", "shadow.lamp.top_levels=2"}).code, 0);
    EXPECT_FALSE(scene.from_cache());
    EXPECT_EQ(read_tree_file(scene.folder / "maps/lamp.shadowtree").trees.at(0).code.code, ShadowCode::mh);
}

TEST(ShadowCache, IsMadeAgainWithANoticeWhenAnythingItDependsOnChanged) {
    const CachedScene scene;
    ASSERT_EQ(scene.render().code, 0);
    for (const char* change :
         {"mesh.cube.size_m=2.01", "light.lamp.elevation_deg=31", "light.lamp.shadow.resolution=512",
          "light.lamp.shadow.layout=bytes16", "light.lamp.shadow.receivers=any",
          "light.lamp.shadow.top_levels=3", "light.lamp.shadow.code=mmh", "mesh.cube.casts_shadow=false"}) {
        const std::string before = scene.map();
        std::string key = change;
        // [shadow.lamp] stands in a table of its own.
        if (key.starts_with("light.lamp.shadow")) key = "shadow.lamp" + key.substr(17);
        const Outcome run = scene.render({"-D", key});
        ASSERT_EQ(run.code, 0) << run.err;
        EXPECT_NE(run.err.find("lamp.shadowtree was made from another scene, light or settings"),
                  std::string::npos)
            << key << ": " << run.err;
        EXPECT_FALSE(scene.from_cache()) << key;
        EXPECT_NE(scene.map(), before) << key;
        ASSERT_EQ(scene.render().code, 0);  // back
        EXPECT_FALSE(scene.from_cache());
    }
}

TEST(ShadowCache, MakesFilesAgainThatAreCutAlteredOrForeign) {
    const CachedScene scene;
    ASSERT_EQ(scene.render().code, 0);
    const std::string good = scene.map();
    std::string altered = good;
    altered[good.size() - 5] = static_cast<char>(altered[good.size() - 5] ^ 4);
    for (const std::string& bad : {good.substr(0, good.size() - 1), good.substr(0, 10), std::string(),
                                   altered, std::string("a picture of a cat"), good + "x"}) {
        scene.folder.write("maps/lamp.shadowtree", bad);
        const Outcome run = scene.render();
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_NE(run.err.find("lamp.shadowtree is damaged ("), std::string::npos) << run.err;
        EXPECT_NE(run.err.find("); it is made again"), std::string::npos) << run.err;
        EXPECT_FALSE(scene.from_cache());
        EXPECT_EQ(scene.map(), good);
    }
}

TEST(ShadowCache, MakesTreesOfOtherViewsUnderTheRightKeyAgain) {
    const CachedScene scene;
    ASSERT_EQ(scene.render().code, 0);
    const auto file = scene.folder / "maps/lamp.shadowtree";
    const TreeFile good = read_tree_file(file);
    ASSERT_EQ(good.trees.size(), 1u);
    ShadowTree moved = good.trees[0];
    moved.view.to_map.m[0][3] += 1.0;
    // Files are renamed into place, so what is mapped from the first one stays readable.
    for (const std::vector<ShadowTree>& trees :
         {std::vector<ShadowTree>{moved}, std::vector<ShadowTree>(2, good.trees[0])}) {
        write_tree_file(file, trees, good.key);
        const Outcome run = scene.render();
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_NE(run.err.find("other views"), std::string::npos) << run.err;
        EXPECT_EQ(read_tree_file(file).trees[0].view, good.trees[0].view);
    }
}

TEST(ShadowCache, LiesWhereScenesMayRead) {
    const CachedScene scene;
    const Folder elsewhere;
    const std::string key = "shadow.cache=\"" + elsewhere.path.string() + "\"";
    const Outcome refused = scene.render({"-D", key});
    EXPECT_EQ(refused.code, 3);
    EXPECT_NE(refused.err.find("leads outside"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("-D shadow.cache="), std::string::npos) << refused.err;  // where the key is
    EXPECT_TRUE(elsewhere.listing().empty());
    ASSERT_EQ(scene.render({"-D", key, "--allow-path", elsewhere.path.string()}).code, 0);
    EXPECT_EQ(elsewhere.listing(), (std::vector<std::string>{"lamp.shadowtree"}));

    scene.folder.write("file", "no folder");
    const Outcome file = scene.render({"-D", "shadow.cache=file"});
    EXPECT_EQ(file.code, 3);
    EXPECT_NE(file.err.find("not a folder"), std::string::npos) << file.err;
    const Outcome deep = scene.render({"-D", "shadow.cache=a/b/c"});
    EXPECT_EQ(deep.code, 5);
    EXPECT_NE(deep.err.find("cannot make the shadow cache"), std::string::npos) << deep.err;
    ASSERT_EQ(::mkdir((scene.folder / "taken").c_str(), 0700), 0);
    ASSERT_EQ(::mkdir((scene.folder / "taken/lamp.shadowtree").c_str(), 0700), 0);
    EXPECT_NE(scene.render({"-D", "shadow.cache=taken"}).code, 0);
    // Looking at a scene makes nothing.
    EXPECT_EQ(run_in(scene.folder, {"check", "s.toml", "-D", "shadow.cache=new"}).code, 0);
    EXPECT_FALSE(std::filesystem::exists(scene.folder / "new"));
}

// A kept map is a file of its own: what a link of its name leads to is never replaced.
TEST(ShadowCache, ReplacesNothingBehindALink) {
    for (const std::string lamp : {"scope = \"full\"", "method = \"stack\"\nsamples = 4"}) {
        const CachedScene scene(lamp);
        const std::string name = lamp[0] == 's' ? "lamp.shadowtree" : "lamp.shadowstack";
        const auto file = scene.folder / "maps" / name;
        std::filesystem::create_directory(scene.folder / "maps");
        scene.folder.write("notes", "not a map");
        std::filesystem::create_symlink("../notes", file);
        const Outcome run = scene.render();
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_NE(run.err.find(name + " is damaged"), std::string::npos) << run.err;
        EXPECT_EQ(file_text(scene.folder / "notes"), "not a map");
        EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(file)));

        // A map behind a link serves where it stays inside.
        std::filesystem::rename(file, scene.folder / "kept");
        std::filesystem::create_symlink("../kept", file);
        ASSERT_EQ(scene.render().code, 0);
        EXPECT_TRUE(scene.from_cache());
        EXPECT_TRUE(std::filesystem::is_symlink(file));

        // Nothing of the kind leads outside, whether something is there or not.
        const Folder outside;
        for (const std::string there : {"map", "nothing"}) {
            outside.write("map", "somebody's");
            std::filesystem::remove(file);
            std::filesystem::create_symlink(outside / there, file);
            const Outcome refused = scene.render();
            EXPECT_EQ(refused.code, 3) << refused.err;
            EXPECT_NE(refused.err.find("leads outside"), std::string::npos) << refused.err;
            EXPECT_EQ(outside.listing(), Names{"map"});
            EXPECT_EQ(file_text(outside / "map"), "somebody's");
        }
    }
}

TEST(ShadowCache, ReplacesNothingThatTheRunReads) {
    const CachedScene scene;
    const std::string text = file_text(scene.folder / "s.toml");
    std::filesystem::create_directory(scene.folder / "maps");
    const auto file = scene.folder / "maps/lamp.shadowtree";
    for (const bool hard : {false, true}) {
        std::filesystem::remove(file);
        if (hard) {
            std::filesystem::create_hard_link(scene.folder / "s.toml", file);
        } else {
            std::filesystem::create_symlink("../s.toml", file);
        }
        for (const Outcome& run : {scene.render(), run_in(scene.folder, {"check", "s.toml"})}) {
            EXPECT_EQ(run.code, 5) << run.err;
            EXPECT_NE(run.err.find("lamp.shadowtree: is read by this run"), std::string::npos) << run.err;
        }
        EXPECT_EQ(file_text(scene.folder / "s.toml"), text);
        EXPECT_EQ(scene.folder.listing(), (Names{"maps", "s.toml"}));
    }
}

// Opened to be written, a pipe waits for a reader who never comes.
TEST(ShadowCache, IsNoPipe) {
    const CachedScene scene;
    ASSERT_EQ(scene.render().code, 0);
    std::filesystem::remove(scene.folder / "maps/lamp.shadowtree");
    ASSERT_EQ(::mkfifo((scene.folder / "maps/lamp.shadowtree").c_str(), 0600), 0);
    const Outcome run = scene.render();
    EXPECT_EQ(run.code, 5);
    EXPECT_NE(run.err.find("lamp.shadowtree: is not a regular file, so no shadow cache"), std::string::npos)
        << run.err;
}

TEST(ShadowCache, IsNoneForMapsOfOneFrame) {
    const CachedScene scene("scope = \"frame\"");
    ASSERT_EQ(scene.render().code, 0);
    EXPECT_FALSE(std::filesystem::exists(scene.folder / "maps"));
}

}  // namespace
}  // namespace obscura::test
