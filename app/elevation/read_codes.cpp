// Elevation models that are pictures of codes: PGM, PNG, and SRTM's HGT.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "app/elevation/flat_json.h"
#include "app/elevation/raw_grid.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/pnm.h"
#include "raster/heights/height_mesh.h"

namespace obscura {
namespace {

/// A decoder compares sizes before it allocates. Of `code_bytes` a sample it may take the share that leaves
/// room for the grid; check_grid_size() is exact where the header can be read alone.
ImageFileLimits picture_limits(const ElevationOptions& options, std::int64_t code_bytes) {
    const std::int64_t grid =
        options.as_mesh ? std::int64_t{sizeof(std::int32_t)} + 2 * (height_mesh_bytes(1001, 1001) / 1002001)
                        : std::int64_t{sizeof(double) + sizeof(std::int32_t)};
    const std::int64_t samples = options.max_bytes / std::max(grid, code_bytes + 12);
    return {largest_height_field_side, samples * code_bytes, options.advice};
}

/// Width (0) or height (1) in the header chunk of a PNG, which is the first.
std::int64_t png_side(std::string_view bytes, std::size_t which) {
    std::int64_t side = 0;
    for (std::size_t i = 16 + 4 * which; i < 20 + 4 * which; ++i)
        side = side << 8 | static_cast<unsigned char>(bytes[i]);
    return side;
}

double json_number(const std::map<std::string, double>& numbers, const char* key, const std::string& name) {
    const auto at = numbers.find(key);
    if (at == numbers.end()) throw InputError(name, fmt::format("has no number '{}'", key));
    return at->second;
}

/// What the file beside a PGM says.
void read_sidecar(const std::string& text, const std::string& name, RawGrid& grid) {
    const auto numbers = json_numbers(text, name);
    grid.cell_x = json_number(numbers, "cell_size_x_m", name);
    grid.cell_y = json_number(numbers, "cell_size_y_m", name);
    grid.z_step_m = json_number(numbers, "elevation_scale_m", name);
    grid.z_offset_m = json_number(numbers, "elevation_offset_m", name);
    if (*grid.z_step_m <= 0)
        throw InputError(name,
                         fmt::format("'elevation_scale_m' is {}, and has to be above 0", *grid.z_step_m));
    grid.metres = true;
    const std::pair<const char*, int> sides[] = {{"width", grid.values.width},
                                                 {"height", grid.values.height}};
    for (const auto& [key, side] : sides) {
        if (const auto at = numbers.find(key); at != numbers.end() && at->second != side)
            throw InputError(name, fmt::format("'{}' is {}, and the picture has {}", key, at->second, side));
    }
}

/// 37.5 of N37E014.hgt.
double middle_latitude(const std::string& name) {
    const std::string file = name.substr(name.find_last_of("/\\") + 1);
    const auto digit = [&](std::size_t i) { return file[i] >= '0' && file[i] <= '9'; };
    const bool placed = file.size() >= 7 &&
                        std::string_view("NSns").find(file[0]) != std::string_view::npos && digit(1) &&
                        digit(2) && std::string_view("EWew").find(file[3]) != std::string_view::npos &&
                        digit(4) && digit(5) && digit(6);
    if (!placed) {
        throw InputError(
            name,
            "an HGT file says where it lies by its name, like N37E014.hgt: rename it, or give latitude_deg, "
            "or cell_x_m and cell_y_m");
    }
    const int south_edge = (file[1] - '0') * 10 + (file[2] - '0');
    return (file[0] == 'N' || file[0] == 'n' ? south_edge : -south_edge) + 0.5;
}

}  // namespace

RawGrid read_pgm_grid(std::string_view bytes, const std::string& name,
                      const std::optional<std::string>& sidecar, const ElevationOptions& options) {
    const GreyCodes grey = decode_pnm(bytes, name, picture_limits(options, sizeof(std::uint16_t)));
    check_grid_size(grey.codes.width, grey.codes.height, name, options, sizeof(std::uint16_t));
    RawGrid grid;
    grid.values = Image<double>(grey.codes.width, grey.codes.height);
    std::copy(grey.codes.pixels.begin(), grey.codes.pixels.end(), grid.values.pixels.begin());
    if (sidecar) read_sidecar(*sidecar, sidecar_name(name), grid);
    return grid;
}

RawGrid read_png_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options) {
    if (!is_png(bytes)) throw InputError(name, "is no PNG by its first bytes");
    if (!has_16_bit_samples(bytes))
        throw InputError(name, "has samples of 8 bits or fewer, steps too coarse for heights: 16 are wanted");
    if (bytes.size() >= 24)
        check_grid_size(png_side(bytes, 0), png_side(bytes, 1), name, options, sizeof(Rgba16));
    const Image<Rgba16> picture =
        decode_png16(bytes, name, {largest_height_field_side, options.max_bytes, options.advice});
    RawGrid grid;
    grid.values = Image<double>(picture.width, picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Rgba16 p = picture.pixels[i];
        if (p.r != p.g || p.g != p.b) {
            const auto width = static_cast<std::size_t>(picture.width);
            throw InputError(
                name, fmt::format("pixel ({}, {}) has a colour: heights are grey", i % width, i / width));
        }
        grid.values.pixels[i] = p.a == 0 ? no_height : p.r;
    }
    return grid;
}

RawGrid read_hgt_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options) {
    int side = 0;
    for (const int known : {1201, 3601}) {
        if (bytes.size() == 2 * static_cast<std::size_t>(known) * static_cast<std::size_t>(known))
            side = known;
    }
    if (side == 0) {
        throw InputError(
            name, fmt::format("has {} bytes: an HGT file has 1201 x 1201 or 3601 x 3601 samples of 2 bytes",
                              bytes.size()));
    }
    check_grid_size(side, side, name, options);
    RawGrid grid;
    grid.z_step_m = 1;
    grid.cell_x = grid.cell_y = 1.0 / (side - 1);
    if (!options.cell_x_m && !options.cell_y_m) {
        grid.degrees = true;
        if (!options.latitude_deg) grid.latitude_deg = middle_latitude(name);
    }
    grid.values = Image<double>(side, side);
    for (std::size_t i = 0; i < grid.values.pixels.size(); ++i) {
        const auto high = static_cast<unsigned char>(bytes[2 * i]),
                   low = static_cast<unsigned char>(bytes[2 * i + 1]);
        const auto height = static_cast<std::int16_t>(high << 8 | low);
        grid.values.pixels[i] = height == std::numeric_limits<std::int16_t>::min() ? no_height : height;
    }
    return grid;
}

}  // namespace obscura
