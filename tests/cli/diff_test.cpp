// The diff command on files: numbers, exit codes, messages.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <string>

#include "app/cli/diff_command.h"
#include "core/error.h"
#include "core/image_io.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

class Diff : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "obscura_diff_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
    }
    void TearDown() override { fs::remove_all(folder); }

    fs::path save(const char* name, const std::string& bytes) const {
        write_file_atomically(folder / name, bytes);
        return folder / name;
    }
    /// Runs the command; what it printed is in `printed`.
    int run(const DiffOptions& options) {
        testing::internal::CaptureStdout();
        const int code = diff_command(options);
        printed = testing::internal::GetCapturedStdout();
        return code;
    }
    std::string input_error(const DiffOptions& options) {
        try {
            run(options);
        } catch (const InputError& e) {
            testing::internal::GetCapturedStdout();
            return e.what();
        }
        return "no error";
    }
    fs::path folder;
    std::string printed;
};

std::string grey_png(std::uint8_t corner, int width = 30) {
    Image<Rgb8> image(width, 20, {100, 100, 100});
    image(7, 5).g = corner;
    return encode_png(image.view());
}

TEST_F(Diff, PrintsTheNumbersOfTwoPngs) {
    const DiffOptions options{save("a.png", grey_png(100)), save("b.png", grey_png(112)), {}, 0, {}, {}, {}};
    EXPECT_EQ(run(options), 0);
    EXPECT_NE(
        printed.find(
            "size    30 x 20 pixels, 3 channels, codes 0..255\nmax     12 at pixel 7,5\nmean    0.00666667\n"
            "psnr    59.0999 dB\n"),
        std::string::npos)
        << printed;
    EXPECT_NE(printed.find("differ  1 pixels above 0 (0.1667 %), first at 7,5\n"), std::string::npos)
        << printed;
}

TEST_F(Diff, FailDecidesTheExitCode) {
    DiffOptions options{save("a.png", grey_png(100)), save("b.png", grey_png(112)), 12.0, 0, {}, {}, {}};
    EXPECT_EQ(run(options), 0);
    options.fail = 11.9;
    EXPECT_EQ(run(options), 10);
    options.b = options.a;
    options.fail = 0.0;
    EXPECT_EQ(run(options), 0);
    EXPECT_NE(printed.find("psnr    inf dB\nssim    1.000000\ndiffer  0 pixels above 0 (0.0000 %)\n"),
              std::string::npos)
        << printed;
    options.fail = -1.0;
    EXPECT_THROW(run(options), UsageError);
    testing::internal::GetCapturedStdout();
}

TEST_F(Diff, WritesThePictureOnce) {
    DiffOptions options{
        save("a.png", grey_png(100)), save("b.png", grey_png(112)), {}, 0, folder / "d.png", {}, {}};
    EXPECT_EQ(run(options), 0);
    EXPECT_THROW(run(options), OutputError);
    testing::internal::GetCapturedStdout();
    options.existing = Existing::replace;
    EXPECT_EQ(run(options), 0);
    options.picture = "/dev/full";
    EXPECT_THROW(run(options), OutputError);
    testing::internal::GetCapturedStdout();
}

TEST_F(Diff, ComparesLinearFloats) {
    Image<float> a(12, 12, 0.5f), b = a;
    a(0, 0) = 2.5f;
    b(0, 0) = 2.25f;
    b(3, 4) = 1.0f;
    const DiffOptions options{
        save("a.pfm", encode_pfm(a.view())), save("b.pfm", encode_pfm(b.view())), 0.5, 0.3, {}, {}, {}};
    EXPECT_EQ(run(options), 0);
    EXPECT_NE(printed.find("12 x 12 pixels, 1 channel, linear\nmax     0.5 at pixel 3,4\n"),
              std::string::npos)
        << printed;
    EXPECT_NE(printed.find("differ  1 pixels above 0.3"), std::string::npos) << printed;
}

TEST_F(Diff, SixteenBitsCountWhenEitherPictureHasThem) {
    Image<std::uint16_t> a(12, 12, 0x1200), b = a;
    b(3, 4) = 0x12ff;
    DiffOptions options{
        save("a.png", encode_png(a.view())), save("b.png", encode_png(b.view())), 254.0, 0, {}, {}, {}};
    EXPECT_EQ(run(options), 10);
    EXPECT_NE(printed.find("3 channels, codes 0..65535\nmax     255 at pixel 3,4\n"), std::string::npos)
        << printed;
    // 8 bits are spread over the same codes: 0x64 is 0x6464.
    const Image<Rgb8> shallow(12, 12, {0x64, 0x64, 0x64});
    const Image<std::uint16_t> deep(12, 12, 0x6464);
    options = {save("c.png", encode_png(shallow.view())),
               save("d.png", encode_png(deep.view())),
               0.0,
               0,
               {},
               {},
               {}};
    EXPECT_EQ(run(options), 0) << printed;
    std::swap(options.a, options.b);
    EXPECT_EQ(run(options), 0) << printed;
    EXPECT_NE(printed.find("codes 0..65535"), std::string::npos) << printed;
}

TEST_F(Diff, AlphaCountsWhenUsed) {
    Image<Rgba8> a(12, 12), b(12, 12);
    b(2, 2).a = 0;
    const DiffOptions options{
        save("a.png", encode_png(a.view())), save("b.png", encode_png(b.view())), 0.0, 0, {}, {}, {}};
    EXPECT_EQ(run(options), 10);
    EXPECT_NE(printed.find("4 channels"), std::string::npos) << printed;
}

TEST_F(Diff, IncomparableFilesAreInputErrors) {
    const fs::path png = save("a.png", grey_png(100)), wide = save("wide.png", grey_png(100, 31));
    const fs::path pfm = save("a.pfm", encode_pfm(Image<float>(30, 20).view()));
    const fs::path colour = save("c.pfm", encode_pfm(Image<Vec3f>(30, 20).view()));
    const fs::path text = save("t.png", "hello");
    const auto pair = [](const fs::path& a, const fs::path& b) {
        return DiffOptions{a, b, {}, 0, {}, {}, {}};
    };
    EXPECT_NE(input_error(pair(png, wide)).find("31 x 20"), std::string::npos);
    EXPECT_NE(input_error(pair(png, pfm)).find("is a PFM file"), std::string::npos);
    EXPECT_NE(input_error(pair(pfm, png)).find("is a PNG file"), std::string::npos);
    EXPECT_NE(input_error(pair(pfm, colour)).find("3 channels"), std::string::npos);
    EXPECT_NE(input_error(pair(png, text)).find("neither a PNG nor a PFM"), std::string::npos);
    EXPECT_NE(input_error(pair(folder / "none.png", png)).find("none.png"), std::string::npos);
    EXPECT_NE(input_error(pair(png, folder)).find(folder.string()), std::string::npos);
}

}  // namespace
}  // namespace obscura
