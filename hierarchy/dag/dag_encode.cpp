// Writes a graph and its values (paper, sections 3.3 and 3.4).
//
// Nodes stand in the reverse of the order in which they were finished: the root first, and every node in
// front of all that hangs below it, so that no file can hold a cycle.

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/buffer.h"
#include "core/error.h"
#include "core/parallel.h"
#include "hierarchy/dag/chunks.h"
#include "hierarchy/dag/dag.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little, "words are written as they are");

constexpr std::uint64_t most_factor_bytes = (std::uint64_t{1} << 30) - 1;

/// Where everything goes.
struct Plan {
    DagForm form;
    std::vector<std::uint64_t> node_at;                                  ///< words, by node
    std::uint64_t first_treelet = 0, first_chunk = 0, first_factor = 0;  ///< words
    std::uint64_t bytes = 0;
};

Plan plan_of(const DagTopology& dag, const EncodeParams& params) {
    Plan plan;
    plan.form = {dag.treelet_levels, params.dag.chunk_log2,
                 dag.nodes.back().values > params.dag.most_counted};
    plan.node_at.resize(dag.nodes.size());
    std::uint64_t at = dag_header_words;
    for (std::size_t i = dag.nodes.size(); i-- > 0;) {
        plan.node_at[i] = at;
        at += plan.form.node_words() + dag.nodes[i].children();
    }
    plan.first_treelet = at;
    plan.first_chunk = at + dag.treelets.size() * treelet_words(dag.treelet_levels);
    const std::uint64_t chunks =
        (dag.values.size() + (1u << plan.form.chunk_log2) - 1) >> plan.form.chunk_log2;
    plan.first_factor = plan.first_chunk + (chunks * plan.form.chunk_bytes() + 3) / 4;
    return plan;
}

std::vector<ValueChunk> chunks_of(const DagTopology& dag, int chunk_log2, const Exec& exec) {
    const std::size_t side = std::size_t{1} << chunk_log2;
    std::vector<ValueChunk> chunks((dag.values.size() + side - 1) / side);
    parallel_blocks(chunks.size(), 256, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t first = i * side, count = std::min(side, dag.values.size() - first);
            chunks[i] = chunk_of(std::span(dag.values).subspan(first, count), dag.layout);
        }
    });
    return chunks;
}

[[noreturn]] void fail(const std::string& what) {
    throw LimitError(fmt::format("a shadow tree of {}; lower the resolution of the shadow map", what));
}

/// All bytes; LimitError where lookups could not name them.
std::uint64_t checked_bytes(const std::vector<ValueChunk>& chunks, const EncodeParams& params,
                            const Plan& plan) {
    std::uint64_t bytes = 0;
    for (const ValueChunk& chunk : chunks)
        bytes += chunk.factors.size() * chunk.factor_bytes;
    const std::uint64_t most_bytes = std::min(params.max_units, std::uint64_t{1} << 30) * 4;
    const std::uint64_t all = plan.first_factor * 4 + bytes;
    if (bytes > most_factor_bytes)
        fail(fmt::format("{} bytes of factors, more than {}", bytes, most_factor_bytes));
    if (all > most_bytes) fail(fmt::format("{} bytes, more than {}", all, most_bytes));
    return all;
}

class Emitter {
  public:
    Emitter(const DagTopology& dag, const std::vector<ValueChunk>& chunks, const Plan& plan,
            std::uint8_t* bits)
        : dag_(dag), chunks_(chunks), plan_(plan), bits_(bits) {}

