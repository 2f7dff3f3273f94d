#pragma once
// Commands that are programs of their own beside this one, found as git finds its commands. What they are
// built from need not be there for the others.

#include <string>

#include "app/cli/command.h"

namespace obscura {

/// Becomes the program obscura-COMMAND: the one beside this executable (links resolved), else the one on
/// PATH. Throws UsageError where neither can be started, so the exit code is 2.
[[noreturn]] void become_sibling(const std::string& command, const Arguments& arguments);

}  // namespace obscura
