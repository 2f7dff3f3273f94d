#pragma once
// Rows of a grid on all threads.

#include <cstddef>

#include "core/parallel.h"

namespace obscura {

constexpr std::size_t grid_rows_per_task = 32;

/// Calls fn(y) for every row of [0, height), a few neighbours per task.
template <class Fn>
void for_rows(int height, const Exec& exec, Fn&& fn) {
    parallel_blocks(static_cast<std::size_t>(height), grid_rows_per_task, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t y = begin; y < end; ++y)
                            fn(static_cast<int>(y));
                    });
}

}  // namespace obscura
