#include "bench/benches.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/diffraction/diffraction_bench.h"
#include "bench/raster/raster_bench.h"
#include "bench/shadows/shadow_bench.h"
#include "bench/stereo/stereo_bench.h"
#include "bench/terrain/terrain_bench.h"

namespace obscura {
namespace {

using Words = std::vector<std::string>;

/// "a, b or c".
std::string joined(const Words& words, const char* last = ", ") {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 == words.size() ? last : ", ") + words[i];
    return text;
}

void add_once(Words& words, const char* word) {
    if (std::find(words.begin(), words.end(), word) == words.end()) words.emplace_back(word);
}

}  // namespace

const std::vector<Bench>& all_benches() {
    static const std::vector<Bench> benches = {
        {"raster", "light views, dual depths and a shaded frame", "scenes", {"meshes"}, {}, bench_raster},
        {"shadows",
         "dense and compressed maps against exact rays",
         "scenes",
         {"meshes", "cities", "terrain"},
         {"times", "accuracy", "wrong-pixels", "sizes", "exact", "soft", "soft-error", "stack", "trees"},
         [](const BenchOptions& options) { return bench_shadows(options, all_contestants()); }},
        {"diffraction", "far and near fields", "apertures", {"apertures"}, {}, bench_diffraction},
        {"stereo", "solvers of disparity maps", "hard cases", {}, {}, bench_stereo},
        {"terrain",
         "shadows of a day over elevation models",
         "elevation models",
         {"terrain"},
         {},
         bench_terrain},
    };
    return benches;
}

const Bench* find_bench(const std::string& name) {
    for (const Bench& bench : all_benches()) {
        if (bench.name == name) return &bench;
    }
    return nullptr;
}

bool has_part(const Bench& bench, const std::string& part) {
    return part.empty() || std::find(bench.parts.begin(), bench.parts.end(), part) != bench.parts.end();
}

std::string benches_text() {
    Words words;
    for (const Bench& bench : all_benches())
        words.push_back(fmt::format("{} ({})", bench.name, bench.what));
    return joined(words, " or ");
}

std::string subjects_text() {
    Words words;
    for (const Bench& bench : all_benches())
        add_once(words, bench.subjects);
    return fmt::format("{} ({})", words.front(), joined({words.begin() + 1, words.end()}));
}

std::string data_text() {
    Words words;
    for (const Bench& bench : all_benches()) {
        for (const char* kind : bench.data)
            add_once(words, kind);
    }
    return joined(words);
}

std::string parts_text() {
    std::string text;
    for (const Bench& bench : all_benches()) {
        if (bench.parts.empty()) continue;
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", bench.name,
                            joined({bench.parts.begin(), bench.parts.end()}, " or "));
    }
    return text;
}

}  // namespace obscura
