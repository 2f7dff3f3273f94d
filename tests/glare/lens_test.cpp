// The lens of a scene: the aperture of its file, fitted to focal length and f-number.

#include "app/glare/lens.h"

#include <gtest/gtest.h>

#include <string>

#include "app/scene/build.h"
#include "core/error.h"
#include "tests/core/temporary_folder.h"

namespace obscura {
namespace {

std::string scene_with(const std::string& optics) {
    return "format = 1\n[camera]\neye_m = [0, 1, 4]\nlook_at_m = [0, 1, 0]\nvfov_deg = 40\n[[mesh]]\n"
           "id = \"box\"\nshape = \"box\"\n[optics]\n" +
           optics;
}

TEST(ApertureFile, InAScene) {
    TemporaryFolder folder;
    folder.write("masks/cross.pbm", "P1\n4 4\n1001 0000 0000 1001");
    folder.write("masks/closed.pbm", "P1\n1 1\n1");
    const FileAccess access{folder.path, {}};
    const auto build = [&](const std::string& optics) {
        return build_scene(read_scene_text(scene_with(optics), "s.toml"), access);
    };
    const auto error = [&](const std::string& optics) -> std::string {
        try {
            build(optics);
        } catch (const InputError& e) {
            return e.what();
        }
        return "no error";
    };
    const Scene scene =
        build("aperture = \"file\"\nfile = \"masks/cross.pbm\"\nf_number = 10\nfocal_length_mm = 40");
    EXPECT_EQ(scene.optics.mask.pixels, (std::vector<float>{0, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 0}));
    EXPECT_NEAR(lens_aperture(scene.optics).pitch_m, 1e-3, 1e-12);
    folder.write("masks/margin.pgm", "P2 5 3 4\n0 0 0 0 0\n0 4 1 4 0\n0 0 0 0 0\n");
    const Scene narrow = build(
        "aperture = \"file\"\nfile = \"masks/margin.pgm\"\nf_number = 10\n"
        "focal_length_mm = 30\ndust = 1\ndust_radius = 0.5");
    const Aperture lens = lens_aperture(narrow.optics);
    EXPECT_EQ(lens.mask.width, 3) << "the pupil is what is open";
    EXPECT_NEAR(lens.pitch_m, 1e-3, 1e-12);
    EXPECT_LT(open_area(lens.mask.view()), 2.25) << "less dust";
    const Scene eclipse = build("aperture = \"circle\"\noccluder = \"disc\"\noccluder_diameter = 2");
    EXPECT_THROW(lens_aperture(eclipse.optics), InputError);
    EXPECT_NE(error("aperture = \"file\"").find("[optics] needs 'file'"), std::string::npos);
    EXPECT_NE(error("aperture = \"file\"\nfile = \"none.png\"").find("s.toml:11"), std::string::npos);
    EXPECT_NE(error("aperture = \"file\"\nfile = \"../x.png\"").find("leads outside"), std::string::npos);
    EXPECT_NE(error("aperture = \"file\"\nfile = \"masks/closed.pbm\"").find("closed"), std::string::npos);
    EXPECT_NE(error("aperture = \"iris\"\nfile = \"masks/cross.pbm\"").find("'file' does not apply"),
              std::string::npos);
}

}  // namespace
}  // namespace obscura
