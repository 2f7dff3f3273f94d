#pragma once
// The file of a day's far shadows in the making: what an earlier run has left of it, what other machines have
// made of it, and what is still to do.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/cli/progress.h"
#include "app/cli/terrain_command.h"
#include "hierarchy/terrain/far_parts.h"
#include "hierarchy/tree_file_key.h"

namespace obscura {

/// What the file holds: this day (or this part of it); some of it, with some altered or absent; or anything
/// else.
enum class FarFileState { other, incomplete, made };

struct FarPlan {
    FarDay known;  ///< all units that are there, from the file, its partial one and the merged parts
    TreeFileKey key;
    std::vector<int> groups;  ///< that the file shall have
    FarFileState state = FarFileState::other;
};

/// Where a run keeps what it has finished, until all is: "day.far.partial".
std::filesystem::path partial_file(const std::filesystem::path& file);

/// Reads what there is. Throws InputError where a part to merge, or a partial file that is not to be
/// overwritten, is of another day, and where merged parts leave a gap; UsageError for a part beyond the day's
/// groups of suns.
FarPlan plan_far_file(const TerrainDayOptions& options, const FarDay& empty, const TreeFileKey& key);

/// Makes what is missing and writes the file; what is finished is kept in the partial file meanwhile, which
/// goes at the end. Throws Interrupted, OutputError. Returns the day.
FarDay make_far_file(const TerrainDayOptions& options, const HeightField& field, const FarPlan& plan,
                     const FarDayWatch& watch);

}  // namespace obscura
