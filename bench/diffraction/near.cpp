// The near field over the mask's square, beside FFTW's linear convolution with the chirp.

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bench/diffraction/cases.h"
#include "bench/diffraction/method_timing.h"
#include "core/error.h"
#ifdef OBSCURA_HAS_FFTW
#include "bench/diffraction/peers.h"
#include "bench/harness/run_times.h"
#endif

namespace obscura {
namespace {

constexpr double timed_fresnel_number = 10;
constexpr NearFieldMethod strategies[] = {NearFieldMethod::direct, NearFieldMethod::two_pass,
                                          NearFieldMethod::edges,  NearFieldMethod::hybrid,
                                          NearFieldMethod::fft,    NearFieldMethod::automatic};

/// A mask and the plane of its own texels.
struct NearRun {
    DiffractionCase shape;
    PlaneGrid grid;
    NearFieldParams params;
    double turns = 0;
    TrueField truth;
    Exec exec;
    Field field;

    FieldTarget target() { return {field.re.pixels.data(), field.im.pixels.data(), nullptr, grid.width}; }
    /// Where the aperture has this Fresnel number.
    void place(double fresnel, int most) {
        params.distance_m = 1;
        params.distance_m = fresnel_number(shape.mask, params) / fresnel;
        turns = shape.mask.pitch_m * shape.mask.pitch_m / (2 * params.wavelength_m * params.distance_m);
        truth = true_near_field(shape.mask.mask.view(), grid, turns, most, Exec{});
    }
};

/// `size`: of the mask.
std::optional<NearRun> near_run(const std::string& aperture, int size, const BenchOptions& options) {
    auto shape = diffraction_case(aperture, 2 * size, options.data);
    if (!shape) return std::nullopt;
    NearRun run;
    run.shape = std::move(*shape);
    run.grid = centred_plane(size, size);
    run.field = {Image<float>(size, size), Image<float>(size, size)};
    return run;
}

DiffractionRow near_row(const NearRun& run, const char* method) {
    DiffractionRow row;
    row.part = near_part;
    row.aperture = run.shape.aperture;
    row.convex = run.shape.convex;
    row.size = run.grid.width;
    row.method = method;
    row.threads = run.exec.threads;
    return row;
}

MethodJob our_job(NearRun& run, NearFieldMethod method) {
    MethodJob job;
    job.row = near_row(run, near_field_method_name(method));
    job.row.one_call = true;
    NearFieldParams params = run.params;
    params.method = method;
    if (method == NearFieldMethod::automatic)
        job.row.note = near_field_method_name(plan_near_field(run.shape.mask, run.grid, params).method);
    job.run = [&run, params] { near_field_into(run.shape.mask, run.grid, params, run.target(), run.exec); };
    job.examine = [&run, work = job.run] {
        work();
        return error_of(run.field, run.truth);
    };
    return job;
}

#ifdef OBSCURA_HAS_FFTW

struct NearPeer {
    std::unique_ptr<FresnelPeer> fft;
    double prepare_ms = 0;
    const char* name = fftw_near_name;
    ChirpKernel kernel = ChirpKernel::integrated;

    NearPeer(int size, int padding, int threads) {
        prepare_ms = milliseconds_of([&] { fft = std::make_unique<FresnelPeer>(size, padding, threads); });
        if (padding == 2) return;
        name = fftw_near8_name;
        kernel = ChirpKernel::sampled;
    }

