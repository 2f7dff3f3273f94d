#pragma once
// What a file of an elevation model says, before it is taken for ground.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "app/elevation/elevation.h"
#include "core/image.h"

namespace obscura {

constexpr double no_height = std::numeric_limits<double>::quiet_NaN();

struct RawGrid {
    Image<double> values;  ///< in units of z_step_m, row 0 in the north; no_height where there is none
    std::optional<double> cell_x, cell_y;  ///< as the file has them
    bool metres = false;                   ///< cells are certainly in metres
    bool degrees = false;                  ///< cells are in degrees, or may be,
    std::optional<double> latitude_deg;    ///< at this latitude
    std::optional<double> z_step_m;
    double z_offset_m = 0;
};

/// Throws LimitError when a grid of this size takes more than options.max_bytes, InputError without a sample.
/// `code_bytes`: of the decoded picture, a sample, that the grid is made from.
void check_grid_size(std::int64_t width, std::int64_t height, const std::string& name,
                     const ElevationOptions& options, std::int64_t code_bytes = 0);

RawGrid read_pgm_grid(std::string_view bytes, const std::string& name,
                      const std::optional<std::string>& sidecar, const ElevationOptions& options);
RawGrid read_esri_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options);
RawGrid read_hgt_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options);
RawGrid read_geotiff_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options);
RawGrid read_png_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options);

}  // namespace obscura
