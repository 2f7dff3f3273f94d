// Whether a tree of the code dag is sound, for trees that come from outside, and what it consists of.
//
// Nodes stand side by side from the root on, each before all that hangs below it. So they are looked at from
// the last to the first, each once, and what hangs below their children is known: no way through a graph, of
// which there may be more than any file is long, is walked.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "core/error.h"
#include "hierarchy/dag/dag.h"
#include "hierarchy/dag/dag_step.h"

namespace obscura {
namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32;
constexpr std::uint32_t bits_of_one = 0x3f800000;

constexpr const char* other_values = "an inner node has other values than stated";
constexpr const char* other_factors = "has other factors than its chunks ask for";
constexpr const char* bad_class = "a chunk has a class that means nothing";
constexpr const char* bad_header = "has parts that do not fit each other";

std::uint32_t kind_at(std::uint32_t kinds, int i) {
    return kinds >> (2 * i) & 3u;
}

/// What hangs below a node, or is in a treelet.
struct Below {
    std::uint64_t values = 0;
    int levels = 0;  ///< of nodes
    MultiresCounts counts;
    void add(const Below& part) {
        values += part.values;
        levels = std::max(levels, part.levels);
        counts.full += part.counts.full;
        counts.empty += part.counts.empty;
        counts.leaf += part.counts.leaf;
    }
};

class Walk {
  public:
    Walk(const ShadowTree& tree, const DagHeader& header)
        : code_(tree.code), header_(header), form_(DagForm::of(header.form)), bytes_(tree.bytes) {}

    const char* run() {
        if (const char* fault = check_header()) return fault;
        if (const char* fault = visit_treelets()) return fault;
        if (const char* fault = visit_nodes()) return fault;
        if (root_.values + 1 != header_.values) return "the number of values is not the one stated";
        return visit_chunks();
    }

    MultiresCounts counts() const {
        MultiresCounts counts = root_.counts;
        ++(root_.levels == 0 ? counts.leaf : counts.full);
        return counts;
    }

  private:
    std::uint32_t word(std::uint64_t at) const { return DagCode::bytes_at(code_, at * 4); }

    /// Parts lie inside the bytes, one behind the other.
    const char* check_header() const {
        if (form_.bits() != header_.form || form_.treelet_levels < min_treelet_levels ||
            form_.treelet_levels > max_treelet_levels || form_.chunk_log2 < min_chunk_log2 ||
            form_.chunk_log2 > max_chunk_log2 || (form_.wide && form_.packed))
            return "has an unknown form";
        const std::uint64_t treelet = header_.first_treelet, chunk = header_.first_chunk,
                            factor = header_.first_factor;
        if (treelet <= dag_header_words || chunk < treelet || factor < chunk || factor * 4 > bytes_)
            return bad_header;
        if ((chunk - treelet) % treelet_words(form_.treelet_levels) != 0) return bad_header;
        if (header_.values == 0 || header_.values > 1u << 31)
            return "has no number of values that it can have";
        if (factor - chunk != (chunks() * form_.chunk_bytes() + 3) / 4) return bad_header;
        return nullptr;
    }
    std::uint64_t chunks() const {
        return (std::uint64_t{header_.values} + (1u << form_.chunk_log2) - 1) >> form_.chunk_log2;
    }

    const char* visit_treelets() {
        const std::uint32_t words = treelet_words(form_.treelet_levels);
        for (std::uint64_t at = header_.first_treelet; at < header_.first_chunk; at += words) {
            Treelet treelet;
            for (std::uint32_t k = 0; k < words; ++k) {
                const std::uint32_t above = k + 1 < words ? word(at + k + 1) << (32 - treelet_count_bits) : 0;
                treelet.bits[k] = word(at + k) >> treelet_count_bits | above;
            }
            const std::uint32_t nodes = full_tree_nodes(form_.treelet_levels);
            const std::uint32_t rest = nodes % 32;
            if (rest != 0 && treelet.bits[nodes / 32] >> rest != 0) return "a treelet has nodes of another";
            Below in;
            count_treelet(treelet, form_.treelet_levels, 0, in);
            if (in.values == 0) return "a treelet has no values";
            if (in.values != (word(at) & treelet_count_mask)) return "a treelet has other values than stated";
            treelets_.push_back(in);
        }
        return nullptr;
    }

