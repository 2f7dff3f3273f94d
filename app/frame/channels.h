#pragma once
// The channels of a frame as rows: what asks for one, where its pixels lie, and the name that files ask for
// it by.

#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>

#include "app/frame/frame.h"
#include "app/scene/aov.h"

namespace obscura {

template <class T>
struct FrameChannel {
    bool FrameOptions::*wanted;
    Image<T> Frame::*pixels;
    std::optional<Aov> aov;  ///< none: no file asks for it
    bool by_tiles = true;    ///< written by tiles with the picture, not by passes of its own
};

inline constexpr std::tuple channel_rows{
    FrameChannel<float>{&FrameOptions::depth, &Frame::depth_m, Aov::depth},
    FrameChannel<Vec3f>{&FrameOptions::normal, &Frame::normal, Aov::normal},
    FrameChannel<Vec3f>{&FrameOptions::albedo, &Frame::albedo, Aov::albedo},
    FrameChannel<std::uint32_t>{&FrameOptions::object, &Frame::object, Aov::object},
    FrameChannel<float>{&FrameOptions::shadow, &Frame::shadow, Aov::shadow},
    FrameChannel<float>{&FrameOptions::shift, &Frame::shift_px, std::nullopt},
    FrameChannel<float>{&FrameOptions::sun_hours, &Frame::sun_hours, Aov::sun_hours, false}};

/// Calls `visit` with every row, in order.
template <class Visit>
void for_each_channel(const Visit& visit) {
    std::apply([&](const auto&... row) { (visit(row), ...); }, channel_rows);
}

constexpr int rows_of(Aov aov) {
    int rows = 0;
    std::apply([&](const auto&... row) { ((rows += row.aov == aov ? 1 : 0), ...); }, channel_rows);
    return rows;
}
static_assert(std::all_of(std::begin(aov_words), std::end(aov_words),
                          [](const auto& word) {
                              return rows_of(word.value) == (word.value == Aov::beauty ? 0 : 1);
                          }),
              "every file but the picture's shows one channel");

/// Wants what a file of `aov` shows.
inline void want_channel(Aov aov, FrameOptions& options) {
    for_each_channel([&](const auto& row) { options.*row.wanted |= row.aov == aov; });
}

}  // namespace obscura
