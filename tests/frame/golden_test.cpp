// Every scene of scenes/tests looks as it did: the decoded pixels and all channels have the hashes of
// tests/golden. When a picture changed, the actual, expected and difference pictures stay in the build
// folder. tests/update_goldens makes the present state the expected one.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "app/frame/render_frame.h"
#include "app/models/file_access.h"
#include "app/scene/build.h"
#include "core/file_output.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "filters/tonemap.h"
#include "tests/frame/one_picture.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

const fs::path scene_folder = fs::path(OBSCURA_SOURCE_DIR) / "scenes/tests";
const fs::path golden_folder = fs::path(OBSCURA_SOURCE_DIR) / "tests/golden";
const fs::path failure_folder = fs::path(OBSCURA_BINARY).parent_path().parent_path() / "golden_failures";
constexpr std::int64_t largest_reference = 30 * 1024;

using Hashes = std::map<std::string, std::string>;

std::vector<fs::path> files_in(const fs::path& folder, const std::string& suffix) {
    std::vector<fs::path> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == suffix) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

template <class T>
std::string hash_of(ImageView<const T> image) {
    Hasher hasher;
    hasher.value(image.width).value(image.height);
    for (int y = 0; y < image.height; ++y)
        hasher.bytes(image.row(y), static_cast<std::size_t>(image.width) * sizeof(T));
    return hash_text(hasher.state);
}

struct Rendered {
    Image<Rgb8> picture;
    Hashes hashes;
};

Rendered render(const fs::path& file) {
    const SceneDocument document = read_scene(file);
    const Scene scene = build_scene(document, FileAccess{document.folder, {}});
    const FrameOptions options = all_channels(scene.outputs);
    const Frame frame = render_frame(scene, options);
    Rendered r;
    r.picture = tonemap(frame.radiance.view(), {scene.render.exposure_ev, scene.render.tone}, Exec{});
    r.hashes = {{"picture", hash_of<Rgb8>(r.picture.view())},
                {"radiance", hash_of<Vec3f>(frame.radiance.view())},
                {"depth", hash_of<float>(frame.depth_m.view())},
                {"normal", hash_of<Vec3f>(frame.normal.view())},
                {"albedo", hash_of<Vec3f>(frame.albedo.view())},
                {"object", hash_of<std::uint32_t>(frame.object.view())},
                {"shadow", hash_of<float>(frame.shadow.view())}};
    if (options.sun_hours) r.hashes["sun_hours"] = hash_of<float>(frame.sun_hours.view());
    return r;
}

Hashes read_hashes(const fs::path& file) {
    Hashes hashes;
    std::ifstream in(file);
    for (std::string name, hash; in >> name >> hash;)
        hashes[name] = hash;
    return hashes;
}

void write_text(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    write_file_atomically(file, text, Existing::replace);
}

void update(const std::string& name, const Rendered& now) {
    std::string text;
    for (const auto& [channel, hash] : now.hashes)
        text += channel + " " + hash + "\n";
    write_text(golden_folder / (name + ".txt"), text);
    const std::string png = encode_png(now.picture.view());
    ASSERT_LE(static_cast<std::int64_t>(png.size()), largest_reference)
        << name << ": make the scene smaller, its reference picture is kept with the sources";
    write_text(golden_folder / (name + ".png"), png);
}

std::string describe(Rgba8 p) {
    return fmt::format("({}, {}, {})", p.r, p.g, p.b);
}

/// Keeps actual, expected and difference pictures; tells the first pixel that differs.
std::string keep_evidence(const std::string& name, const Image<Rgb8>& actual) {
    write_text(failure_folder / (name + ".actual.png"), encode_png(actual.view()));
    const fs::path reference = golden_folder / (name + ".png");
    if (!fs::exists(reference)) return "there is no reference picture";
    const std::string bytes = read_file(reference, largest_reference);
    write_text(failure_folder / (name + ".expected.png"), bytes);
    const Image<Rgba8> expected = decode_png(bytes, reference.string());
    if (expected.width != actual.width || expected.height != actual.height) {
        return fmt::format("{} x {} pixels instead of {} x {}", actual.width, actual.height, expected.width,
                           expected.height);
    }
    Image<Rgb8> difference(actual.width, actual.height);
    std::string first;
    int count = 0;
    const auto far = [](int a, int b) {
        return static_cast<std::uint8_t>(std::min(std::abs(a - b) * 16, 255));
    };
    for (int y = 0; y < actual.height; ++y) {
        for (int x = 0; x < actual.width; ++x) {
            const Rgb8 a = actual(x, y);
            const Rgba8 e = expected(x, y);
            difference(x, y) = {far(a.r, e.r), far(a.g, e.g), far(a.b, e.b)};
            if (a == Rgb8{e.r, e.g, e.b}) continue;
            if (count++ == 0) {
                first = fmt::format("first at ({}, {}): {} instead of {}", x, y, describe({a.r, a.g, a.b}),
                                    describe(e));
            }
        }
    }
    write_text(failure_folder / (name + ".difference.png"), encode_png(difference.view()));
    if (count == 0) return "the picture is the same, only other channels differ";
    return fmt::format("{} pixels differ, {}; see {}", count, first, fs::absolute(failure_folder).string());
}

TEST(Golden, EverySceneLooksAsItDid) {
    const std::vector<fs::path> scenes = files_in(scene_folder, ".toml");
    ASSERT_FALSE(scenes.empty());
    for (const fs::path& file : scenes) {
        const std::string name = file.stem().string();
        SCOPED_TRACE(name);
        const Rendered now = render(file);
        if (std::getenv("OBSCURA_UPDATE_GOLDENS") != nullptr) {
            update(name, now);
            continue;
        }
        const Hashes expected = read_hashes(golden_folder / (name + ".txt"));
        if (expected.empty()) {
            ADD_FAILURE() << "no golden hashes; look at the picture, then run tests/update_goldens";
            continue;
        }
        EXPECT_EQ(now.hashes, expected);
        if (now.hashes != expected) ADD_FAILURE() << keep_evidence(name, now.picture);
    }
}

TEST(Golden, EveryGoldenHasItsScene) {
    for (const fs::path& file : files_in(golden_folder, ".txt"))
        EXPECT_TRUE(fs::exists(scene_folder / (file.stem().string() + ".toml"))) << file;
    for (const fs::path& file : files_in(golden_folder, ".png"))
        EXPECT_TRUE(fs::exists(golden_folder / (file.stem().string() + ".txt"))) << file;
}

TEST(Golden, ReferencePicturesAreTheHashedOnes) {
    for (const fs::path& file : files_in(golden_folder, ".png")) {
        const Image<Rgba8> decoded = decode_png(read_file(file, largest_reference), file.string());
        Image<Rgb8> picture(decoded.width, decoded.height);
        std::transform(decoded.pixels.begin(), decoded.pixels.end(), picture.pixels.begin(), [](Rgba8 p) {
            return Rgb8{p.r, p.g, p.b};
        });
        Hashes hashes = read_hashes(golden_folder / (file.stem().string() + ".txt"));
        EXPECT_EQ(hash_of<Rgb8>(picture.view()), hashes["picture"]) << file;
    }
}

}  // namespace
}  // namespace obscura
