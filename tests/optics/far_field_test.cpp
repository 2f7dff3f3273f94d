// The far field on natural grids, and what mirrors it: against the definition in double.

#include "optics/far_field.h"

#include <gtest/gtest.h>

#include "optics/field/natural_grid.h"
#include "optics/natural_transform.h"
#include "tests/optics/far_field_oracle.h"

namespace obscura {
namespace {

using namespace far_field_oracle;

constexpr double tolerance = 1e-6;

std::vector<FrequencyGrid> natural_grids(int period) {
    const double step = 1.0 / period;
    return {centred_grid(2 * period, 2 * period, step),
            half_grid(2 * period, 2 * period, step),
            centred_grid(period / 2, period / 4 + 1, step),
            centred_grid(37, 29, step, 5 * step, -11 * step),
            {3 * period, 5, -1.5, 0.25, step, step},
            {20, 3 * period, 7 * step, -2, step, step},
            centred_grid(9, 11, step / 64, step / 4, 0),
            {25, 31, -12 * step / 2, -15 * step / 4, step / 2, step / 4}};
}

TEST(FarField, NaturalGridsAgreeWithTheDefinition) {
    for (const int size : {64, 32, 16}) {
        for (const NamedMask& m : hard_masks(size)) {
            const double area = open_area(m.aperture.mask.view());
            for (const FrequencyGrid& grid : natural_grids(size)) {
                const auto truth = exact(m.aperture.mask.view(), grid);
                for (const FarFieldMethod method : {FarFieldMethod::runs, FarFieldMethod::raster_fft}) {
                    for (const bool symmetry : {false, true}) {
                        FarFieldParams params;
                        params.method = method;
                        params.symmetry = symmetry;
                        SCOPED_TRACE(m.name + " " + std::to_string(size) + ", " +
                                     far_field_method_name(method) + (symmetry ? ", mirrored" : "") +
                                     ", grid " + std::to_string(grid.width) + " x " +
                                     std::to_string(grid.height));
                        const Field field = far_field(m.aperture, grid, params, {});
                        EXPECT_LE(amplitude_error(field, truth, area), tolerance);
                        const Image<float> power = far_field_power(m.aperture, grid, params, {});
                        EXPECT_LE(power_error(power, truth, area), tolerance);
                    }
                }
            }
        }
    }
}

/// Thousands of runs in a row, whose lengths add up to the field at frequency 0.
TEST(FarField, WideGreyMasksKeepTheirArea) {
    Image<float> mask(4096, 16);
    for (const bool mirrored : {false, true}) {
        for (int y = 0; y < mask.height; ++y) {
            for (int x = 0; x < mask.width; ++x)
                mask(x, y) = std::min(x, mirrored ? mask.width - 1 - x : x) % 2 == 0 ? 0.1f : 0.3f;
        }
        const double step = 1.0 / mask.width;
        const FrequencyGrid grid{35, 3, -2 * step, -step, step, step};
        const auto natural = natural_grid(mask.width, mask.height, grid);
        ASSERT_TRUE(natural);
        Field field{Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
        far_field_runs(mask.view(), row_runs(mask.view(), best_isa()),
                       natural_transform(mask.width, mask.height, *natural),
                       {field.re.pixels.data(), field.im.pixels.data(), nullptr, grid.width}, {});
        const auto truth = exact(mask.view(), grid);
        EXPECT_LE(amplitude_error(field, truth, open_area(mask.view())), tolerance) << mirrored;
    }
}

/// Of log10 of the power relative to the peak, never below 1e-10, over ten decades.
double log_psnr_db(const Field& field, const std::vector<Complex>& truth, double area) {
    double squares = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const auto re = static_cast<double>(field.re.pixels[i]), im = static_cast<double>(field.im.pixels[i]);
        const double shown = std::max((re * re + im * im) / (area * area), 1e-10);
        const double decades = std::log10(shown / std::max(std::norm(truth[i]) / (area * area), 1e-10));
        squares += decades * decades;
    }
    return 20 * std::log10(10 / std::sqrt(squares / static_cast<double>(truth.size())));
}

/// Openings that half a turn leaves as they are have real fields, which are dark along whole lines: there all
/// of the rounding shows.
TEST(FarField, DarkLinesOfEvenIrisesAreDark) {
    for (const int size : {128, 256}) {
        for (const int blades : {6, 8}) {
            for (const int finer : {1, 2}) {
                ApertureShape shape;
                shape.blades = blades;
                const Aperture iris = make_aperture(shape, size, 0.01);
                const FrequencyGrid grid = centred_grid(size, size, 1.0 / (finer * size));
                FarFieldParams params;
                params.method = FarFieldMethod::runs;
                const Field field = far_field(iris, grid, params, {});
                EXPECT_GE(log_psnr_db(field, exact(iris.mask.view(), grid), open_area(iris.mask.view())), 125)
                    << size << " texels, " << blades << " blades, step 1 / " << finer * size;
            }
        }
    }
}

/// Every pixel of the caller's memory is written, and nothing beside it.
TEST(FarField, WritesAllOfItsTargetAndNothingElse) {
    for (const NamedMask& m : hard_masks(32)) {
        for (const FrequencyGrid& grid : natural_grids(32)) {
            for (const FarFieldMethod method : {FarFieldMethod::runs, FarFieldMethod::raster_fft}) {
                FarFieldParams params;
                params.method = method;
                params.symmetry = false;
                const Field field = far_field(m.aperture, grid, params, {});
                const int stride = grid.width + 3;
                Image<float> re(stride, grid.height, NAN), im = re, power = re;
                far_field_into(m.aperture, grid, params,
                               {re.pixels.data(), im.pixels.data(), power.pixels.data(), stride}, {});
                for (int y = 0; y < grid.height; ++y) {
                    for (int x = 0; x < stride; ++x) {
                        const bool inside = x < grid.width;
                        ASSERT_EQ(std::isnan(re(x, y)), !inside) << m.name << " " << x << ", " << y;
                        ASSERT_EQ(std::isnan(power(x, y)), !inside) << m.name << " " << x << ", " << y;
                        if (!inside) continue;
                        ASSERT_EQ(re(x, y), field.re(x, y)) << m.name << " " << x << ", " << y;
                        ASSERT_EQ(im(x, y), field.im(x, y)) << m.name << " " << x << ", " << y;
                    }
                }
            }
        }
    }
}

/// Zooms, odd steps, windows far out, single pixels.
std::vector<FrequencyGrid> other_grids(int size) {
    const double step = 1.0 / size;
    return {centred_grid(48, 40, 0.37 * step), centred_grid(33, 65, step / 1000, 0.3, -0.2),
            centred_grid(31, 17, 1e-9, 0, 0),  {37, 1, -1.3 * step, 0.77, 0.9 * step, step},
            {1, 1, 0, 0, step, step},          {5, 900, 100.3, -2, 1.1 * step, 0.3 * step},
            half_grid(50, 50, 0.11 * step)};
}

TEST(FarField, OtherGridsAgreeWithTheDefinition) {
    for (const int size : {64, 21}) {
        for (const NamedMask& m : hard_masks(size)) {
            const double area = open_area(m.aperture.mask.view());
            for (const FrequencyGrid& grid : other_grids(size)) {
                const auto truth = exact(m.aperture.mask.view(), grid);
                for (const bool symmetry : {false, true}) {
                    FarFieldParams params;
                    params.method = FarFieldMethod::runs;
                    params.symmetry = symmetry;
                    SCOPED_TRACE(m.name + " " + std::to_string(size) + (symmetry ? ", mirrored" : "") +
                                 ", grid " + std::to_string(grid.width) + " x " +
                                 std::to_string(grid.height));
                    EXPECT_LE(amplitude_error(far_field(m.aperture, grid, params, {}), truth, area),
                              tolerance);
                    EXPECT_LE(power_error(far_field_power(m.aperture, grid, params, {}), truth, area),
                              tolerance);
                }
            }
        }
    }
}

TEST(FarField, ThePlannerKnowsRunsNoiseAndBoxes) {
    const int size = 256;
    const FrequencyGrid natural = half_grid(2 * size, 2 * size, 1.0 / size);
    const FrequencyGrid zoomed = centred_grid(512, 512, 0.23 / size);
    for (const NamedMask& m : hard_masks(2 * size)) {
        const Aperture aperture = reduce(m.aperture, 1, true);
        const auto expect = [&](const FrequencyGrid& grid, FarFieldMethod method) {
            const FarFieldReport plan = plan_far_field(aperture, grid, {});
            EXPECT_EQ(plan.method, method) << m.name << ": " << plan.reason;
            EXPECT_GT(plan.cost_ms, 0);
            EXPECT_EQ(plan.reason.find(far_field_method_name(method)), 0u) << plan.reason;
        };
        if (m.name == "circle" || m.name == "iris" || m.name == "whirl")
            expect(natural, FarFieldMethod::runs);
        if (m.name == "noise") expect(natural, FarFieldMethod::raster_fft);
        if (m.name == "whirl" || m.name == "noise") expect(zoomed, FarFieldMethod::runs);
        if (m.name == "box" || m.name == "full") expect(zoomed, FarFieldMethod::edges);
    }
}

TEST(FarField, TexelsThatAreNoNumbersAreRefused) {
    for (const float bad : {NAN, INFINITY}) {
        Aperture aperture = hard_masks(32)[2].aperture;
        aperture.mask(3, 3) = bad;
        for (const FarFieldMethod method :
             {FarFieldMethod::automatic, FarFieldMethod::runs, FarFieldMethod::edges, FarFieldMethod::direct,
              FarFieldMethod::raster_fft}) {
            FarFieldParams params;
            params.method = method;
            EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 1.0 / 32), params, {}), InputError);
        }
        EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 0.1), {}, {}), InputError);
    }
}

