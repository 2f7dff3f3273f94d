// Writes a graph and its values (paper, sections 3.3 and 3.4; packed: dag_format.h).

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/buffer.h"
#include "core/error.h"
#include "core/parallel.h"
#include "hierarchy/dag/chunks.h"
#include "hierarchy/dag/classes.h"
#include "hierarchy/dag/dag.h"
#include "hierarchy/dag/dag_plan.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little, "words are written as they are");

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32;
constexpr std::uint64_t most_factor_bytes = (std::uint64_t{1} << 30) - 1;

std::uint32_t low(std::uint64_t v) {
    return static_cast<std::uint32_t>(v);
}

/// What a chunk writes: to its record, and among the factors. The place of its first factor is not known
/// yet.
struct WrittenChunk {
    Bytes record, factors;
};

template <class T>
void append(Bytes& bytes, const T* from, std::size_t size) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(from);
    bytes.insert(bytes.end(), p, p + size);
}

WrittenChunk written(const ValueChunk& chunk, const DagForm& form) {
    WrittenChunk out;
    const std::uint32_t head[4] = {chunk.representative, chunk.base, chunk.step, chunk.factor_bytes - 1};
    append(out.record, head, sizeof head);
    append(out.record, chunk.has_factor.data(), form.chunk_bytes() - sizeof head);
    for (const std::uint32_t factor : chunk.factors)
        append(out.factors, &factor, chunk.factor_bytes);
    return out;
}

/// Bits, from the lowest of each byte up.
class BitWriter {
  public:
    explicit BitWriter(Bytes& bytes) : bytes_(bytes) {}
    void put(std::uint32_t value, std::uint32_t width) {
        for (std::uint32_t i = 0; i < width; ++i, ++bits_) {
            if (bits_ % 8 == 0) bytes_.push_back(0);
            bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | (value >> i & 1u) << bits_ % 8);
        }
    }

  private:
    Bytes& bytes_;
    std::uint64_t bits_ = 0;
};

WrittenChunk written(const ClassedChunk& chunk, const DagForm& form) {
    WrittenChunk out;
    out.record.resize(form.chunk_bytes());
    std::uint32_t head = low(chunk.classes.size()) - 1;
    for (std::size_t c = 0; c < chunk.classes.size(); ++c)
        head |= chunk.classes[c].width << (2 + 6 * c);
    append(out.factors, &head, sizeof head);
    for (const ValueClass& c : chunk.classes) {
        append(out.factors, &c.base, sizeof c.base);
        out.factors.push_back(static_cast<std::uint8_t>(c.shift));
    }
    for (std::uint32_t plane = 0; plane < 2; ++plane) {
        if (chunk.classes.size() <= (plane == 0 ? 1u : 2u)) break;
        BitWriter bits(out.factors);
        for (std::uint32_t i = 0; i < 1u << form.chunk_log2; ++i)
            bits.put(i < chunk.class_of.size() ? chunk.class_of[i] >> plane & 1u : 0, 1);
    }
    BitWriter bits(out.factors);
    for (std::size_t i = 0; i < chunk.class_of.size(); ++i)
        bits.put(chunk.factors[i], chunk.classes[chunk.class_of[i]].width);
    return out;
}

std::vector<WrittenChunk> chunks_of(const DagTopology& dag, const DagForm& form, const Exec& exec) {
    const std::size_t side = std::size_t{1} << form.chunk_log2;
    std::vector<WrittenChunk> chunks((dag.values.size() + side - 1) / side);
    parallel_blocks(chunks.size(), 64, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t first = i * side, count = std::min(side, dag.values.size() - first);
            const std::span ranges = std::span(dag.values).subspan(first, count);
            chunks[i] = form.packed ? written(classed_chunk_of(ranges, dag.layout, form.chunk_log2), form)
                                    : written(chunk_of(ranges, dag.layout), form);
        }
    });
    return chunks;
}

[[noreturn]] void fail(const std::string& what) {
    throw LimitError(fmt::format("a shadow tree of {}; lower the resolution of the shadow map", what));
}

/// All bytes; LimitError where lookups could not name them.
std::uint64_t checked_bytes(const std::vector<WrittenChunk>& chunks, const EncodeParams& params,
                            const DagPlan& plan) {
    std::uint64_t bytes = 0;
    for (const WrittenChunk& chunk : chunks)
        bytes += chunk.factors.size();
    if (!plan.form.packed && bytes > most_factor_bytes)
        fail(fmt::format("{} bytes of factors, more than {}", bytes, most_factor_bytes));
    const std::uint64_t all = plan.first_factor * 4 + bytes;
    const std::uint64_t most = std::min(params.max_units, most_bytes / 4) * 4;
    if (all > most) fail(fmt::format("{} bytes, more than {}", all, most));
    return all;
}

class Emitter {
  public:
    Emitter(const DagTopology& dag, const DagPlan& plan, std::uint8_t* bits)
        : dag_(dag), plan_(plan), form_(plan.form), bits_(bits) {}

