// One lane at a time: what run_sums_kernel.cpp does sixteen at a time.

#include "optics/run_sums.h"

namespace obscura::ref {

void edge_phases16(const PhaseSeeds& seeds, float* re, float* im) noexcept {
    for (int x = 0; x < seeds.count; ++x) {
        const float a = seeds.base_re[x], b = seeds.base_im[x];
        for (int lane = 0; lane < 16; ++lane) {
            const float c = seeds.step_re[16 * x + lane], d = seeds.step_im[16 * x + lane];
            if (re != nullptr) re[16 * x + lane] = a * c - b * d;
            im[16 * x + lane] = a * d + b * c;
        }
    }
}

void run_sums16(const RunTable& runs, const float* table, float* out) noexcept {
    for (int y = 0; y < runs.rows; ++y) {
        for (int lane = 0; lane < 16; ++lane) {
            float sum = 0;
            for (std::int32_t r = runs.first[y]; r < runs.first[y + 1]; ++r) {
                const float begin = table[16 * runs.begin[r] + lane], end = table[16 * runs.end[r] + lane];
                sum = sum + runs.weight[r] * (begin - end);
            }
            out[16 * y + lane] = sum;
        }
    }
}

}  // namespace obscura::ref
