#include "app/cli/stereo_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "app/report/output_plan.h"
#include "app/report/pair_pictures.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// "a/b.####.png" and "warp" give "a/b.####.warp.png".
std::string with_role(const std::string& output, const std::string& role) {
    if (role.empty()) return output;
    const fs::path p(output);
    return (p.parent_path() / fmt::format("{}.{}.png", p.stem().string(), role)).string();
}

void check_frame_number(const std::string& pattern, bool several_frames) {
    if (!several_frames || has_frame_number(pattern)) return;
    throw UsageError(
        fmt::format("'{}': several frames need #### in the name, for the frame number", pattern));
}

}  // namespace

StereoCompare compare_value(const std::string& flag, const std::string& text) {
    StereoCompare compare;
    std::string_view rest = text;
    while (true) {
        const std::size_t comma = rest.find(',');
        const std::string name(rest.substr(0, comma));
        if (name == "warp") {
            compare.warp = true;
        } else if (name == "remap") {
            compare.remap = true;
        } else if (name == "unedited") {
            compare.unedited = true;
        } else {
            throw UsageError(fmt::format("{}: '{}' is not warp, remap or unedited{}", flag, name,
                                         hint(name, {"warp", "remap", "unedited"})));
        }
        if (comma == std::string_view::npos) return compare;
        rest.remove_prefix(comma + 1);
    }
}

std::vector<StereoFile> plan_stereo_files(const StereoFileRequest& request) {
    if (file_kind(request.output) != FileKind::png)
        throw UsageError(fmt::format("'{}': stereo pictures end in .png", request.output));
    check_frame_number(request.output, request.several_frames);
    std::vector<StereoFile> files;
    const auto add_layout = [&](const char* role) {
        for (const std::string& r : layout_roles(role, request.layout))
            files.push_back({r, with_role(request.output, r), request.output_run});
    };
    add_layout("");
    if (request.compare.warp) add_layout("warp");
    if (request.compare.remap) add_layout("remap");
    if (request.compare.unedited) add_layout("unedited");
    if (!request.maps.empty()) {
        check_frame_number(request.maps, request.several_frames);
        for (const std::string& role : map_roles())
            files.push_back({"map." + role, request.maps + "." + role, request.least_run});
    }
    if (!request.report.empty()) {
        if (fs::path(request.report).extension() != ".html")
            throw UsageError(fmt::format("'{}': reports end in .html", request.report));
        check_frame_number(request.report, request.several_frames);
        files.push_back({"report", request.report, request.least_run});
    }
    std::set<fs::path> names;
    for (const StereoFile& file : files) {
        if (!names.insert(fs::path(file.pattern).lexically_normal()).second)
            throw UsageError(fmt::format("'{}': two pictures would go to this file", file.pattern));
    }
    return files;
}

fs::path stereo_path(const std::vector<StereoFile>& files, const std::string& role, int frame) {
    const auto file =
        std::find_if(files.begin(), files.end(), [&](const StereoFile& f) { return f.role == role; });
    CHECK(file != files.end(), role);
    return output_path({Aov::beauty, file->pattern, FileKind::png, file->least_run}, frame);
}

}  // namespace obscura
