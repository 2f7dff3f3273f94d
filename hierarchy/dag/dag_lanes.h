#pragma once
// A step of sixteen descents through a tree of the code dag. Kernel files only; the meaning is
// DagCode::child() in hierarchy/dag/dag_step.h.
//
// Lanes are lazy where the scalar step is not: of a treelet they keep the position of the last value met, and
// count the bits before it once, at the end. Numbers of bytes are below 2^32, as of words.

#include "hierarchy/dag/dag_step.h"
#include "hierarchy/descents.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Steps are long: a call costs nothing beside them, and a copy in every kernel would.
#define OBSCURA_DAG_STEP inline __attribute__((noinline))

/// In lanes `inside` has above what TreePlace::inside has: 1 + the position of the last value met in the
/// treelet, or 0.
constexpr int dag_met_shift = 13;

OBSCURA_INLINE I32 popcount(I32 a) {
    a = a - (shift_right_logical<1>(a) & splat(std::int32_t{0x55555555}));
    a = (a & splat(std::int32_t{0x33333333})) + (shift_right_logical<2>(a) & splat(std::int32_t{0x33333333}));
    a = (a + shift_right_logical<4>(a)) & splat(std::int32_t{0x0f0f0f0f});
    return shift_right_logical<24>(a * splat(std::int32_t{0x01010101}));
}

/// A word with so many low bits set, 0 to 31.
OBSCURA_INLINE I32 low_bits(const I32& count) {
    return shift_right_logical(splat(std::int32_t{0x7fffffff}), splat(std::int32_t{31}) - count);
}

/// Nodes of a full tree of so many levels, up to four.
OBSCURA_INLINE I32 full_tree_nodes(const I32& levels) {
    alignas(16) static constexpr std::uint8_t nodes[16] = {0, 1, 5, 21, 85};
    return small_table(nodes, levels);
}

/// Bytes from unit 0, for indices that carry a bias.
OBSCURA_INLINE const std::uint8_t* biased_bytes(const TreeCode& tree) {
    return reinterpret_cast<const std::uint8_t*>(reinterpret_cast<std::uintptr_t>(tree.units) +
                                                 std::uintptr_t{index_bias});
}

/// The lanes of `at_node`, which stand at inner nodes.
OBSCURA_INLINE void descend_nodes(const DagForm& form, const std::uint8_t* base, const I32& bit,
                                  const Mask& at_node, Descents16<DagCode>& d) {
    const I32 bias = splat(biased(0)), one = splat(std::int32_t{1});
    const I32 header = gather_bytes<4>(base, d.node);
    I32 pointer = d.node + splat(static_cast<std::int32_t>(form.node_words())), count = d.count;
    for (int k = 0; k < 3; ++k) {
        const I32 kind = shift_right(header, 2 * k) & splat(std::int32_t{3});
        const Mask before = at_node & less(splat(2 * k), bit) & ~equal(kind, splat(std::int32_t{0}));
        if (none(before)) continue;
        const I32 target =
            select(before, gather_bytes<4>(base, select(before, pointer, d.node)) ^ bias, d.node);
        const I32 head = gather_bytes<4>(base, target);
        const I32 below = form.wide ? gather_bytes<4>(base, target + one) : shift_right_logical<8>(head);
        const I32 values =
            select(equal(kind, one), head & splat(static_cast<std::int32_t>(treelet_count_mask)),
                   below + (kind & one));
        count = select(before, count + values, count);
        pointer = select(before, pointer + one, pointer);
    }

    const I32 kind = shift_right_logical(header, bit) & splat(std::int32_t{3});
    const Mask exists = at_node & ~equal(kind, splat(std::int32_t{0}));
    const I32 target = select(exists, gather_bytes<4>(base, select(exists, pointer, d.node)) ^ bias, d.node);
    const Mask treelet = exists & equal(kind, one), node = exists & ~treelet;
    const Mask full = node & any_bit(kind, one);
    d.value = select(full, count ^ bias, d.value);
    d.node = select(exists, target, d.node);
    d.count = select(exists, count + select(full, one, splat(std::int32_t{0})), d.count);
    Mask more = node;
    if (any(treelet)) {
        const I32 head = gather_bytes<4>(base, d.node);
        const I32 own = shift_right_logical<treelet_count_bits>(head) & one;
        const I32 values = head & splat(static_cast<std::int32_t>(treelet_count_mask));
        more = more | (treelet & less(own, values));
        const I32 start = splat(static_cast<std::int32_t>(inside_of(0, form.treelet_levels - 1)));
        d.inside = select(treelet, start | shift_left<dag_met_shift>(own), d.inside);
    }
    d.inner = (d.inner & ~at_node) | more;
}

