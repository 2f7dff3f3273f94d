// Hours of sun of a town against rays to every sun of the day.

#include <gtest/gtest.h>

#ifdef OBSCURA_HAS_EMBREE
#include <fmt/format.h>

#include <cmath>

#include "app/frame/load_scene.h"
#include "app/frame/render_frame.h"
#include "app/frame/sun_hours.h"
#include "app/scene/scene_file.h"
#include "bench/shadows/exact_rays.h"
#include "bench/shadows/visible_points.h"
#include "core/sky/clear_sky.h"

namespace obscura {
namespace {

TEST(SunHoursRays, OfATownAgreeStepByStep) {
    const SceneDocument document =
        read_scene(OBSCURA_SOURCE_DIR "/scenes/sun_hours.toml",
                   {"render.size_px=[128, 72]", "render.samples=1", "sky.occlusion=false",
                    "light.sun.angular_diameter_deg=0", "mesh.town.triangles=60000"});
    const Scene scene = load_scene(document, FileAccess{document.folder, {}});
    const Light& sun = *sun_with_path(scene);
    const ExactRays rays(scene.mesh);
    const VisiblePoints points = visible_points(scene, Exec{});
    const std::vector<SunStep> suns = sun_steps(*sun.path);
    ASSERT_GT(suns.size(), 70u);

    // One picture of a single sun after the other, so that no two errors cancel.
    std::int64_t asked = 0, wrong = 0, lit = 0;
    FrameOptions options;
    options.sun_hours = true;
    FrameCache cache;
    Frame frame;
    Scene one = scene;
    for (std::size_t s = 0; s < suns.size(); s += 6) {
        SunPath& path = *one.lights[0].light.path;
        path.from_h = suns[s].hour_h - 0.01;
        path.to_h = suns[s].hour_h + 0.01;
        path.steps = 1;
        const std::vector<SunStep> step = sun_steps(path);
        ASSERT_EQ(step.size(), 1u);
        render_frame(one, options, Exec{}, cache, frame);
        const std::vector<Truth> truth = true_shadows(
            rays, scene.mesh, points, compass_direction(step[0].azimuth_deg, step[0].elevation_deg), Exec{});
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const float hours = frame.sun_hours.pixels[i];
            ASSERT_EQ(std::isnan(hours), truth[i] == Truth::nothing);
            if (truth[i] == Truth::nothing) continue;
            ++asked;
            lit += hours > 0;
            wrong += (hours > 0) != (truth[i] == Truth::lit);
        }
    }
    fmt::print("{} samples of {} suns, {} lit, {} otherwise by rays: {:.4f} %\n", asked,
               (suns.size() + 5) / 6, lit, wrong,
               100.0 * static_cast<double>(wrong) / static_cast<double>(asked));
    EXPECT_GT(lit, asked / 10);
    EXPECT_LT(lit, asked * 9 / 10);
    EXPECT_LE(static_cast<double>(wrong), 0.001 * static_cast<double>(asked));

    // And the day as a whole.
    const Frame day = render_frame(scene, options);
    std::vector<double> sum(day.sun_hours.pixels.size());
    for (const SunStep& step : suns) {
        const std::vector<Truth> truth = true_shadows(
            rays, scene.mesh, points, compass_direction(step.azimuth_deg, step.elevation_deg), Exec{});
        for (std::size_t i = 0; i < truth.size(); ++i)
            sum[i] += truth[i] == Truth::lit ? step.hours : 0;
    }
    double off_h = 0, all_h = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        if (std::isnan(day.sun_hours.pixels[i])) continue;
        off_h += std::fabs(sum[i] - static_cast<double>(day.sun_hours.pixels[i]));
        all_h += day.stats.sun_hours->sunlit_h();
    }
    fmt::print("the day: {:.2f} of {:.0f} hours off\n", off_h, all_h);
    EXPECT_LE(off_h, 0.001 * all_h);
}

}  // namespace
}  // namespace obscura
#else
TEST(SunHoursRays, OfATownAgreeStepByStep) {
    GTEST_SKIP() << "Embree 3 is not installed: hours of sun are not compared with rays";
}
#endif
