#pragma once
// How much memory a piece of work needed at most.

#include <cstdint>

namespace obscura {

/// Peak of this process's resident memory since construction, above what was resident then (Linux; 0 where
/// the kernel does not tell).
class PeakMemory {
  public:
    PeakMemory();
    std::int64_t bytes() const;

  private:
    std::int64_t before_ = 0;
};

}  // namespace obscura
