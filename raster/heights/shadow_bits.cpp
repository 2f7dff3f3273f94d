#include "raster/heights/shadow_bits.h"

#include <bit>

#include "core/error.h"

namespace obscura {

ShadowBits united(const ShadowBits& a, const ShadowBits& b) {
    CHECK(a.width == b.width && a.height == b.height);
    ShadowBits out = a;
    for (std::size_t i = 0; i < out.words.size(); ++i)
        out.words[i] |= b.words[i];
    return out;
}

std::int64_t count_of(const ShadowBits& bits) {
    std::int64_t n = 0;
    for (const std::uint64_t w : bits.words)
        n += std::popcount(w);
    return n;
}

ShadowBits eroded(const ShadowBits& bits) {
    // Along rows first: of each word, what its neighbours left and right are.
    ShadowBits along(bits.width, bits.height), out = along;
    const std::ptrdiff_t last = bits.words_per_row - 1;
    const int used = bits.width - 64 * static_cast<int>(last);
    const std::uint64_t inside = used == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << used) - 1;
    for (int y = 0; y < bits.height; ++y) {
        const std::uint64_t* from = bits.row(y);
        for (std::ptrdiff_t i = 0; i <= last; ++i) {
            const std::uint64_t word = i == last ? from[i] | ~inside : from[i];
            const std::uint64_t before = i == 0 ? 1 : from[i - 1] >> 63;
            const std::uint64_t next = i == last ? 1 : i + 1 == last ? from[i + 1] | ~inside : from[i + 1];
            along.row(y)[i] = word & (word << 1 | before) & (word >> 1 | next << 63);
        }
    }
    for (int y = 0; y < bits.height; ++y) {
        for (std::ptrdiff_t i = 0; i <= last; ++i) {
            std::uint64_t word = along.row(y)[i];
            if (y > 0) word &= along.row(y - 1)[i];
            if (y + 1 < bits.height) word &= along.row(y + 1)[i];
            out.row(y)[i] = i == last ? word & inside : word;
        }
    }
    return out;
}

}  // namespace obscura
