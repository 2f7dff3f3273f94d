#pragma once
// How well a pair shows the map that it was made for: disparity measured on the moved triangles, and on the
// pictures.

#include <cstdint>

#include "app/pair/eyes.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "stereo/middle_view.h"
#include "stereo/moved_mesh.h"

namespace obscura {

/// Differences of disparity, over some pixels.
struct DisparityError {
    std::int64_t pixels = 0;  ///< compared
    std::int64_t within = 0;  ///< of these, at most the tolerance off
    double max_px = 0, rms_px = 0;
    double share() const {
        return pixels == 0 ? 1.0 : static_cast<double>(within) / static_cast<double>(pixels);
    }
};

struct RealisedDisparity {
    DisparityMap disparity;  ///< of the picture without margins; NaN where nothing is
    DisparityError error;    ///< against the optimised map
};

/// Exact reprojection: the surface point that the middle camera sees through a pixel's centre, as a place in
/// a moved triangle, is projected where either eye sees it. `optimised` has the size of `view`, which is of
/// full resolution. `scratch`: of the setup of moved.mesh. Sums run in pixel order: the same for any exec.
RealisedDisparity realised_disparity(const Scene& scene, const MovedMesh& moved, const EyeStage& left,
                                     const EyeStage& right, const MiddleView& view,
                                     const DisparityMap& optimised, double tolerance_px, const Exec& exec,
                                     RasterScratch& scratch);

/// The same from an eye's picture: the disparity of what its pixels show against the optimised map at the
/// column where the middle camera sees that point, between two pixels of the same triangle; pixels without
/// two such are left out.
DisparityError picture_error(const EyeMap& map, Eye eye, const MiddleView& view,
                             const DisparityMap& optimised, double tolerance_px);

/// Adds differences one by one.
class ErrorSum {
  public:
    explicit ErrorSum(double tolerance_px) : tolerance_px_(tolerance_px) {}
    void add(double difference_px);
    void add(const ErrorSum& part);
    DisparityError error() const;

  private:
    double tolerance_px_, squares_ = 0, max_ = 0;
    std::int64_t pixels_ = 0, within_ = 0;
};

}  // namespace obscura
