// From an aperture and a grid to a field: the method that the planner names, once over what is not mirrored.

#include "optics/far_field.h"

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "optics/far_field_methods.h"
#include "optics/far_field_plan.h"
#include "optics/field/row_runs.h"
#include "optics/half_plane.h"
#include "optics/natural_transform.h"
#include "optics/thesis/far_field.h"

namespace obscura {
namespace {

/// Throws when a texel is no number: it would spread over the whole pattern.
void check_texels(ImageView<const float> mask, const RowRuns& runs, bool searched) {
    // A texel that is no number is a run of its own.
    bool finite = true;
    for (const float weight : runs.weight)
        finite = finite && std::isfinite(weight);
    for (int y = 0; !searched && y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x)
            finite = finite && std::isfinite(mask(x, y));
    }
    if (!finite) throw InputError("far field", "the mask holds a value that is not finite");
}

/// `tables`: of the grid, or nullptr.
FarFieldReport compute(const Aperture& aperture, const FrequencyGrid& grid, const FarFieldParams& params,
                       const NaturalTransform* tables, const FieldTarget& target, const Exec& exec) {
    const auto mask = aperture.mask.view();
    const bool searched = params.method == FarFieldMethod::automatic || params.method == FarFieldMethod::runs;
    const RowRuns runs = searched ? row_runs(mask, exec.isa) : RowRuns{};
    check_texels(mask, runs, searched);
    FarFieldReport report = plan_far_field(aperture, runs, grid, params);
    switch (report.method) {
        case FarFieldMethod::automatic:
        case FarFieldMethod::direct:
            far_field_direct(quads_of(mask), grid, target, exec);
            break;
        case FarFieldMethod::shift:
            far_field_shift(quads_of(mask), grid, target, exec);
            break;
        case FarFieldMethod::gemm:
            far_field_gemm(quads_of(mask), grid, target, exec);
            break;
        case FarFieldMethod::edges:
            far_field_edges(mask, grid, params.cull, target, exec, &report);
            break;
        case FarFieldMethod::levels:
            far_field_levels(quads_of(mask), grid, target, exec);
            break;
        case FarFieldMethod::runs:
            if (tables != nullptr)
                far_field_runs(mask, runs, *tables, target, exec);
            else
                far_field_runs(mask, runs, grid, target, exec);
            break;
        case FarFieldMethod::raster_fft:
            if (tables != nullptr)
                far_field_raster_fft(mask, *tables, target, exec);
            else
                far_field_raster_fft(mask, grid, target, exec);
            break;
        case FarFieldMethod::polygon:
            far_field_polygon(aperture.outline, mask.width, mask.height, grid, target, exec);
            break;
    }
    return report;
}

/// The whole grid, or that part of it whose mirror images are the rest.
FarFieldReport compute_mirrored(const Aperture& aperture, const FrequencyGrid& grid,
                                const FarFieldParams& params, Image<float>* re, Image<float>* im,
                                Image<float>* power, const Exec& exec) {
    const auto half = params.symmetry ? half_plane(aperture, grid, params) : std::nullopt;
    const auto target_of = [&](Image<float>* a, Image<float>* b, Image<float>* c, int width) {
        return FieldTarget{a ? a->pixels.data() : nullptr, b ? b->pixels.data() : nullptr,
                           c ? c->pixels.data() : nullptr, width};
    };
    if (!half) return compute(aperture, grid, params, nullptr, target_of(re, im, power, grid.width), exec);
    const auto part = [&](const Image<float>* wanted) {
        return wanted != nullptr ? Image<float>(half->grid.width, half->grid.height) : Image<float>();
    };
    Image<float> part_re = part(re), part_im = part(im), part_power = part(power);
    FarFieldReport report = compute(aperture, half->grid, params, nullptr,
                                    target_of(re ? &part_re : nullptr, im ? &part_im : nullptr,
                                              power ? &part_power : nullptr, half->grid.width),
                                    exec);
    if (re != nullptr) unfold(*half, part_re.view(), 1, *re, exec);
    if (im != nullptr) unfold(*half, part_im.view(), -1, *im, exec);
    if (power != nullptr) unfold(*half, part_power.view(), 1, *power, exec);
    return report;
}

}  // namespace

const char* far_field_method_name(FarFieldMethod method) {
    switch (method) {
        case FarFieldMethod::automatic:
            return "automatic";
        case FarFieldMethod::direct:
            return "direct";
        case FarFieldMethod::shift:
            return "shift";
        case FarFieldMethod::gemm:
            return "gemm";
        case FarFieldMethod::edges:
            return "edges";
        case FarFieldMethod::levels:
            return "levels";
        case FarFieldMethod::runs:
            return "runs";
        case FarFieldMethod::raster_fft:
            return "raster_fft";
        case FarFieldMethod::polygon:
            return "polygon";
    }
    return "?";
}

Field far_field(const Aperture& aperture, const FrequencyGrid& grid, const FarFieldParams& params,
                const Exec& exec, FarFieldReport* report) {
    check_grid(grid);
    Field field{Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
    const FarFieldReport done = compute_mirrored(aperture, grid, params, &field.re, &field.im, nullptr, exec);
    if (report != nullptr) *report = done;
    return field;
}

Image<float> far_field_power(const Aperture& aperture, const FrequencyGrid& grid,
                             const FarFieldParams& params, const Exec& exec, FarFieldReport* report) {
    check_grid(grid);
    Image<float> power(grid.width, grid.height);
    const FarFieldReport done = compute_mirrored(aperture, grid, params, nullptr, nullptr, &power, exec);
    if (report != nullptr) *report = done;
    return power;
}

void far_field_into(const Aperture& aperture, const FrequencyGrid& grid, const FarFieldParams& params,
                    const FieldTarget& target, const Exec& exec, FarFieldReport* report) {
    check_grid(grid);
    CHECK(target.stride >= grid.width);
    const FarFieldReport done = compute(aperture, grid, params, nullptr, target, exec);
    if (report != nullptr) *report = done;
}

void far_field_into(const Aperture& aperture, const FrequencyGrid& grid, const FarFieldParams& params,
                    const NaturalTransform& tables, const FieldTarget& target, const Exec& exec,
                    FarFieldReport* report) {
    check_grid(grid);
    CHECK(target.stride >= grid.width && tables.grid.u.count == grid.width &&
          tables.grid.v.count == grid.height);
    const FarFieldReport done = compute(aperture, grid, params, &tables, target, exec);
    if (report != nullptr) *report = done;
}

}  // namespace obscura
