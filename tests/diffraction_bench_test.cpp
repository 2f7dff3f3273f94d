// The diffraction bench: its truths against definitions, its peers against its truths, what a quick run finds
// and writes. Never times.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "bench/diffraction_bench.h"
#include "bench/diffraction_cases.h"
#include "bench/diffraction_report.h"
#include "bench/diffraction_truth.h"
#include "bench/gnuplot.h"
#include "bench/interleave.h"
#include "bench/method_timing.h"
#include "bench/peer_pixels.h"
#include "core/error.h"
#include "temporary_folder.h"
#ifdef OBSCURA_HAS_FFTW
#include "bench/diffraction_peers.h"
#endif

namespace obscura {
namespace {

using Complex = std::complex<double>;

Image<float> random_mask(int width, int height) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0, 1);
    Image<float> mask(width, height);
    for (float& texel : mask.pixels)
        texel = uniform(random);
    return mask;
}

BenchOptions quick_options(const std::string& aperture) {
    BenchOptions options;
    options.quick = true;
    options.scene = aperture;
    return options;
}

DiffractionBenchPlan quick_plan() {
    return diffraction_bench_plan(true, 1);
}

TEST(DiffractionTruth, OfOneTexelIsItsSinc) {
    Image<float> mask(3, 1);
    mask(2, 0) = 0.5f;  // centre at x = 1, y = 0
    const FrequencyGrid grid = centred_grid(9, 9, 0.37);
    const TrueField truth = true_far_field(mask.view(), grid, 9, 9, Exec{});
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 9; ++x) {
            const double u = (x - 4) * 0.37, v = (y - 4) * 0.37;
            const auto sinc = [](double f) { return f == 0 ? 1.0 : std::sin(M_PI * f) / (M_PI * f); };
            const Complex expected = 0.5 * sinc(u) * sinc(v) * std::polar(1.0, -2 * M_PI * u);
            EXPECT_LT(std::abs(truth.values[static_cast<std::size_t>(9 * y + x)] - expected), 1e-12);
        }
    }
    EXPECT_DOUBLE_EQ(truth.unit, 0.5);
}

/// 1 / (i lambda z) times the integral of the chirp over one texel, by the midpoint rule; all lengths in
/// texels, 1 / (lambda z) = 2 turns.
Complex chirp_integral(double x, double y, double turns) {
    constexpr int steps = 4000;
    const auto axis = [&](double at) {
        Complex sum;
        for (int i = 0; i < steps; ++i) {
            const double d = (i + 0.5) / steps - 0.5 - at;
            sum += std::polar(1.0 / steps, 2 * M_PI * turns * d * d);
        }
        return sum;
    };
    return 2 * turns / Complex(0, 1) * axis(x) * axis(y);
}

TEST(DiffractionTruth, OfOneTexelIsTheIntegralOfItsChirp) {
    const Image<float> mask(1, 1, 1.0f);
    const double turns = 0.3;
    const TrueField truth = true_near_field(mask.view(), centred_plane(5, 5), turns, 5, Exec{});
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 5; ++x) {
            const Complex expected = chirp_integral(x - 2, y - 2, turns);
            EXPECT_LT(std::abs(truth.values[static_cast<std::size_t>(5 * y + x)] - expected), 1e-6);
        }
    }
}

TEST(DiffractionTruth, SampledAxesStandForTheWhole) {
    const SampledAxis whole = sampled_axis(100, 50, 100);
    EXPECT_EQ(whole.size(), 100u);
    const SampledAxis some = sampled_axis(4096, 2048, 128);
    EXPECT_LT(some.size(), 160u);
    double sum = 0;
    for (const double weight : some.weights)
        sum += weight;
    EXPECT_NEAR(sum, 4096, 4096 * 0.02);
    EXPECT_TRUE(std::count(some.indices.begin(), some.indices.end(), 2048));
    std::set<int> residues;
    for (const int i : some.indices)
        residues.insert(i % 16);
    EXPECT_EQ(residues.size(), 16u);
}

