// All crossings of a tile, sixteen samples at a time. See layer_ref.cpp for what it computes.

#include "core/simd.h"
#include "raster/layer_tile.h"
#include "raster/tile_walk.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Order of (key, triangle) pairs.
OBSCURA_INLINE Mask pair_less(const I32& key, const I32& id, const I32& other_key, const I32& other_id) {
    // Triangle indices are unsigned; moving them to the signed range keeps their order.
    const I32 flip = splat(INT32_MIN);
    return less(key, other_key) | (equal(key, other_key) & less(id ^ flip, other_id ^ flip));
}

constexpr std::int32_t few_layers = 6;

template <bool with_triangles>
struct Insertion {
    LayerStack& stack;
    I32 crossing, id;

    /// Adds a layer to a row; a full row moves to twice the room. Null when there is none left.
    LayerKey* add_layer(std::int32_t row) {
        if (stack.filled[row] == stack.room[row]) {
            const std::int32_t room = 2 * stack.room[row];
            if (stack.used + room > stack.capacity) return nullptr;
            const std::int32_t from = stack.place(row, 0), to = stack.used * lanes;
            for (std::int32_t i = 0; i < stack.filled[row] * lanes; i += lanes) {
                store(stack.keys + to + i, load(stack.keys + from + i));
                if constexpr (with_triangles)
                    store(stack.triangles + to + i, load(stack.triangles + from + i));
            }
            stack.first[row] = stack.used;
            stack.room[row] = room;
            stack.used += room;
        }
        return stack.keys + stack.place(row, stack.filled[row]++);
    }

    /// Keeps the nearer of key and layer in the layer; the farther goes on.
    OBSCURA_INLINE void sink(LayerKey* place, I32& key, I32& ids) {
        const I32 old = load(place);
        if constexpr (with_triangles) {
            const I32 old_ids = load(id_place(place));
            const Mask before = pair_less(key, ids, old, old_ids);
            store(place, select(before, key, old));
            store(id_place(place), select(before, ids, old_ids));
            key = select(before, old, key);
            ids = select(before, old_ids, ids);
        } else {
            store(place, min(key, old));
            key = max(key, old);
        }
    }

    /// The other way round, from below: what is deeper than the key moves one layer down, until nothing is.
    OBSCURA_INLINE LayerKey* slide(LayerKey* place, const LayerKey* top, I32& key, I32& ids) {
        for (; place != top; place -= lanes) {
            const I32 above = load(place - lanes);
            if constexpr (with_triangles) {
                const I32 above_ids = load(id_place(place - lanes));
                const Mask before = pair_less(key, ids, above, above_ids);
                if (none(before)) break;
                store(place, select(before, above, key));
                store(id_place(place), select(before, above_ids, ids));
                key = select(before, key, above);
                ids = select(before, ids, above_ids);
            } else {
                if (none(less(key, above))) break;
                store(place, max(above, key));
                key = min(above, key);
            }
        }
        return place;
    }

    /// Sorts sixteen keys (no_layer where there is none) into the layers at `at`.
    OBSCURA_INLINE void insert(std::int32_t at, I32 key) {
        const std::int32_t row = at / lanes, filled = stack.filled[row];
        const I32 nothing = splat(no_layer);
        I32 ids = id;
        LayerKey* place = stack.keys + stack.place(row, 0);
        // Few layers: all of them, without asking, costs less than a branch that is often guessed wrong.
        if (filled <= few_layers) {
            for (std::int32_t l = 0; l < filled; ++l, place += lanes)
                sink(place, key, ids);
            if (none(less(key, nothing))) return;
            place = add_layer(row);
        } else {
            // Many: from below, since triangles of one surface follow each other and what comes later tends
            // to lie deeper. A new layer is needed where a key comes to a lane whose last place is taken;
            // without one, the lanes that get nothing keep what they have in the last layer.
            LayerKey* const last_place = place + (filled - 1) * lanes;
            const I32 last = load(last_place);
            if (any(less(key, nothing) & less(last, nothing))) {
                place = add_layer(row);
            } else {
                place = last_place;
                if constexpr (with_triangles) ids = select(less(key, nothing), ids, load(id_place(place)));
                key = min(key, last);
            }
            if (place != nullptr) place = slide(place, stack.keys + stack.place(row, 0), key, ids);
        }
        if (place == nullptr) {
            stack.overflow = true;
            return;
        }
        store(place, key);
        if constexpr (with_triangles) store(id_place(place), ids);
    }

    OBSCURA_INLINE std::int32_t* id_place(const LayerKey* place) const {
        return stack.triangles + (place - stack.keys);
    }
    OBSCURA_INLINE I32 key_of(const F32& z) const {
        return (shift_left<2>(bitcast_i32(z)) | crossing) ^ splat(INT32_MIN);
    }
    /// Every crossing counts, however deep.
    OBSCURA_INLINE bool hidden(const TriangleRecord&, const SampleBox&) const { return false; }
    OBSCURA_INLINE void covered(std::int32_t at, const F32& z) { insert(at, key_of(z)); }
    OBSCURA_INLINE void partial(std::int32_t at, const Mask& inside, const F32& z) {
        if (any(inside)) insert(at, select(inside, key_of(z), splat(no_layer)));
    }
};

