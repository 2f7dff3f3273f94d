#pragma once

#include <string>

namespace obscura {

/// "obscura 0.1.0".
std::string program_version();

}  // namespace obscura
