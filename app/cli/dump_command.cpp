#include "app/cli/dump_command.h"

#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/scene/format_doc.h"
#include "app/scene/scene_file.h"
#include "core/error.h"

namespace obscura {

int dump_command(const DumpOptions& options) {
    const std::string text =
        options.format ? scene_format_doc() : dump_scene(read_scene(options.scene, options.overrides));
    print(text);
    return 0;
}

int run_dump(const Arguments& arguments) {
    Flags flags("dump [options] SCENE",
                "Prints the effective scene as TOML, defaults and overrides included. Reading that gives the "
                "same scene again.");
    DumpOptions options;
    std::string scene;
    flags.positional("SCENE", scene, "The scene file (TOML); not with --format.", false);
    flags.group("Scene");
    flags.list("-D,--define", "KEY=VALUE", options.overrides,
               "Replace a value of the scene (see 'obscura render --help'); may be given again.");
    flags.group("Output");
    flags.on_off("--format", options.format, "Print the description of the scene format instead.");
    if (!flags.parse(arguments)) return 0;
    if (options.format == !scene.empty()) {
        throw UsageError(options.format ? "--format takes no SCENE (see 'obscura dump --help')"
                                        : "SCENE is missing (see 'obscura dump --help')");
    }
    options.scene = scene;
    return dump_command(options);
}

}  // namespace obscura
