#pragma once
// The teaching ladder: lessons that call the rooms' own stage functions and draw one annotated picture each.

#include <span>
#include <string>

#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"

namespace obscura {

struct LessonInfo {
    int number = 0;
    std::string title, summary;
};

/// Every lesson, in order from 1.
std::span<const LessonInfo> lessons();

/// The picture of a lesson, 1600 x 1000 pixels; the same bits for any `exec`. Throws UsageError where there
/// is no such lesson.
Image<Rgb8> draw_lesson(int number, const Exec& exec);

}  // namespace obscura
