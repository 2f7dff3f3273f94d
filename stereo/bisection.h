#pragma once
// Triangles that can be cut in two along their longest edge, over and over, without leaving a T-junction.
//
// Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques", Int. J.
// Numer. Methods Eng. 20, 1984, and "New longest-edge algorithms for the refinement and/or improvement of
// unstructured triangulations", ibid. 40, 1997: before a triangle's longest edge is cut, its neighbour there
// is cut until that edge is its longest, too. Instead of two triangles, an edge may have any number; instead
// of lengths in space, lengths on the screen, and cuts in the middle of what is seen, as it is on the screen
// that changes of disparity are linear.

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "stereo/surface_points.h"
#include "stereo/triangle_pixels.h"

namespace obscura {

struct FineTriangle {
    std::uint32_t point[3] = {};   ///< index into Bisection::points
    std::uint32_t vertex[3] = {};  ///< the mesh's, or after those Bisection::vertices
    std::uint32_t edge[3] = {};    ///< from corner k to the next
    std::uint32_t source = 0;
    std::uint32_t first_pixel = 0, pixels = 0;  ///< what it shows, in Bisection::pixels
    std::uint32_t cuts = 0;
};

/// Ends are points. Uses 3 t + k, triangle and corner, form a list.
struct FineEdge {
    std::uint32_t lo = 0, hi = 0;
    std::uint32_t first_use = 0;
    double length2 = 0;   ///< of what the map and some more hold of it, pixels squared; next to 0 elsewhere
    double middle = 0.5;  ///< of that part, from lo (0) to hi (1), as shares of the way on the screen
};

/// A vertex between two others, which may lie between others in turn: a + (b - a) share.
struct MidVertex {
    std::uint32_t a = 0, b = 0, point = 0;
    float share = 0;
};

class Bisection {
  public:
    /// `mesh` must outlive it.
    Bisection(const Mesh& mesh, const MapProjection& projection, SurfacePoints surface, TrianglePixels lists);

    std::vector<SurfacePoint> points;
    std::vector<FineTriangle> triangles;
    std::vector<std::uint32_t> pixels;  ///< row * width + column of the map
    std::vector<MidVertex> vertices;
    std::vector<std::uint32_t> point_of_vertex;  ///< per vertex of the mesh

    std::span<const std::uint32_t> pixels_of(const FineTriangle& t) const {
        return {pixels.data() + t.first_pixel, t.pixels};
    }
    /// Longest edge on the map, pixels squared.
    double longest2(const FineTriangle& t) const;
    /// Whether the plane that nothing is drawn before cuts the triangle: it has no size on the screen.
    bool crosses_near(const FineTriangle& t) const;

    /// Cuts triangle t in two; as many others as that takes. One that crosses the near plane is cut there.
    /// Changed and new triangles are appended to `changed`. The new points have the changes that leave every
    /// moved surface as it was. Does nothing to triangles that repeat a corner.
    void cut(std::uint32_t t, std::vector<std::uint32_t>& changed);

  private:
    void link_edges();
    void measure(FineEdge& edge) const;
    void link(std::uint32_t use, std::uint32_t edge);
    void unlink(std::uint32_t use);
    std::uint32_t add_edge(std::uint32_t p, std::uint32_t q);
    bool longer(std::uint32_t a, std::uint32_t b) const;
    std::uint32_t longest_edge(const FineTriangle& t) const;
    std::uint32_t add_point(const FineEdge& edge, double share);
    std::uint32_t mid_vertex(const MidVertex& vertex, std::size_t first);
    std::uint32_t edge_across(std::uint32_t opposite, std::uint32_t mid, std::size_t first);
    void cut_edge(std::uint32_t edge, double share, std::vector<std::uint32_t>& changed);
    void share_pixels(FineTriangle& kept, FineTriangle& added, int from_corner);

    const Mesh& mesh_;
    const MapProjection& projection_;
    std::vector<FineEdge> edges_;
    std::vector<std::uint32_t> next_use_, last_use_;
    std::vector<std::uint32_t> scratch_;
    bool linked_ = false;
};

}  // namespace obscura
