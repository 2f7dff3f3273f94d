// What transforms must do, whatever computes them: add up, add up to the whole with the complement, and stay
// exact at the sizes that pictures have.

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/image_io.h"
#include "optics/far_field_methods.h"
#include "optics/thesis/far_field.h"
#include "tests/core/shared_folder.h"
#include "tests/optics/far_field_reference.h"

namespace obscura {
namespace {

using namespace far_field_reference;

struct Strategy {
    const char* name;
    void (*run)(ImageView<const float>, const FrequencyGrid&, const FieldTarget&, const Exec&);
    bool fast;  ///< at real sizes, in a test
};

const std::vector<Strategy> strategies{
    {"direct",
     [](ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target, const Exec& exec) {
         far_field_direct(tree_quads(mask), grid, target, exec);
     },
     false},
    {"shift",
     [](ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target, const Exec& exec) {
         far_field_shift(tree_quads(mask), grid, target, exec);
     },
     true},
    {"gemm",
     [](ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target, const Exec& exec) {
         far_field_gemm(tree_quads(mask), grid, target, exec);
     },
     true},
    {"edges",
     [](ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target, const Exec& exec) {
         far_field_edges(mask, grid, 0, target, exec, nullptr);
     },
     true},
    {"levels",
     [](ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target, const Exec& exec) {
         far_field_levels(tree_quads(mask), grid, target, exec);
     },
     true},
};

Field field_of(const Strategy& strategy, const Image<float>& mask, const FrequencyGrid& grid) {
    Field field = field_for(grid);
    strategy.run(mask.view(), grid, target_of(field), Exec{});
    return field;
}

/// Largest |a f + b g - h|.
double off(double a, const Field& f, double b, const Field& g, const Field& h) {
    double worst = 0;
    for (std::size_t i = 0; i < f.re.pixels.size(); ++i) {
        const auto at = [i](const Field& field) {
            return Complex(static_cast<double>(field.re.pixels[i]), static_cast<double>(field.im.pixels[i]));
        };
        worst = std::max(worst, std::abs(a * at(f) + b * at(g) - at(h)));
    }
    return worst;
}

TEST(FarFieldProperties, MasksAddUp) {
    const std::vector<NamedMask> shapes = four_shapes(64);
    const FrequencyGrid grid = centred_grid(60, 50, 1.0 / 64);
    for (const Strategy& s : strategies) {
        const Image<float>&one = shapes[2].mask, &two = shapes[3].mask;
        Image<float> sum(64, 64);
        for (std::size_t i = 0; i < sum.pixels.size(); ++i)
            sum.pixels[i] = 0.25f * one.pixels[i] + 0.5f * two.pixels[i];
        const double area = open_area(one.view()) + open_area(two.view());
        EXPECT_LT(off(0.25, field_of(s, one, grid), 0.5, field_of(s, two, grid), field_of(s, sum, grid)),
                  1e-6 * area)
            << s.name;
    }
}

TEST(FarFieldProperties, MaskAndComplementGiveTheFrame) {
    const FrequencyGrid grid = centred_grid(64, 64, 1.0 / 64);
    for (const Strategy& s : strategies) {
        for (const NamedMask& m : four_shapes(64)) {
            Image<float> complement = m.mask;
            for (float& texel : complement.pixels)
                texel = 1.0f - texel;
            const Field frame = field_of(s, Image<float>(64, 64, 1.0f), grid);
            EXPECT_LT(off(1, field_of(s, m.mask, grid), 1, field_of(s, complement, grid), frame), 1e-6 * 4096)
                << s.name << ", " << m.name;
            // Away from the frame's own axes, mask and complement show the same power.
            const Field one = field_of(s, m.mask, grid), other = field_of(s, complement, grid);
            for (int y = 1; y < 32; ++y) {
                for (int x = 1; x < 32; ++x)
                    ASSERT_NEAR(one.re(x, y), -other.re(x, y), 0.01);
            }
        }
    }
}

TEST(FarFieldProperties, PowerIsThatOfTheAmplitudesAndRowsKeepTheirStride) {
    const Image<float> mask = four_shapes(64)[3].mask;
    const FrequencyGrid grid = half_grid(63, 50, 1.0 / 64);
    const int stride = grid.width + 5;
    for (const Strategy& s : strategies) {
        Image<float> re(stride, grid.height, 7), im(stride, grid.height, 7), power(stride, grid.height, 7),
            alone(stride, grid.height, 7);
        s.run(mask.view(), grid, {re.pixels.data(), im.pixels.data(), power.pixels.data(), stride}, Exec{});
        s.run(mask.view(), grid, {nullptr, nullptr, alone.pixels.data(), stride}, Exec{});
        EXPECT_EQ(power, alone) << s.name;
        for (int y = 0; y < grid.height; ++y) {
            for (int x = 0; x < stride; ++x) {
                const bool inside = x < grid.width;
                const float expected = re(x, y) * re(x, y) + im(x, y) * im(x, y);
                ASSERT_EQ(power(x, y), inside ? expected : 7.0f) << s.name << " " << x << ", " << y;
            }
        }
    }
}

/// 10 log10 of 1 over the mean squared error of log10(power share + 1e-10) / 10, which spans 0 to 1.
double log_power_psnr(const Field& field, ImageView<const float> mask, const FrequencyGrid& grid,
                      int samples) {
    std::vector<double> u, v;
    std::vector<int> columns, rows;
    for (int i = 0; i < samples; ++i) {
        columns.push_back(static_cast<int>(static_cast<std::int64_t>(i) * grid.width / samples));
        rows.push_back(static_cast<int>(static_cast<std::int64_t>(i) * grid.height / samples));
        u.push_back(grid.first_u + columns.back() * grid.step_u);
        v.push_back(grid.first_v + rows.back() * grid.step_v);
    }
    const std::vector<Complex> truth = far_field_at(mask, u, v);
    const double area = open_area(mask);
    const auto level = [&](Complex f) { return std::log10(std::norm(f / area) + 1e-10) / 10; };
    double sum = 0;
    for (std::size_t j = 0; j < rows.size(); ++j) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const Complex ours(static_cast<double>(field.re(columns[i], rows[j])),
                               static_cast<double>(field.im(columns[i], rows[j])));
            const double d = level(ours) - level(truth[j * u.size() + i]);
            sum += d * d;
        }
    }
    return -10 * std::log10(sum / static_cast<double>(truth.size()));
}

