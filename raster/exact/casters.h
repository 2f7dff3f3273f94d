#pragma once
// What casts shadows, in the order that exact shadows look for it.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "raster/camera_rays.h"
#include "raster/exact/exact.h"
#include "raster/setup.h"

namespace obscura {

/// The casters of one view of a light. Triangles stand in the order of their size on the light's grid, large
/// ones first (in steps of four), and within a size along a Morton curve; sixteen neighbours share a box, as
/// do sixteen such boxes and so on. Large occluders are thus met first, and a large triangle widens no box of
/// small ones.
struct Casters {
    LightView view;
    Buffer<CasterTriangle> triangles;  ///< filled up to a multiple of sixteen
    std::vector<Buffer<CasterBoxes>> boxes;
    std::size_t count = 0;  ///< triangles that are some

    std::int64_t bytes() const;
};

/// What making casters needs meanwhile, and casters that are no longer asked, whose memory is taken first:
/// new pages have to be cleared (caster_pool.h).
struct CasterScratch {
    TriangleSetup setup;
    Buffer<std::uint64_t> items, other_items;  ///< keys of records, and their numbers
    std::vector<Casters> spare;
};

/// Casters of every view that the light needs: one, or six of a point light; none when `cancel` was set
/// before they were done. The same for any exec. The mesh needs its topology.
std::vector<Casters> build_casters(const Mesh& mesh, const Light& light, const Exec& exec,
                                   CasterScratch& scratch, const std::atomic<bool>* cancel = nullptr);

/// Bytes of so many triangles in order; and of what sorting takes meanwhile, beside setup_bytes().
std::int64_t casters_bytes(std::int64_t triangles);
std::int64_t casters_sorting_bytes(std::int64_t triangles);

/// For kernels; `casters` and `mesh`, whose points will ask, must outlive it. `rays` are the camera's, of the
/// picture that asks.
ExactLight exact_light(const Light& light, std::span<const Casters> casters, const Mesh& mesh,
                       const CameraRays& rays);

}  // namespace obscura
