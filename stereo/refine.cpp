#include "stereo/refine.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stereo/hidden_change.h"
#include "stereo/pixel_fit.h"

namespace obscura {
namespace {

/// Triangles shorter than this are not cut.
constexpr double least_edge_px = 1.0;
/// Below this, corners follow the pixels of their triangles at once: the gather looks further than such
/// triangles go, and would round off every crease of the map.
constexpr double fitted_edge_px = 6.0;
/// A triangle that touches a smooth map at its corners leaves all of its error on one side; the plane that
/// fits has half on either side. Misses up to so many tolerances are worth that attempt before a cut.
constexpr double fit_before_cut = 2.0;
/// Points that moved less than this share of the tolerance rest until a triangle around them is cut.
constexpr double rest_share = 0.02;

/// State of the rounds.
class Refinement {
  public:
    Refinement(const SeenChange& seen, const ReprojectParams& params, const Exec& exec, Bisection& surface)
        : seen_(seen), params_(params), exec_(exec), surface_(surface), missed_(surface.triangles.size()) {
        for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
            if (surface.triangles[t].pixels > 0) shown_.push_back(t);
        }
        state_.resize(surface.points.size());
        for (std::size_t p = 0; p < state_.size(); ++p)
            state_[p] = surface.points[p].seen ? Follow::gathered : Follow::moving;
        changed_ = shown_;
    }

    /// Fits what is free, looks at what may have changed, cuts what misses. False when nothing was cut.
    bool round() {
        fit();
        look();
        return cut();
    }

    void finish(ReprojectStats& stats) {
        fit();
        look();
        std::int64_t pixels = 0, missed = 0;
        for (const std::uint32_t t : shown_) {
            pixels += surface_.triangles[t].pixels;
            missed += missed_[t].pixels;
        }
        stats.within = pixels == 0 ? 1.0 : 1.0 - static_cast<double>(missed) / static_cast<double>(pixels);
        stats.triangles_out = static_cast<std::int64_t>(surface_.triangles.size());
    }

  private:
    int free_corners(const FineTriangle& t) const {
        int count = 0;
        for (const std::uint32_t p : t.point)
            count += state_[p] != Follow::gathered ? 1 : 0;
        return count;
    }

    void fit() {
        std::vector<std::uint32_t> list;
        for (const std::uint32_t t : shown_) {
            const auto& p = surface_.triangles[t].point;
            if (std::any_of(p, p + 3, [&](std::uint32_t q) { return state_[q] == Follow::moving; }))
                list.push_back(t);
        }
        if (list.empty()) return;
        for (const PointMove& move : fit_points(seen_, list, state_, exec_, surface_)) {
            if (std::fabs(move.moved_px) < rest_share * params_.tolerance_px)
                state_[move.point] = Follow::resting;
        }
        changed_.insert(changed_.end(), list.begin(), list.end());
    }

    void look() {
        std::sort(changed_.begin(), changed_.end());
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        parallel_blocks(changed_.size(), 64, exec_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                missed_[changed_[i]] = miss_of(seen_, surface_, changed_[i], params_.tolerance_px);
        });
    }

    /// What misses and can be cut. Corners that had not been fitted to pixels are to be `freed` instead, or
    /// as well.
    std::vector<std::uint32_t> missing(std::vector<std::uint32_t>& freed) const {
        std::vector<std::uint32_t> cut;
        for (const std::uint32_t t : changed_) {
            const FineTriangle& f = surface_.triangles[t];
            if (!(static_cast<double>(missed_[t].worst_px) > params_.tolerance_px)) continue;
            const bool crosses = surface_.crosses_near(f);
            const double longest2 = surface_.longest2(f);
            if (!crosses && free_corners(f) < 3) {
                const bool fits =
                    static_cast<double>(missed_[t].worst_px) <= fit_before_cut * params_.tolerance_px;
                if (fits || longest2 <= fitted_edge_px * fitted_edge_px)
                    freed.insert(freed.end(), f.point, f.point + 3);
                if (fits) continue;
            }
            const bool small = longest2 <= least_edge_px * least_edge_px && !crosses;
            if (!small && f.cuts < static_cast<std::uint32_t>(params_.max_splits)) cut.push_back(t);
        }
        return cut;
    }

    /// One after the other: which of two neighbours is cut first decides how they meet.
    void cut_all(const std::vector<std::uint32_t>& list) {
        std::vector<std::uint32_t> cuts(list.size());
        for (std::size_t i = 0; i < list.size(); ++i)
            cuts[i] = surface_.triangles[list[i]].cuts;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (static_cast<std::int64_t>(surface_.triangles.size()) >= params_.max_triangles) break;
            // A neighbour may have cut it already.
            if (surface_.triangles[list[i]].cuts == cuts[i]) surface_.cut(list[i], changed_);
        }
    }

    bool cut() {
        const std::size_t points = surface_.points.size(), triangles = surface_.triangles.size();
        std::vector<std::uint32_t> freed;
        const std::vector<std::uint32_t> list = missing(freed);
        changed_.clear();
        cut_all(list);
        for (const std::uint32_t p : freed)
            state_[p] = Follow::moving;
        gather_seen(seen_, exec_, std::span(surface_.points).subspan(points));
        state_.resize(surface_.points.size());
        for (std::size_t p = points; p < state_.size(); ++p)
            state_[p] = surface_.points[p].seen ? Follow::gathered : Follow::moving;

        for (const std::uint32_t t : changed_) {
            for (const std::uint32_t p : surface_.triangles[t].point) {
                if (state_[p] == Follow::resting) state_[p] = Follow::moving;
            }
        }

        // What is new, and what lost its pixels to it.
        missed_.resize(surface_.triangles.size());
        for (auto t = static_cast<std::uint32_t>(triangles); t < surface_.triangles.size(); ++t)
            shown_.push_back(t);
        for (const std::uint32_t t : changed_)
            missed_[t] = {};
        const auto shows_nothing = [&](std::uint32_t t) { return surface_.triangles[t].pixels == 0; };
        std::erase_if(shown_, shows_nothing);
        std::erase_if(changed_, shows_nothing);
        return !freed.empty() || surface_.triangles.size() > triangles;
    }

    const SeenChange& seen_;
    const ReprojectParams& params_;
    const Exec& exec_;
    Bisection& surface_;
    std::vector<Follow> state_;           ///< per point
    std::vector<Miss> missed_;            ///< per triangle
    std::vector<std::uint32_t> shown_;    ///< triangles with pixels
    std::vector<std::uint32_t> changed_;  ///< of those, the ones to look at
};

}  // namespace

void refine(const SeenChange& seen, const ReprojectParams& params, const Exec& exec, Bisection& surface,
            ReprojectStats& stats) {
    Refinement refinement(seen, params, exec, surface);
    do {
        ++stats.rounds;
    } while (refinement.round());
    refinement.finish(stats);
}

}  // namespace obscura
