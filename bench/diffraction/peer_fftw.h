#pragma once
// FFTW in single precision: the peer of the diffraction bench. Plans are measured (FFTW_MEASURE), which takes
// seconds for large sizes, ten at most; on several threads its loops run on the pool of core/parallel.h.
// Only in builds that found FFTW (OBSCURA_HAS_FFTW).

#include <cstddef>
#include <memory>
#include <string>

namespace obscura {

/// Name, version and how FFTW was built.
std::string fftw_version();

/// size x size real samples to size x (size / 2 + 1) complex numbers, real and imaginary parts by turns.
class FftwReal {
  public:
    FftwReal(int size, int threads);
    ~FftwReal();
    FftwReal(const FftwReal&) = delete;
    FftwReal& operator=(const FftwReal&) = delete;

    int size() const;
    float* samples();  ///< zero at first; run() leaves them as they are
    void run();
    const float* spectrum() const;

  private:
    struct Plan;
    std::unique_ptr<Plan> plan_;
};

/// size x size complex samples to their spectrum, and the spectrum back over itself (not divided by size^2).
class FftwComplex {
  public:
    FftwComplex(int size, int threads);
    ~FftwComplex();
    FftwComplex(const FftwComplex&) = delete;
    FftwComplex& operator=(const FftwComplex&) = delete;

    int size() const;
    float* samples();  ///< zero at first; nothing below changes them
    void forward();    ///< samples to spectrum
    float* spectrum();
    void backward();  ///< spectrum to its inverse transform, in its place

  private:
    struct Plan;
    std::unique_ptr<Plan> plan_;
};

}  // namespace obscura