template <bool with_triangles>
void insert_all(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                const TileRect& tile, LayerStack& stack) {
    const std::int32_t rows = tile.width * tile.height / lanes;
    for (std::int32_t r = 0; r < rows; ++r) {
        stack.first[r] = r * layers_in_place;
        stack.room[r] = layers_in_place;
        stack.filled[r] = 0;
    }
    stack.used = rows * layers_in_place;
    stack.overflow = false;
    Insertion<with_triangles> insertion{stack, splat(std::int32_t{0}), splat(std::int32_t{0})};
    for_each_listed(records, list, count, [&](const TriangleRecord& t) {
        insertion.crossing = splat(static_cast<std::int32_t>(t.crossing));
        insertion.id = splat(static_cast<std::int32_t>(t.triangle));
        walk_triangle(t, tile, insertion);
    });
}

struct Layer16 {
    Mask present;
    F32 depth;
    I32 depth_bits, kind;
};

OBSCURA_INLINE Layer16 layer_of(const I32& key) {
    const I32 code = key ^ splat(INT32_MIN);
    // Logical shift of the unsigned code; the result is below 2^30.
    const I32 depth_bits = shift_right<2>(code) & splat(0x3fffffff);
    return {~equal(key, splat(no_layer)), bitcast_f32(depth_bits), depth_bits, code & splat(3)};
}

/// The intervals of sixteen rays in the making. All lanes of a row walk the layers together.
struct Intervals16 {
    F32 entry = splat(1.0f), exit = splat(1.0f);
    Mask active = equal(splat(std::int32_t{0}), splat(std::int32_t{0}));  ///< not yet decided
    Mask met = ~active;                                                   ///< has met a surface
};

/// From the first surface up to the next deeper one.
struct UpToNext : Intervals16 {
    OBSCURA_INLINE void step(const I32& key) {
        const Layer16 layer = layer_of(key);
        entry = select(layer.present & ~met, layer.depth, entry);
        met = met | layer.present;
        const Mask arrived = active & layer.present & less(entry, layer.depth);
        exit = select(arrived, bitcast_f32(layer.depth_bits - splat(1)), exit);
        active = active & ~arrived;
    }
    OBSCURA_INLINE void finish() {}
};

/// The counter of intervals.h.
struct Counter : Intervals16 {
    I32 inside = splat(std::int32_t{0});

    OBSCURA_INLINE void decide(const Mask& lanes_, const F32& last) {
        exit = select(lanes_, last, exit);
        active = active & ~lanes_;
    }
    OBSCURA_INLINE void step(const I32& key) {
        const Layer16 layer = layer_of(key);
        const Mask now = active & layer.present;
        const Mask is_entry = equal(layer.kind, splat(static_cast<std::int32_t>(Crossing::entry)));
        const Mask is_exit = equal(layer.kind, splat(static_cast<std::int32_t>(Crossing::exit)));
        const Mask first = now & ~met;
        entry = select(first, layer.depth, entry);
        met = met | layer.present;
        decide(first & ~is_entry, layer.depth);
        const Mask counts = now & ~(first & ~is_entry);
        inside = inside + select(counts & is_entry, splat(1), splat(std::int32_t{0})) -
                 select(counts & is_exit, splat(1), splat(std::int32_t{0}));
        decide(counts & is_exit & equal(inside, splat(std::int32_t{0})), layer.depth);
    }
    /// Counters that never closed are surfaces.
    OBSCURA_INLINE void finish() { decide(active & met, entry); }
};

template <class Rule>
OBSCURA_INLINE void intervals_of(const LayerStack& stack, std::int32_t row, DepthInterval* out) {
    Rule rule;
    for (std::int32_t l = 0; l < stack.filled[row] && any(rule.active); ++l)
        rule.step(load(stack.keys + stack.place(row, l)));
    rule.finish();
    store_interleaved(&out->entry, rule.entry, rule.exit);
}

}  // namespace

void layer_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                const TileRect& tile, LayerStack& stack) noexcept {
    insert_all<false>(records, list, count, tile, stack);
}

void layer_tile_with_triangles(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                               const TileRect& tile, LayerStack& stack) noexcept {
    insert_all<true>(records, list, count, tile, stack);
}

void interval_tile(const LayerStack& stack, const TileRect& tile, bool static_receivers,
                   DepthInterval* out) noexcept {
    for (std::int32_t at = 0; at < tile.width * tile.height; at += lanes) {
        const std::int32_t row = at / lanes;
        if (stack.filled[row] == 0) {
            store_interleaved(&out[at].entry, splat(1.0f), splat(1.0f));
            continue;
        }
        if (static_receivers) {
            intervals_of<UpToNext>(stack, row, out + at);
        } else {
            intervals_of<Counter>(stack, row, out + at);
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
