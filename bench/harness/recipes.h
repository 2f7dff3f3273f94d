#pragma once
// The bench's scenes by name.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace obscura {

/// A scene by name; `make` generates or loads its mesh (throws InputError).
struct BenchRecipe {
    std::string name;
    std::function<Mesh()> make;
};

/// Scenes of the bench: two cities of boxes (10,812 and 594,012 triangles), a town of the generator with
/// about as many, and, when `data` holds meshes/bunny.obj, the bunny once and eight times. `quick`: the small
/// city alone.
std::vector<BenchRecipe> bench_recipes(const std::optional<std::filesystem::path>& data, bool quick);

/// columns x rows closed boxes of random height on one closed slab, 12 triangles each. The same on any
/// machine.
Mesh box_city(int columns, int rows);

/// Copies of a part in rows of `columns`, each turned a little further, standing on one closed slab.
Mesh copies_on_slab(const Mesh& part, int copies, int columns);

}  // namespace obscura
