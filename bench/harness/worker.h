#pragma once
// One contestant in a process of its own: libraries that read their thread count once per process can be
// measured at several, a crash takes nobody along, and everyone sits idle while another is on the clock.

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/harness/contestant.h"

namespace obscura {

/// Memory that workers and the bench share: a worker writes a result into it, the bench reads it.
class SharedFloats {
  public:
    /// Throws LimitError when the memory cannot be had.
    explicit SharedFloats(std::size_t count);
    ~SharedFloats();
    SharedFloats(const SharedFloats&) = delete;
    SharedFloats& operator=(const SharedFloats&) = delete;
    float* data() const { return data_; }
    std::size_t size() const { return count_; }

  private:
    float* data_ = nullptr;
    std::size_t count_ = 0;
};

/// What a worker says after it opened the scene.
struct WorkerJob {
    Workload workload = Workload::depth;
    std::string method;
    bool same_work = true;
    bool delivers = false;
};

class Worker {
  public:
    /// Forks a process that is pinned to `threads` cores (as many as there are) and opens a session there;
    /// `name` is the contestant's. The caller must have a single thread: a forked process inherits only the
    /// one that forked. Throws std::runtime_error with the session's message when it cannot open.
    Worker(const std::string& name, const std::function<Session()>& open, int threads,
           const SharedFloats& canvas);
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    const std::string& version() const { return version_; }
    double prepare_ms() const { return prepare_ms_; }
    double prepare_mib() const { return prepare_mib_; }
    const std::vector<WorkerJob>& jobs() const { return jobs_; }

    /// Runs a job once and lets the worker come to rest. Returns wall-clock milliseconds, taken inside it.
    double run(std::size_t job);
    /// Has the last result of a job written into the canvas.
    void deliver(std::size_t job);

  private:
    std::string request(char verb, std::size_t job);

    std::string name_;
    pid_t process_ = -1;
    int socket_ = -1;
    std::string version_;
    double prepare_ms_ = 0, prepare_mib_ = 0;
    std::vector<WorkerJob> jobs_;
};

}  // namespace obscura
