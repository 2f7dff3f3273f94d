#include "stereo/triangle_pixels.h"

#include <numeric>

#include "core/error.h"
#include "stereo/middle_view.h"

namespace obscura {

TrianglePixels triangle_pixels(const Image<std::uint32_t>& triangle, std::size_t triangles) {
    CHECK(triangle.pixels.size() < UINT32_MAX);
    TrianglePixels lists;
    // Count, prefix sum, scatter.
    lists.first.assign(triangles + 1, 0);
    for (const std::uint32_t t : triangle.pixels) {
        if (t != nothing_seen) ++lists.first[t + 1];
    }
    std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
    lists.pixels.resize(lists.first.back());
    std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
    for (std::uint32_t i = 0; i < triangle.pixels.size(); ++i) {
        const std::uint32_t t = triangle.pixels[i];
        if (t != nothing_seen) lists.pixels[next[t]++] = i;
    }
    return lists;
}

}  // namespace obscura
