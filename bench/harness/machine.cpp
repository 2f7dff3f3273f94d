#include "bench/harness/machine.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

#include "core/isa.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// First value of `key` in a file of "key : value" or "key=value" lines; "unknown" when there is none.
std::string lookup(const char* file, const std::string& key, char separator) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        const std::size_t at = line.find(separator);
        if (at == std::string::npos || line.compare(0, key.size(), key) != 0) continue;
        const std::size_t start = line.find_first_not_of(" \t\"", at + 1);
        const std::size_t end = line.find_last_not_of(" \t\"");
        if (start != std::string::npos) return line.substr(start, end - start + 1);
    }
    return "unknown";
}

std::string first_line(const std::string& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

/// "L1d 48K, L1i 32K, L2 2048K, L3 ..." as the first core sees them.
std::string caches() {
    std::string text;
    for (int i = 0; i < 8; ++i) {
        const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", i);
        const std::string level = first_line(folder + "level"), size = first_line(folder + "size");
        if (level.empty() || size.empty()) break;
        const std::string type = first_line(folder + "type");
        const char* suffix = type == "Data" ? "d" : type == "Instruction" ? "i" : "";
        text += fmt::format("{}L{}{} {}", text.empty() ? "" : ", ", level, suffix, size);
    }
    return text.empty() ? "unknown" : text;
}

std::string isas() {
    std::string text;
    for (const Isa isa : supported_isas())
        text += fmt::format("{}{}", text.empty() ? "" : " ", isa_name(isa));
    return text;
}

std::vector<MachineLine> describe_machine() {
    utsname system{};
    uname(&system);
#ifdef __clang__
    const std::string compiler = "clang++ " __clang_version__;
#else
    const std::string compiler = "g++ " __VERSION__;
#endif
#ifdef NDEBUG
    const char* build = "optimised";
#else
    const char* build = "NOT optimised (assertions on)";
#endif
    const double gib = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                       static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0 * 1024.0);
    return {
        {"Processor", lookup("/proc/cpuinfo", "model name", ':')},
        {"Cores", fmt::format("{}", hardware_threads())},
        {"Caches", caches()},
        {"Instruction sets", isas()},
        {"Memory", fmt::format("{:.0f} GiB", gib)},
        {"System",
         fmt::format("{}, Linux {}", lookup("/etc/os-release", "PRETTY_NAME", '='), system.release)},
        {"Compiler", fmt::format("{}, {}", compiler, build)},
        {"Date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))},
    };
}

}  // namespace

std::string machine_markdown(const std::vector<MachineLine>& more) {
    std::vector<MachineLine> lines = describe_machine();
    lines.insert(lines.end(), more.begin(), more.end());
    std::string text = "## Machine\n\n| | |\n|---|---|\n";
    for (const auto& [name, value] : lines)
        text += fmt::format("| {} | {} |\n", name, value);
    return text;
}

}  // namespace obscura
