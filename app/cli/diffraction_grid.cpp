#include "app/cli/diffraction_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "optics/aperture_extent.h"
#include "optics/field/natural_grid.h"
#include "optics/field/near_field_axis.h"

namespace obscura {
namespace {

/// Streaks are in sight and rings can be counted: the opening's width times the highest frequency is from 56
/// to 112. A power of two keeps natural grids natural.
double far_zoom(const DiffractionOptions& options, const Aperture& aperture) {
    if (options.zoom > 0) return options.zoom;
    constexpr int most_fringes = 112;
    const OpenExtent open = open_extent(aperture.mask.view());
    double zoom = 1;
    while (zoom * most_fringes < std::max(open.width, open.height) / 2.0)
        zoom *= 2;
    return zoom;
}

/// Whether the method that was asked for can serve what the grid's size makes of it.
bool serves(const DiffractionOptions& options, const Aperture& aperture) {
    if (options.near_m) {
        return (options.near_method != NearFieldMethod::hybrid &&
                options.near_method != NearFieldMethod::fft) ||
               step_ratio(near_grid(options, aperture).step).has_value();
    }
    return (options.far.method != FarFieldMethod::levels &&
            options.far.method != FarFieldMethod::raster_fft) ||
           natural_grid(aperture.mask.width, aperture.mask.height, far_grid(options, aperture)).has_value();
}

}  // namespace

double longer_side(const Aperture& aperture) {
    return std::max(aperture.mask.width, aperture.mask.height);
}

FrequencyGrid far_grid(const DiffractionOptions& options, const Aperture& aperture) {
    const double step = 1 / (far_zoom(options, aperture) * options.size_px);
    const double side = longer_side(aperture);
    return centred_grid(options.size_px, options.size_px, step, options.centre.x / side,
                        options.centre.y / side);
}

PlaneGrid near_grid(const DiffractionOptions& options, const Aperture& aperture) {
    const double side = longer_side(aperture);
    PlaneGrid plane = centred_plane(options.size_px, side / (options.zoom > 0 ? options.zoom : 1));
    plane.first_x += options.centre.x * side;
    plane.first_y += options.centre.y * side;
    return plane;
}

void check_served(const DiffractionOptions& options, const Aperture& aperture) {
    if (serves(options, aperture)) return;
    const double side = longer_side(aperture), size = options.size_px;
    const double pixels = size * (options.zoom > 0 ? options.zoom
                                  : options.near_m ? 1
                                                   : far_zoom(options, aperture));
    DiffractionOptions other = options;
    std::string text;
    if (options.near_m) {
        const double ratio = pixels / side;
        const double whole = ratio >= 1 ? std::floor(ratio + 0.5) : 1 / std::floor(1 / ratio + 0.5);
        other.zoom = std::clamp(whole, 1.0 / 16, 16.0) * side / size;
        text = fmt::format(
            "cannot serve --size x --zoom = {:.6g}: that must be the mask's side, {}, times a ratio of "
            "whole numbers, the upper one up to 16",
            pixels, side);
    } else {
        double period = 1;
        while (period < std::max(side, pixels / 1.5))
            period *= 2;
        other.zoom = period / size;
        text = fmt::format(
            "cannot serve --size x --zoom = {:.6g}: that must be a power of two, at least the "
            "mask's side, {}, and --centre on a pixel",
            pixels, side);
    }
    if (serves(other, aperture)) text += fmt::format("; --zoom {} would do", other.zoom);
    throw InputError(fmt::format("--method {}", options.near_m ? near_field_method_name(options.near_method)
                                                               : far_field_method_name(options.far.method)),
                     text);
}

}  // namespace obscura
