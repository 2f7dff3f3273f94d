#pragma once
// Casters of lights in great number, in memory that lights before them had: side by side, each by one thread,
// or one by one where there are fewer lights than threads.

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "raster/exact/casters.h"

namespace obscura {

class CasterPool {
  public:
    /// build_casters() of each light; none at all when `cancel` was set before they were done. The same for
    /// any exec.
    std::vector<std::vector<Casters>> build(const Mesh& mesh, std::span<const Light> lights, const Exec& exec,
                                            const std::atomic<bool>* cancel = nullptr);

    /// Memory for the next.
    void give_back(std::vector<std::vector<Casters>> casters);

  private:
    std::unique_ptr<CasterScratch> take(const Light& light);
    void put(std::unique_ptr<CasterScratch> scratch);

    std::mutex mutex_;
    std::vector<std::unique_ptr<CasterScratch>> free_;
    std::vector<Casters> spare_;
};

}  // namespace obscura