    /// The node at `position` and what is below it, in a full tree of so many levels.
    void count_treelet(const Treelet& treelet, int levels, std::uint32_t position, Below& in) const {
        Below under;
        for (std::uint32_t i = 0; levels > 1 && i < 4; ++i)
            count_treelet(treelet, levels - 1, position + 1 + i * full_tree_nodes(levels - 1), under);
        const bool own = (treelet.bits[position / 32] >> position % 32 & 1u) != 0;
        if (!own && under.values == 0) return;
        ++(under.values == 0 ? under.counts.leaf : own ? under.counts.full : under.counts.empty);
        under.values += own;
        ++under.levels;
        in.add(under);
    }

    std::uint64_t units_per_word() const { return form_.packed ? 4 : 1; }

    /// The unit behind the node at `at`.
    std::uint64_t end_of_node(std::uint32_t at) const {
        if (form_.packed) return DagCode::packed_node_at(code_, at).end;
        DagNode node;
        node.kinds = word(at) & 0xffu;
        return std::uint64_t{at} + form_.node_words() + node.children();
    }

    /// Finds out where nodes begin.
    const char* find_nodes() {
        const std::uint64_t end = header_.first_treelet * units_per_word();
        number_.assign(end, 0);
        for (std::uint64_t at = dag_header_words * units_per_word(); at < end;) {
            // Bytes that are left of a word are zeros, and no node has no children but the root.
            if (form_.packed && !starts_.empty() && end - at < 4 && all_zeros(at, end)) break;
            starts_.push_back(static_cast<std::uint32_t>(at));
            number_[at] = static_cast<std::uint32_t>(starts_.size());
            at = end_of_node(starts_.back());
            if (at > end) return "an inner node is cut short";
        }
        return nullptr;
    }
    bool all_zeros(std::uint64_t at, std::uint64_t end) const {
        return std::all_of(code_.units + at, code_.units + end, [](std::uint8_t byte) { return byte == 0; });
    }

    const char* visit_nodes() {
        if (const char* fault = find_nodes()) return fault;
        below_.resize(starts_.size());
        for (std::size_t i = starts_.size(); i-- > 0;) {
            if (const char* fault = visit_node(i)) return fault;
        }
        root_ = below_[0];
        return nullptr;
    }

    const char* visit_node(std::size_t i) {
        const std::uint32_t at = starts_[i];
        const std::uint32_t head = DagCode::bytes_at(code_, std::uint64_t{at} << form_.unit_log2());
        const std::uint32_t kinds = head & 0xffu;
        if (kinds == 0 && i != 0) return "an inner node has no children";
        if (form_.packed && (head >> 12 & 15u) != 0) return "an inner node has bits that mean nothing";
        Below& below = below_[i];
        for (int c = 0; c < 4; ++c) {
            const DagCode::Child to =
                form_.packed ? DagCode::packed_child_at(code_, form_, at, c) : plain_child(at, kinds, c);
            if (to.kind == 0) continue;
            if (form_.packed && to.before != below.values) return other_values;
            Below child;
            const char* fault = to.kind == static_cast<std::uint32_t>(DagKind::treelet)
                                    ? visit_treelet(to.unit, child)
                                    : visit_child(at, to.unit, to.kind, child);
            if (fault != nullptr) return fault;
            below.add(child);
        }
        // Also what keeps the sums small: no more than 4^20 nodes of each kind and level.
        if (below.levels > code_.levels) return "an inner node at the height of texels";
        if (form_.packed) return nullptr;
        if (form_.wide && head >> 8 != 0) return "an inner node has bits that mean nothing";
        return below.values == (form_.wide ? word(at + 1) : head >> 8) ? nullptr : other_values;
    }
    /// Without what stands before it, which only siblings that were looked at tell.
    DagCode::Child plain_child(std::uint32_t at, std::uint32_t kinds, int c) const {
        DagNode before;
        before.kinds = kinds & ((1u << (2 * c)) - 1u);
        const std::uint32_t kind = kind_at(kinds, c);
        return {kind, kind == 0 ? 0 : word(std::uint64_t{at} + form_.node_words() + before.children()), 0};
    }

