// obscura diffraction from outside: patterns with known answers, plans, files and mistakes.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/image_io.h"
#include "tests/cli/scene_folder.h"
#include "tests/report/json_reader.h"

namespace obscura::test {
namespace {

TEST(DiffractionCommand, ABoxGivesSquaredSincs) {
    const Folder folder;
    const Outcome run = run_in(
        folder, {"diffraction", "box", "--mask-size", "100", "--size", "128", "--zoom", "4", "-o", "b.pfm"});
    ASSERT_EQ(run.code, 0) << run.err;
    const Image<float> power = pfm(folder / "b.pfm");
    const auto sinc2 = [](double x) {
        const double a = 3.14159265358979 * 90 * x / 512;  // 90 texels open, steps of 1 / 512 cycle
        return x == 0 ? 1.0 : std::pow(std::sin(a) / a, 2);
    };
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x)
            ASSERT_NEAR(power(x, y), sinc2(x - 64) * sinc2(y - 64), 2e-6) << x << " " << y;
    }
}

TEST(DiffractionCommand, SlitsDoNotDependOnTheMethod) {
    const Folder folder;
    std::vector<Image<float>> powers;
    for (const char* method : {"automatic", "edges", "runs"}) {
        const Outcome run =
            run_in(folder, {"diffraction", "slit", "--slits", "2", "--mask-size", "64", "--size", "64",
                            "--method", method, "-o", "s.pfm", "--overwrite"});
        ASSERT_EQ(run.code, 0) << run.err;
        powers.push_back(pfm(folder / "s.pfm"));
    }
    for (const Image<float>& power : powers) {
        EXPECT_NEAR(power(32, 32), 1, 1e-5);
        for (std::size_t i = 0; i < power.pixels.size(); ++i)
            ASSERT_NEAR(power.pixels[i], powers[0].pixels[i], 3e-6);
    }
}

