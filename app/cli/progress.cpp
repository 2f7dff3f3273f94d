#include "app/cli/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/cli/messages.h"

namespace obscura {
namespace {

constexpr std::int64_t live_interval_ms = 100;
constexpr double worth_guessing_s = 1.0;  // an estimate out of less would jump about

}  // namespace

Progress::Style Progress::style_for(std::FILE* stream, bool quiet) {
    if (quiet) return Style::silent;
    return has_escapes(stream) ? Style::live : Style::lines;
}

Progress::Progress(std::FILE* stream_, Style style_) : stream(stream_), style(style_) {}

void Progress::clear() {
    const std::lock_guard lock(mutex);
    if (!line_open) return;
    line_open = false;
    std::fputs("\r\x1b[K", stream);
    std::fflush(stream);
}

void Progress::begin(std::string label_, double from_, double to_) {
    const std::lock_guard lock(mutex);
    label = std::move(label_);
    from = from_;
    to = to_;
}

void Progress::update(double fraction) {
    if (style == Style::silent) return;
    const double share = from + (to - from) * std::clamp(fraction, 0.0, 1.0);
    // What was done before the first sign of progress (shadow maps, setup) says nothing about the rate.
    std::call_once(first, [&] {
        first_s = watch.seconds();
        first_share = share;
    });
    if (style == Style::live) {
        const auto now = static_cast<std::int64_t>(watch.seconds() * 1000);
        std::int64_t due = next_ms.load();
        if (now < due || !next_ms.compare_exchange_strong(due, now + live_interval_ms)) return;
    } else {
        const int tenth = static_cast<int>(share * 10 + 1e-9);
        int due = next_tenth.load();
        if (tenth < due || tenth >= 10 || !next_tenth.compare_exchange_strong(due, tenth + 1)) return;
    }
    show(share);
}

void Progress::finish() {
    if (style == Style::lines) show(1.0);
    clear();
}

void Progress::show(double share) {
    const std::lock_guard lock(mutex);
    const double elapsed = watch.seconds();
    std::string line =
        fmt::format("{}: {:3.0f} %  {}", label, std::floor(share * 100), duration_text(elapsed));
    const double known_s = elapsed - first_s, known = share - first_share;
    if (known > 0 && share < 1 && known_s > worth_guessing_s) {
        line += fmt::format(", about {} left", duration_text(known_s / known * (1 - share)));
    }
    if (style == Style::live) {
        std::fprintf(stream, "\r%s\x1b[K", line.c_str());
        line_open = true;
    } else {
        std::fprintf(stream, "%s\n", line.c_str());
    }
    std::fflush(stream);
}

}  // namespace obscura
