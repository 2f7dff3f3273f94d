// What every near field has in common: checks, the coarse mask, the choice of a strategy, memory.

#include "optics/near_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "optics/aperture_extent.h"
#include "optics/near_field_methods.h"
#include "optics/thesis/near_field.h"

namespace obscura {
namespace {

void check_length(double metres, const char* what) {
    if (!(metres > 0) || !std::isfinite(metres))
        throw InputError("", fmt::format("{} must be positive and finite, not {:g} m", what, metres));
}

double turns_of(const Aperture& aperture, const NearFieldParams& params) {
    check_length(params.distance_m, "the distance behind the aperture");
    check_length(params.wavelength_m, "the wavelength");
    check_length(aperture.pitch_m, "the pitch of the aperture");
    const double turns = aperture.pitch_m / params.wavelength_m * aperture.pitch_m / (2 * params.distance_m);
    if (!(turns > 1e-60 && turns < 1e60)) {
        throw InputError("", fmt::format("a distance of {:g} m has no meaning at a pitch of {:g} m and a "
                                         "wavelength of {:g} m",
                                         params.distance_m, aperture.pitch_m, params.wavelength_m));
    }
    return turns;
}

void check_plane(const PlaneGrid& grid) {
    if (grid.width < 1 || grid.height < 1)
        throw InputError("near field",
                         fmt::format("a plane of {} x {} pixels is empty", grid.width, grid.height));
    const double extent = grid.step * std::max(grid.width, grid.height);
    if (grid.step > 0 && std::isfinite(grid.first_x + extent) && std::isfinite(grid.first_y + extent)) return;
    throw InputError(
        "near field",
        fmt::format("positions of a plane must be finite and their step positive, not from {}, {} "
                    "in steps of {} texels",
                    grid.first_x, grid.first_y, grid.step));
}

bool is_binary(const Image<float>& mask) {
    for (const float v : mask.pixels) {
        if (v != 0.0f && v != 1.0f) return false;
    }
    return true;
}

NearFieldCase case_of(ImageView<const float> mask, const PlaneGrid& grid, double turns) {
    NearFieldCase c{mask, grid, turns, row_changes(mask), {}};
    c.symmetry = symmetry_of(c.changes, mask.width);
    return c;
}

}  // namespace

const char* near_field_method_name(NearFieldMethod method) {
    switch (method) {
        case NearFieldMethod::automatic:
            return "automatic";
        case NearFieldMethod::direct:
            return "direct";
        case NearFieldMethod::two_pass:
            return "two_pass";
        case NearFieldMethod::edges:
            return "edges";
        case NearFieldMethod::hybrid:
            return "hybrid";
        case NearFieldMethod::fft:
            return "fft";
    }
    return "?";
}

double fresnel_number(const Aperture& aperture, const NearFieldParams& params) {
    const double half = 0.5 * std::max(aperture.mask.width, aperture.mask.height);
    return 2 * half * half * turns_of(aperture, params);
}

double opening_fresnel_number(const Aperture& aperture, const NearFieldParams& params) {
    const OpenExtent open = open_extent(aperture.mask.view());
    const double half = 0.5 * std::max(open.width, open.height);
    return 2 * half * half * turns_of(aperture, params);
}

NearFieldCase near_field_case(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                              Aperture& coarse) {
    CHECK(aperture.mask.width > 0 && aperture.mask.height > 0);
    check_plane(grid);
    if (params.coarse_levels < 0 || params.coarse_levels > 12)
        throw InputError("", fmt::format("coarse levels lie in 0 to 12, not at {}", params.coarse_levels));
    const double turns = turns_of(aperture, params);
    if (params.coarse_levels == 0) return case_of(aperture.mask.view(), grid, turns);

    coarse = reduce(aperture, params.coarse_levels, is_binary(aperture.mask));
    const double side = 1 << params.coarse_levels;
    // reduce() keeps the upper left corner; the centre moves where the size is no multiple of `side`.
    PlaneGrid to = grid;
    to.step = grid.step / side;
    to.first_x = (grid.first_x + 0.5 * aperture.mask.width) / side - 0.5 * coarse.mask.width;
    to.first_y = (grid.first_y + 0.5 * aperture.mask.height) / side - 0.5 * coarse.mask.height;
    return case_of(coarse.mask.view(), to, turns * side * side);
}

namespace {

void compute(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
             const FieldTarget& target, const Exec& exec, NearFieldReport* report) {
    Aperture coarse;
    const NearFieldCase c = near_field_case(aperture, grid, params, coarse);
    NearFieldReport plan = plan_near_field_case(c, params);
    switch (plan.method) {
        case NearFieldMethod::direct:
        case NearFieldMethod::two_pass: {
            const QuadList quads = quads_of(c.mask);
            plan.quads = static_cast<std::int64_t>(quads.size());
            if (plan.method == NearFieldMethod::direct)
                near_field_direct(c, quads, target, exec);
            else
                near_field_two_pass(c, quads, target, exec);
            break;
        }
        case NearFieldMethod::edges:
            near_field_edges(c, params.cull, target, exec, plan);
            break;
        case NearFieldMethod::hybrid:
            near_field_hybrid(c, target, exec);
            break;
        case NearFieldMethod::fft:
            near_field_fft(c, target, exec);
            break;
        case NearFieldMethod::automatic:
            CHECK(false);
    }
    if (report != nullptr) *report = plan;
}

}  // namespace

NearFieldReport plan_near_field(const Aperture& aperture, const PlaneGrid& grid,
                                const NearFieldParams& params) {
    Aperture coarse;
    return plan_near_field_case(near_field_case(aperture, grid, params, coarse), params);
}

Field near_field(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                 const Exec& exec, NearFieldReport* report) {
    check_plane(grid);
    Field field{Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
    compute(aperture, grid, params, {field.re.pixels.data(), field.im.pixels.data(), nullptr, grid.width},
            exec, report);
    return field;
}

void near_field_into(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                     const FieldTarget& target, const Exec& exec, NearFieldReport* report) {
    CHECK(target.stride >= grid.width);
    compute(aperture, grid, params, target, exec, report);
}

Image<float> near_field_intensity(const Aperture& aperture, const PlaneGrid& grid,
                                  const NearFieldParams& params, const Exec& exec, NearFieldReport* report) {
    check_plane(grid);
    Image<float> power(grid.width, grid.height);
    compute(aperture, grid, params, {nullptr, nullptr, power.pixels.data(), grid.width}, exec, report);
    return power;
}

}  // namespace obscura
