#include "bench/raster/memory_limit.h"

#include <emmintrin.h>

#include <memory>

#include "bench/raster/workloads.h"
#include "core/parallel.h"

namespace obscura {
namespace {

struct FreeAligned {
    void operator()(float* p) const { _mm_free(p); }
};

struct LimitState {
    std::unique_ptr<float, FreeAligned> floats;
    Exec exec;
};

void fill_streaming(const LimitState& state, std::size_t count) {
    constexpr std::size_t block = std::size_t{1} << 18;  // 1 MiB of floats
    parallel_blocks(count, block, state.exec, [&](std::size_t begin, std::size_t end) {
        const __m128 one = _mm_set1_ps(1.0f);
        float* const p = state.floats.get();
        for (std::size_t i = begin; i + 16 <= end; i += 16) {
            _mm_stream_ps(p + i, one);
            _mm_stream_ps(p + i + 4, one);
            _mm_stream_ps(p + i + 8, one);
            _mm_stream_ps(p + i + 12, one);
        }
        _mm_sfence();
    });
}

Session open_limit(const BenchScene& scene, const Exec& exec) {
    const auto state = std::make_shared<LimitState>();
    const std::size_t depth = result_size(Workload::depth, scene),
                      dual = result_size(Workload::dual_depth, scene);
    state->floats.reset(static_cast<float*>(_mm_malloc(dual * sizeof(float), 64)));
    if (state->floats == nullptr) throw std::bad_alloc();
    state->exec = exec;
    Session session;
    session.version = "streaming stores, 128 bit";
    session.jobs = {
        {Workload::depth,
         "write the map",
         false,
         [s = state.get(), depth] { fill_streaming(*s, depth); },
         {}},
        {Workload::dual_depth,
         "write both maps",
         false,
         [s = state.get(), dual] { fill_streaming(*s, dual); },
         {}},
    };
    session.state = state;
    return session;
}

}  // namespace

Contestant memory_limit_contestant() {
    return {"memory limit", "", open_limit};
}

}  // namespace obscura