TEST(FarFieldProperties, ExactAtRealSizes) {
    for (const int size : {512, 1024}) {
        const FrequencyGrid grid = half_grid(size, size, 2.0 / size);
        for (const NamedMask& m : four_shapes(size / 2)) {
            for (const Strategy& s : strategies) {
                // Products over every quad take their time: they are tried at the smaller size.
                if (!s.fast ||
                    (size > 512 && std::strcmp(s.name, "edges") != 0 && std::strcmp(s.name, "levels") != 0))
                    continue;
                const Field field = field_of(s, m.mask, grid);
                EXPECT_LT(worst_error(field, m.mask.view(), grid, open_area(m.mask.view()), 40), 1e-6)
                    << s.name << ", " << m.name << " " << size;
                EXPECT_GT(log_power_psnr(field, m.mask.view(), grid, 40), 125)
                    << s.name << ", " << m.name << " " << size;
            }
        }
    }
}

TEST(FarFieldProperties, WindowsMagnifiedAThousandTimes) {
    const Image<float> mask = four_shapes(512)[2].mask;
    for (const double centre : {0.0, 0.013, 0.31, 7.7}) {
        const FrequencyGrid grid = centred_grid(64, 48, 1.0 / 512 / 1000, centre, -0.4 * centre);
        for (const Strategy& s : strategies) {
            if (!s.fast || std::strcmp(s.name, "levels") == 0) continue;
            const Field field = field_of(s, mask, grid);
            EXPECT_LT(worst_error(field, mask.view(), grid, open_area(mask.view()), 12), 1e-6)
                << s.name << " " << centre;
        }
    }
}

/// Segmented mirrors, spiders, thin gaps: what telescopes look through.
TEST(FarFieldProperties, RealPupils) {
    const std::filesystem::path folder = shared_folder("data/apertures");
    SKIP_WITHOUT(folder);
    for (const char* name : {"jwst", "keck", "vlt_ut1", "gmt"}) {
        std::ifstream file(folder / (std::string(name) + "_1024.png"), std::ios::binary);
        ASSERT_TRUE(file) << name;
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const Image<Rgba8> picture = decode_png(bytes, name);
        Image<float> mask(picture.width, picture.height);
        for (std::size_t i = 0; i < mask.pixels.size(); ++i)
            mask.pixels[i] = static_cast<float>(picture.pixels[i].r) / 255.0f;
        const double area = open_area(mask.view());
        ASSERT_GT(area, 1000) << name;
        for (const FrequencyGrid& grid :
             {half_grid(512, 512, 1.0 / 1024), centred_grid(96, 96, 0.3 / 1024, 0.01, 0.02)}) {
            Field field = field_for(grid);
            far_field_edges(mask.view(), grid, 0, target_of(field), Exec{}, nullptr);
            EXPECT_LT(worst_error(field, mask.view(), grid, area, 24), 1e-6) << name;
        }
    }
}

}  // namespace
}  // namespace obscura
