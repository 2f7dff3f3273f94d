#include "app/cli/version_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "app/cli/flags.h"
#include "app/report/program_version.h"
#include "core/isa.h"
#include "core/parallel.h"

namespace obscura {
namespace {

std::string compiler() {
#if defined(__clang__)
    return fmt::format("clang++ {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
    return fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

}  // namespace

int version_command() {
    std::string sets;
    for (const Isa isa : supported_isas())
        sets += fmt::format("{}{}", sets.empty() ? "" : " ", isa_name(isa));
    fmt::print("{}\n", program_version());
    fmt::print("built with        {}, C++20, {}\n", compiler(), OBSCURA_BUILD_TYPE);
    fmt::print("instruction sets  {} (chosen: {})\n", sets, isa_name(best_isa()));
    fmt::print("threads           {}\n", hardware_threads());
    fmt::print("libraries         {}\n", OBSCURA_LIBRARIES);
    return 0;
}

int run_version(const Arguments& arguments) {
    Flags flags("version", "Prints version, compiler, instruction sets, threads and libraries.");
    if (!flags.parse(arguments)) return 0;
    return version_command();
}

}  // namespace obscura
