#pragma once
// What every picture is tested for: the same bits in all channels whatever draws it, and for a crop those of
// the whole.

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "app/frame/channels.h"
#include "app/frame/render_frame.h"
#include "core/hash.h"
#include "core/isa.h"

namespace obscura {

/// Every channel wanted that needs nothing of the scene, and what `files` show.
inline FrameOptions all_channels(const std::vector<Output>& files = {}) {
    FrameOptions options;
    for_each_channel([&](const auto& row) { options.*row.wanted = row.by_tiles && row.aov; });
    for (const Output& file : files)
        want_channel(file.aov, options);
    return options;
}

/// Of the picture alone.
inline std::uint64_t hash(const Frame& frame) {
    return Hasher{}.bytes(frame.radiance.pixels.data(), frame.radiance.pixels.size() * sizeof(Vec3f)).state;
}

/// Of the picture and all channels.
inline std::uint64_t hash_of_all(const Frame& frame) {
    Hasher hasher{hash(frame)};
    for_each_channel([&](const auto& row) { hasher.values((frame.*row.pixels).pixels); });
    return hasher.state;
}

/// `part` is what of `whole` lies behind its corner: the picture and all channels of both.
inline void expect_part_of(const Frame& part, const Frame& whole) {
    const auto same = [&](const auto& of_part, const auto& of_whole) {
        ASSERT_EQ(of_part.width > 0, of_whole.width > 0);
        for (int y = 0; y < of_part.height; ++y) {
            const auto* row = of_whole.row(y + part.y0 - whole.y0) + (part.x0 - whole.x0);
            ASSERT_EQ(0,
                      std::memcmp(of_part.row(y), row, sizeof(*row) * static_cast<std::size_t>(part.width)))
                << "row " << y;
        }
    };
    ASSERT_LE(part.x0 + part.width, whole.x0 + whole.width);
    ASSERT_LE(part.y0 + part.height, whole.y0 + whole.height);
    same(part.radiance.view(), whole.radiance.view());
    for_each_channel([&](const auto& row) { same((part.*row.pixels).view(), (whole.*row.pixels).view()); });
}

/// Drawn by `first`, then by every kernel with the most threads and by the widest with all counts of them,
/// then the crop. The scalar reference, which asks every triangle, draws nothing but `first`.
inline void expect_one_picture(const Scene& scene, const Region& crop, const Exec& first = {Isa::ref, 1},
                               const std::vector<int>& threads = {1, 3}) {
    FrameOptions options = all_channels(scene.outputs);
    const Frame whole = render_frame(scene, options, first);
    const std::uint64_t expected = hash_of_all(whole);
    for (const Isa isa : supported_isas()) {
        if (isa == Isa::ref) continue;
        for (const int count : threads) {
            if (isa != best_isa() && count != threads.back()) continue;
            EXPECT_EQ(hash_of_all(render_frame(scene, options, {isa, count})), expected)
                << isa_name(isa) << ", " << count << " threads";
        }
    }
    options.crop = crop;
    const Frame part = render_frame(scene, options);
    EXPECT_EQ(part.width, crop.width);
    EXPECT_EQ(part.height, crop.height);
    expect_part_of(part, whole);
}

}  // namespace obscura
