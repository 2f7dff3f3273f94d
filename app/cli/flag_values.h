#pragma once
// Values of command-line flags out of their text. Everything throws UsageError that names the flag.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/keyframes.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "core/types.h"

namespace obscura {

/// A decimal whole number in [low, high]; leading zeros mean nothing.
std::int64_t whole_number(const std::string& flag, std::string_view text, std::int64_t low,
                          std::int64_t high);
/// A finite decimal number in [low, high].
double real_number(const std::string& flag, std::string_view text, double low, double high);

/// "960x540".
Size2 size_value(const std::string& flag, std::string_view text);

/// "x0,y0,x1,y1", the last two outside: not empty, inside a width x height picture.
Region crop_value(const std::string& flag, std::string_view text, int width, int height);

/// A pixel of the picture.
struct PixelPlace {
    int x = 0, y = 0;
};
/// "x,y" inside a width x height picture.
PixelPlace pixel_value(const std::string& flag, std::string_view text, int width, int height);

/// Folders that are there.
std::vector<std::filesystem::path> folder_values(const std::string& flag,
                                                 const std::vector<std::string>& names);

/// "auto" or the name of an instruction set that runs on this machine.
Isa isa_value(const std::string& flag, std::string_view text);

/// "depth,normal,...": names of pictures besides the beauty, duplicates dropped.
std::vector<Aov> aov_values(const std::string& flag, std::string_view text);

/// "1-48x2" or "1,5,9-12": in ascending order, duplicates dropped. Every frame must be one of the scene's.
std::vector<int> frame_values(const std::string& flag, std::string_view text, const FrameRange& scene);

}  // namespace obscura
