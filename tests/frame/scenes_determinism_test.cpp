// One picture for every thread count and instruction set, through the library: the same bits in every
// channel.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "app/frame/render_frame.h"
#include "app/models/file_access.h"
#include "app/scene/build.h"
#include "core/isa.h"
#include "tests/frame/one_picture.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

std::uint64_t render_hash(const Scene& scene, const Exec& exec) {
    return hash_of_all(render_frame(scene, all_channels(scene.outputs), exec));
}

TEST(Determinism, ThreadsAndInstructionSetsGiveOnePicture) {
    int scenes = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(OBSCURA_SOURCE_DIR) / "scenes/tests")) {
        if (entry.path().extension() != ".toml") continue;
        ++scenes;
        const SceneDocument document = read_scene(entry.path());
        Scene scene = build_scene(document, FileAccess{document.folder, {}});
        for (SceneLight& light : scene.lights)
            light.shadow.resolution = std::min(light.shadow.resolution, 256);
        const std::uint64_t expected = render_hash(scene, {Isa::ref, 1});
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 2, 3, 7}) {
                // Any number of threads for the fastest kernels, one that is odd for the others.
                if (isa != best_isa() && threads < 7) continue;
                EXPECT_EQ(render_hash(scene, {isa, threads}), expected)
                    << entry.path().filename() << ", " << isa_name(isa) << ", " << threads << " threads";
            }
        }
    }
    EXPECT_GT(scenes, 0);
}

TEST(Determinism, ReusedMemoryChangesNothing) {
    for (const auto& entry : fs::directory_iterator(fs::path(OBSCURA_SOURCE_DIR) / "scenes/tests")) {
        if (entry.path().extension() != ".toml") continue;
        const SceneDocument document = read_scene(entry.path());
        const Scene scene = build_scene(document, FileAccess{document.folder, {}});
        const FrameOptions options = all_channels();
        FrameCache cache;
        Frame frame;
        render_frame(scene, options, {}, cache, frame);
        const std::uint64_t first = hash_of_all(frame);
        render_frame(scene, options, {}, cache, frame);
        EXPECT_EQ(hash_of_all(frame), first) << entry.path().filename();
    }
}

}  // namespace
}  // namespace obscura
