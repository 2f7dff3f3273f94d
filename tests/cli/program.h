#pragma once
// Runs the built obscura as its users do and keeps what it said.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace obscura::test {

/// A scene that renders in milliseconds: a box under a lamp with a shadow map, before the sky.
inline const char* const small_scene = R"(format = 1
[camera]
eye_m = [0, 2, 8]
look_at_m = [0, 1, 0]
vfov_deg = 35
[[mesh]]
id = "cube"
shape = "box"
size_m = 2
material = "stone"
[material.stone]
base_color = [0.6, 0.55, 0.5]
[[light]]
id = "lamp"
type = "directional"
azimuth_deg = 120
elevation_deg = 30
[shadow.lamp]
resolution = 256
[render]
size_px = [64, 48]
)";

/// What a run left behind. `code` is the exit code, or 1000 + n when signal n killed the process.
struct Outcome {
    int code = -1;
    std::string out, err;
};

inline std::string file_text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// A folder of this test's own; removed at the end.
class Folder {
  public:
    Folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "obscura_test_XXXXXX").string();
        if (::mkdtemp(pattern.data()) != nullptr) path = pattern;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path / name; }
    /// Writes a file and returns its name.
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return name;
    }
    /// Names of everything in it, hidden files too.
    std::vector<std::string> listing() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    std::filesystem::path path;
};

/// One run, from start to the reading of its streams.
class Program {
  public:
    std::filesystem::path folder = ".";    ///< where it runs
    std::string binary;                    ///< what runs
    std::string out_target;                ///< file or device for standard output instead of capturing it
    bool out_closed = false;               ///< starts without a standard output
    bool err_on_terminal = false;          ///< standard error is a terminal
    bool out_broken_pipe = false;          ///< standard output is a pipe nobody reads
    std::string err_target;                ///< file or device for standard error instead of capturing it
    bool err_closed = false;               ///< starts without a standard error
    bool err_broken_pipe = false;          ///< standard error is a pipe nobody reads
    std::optional<rlim_t> memory_bytes;    ///< ulimit -v
    std::optional<rlim_t> file_bytes;      ///< ulimit -f; its streams are files, too
    std::vector<std::string> environment;  ///< NAME=value on top of ours

    explicit Program(std::vector<std::string> arguments_, std::string binary_ = OBSCURA_BINARY,
                     std::vector<std::string> environment_ = {})
        : binary(std::move(binary_)),
          environment(std::move(environment_)),
          arguments(std::move(arguments_)) {}

    /// Starts the process. Its streams go to files in a folder of their own.
    void start() {
        if (err_on_terminal) {
            terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
            ASSERT_TRUE(terminal >= 0 && ::grantpt(terminal) == 0 && ::unlockpt(terminal) == 0);
            terminal_name = ::ptsname(terminal);
            // Held open until the end, so that what was said is not lost when the process closes its side.
            held = ::open(terminal_name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        }
        process = ::fork();
        if (process == 0) become_obscura();
    }
    void send(int signal) const { ::kill(process, signal); }
    bool running() const {
        siginfo_t info{};
        return ::waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               info.si_pid == 0;
    }
    /// What it has said on standard error so far.
    std::string err_so_far() const { return file_text(streams / "err"); }

    Outcome wait() {
        std::string on_terminal;
        while (terminal >= 0 && running())
            read_terminal(on_terminal);
        if (terminal >= 0) read_terminal(on_terminal);
        int status = 0;
        ::waitpid(process, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), file_text(streams / "out"),
                terminal >= 0 ? on_terminal : file_text(streams / "err")};
    }
    Outcome run() {
        start();
        return wait();
    }

    ~Program() {
        if (terminal >= 0) ::close(terminal);
        if (held >= 0) ::close(held);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

  private:
    /// Takes what is there, after waiting for it a little.
    void read_terminal(std::string& text) const {
        pollfd ready{terminal, POLLIN, 0};
        char block[4096];
        while (::poll(&ready, 1, 50) > 0) {
            const ssize_t n = ::read(terminal, block, sizeof block);
            if (n <= 0) return;
            text.append(block, static_cast<std::size_t>(n));
        }
    }

    static void redirect(const std::string& target, int to) {
        const int fd = ::open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        if (fd < 0) ::_exit(120);
        ::dup2(fd, to);
        ::close(fd);
    }

    static void redirect_to_broken_pipe(int to) {
        int ends[2];
        if (::pipe(ends) != 0) ::_exit(122);
        ::close(ends[0]);
        ::dup2(ends[1], to);
        ::close(ends[1]);
    }

    static void limit(int resource, const std::optional<rlim_t>& most) {
        if (!most) return;
        const rlimit both{*most, *most};
        ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
    }

    [[noreturn]] void become_obscura() const {
        if (::chdir(folder.c_str()) != 0) ::_exit(121);
        const std::string err = err_target.empty() ? (streams / "err").string() : err_target;
        redirect(err_on_terminal ? terminal_name : err, 2);
        redirect(out_target.empty() ? (streams / "out").string() : out_target, 1);
        if (out_broken_pipe) redirect_to_broken_pipe(1);
        if (err_broken_pipe) redirect_to_broken_pipe(2);
        if (out_closed) ::close(1);
        if (err_closed) ::close(2);
        limit(RLIMIT_AS, memory_bytes);
        limit(RLIMIT_FSIZE, file_bytes);
        for (const std::string& variable : environment) {
            const std::size_t equals = variable.find('=');
            ::setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
        }
        std::vector<char*> argv{const_cast<char*>(binary.c_str())};
        for (const std::string& a : arguments)
            argv.push_back(const_cast<char*>(a.c_str()));
        argv.push_back(nullptr);
        ::execv(binary.c_str(), argv.data());
        ::_exit(123);
    }

    std::vector<std::string> arguments;
    Folder streams_folder;
    const std::filesystem::path& streams = streams_folder.path;
    pid_t process = -1;
    int terminal = -1, held = -1;
    std::string terminal_name;
};

/// obscura ARGUMENTS in `folder`.
inline Outcome run_in(const Folder& folder, std::vector<std::string> arguments) {
    Program program(std::move(arguments));
    program.folder = folder.path;
    return program.run();
}

}  // namespace obscura::test
