// The picture of optics/limits.md; OBSCURA_PICTURES=FOLDER writes it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "core/file_output.h"
#include "core/image_io.h"
#include "lessons/drawing/figure.h"
#include "optics/near_field_colour.h"
#include "optics/psf.h"
#include "tests/optics/cases.h"
#include "tests/optics/near_field_oracle.h"

namespace obscura {
namespace {

using namespace diffraction_cases;
constexpr int side = 256;

struct Panels {
    Figure figure{1148, 720};
    int count = 0;
    void add(const Image<Rgb8>& picture, const std::string& name, const std::string& what) {
        const int x = 24 + count % 4 * 280, y = 72 + count / 4 * 320;
        ++count;
        figure.image(x, y, picture, 1);
        figure.text({x + 0.0, y + 275.0}, name, lettering::bold);
        figure.text({x + 0.0, y + 295.0}, what);
    }
};

Image<Rgb8> linear_view(ImageView<const float> intensity, double white) {
    PatternView view;
    view.white = white;
    return view_power(intensity, view, Exec{});
}

Image<Rgb8> far_view(const Aperture& a, double step, FarFieldMethod method = FarFieldMethod::automatic) {
    FarFieldParams params;
    params.method = method;
    const double area = open_area(a.mask.view());
    return log_view(far_field_power(a, centred_grid(side, side, step), params, Exec{}).view(), area * area,
                    9);
}

TEST(DiffractionStability, PictureOfLimits) {
    Panels panels;
    panels.figure.text({24, 30}, "Where diffraction patterns fail", lettering::head);
    panels.figure.text({24, 52},
                       "far fields: logarithmic, black to white is nine decades; near fields: linear");
    const Image<float> photo = photograph(side);
    panels.add(linear_view(photo.view(), 1), "a photograph as aperture", "half a quad per texel; raster_fft");
    panels.add(far_view(of_mask(photo), 1.0 / side), "its far field", "exact, if not cheap");

    ApertureShape shape;
    shape.rotation_deg = 7;
    const Aperture grey = make_aperture(shape, 64, 1.0);
    const Image<Rgb8> polygon = far_view(grey, 3.0 / side, FarFieldMethod::polygon),
                      staircase = far_view(of_mask(threshold(grey.mask, 0.5f)), 3.0 / side);
    panels.add(polygon, "heptagon, to 1.5 cycles per texel", "the outline itself: polygon");
    panels.add(staircase, "the same from 64 x 64 texels", "copies of the pattern, false streaks");
    EXPECT_LT(likeness(staircase, polygon).ssim, 0.8);

    const Aperture fine = binary_shape(ApertureKind::iris, 1024);
    panels.add(far_view(reduce(fine, 3, true), 8.0 / 1024), "1024 texels, 3 levels coarser",
               "copies of the pattern, false streaks");

    const Aperture disc = near_field_oracle::disc(side, 80);
    const Image<float> shadow = near_field_intensity(
        disc, centred_plane(side / 2, side), near_field_oracle::at_fresnel_number(disc, 1500), Exec{});
    Image<float> doubled(side, side);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            doubled(x, y) = shadow(x / 2, y / 2);
    }
    panels.add(linear_view(doubled.view(), 1.6), "disc, Fresnel number 1500", "fringes finer than a pixel");

    const Aperture few = binary_shape(ApertureKind::iris, side);
    // Left half 4, right half as many wavelengths as it takes.
    PatternView view;
    view.logarithmic = true;
    view.decades = 5;
    const auto coloured = [&](int wavelengths) {
        PsfParams params;
        params.wavelengths = wavelengths;
        return view_colour(
            far_field_colour(few, centred_grid(side, side, 0.25 / side), 550, params, Exec{}).view(), view,
            Exec{});
    };
    const auto beside = [](Image<Rgb8> left, const Image<Rgb8>& right) {
        for (int y = 0; y < side; ++y)
            std::copy_n(right.row(y) + side / 2, side / 2, left.row(y) + side / 2);
        return left;
    };
    panels.add(beside(coloured(4), coloured(0)), "too few wavelengths",
               "left: 4, right: as many as it takes");

    // Left half exact, right half scaled.
    const NearFieldParams at = near_field_oracle::at_fresnel_number(few, 5);
    const auto near = [&](NearFieldColour how) {
        PatternView linear;
        linear.white = 1.6;
        return view_colour(
            near_field_colour(few, centred_plane(side, 1.2 * side), at, {}, 24, how, Exec{}).view(), linear,
            Exec{});
    };
    panels.add(beside(near(NearFieldColour::exact), near(NearFieldColour::scaled)), "colour of a near field",
               "left: exact, right: scaled");

    if (const char* folder = std::getenv("OBSCURA_PICTURES"); folder != nullptr) {
        const std::filesystem::path file = std::filesystem::path(folder) / "limits.png";
        write_file_atomically(file, encode_png(panels.figure.picture.view()), Existing::replace);
        std::cout << "wrote " << file << "\n";
    }
}

}  // namespace
}  // namespace obscura
