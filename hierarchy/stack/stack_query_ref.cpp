// Lookups in a stack, one point at a time. Every sum and product is computed in the order of the kernel's,
// and the bounds of a run in the order of the single lookup's.

#include <cmath>
#include <cstring>

#include "core/scalar_lanes.h"
#include "hierarchy/stack/answered_runs.h"
#include "hierarchy/stack/stack_query.h"

namespace obscura::ref {
namespace {

/// What is the same in all maps.
struct Receiver {
    float a, b, h;           ///< place on the plane of focus, texels; height, metres
    float na, nb, nh;        ///< see StackLookup
    float steep_a, steep_b;  ///< depth per metre times na, nb
    float off;               ///< what may move its depth, before the light's angle
    float top, per_m;
    bool before_near;

    Receiver(const StackLookup& s, const StackPoints& p, std::size_t i) {
        const auto x = static_cast<double>(p.px[i]), y = static_cast<double>(p.py[i]),
                   z = static_cast<double>(p.pz[i]);
        const auto along = [&](const double(&m)[4]) {
            return static_cast<float>((m[0] * x + m[1] * y) + (m[2] * z + m[3]));
        };
        a = along(s.frame.a);
        b = along(s.frame.b);
        h = along(s.frame.h);
        const auto part = [&](const float(&m)[3]) {
            return (m[0] * p.nx[i] + m[1] * p.ny[i]) + m[2] * p.nz[i];
        };
        na = part(s.normal_a);
        nb = part(s.normal_b);
        nh = part(s.normal_h);
        top = static_cast<float>(s.frame.depth_top);
        per_m = static_cast<float>(s.frame.depth_per_m);
        steep_a = per_m * na;
        steep_b = per_m * nb;
        const float reach = (std::fabs(p.px[i]) + std::fabs(p.py[i])) + std::fabs(p.pz[i]);
        off = (stack_position_error * reach) * per_m;
        before_near = static_cast<float>(s.frame.near_h) <= h;
    }
};

/// Far off the map any place will do, as long as its number fits an integer.
float on_or_beside(float x, std::int32_t size) {
    return lane_min(lane_max(x, -8.0f), static_cast<float>(size) + 8.0f);
}

std::int32_t floor_of(float x) {
    const auto cut = static_cast<std::int32_t>(x);
    return x < static_cast<float>(cut) ? cut - 1 : cut;
}

/// Where a receiver is seen in a run of maps: a box, and bounds of its depth.
struct Seen {
    float x[2], y[2];                ///< texels, clamped
    std::int32_t ix[2], iy[2];       ///< texels that hold them
    bool inside, outside;            ///< all of it
    float nearest = 0, deepest = 0;  ///< depths that may be compared, when inside and facing
    bool facing = false, away = false;
};

Seen see(const Receiver& p, const SliceRange& range, std::int32_t size) {
    Seen s;
    const float w0 = 1.0f - range.tau[0] * p.h, w1 = 1.0f - range.tau[1] * p.h;
    const float r0 = 1.0f / w0, r1 = 1.0f / w1;
    const float r[2] = {lane_min(r0, r1), lane_max(r0, r1)};
    const auto place = [&](float at, const float(&sigma)[2], float(&to)[2], std::int32_t(&texel)[2]) {
        const float m0 = sigma[0] * p.h, m1 = sigma[1] * p.h;
        const float low = at + lane_min(m0, m1), high = at + lane_max(m0, m1);
        to[0] = on_or_beside(lane_min(low * r[0], low * r[1]), size);
        to[1] = on_or_beside(lane_max(high * r[0], high * r[1]), size);
        texel[0] = floor_of(to[0]);
        texel[1] = floor_of(to[1]);
    };
    place(p.a, range.sigma_x, s.x, s.ix);
    place(p.b, range.sigma_y, s.y, s.iy);
    s.inside = s.ix[0] >= 0 && s.iy[0] >= 0 && s.ix[1] < size && s.iy[1] < size;
    s.outside = s.ix[1] < 0 || s.iy[1] < 0 || s.ix[0] >= size || s.iy[0] >= size;
    if (!s.inside) return s;

    // D = n . l, inside the map, where x and y are not negative.
    const auto turned = [&](float n, const float(&sigma)[2], const float(&at)[2], float& low, float& high) {
        const float e0 = n * (sigma[0] + range.tau[0] * at[0]), e1 = n * (sigma[1] + range.tau[1] * at[1]);
        low = lane_min(e0, e1);
        high = lane_max(e0, e1);
    };
    float xl, xh, yl, yh;
    turned(p.na, range.sigma_x, s.x, xl, xh);
    turned(p.nb, range.sigma_y, s.y, yl, yh);
    const float d[2] = {(p.nh - xh) - yh, (p.nh - xl) - yl};
    s.away = d[1] <= 0.0f;
    s.facing = 0.0f < d[0];
    const float inv[2] = {1.0f / lane_max(d[1], stack_least_cosine),
                          1.0f / lane_max(d[0], stack_least_cosine)};

    const float g0 = p.h * r[0], g1 = p.h * r[1];
    const float near_z = p.top - p.per_m * lane_max(g0, g1), far_z = p.top - p.per_m * lane_min(g0, g1);
    float slope_x[2], slope_y[2], error[2];
    for (int k = 0; k < 2; ++k) {
        slope_x[k] = (std::fabs(p.steep_a) * r[k]) * inv[k];
        slope_y[k] = (std::fabs(p.steep_b) * r[k]) * inv[k];
        error[k] =
            (((p.off * (r[k] * r[k])) * inv[k]) + stack_snap * (slope_x[k] + slope_y[k])) + stack_depth_error;
    }
    // From the middle of a texel to a place in it are at most half a texel each way.
    s.nearest = lane_min((near_z - error[1]) - (slope_x[1] * 0.5f + slope_y[1] * 0.5f), 1.0f);
    s.deepest = lane_min(far_z - error[0], 1.0f);
    return s;
}

/// Of one map: see() of a run of one gives bounds; here is the depth itself.
float compared_depth(const Receiver& p, const SliceRange& map, const Seen& s) {
    const float r = 1.0f / (1.0f - map.tau[0] * p.h);
    const float d = (p.nh - p.na * (map.sigma_x[0] + map.tau[0] * s.x[0])) -
                    p.nb * (map.sigma_y[0] + map.tau[0] * s.y[0]);
    const float inv = 1.0f / lane_max(d, stack_least_cosine);
    const float z = p.top - p.per_m * (p.h * r);
    const float slope_x = (p.steep_a * r) * inv, slope_y = (p.steep_b * r) * inv;
    const float error = (((p.off * (r * r)) * inv) + stack_snap * (std::fabs(slope_x) + std::fabs(slope_y))) +
                        stack_depth_error;
    const float to_middle_x = (static_cast<float>(s.ix[0]) + 0.5f) - s.x[0],
                to_middle_y = (static_cast<float>(s.iy[0]) + 0.5f) - s.y[0];
    // Beyond the casters' range there is only background, at depth 1; the plane may come back from there.
    return lane_min((z - error) + lane_min(slope_x * to_middle_x + slope_y * to_middle_y, 0.0f), 1.0f);
}

/// Where a descent stands.
struct Place {
    std::uint32_t node, value;
    std::int32_t height;
    bool ended;
};

struct Header {
    std::uint32_t kinds;
    std::uint32_t offset;
};

class Octree {
  public:
    explicit Octree(const StackCode& code)
        : code_(code), wide_(code.layout == StackLayout::wide), header_words_(wide_ ? 2 : 1) {}