TEST(DiffractionCommand, MasksFromFiles) {
    const Folder folder;
    // A slit of two columns: cos^2 between its zeros at half a cycle per column, times the texel's sinc^2.
    folder.write("slit.pgm", "P2\n4 1\n9\n0 9 9 0\n");
    const Outcome run = run_in(folder, {"diffraction", "slit.pgm", "--size", "64", "-o", "s.pfm"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.out.find("4 x 1 texels of 2500 um"), std::string::npos) << run.out;
    const Image<float> power = pfm(folder / "s.pfm");
    const auto sinc = [](double x) { return x == 0 ? 1.0 : std::sin(x) / x; };
    for (int x = 0; x < 64; ++x) {
        const double u = 3.14159265358979 * (x - 32) / 64;
        ASSERT_NEAR(power(x, 32), std::pow(std::cos(u) * sinc(u), 2), 2e-6) << x;
    }
    folder.write("closed.pbm", "P1\n1 1\n1\n");
    EXPECT_EQ(run_in(folder, {"diffraction", "closed.pbm", "-o", "c.png"}).code, 3);
    EXPECT_EQ(run_in(folder, {"diffraction", "slit.pgm", "--limit-memory", "1", "--size", "16"}).code, 0);
    folder.write("large.pgm", "P5\n4096 4096\n255\n");
    const Outcome large =
        run_in(folder, {"diffraction", "large.pgm", "--limit-memory", "100", "-o", "l.png"});
    EXPECT_EQ(large.code, 4) << large.err;
    EXPECT_NE(large.err.find("--limit-memory"), std::string::npos) << large.err;
}

TEST(DiffractionCommand, DirtScattersLightAside) {
    const Folder folder;
    const std::vector<std::string> line = {"diffraction", "circle", "--mask-size", "128", "--size", "128"};
    auto clean = line, dirty = line;
    clean.insert(clean.end(), {"-o", "clean.pfm"});
    dirty.insert(dirty.end(), {"--scratches", "30", "--scratch-spread-deg", "0", "--scratch-width", "0.01",
                               "-o", "dirty.pfm"});
    ASSERT_EQ(run_in(folder, clean).code, 0);
    ASSERT_EQ(run_in(folder, dirty).code, 0);
    const Image<float> a = pfm(folder / "clean.pfm"), b = pfm(folder / "dirty.pfm");
    // Upright scratches spread light to the left and right, far more than up and down.
    double before = 0, aside = 0, upward = 0;
    for (int i = 90; i < 120; ++i) {
        for (int j = 60; j < 68; ++j) {
            before += static_cast<double>(a(i, j));
            aside += static_cast<double>(b(i, j));
            upward += static_cast<double>(b(j, i));
        }
    }
    EXPECT_GT(aside, 10 * before);
    EXPECT_GT(aside, 10 * upward);
}

TEST(DiffractionCommand, CentreMovesTheWindow) {
    const Folder folder;
    const std::vector<std::string> line = {"diffraction", "iris", "--mask-size", "64", "--size", "64"};
    auto whole = line, part = line;
    whole.insert(whole.end(), {"-o", "a.pfm"});
    // 8 steps of 1/64 cycle per texel are 8 cycles per mask of 64 texels.
    part.insert(part.end(), {"-o", "b.pfm", "--centre", "8,-4"});
    ASSERT_EQ(run_in(folder, whole).code, 0);
    ASSERT_EQ(run_in(folder, part).code, 0);
    const Image<float> a = pfm(folder / "a.pfm"), b = pfm(folder / "b.pfm");
    for (int y = 4; y < 64; ++y) {
        for (int x = 0; x < 56; ++x)
            ASSERT_NEAR(b(x, y), a(x + 8, y - 4), 1e-6);
    }
}

TEST(DiffractionCommand, AmplitudesSquareToThePower) {
    const Folder folder;
    const Outcome run = run_in(
        folder, {"diffraction", "whirl", "--mask-size", "128", "--size", "64", "--amplitude", "-o", "w.pfm"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(folder.listing(), (std::vector<std::string>{"w.im.pfm", "w.pfm", "w.re.pfm"}));
    const Image<float> power = pfm(folder / "w.pfm"), re = pfm(folder / "w.re.pfm"),
                       im = pfm(folder / "w.im.pfm");
    double odd = 0;
    for (std::size_t i = 0; i < power.pixels.size(); ++i) {
        ASSERT_NEAR(power.pixels[i], re.pixels[i] * re.pixels[i] + im.pixels[i] * im.pixels[i], 1e-6f);
        odd = std::max(odd, std::fabs(static_cast<double>(im.pixels[i])));
    }
    EXPECT_GT(odd, 1e-3) << "a pinwheel has no mirror symmetry";
}

TEST(DiffractionCommand, ASpotStandsBehindADisc) {
    // An annulus nearly all obstruction is an opaque disc in a wide opening: light on its axis (Poisson).
    const Folder folder;
    const Outcome run = run_in(folder, {"diffraction", "circle", "--near", "2000", "--mask-size", "256",
                                        "--size", "65", "--zoom", "8", "-o", "c.pfm"});
    ASSERT_EQ(run.code, 0) << run.err;
    // 5 mm at 2 m: Fresnel number of the opening a^2 / (lambda z), intensity 4 sin^2(pi F / 2) on the axis.
    const double fresnel = 0.0025 * 0.0025 / (550e-9 * 2),
                 expected = 4 * std::pow(std::sin(1.5707963267948966 * fresnel), 2);
    const Image<float> light = pfm(folder / "c.pfm");
    EXPECT_NEAR(light(32, 32), expected, 0.06) << "the mask has texels";
    EXPECT_NE(run.out.find("near field at 2000 mm"), std::string::npos) << run.out;
}

TEST(DiffractionCommand, TheFresnelNumberIsThatOfTheOpening) {
    const Folder folder;
    // Open 100 x 60 texels of 1 um in a wide mask: a = 50 um.
    std::string mask = "P5\n512 300\n255\n" + std::string(512 * 300, '\0');
    for (std::size_t y = 20; y < 80; ++y)
        std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(mask.size() - 512 * 300 + 512 * y + 300), 100,
                    '\xff');
    folder.write("hole.pgm", mask);
    const auto told = [&](const std::string& near_mm) {
        return run_in(folder, {"diffraction", "hole.pgm", "--pitch-um", "1", "--near", near_mm,
                               "--wavelength-nm", "500", "--plan"});
    };
    EXPECT_NE(told("5").out.find("Fresnel number 1 at 500 nm"), std::string::npos) << told("5").out;
    EXPECT_EQ(told("40").err, "");
    EXPECT_NE(told("60").err.find("all but the far field's"), std::string::npos);
    const Outcome made =
        run_in(folder, {"diffraction", "hole.pgm", "--pitch-um", "1", "--near", "2.5", "--size", "16",
                        "--wavelength-nm", "500", "-o", "h.png", "--stats-json", "h.json"});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NEAR(parse_json(file_text(folder / "h.json")).at("fresnel_number").number, 2, 1e-12);
}

TEST(DiffractionCommand, ThePlanNamesMethodAndReason) {
    const Folder folder;
    const Outcome run = run_in(folder, {"diffraction", "iris", "--plan", "--blades", "5", "--diameter-mm",
                                        "9", "--wavelength_nm", "500"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_TRUE(folder.listing().empty());
    EXPECT_NE(run.out.find("(10 mm wide)"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("method    "), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("at 500 nm"), std::string::npos) << run.out;
}

TEST(DiffractionCommand, ADefaultPictureShowsTheSameOfEveryMask) {
    // 57.6 fringes of 0.9 mask sides at the edge: 64 cycles per side, however many texels the mask has.
    const Folder folder;
    for (const char* mask : {"2048", "1024", "512", "128"}) {
        const Outcome run =
            run_in(folder, {"diffraction", "iris", "--plan", "--size", "128", "--mask-size", mask});
        EXPECT_NE(run.out.find("pixels of 1 cycles per side"), std::string::npos) << mask << run.out;
    }
    const Outcome near = run_in(folder, {"diffraction", "iris", "--plan", "--near", "9", "--pitch-um", "3"});
    EXPECT_NE(near.out.find("1024 x 1024 pixels of 3 um"), std::string::npos) << near.out;
    // A mask of 2 x 8 texels of 1 um: the near field's picture is 8 um wide and high.
    folder.write("tall.pgm", "P2\n2 8\n1\n1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\n");
    const Outcome tall = run_in(
        folder, {"diffraction", "tall.pgm", "--plan", "--near", "9", "--pitch-um", "1", "--size", "4"});
    EXPECT_NE(tall.out.find("4 x 4 pixels of 2 um"), std::string::npos) << tall.out;
}

TEST(DiffractionCommand, AMethodAskedForStandsBesideTheCheapest) {
    const Folder folder;
    const Outcome far = run_in(folder, {"diffraction", "iris", "--plan", "--method", "direct"});
    EXPECT_NE(far.out.find("the cheapest, runs, takes about"), std::string::npos) << far.out;
    const Outcome near =
        run_in(folder, {"diffraction", "iris", "--plan", "--near", "9", "--method", "direct"});
    EXPECT_NE(near.out.find("the cheapest, "), std::string::npos) << near.out;
}

TEST(DiffractionCommand, NearFieldsFarAwayHintAtTheFarField) {
    const Folder folder;
    const auto notes = [&](const char* mm) {
        return run_in(folder, {"diffraction", "iris", "--plan", "--near", mm}).err;
    };
    EXPECT_EQ(notes("1000"), "");
    EXPECT_NE(notes("1e6").find("note: so far away the pattern is all but the far field's; see --far"),
              std::string::npos);
}

TEST(DiffractionCommand, MethodsOfSomeGridsServeThoseTheyAskFor) {
    const Folder folder;
    for (const std::vector<std::string>& flags :
         {std::vector<std::string>{"--method", "levels", "--zoom", "2"},
          std::vector<std::string>{"--method", "fft", "--near", "5", "--zoom", "4"},
          std::vector<std::string>{"--method", "hybrid", "--near", "5", "--zoom", "0.5"}}) {
        std::vector<std::string> line{"diffraction", "iris", "--plan"};
        line.insert(line.end(), flags.begin(), flags.end());
        const Outcome run = run_in(folder, line);
        EXPECT_EQ(run.code, 0) << run.err;
    }
}

TEST(DiffractionCommand, SegmentsAndVanesAreCounted) {
    const Folder folder;
    const auto open_share = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), "diffraction");
        flags.insert(flags.end(), {"--plan", "--mask-size", "512"});
        const std::string out = run_in(folder, flags).out;
        const std::size_t end = out.find(" % open");
        return end == std::string::npos ? -1.0 : std::stod(out.substr(out.rfind(' ', end - 1)));
    };
    EXPECT_NEAR(open_share({"annulus", "--vanes", "0", "--obstruction", "0.5"}), 47.71,
                0.06);  // pi .45^2 3/4
    EXPECT_LT(open_share({"annulus", "--vanes", "9", "--obstruction", "0.5"}), 47);
    EXPECT_GT(std::fabs(open_share({"hexagons", "--rings", "1"}) - open_share({"hexagons", "--rings", "4"})),
              0.5);
}

TEST(DiffractionCommand, StatisticsAreJson) {
    const Folder folder;
    ASSERT_EQ(run_in(folder, {"diffraction", "box", "--mask-size", "64", "--size", "64", "--stats-json",
                              "s.json", "-o", "b.png"})
                  .code,
              0);
    const std::string text = file_text(folder / "s.json");
    for (const char* member :
         {"\"method\": ", "\"reason\": ", "\"planned_ms\": ", "\"field\": \"far\"", "\"open_texels\": "})
        EXPECT_NE(text.find(member), std::string::npos) << member << text;
}

TEST(DiffractionCommand, EveryInstructionSetGivesTheSameFile) {
    const Folder folder;
    std::string expected;
    for (const char* isa : {"ref", "sse2", "auto"}) {
        for (const char* threads : {"1", "3"}) {
            ASSERT_EQ(
                run_in(folder, {"diffraction", "iris", "--mask-size", "64", "--size", "96", "--spectrum",
                                "blackbody:3000", "--isa", isa, "-t", threads, "--overwrite", "-o", "i.pfm"})
                    .code,
                0);
            const std::string bytes = file_text(folder / "i.pfm");
            if (expected.empty()) expected = bytes;
            EXPECT_TRUE(bytes == expected) << isa << " " << threads;
        }
    }
}

struct Mistake {
    std::vector<std::string> flags;
    int code;
    std::string message;
};

TEST(DiffractionCommand, MistakesAreToldBeforeAnythingIsComputed) {
    const Folder folder;
    const std::vector<Mistake> mistakes = {
        {{"iris", "--wavelength_nm", "0.55"},
         2,
         "--wavelength-nm: 0.55 nm is not from 10 to 1e6; did you mean 550 nm?"},
        {{"iris", "--wavelength-nm", "5.5e-7"}, 2, "did you mean 550 nm?"},
        {{"iris", "--wavelength-nm", "-550"}, 2, "-550 nm is not from 10 to 1e6"},
        {{"iris", "--near", "0"}, 2, "--near: 0 mm is not in front of the aperture; give a distance above 0"},
        {{"iris", "--near", "-5"}, 2, "--near: -5 mm is not in front of the aperture"},
        {{"iris", "--near", "5", "--far"}, 2, "give either --far or --near, not both"},
        {{"iris", "--method", "fast"}, 2, "--method: 'fast' is not one of automatic, direct"},
        {{"iris", "--method", "rnus"}, 2, "did you mean 'runs'?"},
        {{"iris", "--near", "5", "--method", "polygon"},
         2,
         "--method: 'polygon' is not one of automatic, direct, two_pass"},
        {{"iris", "--method", "raster_fft", "--size", "1000"}, 3, "--method raster_fft: cannot serve"},
        {{"iris", "--method", "levels", "--zoom", "3"},
         3,
         "--size x --zoom = 3072: that must be a power of two, at least the mask's side, 1024"},
        {{"iris", "--method", "levels", "--zoom", "3"}, 3, "; --zoom 2 would do"},
        {{"iris", "--near", "5", "--method", "fft", "--zoom", "3.7"}, 3, "; --zoom 4 would do"},
        {{"iris", "--near", "nan"}, 2, "--near: 'nan' is not a number from 1e-09 to 1000000000000000"},
        {{"iris", "--wavelength-nm", "nan"}, 2, "--wavelength-nm: 'nan' is not a number from 10 to 1000000"},
        {{"irsi"}, 2, "did you mean 'iris'?"},
        {{"iris", "--spectrum", "d56"}, 2, "did you mean 'd65'?"},
        {{"iris", "--spectrum", "blackbody:3"}, 2, "--spectrum: '3' is not a number from 500"},
        {{"iris", "--spectrum", "d65", "--wavelength-nm", "500"},
         2,
         "give either --wavelength-nm or --spectrum"},
        {{"iris", "--spectrum", "d65", "--amplitude"}, 2, "--amplitude is of one wavelength"},
        {{"iris", "--spectrum", "d65", "--method", "edges"}, 2, "--method and --cull are of one wavelength"},
        {{"iris", "--wavelengths", "9"}, 2, "--wavelengths needs --spectrum"},
        {{"iris", "--spectrum-mode", "full60"}, 2, "--spectrum-mode needs --spectrum"},
        {{"iris", "--spectrum", "d65", "--spectrum-mode", "full6"}, 2, "did you mean 'full60'?"},
        {{"iris", "--spectrum", "d65", "--spectrum-mode", "scaled"},
         2,
         "--spectrum-mode: 'scaled' is not one of exact, full60, batch4"},
        {{"iris", "--spectrum", "d65", "--near", "5", "--spectrum-mode", "batch4"},
         2,
         "--spectrum-mode: 'batch4' is not one of exact, scaled"},
        {{"iris", "--spectrum", "d65", "--wavelengths", "9", "--spectrum-mode", "batch4"},
         2,
         "--wavelengths is of --spectrum-mode exact, not of batch4"},
        {{"iris", "--spectrum", "d65", "--zoom", "1", "--spectrum-mode", "batch4", "--limit-memory", "200"},
         4,
         "more than --limit-memory 200"},
        {{"iris", "--pitch-um", "5x6"}, 2, "texels must be square"},
        {{"iris", "--pitch-um", "5", "--diameter-mm", "6"}, 2, "give either --diameter-mm or --pitch-um"},
        {{"iris", "--centre", "4"}, 2, "--centre: '4' is not like 12.5,-3"},
        {{"iris", "--log", "--linear"}, 2, "give either --log or --linear"},
        {{"iris", "--linear", "--decades", "4"}, 2, "--decades is of --log"},
        {{"iris", "-o", "a.png", "-o", "./a.png"}, 2, "'./a.png' would be written twice"},
        {{"iris", "-o", "a.png", "--stats-json", "a.png"}, 2, "'a.png' would be written twice"},
        {{"circle", "--blades", "5"}, 2, "--blades is of iris and whirl, not of circle"},
        {{"none.png", "--rotation-deg", "5"}, 2, "--rotation-deg is of shapes, not of mask files"},
        {{"none.png", "--aspect", "2"}, 2, "--aspect is of box, not of mask files"},
        {{"iris", "--mask-size", "64", "--finest-level", "9"},
         3,
         "closed at --finest-level 9 (1 x 1 texels)"},
        {{"iris", "--size", "900000"}, 4, "more than --limit-memory 4096"},
        {{"iris", "--size", "2048", "--limit-memory", "8"}, 4, "more than --limit-memory 8"},
        {{"iris", "--blades", "2"}, 2, "--blades: '2' is not a whole number from 3 to 64"},
        {{"irsi"}, 2, "did you mean 'iris'?"},
        {{"iris", "--dust", "-1"}, 2, "--dust: '-1' is not a whole number from 0 to 10000"},
        {{"iris", "--occluder", "disk"}, 2, "did you mean 'disc'?"},
        {{"circle", "--occluder", "disc"}, 3, "the aperture is closed"},
        {{"none.png"}, 3, "none.png: cannot open"},
        {{"iris", "-o", "a.jpg"}, 2, "pictures end in .png"},
        {{"iris", "-o", "none/a.png"}, 5, "none/a.png: cannot be created"},
        {{}, 2, "APERTURE is missing"},
    };
    for (const Mistake& m : mistakes) {
        std::vector<std::string> line{"diffraction"};
        line.insert(line.end(), m.flags.begin(), m.flags.end());
        const Outcome run = run_in(folder, line);
        EXPECT_EQ(run.code, m.code) << m.message << run.err;
        EXPECT_NE(run.err.find(m.message), std::string::npos) << run.err << "instead of " << m.message;
    }
    EXPECT_TRUE(folder.listing().empty());
}

}  // namespace
}  // namespace obscura::test