/// The lanes of `in_treelet`, which stand in treelets, above their last level.
OBSCURA_INLINE void descend_treelets(const TreeCode& tree, const I32& bit, const Mask& in_treelet,
                                     Descents16<DagCode>& d) {
    const I32 one = splat(std::int32_t{1}), bias = splat(biased(0));
    const I32 below = shift_right_logical<9>(d.inside) & splat(std::int32_t{7});
    const I32 nodes = full_tree_nodes(below);
    const I32 position = (d.inside & splat(std::int32_t{511})) + one + shift_right_logical<1>(bit) * nodes;
    const I32 at = position + splat(static_cast<std::int32_t>(treelet_count_bits));
    // The bias of the node leaves at the top.
    const I32 byte =
        (shift_left<2>(d.node) + select(in_treelet, shift_right_logical<3>(at), splat(0))) ^ bias;
    const I32 window =
        shift_right_logical(gather_bytes<1>(biased_bytes(tree), byte), at & splat(std::int32_t{7}));
    const Mask own = in_treelet & any_bit(window, one);
    const Mask wide = less(splat(static_cast<std::int32_t>(treelet_window)), nodes);
    const I32 all = low_bits(min(nodes, splat(static_cast<std::int32_t>(treelet_window)))) - one;
    const Mask more = in_treelet & (wide | any_bit(window, all));

    constexpr auto below_met = static_cast<std::int32_t>((1u << dag_met_shift) - 1u);
    const I32 met = select(own, shift_left<dag_met_shift>(position + one), d.inside & splat(~below_met));
    const I32 stands =
        splat(static_cast<std::int32_t>(inside_treelet)) | shift_left<9>(below - one) | position;
    d.inside = select(in_treelet, stands | met, d.inside);
    d.inner = (d.inner & ~in_treelet) | more;
}

/// One level down, from nodes of height `height` (>= 1) to the children that child_bit() names.
OBSCURA_DAG_STEP void descend(DagCode, const TreeCode& tree, const std::uint8_t* base, int, const I32& bit,
                              Descents16<DagCode>& d) {
    const Mask in_treelet = d.inner & any_bit(d.inside, splat(static_cast<std::int32_t>(inside_treelet)));
    const Mask at_node = d.inner & ~in_treelet;
    if (any(in_treelet)) descend_treelets(tree, bit, in_treelet, d);
    if (any(at_node)) descend_nodes(DagForm::of(DagCode::header(tree).form), base, bit, at_node, d);
}

/// The numbers of the values met last.
OBSCURA_INLINE I32 value_indices(const DagForm& form, const std::uint8_t* base,
                                 const Descents16<DagCode>& d) {
    const I32 last = d.value ^ splat(biased(0));
    const I32 met = shift_right_logical<dag_met_shift>(d.inside);
    const Mask in_treelet = less(splat(std::int32_t{0}), met);
    if (none(in_treelet)) return last;
    const I32 end = met + splat(static_cast<std::int32_t>(treelet_count_bits) - 1);
    I32 count = d.count;
    for (std::int32_t k = 0; k < static_cast<std::int32_t>(treelet_words(form.treelet_levels)); ++k) {
        const I32 here = end - splat(32 * k);
        const Mask some = in_treelet & less(splat(std::int32_t{0}), here);
        if (none(some)) break;
        I32 bits = gather_bytes<4>(base, select(some, d.node + splat(k), d.node));
        if (k == 0) bits = bits & splat(static_cast<std::int32_t>(~treelet_count_mask));
        const I32 most = splat(std::int32_t{31}), counted = min(here, splat(std::int32_t{32}));
        const I32 mask = select(less(most, counted), splat(std::int32_t{-1}), low_bits(min(counted, most)));
        count = count + popcount(select(some, bits & mask, splat(std::int32_t{0})));
    }
    return select(in_treelet, count, last);
}

/// DagCode::number_of().
OBSCURA_INLINE I32 numbers_of(const TreeCode& tree, const DagHeader& header, const DagForm& form,
                              const I32& index) {
    const std::uint8_t* bytes = biased_bytes(tree);
    const auto number = [](std::uint32_t n) { return splat(static_cast<std::int32_t>(n)); };
    const I32 record =
        (shift_right(index, form.chunk_log2) * number(form.chunk_bytes()) + number(header.first_chunk * 4)) ^
        splat(biased(0));
    const I32 in_chunk = index & number((1u << form.chunk_log2) - 1u);
    const I32 place = in_chunk & splat(std::int32_t{31}), row = shift_right_logical<5>(in_chunk);
    const I32 bitmap = gather_bytes<1>(bytes, record + splat(std::int32_t{16}) + shift_left<2>(row));
    const Mask own = any_bit(shift_right_logical(bitmap, place), splat(std::int32_t{1}));
    const I32 representative = gather_bytes<1>(bytes, record);
    if (none(own)) return representative;

    I32 before = popcount(bitmap & low_bits(place));
    for (std::int32_t k = 0; k + 1 < 1 << form.chunk_log2 >> 5; ++k) {
        const Mask behind = own & less(splat(k), row);
        if (none(behind)) break;
        const I32 bits = gather_bytes<1>(bytes, record + splat(16 + 4 * k));
        before = before + popcount(select(behind, bits, splat(std::int32_t{0})));
    }
    const I32 first = gather_bytes<1>(bytes, record + splat(std::int32_t{12}));
    const I32 size = (first & splat(std::int32_t{3})) + splat(std::int32_t{1});
    const I32 at =
        (shift_right_logical<2>(first) + before * size + number(header.first_factor * 4)) ^ splat(biased(0));
    const I32 factor =
        gather_bytes<1>(bytes, select(own, at, record)) &
        shift_right_logical(splat(std::int32_t{-1}), splat(std::int32_t{32}) - shift_left<3>(size));
    const I32 made = gather_bytes<1>(bytes, record + splat(std::int32_t{4})) +
                     gather_bytes<1>(bytes, record + splat(std::int32_t{8})) * factor;
    return select(own, made, representative);
}

OBSCURA_DAG_STEP F32 values(DagCode, const TreeCode& tree, const std::uint8_t* base,
                            const Descents16<DagCode>& d) {
    const DagHeader header = DagCode::header(tree);
    const DagForm form = DagForm::of(header.form);
    return depths_of(tree.layout, numbers_of(tree, header, form, value_indices(form, base, d)));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
