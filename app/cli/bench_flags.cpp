// Flags of `obscura bench`.

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "app/cli/commands.h"
#include "app/cli/flags.h"
#include "app/scene/schema.h"
#include "bench/diffraction/diffraction_bench.h"
#include "bench/raster/raster_bench.h"
#include "bench/shadows/shadow_bench.h"
#include "bench/stereo/stereo_bench.h"
#include "core/error.h"

namespace obscura {

int run_bench(const Arguments& arguments) {
    Flags flags("bench [options] NAME",
                "Measures our methods and their peers in one run on one machine; prints the results and "
                "writes tables (CSV, Markdown) and, with gnuplot, charts (SVG).");
    BenchOptions options;
    std::string name, out = options.out.string(), data, part;
    std::int64_t runs = options.runs, threads = 0;
    flags.positional("NAME", name,
                     "What to measure: raster (light views, dual depths and a shaded frame), shadows (dense "
                     "and compressed maps against exact rays), diffraction (far and near fields) or stereo "
                     "(solvers of disparity maps).");
    flags.group("Measurement");
    flags.whole("--runs", "N", runs, 1, 1000, "Timed runs of each job after one to warm up.",
                std::to_string(runs));
    flags.whole("-t,--threads", "N", threads, 1, 1024, "Measure with this many threads only.", "1 and 2");
    flags.text("--scene", "TEXT", options.scene,
               "Only scenes (apertures, hard cases) whose name contains this.", "all");
    flags.text("--data", "DIR", data,
               "Folder of test data (meshes, cities, apertures); without it they are left out.", "none");
    flags.text("--part", "NAME", part, "shadows: times, accuracy or sizes alone.", "all");
    flags.on_off("--quick", options.quick, "Small pictures of a small scene: a check, not a measurement.");
    flags.group("Output");
    flags.text("-o,--output", "DIR", out, "Folder for tables and charts.", out);
    if (!flags.parse(arguments)) return 0;
    if (name != "raster" && name != "shadows" && name != "diffraction" && name != "stereo") {
        throw UsageError(fmt::format("there is no bench '{}'{} (see 'obscura bench --help')", name,
                                     hint(name, {"raster", "shadows", "diffraction", "stereo"})));
    }
    if (!part.empty() && (name != "shadows" || (part != "times" && part != "accuracy" && part != "sizes")))
        throw UsageError(fmt::format("bench {} has no part '{}'", name, part));
    options.out = out;
    if (!data.empty()) options.data = data;
    options.runs = static_cast<int>(runs);
    if (threads > 0) options.threads = {static_cast<int>(threads)};
    options.say = [](const std::string& line) {
        fmt::print("{}\n", line);
        std::fflush(stdout);
    };
    if (name == "raster") return bench_raster(options);
    if (name == "diffraction") return bench_diffraction(options);
    if (name == "stereo") return bench_stereo(options);
    const bool all = part.empty();
    return bench_shadows(options,
                         {all || part == "times", all || part == "accuracy", all || part == "sizes"});
}

}  // namespace obscura
