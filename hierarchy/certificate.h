#pragma once
// What is certain about a square of texels before any of them is rasterized: its common interval, and how
// deep one has to look.
//
// Let K be the intersection of the intervals of all texels of a square. Where K is not empty, the bottom-up
// construction gives the square exactly K and nothing below it. So a square is done as soon as K is known.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/types.h"
#include "core/union_find.h"
#include "hierarchy/facets.h"
#include "raster/intervals.h"

namespace obscura {

/// What a look at a list says.
struct Verdict {
    std::optional<DepthInterval> common;  ///< K, when it is certain and not empty
    bool uniform = false;                 ///< it is certain that every texel's interval is K
    bool by_mesh = false;                 ///< a surface of several planes had a part in it
    float deepest = 2.0f;  ///< what begins beyond this depth has no part in any texel's interval
};

/// A surface that covers every texel of a square `weight` times.
struct Layer {
    Crossing crossing = Crossing::entry;
    int weight = 1;
    float low = 0, high = 1;                ///< bounds of its depth; exact where it has one plane
    const TriangleRecord* plane = nullptr;  ///< the plane of all its facets; null: several, or weight > 1
    std::uint32_t root = 0;                 ///< the place in the list that names its group of facets
};

/// Judges lists; keeps its working memory: one per thread.
class Judge {
  public:
    /// `longest_surface`: lists up to this long are searched for surfaces of several facets, in longer ones
    /// only single facets that cover all count: such squares are divided anyway.
    Judge(const FacetSet& set, Receivers receivers, std::size_t longest_surface)
        : set_(set), receivers_(receivers), longest_surface_(longest_surface), slot_(set.facets.size()) {}

    /// `list` from `begin` on holds every facet that place() finds for `square`, but for those beyond an
    /// earlier `deepest`. Surfaces that cover none of the texels are removed from it.
    Verdict judge(const Square& square, std::vector<Listed>& list, std::size_t begin);

  private:
    /// How the intervals of all texels come about, as far as it is the same for all.
    struct Course {
        enum Kind { uncertain, nothing, point, solid, open } kind = uncertain;
        Layer first, last;                         ///< solid: entry and exit
        std::size_t next_begin = 0, next_end = 0;  ///< open: layers that may follow it, none: nothing does
        bool exact = true;     ///< false: the order is certain, but not which surface is first or last
        float deepest = 2.0f;  ///< every texel's interval is decided by this depth
    };
    /// A set of facets that hang together within the square.
    struct Group {
        int weight = 0;  ///< how many of them cover the first texel
        float low = 2, high = 0;
        const TriangleRecord* plane = nullptr;
        bool torn = false;  ///< how often it covers a texel may change within the square
        bool one_plane = true;
    };

    void connect(const Square& square, std::span<const Listed> list);
    void gather(const Square& square, std::span<Listed> list);
    void add_to(Group& group, const Listed& l, const Square& square) const;
    Layer layer_of(const Group& group, std::uint32_t root, const Square& square, const Listed& member) const;
    bool covers_first_texel(const Listed& l, const Square& square) const;
    Course course(const Square& square);
    Course up_to_next(const Square& square);
    Course counted(const Square& square);
    bool takes_meshes(const Course& course) const;
    bool is_uniform(const Course& course) const;
    bool put_in_order(std::span<Layer> cluster, const Square& square) const;
    bool certainly_before(const Layer& p, const Layer& q, const Square& square, bool or_equal) const;
    float exit_bound() const;
    float extreme(const Layer& layer, const Square& square, std::span<const Listed> list,
                  bool greatest) const;
    std::optional<DepthInterval> common(const Course& course, const Square& square,
                                        std::span<const Listed> list) const;

    const FacetSet& set_;
    Receivers receivers_;
    std::size_t longest_surface_;
    std::vector<std::uint32_t> slot_;  ///< facet -> its place in the list, if that place holds it
    /// Of places in the list: facets that hang together; parents are roots once gathered.
    UnionFind surfaces_;
    std::vector<Group> groups_;             ///< per place that is a root
    std::vector<Layer> layers_;             ///< by least depth
    std::vector<float> uncertain_entries_;  ///< least depths of front faces that are no layer
    float least_uncertain_ = 2.0f;          ///< the same of anything that is no layer
};

/// Least or greatest depth over the texels of `square` that the facet covers; `best` if none is beyond it.
float extreme_depth(const FacetSet& set, const Facet& facet, const Square& square, bool greatest, float best);

}  // namespace obscura
