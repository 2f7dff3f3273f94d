#include "app/scene/texture_notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/count_text.h"

namespace obscura {

std::vector<std::string> texture_notes(const std::string& who, const Mesh& mesh,
                                       const std::vector<bool>& without_uv,
                                       const std::vector<Material>& materials,
                                       const std::function<std::string(std::int32_t)>& name_of) {
    const auto textured = [](const Material& m) { return m.texture >= 0; };
    if (std::none_of(materials.begin(), materials.end(), textured)) return {};
    std::vector<std::size_t> all(materials.size()), without(materials.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        ++all.at(mesh.material[t]);
        if (mesh.uvs.empty() || (!without_uv.empty() && without_uv[t])) ++without[mesh.material[t]];
    }
    std::vector<std::string> notes;
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (!textured(materials[m]) || without[m] == 0) continue;
        notes.push_back(fmt::format(
            "{}: texture {} of material '{}' does not show on {} of its {}: no texture coordinates (vt)", who,
            name_of(materials[m].texture), materials[m].name, without[m], count_text(all[m], "triangle")));
    }
    return notes;
}

}  // namespace obscura
