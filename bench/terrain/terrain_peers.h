#pragma once
// How others find and store the shadows of terrain.

#include <cstdint>
#include <optional>
#include <span>

#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"
#include "raster/heights/shadow_bits.h"

namespace obscura {

/// Bytes of a far map as Chajdas, Reichl, Dick, Westermann (2014, section 3.1) store it: the distinct 8 x 8
/// tiles as a dictionary, their numbers with 16 or 32 bits, each stream by LZMA (liblzma, its highest level,
/// without a container). An empty map takes none. Nothing where liblzma is not installed.
std::optional<std::int64_t> dictionary_lzma_bytes(const ShadowBits& map);

/// Seconds of tracing, and the samples in shadow.
struct TracedMap {
    ShadowBits map;
    double seconds = 0;
};

/// A ray from every sample to each sun, by Embree, over the ground closed by walls and a floor; one thread.
/// Nothing where Embree is not installed.
std::optional<std::vector<TracedMap>> embree_shadows(const HeightField& field,
                                                     std::span<const HeightSun> suns);

}  // namespace obscura
