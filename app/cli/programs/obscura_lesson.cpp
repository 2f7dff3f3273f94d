// The program `obscura-lesson`, which `obscura lesson` becomes.

#include <fmt/format.h>

#include <string>

#include "app/cli/flag_values.h"
#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/cli/run_program.h"
#include "app/report/output_plan.h"
#include "core/error.h"
#include "core/file_output.h"
#include "core/image_io.h"
#include "lessons/lessons.h"

namespace obscura {
namespace {

std::string lesson_list() {
    std::string list = "Lessons:";
    for (const LessonInfo& lesson : lessons()) {
        list += fmt::format("\n  {:<34}{}", fmt::format("{}  {}", lesson.number, lesson.title),
                            wrapped(lesson.summary, 36, 100));
    }
    return list;
}

int run_lesson(const Arguments& arguments) {
    Flags flags("lesson [options] NUMBER",
                "Draws the annotated picture of a lesson, one step of the renderer at a time.");
    flags.footer(lesson_list());
    std::string number, output, isa = "auto";
    std::int64_t threads = 0;
    bool overwrite = false;
    const auto count = static_cast<std::int64_t>(lessons().size());
    flags.positional("NUMBER", number, fmt::format("Which lesson, 1 to {}.", count));
    flags.group("Output");
    flags.text("-o,--output", "FILE", output, "Where the picture goes (.png).", "lesson_NUMBER.png");
    flags.on_off("--overwrite", overwrite, "Replace the picture when it exists.");
    add_exec_flags(flags, threads, isa);
    if (!flags.parse(arguments)) return 0;

    const auto lesson = static_cast<int>(whole_number("NUMBER", number, 1, count));
    if (output.empty()) output = fmt::format("lesson_{}.png", lesson);
    if (file_kind(output) != FileKind::png)
        throw UsageError(fmt::format("'{}': lessons end in .png", output));
    const Existing existing = overwrite ? Existing::replace : Existing::refuse;
    check_writable(output, existing);
    const Image<Rgb8> picture = draw_lesson(lesson, {isa_value("--isa", isa), static_cast<int>(threads)});
    write_file_atomically(output, encode_png(picture.view()), existing);
    print(output + "\n");
    return 0;
}

}  // namespace
}  // namespace obscura

int main(int argc, char** argv) {
    return obscura::run_program(argc, argv, obscura::run_lesson);
}