    Place root() const {
        const std::int32_t levels = code_.shape.levels();
        return {0, header_words_, levels, levels == 0};
    }

    Header header(std::uint32_t node) const {
        const std::uint32_t first = code_.words[node];
        return {first & 0xffffu, first >> 16 | (wide_ ? code_.words[node + 1] << 16 : 0)};
    }

    /// Child i of an inner node.
    Place child(Place at, Header header, std::uint32_t i) const {
        const std::uint32_t kind = header.kinds >> (2 * i) & 3u;
        if (kind == 0) return {at.node, at.value, at.height - 1, true};
        const std::uint32_t below = header.kinds & ((1u << (2 * i)) - 1u);
        const auto low = static_cast<std::uint32_t>(__builtin_popcount(below & 0x5555u)),
                   high = static_cast<std::uint32_t>(__builtin_popcount(below & 0xaaaau));
        const std::uint32_t node =
            at.node + header.offset * code_.offset_scale[at.height] + low + (wide_ ? 2 * high : high);
        const bool inner = (kind & 2u) != 0;
        const std::uint32_t value = node + (inner ? header_words_ : 0);
        return {node, (kind & 1u) != 0 ? value : at.value, at.height - 1, !inner};
    }

    float value(Place at) const {
        float depth;
        std::memcpy(&depth, code_.words + at.value, sizeof depth);
        return depth;
    }

