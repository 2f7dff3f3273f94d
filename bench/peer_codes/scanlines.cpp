#include "bench/peer_codes/scanlines.h"

#include <algorithm>

#include "core/error.h"

namespace obscura {
namespace {

using Row = std::span<const DepthInterval>;

struct Point {
    double x, y;
};

/// Whether b lies above the line from a to c, which are left and right of it; below: negative.
double above(Point a, Point b, Point c) {
    return (b.y - a.y) * (c.x - a.x) - (c.y - a.y) * (b.x - a.x);
}

/// The convex hull of points from left to right, seen from above (`side` 1) or below (-1). The front is cut
/// off where no tangent will touch it again.
class Hull {
  public:
    explicit Hull(double side) : side_(side) {}
    void clear() {
        points_.clear();
        front_ = 0;
    }
    void add(Point p) {
        while (points_.size() >= front_ + 2 &&
               side_ * above(points_[points_.size() - 2], points_.back(), p) <= 0)
            points_.pop_back();
        points_.push_back(p);
    }
    /// Where the line from the hull to p, a point right of it on its open side, touches.
    Point tangent(Point p) {
        while (front_ + 1 < points_.size() && side_ * above(points_[front_], points_[front_ + 1], p) >= 0)
            ++front_;
        return points_[front_];
    }

  private:
    double side_;
    std::vector<Point> points_;
    std::size_t front_ = 0;
};

/// All lines through the intervals of a row's texels so far, in real numbers: they lie between the steepest
/// and the flattest.
class LineFan {
  public:
    /// Takes the next texel; false when no line reaches it too.
    bool take(DepthInterval interval) {
        const double x = static_cast<double>(count_);
        const Point low{x, interval.entry}, high{x, interval.exit};
        if (count_ == 1) {
            steepest_ = line(first_low_, high);
            flattest_ = line(first_high_, low);
        } else if (count_ > 1) {
            const double most = steepest_.at(x), least = flattest_.at(x);
            if (low.y > most || high.y < least) return false;
            if (high.y < most) steepest_ = line(lows_.tangent(high), high);
            if (low.y > least) flattest_ = line(highs_.tangent(low), low);
        } else {
            first_low_ = low;
            first_high_ = high;
        }
        lows_.add(low);
        highs_.add(high);
        ++count_;
        return true;
    }
    void clear() {
        lows_.clear();
        highs_.clear();
        count_ = 0;
    }
    double middle_slope() const { return count_ < 2 ? 0 : 0.5 * (steepest_.slope + flattest_.slope); }

  private:
    struct Line {
        double slope = 0, y0 = 0;
        double at(double x) const { return y0 + slope * x; }
    };
    static Line line(Point a, Point b) {
        const double slope = (b.y - a.y) / (b.x - a.x);
        return {slope, a.y - slope * a.x};
    }

    Hull lows_{1}, highs_{-1};
    Line steepest_, flattest_;
    Point first_low_{}, first_high_{};
    std::size_t count_ = 0;
};

/// Depths a at the first texel with which a + slope * i lies in every interval, in double.
struct Offsets {
    double low = -1e300, high = 1e300;
    Offsets met(DepthInterval interval, double rise) const {
        return {std::max(low, interval.entry - rise), std::min(high, interval.exit - rise)};
    }
};

/// In how many of the row's texels, from the first on, readers find a depth of the interval.
std::size_t served(Row row, const ScanSegment& segment) {
    std::size_t count = 0;
    for (; count < row.size(); ++count) {
        const float z = segment_depth(segment, segment.first + static_cast<std::uint32_t>(count));
        if (!(row[count].entry <= z && z <= row[count].exit)) break;
    }
    return count;
}

/// How many texels one depth serves, and which.
std::size_t constant_run(Row row, ScanSegment& segment) {
    DepthInterval common = row[0];
    std::size_t count = 1;
    for (; count < row.size(); ++count) {
        const DepthInterval next{std::max(common.entry, row[count].entry),
                                 std::min(common.exit, row[count].exit)};
        if (next.entry > next.exit) break;
        common = next;
    }
    segment.depth = common.entry;
    return count;
}

/// How many texels one line serves, and which. The longest line of real numbers may be none of floats, where
/// intervals have no width: the part of it that a rounded slope still serves is taken.
std::size_t linear_run(Row row, LineFan& fan, ScanSegment& segment) {
    fan.clear();
    std::size_t longest = 0;
    while (longest < row.size() && fan.take(row[longest]))
        ++longest;
    segment.slope = static_cast<float>(fan.middle_slope());
    Offsets offsets;
    std::size_t count = 0;
    for (; count < longest; ++count) {
        const Offsets next = offsets.met(row[count], double{segment.slope} * static_cast<double>(count));
        if (next.low > next.high) break;
        offsets = next;
    }
    // No float may lie between: then the nearest, as far as it serves.
    segment.depth = static_cast<float>(0.5 * (offsets.low + offsets.high));
    return served(row.first(count), segment);
}

}  // namespace

void fit_row(Row row, ScanFit fit, std::vector<ScanSegment>& out) {
    out.clear();
    static thread_local LineFan fan;
    for (std::size_t at = 0; at < row.size();) {
        ScanSegment constant{static_cast<std::uint32_t>(at)}, line = constant;
        const std::size_t flat = constant_run(row.subspan(at), constant);
        const std::size_t sloped = fit == ScanFit::linear ? linear_run(row.subspan(at), fan, line) : 0;
        out.push_back(sloped > flat ? line : constant);
        at += std::max(sloped, flat);
    }
}

void ScanlineMap::add_row(Row row) {
    fit_row(row, fit_, row_);
    segments_.insert(segments_.end(), row_.begin(), row_.end());
    rows_.push_back(segments_.size());
}

float ScanlineMap::depth(std::uint32_t x, std::uint32_t y) const {
    const auto begin = segments_.begin() + static_cast<std::ptrdiff_t>(rows_[y]);
    const auto end = segments_.begin() + static_cast<std::ptrdiff_t>(rows_[y + 1]);
    const auto behind = std::upper_bound(
        begin, end, x, [](std::uint32_t place, const ScanSegment& segment) { return place < segment.first; });
    CHECK(behind != begin);
    return segment_depth(*(behind - 1), x);
}

std::uint64_t ScanlineMap::bytes() const {
    return scanline_bytes(fit_, segments_.size(), rows_.size() - 1);
}

}  // namespace obscura
