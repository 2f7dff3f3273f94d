// The program `obscura-bench`, which `obscura bench` becomes.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/cli/run_program.h"
#include "app/scene/schema.h"
#include "bench/benches.h"
#include "core/error.h"

namespace obscura {
namespace {

int run_bench(const Arguments& arguments) {
    Flags flags("bench [options] NAME",
                "Measures our methods and their peers in one run on one machine; prints the results and "
                "writes tables (CSV, Markdown) and, with gnuplot, charts (SVG).");
    BenchOptions options;
    std::string name, out = options.out.string(), data;
    std::int64_t runs = options.runs, threads = 0;
    flags.positional("NAME", name, fmt::format("What to measure: {}.", benches_text()));
    flags.group("Measurement");
    flags.whole("--runs", "N", runs, 1, 1000, "Timed runs of each job after one to warm up.",
                std::to_string(runs));
    flags.whole("-t,--threads", "N", threads, 1, 1024, "Measure with this many threads only.", "1 and 2");
    flags.text("--scene", "TEXT", options.scene,
               fmt::format("Only {} whose name contains this.", subjects_text()), "all");
    flags.text("--data", "DIR", data,
               fmt::format("Folder of test data ({}); without it they are left out.", data_text()), "none");
    flags.text("--part", "NAME", options.part, fmt::format("{} alone.", parts_text()), "all");
    flags.on_off("--quick", options.quick, "Small pictures of a small scene: a check, not a measurement.");
    flags.group("Output");
    flags.text("-o,--output", "DIR", out, "Folder for tables and charts.", out);
    if (!flags.parse(arguments)) return 0;
    const Bench* bench = find_bench(name);
    if (bench == nullptr) {
        std::vector<std::string> names;
        for (const Bench& known : all_benches())
            names.emplace_back(known.name);
        throw UsageError(
            fmt::format("there is no bench '{}'{} (see 'obscura bench --help')", name, hint(name, names)));
    }
    if (!has_part(*bench, options.part))
        throw UsageError(fmt::format("bench {} has no part '{}'", name, options.part));
    options.out = out;
    if (!data.empty()) options.data = data;
    options.runs = static_cast<int>(runs);
    if (threads > 0) options.threads = {static_cast<int>(threads)};
    options.say = [](const std::string& line) { print(line + "\n"); };
    return bench->run(options);
}

}  // namespace
}  // namespace obscura

int main(int argc, char** argv) {
    return obscura::run_program(argc, argv, obscura::run_bench);
}
