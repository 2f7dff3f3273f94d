#pragma once
// The memory behind a LayerStack: one thread's, used for tile after tile, larger when a tile needs it.

#include "core/buffer.h"
#include "raster/layer_tile.h"

namespace obscura {

class LayerMemory {
  public:
    explicit LayerMemory(bool with_triangles);

    /// Runs fill(stack) until no crossing is dropped, each time with twice the memory, and returns the stack.
    /// LimitError beyond 2^30 crossings.
    template <class Fill>
    const LayerStack& run(Fill&& fill) {
        fill(stack_);
        while (stack_.overflow) {
            grow();
            fill(stack_);
        }
        return stack_;
    }

  private:
    void grow();
    Buffer<LayerKey> keys_;
    Buffer<std::int32_t> triangles_, rows_;
    LayerStack stack_;
};

}  // namespace obscura
