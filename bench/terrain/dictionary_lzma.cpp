#include <unordered_map>
#include <vector>

#include "bench/terrain/terrain_peers.h"
#include "core/error.h"
#include "hierarchy/terrain/tile_bits.h"

#ifdef OBSCURA_HAS_LZMA
#include <lzma.h>
#endif

namespace obscura {

#ifdef OBSCURA_HAS_LZMA
namespace {

using Bytes = std::vector<std::uint8_t>;

std::int64_t lzma_bytes(const Bytes& in) {
    lzma_options_lzma options;
    CHECK(lzma_lzma_preset(&options, 9 | LZMA_PRESET_EXTREME) == 0);
    const lzma_filter filters[] = {{LZMA_FILTER_LZMA1, &options}, {LZMA_VLI_UNKNOWN, nullptr}};
    Bytes out(in.size() + in.size() / 2 + 4096);
    std::size_t size = 0;
    CHECK(lzma_raw_buffer_encode(filters, nullptr, in.data(), in.size(), out.data(), &size, out.size()) ==
          LZMA_OK);
    return static_cast<std::int64_t>(size);
}

void append(Bytes& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

std::optional<std::int64_t> dictionary_lzma_bytes(const ShadowBits& map) {
    if (count_of(map) == 0) return 0;
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;
    std::vector<std::uint32_t> tiles;
    Bytes dictionary, indices;
    for (const std::uint64_t tile : tile_of(map, {0, 0, map.width, map.height}).blocks) {
        const auto [entry, is_new] = numbers.emplace(tile, static_cast<std::uint32_t>(numbers.size()));
        if (is_new) append(dictionary, tile, 8);
        tiles.push_back(entry->second);
    }
    for (const std::uint32_t number : tiles)
        append(indices, number, numbers.size() > 65536 ? 4 : 2);
    return lzma_bytes(dictionary) + lzma_bytes(indices);
}

#else

std::optional<std::int64_t> dictionary_lzma_bytes(const ShadowBits&) {
    return {};
}

#endif

}  // namespace obscura
