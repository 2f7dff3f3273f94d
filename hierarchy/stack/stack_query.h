#pragma once
// How many samples of a light reach a point: lookups in a stack of shadow maps. POD: kernels include this.
//
// One lookup asks one map for one point, by the rule of filters/pcf.h with a kernel of one texel. Let D = n .
// l, with n the receiver's normal and l the way to the sample, as long as makes its part along the plane of
// focus' normal 1. The sample is
//   lit    where the point lies before the near plane, or outside of the map;
//   else dark where D <= 0: the face looks away;
//   else lit where the depth of the receiver's own plane at the middle of the texel, but not more than the
//   receiver's, less what rounding may have moved it, nor than 1, where there is only background, is at most
//   what the octree stores for that texel.
//
// lit_of_subset: the paper's way (Scandolo, Bauszat, Eisemann 2016, section 4): one lookup in each of
// `samples` equal shares of the maps, where the point's pattern says.
//
// lit_samples: all maps, by fewer steps. The octree is descended with a run of maps at once, all of them at
// first. In all maps of the run the point falls into a box of texels, whose corners follow from the least and
// greatest slice parameters of the run (stack_frame.h), and its depth lies between bounds. While one child
// holds box and run, the descent goes there. Where one value holds for all of it, and no depth in between is
// on the other side of that value, all maps of the run are answered at once; else the run is halved, and each
// half goes on from where the descent stands. Floats are rounded monotonically, and both ways compute in the
// same order, so bounds hold to the last bit and the count is that of one lookup per map. Shaft traversal of
// this kind is old (E. Haines, J. Wallace, "Shaft Culling for Efficient Ray-Traced Radiosity", 1991); here
// the shaft runs through the octree's third axis.

#include <cstddef>
#include <cstdint>

#include "hierarchy/stack/stack_code.h"
#include "hierarchy/stack/stack_frame.h"

namespace obscura {

/// Error bounds of a receiver's depth: those of filters/pcf.h (pcf_position_error, pcf_snap,
/// pcf_depth_error), but for depths computed in floats, eight units in the last place.
constexpr float stack_position_error = 0x1p-21f, stack_snap = 1.0f / 256.0f, stack_depth_error = 0x1p-21f;
/// D is taken for no less than this.
constexpr float stack_least_cosine = 1.0f / 64.0f;

/// A stack as its lookups see it, for points relative to an eye.
struct StackLookup {
    StackCode code;
    StackFrame frame;  ///< for points relative to the eye
    /// Of a normal n: its parts along the plane of focus, per texel, and across: plane coordinates of a step
    /// (dA, dB, dh) within the receiver's plane have n_a dA + n_b dB + n_h dh = 0.
    float normal_a[3] = {0, 0, 0}, normal_b[3] = {0, 0, 0}, normal_h[3] = {0, 0, 0};
    const SliceRange* ranges = nullptr;  ///< as ShadowStack::ranges
    std::int32_t slices = 0;
};

/// Points relative to the eye, one array per coordinate; unit normals, turned to the side that is lit.
struct StackPoints {
    const float *px = nullptr, *py = nullptr, *pz = nullptr;
    const float *nx = nullptr, *ny = nullptr, *nz = nullptr;
    const std::uint16_t* pattern =
        nullptr;  ///< lit_of_subset: where in its share of the maps a point looks, of 2^16
    std::size_t count = 0;
};

/// Exact counts, the same for every instruction set.
struct StackWork {
    std::uint64_t nodes = 0;    ///< headers read, a point at a time
    std::uint64_t lookups = 0;  ///< runs of maps (or single maps) that were asked, a point at a time
};

constexpr std::int32_t most_stack_parts = 64;

/// lit[i] = how many samples reach point i: of all maps, or of `samples` (in [1, slices]) of them.
/// lit_of_parts: of each of `parts` equal runs of maps, lit[part * points.count + i], at the same steps; a
/// power of two, at most most_stack_parts and 2^slice_levels, as many as which are a map each. All add to
/// `work`.
#define OBSCURA_STACK_QUERIES                                                                                \
    void lit_samples(const StackLookup& stack, const StackPoints& points, std::uint16_t* lit,                \
                     StackWork& work) noexcept;                                                              \
    void lit_of_parts(const StackLookup& stack, const StackPoints& points, std::int32_t parts,               \
                      std::uint16_t* lit, StackWork& work) noexcept;                                         \
    void lit_of_subset(const StackLookup& stack, const StackPoints& points, int samples, std::uint16_t* lit, \
                       StackWork& work) noexcept;
namespace ref {
OBSCURA_STACK_QUERIES
}
namespace sse2 {
OBSCURA_STACK_QUERIES
}
namespace avx2 {
OBSCURA_STACK_QUERIES
}
namespace avx512bw {
OBSCURA_STACK_QUERIES
}
#undef OBSCURA_STACK_QUERIES

/// Which map a point with this pattern asks in share j of `samples`.
inline __attribute__((always_inline)) std::int32_t subset_slice(std::int32_t slices, std::int32_t samples,
                                                                std::int32_t j, std::uint32_t pattern) {
    const std::int32_t begin = j * slices / samples, end = (j + 1) * slices / samples;
    const std::uint32_t turned = (pattern + static_cast<std::uint32_t>(j) * 0x9e37u) & 0xffffu;
    return begin + static_cast<std::int32_t>(turned * static_cast<std::uint32_t>(end - begin) >> 16);
}

}  // namespace obscura
