#include "bench/diffraction/far_field_jobs.h"

#include <fmt/format.h>

#include "optics/far_field_methods.h"

namespace obscura {
namespace {

FieldTarget power_target(FarRun& run) {
    return {nullptr, nullptr, run.power.pixels.data(), run.grid.width};
}

FieldTarget field_target(FarRun& run) {
    return {run.field.re.pixels.data(), run.field.im.pixels.data(), nullptr, run.grid.width};
}

/// Times powers, compares amplitudes.
void set_work(FarRun& run, MethodJob& job, const std::function<void(const FieldTarget&)>& compute) {
    job.run = [&run, compute] { compute(power_target(run)); };
    job.examine = [&run, compute] {
        compute(field_target(run));
        return error_of(run.field, run.truth);
    };
}

}  // namespace

FarRun far_run(const char* part, DiffractionCase shape, const FrequencyGrid& grid, int most) {
    FarRun run;
    run.part = part;
    run.shape = std::move(shape);
    run.grid = grid;
    run.power = Image<float>(grid.width, grid.height);
    run.field = {run.power, run.power};
    run.truth = true_far_field(run.shape.mask.mask.view(), grid, most, most, Exec{});
    return run;
}

DiffractionRow far_row(const FarRun& run, const std::string& method) {
    DiffractionRow row;
    row.part = run.part;
    row.aperture = run.shape.aperture;
    row.convex = run.shape.convex;
    row.size = run.shape.size;
    row.method = method;
    row.threads = run.exec.threads;
    return row;
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
    if (method == FarFieldMethod::polygon && run.shape.mask.outline.disjoint) {
        const double expected_ms = 1e-6 * far_field_polygon_cost_ns(run.shape.mask.outline, run.grid);
        if (expected_ms > longest_ms)
            job.row.problem = fmt::format("left out: {:.0f} ms expected", expected_ms);
    }
    set_work(run, job, [&run, params](const FieldTarget& target) {
        far_field_into(run.shape.mask, run.grid, params, target, run.exec);
    });
    return job;
}

MethodJob kept_tables(FarRun& run, const std::shared_ptr<NaturalTransform>& tables, double prepare_ms,
                      FarFieldMethod method) {
    MethodJob job = one_call(run, method, 0);
    job.row.one_call = false;
    job.row.prepare_ms = prepare_ms;
    set_work(run, job, [&run, tables, method](const FieldTarget& target) {
        FarFieldParams params;
        params.method = method;
        far_field_into(run.shape.mask, run.grid, params, *tables, target, run.exec);
    });
    return job;
}

MethodJob peer_job(FarRun& run, const DiffractionRow& row, const std::function<void(float*)>& peer,
                   float scale) {
    MethodJob job;
    job.row = row;
    job.row.peer = true;
    job.run = [&run, peer] { peer(run.power.pixels.data()); };
    job.examine = [&run, peer, scale] {
        peer(run.power.pixels.data());
        for (float& power : run.power.pixels)
            power *= scale;
        return error_of(run.power, run.truth);
    };
    return job;
}

MethodJob absent_peer(FarRun& run, const char* name) {
    MethodJob job;
    job.row = far_row(run, name);
    job.row.peer = true;
    job.row.problem = "this build has no FFTW";
    return job;
}

}  // namespace obscura
