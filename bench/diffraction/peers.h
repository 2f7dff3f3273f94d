#pragma once
// What FFTW is asked to do beside our far and near fields. Masks are loaded, and kernels transformed, before
// the clock starts. Only in builds that found FFTW (OBSCURA_HAS_FFTW).

#include <complex>
#include <vector>

#include "bench/diffraction/peer_fftw.h"
#include "core/image.h"
#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field/field.h"

namespace obscura {

/// F1: power of the size x size image's transform, the image's samples taken as points, in the rows and
/// columns of half_grid(size, size, 1 / size). What the thesis compares with; another function than ours.
class ImagePeer {
  public:
    ImagePeer(int size, int threads) : fft_(size, threads), exec_{best_isa(), threads} {}
    void load(ImageView<const float> image);
    void run(float* power);

  private:
    FftwReal fft_;
    Exec exec_;
};

/// F2: power of a mask over a grid of frequencies that are whole multiples of 1 / period, by one FFT of
/// period x period samples, whose spectrum is tiled over the grid and multiplied by the transform of a texel:
/// exactly our function. A period larger than the mask pads it with zeros.
class TexelPeer {
  public:
    TexelPeer(int period, const FrequencyGrid& grid, int threads);
    void load(ImageView<const float> mask);
    void run(float* power);

  private:
    /// Columns of the grid that lie side by side in the half of the spectrum that FFTW computes, or in its
    /// mirror image.
    struct Segment {
        int column = 0, count = 0, from = 0;
        bool mirrored = false;
    };
    void power_row(int row, std::vector<float>& power) const;
    void place_row(const std::vector<float>& own, const std::vector<float>& opposite, int row,
                   float* out) const;

    FftwReal fft_;
    FrequencyGrid grid_;
    Exec exec_;
    std::vector<Segment> segments_;
    std::vector<int> spectrum_row_;          ///< of each row of the grid
    std::vector<std::vector<int>> rows_of_;  ///< rows of the grid that show a row of the spectrum
    std::vector<float> u_texel_, v_texel_;   ///< sinc^2
    int least_ = 0, end_ = 0;                ///< columns of the spectrum that the grid needs
};

/// Which samples stand for the chirp of Fresnel's integral.
enum class ChirpKernel {
    integrated,  ///< over each texel: exact
    sampled,     ///< at its middle
};

/// Linear convolution of a size x size mask with the chirp, by FFTs of (padding size)^2: U at the middles of
/// its texels. `turns` is pitch^2 / (2 lambda z).
class FresnelPeer {
  public:
    FresnelPeer(int size, int padding, int threads);
    void set_kernel(double turns, ChirpKernel kernel);
    void load(ImageView<const float> mask);
    /// re, im: size x size.
    void run(float* re, float* im);

  private:
    int size_ = 0;
    FftwComplex fft_;
    Exec exec_;
    std::vector<float> kernel_;  ///< spectrum of one axis; two axes multiply
};

}  // namespace obscura
