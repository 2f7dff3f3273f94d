#pragma once
// Two eyes beside the camera, and the viewer in front of the screen.
//
// The rig is off-axis: both eyes look parallel to the middle view and shift their frustums so that what lies
// at the zero-parallax distance falls on the same pixel in both. Scandolo, Bauszat, Eisemann,
// "Gradient-Guided Local Disparity Editing", CGF 2018 (thesis, section 4.3.1), after Mendiburu, "3D Movie
// Making", 2009. Disparity is left minus right in pixels of the picture, measured where the middle view sees
// the point: positive in front of the screen.

namespace obscura {

struct Camera;

struct StereoRig {
    double interaxial_m = 0.065;  ///< between the eyes, > 0
    double zero_parallax_m = 5;   ///< distance along the view axis at which disparity is 0, > 0
    double screen_width_m = 0.6;  ///< of the whole picture
    double viewing_distance_m = 0.7;
    double eye_separation_m = 0.063;  ///< of the viewer
};

/// How distance becomes disparity at one picture size: d(z) = scale / z - offset, pixels; z in metres along
/// the view axis.
struct DisparityLaw {
    double scale = 0;   ///< f_px * interaxial, pixel metres
    double offset = 0;  ///< scale / zero_parallax: minus the disparity of infinity, pixels
    double focal_px = 0;
    /// Disparity at z > 0; infinity gives -offset.
    float at(double z_m) const { return static_cast<float>(scale / z_m - offset); }
};

/// The law of a perspective camera's picture `height` pixels high. CHECKs that it is perspective: parallel
/// rays have no disparity.
DisparityLaw disparity_law(const StereoRig& rig, const Camera& camera, int height);

/// Disparity in percent of the picture's width.
inline double percent_of_width(double disparity_px, int picture_width) {
    return 100.0 * disparity_px / picture_width;
}
/// How far the viewer's eyes turn in more than for the screen itself, degrees, for disparity on a screen that
/// the picture fills; straight ahead. Positive in front of the screen. Past parallel (uncrossed disparity
/// wider than the eyes' separation) the angle goes on falling.
double vergence_deg(double disparity_px, int picture_width, const StereoRig& rig);
/// The inverse: disparity in pixels of a vergence in degrees; infinite for more than lines of sight that meet
/// between the eyes.
double disparity_of_vergence(double vergence_deg, int picture_width, const StereoRig& rig);

}  // namespace obscura