TEST(DiffractionTruth, ErrorsAreWhatTheyAreCalled) {
    TrueField truth;
    truth.columns = sampled_axis(2, 0, 2);
    truth.rows = sampled_axis(1, 0, 1);
    truth.values = {Complex(4, 0), Complex(0, 2e-6)};
    truth.unit = 4;
    Field field{Image<float>(2, 1), Image<float>(2, 1)};
    field.re(0, 0) = 4.0f;
    field.re(1, 0) = 1e-6f;  // both below the floor of the logarithm: 1e-5 of the unit
    EXPECT_NEAR(error_of(field, truth).amplitude, std::hypot(1e-6, 2e-6) / 4, 1e-13);
    EXPECT_TRUE(std::isinf(error_of(field, truth).log_psnr_db));
    Image<float> power(2, 1);
    power(0, 0) = 1600.0f;  // ten times the magnitude: two decades on one of two pixels
    EXPECT_NEAR(error_of(power, truth).amplitude, 9, 1e-6);
    EXPECT_NEAR(error_of(power, truth).log_psnr_db, 20 * std::log10(10 / std::sqrt(2.0)), 1e-6);
    power(1, 0) = NAN;
    EXPECT_TRUE(std::isinf(error_of(power, truth).amplitude));
}

TEST(PeerPixels, AreTheSameOnEveryMachine) {
    constexpr int count = 61;
    const Image<float> z = random_mask(2 * count, 1), w = random_mask(2 * count + 1, 1),
                       u = random_mask(count, 1);
    std::vector<float> power(count), out(count), product, re(count), im(count);
    for (const Isa isa : supported_isas()) {
        product = z.pixels;
        OBSCURA_DISPATCH(isa, multiply_row, product.data(), w.pixels.data(), 0.5f, -0.7f, count);
        OBSCURA_DISPATCH(isa, split_row, product.data(), count, re.data(), im.data());
        OBSCURA_DISPATCH(isa, power_of, z.pixels.data(), count, power.data());
        OBSCURA_DISPATCH(isa, scale_row, power.data(), u.pixels.data(), 0.3f, count, out.data());
        for (std::size_t i = 0; i < count; ++i) {
            const std::complex<float> a(z.pixels[2 * i], z.pixels[2 * i + 1]);
            const std::complex<float> b(w.pixels[2 * i], w.pixels[2 * i + 1]);
            const std::complex<float> expected = a * b * std::complex<float>(0.5f, -0.7f);
            EXPECT_NEAR(re[i], expected.real(), 1e-6f) << isa_name(isa);
            EXPECT_NEAR(im[i], expected.imag(), 1e-6f) << isa_name(isa);
            EXPECT_EQ(power[i], a.real() * a.real() + a.imag() * a.imag()) << isa_name(isa);
            EXPECT_EQ(out[i], power[i] * u.pixels[i] * 0.3f) << isa_name(isa);
        }
        OBSCURA_DISPATCH(isa, scale_reversed, power.data() + count - 1, u.pixels.data(), 0.3f, count,
                         out.data());
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_EQ(out[i], power[count - 1 - i] * u.pixels[i] * 0.3f) << isa_name(isa);
    }
}

#ifdef OBSCURA_HAS_FFTW

TEST(DiffractionPeers, ImagePeerIsTheDiscreteTransformOfItsSamples) {
    constexpr int size = 16;
    const Image<float> image = random_mask(size, size);
    for (const int threads : {1, 2}) {
        ImagePeer peer(size, threads);
        peer.load(image.view());
        Image<float> power(size / 2 + 1, size);
        peer.run(power.pixels.data());
        for (int row = 0; row < size; ++row) {
            for (int k = 0; k <= size / 2; ++k) {
                Complex sum;
                for (int y = 0; y < size; ++y) {
                    for (int x = 0; x < size; ++x)
                        sum += static_cast<double>(image(x, y)) *
                               std::polar(1.0, -2 * M_PI * (k * x + (row - size / 2) * y) / size);
                }
                EXPECT_NEAR(static_cast<double>(power(k, row)), std::norm(sum), 1e-5 * std::norm(sum) + 1e-4);
            }
        }
    }
}