    const char* visit_treelet(std::uint32_t unit, Below& child) const {
        const std::uint64_t first = std::uint64_t{header_.first_treelet} * units_per_word(),
                            end = std::uint64_t{header_.first_chunk} * units_per_word(),
                            size = std::uint64_t{treelet_words(form_.treelet_levels)} * units_per_word();
        if (unit < first || unit >= end || (unit - first) % size != 0) return "a child is no treelet";
        child = treelets_[(unit - first) / size];
        return nullptr;
    }

    const char* visit_child(std::uint32_t at, std::uint32_t unit, std::uint32_t kind, Below& child) const {
        if (unit <= at) return "children do not follow their parent";
        if (unit >= number_.size() || number_[unit] == 0) return "a child is no inner node";
        child = below_[number_[unit] - 1];
        const bool full = kind == static_cast<std::uint32_t>(DagKind::full);
        child.values += full;
        ++(full ? child.counts.full : child.counts.empty);
        ++child.levels;
        return nullptr;
    }

    const char* visit_chunks() const {
        const std::uint64_t first = std::uint64_t{header_.first_chunk} * 4;
        std::uint64_t factors = 0;
        for (std::uint64_t i = 0; i < chunks(); ++i) {
            const std::uint64_t record = first + i * form_.chunk_bytes();
            const char* fault = form_.packed ? visit_packed_chunk(record, values_in(i), factors)
                                             : visit_chunk(record, values_in(i), factors);
            if (fault != nullptr) return fault;
        }
        if (std::uint64_t{header_.first_factor} * 4 + factors != bytes_) return other_factors;
        if (code_.layout != TreeLayout::float_bits) return nullptr;  // any fraction is a depth
        for (std::uint32_t i = 0; i < header_.values; ++i) {
            if (DagCode::number_of(code_, i) > bits_of_one) return "a value is not a depth in [0, 1]";
        }
        return nullptr;
    }
    std::uint32_t values_in(std::uint64_t chunk) const {
        const std::uint64_t before = chunk << form_.chunk_log2;
        return static_cast<std::uint32_t>(
            std::min(header_.values - before, std::uint64_t{1} << form_.chunk_log2));
    }

    const char* visit_chunk(std::uint64_t record, std::uint32_t values, std::uint64_t& factors) const {
        const std::uint32_t head = DagCode::bytes_at(code_, record + 12);
        if (head >> 2 != factors) return "factors do not follow each other";
        for (std::uint32_t at = 0; at < 1u << form_.chunk_log2; ++at) {
            const std::uint32_t bits = DagCode::bytes_at(code_, record + 16 + at / 32 * 4);
            if ((bits >> at % 32 & 1u) == 0) continue;
            if (at >= values) return "a chunk has more values than there are";
            factors += (head & 3u) + 1;
        }
        return nullptr;
    }

    const char* visit_packed_chunk(std::uint64_t record, std::uint32_t values, std::uint64_t& factors) const {
        if (DagCode::bytes_at(code_, record) != factors) return "factors do not follow each other";
        const std::uint64_t chunk = std::uint64_t{header_.first_factor} * 4 + factors;
        if (chunk + packed_head_bytes > bytes_) return other_factors;
        const std::uint32_t head = DagCode::bytes_at(code_, chunk), classes = (head & 3u) + 1;
        const std::uint32_t plane_bytes = (1u << form_.chunk_log2) / 8;
        const std::uint64_t planes = chunk + packed_head_bytes + classes * packed_class_bytes,
                            first = planes + (classes == 1   ? 0
                                              : classes == 2 ? 1
                                                             : 2) *
                                                 plane_bytes;
        if (first > bytes_) return other_factors;
        // Classes that are not there have no bits.
        if (head >> 26 != 0 || (classes < 4 && head >> (2 + 6 * classes) != 0)) return bad_class;
        for (std::uint32_t c = 0; c < classes; ++c) {
            const std::uint8_t shift = code_.units[chunk + packed_head_bytes + c * packed_class_bytes + 4];
            if (shift > 31 || (head >> (2 + 6 * c) & 63u) > 32) return bad_class;
        }
        std::uint64_t bits = 0;
        for (std::uint32_t at = 0; at < 1u << form_.chunk_log2; ++at) {
            const auto bit = [&](std::uint64_t from) { return code_.units[from + at / 8] >> at % 8 & 1u; };
            const std::uint32_t c =
                (classes > 1 ? bit(planes) : 0) + 2 * (classes > 2 ? bit(planes + plane_bytes) : 0);
            if (c >= classes) return bad_class;
            if (at < values) bits += head >> (2 + 6 * c) & 63u;
        }
        factors = first + (bits + 7) / 8 - std::uint64_t{header_.first_factor} * 4;
        return first + (bits + 7) / 8 > bytes_ ? other_factors : nullptr;
    }

