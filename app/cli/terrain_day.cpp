#include "app/cli/terrain_day.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "app/cli/messages.h"
#include "app/cli/signals.h"
#include "core/error.h"
#include "hierarchy/terrain/far_file.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// The file's day when it is one with this key.
std::optional<FarDay> day_with(const fs::path& path, const TreeFileKey& key) {
    std::error_code error;
    if (!fs::exists(path, error)) return {};
    try {
        FarFile file = read_far_file(path);
        if (file.key == key) return std::move(file.day);
    } catch (const InputError&) {
        // Something else, or cut short.
    }
    return {};
}

/// A part that is asked for by name.
NamedDay part_of(const fs::path& path, const TreeFileKey& key) {
    FarFile file = read_far_file(path);
    if (file.key != key)
        throw InputError(path.string(),
                         "is of another day: its ground, its suns or its settings are not these");
    return {std::move(file.day), path.string()};
}

/// What an interrupted run has left.
void add_partial(const TerrainDayOptions& options, const TreeFileKey& key, std::vector<NamedDay>& days) {
    const fs::path path = partial_file(options.far_shadows);
    std::error_code error;
    if (!fs::exists(path, error)) return;
    if (std::optional<FarDay> day = day_with(path, key)) {
        days.push_back({std::move(*day), path.string()});
    } else if (!options.run.overwrite) {
        throw InputError(
            path.string(),
            "is what an interrupted run has left, of another day or damaged: remove it, or say --overwrite");
    }
}

std::vector<int> all_groups(const FarDay& day) {
    std::vector<int> groups(static_cast<std::size_t>(day.groups()));
    std::iota(groups.begin(), groups.end(), 0);
    return groups;
}

/// Of `groups`, those that the day is missing.
std::vector<int> missing_of(const FarDay& day, const std::vector<int>& groups) {
    std::vector<int> missing;
    for (const int group : missing_groups(day))
        if (std::find(groups.begin(), groups.end(), group) != groups.end()) missing.push_back(group);
    return missing;
}

/// The day with these groups alone.
FarDay with_only(const FarDay& day, const std::vector<int>& groups) {
    std::vector<CodedGroup> coded(static_cast<std::size_t>(day.groups()));
    for (const int group : groups)
        coded[static_cast<std::size_t>(group)] = coded_group(day, group);
    return with_groups(day, coded);
}

}  // namespace

fs::path partial_file(const fs::path& file) {
    fs::path partial = file;
    partial += ".partial";
    return partial;
}

FarPlan plan_far_file(const TerrainDayOptions& options, const FarDay& empty, const TreeFileKey& key) {
    FarPlan plan{empty, key, all_groups(empty), FarFileState::other};
    if (options.parts > 1) {
        plan.groups =
            groups_of_part(empty.groups(), static_cast<int>(options.part), static_cast<int>(options.parts));
        if (plan.groups.empty()) {
            throw UsageError(
                fmt::format("--tile {}/{}: the day has {} units of up to {} suns, and none is left for it",
                            options.part, options.parts, empty.groups(), empty.params.suns_per_unit));
        }
    }
    std::vector<NamedDay> days;
    for (const fs::path& part : options.merged)
        days.push_back(part_of(part, key));
    if (!options.merged.empty()) {
        plan.known = joined(empty, days);
        const std::vector<int> gap = missing_groups(plan.known);
        if (!gap.empty()) {
            throw InputError(options.far_shadows.string(),
                             fmt::format("cannot be merged: {} are in none of the parts, or are altered",
                                         suns_text(plan.known, gap)));
        }
    }
    if (std::optional<FarDay> day = day_with(options.far_shadows, key)) {
        plan.state = missing_of(*day, plan.groups).empty() ? FarFileState::made : FarFileState::incomplete;
        days.push_back({std::move(*day), options.far_shadows.string()});
    }
    if (plan.state != FarFileState::made) add_partial(options, key, days);
    plan.known = joined(empty, days);
    return plan;
}

FarDay make_far_file(const TerrainDayOptions& options, const HeightField& field, const FarPlan& plan,
                     const FarDayWatch& watch) {
    const fs::path partial = partial_file(options.far_shadows);
    const FarDay day = make_missing(
        field, plan.known, plan.groups, options.run.exec, watch,
        [&](const FarDay& so_far) { write_far_file(partial, so_far, plan.key, Existing::replace); });
    stop_if_requested();
    FarDay wanted = with_only(day, plan.groups);
    write_far_file(options.far_shadows, wanted, plan.key,
                   plan.state == FarFileState::other ? options.run.existing() : Existing::replace);
    std::error_code none;
    fs::remove(partial, none);
    return wanted;
}

}  // namespace obscura
