#include "lessons/lessons.h"

#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/ladder.h"

namespace obscura {
namespace {

struct Row {
    Image<Rgb8> (*draw)(const Exec& exec);
    const char *title, *summary;
};

constexpr Row rows[] = {
#define OBSCURA_LESSON_ROW(draw, title, summary) {draw, title, summary},
    OBSCURA_LESSONS(OBSCURA_LESSON_ROW)
#undef OBSCURA_LESSON_ROW
};

std::vector<LessonInfo> numbered_rows() {
    std::vector<LessonInfo> infos;
    for (const Row& row : rows)
        infos.push_back({static_cast<int>(infos.size()) + 1, row.title, row.summary});
    return infos;
}

}  // namespace

std::span<const LessonInfo> lessons() {
    static const std::vector<LessonInfo> infos = numbered_rows();
    return infos;
}

Image<Rgb8> draw_lesson(int number, const Exec& exec) {
    if (number < 1 || number > static_cast<int>(std::size(rows))) {
        throw UsageError(fmt::format("there is no lesson {}: choose 1 to {}", number, std::size(rows)));
    }
    return rows[number - 1].draw(exec);
}

}  // namespace obscura
