#include "app/cli/signals.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file_output.h"

namespace obscura {
namespace {

// A handler can reach nothing but globals; these are lock-free and written by nobody else.
constinit std::atomic<bool> stop{false};
constinit std::atomic<int> first_signal{0};
constinit std::atomic<int> policy_now{static_cast<int>(OnSignal::exit_at_once)};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

/// How long work that was asked to stop may take. Some of it waits for others and would never end: a pipe's
/// writer for its reader.
constexpr unsigned patience_s = 1;

extern "C" void on_signal(int number) {
    int none = 0;
    const bool first = first_signal.compare_exchange_strong(none, number);
    stop.store(true);
    if (first && policy_now.load() == static_cast<int>(OnSignal::ask_to_stop)) {
        ::alarm(patience_s);  // SIGALRM is then the second signal
        return;
    }
    remove_pending_outputs();
    _exit(static_cast<int>(ExitCode::signal_base) + first_signal.load());
}

/// A fault of ours: its default, which writes the core file, follows.
extern "C" void on_fault(int number) {
    remove_pending_outputs();
    ::raise(number);
}

// Their default is to end the process. SIGKILL is missing: nobody can follow it.
constexpr int requests[] = {SIGHUP,  SIGINT,  SIGQUIT,   SIGTERM, SIGXCPU, SIGUSR1,  SIGUSR2,
                            SIGALRM, SIGPROF, SIGVTALRM, SIGPOLL, SIGPWR,  SIGSTKFLT};
constexpr int faults[] = {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGSYS, SIGTRAP};

/// A parent that ignores a signal (nohup, a shell's background job) means it, and what handles one already
/// (a profiler, a sanitizer) has better things to do with it.
void handle_if_default(int number, const struct sigaction& action) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    if (before.sa_handler == SIG_DFL) ::sigaction(number, &action, nullptr);
}

void fill_closed_stream(int fd, int flags) {
    if (::fcntl(fd, F_GETFD) != -1) return;
    // The lowest free number is what open() returns: 0, 1 and 2 are asked for in this order.
    (void)::open("/dev/null", flags);
}

}  // namespace

void install_signal_handlers() {
    fill_closed_stream(0, O_RDONLY);
    fill_closed_stream(1, O_WRONLY);
    fill_closed_stream(2, O_WRONLY);
    struct sigaction action {};
    ::sigemptyset(&action.sa_mask);
    // Ignored, they are the errors EPIPE and EFBIG of the write that met them.
    action.sa_handler = SIG_IGN;
    for (const int number : {SIGPIPE, SIGXFSZ})
        ::sigaction(number, &action, nullptr);
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    for (const int number : requests)
        handle_if_default(number, action);
    for (int number = SIGRTMIN; number <= SIGRTMAX; ++number)
        handle_if_default(number, action);
    action.sa_handler = on_fault;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_NODEFER;
    for (const int number : faults)
        handle_if_default(number, action);
}

void set_signal_policy(OnSignal policy) noexcept {
    policy_now.store(static_cast<int>(policy));
}

const std::atomic<bool>& stop_requested() noexcept {
    return stop;
}

int received_signal() noexcept {
    return first_signal.load();
}

void stop_if_requested() {
    if (stop.load()) throw Interrupted(received_signal());
}

}  // namespace obscura
