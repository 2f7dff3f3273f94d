// obscura diffraction over the whole ranges of its numbers: a picture of finite numbers, or words and the
// code of a wrong flag, a wrong mask or a limit. Nothing ends in a broken precondition.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/cli/scene_folder.h"

namespace obscura::test {
namespace {

/// A flag and the ends of what is drawn for it, which lie beyond what it takes where that costs nothing.
struct DrawnFlag {
    const char* name;
    double lo, hi;
    bool whole = false;
};

constexpr DrawnFlag drawn_flags[] = {
    {"diameter-mm", 1e-300, 1e300},
    {"pitch-um", 1e-300, 1e300},
    {"blades", 0, 40, true},
    {"rotation-deg", -1e6, 1e6},
    {"bow", 0, 1},
    {"aspect", 0, 1e6},
    {"obstruction", 0, 1},
    {"vanes", 0, 40, true},
    {"slits", 1, 60, true},
    {"lines", 1, 60, true},
    {"rings", 0, 12, true},
    {"finest-level", 0, 9, true},
    {"seed", 0, 1e18, true},
    {"noise", 0, 1},
    {"noise-cell", 0, 1},
    {"noise-stretch", 0, 100},
    {"noise-angle-deg", -1e6, 1e6},
    {"dust", 0, 50, true},
    {"dust-radius", 0, 1},
    {"dust-softness", 0, 1},
    {"scratches", 0, 30, true},
    {"scratch-width", 0, 1},
    {"scratch-length", 0, 2},
    {"scratch-spread-deg", 0, 360},
    {"eyelashes", 0, 20, true},
    {"eyelash-width", 0, 1},
    {"eyelash-length", 0, 2},
    {"occluder-diameter", 0, 10},
    {"occluder-x", -5, 5},
    {"occluder-y", -5, 5},
    {"wavelength-nm", 1e-3, 1e6},
    {"wavelengths", 1, 40, true},
    {"zoom", 1e-300, 1e12},
    {"cull", 0, 1},
    {"decades", 0, 400},
};

class Source {
  public:
    explicit Source(std::uint64_t seed) : bits(seed) {}
    double chance() { return std::uniform_real_distribution<>(0, 1)(bits); }
    template <std::size_t n>
    std::string one_of(const char* const (&words)[n]) {
        return words[bits() % n];
    }
    /// By magnitude mostly; the ends among them.
    std::string number(double lo, double hi, bool whole = false) {
        const double kind = chance();
        double value = lo;
        if (kind >= 0.15) value = hi;
        if (kind >= 0.3) value = lo + (hi - lo) * chance();
        if (kind >= 0.5) {
            const double size = std::pow(10, std::uniform_real_distribution<>(-12, 6)(bits));
            value = std::clamp(lo < 0 && chance() < 0.5 ? -size : size, lo, hi);
        }
        return whole ? fmt::format("{}", std::llround(value)) : fmt::format("{}", value);
    }

  private:
    std::mt19937_64 bits;
};

Names drawn_line(Source& source) {
    const char* const apertures[] = {"iris",    "circle", "box",     "whirl",
                                     "annulus", "slit",   "grating", "hexagons"};
    const char* const masks[] = {"1", "2", "3", "7", "16", "33", "64"};
    const char* const sizes[] = {"1", "2", "5", "16", "31", "48"};
    Names line{"diffraction", source.one_of(apertures),
               "--mask-size", source.one_of(masks),
               "--size",      source.one_of(sizes),
               "-o",          "x.pfm",
               "-o",          "x.png",
               "--overwrite"};
    const auto add = [&](const char* name, const std::string& value) {
        line.push_back(fmt::format("--{}={}", name, value));
    };
    for (const DrawnFlag& flag : drawn_flags)
        if (source.chance() < 0.025) add(flag.name, source.number(flag.lo, flag.hi, flag.whole));
    if (source.chance() < 0.4) add("near", source.number(1e-300, 1e12));
    if (source.chance() < 0.1) add("occluder", source.one_of({"housing", "disc"}));
    if (source.chance() < 0.15) add("spectrum", source.one_of({"d65", "equal", "sodium", "rgb_led"}));
    if (source.chance() < 0.1) add("spectrum", "blackbody:" + source.number(1, 1e7));
    if (source.chance() < 0.1) add("spectrum-mode", source.one_of({"exact", "full60", "batch4", "scaled"}));
    if (source.chance() < 0.1) add("centre", source.number(-1e9, 1e9) + "," + source.number(-1e300, 1e9));
    if (source.chance() < 0.15) {
        add("method", source.one_of({"direct", "shift", "gemm", "edges", "levels", "runs", "raster_fft",
                                     "polygon", "two_pass", "hybrid", "fft"}));
    }
    if (source.chance() < 0.1) line.push_back("--" + source.one_of({"log", "linear", "amplitude"}));
    return line;
}

/// Numbers of a PFM that are none.
std::int64_t not_finite(const std::filesystem::path& file) {
    const std::string bytes = file_text(file);
    std::size_t at = 0;
    for (int newline = 0; newline < 3; ++newline)
        at = bytes.find('\n', at) + 1;
    std::int64_t count = 0;
    for (; at + sizeof(float) <= bytes.size(); at += sizeof(float)) {
        float value = 0;
        std::copy_n(bytes.data() + at, sizeof value, reinterpret_cast<char*>(&value));
        count += std::isfinite(value) ? 0 : 1;
    }
    return count;
}

TEST(DiffractionRanges, EveryNumberMakesAPictureOrIsRefused) {
    const bool all = std::getenv("OBSCURA_SLOW_TESTS") != nullptr;
    int made = 0, refused = 0;
    const Folder folder;
    for (std::uint64_t i = 0; i < (all ? 3000 : 100) && !HasFailure(); ++i) {
        Source source(i);
        const Names line = drawn_line(source);
        std::string told;
        for (const std::string& word : line)
            told += " " + word;
        SCOPED_TRACE("obscura" + told);
        const Outcome run = run_in(folder, line);
        EXPECT_TRUE(run.code == 0 || run.code == 2 || run.code == 3 || run.code == 4)
            << run.code << ": " << run.err;
        if (run.code != 0) {
            EXPECT_NE(run.err.find("error:"), std::string::npos) << run.err;
            ++refused;
            continue;
        }
        EXPECT_EQ(not_finite(folder / "x.pfm"), 0);
        ++made;
    }
    fmt::print("{} made, {} refused\n", made, refused);
    EXPECT_GE(made, 30);
}

}  // namespace
}  // namespace obscura::test
