#include "app/cli/new_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

// The files of scenes/starters, as CMake has put them here.
constexpr Starter all[] = {
#include "app/cli/starters.inc"
};

std::string names() {
    std::string out;
    for (const Starter& s : all)
        out += fmt::format("{}{} ({})", out.empty() ? "" : ", ", s.name, s.summary);
    return out;
}

/// A name as a shell takes it for one word.
std::string quoted(const std::filesystem::path& file) {
    std::string name = file.string();
    if (name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./+-") ==
        std::string::npos)
        return name;
    std::string out = "'";
    for (const char c : name)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace

std::span<const Starter> starters() {
    return all;
}

int new_command(const NewOptions& options) {
    const auto starter = std::find_if(std::begin(all), std::end(all),
                                      [&](const Starter& s) { return s.name == options.kind; });
    if (starter == std::end(all)) {
        std::vector<std::string> kinds;
        for (const Starter& s : all)
            kinds.emplace_back(s.name);
        throw UsageError(fmt::format("--kind '{}' is none of {}{}", options.kind, fmt::join(kinds, ", "),
                                     hint(options.kind, kinds)));
    }
    std::filesystem::path file = options.file;
    if (!file.has_filename()) throw UsageError(fmt::format("'{}' is no name of a file", file.string()));
    if (file.extension() != ".toml") file += ".toml";
    write_file_atomically(file, starter->text, options.existing);
    std::filesystem::path picture = file;
    picture.replace_extension(".png");
    say(fmt::format("written: {}\nrender it: obscura {} {} -o {}\n", file.string(),
                    starter->stereo ? "stereo" : "render", quoted(file), quoted(picture)));
    return 0;
}

int run_new(const Arguments& arguments) {
    Flags flags(
        "new [options] FILE",
        "Writes a commented scene to begin with, which needs no other files: change a number, render again.");
    NewOptions options;
    std::string file;
    bool overwrite = false;
    flags.positional("FILE", file, "The scene file to be written; .toml is added where it does not end so.");
    flags.group("Scene");
    flags.text("--kind", "NAME", options.kind, names() + ".", "place");
    flags.group("Output");
    flags.on_off("--overwrite", overwrite, "Replace FILE when it exists.");
    if (!flags.parse(arguments)) return 0;
    options.file = file;
    options.existing = overwrite ? Existing::replace : Existing::refuse;
    return new_command(options);
}

}  // namespace obscura