TEST(DiffractionPeers, TexelPeerIsOurFunctionOnHalfPlanesAndWindows) {
    const Image<float> mask = random_mask(32, 32);
    for (const int period : {32, 128}) {
        for (const FrequencyGrid& grid :
             {half_grid(64, 64, 1.0 / period), centred_grid(40, 24, 1.0 / period, 0.125, -0.0625),
              centred_grid(300, 30, 1.0 / period)}) {
            TexelPeer peer(period, grid, 1);
            peer.load(mask.view());
            Image<float> power(grid.width, grid.height);
            peer.run(power.pixels.data());
            const TrueField truth = true_far_field(mask.view(), grid, 512, 512, Exec{});
            EXPECT_LT(error_of(power, truth).amplitude, 3e-7) << period << ' ' << grid.width;
        }
    }
}

TEST(DiffractionPeers, FresnelPeerNeedsTheIntegratedChirp) {
    constexpr int size = 64;
    const Image<float> mask = random_mask(size, size);
    const double turns = 50.0 / (2 * 32 * 32);  // Fresnel number 50
    const TrueField truth = true_near_field(mask.view(), centred_plane(size, size), turns, size, Exec{});
    FresnelPeer peer(size, 2, 1);
    peer.load(mask.view());
    const auto error_with = [&](ChirpKernel kernel) {
        Field field{Image<float>(size, size), Image<float>(size, size)};
        peer.set_kernel(turns, kernel);
        peer.run(field.re.pixels.data(), field.im.pixels.data());
        return error_of(field, truth).amplitude;
    };
    EXPECT_LT(error_with(ChirpKernel::integrated), 2e-6);
    EXPECT_GT(error_with(ChirpKernel::sampled), 1e-2);
}

#endif

TEST(Interleaving, TakesTurnsInBothOrders) {
    std::string calls;
    const std::vector<TimedJob> jobs = {{"a", [&] { calls += 'a'; }}, {"b", [&] { calls += 'b'; }}};
    TimingPlan plan;
    plan.rounds = 3;
    plan.turn_ms = 0;  // every job is a long one
    const std::vector<Timing> timings = time_interleaved(jobs, plan);
    EXPECT_EQ(calls,
              "ab"
              "ab"
              "ba"
              "ab");
    ASSERT_EQ(timings.size(), 2u);
    EXPECT_EQ(timings[0].calls, 3);
    plan.budget_ms = 0;  // one turn each
    calls.clear();
    EXPECT_EQ(time_interleaved(jobs, plan)[1].calls, 1);
    EXPECT_EQ(calls,
              "ab"
              "ab");
}

/// What every measured part promises.
void check_rows(const std::vector<DiffractionRow>& rows, double most_error) {
    for (const DiffractionRow& row : rows) {
        const std::string where = row.part + " " + row.aperture + " " + row.method;
        if (!row.problem.empty()) {
            EXPECT_EQ(row.time.calls, 0) << where;
            continue;
        }
        EXPECT_GT(row.time.calls, 0) << where;
        EXPECT_GE(row.time.median_ms, row.time.least_ms) << where;
        EXPECT_GE(row.error, 0) << where;
        if (row.same_function) {
            EXPECT_LE(row.error, most_error) << where;
        }
        EXPECT_EQ(row.method == automatic_name, !row.note.empty()) << where;
    }
}

std::set<std::string> methods_of(const std::vector<DiffractionRow>& rows, int threads) {
    std::set<std::string> methods;
    for (const DiffractionRow& row : rows) {
        if (row.threads == threads && row.problem.empty()) methods.insert(row.method);
    }
    return methods;
}

