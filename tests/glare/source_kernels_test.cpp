// Visible pupils by geometry that can be drawn by hand, blurred points by ray optics, and the frames that use
// them.

#include "app/glare/source_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "app/frame/render_frame.h"
#include "app/glare/defocus.h"
#include "app/glare/lens.h"
#include "app/glare/visible_pupil.h"
#include "app/scene/build.h"
#include "core/error.h"

namespace obscura {
namespace {

/// A rectangle across the view, [x0, x1] x [y0, y1] at distance z before the camera at the origin.
void add_screen(Mesh& mesh, double x0, double x1, double y0, double y1, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d p : {Vec3d{x0, y0, -z}, Vec3d{x1, y0, -z}, Vec3d{x1, y1, -z}, Vec3d{x0, y1, -z}})
        mesh.positions.push_back(to_float(p));
    mesh.triangles.push_back({{first, first + 1, first + 2}});
    mesh.triangles.push_back({{first, first + 2, first + 3}});
}

PupilPlane pupil(double side_m) {
    Camera camera;
    camera.eye = {0, 0, 0};
    camera.look_at = {0, 0, -1};
    camera.near_m = 0.1;
    return pupil_plane(camera, side_m);
}

std::vector<std::uint32_t> all(const Mesh& mesh) {
    std::vector<std::uint32_t> ids(mesh.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    return ids;
}

/// Open texels per column.
std::vector<int> columns(const Image<std::uint8_t>& open) {
    std::vector<int> count(static_cast<std::size_t>(open.width), 0);
    for (int y = 0; y < open.height; ++y) {
        for (int x = 0; x < open.width; ++x)
            count[static_cast<std::size_t>(x)] += open(x, y);
    }
    return count;
}

TEST(VisiblePupil, AnEdgeHidesTheSideThatItStandsOn) {
    Mesh mesh;
    add_screen(mesh, 0, 50, -50, 50, 5);
    const Image<std::uint8_t> open = visible_pupil(mesh, all(mesh), pupil(0.2), {0, 0, -10}, 64);
    const std::vector<int> count = columns(open);
    for (int x = 0; x < 64; ++x)
        EXPECT_EQ(count[static_cast<std::size_t>(x)], x < 32 ? 64 : 0) << x;
}

TEST(VisiblePupil, ALightThatMovesMovesTheEdgeTheOtherWay) {
    // Halfway between light and lens: the edge's shadow moves as far as the light, the other way.
    Mesh mesh;
    add_screen(mesh, 0, 50, -50, 50, 5);
    for (const double shift : {-0.05, -0.025, 0.025, 0.05}) {
        const std::vector<int> count =
            columns(visible_pupil(mesh, all(mesh), pupil(0.2), {shift, 0, -10}, 64));
        const int edge = 32 - static_cast<int>(std::lround(shift / 0.2 * 64));
        for (int x = 0; x < 64; ++x)
            EXPECT_EQ(count[static_cast<std::size_t>(x)], x < edge ? 64 : 0) << shift << " " << x;
    }
}

TEST(VisiblePupil, RowZeroIsUp) {
    Mesh mesh;
    add_screen(mesh, -50, 50, 0, 50, 5);
    const Image<std::uint8_t> open = visible_pupil(mesh, all(mesh), pupil(0.2), {0, 0, -10}, 16);
    EXPECT_EQ(open(8, 0), 0);
    EXPECT_EQ(open(8, 15), 1);
}

TEST(VisiblePupil, OnlyWhatIsBetweenHides) {
    const auto open_texels = [](double z) {
        Mesh mesh;
        add_screen(mesh, -50, 50, -50, 50, z);
        const Image<std::uint8_t> open = visible_pupil(mesh, all(mesh), pupil(0.2), {0, 0, -10}, 8);
        return std::accumulate(open.pixels.begin(), open.pixels.end(), 0);
    };
    EXPECT_EQ(open_texels(0.05), 64) << "nearer than the camera sees";
    EXPECT_EQ(open_texels(0.2), 0);
    EXPECT_EQ(open_texels(9.9), 0);
    EXPECT_EQ(open_texels(9.9999), 64) << "the light's own surface";
    EXPECT_EQ(open_texels(11), 64) << "behind the light";
    EXPECT_EQ(open_texels(-3), 64) << "behind the lens";
}

TEST(VisiblePupil, CrossingTrianglesAreCutAtThePlanes) {
    // A floor that passes under lens and light from far behind one to far behind the other.
    Mesh mesh;
    mesh.positions = {{-50, -0.02f, 60}, {50, -0.02f, 60}, {0, -0.02f, -90}};
    mesh.triangles.push_back({{0, 1, 2}});
    const Image<std::uint8_t> above = visible_pupil(mesh, all(mesh), pupil(0.02), {0, 0, -10}, 8);
    EXPECT_EQ(std::accumulate(above.pixels.begin(), above.pixels.end(), 0), 64);
    // A light below the floor reaches the lens nowhere.
    const Image<std::uint8_t> below = visible_pupil(mesh, all(mesh), pupil(0.02), {0, -1, -10}, 8);
    EXPECT_EQ(std::accumulate(below.pixels.begin(), below.pixels.end(), 0), 0);
}

TEST(VisiblePupil, NoTriangleThatHidesIsLeftOut) {
    std::uint32_t state = 7;
    const auto dice = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<double>(state >> 8) / 16777216.0;
    };
    Mesh mesh;
    for (int i = 0; i < 400; ++i) {
        const double x = dice() * 4 - 2, y = dice() * 4 - 2, w = 0.02 + dice() * 0.4;
        add_screen(mesh, x, x + w, y, y + w, 0.5 + dice() * 12);
    }
    const PupilPlane plane = pupil(0.3);
    std::size_t candidates = 0;
    for (int i = 0; i < 30; ++i) {
        const Vec3d centre{dice() * 2 - 1, dice() * 2 - 1, -10};
        const double radius = 0.01 + dice() * 0.8;
        const std::vector<std::uint32_t> near = between(mesh, plane, centre, radius);
        candidates += near.size();
        for (int k = 0; k < 5; ++k) {
            const Vec3d point = centre + Vec3d{dice() - 0.5, dice() - 0.5, dice() - 0.5} * radius;
            EXPECT_TRUE(visible_pupil(mesh, near, plane, point, 24) ==
                        visible_pupil(mesh, all(mesh), plane, point, 24));
        }
    }
    EXPECT_LT(candidates, std::size_t{30} * 800 / 2) << "most triangles are nowhere near";
    EXPECT_GT(candidates, 0u);
}

// --- out of focus

/// A half-open mask, its right half and one texel at the left that keeps it from being centred, of a lens of
/// 50 mm at f/2, pixels of 50 um.
struct HalfLens {
    OpticsSettings optics;
    RenderSettings render;
    Aperture aperture;
    HalfLens() {
        optics.enabled = true;
        optics.from_file = true;
        optics.focal_length_mm = 50;
        optics.f_number = 2;
        optics.sensor_height_mm = 24;
        optics.radius_px = 24;
        optics.wavelengths = 6;
        render.width = 640;
        render.height = 480;
        optics.mask = Image<float>(64, 64);
        for (int y = 0; y < 64; ++y) {
            for (int x = 32; x < 64; ++x)
                optics.mask(x, y) = 1;
        }
        optics.mask(0, 32) = 1;
        aperture = lens_aperture(optics);
    }
};

/// Share of the kernel's light within columns [x0, x1) and rows [y0, y1) from its centre.
double share(const Image<Vec3f>& kernel, int x0, int x1, int y0, int y1) {
    double sum = 0;
    const int r = kernel.width / 2;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x)
            sum += static_cast<double>(kernel(x + r, y + r).y);
    }
    return sum;
}

