#include "bench/harness/worker.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "bench/harness/run_times.h"
#include "core/error.h"

namespace obscura {
namespace {

// The conversation: the bench sends Request, the worker answers a length and that many bytes of text. The
// first byte of the text is '+' (fine) or '-' (an error message follows).
struct Request {
    char verb;  // 'r' run, 'd' deliver
    std::uint32_t job;
};

bool send_all(int socket, const void* data, std::size_t size) {
    const char* p = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t sent = send(socket, p, size, MSG_NOSIGNAL);
        if (sent <= 0) return false;
        p += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
    char* p = static_cast<char*>(data);
    while (size > 0) {
        const ssize_t got = recv(socket, p, size, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        p += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

bool send_text(int socket, const std::string& text) {
    const auto size = static_cast<std::uint32_t>(text.size());
    return send_all(socket, &size, sizeof size) && send_all(socket, text.data(), size);
}

bool receive_text(int socket, std::string& text) {
    std::uint32_t size = 0;
    if (!receive_all(socket, &size, sizeof size)) return false;
    text.resize(size);
    return receive_all(socket, text.data(), size);
}

/// Keeps this process on the first `count` of its cores.
void pin_to_cores(int count) {
    cpu_set_t allowed, chosen;
    CPU_ZERO(&allowed);
    CPU_ZERO(&chosen);
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
    for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&chosen) < count; ++cpu) {
        if (CPU_ISSET(cpu, &allowed)) CPU_SET(cpu, &chosen);
    }
    sched_setaffinity(0, sizeof chosen, &chosen);
}

/// Version, preparation and jobs, one line each; read back by read_session().
std::string write_session(const Session& session) {
    std::string text = fmt::format("+{}\n{} {}\n", session.version, session.prepare_ms, session.prepare_mib);
    for (const Job& job : session.jobs) {
        text += fmt::format("{} {} {} {}\n", static_cast<int>(job.workload), job.same_work ? 1 : 0,
                            job.deliver ? 1 : 0, job.method);
    }
    return text;
}

std::string answer(const Session& session, const Request& request, float* canvas) {
    const Job& job = session.jobs.at(request.job);
    if (request.verb == 'd') {
        job.deliver(canvas);
        return "+";
    }
    return fmt::format("+{}", milliseconds_of(job.run));
}

/// The life of a worker process. Ends when the bench closes its end of the socket.
void serve(int socket, const std::function<Session()>& open, int threads, float* canvas) {
    try {
        pin_to_cores(threads);
        const Session session = open();
        Request request{};
        bool connected = send_text(socket, write_session(session));
        while (connected && receive_all(socket, &request, sizeof request)) {
            connected = send_text(socket, answer(session, request, canvas));
        }
    } catch (const std::exception& error) {
        send_text(socket, fmt::format("-{}", error.what()));
    }
}

int threads_of_this_process() {
    int count = 0;
    for ([[maybe_unused]] const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
        ++count;
    return count;
}

}  // namespace

SharedFloats::SharedFloats(std::size_t count) : count_(count) {
    void* memory =
        mmap(nullptr, count * sizeof(float), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
        throw LimitError(fmt::format("cannot share {} MiB", count * sizeof(float) >> 20));
    data_ = static_cast<float*>(memory);
}

SharedFloats::~SharedFloats() {
    munmap(data_, count_ * sizeof(float));
}

Worker::Worker(const std::string& name, const std::function<Session()>& open, int threads,
               const SharedFloats& canvas)
    : name_(name) {
    CHECK(threads_of_this_process() == 1, "workers must be forked before any thread is started");
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        throw std::runtime_error(strerror(errno));
    std::fflush(nullptr);
    process_ = fork();
    if (process_ < 0) throw std::runtime_error(fmt::format("fork: {}", strerror(errno)));
    if (process_ == 0) {
        close(ends[0]);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        serve(ends[1], open, threads, canvas.data());
        _exit(0);
    }
    close(ends[1]);
    socket_ = ends[0];

    std::string text;
    const bool alive = receive_text(socket_, text);
    if (!alive || text[0] == '-') {
        close(socket_);
        waitpid(process_, nullptr, 0);
        throw std::runtime_error(alive ? text.substr(1) : "the process ended while opening the scene");
    }
    std::istringstream lines(text.substr(1));
    std::getline(lines, version_);
    lines >> prepare_ms_ >> prepare_mib_;
    for (int workload = 0, same_work = 0, delivers = 0; lines >> workload >> same_work >> delivers;) {
        std::string method;
        std::getline(lines >> std::ws, method);
        jobs_.push_back({static_cast<Workload>(workload), method, same_work != 0, delivers != 0});
    }
}

Worker::~Worker() {
    // Not only close: workers forked later hold a copy of this end.
    shutdown(socket_, SHUT_RDWR);
    close(socket_);
    waitpid(process_, nullptr, 0);
}

std::string Worker::request(char verb, std::size_t job) {
    const Request request{verb, static_cast<std::uint32_t>(job)};
    std::string text;
    if (!send_all(socket_, &request, sizeof request) || !receive_text(socket_, text)) {
        throw std::runtime_error(
            fmt::format("{}: the process ended during \"{}\"", name_, jobs_.at(job).method));
    }
    if (text[0] == '-') throw std::runtime_error(fmt::format("{}: {}", name_, text.substr(1)));
    return text.substr(1);
}

double Worker::run(std::size_t job) {
    const double ms = std::stod(request('r', job));
    // Let spinning threads of this one go to sleep before the next is on the clock.
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    return ms;
}

void Worker::deliver(std::size_t job) {
    CHECK(jobs_.at(job).delivers);
    request('d', job);
}

}  // namespace obscura