    void run() {
        const DagHeader header{low(plan_.first_treelet), low(plan_.first_chunk), low(plan_.first_factor),
                               low(dag_.values.size()), plan_.form.bits()};
        std::memcpy(bits_, &header, sizeof header);
        for (std::size_t i = 0; i < dag_.nodes.size(); ++i)
            node(dag_.nodes[i], plan_.node_at[i]);
        for (std::size_t i = 0; i < dag_.treelets.size(); ++i)
            treelet(dag_.treelets[i], treelet_at(i));
        std::uint8_t* factors = bits_ + plan_.first_factor * 4;
        std::uint64_t first = 0;
        for (std::size_t i = 0; i < chunks_.size(); ++i) {
            chunk(chunks_[i], bits_ + plan_.first_chunk * 4 + i * plan_.form.chunk_bytes(), first);
            for (const std::uint32_t factor : chunks_[i].factors) {
                std::memcpy(factors + first, &factor, chunks_[i].factor_bytes);
                first += chunks_[i].factor_bytes;
            }
        }
    }

  private:
    static std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
    void put(std::uint64_t at, std::uint32_t word) { std::memcpy(bits_ + at * 4, &word, 4); }
    std::uint64_t treelet_at(std::uint64_t i) const {
        return plan_.first_treelet + i * treelet_words(dag_.treelet_levels);
    }

    void node(const DagNode& node, std::uint64_t at) {
        put(at++, node.kinds | (plan_.form.wide ? 0 : low(node.values) << 8));
        if (plan_.form.wide) put(at++, low(node.values));
        for (int i = 0; i < 4; ++i) {
            const auto kind = static_cast<DagKind>(node.kinds >> (2 * i) & 3u);
            if (kind == DagKind::none) continue;
            put(at++,
                low(kind == DagKind::treelet ? treelet_at(node.child[i]) : plan_.node_at[node.child[i]]));
        }
    }

    /// The bits, moved up by the count in front of them.
    void treelet(const Treelet& treelet, std::uint64_t at) {
        std::uint32_t carried = treelet.values();
        for (std::uint32_t k = 0; k < treelet_words(dag_.treelet_levels); ++k) {
            put(at + k, carried | treelet.bits[k] << treelet_count_bits);
            carried = treelet.bits[k] >> (32 - treelet_count_bits);
        }
    }

    void chunk(const ValueChunk& chunk, std::uint8_t* out, std::uint64_t first_factor) const {
        const std::uint32_t head[4] = {chunk.representative, chunk.base, chunk.step,
                                       low(first_factor) << 2 | (chunk.factor_bytes - 1)};
        std::memcpy(out, head, sizeof head);
        std::memcpy(out + sizeof head, chunk.has_factor.data(), plan_.form.chunk_bytes() - sizeof head);
    }

    const DagTopology& dag_;
    const std::vector<ValueChunk>& chunks_;
    const Plan& plan_;
    std::uint8_t* bits_;
};

}  // namespace

ShadowTree encode_dag(const MultiresTree& tree, const LightView& view, const EncodeParams& params) {
    CHECK(params.dag.chunk_log2 >= min_chunk_log2 && params.dag.chunk_log2 <= max_chunk_log2);
    const DagTopology dag = dag_topology(
        tree, params.dag.treelet_levels,
        params.layout == TreeLayout::float_bits ? TreeLayout::float_bits : TreeLayout::fractions);
    Plan plan = plan_of(dag, params);
    const std::vector<ValueChunk> chunks = chunks_of(dag, params.dag.chunk_log2, params.exec);
    plan.bytes = checked_bytes(chunks, params, plan);

    ShadowTree result;
    result.view = view;
    result.counts = count_nodes(tree);
    if (tree.root.kinds == 0) result.counts = {0, 0, 1};
    result.bytes = plan.bytes;
    auto bits =
        std::make_shared<Buffer<std::uint8_t>>(static_cast<std::size_t>(plan.bytes) + tree_slack_bytes);
    std::memset(bits->data(), 0, bits->size());
    Emitter(dag, chunks, plan, bits->data()).run();
    result.code.units = bits->data();
    result.code.code = ShadowCode::dag;
    result.code.layout = dag.layout;
    result.code.levels = tree.levels;
    result.bits = std::move(bits);
    return result;
}

}  // namespace obscura
