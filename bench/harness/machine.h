#pragma once
// What a measurement was taken on, without names of hosts, users or folders.

#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// Pairs of heading and text: processor, cores, caches, instruction sets, memory, system, compiler, date.
std::vector<std::pair<std::string, std::string>> describe_machine();

}  // namespace obscura
