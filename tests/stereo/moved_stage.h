#pragma once
// A mesh on a stage: seen, edited by a function of the picture, moved.

#include <functional>

#include "stereo/moved_mesh.h"
#include "tests/stereo/views.h"

namespace obscura::stereo_views {

/// A mesh, what the camera sees of it, and a map that differs from the original by `change` of column and
/// row.
struct Stage {
    Mesh mesh;
    Camera camera;
    StereoRig rig;
    int width = 320, height = 240, margin = 0;
    MiddleView view;
    DisparityMap optimised;
    ReprojectParams params;
    ReprojectStats stats;

    Stage() {
        camera.eye = {0, 0, 5};
        camera.look_at = {0, 0, 0};
        camera.near_m = 0.1;
    }
    MovedMesh moved(const std::function<double(double, double)>& change) {
        view = middle_view(mesh, camera, width, height, margin, rig);
        optimised = view.disparity;
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                if (view.triangle(x, y) != nothing_seen)
                    optimised(x, y) += static_cast<float>(change(x + 0.5, y + 0.5));
            }
        }
        return moved_mesh(mesh, camera, view, optimised, params, {Isa::ref, 1}, stats);
    }
};

}  // namespace obscura::stereo_views
