// Windows of frequencies four times as fine as the half plane's: there an FFT must pad the mask.

#include <fmt/format.h>

#include "bench/diffraction/far_field_jobs.h"
#ifdef OBSCURA_HAS_FFTW
#include "bench/diffraction/peers.h"
#include "bench/harness/run_times.h"
#endif

namespace obscura {
namespace {

constexpr int padding = 4;
constexpr FarFieldMethod strategies[] = {FarFieldMethod::gemm, FarFieldMethod::edges, FarFieldMethod::runs,
                                         FarFieldMethod::raster_fft, FarFieldMethod::automatic};

/// Off the centre, so that no method gains from the pattern's own symmetry; whole multiples of the step, so
/// that FFTW can serve it.
FrequencyGrid window_of(int mask_size, int pixels) {
    const double step = 1.0 / (padding * mask_size);
    return centred_grid(pixels, pixels, step, 0.125, -0.0625);
}

#ifdef OBSCURA_HAS_FFTW

struct WindowPeer {
    std::unique_ptr<TexelPeer> padded;
    double prepare_ms = 0;

    WindowPeer(int mask_size, const FrequencyGrid& grid, int threads) {
        prepare_ms = milliseconds_of(
            [&] { padded = std::make_unique<TexelPeer>(padding * mask_size, grid, threads); });
    }

    void add_job(FarRun& run, std::vector<MethodJob>& jobs) {
        padded->load(run.shape.mask.mask.view());
        DiffractionRow row = far_row(run, fftw_padded_name);
        row.prepare_ms = prepare_ms;
        jobs.push_back(peer_job(
            run, row, [this](float* power) { padded->run(power); }, 1));
    }
};

#else

struct WindowPeer {
    WindowPeer(int, const FrequencyGrid&, int) {}
    void add_job(FarRun& run, std::vector<MethodJob>& jobs) {
        jobs.push_back(absent_peer(run, fftw_padded_name));
    }
};

#endif

}  // namespace

std::vector<DiffractionRow> measure_windows(const DiffractionBenchPlan& plan, const BenchOptions& options) {
    std::vector<DiffractionRow> all;
    std::vector<MethodPast> past;
    for (const int size : plan.window_sizes) {
        const FrequencyGrid grid = window_of(size / 2, plan.window_px);
        std::vector<std::unique_ptr<WindowPeer>> peers;
        for (const int threads : options.threads)
            peers.push_back(std::make_unique<WindowPeer>(size / 2, grid, threads));
        for (const std::string& name : chosen_apertures(options)) {
            auto shape = diffraction_case(name, size, options.data);
            if (!shape) continue;
            FarRun run = far_run(window_part, std::move(*shape), grid,
                                 size <= plan.whole_size ? plan.window_px : plan.most_samples);
            const auto jobs_of = [&](std::size_t t) {
                run.exec.threads = options.threads[t];
                std::vector<MethodJob> jobs;
                peers[t]->add_job(run, jobs);
                for (const FarFieldMethod method : strategies)
                    jobs.push_back(one_call(run, method, plan.longest_ms));
                return jobs;
            };
            for (DiffractionRow& row : time_methods(options.threads, jobs_of, plan, past))
                all.push_back(std::move(row));
            options.say(fmt::format("window, {} {}: measured", name, size));
        }
    }
    return all;
}

}  // namespace obscura
