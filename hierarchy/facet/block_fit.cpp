#include "hierarchy/facet/block_fit.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

/// Calls f(texel) until it is false for one.
template <class F>
bool for_all(std::uint64_t texels, F&& f) {
    for (; texels != 0; texels &= texels - 1) {
        if (!f(std::countr_zero(texels))) return false;
    }
    return true;
}

float rounded_up(double a) {
    const auto f = static_cast<float>(a);
    return static_cast<double>(f) < a ? std::nextafterf(f, 2.0f) : f;
}

std::uint64_t texels_of(int first, int height) {
    CHECK(height >= 0 && height <= 3);
    const int count = 1 << (2 * height);
    return (count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1) << first;
}

}  // namespace

/// Whether a plane comes first at some texel; then its depths are kept.
bool BlockFit::is_seen(std::uint32_t plane, int count) {
    if (plane == no_plane) return false;
    if (std::any_of(depths_.begin(), depths_.end(), [&](const PlaneDepths& d) { return d.plane == plane; }))
        return true;
    if (depths_.size() == most_planes) return false;
    PlaneDepths& d = depths_.emplace_back();
    d.plane = plane;
    bool seen = false;
    for (int i = 0; i < count; ++i) {
        d.z[i] =
            facet_plane_depth(planes_.planes[plane], square_.x0 + block_column(i), square_.y0 + block_row(i));
        seen = seen || d.z[i] == entry_[i];
    }
    if (!seen) depths_.pop_back();
    return seen;
}

void BlockFit::load(const Square& square, std::span<const Listed> list, const float* entry,
                    const float* exit) {
    square_ = square;
    entry_ = entry;
    exit_ = exit;
    const int count = square.side * square.side;
    // Where there is nothing between before and behind, there is nothing to keep away from.
    for (int i = 0; i < count; ++i)
        need_[i] = std::min(least_offset, (exit[i] - entry[i]) * 0.0625f);
    depths_.clear();
    edges_.clear();
    const FacetSet& set = *planes_.facets;
    for (const Listed& l : list) {
        if (!is_seen(planes_.plane_of[l.facet], count)) continue;
        const Facet& f = set.facets[l.facet];
        for (int k = 0; k < f.edges && edges_.size() < most_edges; ++k) {
            if ((l.crossed >> k & 1u) == 0 || !edge_meets(set, f, k, square)) continue;
            const FacetEdge edge = line_of(set, f, k).edge;
            if (std::any_of(edges_.begin(), edges_.end(),
                            [&](const EdgeTexels& e) { return e.edge == edge; }))
                continue;
            EdgeTexels& e = edges_.emplace_back();
            e.edge = edge;
            for (int i = 0; i < count; ++i) {
                const double d = facet_distance(edge, square.x0 + block_column(i), square.y0 + block_row(i));
                e.high |= static_cast<Texels>(d >= 0) << i;
            }
        }
    }
}

Acceptable BlockFit::acceptable(Texels texels) const {
    Acceptable a;
    a.depths = {0.0f, 1.0f};
    for_all(texels, [&](int i) {
        a.depths = common_depths(a.depths, {entry_[i], exit_[i]});
        return has_depth(a.depths);
    });
    // The plane that comes first everywhere, else one that lies between before and behind when it is moved.
    for (const bool exactly : {true, false}) {
        for (const PlaneDepths& d : depths_) {
            float need = 0, room = 1;
            const bool fits = for_all(texels, [&](int i) {
                if (exactly && d.z[i] != entry_[i]) return false;
                need = std::max(need, rounded_up(double{entry_[i]} - double{d.z[i]} + double{need_[i]}));
                room = std::min(room, -rounded_up(double{d.z[i]} - double{exit_[i]} + double{need_[i]}));
                return room >= need;
            });
            if (!fits || !offset_between(need, room)) continue;
            // A ramp would leave texels without the offset that they need.
            if (!exactly) a.flattest = no_ramp_needed;
            a.plane = d.plane;
            a.need = need;
            a.room = room;
            return a;
        }
    }
    return a;
}

Acceptable BlockFit::ramped(Texels texels, const EdgeTexels& edge, bool high) const {
    const double start = facet_ramp_start(edge.edge);
    const auto beyond = [&](int i) {
        const double d = facet_distance(edge.edge, square_.x0 + block_column(i), square_.y0 + block_row(i));
        return (high ? d : -d) - start;
    };
    for (const PlaneDepths& d : depths_) {
        double most = 0x1p60, far = 0, steepest = 0;
        const bool fits = for_all(texels, [&](int i) {
            if (d.z[i] < entry_[i] || d.z[i] > exit_[i]) return false;
            const double b = beyond(i), room = double{exit_[i]} - double{d.z[i]};
            if (b > 0) most = std::min(most, room / (2 * b));
            if (b > far) {
                far = b;
                steepest = room / b;
            }
            return most > 0;
        });
        if (!fits || far == 0) continue;
        const Acceptable ramp = with_ramp(d.plane, 0.5f, most, steepest / 64);
        if (!ramp.empty()) return ramp;
    }
    return {};
}

bool BlockFit::by_edge(Texels texels, FacetPart& part) const {
    for (const EdgeTexels& e : edges_) {
        const Texels high = texels & e.high, low = texels & ~e.high;
        if (high == 0 || low == 0) continue;
        Acceptable a = acceptable(low);
        if (!a.takes_plane()) take_plane(a, ramped(low, e, false));
        if (a.empty()) continue;
        Acceptable b = acceptable(high);
        if (!b.takes_plane()) take_plane(b, ramped(high, e, true));
        if (b.empty()) continue;
        part.value[0] = a;
        part.value[1] = b;
        part.has_edge = true;
        part.edge = e.edge;
        return true;
    }
    return false;
}

FacetPart BlockFit::part(int first, const Square& square, bool as_root, FacetBuilder& builder) {
    const int height = std::countr_zero(static_cast<unsigned>(square.side));
    const Texels texels = texels_of(first, height);
    const Acceptable a = acceptable(texels);
    if (!a.empty()) return FacetPart::of(a);
    FacetPart with_edge;
    if (!as_root && by_edge(texels, with_edge)) return with_edge;
    const int quarter = 1 << (2 * (height - 1));
    FacetPart child[4];
    for (int i = 0; i < 4; ++i)
        child[i] = part(first + i * quarter, square.child(i), false, builder);
    return builder.join(child, square, as_root);
}

FacetPart BlockFit::fit(const Square& square, std::span<const Listed> list, const float* entry,
                        const float* exit, bool as_root, FacetBuilder& builder) {
    load(square, list, entry, exit);
    return part(0, square, as_root, builder);
}

}  // namespace obscura
