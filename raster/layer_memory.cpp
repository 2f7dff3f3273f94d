#include "raster/layer_memory.h"

#include "core/error.h"

namespace obscura {

LayerMemory::LayerMemory(bool with_triangles) : rows_(3 * layer_tile_rows) {
    // Eight layers everywhere, and some more for the rows that need them.
    stack_.capacity = layer_tile_rows * layers_in_place * 3 / 2;
    const auto size = static_cast<std::size_t>(stack_.capacity) * 16;
    keys_.reset(size);
    if (with_triangles) triangles_.reset(size);
    stack_.keys = keys_.data();
    stack_.triangles = triangles_.data();
    stack_.first = rows_.data();
    stack_.room = rows_.data() + layer_tile_rows;
    stack_.filled = rows_.data() + 2 * layer_tile_rows;
}

void LayerMemory::grow() {
    if (stack_.capacity >= (1 << 26)) {
        throw LimitError("more surfaces lie behind one another than a tile can hold: 2^30 crossings");
    }
    stack_.capacity *= 2;
    const auto size = static_cast<std::size_t>(stack_.capacity) * 16;
    keys_.reset(size);
    if (stack_.triangles != nullptr) triangles_.reset(size);
    stack_.keys = keys_.data();
    stack_.triangles = triangles_.data();
}

}  // namespace obscura
