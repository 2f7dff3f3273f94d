// Ends of runs, sixteen frequencies at a time. See run_sums_ref.cpp.

#include "optics/run_sums.h"

#include "core/simd.h"

namespace obscura::OBSCURA_ISA {

void edge_phases16(const PhaseSeeds& seeds, float* re, float* im) noexcept {
    for (int x = 0; x < seeds.count; ++x) {
        const F32 a = splat(seeds.base_re[x]), b = splat(seeds.base_im[x]);
        const F32 c = load(seeds.step_re + 16 * x), d = load(seeds.step_im + 16 * x);
        if (re != nullptr) store(re + 16 * x, a * c - b * d);
        store(im + 16 * x, a * d + b * c);
    }
}

void run_sums16(const RunTable& runs, const float* table, float* out) noexcept {
    for (int y = 0; y < runs.rows; ++y) {
        F32 sum = splat(0.0f);
        for (std::int32_t r = runs.first[y]; r < runs.first[y + 1]; ++r) {
            const F32 begin = load(table + 16 * runs.begin[r]), end = load(table + 16 * runs.end[r]);
            sum = sum + splat(runs.weight[r]) * (begin - end);
        }
        store(out + 16 * y, sum);
    }
}

}  // namespace obscura::OBSCURA_ISA
