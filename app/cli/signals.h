#pragma once
// Signals that end a process (SIGHUP, SIGINT, SIGTERM, SIGXCPU, ...): the first asks the work to stop at its
// next tile; the second ends the process at once with the code of the first, and so does a second of waiting.
// Either way, and after faults (SIGSEGV, SIGABRT, ...), no half-written file stays behind.

#include <atomic>
#include <stdexcept>

namespace obscura {

enum class OnSignal {
    exit_at_once,  ///< remove temporaries, exit with 128 + n
    ask_to_stop,   ///< set the flag; another signal exits at once, as does a second of waiting
};

/// Installs the handlers where a signal still has its default, ignores SIGPIPE and SIGXFSZ (a closed pipe and
/// a file too large are then ordinary write errors) and opens /dev/null in the place of a closed standard
/// stream, so that no output file becomes one.
void install_signal_handlers();
/// What the next signal does; at first `exit_at_once`.
void set_signal_policy(OnSignal policy) noexcept;
/// Becomes true when the work should stop.
const std::atomic<bool>& stop_requested() noexcept;
/// The signal that asked, 0 when none has.
int received_signal() noexcept;

/// Thrown by work that stopped because of a signal (exit 128 + signal).
struct Interrupted : std::runtime_error {
    explicit Interrupted(int signal_) : std::runtime_error("interrupted"), signal(signal_) {}
    int signal;
};

/// Throws Interrupted when a signal has asked the work to stop.
void stop_if_requested();

}  // namespace obscura
