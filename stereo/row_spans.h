#pragma once
// One row of a disparity map as surfaces, drawn for an eye beside the camera that saw it.
//
// Rows of eyes that stand side by side hold the same points: a pixel at column x with disparity d moves to
// x + shift * d, and nothing leaves its row. Neighbours that belong to one smooth surface are joined into a
// polyline, so that a surface which turns towards the eye is stretched and does not tear; silhouettes are not
// joined, so that what they uncover stays empty. (After the layered and mesh forms of depth image-based
// rendering: Mark, McMillan, Bishop, "Post-Rendering 3D Warping", I3D 1997. Where they join by a
// threshold on depth, we compare with the slopes on both sides in disparity, in which planes are straight
// lines: grazing floors hold together and small steps between surfaces do not.)

#include <cstdint>
#include <limits>
#include <span>

namespace obscura {

/// One row. `original` tells what is nearer and what is joined, `disparity` where it goes; they are the same
/// before edits. NaN: nothing is known there.
struct SpanRow {
    const float* disparity = nullptr;
    const float* original = nullptr;
    const std::uint32_t* object = nullptr;  ///< or null: all one
    int width = 0;
    int margin = 0;  ///< columns before the picture's first
};

/// What the eye sees in one pixel's centre.
struct RowHit {
    float original = -std::numeric_limits<float>::infinity();
    float disparity = std::numeric_limits<float>::quiet_NaN();
    float column = 0;  ///< of the row, from centre to centre of one surface; whole numbers are centres
    bool found() const { return original > -std::numeric_limits<float>::infinity(); }
};

/// True when pixels x and x + 1 show one surface: the same object, and a step of original disparity within
/// `join_px` of 0 or of the slopes beside it.
bool joined(const SpanRow& row, int x, double join_px);

/// Draws the row for an eye at `shift` (see EyeShift); `hits`, one per pixel of its picture, are nearest
/// first come. Ends of surfaces reach half a pixel beyond their last centre.
void draw_spans(const SpanRow& row, double shift, double join_px, std::span<RowHit> hits);

}  // namespace obscura