TEST(Defocus, FarPointsShowTheApertureUprightNearOnesTurned) {
    const HalfLens lens;
    // 25 mm of pupil; focus at 4 m, light at 2 m: vergence 0.25 / m; half width 0.0125 * 0.25 rad = 3.1 px.
    const double vergence = 1.0;  // 12.5 px
    const Image<Vec3f> near = defocus_kernel(lens.aperture, lens.optics, lens.render, vergence, {}),
                       far = defocus_kernel(lens.aperture, lens.optics, lens.render, -vergence, {});
    EXPECT_GT(share(far, 1, 13, -13, 14), 0.9);
    EXPECT_GT(share(near, -12, 0, -13, 14), 0.9);
    for (int y = 0; y < 49; ++y) {
        for (int x = 0; x < 49; ++x)
            ASSERT_EQ(far(x, y), near(48 - x, 48 - y));
    }
}

TEST(Defocus, TheEdgeIsBrighterThanTheMiddle) {
    // The ringing that rays do not know: light overshoots just inside the geometric edge.
    HalfLens lens;
    lens.optics.mask = Image<float>(128, 128, 1.0f);
    lens.aperture = lens_aperture(lens.optics);
    lens.optics.f_number = 16;  // 3.1 mm, few rings
    lens.aperture = lens_aperture(lens.optics);
    lens.optics.wavelengths = 1;
    const Image<Vec3f> kernel = defocus_kernel(lens.aperture, lens.optics, lens.render, 12, {});
    float most = 0, middle = kernel(24, 24).y;
    for (int x = 0; x < 49; ++x)
        most = std::max(most, kernel(x, 24).y);
    EXPECT_GT(most, 1.1f * middle);
    EXPECT_GT(share(kernel, -19, 20, -19, 20), 0.9)
        << "0.00156 * 12 rad = 18.75 px from the middle to the edge";
}

