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

/// Bits below place `end`; none where it is negative, all from 32 on.
OBSCURA_INLINE I32 bits_below(const I32& end) {
    const I32 most = splat(std::int32_t{31}), inside = min(max(end, splat(std::int32_t{0})), most);
    return select(less(most, end), splat(std::int32_t{-1}), low_bits(inside));
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

OBSCURA_INLINE I32 number(std::uint32_t n) {
    return splat(static_cast<std::int32_t>(n));
}

/// First bytes of nodes or treelets, biased as these are.
OBSCURA_INLINE I32 first_bytes(const DagForm& form, const I32& node) {
    // The bias of a word leaves at the top.
    return form.packed ? node : shift_left<2>(node) ^ splat(biased(0));
}

/// DagCode::Child of sixteen nodes; what does not exist is of no account.
struct Children16 {
    I32 kind, unit, before;  ///< unit: biased
};

/// A word with so many low bytes set, 1 to 4.
OBSCURA_INLINE I32 low_bytes(const I32& count) {
    return shift_right_logical(splat(std::int32_t{-1}), splat(std::int32_t{32}) - shift_left<3>(count));
}

/// DagCode::packed_child_at() for the lanes of `at_node`.
OBSCURA_INLINE Children16 packed_children(const TreeCode& tree, const DagForm& form, const I32& node,
                                          const I32& bit, const Mask& at_node) {
    const std::uint8_t* bytes = biased_bytes(tree);
    const I32 zero = splat(std::int32_t{0}), one = splat(std::int32_t{1}), three = splat(std::int32_t{3});
    const I32 head = gather_bytes<1>(bytes, node);
    Children16 child{shift_right_logical(head, bit) & three, node, zero};
    const Mask exists = at_node & ~equal(child.kind, zero);
    const I32 existing = (head | shift_right_logical<1>(head)) & splat(std::int32_t{0x55});
    const I32 below = existing & shift_right_logical(splat(std::int32_t{0x3f}), splat(std::int32_t{6}) - bit);
    const auto children_of = [&](const I32& set) {
        const I32 pairs =
            (set & splat(std::int32_t{0x11})) + (shift_right_logical<2>(set) & splat(std::int32_t{0x11}));
        return (pairs & three) + shift_right_logical<4>(pairs);
    };
    const I32 index = children_of(below);
    const I32 pointer_bytes = (shift_right_logical<8>(head) & three) + one,
              count_bytes = (shift_right_logical<10>(head) & three) + one;
    const I32 counts = node + number(packed_node_bytes) - count_bytes;
    const Mask later = exists & less(zero, index);
    if (any(later)) {
        const I32 count = gather_bytes<1>(bytes, select(later, counts + index * count_bytes, node));
        child.before = select(later, count & low_bytes(count_bytes), zero);
    }
    const I32 pointers = counts + children_of(existing) * count_bytes;
    const I32 place = gather_bytes<1>(bytes, select(exists, pointers + index * pointer_bytes, node)) &
                      low_bytes(pointer_bytes);
    const I32 treelet = place * number(4 * treelet_words(form.treelet_levels)) +
                        number((4 * DagCode::header(tree).first_treelet) ^ index_bias);
    child.unit = select(equal(child.kind, one), treelet, node + place);
    return child;
}

/// DagCode::child_at() for the lanes of `at_node`.
OBSCURA_INLINE Children16 children(const TreeCode& tree, const DagForm& form, const I32& node, const I32& bit,
                                   const Mask& at_node) {
    const std::uint8_t* base = biased_units<DagCode>(tree);
    const I32 bias = splat(biased(0)), one = splat(std::int32_t{1}), zero = splat(std::int32_t{0});
    const I32 header = gather_bytes<4>(base, node);
    Children16 child{shift_right_logical(header, bit) & splat(std::int32_t{3}), node, zero};
    I32 pointer = node + number(form.node_words());
    for (int k = 0; k < 3; ++k) {
        const I32 kind = shift_right(header, 2 * k) & splat(std::int32_t{3});
        const Mask before = at_node & less(splat(2 * k), bit) & ~equal(kind, zero);
        if (none(before)) continue;
        const I32 sibling = select(before, gather_bytes<4>(base, select(before, pointer, node)) ^ bias, node);
        const I32 head = gather_bytes<4>(base, sibling);
        const I32 below = form.wide ? gather_bytes<4>(base, sibling + one) : shift_right_logical<8>(head);
        const I32 values = select(equal(kind, one), head & number(treelet_count_mask), below + (kind & one));
        child.before = select(before, child.before + values, child.before);
        pointer = select(before, pointer + one, pointer);
    }
    const Mask exists = at_node & ~equal(child.kind, zero);
    child.unit = gather_bytes<4>(base, select(exists, pointer, node)) ^ bias;
    return child;
}

/// The lanes of `at_node`, which stand at inner nodes.
OBSCURA_INLINE void descend_nodes(const TreeCode& tree, const DagForm& form, const I32& bit,
                                  const Mask& at_node, Descents16<DagCode>& d) {
    const I32 one = splat(std::int32_t{1}), zero = splat(std::int32_t{0});
    const Children16 child = form.packed ? packed_children(tree, form, d.node, bit, at_node)
                                         : children(tree, form, d.node, bit, at_node);
    const Mask exists = at_node & ~equal(child.kind, zero);
    const Mask treelet = exists & equal(child.kind, one), node = exists & ~treelet;
    const Mask full = node & any_bit(child.kind, one);
    const I32 count = d.count + child.before;
    d.value = select(full, count ^ splat(biased(0)), d.value);
    d.node = select(exists, child.unit, d.node);
    d.count = select(exists, count + select(full, one, zero), d.count);
    Mask more = node;
    if (any(treelet)) {
        const I32 head = gather_bytes<1>(biased_bytes(tree), first_bytes(form, d.node));
        const I32 own = shift_right_logical<treelet_count_bits>(head) & one;
        more = more | (treelet & less(own, head & number(treelet_count_mask)));
        const I32 start = number(inside_of(0, form.treelet_levels - 1));
        d.inside = select(treelet, start | shift_left<dag_met_shift>(own), d.inside);
    }
    d.inner = (d.inner & ~at_node) | more;
}

/// The lanes of `in_treelet`, which stand in treelets, above their last level.
OBSCURA_INLINE void descend_treelets(const TreeCode& tree, const DagForm& form, const I32& bit,
                                     const Mask& in_treelet, Descents16<DagCode>& d) {
    const I32 one = splat(std::int32_t{1});
    const I32 below = shift_right_logical<9>(d.inside) & splat(std::int32_t{7});
    const I32 nodes = full_tree_nodes(below);
    const I32 position = (d.inside & splat(std::int32_t{511})) + one + shift_right_logical<1>(bit) * nodes;
    const I32 at = position + splat(static_cast<std::int32_t>(treelet_count_bits));
    const I32 byte =
        first_bytes(form, d.node) + select(in_treelet, shift_right_logical<3>(at), splat(std::int32_t{0}));
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
OBSCURA_DAG_STEP void descend(DagCode, const TreeCode& tree, const std::uint8_t*, int, const I32& bit,
                              Descents16<DagCode>& d) {
    const DagForm form = DagCode::form_of(tree);
    const Mask in_treelet = d.inner & any_bit(d.inside, number(inside_treelet));
    const Mask at_node = d.inner & ~in_treelet;
    if (any(in_treelet)) descend_treelets(tree, form, bit, in_treelet, d);
    if (any(at_node)) descend_nodes(tree, form, bit, at_node, d);
}

/// The numbers of the values met last.
OBSCURA_INLINE I32 value_indices(const TreeCode& tree, const DagForm& form, const Descents16<DagCode>& d) {
    const I32 zero = splat(std::int32_t{0}), last = d.value ^ splat(biased(0));
    const I32 met = shift_right_logical<dag_met_shift>(d.inside);
    const Mask in_treelet = less(zero, met);
    if (none(in_treelet)) return last;
    const I32 first = first_bytes(form, d.node), end = met + number(treelet_count_bits - 1);
    I32 count = d.count;
    for (std::int32_t k = 0; k < static_cast<std::int32_t>(treelet_words(form.treelet_levels)); ++k) {
        const I32 here = end - splat(32 * k);
        const Mask some = in_treelet & less(zero, here);
        if (none(some)) break;
        I32 bits = gather_bytes<1>(biased_bytes(tree), select(some, first + splat(4 * k), first));
        if (k == 0) bits = bits & number(~treelet_count_mask);
        count = count + popcount(select(some, bits & bits_below(here), zero));
    }
    return select(in_treelet, count, last);
}

/// DagCode::packed_number_of(): `chunk` biased.
OBSCURA_INLINE I32 packed_numbers_of(const TreeCode& tree, const DagForm& form, const I32& chunk,
                                     const I32& in) {
    const std::uint8_t* bytes = biased_bytes(tree);
    const I32 zero = splat(std::int32_t{0}), one = splat(std::int32_t{1}), three = splat(std::int32_t{3});
    const I32 head = gather_bytes<1>(bytes, chunk), classes = (head & three) + one;
    const I32 plane_bytes = number((1u << form.chunk_log2) / 8);
    const I32 planes = chunk + number(packed_head_bytes) + classes * number(packed_class_bytes);
    const Mask several = less(one, classes), many = less(splat(std::int32_t{2}), classes);
    I32 own = zero, low = zero, high = zero, both = zero;
    for (std::int32_t begin = 0; begin < 1 << form.chunk_log2; begin += 32) {
        const I32 left = in - splat(begin);
        const Mask here = several & less(splat(std::int32_t{-1}), left);
        if (none(here)) break;
        const I32 at = select(here, planes + splat(begin / 8), chunk);
        const I32 a = select(here, gather_bytes<1>(bytes, at), zero);
        I32 b = zero;
        if (any(here & many))
            b = select(here & many, gather_bytes<1>(bytes, select(many, at + plane_bytes, at)), zero);
        const I32 below = bits_below(left);
        low = low + popcount(a & below);
        high = high + popcount(b & below);
        both = both + popcount(a & b & below);
        const I32 place = left & splat(std::int32_t{31});
        const I32 of =
            (shift_right_logical(a, place) & one) + shift_left<1>(shift_right_logical(b, place) & one);
        own = select(here & less(left, splat(std::int32_t{32})), of, own);
    }
    const auto width_of = [&](int c) { return shift_right(head, 2 + 6 * c) & splat(std::int32_t{63}); };
    const I32 bit = (in - low - high + both) * width_of(0) + (low - both) * width_of(1) +
                    (high - both) * width_of(2) + both * width_of(3);
    const I32 width = shift_right_logical(head, own * splat(std::int32_t{6}) + splat(std::int32_t{2})) &
                      splat(std::int32_t{63});
    const I32 of_class = chunk + number(packed_head_bytes) + own * number(packed_class_bytes);
    const I32 base = gather_bytes<1>(bytes, of_class);
    const Mask factors = less(zero, width);
    if (none(factors)) return base;

    const I32 step =
        low_bits(gather_bytes<1>(bytes, of_class + splat(std::int32_t{4})) & splat(std::int32_t{31})) + one;
    const I32 plane_count = select(several, one, zero) + select(many, one, zero);
    const I32 at = select(factors, planes + plane_count * plane_bytes + shift_right_logical<3>(bit), chunk);
    const I32 place = bit & splat(std::int32_t{7});
    I32 factor = shift_right_logical(gather_bytes<1>(bytes, at), place);
    const Mask long_ones = factors & less(splat(std::int32_t{25}), width);
    if (any(long_ones)) {
        // The next byte's word overlaps; what both have is the same.
        const I32 next = gather_bytes<1>(bytes, select(long_ones, at + one, chunk));
        const I32 moved = next * (low_bits(splat(std::int32_t{8}) - place) + one);
        factor = factor | select(long_ones, moved, zero);
    }
    factor = factor & shift_right_logical(splat(std::int32_t{-1}),
                                          select(factors, splat(std::int32_t{32}) - width, zero));
    return base + select(factors, factor, zero) * step;
}

/// DagCode::number_of().
OBSCURA_INLINE I32 numbers_of(const TreeCode& tree, const DagHeader& header, const DagForm& form,
                              const I32& index) {
    const std::uint8_t* bytes = biased_bytes(tree);
    const I32 record =
        (shift_right(index, form.chunk_log2) * number(form.chunk_bytes()) + number(header.first_chunk * 4)) ^
        splat(biased(0));
    const I32 in_chunk = index & number((1u << form.chunk_log2) - 1u);
    if (form.packed) {
        const I32 chunk =
            (gather_bytes<1>(bytes, record) + number(header.first_factor * 4)) ^ splat(biased(0));
        return packed_numbers_of(tree, form, chunk, in_chunk);
    }
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

OBSCURA_DAG_STEP F32 values(DagCode, const TreeCode& tree, const std::uint8_t*,
                            const Descents16<DagCode>& d) {
    const DagHeader header = DagCode::header(tree);
    const DagForm form = DagForm::of(header.form);
    return depths_of(tree.layout, numbers_of(tree, header, form, value_indices(tree, form, d)));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
