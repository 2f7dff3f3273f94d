#pragma once
// How far the work is, on standard error: one line that renews itself on a terminal, one line per 10 %
// elsewhere.

#include <atomic>
#include <cstdio>
#include <mutex>
#include <string>

#include "core/stopwatch.h"

namespace obscura {

class Progress {
  public:
    enum class Style { silent, lines, live };
    /// The style that fits `stream`: live only on terminals that can take a line away again.
    static Style style_for(std::FILE* stream, bool quiet);

    Progress(std::FILE* stream, Style style);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// What is under way and its share [from, to] of all the work. Single-threaded.
    void begin(std::string label, double from, double to);
    /// Fraction in [0, 1] of what is under way. From any thread; cheap when there is nothing to say.
    void update(double fraction);
    /// Takes the live line away, so that something else can be said.
    void clear();
    /// All is done: the last of the lines, or no live line any more.
    void finish();

  private:
    void show(double share);

    std::FILE* stream;
    Style style;
    Stopwatch watch;  ///< since the beginning
    std::mutex mutex;
    std::atomic<std::int64_t> next_ms{0};  ///< live: nothing is written before
    std::atomic<int> next_tenth{1};        ///< lines: nothing is written before this many tenths
    std::string label;
    double from = 0, to = 1;
    std::once_flag first;
    double first_s = 0, first_share = 0;  ///< at the first update
    bool line_open = false;
};

}  // namespace obscura
