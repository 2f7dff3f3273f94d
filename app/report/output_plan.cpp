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
    if (!request.output.empty()) {
        plan.push_back({Aov::beauty, request.output, file_kind(request.output)});
    } else if (!scene_outputs.empty()) {
        for (const Output& output : scene_outputs)
            plan.push_back({output.aov, output.file, file_kind(output.file)});
    } else {
        plan.push_back({Aov::beauty, request.scene_stem + (request.several_frames ? ".####.png" : ".png"),
                        FileKind::png});
    }
    const std::string first = plan.front().pattern;
    for (const Aov aov : request.aovs)
        plan.push_back({aov, beside(first, aov, request.aov_kind), request.aov_kind});

    std::set<fs::path> names;
    for (const PlannedOutput& output : plan) {
        if (request.several_frames && output.pattern.find('#') == std::string::npos) {
            throw UsageError(fmt::format("'{}': several frames need #### in the name, for the frame number",
                                         output.pattern));
        }
        if (!names.insert(fs::path(output.pattern).lexically_normal()).second) {
            throw UsageError(fmt::format("'{}': two pictures would go to this file", output.pattern));
        }
    }
    return plan;
}

fs::path output_path(const PlannedOutput& output, int frame) {
    std::string name;
    const std::string& pattern = output.pattern;
    for (std::size_t i = 0; i < pattern.size();) {
        const std::size_t end = std::min(pattern.find_first_not_of('#', i), pattern.size());
        if (end > i) {
            name += fmt::format("{:0{}}", frame, end - i);
        } else {
            name += pattern[i];
        }
        i = std::max(end, i + 1);
    }
    return name;
}

}  // namespace obscura
