#include "stereo/refine.h"

#include <algorithm>

#include "core/parallel.h"
#include "stereo/hidden_change.h"
#include "stereo/pixel_fit.h"

namespace obscura {
namespace {

/// Triangles shorter than this are not cut.
constexpr double least_edge_px = 1.0;
/// Below this, corners are fitted to the pixels around them: the gather looks further than such triangles go,
/// and would round off every crease of the map.
constexpr double fitted_edge_px = 6.0;
constexpr int fit_sweeps = 3;

/// State of the rounds.
class Refinement {
  public:
    Refinement(const SeenChange& seen, const ReprojectParams& params, const Exec& exec, Bisection& surface)
        : seen_(seen), params_(params), exec_(exec), surface_(surface), missed_(surface.triangles.size(), 0) {
        for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
            if (surface.triangles[t].pixels > 0) shown_.push_back(t);
        }
        free_.resize(surface.points.size());
        for (std::size_t p = 0; p < free_.size(); ++p)
            free_[p] = surface.points[p].seen ? 0 : 1;
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
            missed += missed_[t];
        }
        stats.within = pixels == 0 ? 1.0 : 1.0 - static_cast<double>(missed) / static_cast<double>(pixels);
        stats.triangles_out = static_cast<std::int64_t>(surface_.triangles.size());
    }

  private:
    /// Shown triangles with a corner that follows its pixels. What it is changes with every round.
    std::vector<std::uint32_t> followers() const {
        std::vector<std::uint32_t> list;
        for (const std::uint32_t t : shown_) {
            const auto& p = surface_.triangles[t].point;
            if ((free_[p[0]] | free_[p[1]] | free_[p[2]]) != 0) list.push_back(t);
        }
        return list;
    }

    void fit() {
        const std::vector<std::uint32_t> list = followers();
        if (list.empty()) return;
        for (int sweep = 0; sweep < fit_sweeps; ++sweep)
            fit_points(seen_, list, free_, exec_, surface_);
        changed_.insert(changed_.end(), list.begin(), list.end());
    }

    void look() {
        std::sort(changed_.begin(), changed_.end());
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        parallel_blocks(changed_.size(), 64, exec_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                missed_[changed_[i]] = missed_pixels(seen_, surface_, changed_[i], params_.tolerance_px);
        });
    }

    bool cut() {
        std::vector<std::uint32_t> cut;
        const std::size_t points = surface_.points.size(), triangles = surface_.triangles.size();
        for (const std::uint32_t t : changed_) {
            const FineTriangle& f = surface_.triangles[t];
            if (missed_[t] == 0) continue;
            const double longest2 = surface_.longest2(f);
            if (longest2 <= fitted_edge_px * fitted_edge_px && !surface_.crosses_near(f)) {
                for (const std::uint32_t p : f.point)
                    free_[p] = 1;
            }
            const bool small = longest2 <= least_edge_px * least_edge_px && !surface_.crosses_near(f);
            if (!small && f.cuts < static_cast<std::uint32_t>(params_.max_splits)) cut.push_back(t);
        }
        changed_.clear();
        std::vector<std::uint32_t> cuts_before(cut.size());
        for (std::size_t i = 0; i < cut.size(); ++i)
            cuts_before[i] = surface_.triangles[cut[i]].cuts;
        for (std::size_t i = 0; i < cut.size(); ++i) {
            if (static_cast<std::int64_t>(surface_.triangles.size()) >= params_.max_triangles) break;
            // A neighbour may have cut it already.
            if (surface_.triangles[cut[i]].cuts == cuts_before[i]) surface_.cut(cut[i], changed_);
        }
        gather_seen(seen_, exec_, std::span(surface_.points).subspan(points));
        free_.resize(surface_.points.size());
        for (std::size_t p = points; p < free_.size(); ++p)
            free_[p] = surface_.points[p].seen ? 0 : 1;

        // What is new, and what lost its pixels to it.
        missed_.resize(surface_.triangles.size(), 0);
        for (auto t = static_cast<std::uint32_t>(triangles); t < surface_.triangles.size(); ++t) {
            if (surface_.triangles[t].pixels > 0) shown_.push_back(t);
        }
        std::erase_if(shown_, [&](std::uint32_t t) { return surface_.triangles[t].pixels == 0; });
        for (const std::uint32_t t : changed_)
            missed_[t] = 0;
        std::erase_if(changed_, [&](std::uint32_t t) { return surface_.triangles[t].pixels == 0; });
        return surface_.triangles.size() > triangles;
    }

    const SeenChange& seen_;
    const ReprojectParams& params_;
    const Exec& exec_;
    Bisection& surface_;
    std::vector<std::uint8_t> free_;      ///< per point: follows the pixels of its triangles
    std::vector<std::uint32_t> missed_;   ///< per triangle: pixels beyond the tolerance
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
