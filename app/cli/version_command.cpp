#include "app/cli/version_command.h"

#include <fmt/format.h>

#include "app/cli/flags.h"
#include "app/cli/messages.h"
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
    print(fmt::format(
        "{}\nbuilt with        {}, C++20, {}\ninstruction sets  {} (chosen: {})\nthreads           {}\n"
        "libraries         {}\n",
        program_version(), compiler(), OBSCURA_BUILD_TYPE, sets, isa_name(best_isa()), hardware_threads(),
        OBSCURA_LIBRARIES));
    return 0;
}

int run_version(const Arguments& arguments) {
    Flags flags("version", "Prints version, compiler, instruction sets, threads and libraries.");
    if (!flags.parse(arguments)) return 0;
    return version_command();
}

}  // namespace obscura