TEST(FarField, MethodsThatCannotServeAreRefused) {
    const Aperture aperture = hard_masks(32)[5].aperture;
    FarFieldParams params;
    params.method = FarFieldMethod::raster_fft;
    EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 0.01), params, {}), InputError);
    EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 1.0 / 16), params, {}), InputError);
    params.method = FarFieldMethod::levels;
    EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 0.01), params, {}), InputError);
    params.method = FarFieldMethod::polygon;
    EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 0.01), params, {}), InputError);
    params.method = FarFieldMethod::runs;
    params.cull = 1e-4;
    EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 0.01), params, {}), InputError);
    params.method = FarFieldMethod::automatic;
    params.cull = -1;
    EXPECT_THROW(far_field(aperture, centred_grid(8, 8, 0.01), params, {}), InputError);
}

TEST(FarField, GridsThatMeanNothingAreRefused) {
    const Aperture aperture = hard_masks(32)[2].aperture;
    for (const FrequencyGrid& grid :
         {FrequencyGrid{0, 8, 0, 0, 0.1, 0.1}, FrequencyGrid{8, -1, 0, 0, 0.1, 0.1},
          FrequencyGrid{8, 8, 0, 0, 0, 0.1}, FrequencyGrid{8, 8, 0, 0, 0.1, NAN},
          FrequencyGrid{8, 8, 0, 0, INFINITY, 0.1}, FrequencyGrid{8, 8, 0, 0, -0.1, 0.1},
          FrequencyGrid{8, 8, NAN, 0, 0.1, 0.1}, FrequencyGrid{8, 8, 0, -INFINITY, 0.1, 0.1}}) {
        EXPECT_THROW(far_field(aperture, grid, {}, {}), InputError);
        EXPECT_THROW(far_field_power(aperture, grid, {}, {}), InputError);
        EXPECT_THROW(plan_far_field(aperture, grid, {}), InputError);
        EXPECT_THROW(far_field_into(aperture, grid, {}, {}, {}), InputError);
    }
}

