#pragma once
// The bytes of a file of a day's far shadows, version 1. Everything is little-endian.
//
//   FarFileHeader | FarFileSun x suns | FarUnit x units | zeros to 64 | bytes of the units

#include <cstdint>

namespace obscura {

constexpr char far_file_magic[8] = {'O', 'B', 'S', 'C', 'F', 'A', 'R', 'S'};
constexpr std::uint32_t far_file_version = 1;
constexpr std::uint32_t far_file_byte_order = 0x01020304u;
constexpr std::uint64_t far_file_alignment = 64;

struct FarFileHeader {
    char magic[8] = {};
    std::uint32_t version = 0;
    std::uint32_t byte_order = 0;
    std::uint64_t key[2] = {};
    std::uint64_t file_bytes = 0;
    std::uint64_t unit_bytes = 0;  ///< of all units
    double cell_x_m = 0, cell_y_m = 0;
    std::int32_t width = 0, height = 0;
    std::uint32_t diagonal = 0;
    std::int32_t threshold = 0, tile_side = 0, suns_per_unit = 0;
    std::uint32_t suns = 0, units = 0;
    std::uint64_t checksum = 0;  ///< bulk_hash of header, suns and units, with zero in this place
};
static_assert(sizeof(FarFileHeader) == 104);

struct FarFileSun {
    double hour_h = 0, hours = 0, azimuth_deg = 0, elevation_deg = 0;
    std::int64_t slope_q20 = 0, rise_q36 = 0;
    std::int32_t lines_are_columns = 0, step_line = 0, step_along = 0, padding = 0;
};
static_assert(sizeof(FarFileSun) == 64);

}  // namespace obscura
