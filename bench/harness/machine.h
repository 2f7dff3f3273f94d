#pragma once
// What a measurement was taken on, without names of hosts, users or folders.

#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// Heading and text.
using MachineLine = std::pair<std::string, std::string>;

/// "## Machine" and a table: processor, cores, caches, instruction sets, memory, system, compiler, date, and
/// `more`.
std::string machine_markdown(const std::vector<MachineLine>& more);

}  // namespace obscura
