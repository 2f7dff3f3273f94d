#include "app/report/output_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "app/scene/aov.h"
#include "core/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// "a/b.####.png" and depth give "a/b.####.depth.pfm".
std::string beside(const std::string& pattern, Aov aov, FileKind kind) {
    const fs::path p(pattern);
    return (p.parent_path() /
            fmt::format("{}.{}.{}", p.stem().string(), aov_name(aov), kind == FileKind::png ? "png" : "pfm"))
        .string();
}

}  // namespace

FileKind file_kind(const std::string& file) {
    std::string suffix = fs::path(file).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (suffix == ".png") return FileKind::png;
    if (suffix == ".pfm") return FileKind::pfm;
    throw UsageError(fmt::format("'{}': pictures end in .png (8-bit sRGB) or .pfm (linear float)", file));
}

std::vector<PlannedOutput> plan_outputs(const OutputRequest& request,
                                        const std::vector<Output>& scene_outputs) {
    std::vector<PlannedOutput> plan;
    int run = least_number_run(request.scene_has_several_frames || request.several_frames);
    if (!request.output.empty()) {
        plan.push_back({Aov::beauty, request.output, file_kind(request.output)});
    } else if (!scene_outputs.empty()) {
        for (const Output& output : scene_outputs)
            plan.push_back({output.aov, output.file, file_kind(output.file)});
    } else {
        if (!request.several_frames) run = 0;  // the scene's own name, as it is
        plan.push_back({Aov::beauty, request.scene_stem + (request.several_frames ? ".####.png" : ".png"),
                        FileKind::png});
    }
    const std::string first = plan.front().pattern;
    for (const Aov aov : request.aovs)
        plan.push_back({aov, beside(first, aov, request.aov_kind), request.aov_kind});

    std::set<fs::path> names;
    for (PlannedOutput& output : plan) {
        output.least_run = run;
        if (request.several_frames && !has_frame_number(output.pattern)) {
            throw UsageError(fmt::format("'{}': several frames need #### in the name, for the frame number",
                                         output.pattern));
        }
        if (!names.insert(fs::path(output.pattern).lexically_normal()).second) {
            throw UsageError(fmt::format("'{}': two pictures would go to this file", output.pattern));
        }
    }
    return plan;
}

bool has_frame_number(const std::string& pattern) {
    return fs::path(pattern).filename().string().find('#') != std::string::npos;
}

fs::path output_path(const PlannedOutput& output, int frame) {
    fs::path path(output.pattern);
    std::string name = path.filename().string();
    const std::size_t last = name.rfind('#');
    if (last == std::string::npos || output.least_run == 0) return path;
    const std::size_t before = name.find_last_not_of('#', last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1, run = last + 1 - first;
    if (run < static_cast<std::size_t>(output.least_run)) return path;
    return path.parent_path() / name.replace(first, run, fmt::format("{:0{}}", frame, run));
}

}  // namespace obscura
