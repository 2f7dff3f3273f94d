#include "core/error.h"

#include <cstdio>
#include <cstdlib>

namespace obscura {
namespace {

std::string located(const std::string& file, int line, int column, const std::string& message) {
    std::string where = file;
    const auto append = [&](const char* separator, const std::string& text) {
        where += separator;
        where += text;
    };
    if (line > 0) append(":", std::to_string(line));
    if (line > 0 && column > 0) append(":", std::to_string(column));
    if (where.empty()) return message;
    append(": ", message);
    return where;
}

}  // namespace

InputError::InputError(std::string file_, int line_, int column_, std::string message_)
    : std::runtime_error(located(file_, line_, column_, message_)),
      file(std::move(file_)),
      line(line_),
      column(column_),
      message(std::move(message_)) {}

void check_failed(const char* expression, const char* file, int line, const std::string& values) {
    std::fprintf(stderr, "%s:%d: broken precondition: %s%s%s\n", file, line, expression,
                 values.empty() ? "" : ": ", values.c_str());
    std::abort();
}

}  // namespace obscura
