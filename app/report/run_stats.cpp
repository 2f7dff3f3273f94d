#include "app/report/run_stats.h"

#include <sys/resource.h>

#include <fstream>
#include <string>

#include "app/report/program_version.h"
#include "core/parallel.h"

namespace obscura {

int thread_count(const Exec& exec) {
    return exec.threads > 0 ? exec.threads : hardware_threads();
}

std::int64_t peak_resident_bytes() {
    // What getrusage() tells is never less than what the process had that started this one.
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::int64_t kib = 0;
        if (word == "VmHWM:" && status >> kib) return kib * 1024;
    }
    struct rusage usage {};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::int64_t{usage.ru_maxrss} * 1024;
}

void put_origin(JsonWriter& json, const RunReport& run) {
    json.member("schema", 1).member("program", program_version()).member("scene", run.scene);
}

void put_execution(JsonWriter& json, const Exec& exec) {
    json.member("isa", isa_name(exec.isa)).member("threads", thread_count(exec));
}

void put_picture_size(JsonWriter& json, const RunReport& run) {
    json.member("width_px", run.width).member("height_px", run.height).member("samples", run.samples);
}

void put_times(JsonWriter& json, const RunReport& run) {
    json.member("load_s", run.load_s).member("total_s", run.total_s);
}

}  // namespace obscura
