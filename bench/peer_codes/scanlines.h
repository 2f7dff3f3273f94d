#pragma once
// Scanline compression: every row of a map as few segments, each a depth or a line of depths that lies in the
// intervals of all its texels.
//
// J. Arvo, M. Hirvikorpi, "Compressed Shadow Maps", The Visual Computer 21(3), 2005. Theirs cuts rows
// anywhere, ours between texels, since what is compared here are maps of texels. Each segment is the longest
// that begins where the one before ends, which is the least number of them. Lines by J. O'Rourke, "An On-Line
// Algorithm for Fitting Straight Lines Between Data Ranges", Communications of the ACM 24(9), 1981.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.h"

namespace obscura {

enum class ScanFit { constant, linear };

/// From texel `first` on to where the next one begins.
struct ScanSegment {
    std::uint32_t first = 0;
    float depth = 0;  ///< at `first`
    float slope = 0;  ///< per texel; linear
};

/// Bytes of a stored segment: its place and depth, and if linear its slope.
constexpr std::uint64_t segment_bytes(ScanFit fit) {
    return fit == ScanFit::constant ? 8 : 12;
}

/// What readers compute. The product is exact in double.
inline float segment_depth(const ScanSegment& segment, std::uint32_t x) {
    return static_cast<float>(double{segment.depth} + double{segment.slope} * (x - segment.first));
}

/// The segments of one row, left to right, in place of what `out` had.
void fit_row(std::span<const DepthInterval> row, ScanFit fit, std::vector<ScanSegment>& out);

/// A map of such rows.
class ScanlineMap {
  public:
    explicit ScanlineMap(ScanFit fit) : fit_(fit) {}
    void add_row(std::span<const DepthInterval> row);
    /// Stored depth, by bisection of its row.
    float depth(std::uint32_t x, std::uint32_t y) const;
    /// Segments, and where each row begins.
    std::uint64_t bytes() const;

  private:
    ScanFit fit_;
    std::vector<std::size_t> rows_ = {0};  ///< first segment of each, and their end
    std::vector<ScanSegment> segments_, row_;
};

/// Of so many segments in so many rows.
constexpr std::uint64_t scanline_bytes(ScanFit fit, std::uint64_t segments, std::uint64_t rows) {
    return segments * segment_bytes(fit) + (rows + 1) * sizeof(std::uint32_t);
}

}  // namespace obscura
