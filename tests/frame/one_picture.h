#pragma once
// What every picture is tested for: the same bits in all channels whatever draws it, and for a crop those of
// the whole.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
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

template <class T>
std::string channel_name(const FrameChannel<T>& row) {
    return row.aov ? std::string(aov_name(*row.aov)) : "shift";
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

/// Channels are as large as the frame where they are wanted and else empty; what they hold is finite, but for
/// depths where nothing is and hours of sun there.
inline void expect_channels(const Frame& frame, const FrameOptions& options) {
    const auto finite = [](const auto& value) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, Vec3f>) {
            return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
        } else {
            return std::isfinite(static_cast<float>(value));
        }
    };
    EXPECT_TRUE(std::all_of(frame.radiance.pixels.begin(), frame.radiance.pixels.end(), finite));
    for_each_channel([&](const auto& row) {
        const auto& channel = frame.*row.pixels;
        const bool wanted = options.*row.wanted;
        ASSERT_EQ(channel.width, wanted ? frame.width : 0) << channel_name(row);
        ASSERT_EQ(channel.height, wanted ? frame.height : 0) << channel_name(row);
        if (row.aov == Aov::depth || row.aov == Aov::sun_hours) return;
        EXPECT_TRUE(std::all_of(channel.pixels.begin(), channel.pixels.end(), finite)) << channel_name(row);
    });
}

/// `part` is the crop of `whole`: the picture and all channels of both.
inline void expect_part_of(const Frame& part, const Frame& whole, const Region& crop) {
    ASSERT_EQ(part.x0, crop.x0);
    ASSERT_EQ(part.y0, crop.y0);
    ASSERT_EQ(part.width, crop.width);
    ASSERT_EQ(part.height, crop.height);
    ASSERT_EQ(whole.x0, 0);
    ASSERT_EQ(whole.y0, 0);
    ASSERT_LE(crop.x0 + crop.width, whole.width);
    ASSERT_LE(crop.y0 + crop.height, whole.height);
    const auto same = [&](const auto& of_part, const auto& of_whole, const std::string& name) {
        for (int y = 0; y < crop.height; ++y) {
            const auto* row = of_whole.row(y + crop.y0) + crop.x0;
            ASSERT_EQ(0,
                      std::memcmp(of_part.row(y), row, sizeof(*row) * static_cast<std::size_t>(crop.width)))
                << name << ", row " << y;
        }
    };
    same(part.radiance.view(), whole.radiance.view(), "radiance");
    for_each_channel([&](const auto& row) {
        if ((whole.*row.pixels).width > 0)
            same((part.*row.pixels).view(), (whole.*row.pixels).view(), channel_name(row));
    });
}

/// Drawn by `first`, then by every kernel with the most threads and by the widest with all counts of them,
/// then without channels, then the crop. The scalar reference, which asks every triangle, draws nothing but
/// `first`, and the picture alone with two threads where `first` is the reference, too.
inline void expect_one_picture(const Scene& scene, const Region& crop, const Exec& first = {Isa::ref, 1},
                               const std::vector<int>& threads = {1, 3}) {
    FrameOptions options = all_channels(scene.outputs);
    const Frame whole = render_frame(scene, options, first);
    expect_channels(whole, options);
    const std::uint64_t expected = hash_of_all(whole);
    const int most = *std::max_element(threads.begin(), threads.end());
    for (const Isa isa : supported_isas()) {
        if (isa == Isa::ref) continue;
        for (const int count : threads) {
            if (isa != best_isa() && count != most) continue;
            EXPECT_EQ(hash_of_all(render_frame(scene, options, {isa, count})), expected)
                << isa_name(isa) << ", " << count << " threads";
        }
        EXPECT_EQ(hash(render_frame(scene, {}, {isa, most})), hash(whole))
            << isa_name(isa) << ", no channels";
    }
    if (first.isa == Isa::ref) {
        EXPECT_EQ(hash(render_frame(scene, {}, {Isa::ref, 2})), hash(whole));
    }
    options.crop = crop;
    const Frame part = render_frame(scene, options);
    expect_channels(part, options);
    expect_part_of(part, whole, crop);
}

}  // namespace obscura
