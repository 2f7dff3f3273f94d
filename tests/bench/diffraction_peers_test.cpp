// The truths of the diffraction bench against definitions, and its peers against the truths.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <set>

#include "bench/diffraction/peer_pixels.h"
#include "bench/diffraction/truth.h"
#ifdef OBSCURA_HAS_FFTW
#include "bench/diffraction/peers.h"
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

}  // namespace
}  // namespace obscura
