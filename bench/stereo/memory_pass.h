#pragma once
// The unit in which solvers are measured: once over memory, reading three numbers per unknown and writing
// one.

#include <cstddef>
#include <memory>

#include "core/isa.h"

namespace obscura {

/// d = a + s (b - c) over arrays of `count` floats. A damped Jacobi sweep reads and writes as much, at least.
class MemoryPass {
  public:
    explicit MemoryPass(std::size_t count);
    /// `streaming`: stores go around the caches, which is faster where the arrays do not fit into them.
    void run(bool streaming, const Exec& exec);
    const float* result() const { return arrays_[3].get(); }
    std::size_t bytes() const { return 4 * sizeof(float) * count_; }

  private:
    struct FreeAligned {
        void operator()(float* p) const;
    };
    std::size_t count_;
    std::unique_ptr<float, FreeAligned> arrays_[4];
};

}  // namespace obscura
