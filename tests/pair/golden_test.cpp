// The pair of scenes/tests/stereo_pair.toml has the bits that it had: its map and both eyes' radiance, for
// any number of threads and every instruction set. When they are meant to change, put the printed hashes
// here.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/models/file_access.h"
#include "app/pair/pair.h"
#include "app/scene/build.h"
#include "app/scene/stereo_settings.h"
#include "core/hash.h"

namespace obscura {
namespace {

template <class T>
std::string hash_of(ImageView<const T> image) {
    Hasher hasher;
    hasher.value(image.width).value(image.height);
    for (int y = 0; y < image.height; ++y)
        hasher.bytes(image.row(y), static_cast<std::size_t>(image.width) * sizeof(T));
    return hash_text(hasher.state);
}

StereoPair pair_of(const Exec& exec, const std::vector<std::string>& overrides = {}) {
    const std::filesystem::path file =
        std::filesystem::path(OBSCURA_SOURCE_DIR) / "scenes/tests/stereo_pair.toml";
    const SceneDocument document = read_scene(file, overrides);
    const FileAccess access{document.folder, {}};
    Scene scene = build_scene(document, access);
    set_frame(scene, document, 1);
    const StereoSettings settings = stereo_settings(document, scene, 1, access);
    StereoCache cache;
    StereoPair pair;
    render_stereo_pair(scene, settings, {}, exec, cache, pair);
    EXPECT_TRUE(pair.solution.report.converged);
    EXPECT_GE(pair.realised.error.share(), 0.999);
    return pair;
}

std::string hashes(const Exec& exec, const std::vector<std::string>& overrides = {}) {
    const StereoPair pair = pair_of(exec, overrides);
    return fmt::format("map {}, left {}, right {}", hash_of<float>(std::as_const(pair.optimised).view()),
                       hash_of<Vec3f>(std::as_const(pair.eyes.left.radiance).view()),
                       hash_of<Vec3f>(std::as_const(pair.eyes.right.radiance).view()));
}

TEST(StereoGolden, PairHasTheBitsThatItHad) {
    const std::string expected = "map ac59171ff71cce26, left db979db4b698ecfa, right 9a1f36c739f3bca5";
    for (const Isa isa : supported_isas())
        EXPECT_EQ(hashes({isa, 1}), expected) << isa_name(isa);
    EXPECT_EQ(hashes({best_isa(), 3}), expected);
}

/// Pixels of the eye that has more of them whose radiances differ by more than the root of `square`.
int most_different(const StereoPair& a, const StereoPair& b, float square) {
    int most = 0;
    for (const auto& [mine, other] : {std::pair(&a.eyes.left.radiance, &b.eyes.left.radiance),
                                      std::pair(&a.eyes.right.radiance, &b.eyes.right.radiance)}) {
        int different = 0;
        for (int y = 0; y < mine->height; ++y) {
            for (int x = 0; x < mine->width; ++x) {
                const Vec3f d = mine->view()(x, y) - other->view()(x, y);
                different += dot(d, d) > square;
            }
        }
        most = std::max(most, different);
    }
    return most;
}

/// Edits cut triangles, so the eyes' samples are of other triangles than those that cast the shadows.
TEST(StereoGolden, ExactShadowsAreThoseOfAFineTree) {
    const std::vector<std::string> exact = {"light.sun.shadow={method=\"exact\"}"};
    const std::string expected = hashes({Isa::ref, 1}, exact);
    for (const Isa isa : supported_isas())
        EXPECT_EQ(hashes({isa, 3}, exact), expected) << isa_name(isa);
    const StereoPair a = pair_of({}, exact);
    const StereoPair b = pair_of({}, {"light.sun.shadow={resolution=65536, filter_px=1}"});
    // Of 15,360 pixels those on outlines of shadows, which a tree cuts into texels.
    EXPECT_LE(most_different(a, b, 1e-6f), 60);
}

/// A disc so small that it has no penumbra, asked for sixteen points, casts the shadow of its middle.
TEST(StereoGolden, ShadowsOfADiscAreOfTheWholeScene) {
    const std::string exact = "light.sun.shadow={method=\"exact\"";
    const StereoPair a = pair_of({}, {exact + "}"});
    const StereoPair b = pair_of({}, {exact + ", samples=16}", "light.sun.angular_diameter_deg=0.0001"});
    EXPECT_LE(most_different(a, b, 1e-4f), 5);
}

}  // namespace
}  // namespace obscura
