// The nearest triangle before samples, bunches of sixteen neighbours on the light's grid. See
// exact_nearest_ref.cpp for the meaning of each step.

#include "raster/depth_tile.h"
#include "raster/exact/exact_bunch.h"
#include "raster/exact/exact_chunks.h"
#include "raster/exact/exact_nearby.h"
#include "raster/exact/exact_nearest.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// What is known to stand before a bunch.
struct Before {
    alignas(64) double distance[16];
    std::uint32_t triangle[16];
    float z_floor;  ///< what has no depth above it is nearer to the light than all that
};

OBSCURA_INLINE void reset(Before& before) {
    for (int k = 0; k < lanes; ++k) {
        before.distance[k] = __builtin_inf();
        before.triangle[k] = no_triangle;
    }
    before.z_floor = -__builtin_inff();
}

/// What was found before one point.
OBSCURA_INLINE void answer(std::uint32_t point, const Before& before, int k, std::uint32_t* lit,
                           const ExactHits& hits) {
    if (before.triangle[k] == no_triangle) return;
    hits.triangle[point] = before.triangle[k];
    hits.distance_m[point] = static_cast<float>(before.distance[k]);
    lit[point / 16] &= ~(1u << (point % 16));
}

/// The least depth that a triangle must reach to be nearer to some open lane than what is known.
OBSCURA_INLINE float floor_of(const ExactView& view, const Bunch& s, const Before& before) {
    double floor = __builtin_inf();
    for (std::uint32_t left = s.open; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        // Less what rounding may take, of large terms too.
        const double deep = static_cast<double>(s.z[k]), nearer = before.distance[k] / view.depth_m;
        const double z = (deep - nearer) - 0x1p-50 * ((deep < 0 ? -deep : deep) + nearer);
        floor = z < floor ? z : floor;
    }
    // Less a rounding to float, and more than all of doubles.
    return static_cast<float>(floor - 0x1p-22 * (floor < 0 ? -floor : floor) - 0x1p-40);
}

/// Takes the triangle for those lanes of the bunch that it darkens and that it is nearer to.
OBSCURA_INLINE void consider(const CasterTriangle& t, const CasterBoxes& boxes, int child,
                             const ExactPoints& points, const ExactLight& light, const ExactView& view,
                             Bunch& s, Before& before) {
    // Planes first: most triangles lie farther off than what is known.
    const F64 height =
        (splat(t.n[0]) * load(s.px) + splat(t.n[1]) * load(s.py)) + (splat(t.n[2]) * load(s.pz) + splat(t.d));
    const F64 along = (splat(0.0) - height) / splat(exact_cosine(t, light));
    const F64 least =
        (to_f64(load(s.z)) - splat(static_cast<double>(boxes.z_high[child]))) * splat(view.depth_m);
    const F64 distance = max(along, least);
    const std::uint32_t all = s.open;
    s.open = all & bits(greater_equal(load(before.distance), distance));
    std::uint32_t dark = s.open == 0 ? 0 : darkened(t, boxes.z_low[child], points, light, s);
    s.open = all;
    if (dark == 0) return;
    alignas(64) double d[16];
    store(d, distance);
    for (; dark != 0; dark &= dark - 1) {
        const int k = __builtin_ctz(dark);
        if (!exact_is_nearer(d[k], t.triangle, before.distance[k], before.triangle[k])) continue;
        before.distance[k] = d[k];
        before.triangle[k] = t.triangle;
    }
    before.z_floor = floor_of(view, s, before);
}

/// What is near some bunches, about the deepest first.
class Deepest {
  public:
    static constexpr int room = 4096;

    struct Found {
        const CasterBoxes* boxes;
        std::uint32_t index;  ///< of the triangle: child index % 16 of the boxes
        float z_high;
    };

    /// How much overlaps e; room + 1 when there is no room for all of it.
    int collect(const ExactView& view, const Extent& e, int most_found, ExactCounts& counts) {
        count_ = 0;
        float low = __builtin_inff(), high = -__builtin_inff();
        bool fits = true;
        walk(view, e, counts.groups, [&](const CasterBoxes& boxes, std::uint32_t first, int k) {
            fits = count_ < most_found;
            if (!fits) return false;
            const float z = boxes.z_high[k];
            low = least(low, z);
            high = most(high, z);
            found_[count_++] = {&boxes, first + static_cast<std::uint32_t>(k), z};
            return true;
        });
        if (!fits) return room + 1;
        sort(low, high);
        return count_;
    }
    const Found& operator[](int i) const { return found_[order_[i]]; }
    /// Nothing from place i on, a multiple of sixteen, is deeper.
    float deepest_from(int i) const { return deepest_[i / 16]; }

  private:
    /// By slices of depth, and in a slice as they were found.
    void sort(float low, float high) {
        constexpr int slices = 64;
        const float scale = high > low ? (slices - 1) / (high - low) : 0.0f;
        const auto slice = [&](float z) { return slices - 1 - static_cast<int>((z - low) * scale); };
        int next[slices + 1] = {};
        for (int i = 0; i < count_; ++i)
            ++next[slice(found_[i].z_high) + 1];
        for (int b = 0; b < slices; ++b)
            next[b + 1] += next[b];
        for (int i = 0; i < count_; ++i)
            order_[next[slice(found_[i].z_high)]++] = static_cast<std::uint16_t>(i);
        float deepest = -__builtin_inff();
        for (int i = count_ - 1; i >= 0; --i) {
            deepest = most(deepest, found_[order_[i]].z_high);
            if (i % 16 == 0) deepest_[i / 16] = deepest;
        }
    }

    Found found_[room];
    std::uint16_t order_[room];
    float deepest_[room / 16];
    int count_ = 0;
};

