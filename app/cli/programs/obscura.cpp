// The program `obscura`: finds the command and runs it. A command is a pair of files and a row here.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/cli/check_command.h"
#include "app/cli/diff_command.h"
#include "app/cli/diffraction_command.h"
#include "app/cli/dump_command.h"
#include "app/cli/info_command.h"
#include "app/cli/messages.h"
#include "app/cli/new_command.h"
#include "app/cli/render_command.h"
#include "app/cli/run_program.h"
#include "app/cli/sibling_program.h"
#include "app/cli/stereo_command.h"
#include "app/cli/terrain_command.h"
#include "app/cli/version_command.h"
#include "app/report/program_version.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr RunCommand program_of_its_own = nullptr;

struct Command {
    const char* name;
    const char* summary;
    RunCommand run;
};

constexpr Command commands[] = {
    {"new", "Write a scene to begin with", run_new},
    {"render", "Render a scene file to pictures", run_render},
    {"check", "Validate a scene and say what rendering it would take", run_check},
    {"dump", "Print the effective scene, or the description of the format", run_dump},
    {"info", "Print what a mesh file holds", run_info},
    {"diff", "Compare two pictures", run_diff},
    {"diffraction", "Compute the light behind an aperture: far field, near field, colours", run_diffraction},
    {"stereo", "Render a scene for two eyes, with edited disparity", run_stereo},
    {"terrain", "Compute the shadows of a day over an elevation model", run_terrain},
    {"bench", "Measure our methods beside their peers", program_of_its_own},
    {"lesson", "Draw the picture of a lesson", program_of_its_own},
    {"version", "Print version, instruction sets and libraries", run_version},
};

std::string short_help() {
    std::string out =
        program_version() + ": renders scene files on the CPU\n\nUsage: obscura COMMAND [options]\n\n";
    for (const Command& c : commands)
        out += fmt::format("  {:<12}{}\n", c.name, c.summary);
    return out + "\n'obscura COMMAND --help' explains a command.\n";
}

std::vector<std::string> command_names() {
    std::vector<std::string> names;
    for (const Command& c : commands)
        names.emplace_back(c.name);
    return names;
}

int run_command(const Arguments& arguments) {
    if (arguments.empty()) {
        say(short_help());
        return static_cast<int>(ExitCode::usage);
    }
    const std::string& name = arguments.front();
    if (name == "-h" || name == "--help") {
        print(short_help());
        return 0;
    }
    const Arguments rest(arguments.begin() + 1, arguments.end());
    if (name == "--version") return run_version(rest);
    const auto command = std::find_if(std::begin(commands), std::end(commands),
                                      [&](const Command& c) { return c.name == name; });
    if (command == std::end(commands)) {
        throw UsageError(
            fmt::format("unknown command '{}'{} (see 'obscura --help')", name, hint(name, command_names())));
    }
    if (command->run == program_of_its_own) become_sibling(name, rest);
    return command->run(rest);
}

}  // namespace
}  // namespace obscura

int main(int argc, char** argv) {
    return obscura::run_program(argc, argv, obscura::run_command);
}