TEST(DiffractionBench, EveryStrategyOfTheFarFieldAgreesWithTheTruth) {
    const std::vector<DiffractionRow> rows = measure_far(quick_plan(), quick_options("heptagon"));
    check_rows(rows, 1e-6);
    for (const int threads : {1, 2}) {
        const std::set<std::string> methods = methods_of(rows, threads);
        for (const char* method :
             {"direct", "shift", "gemm", "edges", "levels", "runs", "raster_fft", "polygon", "automatic"})
            EXPECT_TRUE(methods.count(method)) << method;
    }
    DiffractionResults results;
    results.rows = rows;
    EXPECT_NE(goals_markdown(results).find("amplitude error, share of F(0, 0) | <= 1e-06"),
              std::string::npos);
}

TEST(DiffractionBench, EveryStrategyOfWindowsAgreesWithTheTruth) {
    const std::vector<DiffractionRow> rows = measure_windows(quick_plan(), quick_options("whirl"));
    check_rows(rows, 1e-6);
    EXPECT_TRUE(methods_of(rows, 1).count("runs"));
    EXPECT_TRUE(methods_of(rows, 2).count("edges"));
}

TEST(DiffractionBench, EveryStrategyOfTheNearFieldAgreesWithTheTruth) {
    DiffractionBenchPlan plan = quick_plan();
    plan.near_sizes = plan.padded_sizes;
    BenchOptions options = quick_options("whirl");
    options.threads = {1};
    const std::vector<DiffractionRow> rows = measure_near(plan, options);
    check_rows(rows, 2e-6);
    for (const char* method : {"direct", "two_pass", "edges", "hybrid", "fft", "automatic"})
        EXPECT_TRUE(methods_of(rows, 1).count(method)) << method;
    for (const ControlRow& row : measure_controls(plan, quick_options("heptagon"))) {
        EXPECT_LE(row.our_error, 2e-6) << row.fresnel_number;
#ifdef OBSCURA_HAS_FFTW
        EXPECT_LE(row.integrated_error, 2e-6) << row.fresnel_number;
        EXPECT_GT(row.sampled_error, 100 * row.our_error) << row.fresnel_number;
#endif
    }
}

TEST(DiffractionBench, MethodsThatWouldTakeTooLongAreLeftOut) {
    DiffractionBenchPlan plan = quick_plan();
    plan.longest_ms = 1e-9;
    BenchOptions options = quick_options("box");
    options.threads = {1};
    for (const DiffractionRow& row : measure_far(plan, options)) {
        const bool measured = row.peer || (row.size == 64 && row.method != "polygon" && row.one_call);
        if (measured) {
            EXPECT_EQ(row.problem, "") << row.method << ' ' << row.size;
        }
        if (!row.peer && row.size == 128) {
            EXPECT_EQ(row.problem.rfind("left out", 0), 0u) << row.method << ": " << row.problem;
        }
    }
}

TEST(DiffractionBench, CountsWorkAsTheThesisDoes) {
    DiffractionBenchPlan plan = quick_plan();
    plan.sizes = {256, 512};
    const std::vector<QuadRow> quads = measure_quads(plan, quick_options("heptagon"));
    ASSERT_EQ(quads.size(), 2u);
    EXPECT_EQ(quads[1].aggressive, quads[0].finest);
    for (const auto& [row, printed] : {std::pair(quads[0], 176), std::pair(quads[1], 389)}) {
        EXPECT_GT(static_cast<double>(row.finest), 0.8 * printed);
        EXPECT_LT(static_cast<double>(row.finest), 1.25 * printed);
    }
    plan.sizes = {512};
    const std::vector<CullRow> culling = measure_culling(plan);
    ASSERT_EQ(culling.size(), 1u);
    EXPECT_GT(culling[0].active, 0);
    EXPECT_LT(culling[0].active, 1);
}

