#pragma once
// Far fields as jobs of the diffraction bench.

#include <memory>

#include "bench/diffraction/cases.h"
#include "bench/diffraction/method_timing.h"
#include "optics/natural_transform.h"

namespace obscura {

/// One aperture at one size and one grid of frequencies, and where every method writes.
struct FarRun {
    const char* part = far_part;
    DiffractionCase shape;
    FrequencyGrid grid;
    TrueField truth;
    Exec exec;
    Image<float> power;
    Field field;
};

/// Computes the truth; `most`: see true_far_field().
FarRun far_run(const char* part, DiffractionCase shape, const FrequencyGrid& grid, int most);

DiffractionRow far_row(const FarRun& run, const std::string& method);

// `run` must outlive the jobs.

/// far_field_into() as it is. Left out when its cost is known to exceed longest_ms.
MethodJob one_call(FarRun& run, FarFieldMethod method, double longest_ms);

/// The same with the tables of the mask's size made before, in prepare_ms.
MethodJob kept_tables(FarRun& run, const std::shared_ptr<NaturalTransform>& tables, double prepare_ms,
                      FarFieldMethod method);

/// A peer that writes powers; `scale` turns them into those of the mask.
MethodJob peer_job(FarRun& run, const DiffractionRow& row, std::function<void(float*)> peer, float scale);

/// The same when it is absent.
MethodJob absent_peer(FarRun& run, const char* name);

}  // namespace obscura
