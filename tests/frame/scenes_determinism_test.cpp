// One picture for every thread count and instruction set, through the library: the same bits in every
// channel.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "app/frame/render_frame.h"
#include "app/scene/build.h"
#include "app/scene/file_access.h"
#include "core/hash.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

std::uint64_t hash_of(const Frame& frame) {
    Hasher hasher;
    const ImageView<const Vec3f> radiance = frame.radiance.view();
    for (int y = 0; y < radiance.height; ++y)
        hasher.bytes(radiance.row(y), static_cast<std::size_t>(radiance.width) * sizeof(Vec3f));
    hasher.values(frame.depth_m.pixels).values(frame.normal.pixels).values(frame.albedo.pixels);
    hasher.values(frame.object.pixels).values(frame.shadow.pixels).values(frame.sun_hours.pixels);
    return hasher.state;
}

std::uint64_t render_hash(const Scene& scene, const Exec& exec) {
    FrameOptions options;
    options.depth = options.normal = options.albedo = options.object = options.shadow = true;
    options.sun_hours = std::any_of(scene.outputs.begin(), scene.outputs.end(),
                                    [](const Output& o) { return o.aov == Aov::sun_hours; });
    return hash_of(render_frame(scene, options, exec));
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
        FrameOptions options;
        options.depth = options.normal = options.albedo = options.object = options.shadow = true;
        FrameCache cache;
        Frame frame;
        render_frame(scene, options, {}, cache, frame);
        const std::uint64_t first = hash_of(frame);
        render_frame(scene, options, {}, cache, frame);
        EXPECT_EQ(hash_of(frame), first) << entry.path().filename();
    }
}

}  // namespace
}  // namespace obscura