TEST(DiffractionBench, CoarserMasksGiveWorsePictures) {
    const std::vector<QualityRow> rows = measure_quality(quick_plan(), quick_options("heptagon"));
    ASSERT_EQ(rows.size(), 4u);
    for (const QualityRow& row : rows) {
        EXPECT_GT(row.ssim, 0.5) << row.field << row.level;
        EXPECT_LT(row.ssim, 1) << row.field << row.level;
        for (const QualityRow& other : rows) {
            if (row.field == other.field && row.level == "finest" && other.level == "aggressive") {
                EXPECT_GT(row.psnr_db, other.psnr_db) << row.field;
            }
        }
    }
}

TEST(DiffractionCases, TelescopesComeFromTheirMasks) {
    const std::filesystem::path data = OBSCURA_SOURCE_DIR "/../shared/data";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared data beside the repository";
    EXPECT_EQ(aperture_names(data).size(), 6u);
    EXPECT_EQ(aperture_names({}).size(), 4u);
    const auto small = diffraction_case("jwst", 256, data), large = diffraction_case("jwst", 2048, data);
    ASSERT_TRUE(small && large);
    EXPECT_EQ(small->mask.mask.width, 128);
    EXPECT_EQ(large->mask.mask.width, 1024);
    EXPECT_NEAR(open_area(small->mask.mask.view()) * 64, open_area(large->mask.mask.view()),
                0.05 * open_area(large->mask.mask.view()));
    EXPECT_FALSE(diffraction_case("jwst", 4096, data));
    EXPECT_FALSE(diffraction_case("jwst", 256, {}));
}

DiffractionRow timed_row(const char* method, double ms, bool one_call, bool peer) {
    DiffractionRow row;
    row.part = far_part;
    row.aperture = "box";
    row.convex = true;
    row.size = 1024;
    row.method = method;
    row.peer = peer;
    row.one_call = one_call;
    row.time = {ms, ms, 1};
    return row;
}

TEST(DiffractionReport, JudgesTheWorstCase) {
    DiffractionResults results;
    results.rows = {timed_row(fftw_image_name, 9, false, true), timed_row(fftw_mask_name, 2, false, true),
                    timed_row(automatic_name, 2, false, false), timed_row(automatic_name, 3, true, false),
                    timed_row("edges", 2, true, false)};
    const std::string goals = goals_markdown(results);
    EXPECT_NE(goals.find("FFTW of the image | >= 4 | 4.50 | box 1024 | met"), std::string::npos) << goals;
    EXPECT_NE(goals.find("FFTW of the mask | >= 1.5 | 1.00 | box 1024 | **not met**"), std::string::npos);
    EXPECT_NE(goals.find("time over the best strategy's | <= 1.2 | 1.50 | box 1024 | **not met**"),
              std::string::npos);
    EXPECT_EQ(goals.find("whirl"), std::string::npos);
    const std::string csv = diffraction_csv(results.rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
}

TEST(DiffractionReport, IsWritten) {
    TemporaryFolder folder;
    BenchOptions options = quick_options("circle");
    options.threads = {1};
    options.out = folder.path / "results";
    EXPECT_EQ(bench_diffraction(options), 0);
    std::ifstream file(options.out / "diffraction.md");
    std::stringstream text;
    text << file.rdbuf();
    for (const char* heading : {"## Goals", "## Far field", "## Windows", "## Near field", "(Table 3.1)",
                                "(Table 3.2)", "(Table 3.3)", "Figures 3.8"}) {
        EXPECT_NE(text.str().find(heading), std::string::npos) << heading;
    }
    EXPECT_TRUE(std::filesystem::exists(options.out / "diffraction.csv"));
    if (!has_gnuplot()) return;
    for (const char* chart : {"time", "error", "window", "near"})
        EXPECT_TRUE(std::filesystem::exists(options.out / (std::string("diffraction_") + chart + ".svg")))
            << chart;
    options.scene = "pentagon";
    EXPECT_THROW(bench_diffraction(options), UsageError);
}

}  // namespace
}  // namespace obscura
