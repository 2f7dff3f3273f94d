#pragma once
// What [stereo] and [[stereo.edit]] of a scene come to at one frame: everything that a pair is made from
// beside the scene itself.

#include <vector>

#include "stereo/edit.h"
#include "stereo/moved_mesh.h"
#include "stereo/solver.h"
#include "stereo/stereo_rig.h"

namespace obscura {

constexpr int auto_margin = -1;

struct StereoSettings {
    StereoRig rig;
    int margin_px = auto_margin;    ///< columns that the middle view has on either side of the picture; >= 0
    int map_scale = 1;              ///< the system is solved at 1 : 1, 2, 4 or 8
    std::vector<StereoEdit> edits;  ///< weights with fades and keyframes of this frame
    EditParams edit;
    SolverParams solver;
    ReprojectParams reproject;
    bool middle_picture = false;  ///< also render what the middle camera sees, margins included: for warping
};

}  // namespace obscura
