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

}  // namespace obscura
