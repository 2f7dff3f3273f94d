// The far field over the half plane: every strategy beside FFTW of the image and of the mask.

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "bench/diffraction_bench.h"
#include "bench/diffraction_cases.h"
#include "bench/method_timing.h"
#include "optics/far_field_costs.h"
#include "optics/far_field_methods.h"
#include "optics/natural_transform.h"
#ifdef OBSCURA_HAS_FFTW
#include "bench/diffraction_peers.h"
#endif

namespace obscura {
namespace {

constexpr FarFieldMethod strategies[] = {
    FarFieldMethod::direct, FarFieldMethod::shift, FarFieldMethod::gemm,       FarFieldMethod::edges,
    FarFieldMethod::levels, FarFieldMethod::runs,  FarFieldMethod::raster_fft, FarFieldMethod::polygon,
};

/// One aperture at one size, and where every method writes.
struct FarRun {
    DiffractionCase shape;
    FrequencyGrid grid;
    TrueField truth;
    Exec exec;
    Image<float> power;
    Field field;
    bool compare = false;  ///< results do not depend on threads: compared once

    FieldTarget power_target() { return {nullptr, nullptr, power.pixels.data(), grid.width}; }
    FieldTarget field_target() {
        return {field.re.pixels.data(), field.im.pixels.data(), nullptr, grid.width};
    }
};

FrequencyGrid half_plane_of(int size) {
    return half_grid(size, size, 2.0 / size);
}

DiffractionRow far_row(const FarRun& run, const std::string& method) {
    DiffractionRow row;
    row.part = far_part;
    row.aperture = run.shape.aperture;
    row.convex = run.shape.convex;
    row.size = run.shape.size;
    row.method = method;
    row.threads = run.exec.threads;
    return row;
}

/// The method's own function of a mask whose size's tables are at hand.
void run_with_tables(FarRun& run, const NaturalTransform& tables, FarFieldMethod method,
                     const FieldTarget& target) {
    FarFieldParams params;
    params.method = method;
    params.method = plan_far_field(run.shape.mask, run.grid, params).method;
    const auto mask = run.shape.mask.mask.view();
    if (params.method == FarFieldMethod::runs)
        far_field_runs(mask, tables, target, run.exec);
    else if (params.method == FarFieldMethod::raster_fft)
        far_field_raster_fft(mask, tables, target, run.exec);
    else
        far_field_into(run.shape.mask, run.grid, params, target, run.exec);
}

MethodJob one_call(FarRun& run, FarFieldMethod method, double longest_ms) {
    MethodJob job;
    job.row = far_row(run, far_field_method_name(method));
    job.row.one_call = true;
    job.row.same_function = method != FarFieldMethod::polygon;
    FarFieldParams params;
    params.method = method;
    if (method == FarFieldMethod::automatic)
        job.row.note = far_field_method_name(plan_far_field(run.shape.mask, run.grid, params).method);
    job.run = [&run, params] {
        far_field_into(run.shape.mask, run.grid, params, run.power_target(), run.exec);
    };
    if (method == FarFieldMethod::polygon && run.shape.image.outline.disjoint) {
        const double expected_ms = 1e-6 * far_field_polygon_cost_ns(run.shape.mask.outline, run.grid);
        if (expected_ms > longest_ms)
            job.row.problem = fmt::format("left out: {:.0f} ms expected", expected_ms);
    }
    if (run.compare) {
        job.examine = [&run, params] {
            far_field_into(run.shape.mask, run.grid, params, run.field_target(), run.exec);
            return error_of(run.field, run.truth);
        };
    }
    return job;
}

/// The same with the tables of the mask's size made before.
MethodJob kept_tables(FarRun& run, const std::shared_ptr<NaturalTransform>& tables, double prepare_ms,
                      FarFieldMethod method) {
    MethodJob job = one_call(run, method, 0);
    job.row.one_call = false;
    job.row.prepare_ms = prepare_ms;
    job.run = [&run, tables, method] { run_with_tables(run, *tables, method, run.power_target()); };
    if (run.compare) {
        job.examine = [&run, tables, method] {
            run_with_tables(run, *tables, method, run.field_target());
            return error_of(run.field, run.truth);
        };
    }
    return job;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void add_our_jobs(FarRun& run, double longest_ms, std::vector<MethodJob>& jobs) {
    for (const FarFieldMethod method : strategies)
        jobs.push_back(one_call(run, method, longest_ms));
    jobs.push_back(one_call(run, FarFieldMethod::automatic, longest_ms));
    const ImageView<const float> mask = run.shape.mask.mask.view();
    const auto natural = natural_grid(mask.width, mask.height, run.grid);
    const auto start = std::chrono::steady_clock::now();
    const auto tables =
        std::make_shared<NaturalTransform>(natural_transform(mask.width, mask.height, *natural));
    const double prepare_ms = milliseconds_since(start);
    for (const auto method : {FarFieldMethod::runs, FarFieldMethod::raster_fft, FarFieldMethod::automatic})
        jobs.push_back(kept_tables(run, tables, prepare_ms, method));
}

#ifdef OBSCURA_HAS_FFTW

/// FFTW's plans of one size and number of threads.
struct FarPeers {
    std::unique_ptr<ImagePeer> image;
    std::unique_ptr<TexelPeer> mask;
    double image_ms = 0, mask_ms = 0;

    FarPeers(int size, int threads) {
        auto start = std::chrono::steady_clock::now();
        image = std::make_unique<ImagePeer>(size, threads);
        image_ms = milliseconds_since(start);
        start = std::chrono::steady_clock::now();
        mask = std::make_unique<TexelPeer>(size / 2, half_plane_of(size), threads);
        mask_ms = milliseconds_since(start);
    }

    /// `scale` turns the peer's powers into those of the mask.
    template <class Peer>
    void add(FarRun& run, Peer& peer, const DiffractionRow& row, float scale, std::vector<MethodJob>& jobs) {
        MethodJob job;
        job.row = row;
        job.row.peer = true;
        job.run = [&run, &peer] { peer.run(run.power.pixels.data()); };
        if (run.compare) {
            job.examine = [&run, &peer, scale] {
                peer.run(run.power.pixels.data());
                for (float& power : run.power.pixels)
                    power *= scale;
                return error_of(run.power, run.truth);
            };
        }
        jobs.push_back(std::move(job));
    }

    void add_jobs(FarRun& run, std::vector<MethodJob>& jobs) {
        image->load(run.shape.image.mask.view());
        mask->load(run.shape.mask.mask.view());
        DiffractionRow row = far_row(run, fftw_image_name);
        row.prepare_ms = image_ms;
        row.same_function = false;
        add(run, *image, row, 1.0f / 16, jobs);  // its texels are half as wide
        row = far_row(run, fftw_mask_name);
        row.prepare_ms = mask_ms;
        add(run, *mask, row, 1, jobs);
    }
};

#else

struct FarPeers {
    FarPeers(int, int) {}
    void add_jobs(FarRun& run, std::vector<MethodJob>& jobs) {
        for (const char* name : {fftw_image_name, fftw_mask_name}) {
            jobs.push_back({far_row(run, name), {}, {}});
            jobs.back().row.peer = true;
            jobs.back().row.problem = "this build has no FFTW";
        }
    }
};

#endif

/// Rows of one aperture at one size, all numbers of threads.
std::vector<DiffractionRow> measure_aperture(FarRun& run, const std::vector<std::unique_ptr<FarPeers>>& peers,
                                             const DiffractionBenchPlan& plan, const BenchOptions& options,
                                             std::vector<MethodPast>& past) {
    std::vector<DiffractionRow> all;
    for (std::size_t t = 0; t < options.threads.size(); ++t) {
        run.exec.threads = options.threads[t];
        run.compare = t == 0;
        std::vector<MethodJob> jobs;
        peers[t]->add_jobs(run, jobs);
        add_our_jobs(run, plan.longest_ms, jobs);
        // The jobs are the same for every number of threads: errors and problems are known from the first.
        for (std::size_t i = 0; t > 0 && i < jobs.size(); ++i) {
            jobs[i].row.error = all[i].error;
            jobs[i].row.log_psnr_db = all[i].log_psnr_db;
            jobs[i].row.problem = all[i].problem;
        }
        const std::vector<DiffractionRow> rows = time_methods(std::move(jobs), plan, past);
        all.insert(all.end(), rows.begin(), rows.end());
    }
    return all;
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
            FarRun run{std::move(*shape), half_plane_of(size), {}, {}, {}, {}, true};
            run.power = Image<float>(run.grid.width, run.grid.height);
            run.field = {run.power, run.power};
            const int most = size <= plan.whole_size ? size : plan.most_samples;
            run.truth = true_far_field(run.shape.mask.mask.view(), run.grid, most, most, Exec{});
            const std::vector<DiffractionRow> rows = measure_aperture(run, peers, plan, options, past);
            all.insert(all.end(), rows.begin(), rows.end());
            options.say(fmt::format("far field, {} {}: measured", name, size));
        }
    }
    return all;
}

}  // namespace obscura
