#pragma once
// Parts of a courtyard and of a house, grown from a few numbers. Each function is deterministic in its
// parameters: the same struct gives the same bits everywhere. What it makes stands on y = 0 about the origin,
// faces +Z unless said otherwise, consists of closed solids (see scenes/shapes.h), which may touch and pierce
// one another, and names its material slots. A scene file names them as shapes
// (app/scene/generators.cpp has the ranges of single parameters). problem() says what is wrong between
// parameters, in words for the person who wrote them; "" = nothing.

#include <string>

#include "scenes/build.h"

namespace obscura {

/// A row of round arches on columns that runs along X, each open from front to back.
struct ArcadeParams {
    int bays = 6;                   ///< arches
    double bay_m = 3.0;             ///< from column axis to column axis
    double column_m = 2.7;          ///< floor to springing line: base, shaft, capital and impost
    double column_radius_m = 0.19;  ///< of the shaft at its foot
    double wall_m = 0.56;           ///< thickness of the wall the arches carry
    double above_m = 0.55;          ///< wall between the crown of the arches and the cornice
    int smoothness = 1;             ///< 1: 24 facets around a column; each step adds 12
};
GeneratedModel arcade(const ArcadeParams& params);
std::string problem(const ArcadeParams& params);

/// Straight flight that climbs towards -Z: solid steps, overhanging treads, a sloping parapet on either side.
/// The lowest riser is at z = 0.
struct StairsParams {
    int steps = 12;
    double width_m = 2.4;  ///< between the parapets
    double rise_m = 0.165;
    double going_m = 0.31;
    double parapet_m = 0.85;  ///< height of the parapets over the steps; 0 = none
};
GeneratedModel stairs(const StairsParams& params);

/// Wrought-iron fence along X: thin round bars with spear finials, two rails, posts with balls.
struct FenceParams {
    double length_m = 6.0;
    double height_m = 1.6;    ///< tip of the bars
    double spacing_m = 0.12;  ///< between bar axes
    double bar_radius_m = 0.008;
    double post_every_m = 2.0;  ///< about; posts divide the length evenly
};
GeneratedModel fence(const FenceParams& params);
std::string problem(const FenceParams& params);

/// Broad-leaved tree. The branches compete for space (space colonisation); leaves are thin closed solids.
struct TreeParams {
    double height_m = 7.0;
    double crown_radius_m = 2.6;
    double trunk_m = 2.1;   ///< bare trunk below the crown
    int leaves = 20000;     ///< four triangles each
    double leaf_m = 0.125;  ///< length of an average leaf
    int seed = 1;
};
GeneratedModel tree(const TreeParams& params);
std::string problem(const TreeParams& params);

/// Street lamp with an open lantern: a cage of bars without glass, and a small bulb. A point light at
/// (0, lamp_light_height(params), 0) with near_m >= 0.05 starts outside the bulb and shines out between the
/// bars.
struct LampPostParams {
    double height_m = 3.4;
    double lantern_m = 0.34;  ///< width of the lantern at its widest
};
GeneratedModel lamp_post(const LampPostParams& params);
std::string problem(const LampPostParams& params);
double lamp_light_height(const LampPostParams& params);

/// Terracotta pot with earth and a clipped shrub.
struct PlanterParams {
    double radius_m = 0.32;  ///< of the rim
    double height_m = 0.50;  ///< of the pot
    double shrub_m = 0.42;   ///< radius of the shrub
    int leaves = 2600;
    int seed = 1;
};
GeneratedModel planter(const PlanterParams& params);

/// Clipped hedge along X: a dark core under a coat of leaves.
struct HedgeParams {
    double length_m = 6.0;
    double height_m = 1.2;
    double depth_m = 0.7;
    int leaves = 2500;
    int seed = 1;
};
GeneratedModel hedge(const HedgeParams& params);

/// Stone bench along X: a slab with a rounded edge on two profiled supports.
struct BenchParams {
    double length_m = 1.7;
    double height_m = 0.45;
    double depth_m = 0.46;
};
GeneratedModel bench(const BenchParams& params);

/// Round fountain: kerbed basin with water, baluster, upper bowl with water, finial.
struct FountainParams {
    double radius_m = 1.5;  ///< of the basin
    double height_m = 1.9;  ///< of the finial's tip
    int segments = 64;
};
GeneratedModel fountain(const FountainParams& params);

/// Flagstones in courses with open joints over a bed, level with y = 0 (the bed lies below). Sizes, tints and
/// heights vary by a few per cent and millimetres.
struct PavementParams {
    double width_m = 12.0, depth_m = 12.0;
    double stone_m = 0.62;  ///< side of an average stone
    double joint_m = 0.012;
    int seed = 1;
};
GeneratedModel pavement(const PavementParams& params);
std::string problem(const PavementParams& params);

/// A slope of barrel tiles on a board. The eaves run along X at y = 0, z = 0; the slope climbs towards -Z.
struct RoofTilesParams {
    double width_m = 8.0;
    double slope_m = 2.5;  ///< eaves to ridge, measured up the slope
    double pitch_deg = 24.0;
    double tile_m = 0.2;  ///< width of a tile
    int seed = 1;
};
GeneratedModel roof_tiles(const RoofTilesParams& params);
std::string problem(const RoofTilesParams& params);

/// Window frame with glazing bars and no glass, centred on x and z, its lower edge on y = 0.
struct WindowParams {
    double width_m = 1.2, height_m = 1.9;
    double depth_m = 0.09;  ///< of the frame along Z
    double frame_m = 0.07;  ///< face width of the frame
    double bar_m = 0.03;    ///< face width of the glazing bars
    int columns = 2, rows = 4;
};
GeneratedModel window_frame(const WindowParams& params);
std::string problem(const WindowParams& params);

/// A wall along X pierced by a row of equal openings that go right through it.
struct PiercedWallParams {
    double width_m = 6.0, height_m = 3.2, depth_m = 0.35;
    int openings = 2;
    double opening_width_m = 1.2, opening_height_m = 1.9;
    double sill_m = 0.75;  ///< lower edge of the openings
};
GeneratedModel pierced_wall(const PiercedWallParams& params);
std::string problem(const PiercedWallParams& params);
/// x of the middle of opening i, so that a frame can be set into it.
double opening_x(const PiercedWallParams& params, int i);

/// A plastered house: window bays with reveals, sills and shutters, storey bands, cornice, tiled hip or flat
/// roof.
struct HouseParams {
    double width_m = 12.0, depth_m = 7.0;
    int storeys = 2;
    double storey_m = 3.2;
    double bay_m = 2.4;   ///< about; windows divide each front evenly
    double roof_m = 1.6;  ///< height of the hip roof; 0 = flat with a parapet
    int detail = 4;       ///< 0 box, 1 cornice, 2 windows, 3 sills and lintels, 4 glazing bars and shutters
    int fronts = 4;       ///< of the four (+Z, +X, -Z, -X), how many have windows with trim
    int seed = 1;
};
GeneratedModel house(const HouseParams& params);

/// A person in a coat, of turned and rounded pieces.
struct FigureParams {
    double height_m = 1.7;                         ///< without the hat
    double girth = 1;                              ///< width and depth are scaled by it
    int hat = 0;                                   ///< 0 none, 1 pointed, 2 brimmed
    double left_arm_deg = 12, right_arm_deg = 12;  ///< raised sideways from hanging down
};
GeneratedModel figure(const FigureParams& params);

/// A lion's head on a round plate whose back is the plane z = 0, a ring in its mouth; its middle at the
/// origin.
struct LionHeadParams {
    double size_m = 0.7;  ///< diameter of the plate; the mane reaches a little beyond
};
GeneratedModel lion_head(const LionHeadParams& params);

/// A rocky coast along X with the sea at y = 0 on its +Z side: beach, a face with a ledge, a plateau inland.
struct CliffsParams {
    double width_m = 160;           ///< along the shore
    double height_m = 36;           ///< of the face
    double meander_m = 14;          ///< how far headlands and bays leave the straight shore
    double roughness = 1;           ///< of the face
    int columns = 320, rows = 160;  ///< squares along the shore and from sea to plateau
    int seed = 1;
};
GeneratedModel cliffs(const CliffsParams& params);

}  // namespace obscura
