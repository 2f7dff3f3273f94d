#pragma once
// Apertures as shapes: outlines of any size, and masks with exact coverage.

#include "optics/field/aperture.h"

namespace obscura {

enum class ApertureKind {
    iris,      ///< `blades` straight or bowed edges; a corner points up
    circle,    ///< full opening
    box,       ///< rectangle
    whirl,     ///< pinwheel of `blades` curved openings around a hub
    annulus,   ///< telescope: circle less a central obstruction and its spider vanes
    slit,      ///< one or several parallel vertical slits
    grating,   ///< `lines` vertical openings side by side
    hexagons,  ///< segmented mirror: rings of hexagons around the (missing) one in the middle
};

/// Lengths called share are relative: `diameter` to the mask's side, all others to the diameter.
struct ApertureShape {
    ApertureKind kind = ApertureKind::iris;

    /// Of the circle around iris, circle, whirl, annulus, hexagons; box: its width; slit, grating: their
    /// height, and the grating's width. In (0, 2]; what does not fit into the mask is cut off.
    double diameter = 0.9;
    double rotation_deg = 0;            ///< from x towards y: clockwise as seen
    double offset_x = 0, offset_y = 0;  ///< of the centre, shares of the mask's side

    int blades = 7;         ///< iris, whirl: 3 to 64
    double bow = 0;         ///< iris: 0 straight edges, 1 arcs that make up the full circle, in [0, 1]
    double aspect = 1;      ///< box: height / width, in [1/64, 64]
    double hub = 0.16;      ///< whirl: share, the disc that all blades leave from, in (0, 1)
    double blade = 0.5;     ///< whirl: open part of each blade's turn, in (0, 1)
    double twist_deg = 80;  ///< whirl: turn of a blade between hub and rim, -360 to 360

    double obstruction = 0.3;   ///< annulus: share, in [0, 1)
    int vanes = 4;              ///< annulus: 0 to 64
    double vane_width = 0.015;  ///< annulus: share, in (0, 1)
    double vane_angle_deg = 0;  ///< annulus: of the first vane, from x towards y

    int slits = 1;            ///< 1 to 1024
    double slit_width = 0.1;  ///< share, in (0, 1]
    double slit_step = 0.3;   ///< share, from centre to centre, in (0, 1]
    int lines = 16;           ///< grating: 1 to 4096
    double duty = 0.5;        ///< grating: open part of a period, in (0, 1)

    int rings = 2;        ///< hexagons: 1 to 32
    double gap = 0.005;   ///< hexagons: share, between neighbours, in [0, 0.1]
    bool middle = false;  ///< hexagons: the central one, too

    friend bool operator==(const ApertureShape&, const ApertureShape&) = default;
};

/// "iris", "circle", "box", "whirl", "annulus", "slit", "grating", "hexagons".
const char* aperture_kind_name(ApertureKind kind);

/// Stand-ins for the thesis's four test apertures (figure 3.8): box, circle, iris (its heptagon) or whirl. It
/// prints no sizes: scales, the heptagon's turn, the box's place (two edges off the grid by one texel in
/// 1024) and the whirl's form are chosen so that a 4096 x 4096 mask has about as many quads as in its
/// Table 3.1.
ApertureShape paper_aperture(ApertureKind kind);

/// In texels of a size x size mask. Curves become chords no farther than 1e-6 texel from them; straight
/// shapes have their corners only. Throws InputError when a parameter is out of its range.
Outline outline_of(const ApertureShape& shape, int size);

/// Its exact coverage, with the outline. `diameter_m` is what shape.diameter measures, in metres. Throws
/// InputError as above, for sizes outside 1 to 32768, and for a diameter_m that is not positive and finite.
Aperture make_aperture(const ApertureShape& shape, int size, double diameter_m);

}  // namespace obscura
