// Hours of sun against what is known: open ground, walls, rooms, polar nights; and against shadows of the
// same suns, one picture each.

#include <gtest/gtest.h>

#include <cmath>

#include "app/frame/sun_hours.h"
#include "core/sky/clear_sky.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

/// A sun with a path over a day of 2026, by the clock of the place.
SceneLight sun_of(int month, int day, double latitude_deg, int steps = 144) {
    SceneLight light;
    light.light.id = "sun";
    light.light.kind = LightKind::sun;
    light.light.direction = normalize(Vec3d{-0.3, -1, 0.2});
    light.light.path = SunPath{2026, month, day, 1, 0, 24, latitude_deg, 15, steps};
    light.shadow.method = ShadowMethod::none;
    return light;
}

Frame hours_of(const Scene& scene) {
    FrameOptions options;
    options.sun_hours = true;
    return render_frame(scene, options);
}

/// A floor from half a metre above, `wide` metres of it across the picture: north is up.
Scene floor_under(int width, int height, double wide, const SceneLight& sun, int samples = 1) {
    Scene scene = empty_scene(width, height, samples);
    add(scene, plane(4000, 4000), 0);
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.height_m = wide * height / width;
    scene.camera.eye = {0, 0.5, 0};
    scene.camera.look_at = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.near_m = 0.01;
    scene.lights.push_back(sun);
    return scene;
}

void expect_everywhere(const Frame& frame, double hours, double tolerance) {
    ASSERT_FALSE(frame.sun_hours.pixels.empty());
    for (const float h : frame.sun_hours.pixels)
        ASSERT_NEAR(static_cast<double>(h), hours, tolerance);
}

TEST(SunHours, OpenGroundHasAllTheDay) {
    for (const auto& [month, day] : {std::pair{3, 20}, {6, 21}, {9, 23}, {12, 21}}) {
        for (const int steps : {7, 144}) {
            const Frame frame = hours_of(floor_under(70, 20, 3, sun_of(month, day, 48.2, steps), 4));
            double sunlit = 0;
            for (const SunSpan& span : sunlit_spans(frame.stats.sun_hours->path))
                sunlit += span.hours();
            EXPECT_GT(sunlit, 8);
            expect_everywhere(frame, sunlit, 1e-6);
        }
    }
}

TEST(SunHours, AWallInTheEastKeepsTheMorningAway) {
    // 8 m high, without end to north and south, its foot 5 m east of the picture's middle.
    // Only until three, so that the evening is not as long as the morning.
    SceneLight sun = sun_of(6, 21, 48.2, 180);
    sun.light.path->to_h = 15;
    Scene scene = floor_under(64, 4, 6, sun);
    add(scene, box({0.5, 8, 3000}), 0, {5.25f, 4, 0});
    const Frame frame = hours_of(scene);
    const SunPath& path = *sun.light.path;
    const std::vector<SunSpan> spans = sunlit_spans(path);
    ASSERT_EQ(spans.size(), 1u);
    const double step_h = 15.0 / 180;
    for (int x = 0; x < 64; ++x) {
        const double away = 5 - ((x + 0.5) / 64 - 0.5) * 6;
        // The sun comes over the wall where up / east is 8 / away: by bisection, before it stands south.
        double hidden = spans[0].from_h, clear = 12;
        for (int i = 0; i < 60; ++i) {
            const double hour = 0.5 * (hidden + clear);
            const SunPosition p = solar_position(2026, 6, 21, hour - 1, 48.2, 15);
            const Vec3d to = compass_direction(p.azimuth_deg, p.apparent_elevation_deg);
            (to.y * away < 8 * to.x ? hidden : clear) = hour;
        }
        // In June it rises north of east and sets north of west: nothing but this wall is in its way.
        EXPECT_NEAR(static_cast<double>(frame.sun_hours(x, 2)), spans[0].to_h - clear, step_h) << x;
    }
    EXPECT_GT(frame.sun_hours(0, 2), frame.sun_hours(63, 2) + 1);
}

