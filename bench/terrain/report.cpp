#include <fmt/format.h>

#include <iterator>

#include "bench/harness/machine.h"
#include "bench/harness/report.h"
#include "bench/terrain/terrain_bench.h"
#include "core/error.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

double share(const TerrainWay& way) {
    return way.samples > 0 ? static_cast<double>(way.differ) / static_cast<double>(way.samples) : 0;
}

std::string way_fields(const std::optional<TerrainWay>& way) {
    return way ? fmt::format("{:.2f},{},{}", way->ns_per_sample, way->samples, way->differ) : ",,";
}

std::string ray_fields(const TerrainRays& rays) {
    return fmt::format("{:.2f},{:.2f},{:.1f},{:.1f}", rays.looks, rays.plain_looks, rays.ns, rays.plain_ns);
}

std::string rays_text(const TerrainRays& rays) {
    return fmt::format(" {:.1f} | {:.1f} | {:.0f} | {:.0f} |", rays.looks, rays.plain_looks, rays.ns,
                       rays.plain_ns);
}

/// What pictures ask of a day.
std::string lookups_markdown(const std::vector<TerrainRow>& rows) {
    std::string text =
        "\n## Lookups\n\nEvery 13th row, every 16th sun, one thread. Lookup: far bits and a near ray at a "
        "sample, nanoseconds; differ: from the sweep. Rays start in the middles of cells whose far bit is "
        "not set, and go to the threshold (near) or to the border (all); looks: cells and blocks of the "
        "pyramid of greatest heights that a ray looks at, plain: cells without one.\n\n"
        "| model | lookup, ns | differ | near looks | plain | ns | plain | all looks | plain | ns | plain |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const TerrainRow& r : rows) {
        text += fmt::format("| {} | {:.0f} | {} of {} |", r.name, r.lookup.ns_per_sample, r.lookup.differ,
                            r.lookup.samples) +
                rays_text(r.near_rays) + rays_text(r.all_rays) + "\n";
    }
    return text;
}

}  // namespace

std::string terrain_csv(const std::vector<TerrainRow>& rows) {
    std::string text =
        "model,width,height,threshold,suns,dark,far_dark,sweep_ns,sweep_far_ns,marched,march_ns,"
        "march_samples,march_differ,embree_ns,embree_samples,embree_differ,far_bits,paper_bits,decode_ns,"
        "lookup_ns,lookup_samples,lookup_differ,near_looks,near_plain_looks,near_ns,near_plain_ns,"
        "all_looks,all_plain_looks,all_ns,all_plain_ns\n";
    for (const TerrainRow& r : rows) {
        fmt::format_to(
            Out(text), "{},{},{},{},{},{:.5f},{:.5f},{:.2f},{:.2f},{:.3g},{},{},{:.6f},{},{:.3f},{},{},{}\n",
            r.name, r.width, r.height, r.threshold, r.suns, r.dark, r.far_dark, r.sweep.ns_per_sample,
            r.sweep_far.ns_per_sample, r.marched, way_fields(r.march), way_fields(r.embree), r.far_bits,
            r.paper_bits ? fmt::format("{:.6f}", *r.paper_bits) : "", r.decode_ns, way_fields(r.lookup),
            ray_fields(r.near_rays), ray_fields(r.all_rays));
    }
    return text;
}

std::string terrain_markdown(const std::vector<TerrainRow>& rows) {
    std::string text =
        "## Whole shadows\n\nNanoseconds a sample and sun, one thread. Sweep: all suns, alone and with far "
        "maps. March: rays "
        "in doubles from every 13th row, every 16th sun. Embree: from every sample, every 16th sun, over a "
        "solid with walls "
        "and a floor, its hierarchy kept. Differ: of the samples asked, from the sweep.\n\n"
        "| model | samples | dark | sweep | with far maps | march | differ | Embree | differ | Embree / "
        "sweep |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const TerrainRow& r : rows) {
        fmt::format_to(Out(text), "| {} | {} x {} | {:.1f} % | {:.1f} | {:.1f} | {:.0f} | {} of {} |", r.name,
                       r.width, r.height, 100 * r.dark, r.sweep.ns_per_sample, r.sweep_far.ns_per_sample,
                       r.march.ns_per_sample, r.march.differ, r.march.samples);
        if (r.embree) {
            fmt::format_to(Out(text), " {:.0f} | {:.1e} | {:.1f} |\n", r.embree->ns_per_sample,
                           share(*r.embree), r.embree->ns_per_sample / r.sweep.ns_per_sample);
        } else {
            text += " - | - | - |\n";
        }
    }
    text +=
        "\n## Far maps of a day\n\nBits a sample and map, all maps counted whether empty or not. Dictionary "
        "and LZMA: each map "
        "as Chajdas et al. (2014) store it. Decoding: nanoseconds a sample and map, one thread.\n\n"
        "| model | threshold | suns | far | dictionary + LZMA | coded | less by | decoding "
        "|\n|---|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const TerrainRow& r : rows) {
        fmt::format_to(Out(text), "| {} | {} | {} | {:.1f} % | {} | {:.4f} | {} | {:.2f} |\n", r.name,
                       r.threshold, r.suns, 100 * r.far_dark,
                       r.paper_bits ? fmt::format("{:.4f}", *r.paper_bits) : "-", r.far_bits,
                       r.paper_bits ? fmt::format("{:.1f}", *r.paper_bits / r.far_bits) : "-", r.decode_ns);
    }
    return text + lookups_markdown(rows) +
           "\nThe paper states 0.018 and 0.013 for 76 and 69 thousand million samples of 1 m and less, 158 "
           "maps, a threshold of 512 samples; its data is not to be had.\n\n";
}

int bench_terrain(const BenchOptions& options) {
    std::vector<TerrainRow> rows;
    for (const TerrainSubject& subject : terrain_subjects(options)) {
        if (subject.name.find(options.scene) == std::string::npos) continue;
        const TerrainRow& row = rows.emplace_back(measure_terrain(subject, options));
        options.say(fmt::format(
            "{}: sweep {:.1f} ns, march {:.0f} ns ({} differ), Embree {:.0f} ns ({:.1e} differ); {:.4f} bits "
            "a sample and map, dictionary + LZMA {:.4f}, decoding {:.2f} ns",
            row.name, row.sweep.ns_per_sample, row.march.ns_per_sample, row.march.differ,
            row.embree ? row.embree->ns_per_sample : 0.0, row.embree ? share(*row.embree) : 0.0, row.far_bits,
            row.paper_bits.value_or(0), row.decode_ns));
    }
    check_chosen(!rows.empty(), options, "elevation model");
    write_files(
        options,
        {{"terrain.csv", terrain_csv(rows)},
         {"terrain.md", report_head("Shadows of terrain", "a small generated model and few suns", options) +
                            terrain_markdown(rows) + machine_markdown({})}});
    return static_cast<int>(ExitCode::ok);
}

}  // namespace obscura
