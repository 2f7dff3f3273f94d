#pragma once
// Elevation models of any kind to a HeightField.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "raster/heights/height_field.h"

namespace obscura {

enum class HolePolicy {
    refuse,  ///< samples without a height are errors
    fill,    ///< from their neighbours, inwards from the hole's border
    level,   ///< all at one height: lakes, the sea
};

/// What a file does not say, or says wrongly.
struct ElevationOptions {
    std::optional<double> cell_x_m, cell_y_m;  ///< between columns, and between rows; one alone is for both
    std::optional<double> z_step_m;            ///< metres in a unit of the file's numbers
    std::optional<double> latitude_deg;        ///< of the model's middle: its cells are in degrees. Refused
                                               ///< where they are known to be in metres
    double exaggeration = 1;                   ///< heights are multiplied by it
    HolePolicy holes = HolePolicy::refuse;
    double hole_level_m = 0;
    std::int64_t max_bytes = std::int64_t{1} << 30;  ///< of the model while it is read,
    bool as_mesh = false;       ///< and of what it becomes in a scene: a closed mesh, and the scene's copy
    std::string_view advice{};  ///< follows that number in messages, like " (--limit raises it)"
};

struct ElevationModel {
    HeightField field;
    std::int64_t holes = 0;  ///< samples that were filled
    double least_m = 0, greatest_m = 0;
};

/// The kinds of file, by the name's ending; refused with a word when there is none of these:
///   .pgm   samples of 8 or 16 bits, with a .json beside it (`sidecar`: cell_size_x_m, cell_size_y_m,
///          elevation_scale_m, elevation_offset_m) or with cell sizes and z_step_m given
///   .asc   ESRI ASCII grid; cells below 1 at a place on the globe are refused without cell sizes or a
///          latitude; -9999 is a hole when no NODATA_value is given
///   .hgt   SRTM, 1 or 3 arc seconds, placed by its name (N37E014)
///   .tif   GeoTIFF in strips or tiles, plain, LZW, deflate or PackBits, of 16 or 32 bits or floats; cells
///          by its scale, in metres or feet, or in degrees at its own latitude; GDAL's value for holes.
///          Also .tiff
///   .png   grey, 16 bits, with cell sizes and z_step_m given
/// `name` stands in messages, its last part is the file's. Throws InputError with line or byte, LimitError
/// before anything is allocated.
ElevationModel decode_elevation(std::string_view bytes, const std::string& name,
                                const std::optional<std::string>& sidecar, const ElevationOptions& options);

/// The name of the file beside `name` that decode_elevation() takes as sidecar; empty when its kind has none.
std::string sidecar_name(const std::string& name);

}  // namespace obscura
