#include "bench/harness/peak_memory.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace obscura {
namespace {

/// A line of /proc/self/status, in bytes.
std::int64_t status_bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::int64_t kib = 0;
        if (word == name && status >> kib) return kib * 1024;
    }
    return 0;
}

}  // namespace

PeakMemory::PeakMemory() {
    malloc_trim(0);  // memory that was freed but kept would otherwise serve the work unseen
    std::ofstream("/proc/self/clear_refs") << "5";  // the peak starts again from what is resident now
    before_ = status_bytes("VmRSS:");
}

std::int64_t PeakMemory::bytes() const {
    return before_ == 0 ? 0 : std::max<std::int64_t>(status_bytes("VmHWM:") - before_, 0);
}

}  // namespace obscura