// --- in frames

std::string lamp_scene(const std::string& optics, const std::string& rest) {
    return R"(format = 1
[camera]
eye_m = [0, 0, 0]
look_at_m = [0, 0, -1]
focal_length_mm = 400
[render]
size_px = [96, 64]
samples = 1
[sky]
visible = false
ambient = 0
[material.glow]
base_color = 0
emission_w_m2_sr = 500
[[mesh]]
id = "lamp"
shape = "sphere"
radius_m = 0.1
material = "glow"
translate_m = [0, 0, -10]
[optics]
aperture = "circle"
f_number = 8
radius_px = 12
mask_px = 64
wavelengths = 3
)" + optics +
           rest;
}

const char* const post = R"([[mesh]]
id = "post"
shape = "box"
size_m = [0.03, 4, 0.03]
translate_m = [0.0, 0, -3]
)";

Frame frame_of(const std::string& text) {
    return render_frame(build_scene(read_scene_text(text, "lamp.toml"), FileAccess{".", {}}));
}

double light_of(const Frame& frame) {
    double sum = 0;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x)
            sum += static_cast<double>(frame.radiance.view()(x, y).y);
    }
    return sum;
}

TEST(SourceKernels, NoIndexWrapsAround) {
    SourceKernels all;
    for (std::size_t i = 0; i < most_kernels; ++i)
        ASSERT_EQ(add_kernel(Image<Vec3f>(1, 1), all), i);
    EXPECT_THROW(add_kernel(Image<Vec3f>(1, 1), all), LimitError);
    EXPECT_EQ(all.kernels.size(), most_kernels);
}

TEST(SourceKernels, AFreeLampSeesTheWholeLens) {
    const Frame frame = frame_of(lamp_scene("visibility = \"exact\"\n", ""));
    EXPECT_EQ(frame.stats.glare->kernels, 1);
    EXPECT_EQ(frame.stats.glare->own_kernel_sources, 0);
}

