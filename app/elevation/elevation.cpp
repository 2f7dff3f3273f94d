#include "app/elevation/elevation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "app/elevation/raw_grid.h"
#include "core/error.h"
#include "core/num.h"
#include "raster/heights/height_mesh.h"

namespace obscura {
namespace {

std::string ending_of(const std::string& name) {
    const std::size_t dot = name.find_last_of("./\\");
    std::string ending = dot == std::string::npos || name[dot] != '.' ? "" : name.substr(dot + 1);
    for (char& c : ending)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    return ending;
}

RawGrid read_grid(std::string_view bytes, const std::string& name, const std::optional<std::string>& sidecar,
                  const ElevationOptions& options) {
    const std::string ending = ending_of(name);
    if (ending == "pgm") return read_pgm_grid(bytes, name, sidecar, options);
    if (ending == "asc") return read_esri_grid(bytes, name, options);
    if (ending == "hgt") return read_hgt_grid(bytes, name, options);
    if (ending == "png") return read_png_grid(bytes, name, options);
    if (ending == "tif" || ending == "tiff") return read_geotiff_grid(bytes, name, options);
    throw InputError(
        name, "an elevation model is a .pgm, .asc, .hgt, .tif or .png file, and the name says none of these");
}

/// Lengths of a degree on the WGS84 ellipsoid (series as in the US NGA's tables).
double metres_per_degree_east(double latitude_deg) {
    const double f = latitude_deg;
    return 111412.84 * num::cos_deg(f) - 93.5 * num::cos_deg(3 * f) + 0.118 * num::cos_deg(5 * f);
}
double metres_per_degree_north(double latitude_deg) {
    return 111132.92 - 559.82 * num::cos_deg(2 * latitude_deg) + 1.175 * num::cos_deg(4 * latitude_deg);
}

struct CellSize {
    double x_m, y_m;
};

CellSize cell_size(const RawGrid& raw, const std::string& name, const ElevationOptions& o) {
    CellSize cell{};
    if (o.cell_x_m || o.cell_y_m) {
        if (o.latitude_deg)
            throw InputError(name,
                             "latitude_deg is for cells in degrees, and cell_x_m or cell_y_m says metres");
        cell = {o.cell_x_m ? *o.cell_x_m : *o.cell_y_m, o.cell_y_m ? *o.cell_y_m : *o.cell_x_m};
    } else {
        if (!raw.cell_x || !raw.cell_y)
            throw InputError(name, "says nothing about the size of its cells: give cell_x_m and cell_y_m");
        cell = {*raw.cell_x, *raw.cell_y};
        const std::optional<double> latitude = o.latitude_deg ? o.latitude_deg : raw.latitude_deg;
        if (raw.metres && o.latitude_deg)
            throw InputError(name, "has cells in metres, and latitude_deg is for cells in degrees");
        if (raw.degrees || o.latitude_deg) {
            if (!latitude) {
                throw InputError(
                    name,
                    fmt::format("has cells of {} by {}, degrees by where it lies, which are metres at a "
                                "latitude only: give latitude_deg, or cell_x_m and cell_y_m",
                                cell.x_m, cell.y_m));
            }
            if (std::fabs(*latitude) > 89.9)
                throw InputError(name,
                                 "cells in degrees have no shape at the poles: give cell_x_m and cell_y_m");
            cell = {cell.x_m * metres_per_degree_east(*latitude),
                    cell.y_m * metres_per_degree_north(*latitude)};
        }
    }
    for (const double m : {cell.x_m, cell.y_m}) {
        if (!std::isfinite(m) || m < 1e-3 || m > 1e6)
            throw InputError(name, fmt::format("cells of {} by {} m: sizes lie between 1 mm and 1000 km",
                                               cell.x_m, cell.y_m));
    }
    return cell;
}

std::int64_t count_holes(const Image<double>& values) {
    return std::count_if(values.pixels.begin(), values.pixels.end(), [](double v) { return std::isnan(v); });
}

/// Codes by which files mark holes, and which are no heights unless the file declares another use.
bool is_customary_hole(double value) {
    return value == -32768 || value == -9999;
}

/// From the file's units to metres before exaggeration. Every height is one that a field can have from here
/// on, so that means of heights are finite.
void to_metres(RawGrid& raw, double step_m, const std::string& name) {
    for (std::size_t i = 0; i < raw.values.pixels.size(); ++i) {
        double& v = raw.values.pixels[i];
        if (std::isnan(v)) continue;
        const double height_m = v * step_m + raw.z_offset_m;
        if (std::fabs(height_m) <= largest_height_m && !is_customary_hole(v)) {
            v = height_m;
            continue;
        }
        const auto width = static_cast<std::size_t>(raw.values.width);
        const std::string place = fmt::format("column {}, row {}: ", i % width, i / width);
        if (is_customary_hole(v))
            throw InputError(name,
                             fmt::format("{}{} marks holes, and the file does not declare it", place, v));
        throw InputError(name,
                         fmt::format("{}a height of {} m is beyond {} m: is the z unit right, or is this a "
                                     "hole that the file does not declare?",
                                     place, height_m, largest_height_m));
    }
}

/// Gives every hole the mean of those of its eight neighbours that have a height, layer after layer from the
/// border.
void fill_holes(Image<double>& values) {
    using Place = std::pair<int, int>;
    const auto neighbours = [&](Place at, auto&& visit) {
        for (int y = std::max(0, at.second - 1); y <= std::min(values.height - 1, at.second + 1); ++y) {
            for (int x = std::max(0, at.first - 1); x <= std::min(values.width - 1, at.first + 1); ++x)
                visit(x, y);
        }
    };
    std::vector<Place> layer;
    for (int y = 0; y < values.height; ++y) {
        for (int x = 0; x < values.width; ++x) {
            bool border = false;
            if (std::isnan(values(x, y)))
                neighbours({x, y}, [&](int i, int j) { border |= !std::isnan(values(i, j)); });
            if (border) layer.emplace_back(x, y);
        }
    }
    while (!layer.empty()) {
        std::vector<double> means;
        for (const Place& at : layer) {
            double sum = 0;
            int known = 0;
            neighbours(at, [&](int i, int j) {
                if (std::isnan(values(i, j))) return;
                sum += values(i, j);
                ++known;
            });
            means.push_back(sum / known);
        }
        for (std::size_t i = 0; i < layer.size(); ++i)
            values(layer[i].first, layer[i].second) = means[i];
        // What lies within is next, in the order in which it is met.
        std::vector<Place> next;
        for (const Place& at : layer) {
            neighbours(at, [&](int i, int j) {
                if (std::isnan(values(i, j))) next.emplace_back(i, j);
            });
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        layer = std::move(next);
    }
}

void close_holes(Image<double>& metres, std::int64_t holes, const std::string& name,
                 const ElevationOptions& o) {
    if (holes == 0) return;
    const auto first =
        std::find_if(metres.pixels.begin(), metres.pixels.end(), [](double v) { return std::isnan(v); }) -
        metres.pixels.begin();
    if (o.holes == HolePolicy::refuse) {
        throw InputError(
            name, fmt::format("{} of {} samples have no height, the first at column {}, row {}: holes = "
                              "\"fill\" or \"level\" says what to take them for",
                              holes, metres.pixels.size(), first % metres.width, first / metres.width));
    }
    if (o.holes == HolePolicy::fill) {
        if (holes == static_cast<std::int64_t>(metres.pixels.size()))
            throw InputError(name, "no sample has a height: there is nothing to fill holes from");
        fill_holes(metres);
        return;
    }
    for (double& v : metres.pixels)
        v = std::isnan(v) ? o.hole_level_m : v;
}

}  // namespace

void check_grid_size(std::int64_t width, std::int64_t height, const std::string& name,
                     const ElevationOptions& options, std::int64_t code_bytes) {
    if (width < 1 || height < 1) throw InputError(name, fmt::format("has {} by {} samples", width, height));
    if (width > largest_height_field_side || height > largest_height_field_side) {
        throw LimitError(fmt::format("{}: {} by {} samples; a side has at most {}", name, width, height,
                                     largest_height_field_side));
    }
    const std::int64_t samples = width * height;
    const auto check = [&](std::int64_t bytes, const char* doing) {
        if (bytes <= options.max_bytes) return;
        throw LimitError(fmt::format("{}: {} by {} samples take {} MiB {}, more than {} MiB{}", name, width,
                                     height, bytes >> 20, doing, options.max_bytes >> 20, options.advice));
    };
    check(samples * (code_bytes + std::int64_t{sizeof(double) + sizeof(std::int32_t)}),
          "while they are read");
    if (options.as_mesh && width >= 2 && height >= 2) {
        // The scene's copy of the mesh is made from it.
        check(samples * std::int64_t{sizeof(std::int32_t)} + 2 * height_mesh_bytes(width, height),
              "as a mesh of a scene");
    }
}

ElevationModel decode_elevation(std::string_view bytes, const std::string& name,
                                const std::optional<std::string>& sidecar, const ElevationOptions& options) {
    RawGrid raw = read_grid(bytes, name, sidecar, options);
    const CellSize cell = cell_size(raw, name, options);
    const std::optional<double> step = options.z_step_m ? options.z_step_m : raw.z_step_m;
    if (!step) throw InputError(name, "says nothing about the unit of its heights: give z_step_m");
    to_metres(raw, *step, name);

    ElevationModel model;
    model.holes = count_holes(raw.values);
    close_holes(raw.values, model.holes, name, options);
    model.field = {Image<std::int32_t>(raw.values.width, raw.values.height), cell.x_m, cell.y_m,
                   Diagonal::falling};
    model.least_m = largest_height_m;
    model.greatest_m = -largest_height_m;
    for (std::size_t i = 0; i < raw.values.pixels.size(); ++i) {
        const double height_m = raw.values.pixels[i] * options.exaggeration;
        if (!(std::fabs(height_m) <= largest_height_m)) {
            const auto width = static_cast<std::size_t>(raw.values.width);
            throw InputError(
                name, fmt::format("column {}, row {}: {} m times exaggeration {} is beyond {} m", i % width,
                                  i / width, raw.values.pixels[i], options.exaggeration, largest_height_m));
        }
        model.least_m = std::min(model.least_m, height_m);
        model.greatest_m = std::max(model.greatest_m, height_m);
        model.field.height_q16.pixels[i] = height_q16_of(height_m);
    }
    return model;
}

std::string sidecar_name(const std::string& name) {
    return ending_of(name) == "pgm" ? name.substr(0, name.size() - 4) + ".json" : "";
}

}  // namespace obscura
