#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "bench/harness/report.h"
#include "bench/shadows/shadow_bench.h"
#include "bench/shadows/stack_bench.h"
#include "core/error.h"

namespace obscura {
namespace {

using Out = std::back_insert_iterator<std::string>;

double ratio_of(const StackTrial& trial, const StackRow& row) {
    return static_cast<double>(trial.bytes) / static_cast<double>(row.quadtree_bytes);
}

/// The cube of the paper.
double cube_ratio(const StackRow& row) {
    for (const StackTrial& trial : row.trials) {
        if (trial.anisotropy == 0) return ratio_of(trial, row);
    }
    return 0;
}

std::string steps_fields(const StackSteps& s) {
    return fmt::format("{:.2f},{:.2f},{:.2f},{:.2f},", s.quadtrees, s.each, s.all, s.all_runs);
}

}  // namespace

std::string stack_csv(const std::vector<StackRow>& rows) {
    std::string text =
        "scene,triangles,resolution,maps,light_percent,aim,parallax_texels,quadtree_bytes,octree_bytes,"
        "anisotropy,ratio,cube_ratio,trials,build_s,points,quadtree_steps,each_steps,all_steps,all_runs,"
        "penumbra_points,penumbra_quadtree_steps,penumbra_each_steps,penumbra_all_steps,penumbra_all_runs,"
        "problem\n";
    for (const StackRow& row : rows) {
        const StackSubject& s = row.subject;
        fmt::format_to(Out(text), "{},{},{},{},{},{},{:.3f},{},{},{},{:.4f},{:.4f},\"", row.scene,
                       row.triangles, s.resolution, s.maps, s.light_percent, aim_name(s.aim),
                       row.parallax_texels, row.quadtree_bytes, row.bytes, row.anisotropy, row.ratio(),
                       cube_ratio(row));
        for (const StackTrial& trial : row.trials) {
            if (!trial.given_up)
                fmt::format_to(Out(text), "{}:{:.4f} ", trial.anisotropy, ratio_of(trial, row));
        }
        fmt::format_to(Out(text), "\",{:.2f},{},", row.build_s, row.points);
        text += steps_fields(row.everywhere);
        fmt::format_to(Out(text), "{},", row.penumbra);
        text += steps_fields(row.in_penumbra);
        fmt::format_to(Out(text), "\"{}\"\n", row.problem);
    }
    return text;
}

std::string stack_markdown(const std::vector<StackRow>& rows) {
    std::string text =
        "## Bytes\n\nOctree over the sum of the maps' quadtrees, both in words with 16 bits of offset (the "
        "cube: what the paper divides). Seconds: of all octrees that were tried, and of counting "
        "quadtrees.\n\n"
        "| scene | texels | maps | lamp, % | aim | parallax, texels | cube | best | anisotropy | octree, MB "
        "| s |\n"
        "|---|--:|--:|--:|---|--:|--:|--:|--:|--:|--:|\n";
    for (const StackRow& row : rows) {
        if (!row.problem.empty()) continue;
        const StackSubject& s = row.subject;
        fmt::format_to(
            Out(text), "| {} | {} | {} | {} | {} | {} | {:.3f} | {:.3f} | {} | {:.2f} | {:.1f} |\n",
            row.scene, s.resolution, s.maps, s.light_percent, aim_name(s.aim),
            s.aim == StackAim::apart ? std::string("-") : fmt::format("{:.2f}", row.parallax_texels),
            cube_ratio(row), row.ratio(), row.anisotropy, static_cast<double>(row.bytes) * 1e-6, row.build_s);
    }
    text +=
        "\n## Steps\n\nNodes read for one point of a picture, all maps asked: in the maps' quadtrees, in the "
        "octree one map after the other, and all at once (runs of maps asked in brackets).\n\n"
        "| scene | texels | maps | points | quadtrees | one by one | at once "
        "|\n|---|--:|--:|---|--:|--:|--:|\n";
    const auto steps = [&](const StackRow& row, const char* which, std::size_t points, const StackSteps& s) {
        fmt::format_to(Out(text), "| {} | {} | {} | {} {} | {:.0f} | {:.0f} | {:.0f} ({:.0f}) |\n", row.scene,
                       row.subject.resolution, row.subject.maps, points, which, s.quadtrees, s.each, s.all,
                       s.all_runs);
    };
    for (const StackRow& row : rows) {
        if (row.points == 0) continue;
        steps(row, "in all", row.points, row.everywhere);
        steps(row, "in penumbras", row.penumbra, row.in_penumbra);
    }
    return text;
}

int bench_stack(const BenchOptions& options) {
    std::vector<StackRow> rows;
    for (const ShadowRecipe& recipe : shadow_recipes(options.data, options.quick)) {
        if (recipe.name.find(options.scene) == std::string::npos) continue;
        for (const StackSubject& subject : stack_subjects(recipe.name, options.quick)) {
            StackRow row = measure_stack(recipe, subject, options);
            options.say(fmt::format(
                "{}, {} maps of {}, lamp {} %, {}: octree / quadtrees {:.3f} (anisotropy {}, cube {:.3f}), "
                "{:.2f} MB, {:.1f} s; steps {:.0f} at once, {:.0f} one by one, {:.0f} in quadtrees",
                row.scene, subject.maps, subject.resolution, subject.light_percent, aim_name(subject.aim),
                row.ratio(), row.anisotropy, cube_ratio(row), static_cast<double>(row.bytes) * 1e-6,
                row.build_s, row.everywhere.all, row.everywhere.each, row.everywhere.quadtrees));
            rows.push_back(std::move(row));
        }
    }
    check_chosen(!rows.empty(), options);
    write_files(options, {{"shadows_stack.csv", stack_csv(rows)},
                          {"shadows_stack.md",
                           report_head("Stacks of shadow maps", "a small stack of a small scene", options) +
                               stack_markdown(rows)}});
    return static_cast<int>(ExitCode::ok);
}

}  // namespace obscura
