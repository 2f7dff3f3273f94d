#pragma once
// The files that a run is to write, held against one another and against what it reads, before the work.

#include <filesystem>
#include <string>
#include <vector>

#include "app/models/read_files.h"
#include "core/file_output.h"

namespace obscura {

/// Throws UsageError when two results would go to one file, by whatever names; OutputError when one cannot be
/// written (see check_writable), or is a file of `read`. `stats_json` may be empty, or "-": then no other
/// result may be standard output.
void check_targets(const std::vector<std::filesystem::path>& results, const std::filesystem::path& stats_json,
                   Existing existing, const ReadFiles& read);

/// Throws OutputError when a result is a file of `read`: for what is known only once a scene is loaded.
void check_not_read(const std::vector<std::filesystem::path>& results,
                    const std::filesystem::path& stats_json, const ReadFiles& read);

/// Whether --stats-json says "-", standard output.
bool is_standard_output(const std::filesystem::path& stats_json);

/// Writes statistics where --stats-json says, if it says anything. Throws OutputError.
void write_stats(const std::filesystem::path& stats_json, const std::string& json, Existing existing);

}  // namespace obscura
