// A smaller system from a larger one; see reduced_system.h.

#include "stereo/reduced_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace obscura {
namespace {

class Reduction {
  public:
    Reduction(const DisparitySystem& full, const MiddleView& view, int reduction)
        : full_(full),
          view_(view),
          n_(reduction),
          width_((full.width() + n_ - 1) / n_),
          height_((full.height() + n_ - 1) / n_) {}

    DisparitySystem system(const Exec& exec) const {
        DisparitySystem low;
        low.original = sampled(full_.original);
        low.start = sampled(full_.start);
        low.valid = sampled(full_.valid);
        low.gradient_weight = full_.gradient_weight;
        low.epsilon = full_.epsilon * static_cast<float>(n_ * n_);
        low.gradient_x = low.gradient_y = low.anchor_weight = low.anchor_value =
            Image<float>(width_, height_);
        parallel_blocks(static_cast<std::size_t>(height_), 8, exec, [&](std::size_t begin, std::size_t end) {
            for (auto j = static_cast<int>(begin); j < static_cast<int>(end); ++j)
                fill_row(j, low);
        });
        for (const MatchingSet& set : full_.sets)
            add_set(set, low);
        for (const AnchorArea& area : full_.anchors) {
            AnchorArea small{area.name, area.weight * static_cast<float>(n_ * n_),
                             sampled_members(area.pixels)};
            if (!small.pixels.empty()) low.anchors.push_back(std::move(small));
        }
        return low;
    }

  private:
    int column(int i) const { return sampled_pixel(i, n_, full_.width()); }
    int row(int j) const { return sampled_pixel(j, n_, full_.height()); }

    void fill_row(int j, DisparitySystem& low) const {
        const int y = row(j);
        for (int i = 0; i < width_; ++i) {
            const int x = column(i);
            if (i + 1 < width_) low.gradient_x(i, j) = along_row(x, column(i + 1), y);
            if (j + 1 < height_) low.gradient_y(i, j) = along_column(x, y, row(j + 1));
            if (full_.valid(x, y) != 0)
                std::tie(low.anchor_weight(i, j), low.anchor_value(i, j)) = anchor(i, j);
        }
    }

    template <class T>
    Image<T> sampled(const Image<T>& image) const {
        Image<T> small(width_, height_);
        for (int j = 0; j < height_; ++j)
            for (int i = 0; i < width_; ++i)
                small(i, j) = image(column(i), row(j));
        return small;
    }

    /// The original's difference, exactly, and what edits change of the gradients on the way.
    float along_row(int x0, int x1, int y) const {
        float change = 0;
        for (int x = x0; x < x1; ++x)
            if (full_.valid(x, y) != 0 && full_.valid(x + 1, y) != 0)
                change += full_.gradient_x(x, y) - (full_.original(x + 1, y) - full_.original(x, y));
        const float difference = full_.original(x1, y) - full_.original(x0, y);
        return change == 0 ? difference : difference + change;
    }
    float along_column(int x, int y0, int y1) const {
        float change = 0;
        for (int y = y0; y < y1; ++y)
            if (full_.valid(x, y) != 0 && full_.valid(x, y + 1) != 0)
                change += full_.gradient_y(x, y) - (full_.original(x, y + 1) - full_.original(x, y));
        const float difference = full_.original(x, y1) - full_.original(x, y0);
        return change == 0 ? difference : difference + change;
    }

    /// Weight and value at a sample: of what its object's pixels in its block ask for. Where it is not
    /// anchored itself, it takes their change.
    std::pair<float, float> anchor(int i, int j) const {
        const int x = column(i), y = row(j);
        const std::uint32_t object = view_.object(x, y);
        double weight = 0, change = 0;
        for (int v = j * n_; v < std::min((j + 1) * n_, full_.height()); ++v) {
            for (int u = i * n_; u < std::min((i + 1) * n_, full_.width()); ++u) {
                if (full_.valid(u, v) == 0 || view_.object(u, v) != object) continue;
                const auto w = static_cast<double>(full_.anchor_weight(u, v));
                weight += w;
                if (w > 0) change += w * static_cast<double>(full_.anchor_value(u, v) - full_.original(u, v));
            }
        }
        if (!(weight > 0)) return {0.0f, 0.0f};
        const float value = full_.anchor_weight(x, y) > 0
                                ? full_.anchor_value(x, y)
                                : full_.original(x, y) + static_cast<float>(change / weight);
        return {static_cast<float>(weight), value};
    }

    /// The sample that stands for a pixel of the full map: the nearest valid one of the same object in the
    /// 3 x 3 blocks around it, or else the nearest valid one.
    std::optional<std::pair<int, int>> nearest(int x, int y) const {
        std::optional<std::pair<int, int>> best;
        std::int64_t best_distance = 0;
        for (int j = std::max(y / n_ - 1, 0); j <= std::min(y / n_ + 1, height_ - 1); ++j) {
            for (int i = std::max(x / n_ - 1, 0); i <= std::min(x / n_ + 1, width_ - 1); ++i) {
                if (full_.valid(column(i), row(j)) == 0) continue;
                const std::int64_t dx = column(i) - x, dy = row(j) - y;
                const bool other = view_.object(column(i), row(j)) != view_.object(x, y);
                const std::int64_t distance = dx * dx + dy * dy + (other ? std::int64_t{1} << 40 : 0);
                if (best && distance >= best_distance) continue;
                best = {i, j};
                best_distance = distance;
            }
        }
        return best;
    }

    std::vector<MatchedPixel> sampled_members(const std::vector<MatchedPixel>& members) const {
        std::vector<MatchedPixel> kept;
        for (const MatchedPixel& m : members)
            if (column(m.x / n_) == m.x && row(m.y / n_) == m.y)
                kept.push_back({m.x / n_, m.y / n_, m.target});
        return kept;
    }

    void add_set(const MatchingSet& set, DisparitySystem& low) const {
        const auto source = nearest(set.source_x, set.source_y);
        MatchingSet small{set.name, 0, 0, set.weight * static_cast<float>(n_ * n_),
                          sampled_members(set.members)};
        if (!source || small.members.empty()) return;
        std::tie(small.source_x, small.source_y) = *source;
        // Members keep their distance to the source itself: its sample differs by as much as D~ does.
        const float step = full_.start(set.source_x, set.source_y) - low.start(source->first, source->second);
        for (MatchedPixel& m : small.members)
            m.target += step;
        low.sets.push_back(std::move(small));
    }

    const DisparitySystem& full_;
    const MiddleView& view_;
    int n_, width_, height_;
};

}  // namespace

DisparitySystem reduced_system(const DisparitySystem& full, const MiddleView& view, int reduction,
                               const Exec& exec) {
    CHECK(view.reduction == 1 && view.width() == full.width() && view.height() == full.height() &&
              (reduction == 1 || reduction == 2 || reduction == 4 || reduction == 8),
          fmt::format("1:{} of {} x {}", reduction, full.width(), full.height()));
    return Reduction(full, view, reduction).system(exec);
}

}  // namespace obscura
