#include "core/parallel.h"

#include <sched.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace obscura {

int hardware_threads() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    const int n = CPU_COUNT(&set);
    return n > 0 ? n : 1;
}

void parallel_for_raw(std::size_t count, const Exec& exec, void (*body)(void*, std::size_t), void* context) {
    const int threads = exec.threads > 0 ? exec.threads : hardware_threads();
    if (threads == 1 || count <= 1) {
        for (std::size_t i = 0; i < count; ++i)
            body(context, i);
        return;
    }
    // More threads than cores are allowed on purpose: determinism tests ask for 7 on any machine.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i != range.end(); ++i)
                    body(context, i);
            },
            tbb::simple_partitioner());
    });
}

}  // namespace obscura
