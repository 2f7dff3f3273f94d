#include "hierarchy/facet/plane_set.h"

#include <cstring>
#include <unordered_map>

#include "core/hash.h"

namespace obscura {
namespace {

struct PlaneHash {
    std::size_t operator()(const FacetPlane& p) const {
        std::uint64_t words[4], h = 0;
        std::memcpy(words, &p, sizeof words);
        for (const std::uint64_t w : words)
            h = (h ^ w) * 0x9e3779b97f4a7c15ull + (h >> 29);
        return static_cast<std::size_t>(h ^ h >> 32);
    }
};

std::int64_t floor_of_256th(std::int64_t a) {
    return a >> subtexel_bits;
}

}  // namespace

PlaneSet planes_of(const FacetSet& facets) {
    PlaneSet set;
    set.facets = &facets;
    std::unordered_map<FacetPlane, std::uint32_t, PlaneHash> number;
    constexpr double steepest = 0x1p40;
    for (const Facet& f : facets.facets) {
        const TriangleRecord& t = facets.plane(f);
        const FacetPlane plane{t.a + 0.0, t.b + 0.0, t.c + 0.0, t.zmin, t.zmax};
        const auto bounded = [](double v) { return v >= -steepest && v <= steepest; };
        if (!bounded(plane.a) || !bounded(plane.b) || !bounded(plane.c) || !(plane.zmin >= 0) ||
            !(plane.zmax <= 1)) {
            set.plane_of.push_back(no_plane);
            continue;
        }
        const auto [place, is_new] = number.try_emplace(plane, static_cast<std::uint32_t>(set.planes.size()));
        if (is_new && set.planes.size() == facet_most_planes) {
            number.erase(place);
            set.plane_of.push_back(no_plane);
            continue;
        }
        if (is_new) set.planes.push_back(plane);
        set.plane_of.push_back(place->second);
    }
    return set;
}

Line line_of(const FacetSet& set, const Facet& facet, int k) {
    const EdgeFunction e = set.edge(facet, k);
    // E at centres 256 x + 128 is 256 (A x + B y) and a rest; whole 256ths decide its sign.
    const std::int64_t c = floor_of_256th(e.C + 128 * (e.A + e.B));
    Line line;
    line.inside_high = e.A > 0 || (e.A == 0 && e.B > 0);
    const std::int64_t s = line.inside_high ? 1 : -1;
    line.edge.a = static_cast<std::int32_t>(s * e.A);
    line.edge.b = static_cast<std::int32_t>(s * e.B);
    // Outside is where the form is negative, at most -1.
    line.edge.c = static_cast<double>(line.inside_high ? c : -c - 1);
    return line;
}

}  // namespace obscura
