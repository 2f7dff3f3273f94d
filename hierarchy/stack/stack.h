#pragma once
// Stacks of shadow maps: soft shadows from all samples of a light, out of one octree. The room's public face.
//
//   const LightSamples lamp = parallelogram_samples(centre, edge_u, edge_v, 256);
//   FocusParams focus;
//   focus.plane_point = median_plane_point(mesh, {0, 1, 0});
//   if (!can_focus(lamp, focus)) ...
//   const ShadowStack stack = build_stack(mesh, focused_views(mesh, lamp, focus), {}, exec);
//   const StackLookup lookup = stack_lookup(stack, eye);                        // once a frame
//   const std::vector<float> share = visible_share(lookup, points, 0, exec);    // 0: all samples
//
// light_samples.h, focus.h and visible_share.h have the rest.
// The sun's disc has sun_samples(), a path of the sun or a sky's directions LightSamples of their own making.
// Files: stack_file.h. Memory while building: build_stack() says.

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "hierarchy/multires.h"
#include "hierarchy/stack/build_tree.h"
#include "hierarchy/stack/focus.h"
#include "hierarchy/stack/stack_code.h"
#include "hierarchy/stack/stack_frame.h"
#include "raster/intervals.h"

namespace obscura {

/// Immutable and cheap to copy: copies share the bits, which live in memory or in a mapped file.
struct ShadowStack {
    StackFrame frame;  ///< for points in the world
    std::shared_ptr<const std::vector<SliceView>> slices;
    /// Of every run of 2^j maps, aligned: run 1 holds all, run i the runs 2i and 2i + 1; maps are runs
    /// 2^slice_levels on.
    std::shared_ptr<const std::vector<SliceRange>> ranges;
    MultiresCounts counts;            ///< as count_nodes(): a tree of one node has a leaf
    StackCode code;                   ///< points into `bits`
    std::uint64_t bytes = 0;          ///< of the serialised nodes, padding included
    std::uint64_t padding_bytes = 0;  ///< of these
    std::shared_ptr<const void> bits;

    int resolution() const { return 1 << code.shape.map_levels; }
};

struct StackBuildParams {
    Receivers receivers = Receivers::any;
    bool only_casters = true;
    StackTreeParams tree;  ///< anisotropies to try, limits
};

/// One octree for all views. Every map is built by itself, as build_shadow_tree() builds one, and merged with
/// those before it; decoded depths lie in the interval of their texel in every map. For any exec the same
/// bytes. While it works it holds, for eight maps, what their texels are certain of (14 bytes a texel where
/// surfaces slope, nothing where depths are level), the setup of the mesh for every thread, and for every
/// anisotropy tried its octree so far (12 bytes a node) and up to as much again. Throws LimitError. When
/// `cancel` is set meanwhile, the result has no meaning.
ShadowStack build_stack(const Mesh& mesh, const FocusedViews& views, const StackBuildParams& params,
                        const Exec& exec, StackTreeStats* stats = nullptr,
                        const std::atomic<bool>* cancel = nullptr);

/// Ranges of runs of these slices (see ShadowStack::ranges).
std::vector<SliceRange> slice_ranges(const std::vector<SliceView>& slices, int slice_levels);

}  // namespace obscura