TEST(SunHours, AWallThatLooksWestHasTheAfternoon) {
    SceneLight sun = sun_of(3, 20, 48.2);
    sun.light.path->to_h = 15;
    Scene scene = empty_scene(40, 40);
    add(scene, box({2, 2, 2}), 0);
    scene.lights.push_back(sun);
    scene.camera.eye = {-9, 0, 0};
    scene.camera.look_at = {0, 0, 0};
    scene.camera.vfov_deg = 10;
    const Frame frame = hours_of(scene);
    const SunSpan span = sunlit_spans(*sun.light.path)[0];
    double south = span.from_h, past = span.to_h;
    for (int i = 0; i < 60; ++i) {
        const double hour = 0.5 * (south + past);
        (solar_position(2026, 3, 20, hour - 1, 48.2, 15).azimuth_deg < 180 ? south : past) = hour;
    }
    EXPECT_NEAR(static_cast<double>(frame.sun_hours(20, 20)), span.to_h - south, 15.0 / 144);
}

TEST(SunHours, RoomsAndPolarNightsHaveNone) {
    Scene room = empty_scene(60, 40, 4);
    add(room, box({6, 3, 6}), 0);
    room.camera.eye = {0, 0, 0};
    room.camera.look_at = {1, -0.2, 0.3};
    room.lights.push_back(sun_of(6, 21, 48.2, 48));
    expect_everywhere(hours_of(room), 0, 0);

    const Frame night = hours_of(floor_under(20, 20, 3, sun_of(12, 21, 69.65), 4));
    expect_everywhere(night, 0, 0);
    EXPECT_EQ(night.stats.sun_hours->suns, 0);
    ASSERT_EQ(night.stats.notices.size(), 1u);
    EXPECT_NE(night.stats.notices[0].find("'sun' does not rise at latitude 69.65 on 2026-12-21"),
              std::string::npos)
        << night.stats.notices[0];
}

TEST(SunHours, TheMidnightSunShinesAllDay) {
    expect_everywhere(hours_of(floor_under(20, 20, 3, sun_of(6, 21, 69.65), 1)), 24, 1e-6);
}

TEST(SunHours, WhereNothingIsThereAreNoHours) {
    Scene scene = everything(4);
    scene.lights.push_back(sun_of(6, 21, 48.2, 6));
    const Frame frame = render_frame(scene, [] {
        FrameOptions options = all_channels();
        options.sun_hours = true;
        return options;
    }());
    int sky = 0;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            const bool none = std::isnan(frame.sun_hours(x, y));
            sky += none;
            if (none) {
                EXPECT_TRUE(std::isinf(frame.depth_m(x, y)));
            }
        }
    }
    EXPECT_GT(sky, 100);
    Scene empty = empty_scene(8, 8);
    empty.lights.push_back(sun_of(6, 21, 48.2, 6));
    for (const float h : hours_of(empty).sun_hours.pixels)
        EXPECT_TRUE(std::isnan(h));
}

TEST(SunHours, AreTheSumOfPicturesUnderTheSameSuns) {
    Scene scene = everything(4);
    scene.camera.eye = {0.5, 7, 2.5};  // nothing but surfaces
    scene.camera.vfov_deg = 30;
    scene.lights.clear();
    scene.lights.push_back(sun_of(6, 21, 48.2, 24));
    const Frame hours = hours_of(scene);
    Image<double> sum(hours.width, hours.height);
    int suns = 0;
    for (const SunStep& step : sun_steps(*scene.lights[0].light.path)) {
        Scene one = scene;
        one.lights[0].light.direction = -compass_direction(step.azimuth_deg, step.elevation_deg);
        one.lights[0].shadow.method = ShadowMethod::exact;
        one.lights[0].light.color = {1, 1, 1};
        const Frame frame = render_frame(one, all_channels());
        for (std::size_t i = 0; i < sum.pixels.size(); ++i)
            sum.pixels[i] += step.hours * static_cast<double>(frame.shadow.pixels[i]);
        ++suns;
    }
    EXPECT_EQ(hours.stats.sun_hours->suns, suns);
    int compared = 0, shaded = 0;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        if (std::isnan(hours.sun_hours.pixels[i])) continue;
        ASSERT_NEAR(static_cast<double>(hours.sun_hours.pixels[i]), sum.pixels[i], 2e-5);
        ++compared;
        shaded += sum.pixels[i] < 8;
    }
    EXPECT_EQ(compared, 200 * 130);
    EXPECT_GT(shaded, 1000);
}

TEST(SunHours, TheSamePictureComesWithThem) {
    Scene scene = everything(4);
    scene.lights.push_back(sun_of(6, 21, 48.2, 6));
    scene.lights.back().light.below_horizon = true;
    EXPECT_EQ(hash(hours_of(scene)), hash(render_frame(scene)));
}

}  // namespace
}  // namespace obscura
