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

namespace obscura {
namespace {

ImageFileLimits picture_limits(const ElevationOptions& options) {
    return {largest_height_field_side, options.max_bytes, ""};
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
            "an HGT file says where it lies by its name, like N37E014.hgt: rename it, or give cell_x_m and "
            "cell_y_m");
    }
    const int south_edge = (file[1] - '0') * 10 + (file[2] - '0');
    return (file[0] == 'N' || file[0] == 'n' ? south_edge : -south_edge) + 0.5;
}

}  // namespace

RawGrid read_pgm_grid(std::string_view bytes, const std::string& name,
                      const std::optional<std::string>& sidecar, const ElevationOptions& options) {
    const GreyCodes grey = decode_pnm(bytes, name, picture_limits(options));
    check_grid_size(grey.codes.width, grey.codes.height, name, options);
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
    const Image<Rgba16> picture = decode_png16(bytes, name, picture_limits(options));
    check_grid_size(picture.width, picture.height, name, options);
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
        grid.latitude_deg = middle_latitude(name);
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
