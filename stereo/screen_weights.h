#pragma once
// Weights of a triangle's corners at a pixel, for what is linear on the screen.

#include <algorithm>
#include <cmath>

#include "stereo/map_projection.h"

namespace obscura {

/// A point of the triangle with world barycentrics b is seen at the pixel p = sum of b_i h_i / z, h_i the
/// corners' homogeneous map points and z = sum of b_i z_i. Corners move by s_i = c_i z_i / focal metres, what
/// lies between them by sum of b_i s_i metres, which is c = sum of (b_i z_i / z) c_i pixels: the weights
/// b_i z_i / z of the corners' changes c_i are what this gives. They are linear in the pixel, they add up to
/// 1, and all of this holds for corners behind the camera, too, whose weights are negative.
class ScreenWeights {
  public:
    ScreenWeights(const MapPoint& p, const MapPoint& q, const MapPoint& r)
        : ahead_(p.z > 0 && q.z > 0 && r.z > 0) {
        set_row(0, q, r, p.z);
        set_row(1, r, p, q.z);
        set_row(2, p, q, r.z);
        // h_p . (h_q x h_r), by the first row, which holds (h_q x h_r) z_p.
        const double det = (row_[0][0] * p.xz + row_[0][1] * p.yz + row_[0][2] * p.z) / p.z;
        for (auto& row : row_) {
            for (double& a : row)
                a /= det;
        }
        if (!(det != 0) || !(row_[0][2] - row_[0][2] == 0)) degenerate();
    }
    /// Weights at a pixel of the map; in [0, 1] for triangles before the camera. Triangles are drawn with
    /// corners snapped to 1/256 pixel, so they may show pixels that lie just beside them.
    void at(double column, double row, double (&weight)[3]) const {
        for (int k = 0; k < 3; ++k)
            weight[k] = row_[k][0] * column + row_[k][1] * row + row_[k][2];
        if (!ahead_ || (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0)) return;
        double sum = 0;
        for (double& w : weight) {
            w = std::max(w, 0.0);
            sum += w;
        }
        for (double& w : weight)
            w /= sum;
    }
    /// How fast what is `corner` at the corners changes from pixel to pixel, columns and rows together.
    double slope(const double (&corner)[3]) const {
        const auto along = [&](int i) {
            return std::fabs(row_[0][i] * corner[0] + row_[1][i] * corner[1] + row_[2][i] * corner[2]);
        };
        return along(0) + along(1);
    }

  private:
    void set_row(int k, const MapPoint& a, const MapPoint& b, double z) {
        row_[k][0] = (a.yz * b.z - a.z * b.yz) * z;
        row_[k][1] = (a.z * b.xz - a.xz * b.z) * z;
        row_[k][2] = (a.xz * b.yz - a.yz * b.xz) * z;
    }
    /// Seen edge-on: the mean of the corners is as good as anything.
    void degenerate() {
        for (auto& row : row_) {
            row[0] = row[1] = 0;
            row[2] = 1.0 / 3.0;
        }
    }
    double row_[3][3];
    bool ahead_;
};

}  // namespace obscura