/// A part of a bunch's samples that may have some of what was collected before them.
class Search {
  public:
    Search(const ExactPoints& points, const ExactLight& light, const ExactView& view, ExactCounts& counts)
        : points_(points), light_(light), view_(view), counts_(counts) {}

    /// The nearest before each open lane of `n` bunches.
    void run(Bunch* bunch, Before* before, int n) {
        // Halves, until what is near has room.
        int found =
            deepest_.collect(view_, extent_of(bunch, n), n == 1 ? Deepest::room : Nearby::room, counts_);
        while (n > 1 && found > Nearby::room) {
            run(bunch, before, n / 2);
            bunch += n / 2;
            before += n / 2;
            n -= n / 2;
            found =
                deepest_.collect(view_, extent_of(bunch, n), n == 1 ? Deepest::room : Nearby::room, counts_);
        }
        if (found <= Nearby::room) {
            put_nearby(found);
            for (int b = 0; b < n; ++b)
                take_nearby(bunch[b], before[b]);
        } else if (found <= Deepest::room) {
            take_found(found, *bunch, *before);
        } else {
            take_all(*bunch, *before);
        }
    }

    /// The same where few are near all of them; else false, and nothing done.
    bool run_if_few(Bunch* bunch, Before* before, int n) {
        const int found = deepest_.collect(view_, extent_of(bunch, n), Nearby::room, counts_);
        if (found > Nearby::room) return false;
        put_nearby(found);
        for (int b = 0; b < n; ++b)
            take_nearby(bunch[b], before[b]);
        return true;
    }

  private:
    static Extent extent_of(const Bunch* bunch, int n) {
        Extent all = bunch[0].extent;
        for (int b = 1; b < n; ++b)
            all = united(all, bunch[b].extent);
        return all;
    }

    void put_nearby(int found) {
        nearby_.count = 0;
        for (int i = 0; i < found; ++i) {
            const Deepest::Found& f = deepest_[i];
            nearby_.add(view_.triangles[f.index], light_, *f.boxes, f.index, static_cast<int>(f.index % 16));
        }
        nearby_.close();
    }

    void take_nearby(Bunch& s, Before& before) {
        std::uint32_t near = overlapping(nearby_.around, s.extent);
        ++counts_.groups;
        for (; near != 0; near &= near - 1) {
            const int g = __builtin_ctz(near);
            if (deepest_.deepest_from(16 * g) < before.z_floor) return;
            ++counts_.groups;
            const CasterBoxes& boxes = nearby_.boxes[g];
            for (std::uint32_t may = nearby_.may_darken(16 * g, s); may != 0; may &= may - 1) {
                const int k = __builtin_ctz(may);
                if (boxes.z_high[k] < before.z_floor) continue;
                take(nearby_.triangle[16 * g + k], boxes, k, s, before);
            }
        }
    }

    void take_found(int found, Bunch& s, Before& before) {
        for (int i = 0; i < found; ++i) {
            if (i % 16 == 0 && deepest_.deepest_from(i) < before.z_floor) return;
            const Deepest::Found& f = deepest_[i];
            if (f.z_high >= before.z_floor)
                take(f.index, *f.boxes, static_cast<int>(f.index % 16), s, before);
        }
    }

    void take_all(Bunch& s, Before& before) {
        walk(view_, s.extent, counts_.groups, [&](const CasterBoxes& boxes, std::uint32_t first, int k) {
            if (boxes.z_high[k] >= before.z_floor)
                take(first + static_cast<std::uint32_t>(k), boxes, k, s, before);
            return true;
        });
    }

    OBSCURA_INLINE void take(std::uint32_t index, const CasterBoxes& boxes, int child, Bunch& s,
                             Before& before) {
        ++counts_.triangles;
        consider(view_.triangles[index], boxes, child, points_, light_, view_, s, before);
    }

    const ExactPoints& points_;
    const ExactLight& light_;
    const ExactView& view_;
    ExactCounts& counts_;
    Deepest deepest_;
    Nearby nearby_;
};

}  // namespace

void exact_locate_nearest(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,
                          std::uint32_t* lit, const ExactHits& hits, ExactCounts& counts) noexcept {
    Before before[bunches];
    locate_chunks(points, light, samples, lit,
                  [&](const ExactView& view, std::int32_t v, Bunch* bunch, int n) {
                      for (int b = 0; b < n; ++b)
                          reset(before[b]);
                      if (!Search(points, light, view, counts).run_if_few(bunch, before, n)) {
                          for (int b = 0; b < n; ++b)
                              append(bunch[b], v, samples);
                          return;
                      }
                      for (int b = 0; b < n; ++b) {
                          counts.samples += __builtin_popcount(bunch[b].open);
                          for (std::uint32_t left = bunch[b].open; left != 0; left &= left - 1) {
                              const int k = __builtin_ctz(left);
                              answer(static_cast<std::uint32_t>(bunch[b].point[k]), before[b], k, lit, hits);
                          }
                      }
                  });
}

void exact_nearest(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples,
                   const std::uint32_t* order, std::uint32_t* lit, const ExactHits& hits,
                   ExactCounts& counts) noexcept {
    Bunch bunch[bunches];
    Before before[bunches];
    std::int32_t next = 0;
    while (next < samples.count) {
        std::int32_t at = next;
        const std::uint8_t view = samples.view[order[next]];
        const int n = gather_bunches(points, light, samples, order, next, bunch);
        for (int b = 0; b < n; ++b)
            reset(before[b]);
        Search(points, light, light.view[view], counts).run(bunch, before, n);
        for (int i = 0; at < next; ++i, ++at)
            answer(samples.point[order[at]], before[i / lanes], i % lanes, lit, hits);
    }
    counts.samples += samples.count;
}

}  // namespace obscura::OBSCURA_ISA