    void run(const std::vector<WrittenChunk>& chunks) {
        const DagHeader header{low(plan_.first_treelet), low(plan_.first_chunk), low(plan_.first_factor),
                               low(dag_.values.size()), form_.bits()};
        std::memcpy(bits_, &header, sizeof header);
        for (std::size_t i = 0; i < dag_.nodes.size(); ++i) {
            out_ = bits_ + (plan_.node_at[i] << form_.unit_log2());
            form_.packed ? packed_node(i) : node(dag_.nodes[i]);
        }
        out_ = bits_ + plan_.first_treelet * 4;
        for (const Treelet& t : dag_.treelets)
            treelet(t);
        out_ = bits_ + plan_.first_chunk * 4;
        std::uint8_t* factors = bits_ + plan_.first_factor * 4;
        std::uint64_t first = 0;
        for (const WrittenChunk& c : chunks) {
            chunk(c, first);
            if (!c.factors.empty()) std::memcpy(factors + first, c.factors.data(), c.factors.size());
            first += c.factors.size();
        }
    }

  private:
    template <class T>
    void put(T value) {
        std::memcpy(out_, &value, sizeof value);
        out_ += sizeof value;
    }
    std::uint64_t treelet_at(std::uint64_t i) const {
        return plan_.first_treelet + i * treelet_words(form_.treelet_levels);
    }

    void node(const DagNode& node) {
        put(node.kinds | (form_.wide ? 0 : low(node.values) << 8));
        if (form_.wide) put(low(node.values));
        for (int c = 0; c < 4; ++c) {
            const DagKind kind = node.kind(c);
            if (kind == DagKind::none) continue;
            put(low(kind == DagKind::treelet ? treelet_at(node.child[c]) : plan_.node_at[node.child[c]]));
        }
    }

    void packed_node(std::size_t i) {
        const DagNode& node = dag_.nodes[i];
        const PackedSizes& sizes = plan_.sizes[i];
        put(static_cast<std::uint16_t>(node.kinds | (sizes.pointer - 1) << 8 | (sizes.count - 1) << 10));
        bool first = true;
        for (int c = 0; c < 4; ++c) {
            if (node.kind(c) == DagKind::none) continue;
            if (!first) put_bytes(node.before[c], sizes.count);
            first = false;
        }
        for (int c = 0; c < 4; ++c) {
            if (node.kind(c) == DagKind::none) continue;
            put_bytes(node.kind(c) == DagKind::treelet ? node.child[c]
                                                       : plan_.node_at[node.child[c]] - plan_.node_at[i],
                      sizes.pointer);
        }
    }
    void put_bytes(std::uint64_t value, std::uint32_t size) {
        std::memcpy(out_, &value, size);
        out_ += size;
    }

    /// The bits, moved up by the count in front of them.
    void treelet(const Treelet& treelet) {
        std::uint32_t carried = treelet.values();
        for (std::uint32_t k = 0; k < treelet_words(form_.treelet_levels); ++k) {
            put(carried | treelet.bits[k] << treelet_count_bits);
            carried = treelet.bits[k] >> (32 - treelet_count_bits);
        }
    }

    void chunk(const WrittenChunk& chunk, std::uint64_t first_factor) {
        std::memcpy(out_, chunk.record.data(), chunk.record.size());
        // Packed, the place is all that a record has; else it stands above the bytes of a factor.
        std::uint8_t* at = out_ + (form_.packed ? 0 : 12);
        std::uint32_t place = low(first_factor);
        if (!form_.packed) {
            std::memcpy(&place, at, sizeof place);
            place |= low(first_factor) << 2;
        }
        std::memcpy(at, &place, sizeof place);
        out_ += chunk.record.size();
    }

    const DagTopology& dag_;
    const DagPlan& plan_;
    const DagForm& form_;
    std::uint8_t* bits_;
    std::uint8_t* out_ = nullptr;
};

}  // namespace

ShadowTree encode_dag(const MultiresTree& tree, const LightView& view, const EncodeParams& params) {
    CHECK(params.dag.chunk_log2 >= min_chunk_log2 && params.dag.chunk_log2 <= max_chunk_log2);
    const DagTopology dag = dag_topology(
        tree, params.dag.treelet_levels,
        params.layout == TreeLayout::float_bits ? TreeLayout::float_bits : TreeLayout::fractions);
    DagForm form;
    form.treelet_levels = dag.treelet_levels;
    form.chunk_log2 = params.dag.chunk_log2;
    form.packed = params.dag.packed;
    form.wide = !form.packed && dag.nodes.back().values > params.dag.most_counted;
    const DagPlan plan = plan_of(dag, form);
    const std::vector<WrittenChunk> chunks = chunks_of(dag, form, params.exec);

    ShadowTree result;
    result.view = view;
    result.counts = count_nodes(tree);
    if (tree.root.kinds == 0) result.counts = {0, 0, 1};
    result.bytes = checked_bytes(chunks, params, plan);
    auto bits =
        std::make_shared<Buffer<std::uint8_t>>(static_cast<std::size_t>(result.bytes) + tree_slack_bytes);
    std::memset(bits->data(), 0, bits->size());
    Emitter(dag, plan, bits->data()).run(chunks);
    result.code.units = bits->data();
    result.code.code = ShadowCode::dag;
    result.code.layout = dag.layout;
    result.code.levels = tree.levels;
    result.bits = std::move(bits);
    return result;
}

}  // namespace obscura
