// Who takes part. A new contestant is one line here.

#include "bench/raster/memory_limit.h"
#include "bench/raster/our_rasterizer.h"
#include "bench/raster/raster_bench.h"
#ifdef OBSCURA_HAS_EMBREE
#include "bench/raster/peer_embree.h"
#endif
#ifdef OBSCURA_HAS_OSMESA
#include "bench/raster/peer_llvmpipe.h"
#endif

namespace obscura {

std::vector<Contestant> all_contestants() {
    std::vector<Contestant> all = {our_contestant()};
#ifdef OBSCURA_HAS_OSMESA
    all.push_back(llvmpipe_contestant());
#else
    all.push_back({"llvmpipe", "this build did not find OSMesa (package libosmesa6-dev)", {}});
#endif
#ifdef OBSCURA_HAS_EMBREE
    all.push_back(embree_contestant());
#else
    all.push_back({"Embree", "this build did not find Embree 3 (package libembree-dev)", {}});
#endif
    all.push_back(memory_limit_contestant());
    return all;
}

}  // namespace obscura
