// Estimates against what the program really takes, each scene in a process of its own.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/frame/load_scene.h"
#include "app/frame/memory.h"
#include "app/scene/scene_file.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr double mib = 1 << 20;
/// What page rounding, threads' arenas and setup that no triangle fills come to, whatever the scene.
constexpr double floor_mib = 8;
/// Runs differ by what the allocator keeps of freed blocks, as threads take turns, and by the system's huge
/// pages (always: 4 % more): by 10 % at most in all that was seen.
constexpr double run_share = 1.1;

/// Peak of resident memory, MiB.
double peak_of(std::vector<std::string> arguments) {
    std::string program = OBSCURA_BINARY;
    std::vector<char*> argv = {program.data()};
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const int nothing = open("/dev/null", O_WRONLY);
        dup2(nothing, 1);
        execv(argv[0], argv.data());
        _exit(127);
    }
    int status = 0;
    rusage usage{};
    EXPECT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << arguments[2];
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// What rendering says, bytes. Nothing is loaded here: a child's peak is never less than what this process
/// has.
double estimate_in(const std::filesystem::path& stats) {
    std::ifstream in(stats);
    std::ostringstream all;
    all << in.rdbuf();
    const std::string key = "\"estimate_bytes\":", text = all.str();
    const std::size_t begin = text.find(key);
    EXPECT_NE(begin, std::string::npos) << text;
    return begin == std::string::npos ? 0 : std::stod(text.substr(begin + key.size()));
}

/// The night street with `lamps` lamps in place of its four, alternately on either side.
std::string street_of(int lamps) {
    std::ifstream in(OBSCURA_SOURCE_DIR "/scenes/night_street.toml");
    std::ostringstream all;
    all << in.rdbuf();
    std::string text = all.str();
    std::string lights, instances;
    for (int i = 0; i < lamps; ++i) {
        const double x = i % 2 == 0 ? -3.3 : 3.4, z = -1 - 1.2 * i;
        lights += fmt::format(
            "[[light]]\nid = \"l{}\"\ntype = \"point\"\nposition_m = [{}, 3.21, {}]\n"
            "intensity_w_sr = [9, 5.6, 2.6]\nnear_m = 0.4\nrange_m = 40\n",
            i, x, z);
        instances += fmt::format("[[mesh.instance]]\ntranslate_m = [{}, 0.1, {}]\n", x, z);
    }
    const auto replace = [&](const std::string& from, const std::string& to, const std::string& by) {
        const std::size_t begin = text.find(from) + from.size();
        text.replace(begin, text.find(to) - begin, by);
    };
    replace("# --- Light: one point in each lantern\n", "# --- The street", lights);
    replace("materials = { bulb = \"filament\" }\n", "[[mesh]]\nid = \"posts\"", instances);
    return text;
}

struct Case {
    const char* scene;  ///< below scenes/; "street N": a street of N lamps
    std::vector<std::string> overrides;
    std::vector<std::string> flags = {};
};

TEST(FrameMemory, EstimatesAreNearWhatIsReallyTaken) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers keep memory of their own";
#endif
    const std::string small = "render.size_px=[240, 135]", short_streaks = "optics.radius_px=100";
    const std::vector<Case> cases = {
        {"tests/box.toml", {}},
        {"tests/box_on_plane.toml", {}},
        {"tests/glare_bokeh.toml", {}},
        {"tests/glare_even.toml", {}},
        {"tests/glare_odd.toml", {}},
        {"tests/glare_post.toml", {}},
        {"tests/ortho.toml", {}},
        {"tests/point_in_box.toml", {}},
        {"tests/soft_stack.toml", {}},
        {"tests/spot.toml", {}},
        {"tests/stereo_pair.toml", {}},
        {"tests/textured_quad.toml", {}},
        {"tests/two_lights.toml", {}},
        {"city.toml", {small}},
        {"courtyard.toml", {small}},
        {"interior.toml", {small}},
        {"still_life.toml", {small}},
        {"sun_hours.toml", {small, "light.sun.steps=30"}, {"--aov", "sun_hours"}},
        {"sun_star.toml", {small, short_streaks}},
        {"stereo_characters.toml", {small}},
        {"stereo_spheres.toml", {small}},
        {"stereo_wall.toml", {small}},
        {"night_street.toml", {small, "render.samples=16"}},
        {"street 40", {small, "render.samples=1", short_streaks}},
    };
    const double program = peak_of({"--version"});
    const std::filesystem::path folder = testing::TempDir() + fmt::format("obscura_memory_{}", getpid());
    std::filesystem::create_directories(folder);
    for (const Case& c : cases) {
        std::string file = std::string(OBSCURA_SOURCE_DIR "/scenes/") + c.scene;
        if (const std::string name = c.scene; name.starts_with("street ")) {
            file = folder / "street.toml";
            std::ofstream(file) << street_of(std::stoi(name.substr(7)));
        }
        const std::filesystem::path stats = folder / "stats.json";
        std::vector<std::string> arguments{"render",         file,           "-q", "--overwrite", "-o",
                                           folder / "p.png", "--stats-json", stats};
        arguments.insert(arguments.end(), c.flags.begin(), c.flags.end());
        for (const std::string& o : c.overrides)
            arguments.insert(arguments.end(), {"-D", o});
        const double real = peak_of(arguments) - program;
        const double estimate = estimate_in(stats) / mib;
        EXPECT_GE(run_share * estimate + floor_mib, real) << c.scene;
        EXPECT_LE(estimate, 1.5 * real + floor_mib) << c.scene;
        fmt::print("{:24} estimate {:6.1f} MiB, real {:6.1f}, ratio {:.2f}\n", c.scene, estimate, real,
                   estimate / real);
    }
    std::filesystem::remove_all(folder);
}

TEST(FrameMemory, ResolutionsThatAreFoundCount) {
    const SceneDocument document = read_scene(OBSCURA_SOURCE_DIR "/scenes/tests/box_on_plane.toml", {});
    const Scene scene = load_scene(document, {document.folder, {}});
    std::vector<SceneLight> lights = scene.lights;
    ASSERT_FALSE(lights.empty());
    for (SceneLight& light : lights) {
        light.shadow.method = ShadowMethod::compressed;
        light.shadow.scope = ShadowScope::full;
        light.shadow.resolution = auto_resolution;
    }
    const auto bytes = [&] {
        return estimate_memory(scene, {.lights = lights, .bright_px = {}, .channels = {}}).total();
    };
    const std::int64_t before = bytes();
    lights[0].shadow.resolution = 1 << 20;
    EXPECT_GT(bytes(), before + (std::int64_t{32} << 20) * 6);
}

}  // namespace
}  // namespace obscura
