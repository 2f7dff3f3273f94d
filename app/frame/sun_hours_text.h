#pragma once
// The sun's path and its hours in words, for `render` and `check`.

#include <string>

#include "app/frame/frame.h"

namespace obscura {

/// "2026-06-21".
std::string date_text(const SunPath& path);

/// "light 'sun', 2026-06-21, 00:00 to 24:00 in 144 steps of 10 min: up 04:43 to 21:22, 16.64 h".
std::string sun_path_text(const std::string& light, const SunPath& path);

/// The note on a sun that does not rise.
std::string no_sun_text(const std::string& light, const SunPath& path);

/// What `render` tells: lines, each with its end; what it took with a verbosity above 0.
std::string sun_hours_text(const SunHoursStats& stats, int verbosity);

}  // namespace obscura