TEST(FarField, MasksTooHighForTransformsAreServedByEdges) {
    // A column of open texels, as high as anything: sinc, over its height, of frequencies around 0.
    const int height = 65537;
    Aperture aperture;
    aperture.mask = Image<float>(1, height);
    std::fill(aperture.mask.pixels.begin(), aperture.mask.pixels.end(), 1.0f);
    const FrequencyGrid grid = centred_grid(1, 5, 0.3 / height);
    FarFieldReport report;
    const Field field = far_field(aperture, grid, {}, {}, &report);
    EXPECT_EQ(report.method, FarFieldMethod::edges) << report.reason;
    for (int y = 0; y < 5; ++y) {
        const double turns = 0.3 * (y - 2), angle = 3.14159265358979323846 * turns;
        const double expected = turns == 0 ? height : height * std::sin(angle) / angle;
        EXPECT_NEAR(static_cast<double>(field.re(0, y)), expected, 2e-6 * height) << y;
    }
    FarFieldParams runs;
    runs.method = FarFieldMethod::runs;
    EXPECT_THROW(far_field(aperture, grid, runs, {}), LimitError);
}

TEST(FarField, BitsDoNotDependOnThreadsOrInstructionSet) {
    for (const NamedMask& m : hard_masks(64)) {
        auto grids = natural_grids(64);
        for (const FrequencyGrid& grid : other_grids(64))
            grids.push_back(grid);
        for (const FrequencyGrid& grid : grids) {
            const bool natural =
                natural_grid(m.aperture.mask.width, m.aperture.mask.height, grid).has_value();
            for (const FarFieldMethod method : {FarFieldMethod::runs, FarFieldMethod::raster_fft}) {
                if (method == FarFieldMethod::raster_fft && !natural) continue;
                FarFieldParams params;
                params.method = method;
                const Field first = far_field(m.aperture, grid, params, {Isa::ref, 1});
                const Image<float> power = far_field_power(m.aperture, grid, params, {Isa::ref, 1});
                for (const Isa isa : supported_isas()) {
                    for (const int threads : {1, 3}) {
                        const Field field = far_field(m.aperture, grid, params, {isa, threads});
                        ASSERT_EQ(field.re, first.re) << m.name << " " << isa_name(isa);
                        ASSERT_EQ(field.im, first.im) << m.name << " " << isa_name(isa);
                        ASSERT_EQ(far_field_power(m.aperture, grid, params, {isa, threads}), power) << m.name;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace obscura
