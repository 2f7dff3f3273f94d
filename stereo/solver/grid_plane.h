#pragma once
// Pictures of floats with a frame of zeros, and rings of rows: what the row loops (grid_rows.h) run on.

#include <algorithm>
#include <cstddef>

#include "core/buffer.h"

namespace obscura {

/// Floats that a row of `width` takes in the row loops: a multiple of 16.
constexpr int row_count(int width) {
    return (width + 15) / 16 * 16;
}
/// Zeros before a row; after it there are as many and the rest of a multiple of 16.
constexpr int row_padding = 32;

/// width x height floats within zeros: a row above and one below, row_padding floats on either side. Rows
/// are aligned to 64 bytes. What a loop writes beyond `width` must be 0.
class GridPlane {
  public:
    GridPlane() = default;
    GridPlane(int width, int height) : GridPlane(width, height, Uninitialised{}) {
        std::fill(data_.begin(), data_.end(), 0.0f);
    }
    /// The frame alone is 0: every row must be written, to row_count(width), before it is read.
    static GridPlane framed(int width, int height) {
        GridPlane plane(width, height, Uninitialised{});
        std::fill_n(plane.row(-1) - row_padding, plane.stride_, 0.0f);
        for (int y = 0; y < height; ++y) {
            std::fill_n(plane.row(y) - row_padding, row_padding, 0.0f);
            std::fill_n(plane.row(y) + width, plane.stride_ - row_padding - width, 0.0f);
        }
        std::fill_n(plane.row(height) - row_padding, plane.stride_, 0.0f);
        return plane;
    }
    bool empty() const { return data_.size() == 0; }
    int width() const { return width_; }
    int height() const { return height_; }
    int count() const { return row_count(width_); }
    /// Row y in [-1, height].
    float* row(int y) { return data_.data() + (y + 1) * stride_ + row_padding; }
    const float* row(int y) const { return data_.data() + (y + 1) * stride_ + row_padding; }
    std::size_t bytes() const { return data_.size() * sizeof(float); }

  private:
    struct Uninitialised {};
    GridPlane(int width, int height, Uninitialised)
        : width_(width),
          height_(height),
          stride_(row_count(width) + 2 * row_padding),
          data_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2)) {}

    int width_ = 0, height_ = 0;
    std::ptrdiff_t stride_ = 0;
    Buffer<float> data_;
};

/// A few padded rows of working memory that follow a sweep: row y lives at y modulo `rows`.
class RowRing {
  public:
    RowRing(int width, int rows) : plane_(width, rows - 2), rows_(rows) {}
    float* row(int y) { return plane_.row((y + 2 * rows_) % rows_ - 1); }

  private:
    GridPlane plane_;
    int rows_;
};

}  // namespace obscura