    const TreeCode& code_;
    const DagHeader header_;
    const DagForm form_;
    const std::uint64_t bytes_;
    std::vector<Below> treelets_;
    std::vector<std::uint32_t> starts_, number_;  ///< first units of nodes; at each of these 1 + its number
    std::vector<Below> below_;                    ///< of nodes
    Below root_;
};

}  // namespace

const char* dag_fault_of(const ShadowTree& tree) {
    const TreeCode& code = tree.code;
    CHECK(code.levels >= 0 && code.levels <= max_tree_levels);
    if (code.layout != TreeLayout::fractions && code.layout != TreeLayout::float_bits)
        return "has an unknown layout";
    if (tree.bytes > most_bytes) return "more bytes than lookups can name";
    if (tree.bytes < sizeof(DagHeader)) return "no room for the header";
    Walk walk(tree, DagCode::header(code));
    if (const char* fault = walk.run()) return fault;
    if (!(walk.counts() == tree.counts)) return "the number of nodes is not the one stated";
    return tree.padding_bytes == 0 ? nullptr : "has other padding than stated";
}

namespace {

std::uint64_t count_nodes_of(const TreeCode& code, const DagForm& form, const DagHeader& header) {
    const std::uint64_t per_word = form.packed ? 4 : 1, end = header.first_treelet * per_word;
    std::uint64_t count = 0;
    for (std::uint64_t at = dag_header_words * per_word; at < end; ++count) {
        const auto node = static_cast<std::uint32_t>(at);
        DagNode own;
        own.kinds = DagCode::bytes_at(code, at << form.unit_log2()) & 0xffu;
        if (own.kinds == 0 && count != 0) break;  // what is left of a word
        at = form.packed ? DagCode::packed_node_at(code, node).end : at + form.node_words() + own.children();
    }
    return count;
}

}  // namespace

DagStats dag_stats(const ShadowTree& tree) {
    const DagHeader header = DagCode::header(tree.code);
    const DagForm form = DagForm::of(header.form);
    DagStats stats;
    stats.inner_nodes = count_nodes_of(tree.code, form, header);
    stats.inner_bytes = 4 * std::uint64_t{header.first_treelet};
    stats.treelet_bytes = 4 * std::uint64_t{header.first_chunk - header.first_treelet};
    stats.treelets = stats.treelet_bytes / 4 / treelet_words(form.treelet_levels);
    stats.values = header.values;
    stats.chunk_bytes = 4 * std::uint64_t{header.first_factor - header.first_chunk};
    stats.factor_bytes = tree.bytes - 4 * std::uint64_t{header.first_factor};
    for (std::uint64_t i = 0; i << form.chunk_log2 < header.values; ++i) {
        const std::uint64_t record = std::uint64_t{header.first_chunk} * 4 + i * form.chunk_bytes();
        if (form.packed) {
            ++stats.classes[DagCode::bytes_at(tree.code, std::uint64_t{header.first_factor} * 4 +
                                                             DagCode::bytes_at(tree.code, record)) &
                            3u];
            continue;
        }
        for (std::uint64_t byte = 16; byte < form.chunk_bytes(); ++byte)
            stats.factors += static_cast<std::uint64_t>(std::popcount(tree.code.units[record + byte]));
    }
    return stats;
}

std::string dag_text(const ShadowTree& tree) {
    const DagStats stats = dag_stats(tree);
    const DagForm form = DagForm::of(DagCode::header(tree.code).form);
    return fmt::format("{} nodes, {} treelets of {} levels, {:.1f} bits a value{}", stats.inner_nodes,
                       stats.treelets, form.treelet_levels,
                       8 * static_cast<double>(stats.value_bytes()) / static_cast<double>(stats.values),
                       tree.code.layout == TreeLayout::float_bits ? " of float bits" : "");
}

}  // namespace obscura
