#pragma once
// The parts of a parallel light with a size, ready for exact shadows: of each no more than where it sees the
// mesh's vertices. What casts is ordered once, as the light's middle sees it (build_casters()).

#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_soft.h"

namespace obscura {

struct SoftParts {
    std::vector<Buffer<PartVertex>> vertices;
    std::vector<ExactParts> groups;  ///< sixteen parts each, which borrow from vertices
};

/// `lights`: of light_samples(), parallel. The same for any exec.
SoftParts soft_parts(const Mesh& mesh, std::span<const Light> lights, const Exec& exec);

/// Bytes of sixteen parts, or fewer.
std::int64_t soft_parts_bytes(std::int64_t vertices);

/// `middle` and what it holds, the parts and the mesh must outlive it.
ExactSoft exact_soft_light(const Light& light, const ExactLight& middle, const SoftParts& parts,
                           const Mesh& mesh);

}  // namespace obscura
