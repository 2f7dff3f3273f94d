// The lessons' pictures: the same bits everywhere, known by hash, and committed copies that are not stale.
//
// A picture that changed on purpose: look at it, then for each N
//   obscura lesson N -o lessons/lesson_N.png --overwrite
// and take over the hash that this test prints; the commit says why.

#include "lessons/lessons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

constexpr std::array golden{"2b80deeaca7a1f64", "c1edc3458efbb83c", "415f018f5fd1ffd8", "7c9c081cfe7aeee7",
                            "da4e1855356c3fdd", "58e38df2aa3009e6", "bad0f240905ab4ef", "978e552047151592"};

fs::path lessons_folder() {
    return fs::path(OBSCURA_SOURCE_DIR) / "lessons";
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in.good()) << file;
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
}

std::string hash_of(const Image<Rgb8>& picture) {
    return hash_text(Hasher().value(picture.width).value(picture.height).values(picture.pixels).state);
}

TEST(Lessons, HaveNumbersInOrderAndTheirOwnGoldenHash) {
    ASSERT_EQ(lessons().size(), golden.size());
    for (std::size_t i = 0; i < lessons().size(); ++i) {
        EXPECT_EQ(lessons()[i].number, static_cast<int>(i) + 1);
        EXPECT_FALSE(lessons()[i].title.empty());
        EXPECT_FALSE(lessons()[i].summary.empty());
    }
}

TEST(Lessons, AreTheSameOnEveryIsaAndThreadCount) {
    for (const LessonInfo& lesson : lessons()) {
        SCOPED_TRACE(fmt::format("lesson {}", lesson.number));
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 2}) {
                if (threads == 2 && isa != best_isa()) continue;  // one is enough to see threads
                const Image<Rgb8> picture = draw_lesson(lesson.number, Exec{isa, threads});
                ASSERT_EQ(hash_of(picture), golden[static_cast<std::size_t>(lesson.number - 1)])
                    << isa_name(isa) << ", threads: " << threads;
            }
        }
    }
}

TEST(Lessons, CommittedPicturesAreNotStale) {
    for (const LessonInfo& lesson : lessons()) {
        const fs::path file = lessons_folder() / fmt::format("lesson_{}.png", lesson.number);
        SCOPED_TRACE(file);
        const std::string png = bytes_of(file);
        EXPECT_LT(png.size(), 200u * 1024u);
        const Image<Rgba8> committed = decode_png(png, file.string());
        const Image<Rgb8> drawn = draw_lesson(lesson.number, {});
        ASSERT_EQ(committed.width, drawn.width);
        ASSERT_EQ(committed.height, drawn.height);
        for (int y = 0; y < drawn.height; ++y) {
            for (int x = 0; x < drawn.width; ++x) {
                const Rgba8 c = committed(x, y);
                ASSERT_EQ((Rgb8{c.r, c.g, c.b}), drawn(x, y)) << "first differing pixel: " << x << ", " << y;
            }
        }
    }
}

TEST(Lessons, EachIsOneSourceFileOfLessThan150Lines) {
    std::size_t found = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(lessons_folder())) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("lesson_", 0) != 0 || entry.path().extension() != ".cpp") continue;
        ++found;
        const std::string text = bytes_of(entry.path());
        EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 150) << name;
    }
    EXPECT_EQ(found, lessons().size());
}

TEST(Lessons, AnUnknownNumberIsAUsageError) {
    for (const int number : {-1, 0, static_cast<int>(lessons().size()) + 1, 1000000}) {
        EXPECT_THROW(draw_lesson(number, {}), UsageError) << number;
    }
}

}  // namespace
}  // namespace obscura
