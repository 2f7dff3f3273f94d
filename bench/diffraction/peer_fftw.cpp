#include "bench/diffraction/peer_fftw.h"

#include <fftw3.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"

namespace obscura {
namespace {

struct Release {
    void operator()(float* memory) const { fftwf_free(memory); }
};
using Floats = std::unique_ptr<float, Release>;

Floats floats(std::size_t count) {
    Floats memory(fftwf_alloc_real(count));
    if (!memory) throw LimitError("not enough memory for FFTW's arrays");
    return memory;
}

fftwf_complex* complex_of(const Floats& memory) {
    return reinterpret_cast<fftwf_complex*>(memory.get());
}

/// Of one plan; then the best so far is taken.
constexpr double longest_planning_s = 10;

/// FFTW's parallel loops, as items of ours.
void run_jobs(void* (*work)(char*), char* jobs, std::size_t bytes, int count, void*) {
    parallel_for(static_cast<std::size_t>(count), Exec{best_isa(), count},
                 [&](std::size_t i) { work(jobs + i * bytes); });
}

void plan_for(int threads) {
    static const bool ready = [] {
        const bool started = fftwf_init_threads() != 0;
        fftwf_threads_set_callback(run_jobs, nullptr);
        fftwf_set_timelimit(longest_planning_s);
        return started;
    }();
    CHECK(ready);
    fftwf_plan_with_nthreads(threads);
}

std::size_t squared(int size) {
    return static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
}

}  // namespace

std::string fftw_version() {
    return fftwf_version;
}

struct FftwReal::Plan {
    int size = 0;
    Floats samples, spectrum;
    fftwf_plan plan = nullptr;
};

FftwReal::FftwReal(int size, int threads) : plan_(std::make_unique<Plan>()) {
    plan_->size = size;
    plan_->samples = floats(squared(size));
    plan_->spectrum = floats(2 * static_cast<std::size_t>(size) * (static_cast<std::size_t>(size) / 2 + 1));
    plan_for(threads);
    plan_->plan = fftwf_plan_dft_r2c_2d(size, size, plan_->samples.get(), complex_of(plan_->spectrum),
                                        FFTW_MEASURE | FFTW_PRESERVE_INPUT);
    CHECK(plan_->plan != nullptr);
    std::fill_n(plan_->samples.get(), squared(size), 0.0f);  // planning wrote there
}

FftwReal::~FftwReal() {
    fftwf_destroy_plan(plan_->plan);
}

int FftwReal::size() const {
    return plan_->size;
}
float* FftwReal::samples() {
    return plan_->samples.get();
}
const float* FftwReal::spectrum() const {
    return plan_->spectrum.get();
}
void FftwReal::run() {
    fftwf_execute(plan_->plan);
}

struct FftwComplex::Plan {
    int size = 0;
    Floats samples, spectrum;
    fftwf_plan forward = nullptr, backward = nullptr;
};

FftwComplex::FftwComplex(int size, int threads) : plan_(std::make_unique<Plan>()) {
    plan_->size = size;
    plan_->samples = floats(2 * squared(size));
    plan_->spectrum = floats(2 * squared(size));
    plan_for(threads);
    fftwf_complex *from = complex_of(plan_->samples), *to = complex_of(plan_->spectrum);
    plan_->forward =
        fftwf_plan_dft_2d(size, size, from, to, FFTW_FORWARD, FFTW_MEASURE | FFTW_PRESERVE_INPUT);
    plan_->backward = fftwf_plan_dft_2d(size, size, to, to, FFTW_BACKWARD, FFTW_MEASURE);
    CHECK(plan_->forward != nullptr && plan_->backward != nullptr);
    std::fill_n(plan_->samples.get(), 2 * squared(size), 0.0f);
}

FftwComplex::~FftwComplex() {
    fftwf_destroy_plan(plan_->forward);
    fftwf_destroy_plan(plan_->backward);
}

int FftwComplex::size() const {
    return plan_->size;
}
float* FftwComplex::samples() {
    return plan_->samples.get();
}
float* FftwComplex::spectrum() {
    return plan_->spectrum.get();
}
void FftwComplex::forward() {
    fftwf_execute(plan_->forward);
}
void FftwComplex::backward() {
    fftwf_execute(plan_->backward);
}

}  // namespace obscura
