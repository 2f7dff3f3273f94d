#pragma once
// Fixed tiles on many threads. Work items write to disjoint places and learn nothing about threads, so
// no result can depend on how many there are. Reductions: write one partial per item, sum in index order.

#include <atomic>
#include <cstddef>
#include <type_traits>

#include "core/isa.h"

namespace obscura {

/// Threads that Exec::threads = 0 stands for: the CPUs this process may run on.
int hardware_threads();

/// Calls body(context, i) for every i in [0, count), in any order, on exec.threads threads.
/// The first exception thrown by a body is rethrown here after the others stopped.
void parallel_for_raw(std::size_t count, const Exec& exec, void (*body)(void*, std::size_t), void* context);

/// Calls fn(i) for every i in [0, count). Items are handed out one by one: make them worth 10 us or more.
template <class Fn>
void parallel_for(std::size_t count, const Exec& exec, Fn&& fn) {
    using F = std::remove_reference_t<Fn>;
    parallel_for_raw(
        count, exec, [](void* context, std::size_t i) { (*static_cast<F*>(context))(i); },
        const_cast<void*>(static_cast<const void*>(&fn)));
}

/// Whether whoever gave `cancel` (null: nobody) has set it.
inline bool stopped(const std::atomic<bool>* cancel) {
    return cancel != nullptr && cancel->load(std::memory_order_relaxed);
}

/// Cuts [0, count) into blocks of `block` items and calls fn(begin, end) for each.
template <class Fn>
void parallel_blocks(std::size_t count, std::size_t block, const Exec& exec, Fn&& fn) {
    parallel_for((count + block - 1) / block, exec, [&](std::size_t b) {
        const std::size_t begin = b * block;
        fn(begin, begin + block < count ? begin + block : count);
    });
}

}  // namespace obscura