TEST(SourceKernels, ALampBehindAPostSeesPartOfIt) {
    const Frame open = frame_of(lamp_scene("", post)),
                exact = frame_of(lamp_scene("visibility = \"exact\"\nvisibility_samples = 4\n", post)),
                cheap = frame_of(lamp_scene("visibility = \"neighbours\"\n", post));
    EXPECT_EQ(open.stats.glare->kernels, 1);
    EXPECT_GT(exact.stats.glare->kernels, 1);
    EXPECT_LE(exact.stats.glare->kernels, 5);
    EXPECT_GT(exact.stats.glare->own_kernel_sources, 0);
    EXPECT_GT(cheap.stats.glare->own_kernel_sources, exact.stats.glare->own_kernel_sources / 8);
    // Light is spread otherwise; what is hidden from the lens is missing, and counted.
    EXPECT_GT(exact.stats.glare->blocked, 0.01);
    EXPECT_EQ(cheap.stats.glare->blocked, 0);
    EXPECT_NEAR(light_of(exact), (1 - exact.stats.glare->blocked) * light_of(open), 4e-3 * light_of(open));
    EXPECT_NEAR(light_of(cheap), light_of(open), 2e-3 * light_of(open));
    EXPECT_EQ(exact.depth_m.width, 0) << "channels that nobody wanted are gone";
}

TEST(SourceKernels, ALampSeenThroughAGapGivesWhatTheGapLetsThrough) {
    // A gap of 8 mm at 1 m: from a point of the lamp at 10 m it is 8 mm * 10 / 9 of a pupil of 50 mm wide.
    const char* const shutters = R"([[mesh]]
id = "left"
shape = "box"
size_m = [1, 4, 0.001]
translate_m = [-0.504, 0, -1]
[[mesh]]
id = "right"
shape = "box"
size_m = [1, 4, 0.001]
translate_m = [0.504, 0, -1]
)";
    const Frame open = frame_of(lamp_scene("", shutters)),
                exact = frame_of(lamp_scene("visibility = \"exact\"\nvisibility_samples = 16\n", shutters));
    // The gap's share of the circle, from the middle to the edges of what the pinhole shows through it.
    const double half = 0.5 * 8 * 10 / 9 / 25;
    const auto strip = [](double x) { return (x * std::sqrt(1 - x * x) + std::asin(x)) / 3.14159265358979; };
    const double in_the_middle = 2 * strip(half), at_its_edge = strip(2 * half);
    ASSERT_GT(open.stats.glare->sources, 0);
    EXPECT_EQ(exact.stats.glare->sources, open.stats.glare->sources);
    EXPECT_GT(1 - exact.stats.glare->blocked, at_its_edge - 0.03);
    EXPECT_LT(1 - exact.stats.glare->blocked, in_the_middle + 0.03);
    EXPECT_NEAR(light_of(exact), (1 - exact.stats.glare->blocked) * light_of(open), 4e-3 * light_of(open));
}

TEST(SourceKernels, OutOfFocusLampsShowDiscs) {
    const Frame sharp = frame_of(lamp_scene("focus_m = 10\n", "")),
                blurred = frame_of(lamp_scene("focus_m = 3\nfocus_steps = 2\n", ""));
    EXPECT_EQ(sharp.stats.glare->kernels, 1) << "a sphere at the focus is sharp to half a pixel";
    EXPECT_GT(blurred.stats.glare->kernels, 1);
    EXPECT_LE(blurred.stats.glare->kernels, 3);
    EXPECT_NEAR(light_of(blurred), light_of(sharp), 2e-3 * light_of(sharp));
    // 25 mm * (1/3 - 1/10) / m = 5.8 mrad: the disc reaches six pixels beyond the lamp.
    const auto wide = [](const Frame& frame) {
        int count = 0;
        for (int x = 0; x < frame.width; ++x)
            count += frame.radiance.view()(x, frame.height / 2).y > 5 ? 1 : 0;
        return count;
    };
    EXPECT_NEAR(wide(blurred), wide(sharp) + 12, 2);
}

}  // namespace
}  // namespace obscura
