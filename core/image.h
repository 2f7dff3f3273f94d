#pragma once
// Row-major pixel rectangles; row 0 is the top row.

#include <cstddef>
#include <type_traits>
#include <vector>

#include "core/error.h"

namespace obscura {

/// Borrowed pixels. `stride` counts elements from one row to the next (>= width).
template <class T>
struct ImageView {
    T* data = nullptr;
    int width = 0, height = 0;
    std::ptrdiff_t stride = 0;

    ImageView() = default;
    ImageView(T* data_, int width_, int height_, std::ptrdiff_t stride_)
        : data(data_), width(width_), height(height_), stride(stride_) {}
    /// A view of const pixels from a view of mutable ones.
    template <class U>
    requires std::is_same_v<const U, T> ImageView(ImageView<U> v)
        : ImageView(v.data, v.width, v.height, v.stride) {}  // NOLINT: implicit on purpose

    T* row(int y) const { return data + stride * y; }
    T& operator()(int x, int y) const { return data[stride * y + x]; }
    /// The rectangle [x0, x0+w) x [y0, y0+h), which must lie inside.
    ImageView crop(int x0, int y0, int w, int h) const {
        CHECK(x0 >= 0 && y0 >= 0 && w >= 0 && h >= 0 && x0 + w <= width && y0 + h <= height);
        return {data + stride * y0 + x0, w, h, stride};
    }
};

/// Owned pixels, contiguous.
template <class T>
struct Image {
    int width = 0, height = 0;
    std::vector<T> pixels;

    Image() = default;
    Image(int width_, int height_, const T& value = T{})
        : width(width_),
          height(height_),
          pixels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), value) {}

    T* row(int y) { return pixels.data() + static_cast<std::ptrdiff_t>(y) * width; }
    const T* row(int y) const { return pixels.data() + static_cast<std::ptrdiff_t>(y) * width; }
    T& operator()(int x, int y) { return row(y)[x]; }
    const T& operator()(int x, int y) const { return row(y)[x]; }
    ImageView<T> view() { return {pixels.data(), width, height, width}; }
    ImageView<const T> view() const { return {pixels.data(), width, height, width}; }
    friend bool operator==(const Image&, const Image&) = default;
};

}  // namespace obscura