    void add_job(NearRun& run, std::vector<MethodJob>& jobs) {
        fft->set_kernel(run.turns, kernel);
        fft->load(run.shape.mask.mask.view());
        MethodJob job;
        job.row = near_row(run, name);
        job.row.peer = true;
        job.row.same_function = kernel == ChirpKernel::integrated;
        job.row.prepare_ms = prepare_ms;
        job.run = [&run, this] { fft->run(run.field.re.pixels.data(), run.field.im.pixels.data()); };
        job.examine = [&run, work = job.run] {
            work();
            return error_of(run.field, run.truth);
        };
        jobs.push_back(std::move(job));
    }
};

#else

struct NearPeer {
    const char* name;
    NearPeer(int, int padding, int) : name(padding == 2 ? fftw_near_name : fftw_near8_name) {}
    void add_job(NearRun& run, std::vector<MethodJob>& jobs) {
        MethodJob job;
        job.row = near_row(run, name);
        job.row.peer = true;
        job.row.problem = "this build has no FFTW";
        jobs.push_back(std::move(job));
    }
};

#endif

/// The thesis pads to eight times the size; that is slow, and what it costs does not depend on the aperture.
constexpr const char* padded_aperture = "whirl";

using Peers = std::vector<std::unique_ptr<NearPeer>>;

std::vector<DiffractionRow> measure_one(NearRun& run, const Peers& peers, const Peers& padded,
                                        const DiffractionBenchPlan& plan, const BenchOptions& options,
                                        std::vector<MethodPast>& past) {
    run.place(timed_fresnel_number, std::min(run.grid.width, plan.most_near_samples));
    const auto jobs_of = [&](std::size_t t) {
        run.exec.threads = options.threads[t];
        std::vector<MethodJob> jobs;
        peers[t]->add_job(run, jobs);
        for (const NearFieldMethod method : strategies)
            jobs.push_back(our_job(run, method));
        if (t < padded.size() && run.shape.aperture == padded_aperture) padded[t]->add_job(run, jobs);
        return jobs;
    };
    return time_methods(options.threads, jobs_of, plan, past);
}

}  // namespace

std::vector<DiffractionRow> measure_near(const DiffractionBenchPlan& plan, const BenchOptions& options) {
    std::vector<DiffractionRow> all;
    std::vector<MethodPast> past;
    for (const int size : plan.near_sizes) {
        const bool pads = std::count(plan.padded_sizes.begin(), plan.padded_sizes.end(), size) > 0;
        Peers peers, padded;
        for (const int threads : options.threads) {
            peers.push_back(std::make_unique<NearPeer>(size, 2, threads));
            if (pads && threads == 1) padded.push_back(std::make_unique<NearPeer>(size, 8, threads));
        }
        for (const std::string& name : chosen_apertures(options)) {
            auto run = near_run(name, size, options);
            if (!run) continue;
            for (DiffractionRow& row : measure_one(*run, peers, padded, plan, options, past))
                all.push_back(std::move(row));
            options.say(fmt::format("near field, {} {}: measured", name, size));
        }
    }
    return all;
}

std::vector<ControlRow> measure_controls(const DiffractionBenchPlan& plan, const BenchOptions& options) {
    std::vector<ControlRow> rows;
    auto run = near_run("heptagon", plan.control_size, options);
    CHECK(run.has_value());
    run->exec.threads = 1;
#ifdef OBSCURA_HAS_FFTW
    NearPeer peer(plan.control_size, 2, 1);
#endif
    for (const double fresnel : {1.0, 10.0, 50.0}) {
        run->place(fresnel, plan.control_size);
        ControlRow row;
        row.fresnel_number = fresnel;
        row.size = plan.control_size;
        for (const NearFieldMethod method : {NearFieldMethod::two_pass, NearFieldMethod::edges,
                                             NearFieldMethod::hybrid, NearFieldMethod::fft})
            row.our_error = std::max(row.our_error, our_job(*run, method).examine().amplitude);
#ifdef OBSCURA_HAS_FFTW
        for (double* error : {&row.integrated_error, &row.sampled_error}) {
            peer.kernel = error == &row.sampled_error ? ChirpKernel::sampled : ChirpKernel::integrated;
            std::vector<MethodJob> jobs;
            peer.add_job(*run, jobs);
            *error = jobs[0].examine().amplitude;
        }
#endif
        rows.push_back(row);
    }
    return rows;
}

}  // namespace obscura