    const StackShape& shape() const { return code_.shape; }

  private:
    const StackCode& code_;
    bool wide_;
    std::uint32_t header_words_;
};

/// Where the lit samples of a point are counted.
struct Tally {
    std::uint16_t* lit = nullptr;
    std::size_t stride = 0;
    int exponent = 0;

    std::uint16_t& part(std::int32_t map) const {
        return lit[static_cast<std::size_t>(map >> exponent) * stride];
    }
    /// Samples [first, first + maps), all lit or all dark.
    void answer(std::int32_t first, std::int32_t maps, bool is_lit) const {
        while (is_lit && maps > 0) {
            const std::int32_t end = ((first >> exponent) + 1) << exponent,
                               here = first + maps < end ? maps : end - first;
            part(first) = static_cast<std::uint16_t>(part(first) + here);
            first += here;
            maps -= here;
        }
    }
};

/// The answers themselves.
struct Answers {
    std::vector<AnsweredRun>& runs;
    void answer(std::int32_t first, std::int32_t maps, bool is_lit) const {
        runs.push_back({first, maps, is_lit});
    }
};

class Query {
  public:
    Query(const StackLookup& stack, StackWork& work)
        : stack_(stack), octree_(stack.code), size_(1 << stack.code.shape.map_levels), work_(work) {}

    /// All maps of point i.
    template <class To>
    void all(const StackPoints& points, std::size_t i, const To& to) {
        const Receiver p(stack_, points, i);
        if (p.before_near) return to.answer(0, stack_.slices, true);
        run(p, 1, stack_.code.shape.slice_levels, octree_.root(), to);
    }

    int subset(const StackPoints& points, std::size_t i, int samples) {
        const Receiver p(stack_, points, i);
        if (p.before_near) return samples;
        int lit = 0;
        for (int j = 0; j < samples; ++j)
            lit += single(p, subset_slice(stack_.slices, samples, j, points.pattern[i]));
        return lit;
    }

  private:
    int single(const Receiver& p, std::int32_t k) {
        ++work_.lookups;
        const SliceRange& map = stack_.ranges[(std::int32_t{1} << stack_.code.shape.slice_levels) + k];
        const Seen s = see(p, map, size_);
        if (!s.inside) return 1;
        if (!s.facing) return 0;
        Place at = octree_.root();
        while (!at.ended && at.height > 0)
            step(at, s, k, k);
        return compared_depth(p, map, s) <= octree_.value(at) ? 1 : 0;
    }

    /// Run i of 2^exponent maps; the descent of the run that it is half of stands at `at`.
    template <class To>
    void run(const Receiver& p, std::int32_t i, int exponent, Place at, const To& to) {
        const std::int32_t first = (i << exponent) - (std::int32_t{1} << stack_.code.shape.slice_levels);
        std::int32_t maps = stack_.slices - first;
        if (maps <= 0) return;
        const std::int32_t length = std::int32_t{1} << exponent;
        if (maps > length) maps = length;
        ++work_.lookups;
        const SliceRange& range = stack_.ranges[i];
        const Seen s = see(p, range, size_);
        if (s.outside) return to.answer(first, maps, true);
        if (s.inside && s.away) return to.answer(first, maps, false);
        if (s.inside) {
            while (!at.ended && at.height > 0 && step(at, s, first, first + length - 1)) {
            }
            if (at.ended && s.facing) {
                const float value = octree_.value(at);
                if (exponent == 0) return to.answer(first, maps, compared_depth(p, range, s) <= value);
                if (s.deepest <= value) return to.answer(first, maps, true);
                if (value < s.nearest) return to.answer(first, maps, false);
            }
        }
        run(p, 2 * i, exponent - 1, at, to);
        run(p, 2 * i + 1, exponent - 1, at, to);
    }

