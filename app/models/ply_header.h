#pragma once
// The header of a PLY file: which elements follow, and what their properties are.
//
// Greg Turk, "The PLY Polygon File Format", Stanford University, 1994.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a binary value.
int ply_size(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  ///< of a list's length, an integer
};

struct PlyElement {
    std::string name;
    std::int64_t count = 0;
    std::vector<PlyProperty> properties;
    int line = 0;  ///< of the header

    /// Bytes of a binary row whose lists are empty; in a text every value takes two.
    std::int64_t least_bytes(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;   ///< in the order in which they follow
    std::vector<std::string> textures;  ///< that comments name
    std::size_t body = 0;               ///< byte at which they begin
    int lines = 0;                      ///< of the header
};

/// `file` names it in messages. Throws InputError with the line for anything that is not a sound header, and
/// for elements that are longer than what is left of the file.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& file);

}  // namespace obscura
