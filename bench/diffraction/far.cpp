// The far field over the half plane: every strategy beside FFTW of the image and of the mask.

#include <fmt/format.h>

#include "bench/diffraction/far_field_jobs.h"
#include "bench/harness/run_times.h"
#ifdef OBSCURA_HAS_FFTW
#include "bench/diffraction/peers.h"
#endif

namespace obscura {
namespace {

constexpr FarFieldMethod strategies[] = {
    FarFieldMethod::direct,  FarFieldMethod::shift,      FarFieldMethod::gemm,
    FarFieldMethod::edges,   FarFieldMethod::levels,     FarFieldMethod::runs,
    FarFieldMethod::polygon, FarFieldMethod::raster_fft, FarFieldMethod::automatic,
};

FrequencyGrid half_plane_of(int size) {
    return half_grid(size, size, 2.0 / size);
}

#ifdef OBSCURA_HAS_FFTW

/// FFTW's plans of one size and number of threads.
struct FarPeers {
    std::unique_ptr<ImagePeer> image;
    std::unique_ptr<TexelPeer> mask;
    double image_ms = 0, mask_ms = 0;

    FarPeers(int size, int threads) {
        image_ms = milliseconds_of([&] { image = std::make_unique<ImagePeer>(size, threads); });
        mask_ms = milliseconds_of(
            [&] { mask = std::make_unique<TexelPeer>(size / 2, half_plane_of(size), threads); });
    }

    void add_jobs(FarRun& run, std::vector<MethodJob>& jobs) {
        image->load(run.shape.image.mask.view());
        mask->load(run.shape.mask.mask.view());
        DiffractionRow row = far_row(run, fftw_image_name);
        row.prepare_ms = image_ms;
        row.same_function = false;
        const float half_as_wide = 1.0f / 16;  // the image's texels
        jobs.push_back(peer_job(
            run, row, [this](float* power) { image->run(power); }, half_as_wide));
        row = far_row(run, fftw_mask_name);
        row.prepare_ms = mask_ms;
        jobs.push_back(peer_job(
            run, row, [this](float* power) { mask->run(power); }, 1));
    }
};

#else

struct FarPeers {
    FarPeers(int, int) {}
    void add_jobs(FarRun& run, std::vector<MethodJob>& jobs) {
        for (const char* name : {fftw_image_name, fftw_mask_name})
            jobs.push_back(absent_peer(run, name));
    }
};

#endif

void add_our_jobs(FarRun& run, double longest_ms, std::vector<MethodJob>& jobs) {
    for (const FarFieldMethod method : strategies)
        jobs.push_back(one_call(run, method, longest_ms));
    const ImageView<const float> mask = run.shape.mask.mask.view();
    const auto natural = natural_grid(mask.width, mask.height, run.grid);
    CHECK(natural.has_value());
    std::shared_ptr<NaturalTransform> tables;
    const double prepare_ms = milliseconds_of([&] {
        tables = std::make_shared<NaturalTransform>(natural_transform(mask.width, mask.height, *natural));
    });
    for (const auto method : {FarFieldMethod::runs, FarFieldMethod::raster_fft, FarFieldMethod::automatic})
        jobs.push_back(kept_tables(run, tables, prepare_ms, method));
}

}  // namespace

std::vector<DiffractionRow> measure_far(const DiffractionBenchPlan& plan, const BenchOptions& options) {
    std::vector<DiffractionRow> all;
    std::vector<MethodPast> past;
    for (const int size : plan.sizes) {
        std::vector<std::unique_ptr<FarPeers>> peers;
        for (const int threads : options.threads)
            peers.push_back(std::make_unique<FarPeers>(size, threads));
        for (const std::string& name : chosen_apertures(options)) {
            auto shape = diffraction_case(name, size, options.data);
            if (!shape) continue;
            FarRun run = far_run(far_part, std::move(*shape), half_plane_of(size),
                                 size <= plan.whole_size ? size : plan.most_samples);
            const auto jobs_of = [&](std::size_t t) {
                run.exec.threads = options.threads[t];
                std::vector<MethodJob> jobs;
                peers[t]->add_jobs(run, jobs);
                add_our_jobs(run, plan.longest_ms, jobs);
                return jobs;
            };
            for (DiffractionRow& row : time_methods(options.threads, jobs_of, plan, past))
                all.push_back(std::move(row));
            options.say(fmt::format("far field, {} {}: measured", name, size));
        }
    }
    return all;
}

}  // namespace obscura