    /// Looks at the children that hold a part of the box in maps [first, last]. True when the descent went
    /// on: to the only one, or because there are none, so that the value holds for all.
    bool step(Place& at, const Seen& s, std::int32_t first, std::int32_t last) {
        ++work_.nodes;
        const Header header = octree_.header(at.node);
        const StackShape& shape = octree_.shape();
        const int height = at.height - 1;
        const std::uint32_t x = halves(s.ix[0], s.ix[1], height - shape.map_start()),
                            y = halves(s.iy[0], s.iy[1], height - shape.map_start()),
                            k = halves(first, last, height - shape.slice_start());
        // One bit for each child: x in pairs of bits, y in pairs of these, k in pairs of those.
        const std::uint32_t xy = ((y & 1u) != 0 ? x : 0u) | ((y & 2u) != 0 ? x << 2 : 0u);
        const std::uint32_t children = ((k & 1u) != 0 ? xy : 0u) | ((k & 2u) != 0 ? xy << 4 : 0u);
        std::uint32_t kinds = 0;
        for (int i = 0; i < 8; ++i)
            kinds |= (children >> i & 1u) != 0 ? header.kinds & 3u << (2 * i) : 0u;
        if (kinds == 0) {
            at.ended = true;
            return true;
        }
        if ((children & (children - 1u)) != 0) return false;
        at = octree_.child(at, header, static_cast<std::uint32_t>(__builtin_ctz(children)));
        return true;
    }

    /// Which halves of a node [low, high] meets, along an axis whose bit `bit` tells them apart: 1 the first,
    /// 2 the second, 3 both. No such bit: the axis is not divided, all of it is the first half.
    static std::uint32_t halves(std::int32_t low, std::int32_t high, int bit) {
        if (bit < 0) return 1;
        const bool in_second_low = (low >> bit & 1) != 0, in_second_high = (high >> bit & 1) != 0;
        return in_second_low == in_second_high ? (in_second_low ? 2 : 1) : 3;
    }

    const StackLookup& stack_;
    Octree octree_;
    std::int32_t size_;
    StackWork& work_;
};

}  // namespace

void lit_samples(const StackLookup& stack, const StackPoints& points, std::uint16_t* lit,
                 StackWork& work) noexcept {
    lit_of_parts(stack, points, 1, lit, work);
}

void lit_of_parts(const StackLookup& stack, const StackPoints& points, std::int32_t parts, std::uint16_t* lit,
                  StackWork& work) noexcept {
    Query query(stack, work);
    int exponent = stack.code.shape.slice_levels;
    for (std::int32_t of = parts; of > 1; of /= 2)
        --exponent;
    for (std::size_t i = 0; i < points.count; ++i) {
        const Tally tally{lit + i, points.count, exponent};
        for (std::int32_t first = 0; first < std::int32_t{1} << stack.code.shape.slice_levels;
             first += std::int32_t{1} << exponent)
            tally.part(first) = 0;
        query.all(points, i, tally);
    }
}

std::vector<AnsweredRun> answered_runs(const StackLookup& stack, const StackPoints& points, std::size_t i,
                                       StackWork& work) {
    std::vector<AnsweredRun> runs;
    Query(stack, work).all(points, i, Answers{runs});
    return runs;
}

void lit_of_subset(const StackLookup& stack, const StackPoints& points, int samples, std::uint16_t* lit,
                   StackWork& work) noexcept {
    Query query(stack, work);
    for (std::size_t i = 0; i < points.count; ++i)
        lit[i] = static_cast<std::uint16_t>(query.subset(points, i, samples));
}

}  // namespace obscura::ref
