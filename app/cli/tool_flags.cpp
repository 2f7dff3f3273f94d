// Flags of the commands that look at files.

#include <string>

#include "app/cli/check_command.h"
#include "app/cli/commands.h"
#include "app/cli/diff_command.h"
#include "app/cli/dump_command.h"
#include "app/cli/flags.h"
#include "app/cli/info_command.h"
#include "app/cli/scene_flags.h"
#include "app/cli/version_command.h"
#include "core/error.h"

namespace obscura {
namespace {

std::vector<std::filesystem::path> as_paths(const std::vector<std::string>& texts) {
    return {texts.begin(), texts.end()};
}

}  // namespace

int run_check(const Arguments& arguments) {
    Flags flags("check [options] SCENE",
                "Reads, loads and validates a scene and prints what rendering would compute: lights, shadow "
                "maps, memory, frames. Renders and writes nothing.");
    SceneFlags scene;
    scene.add_to(flags);
    if (!flags.parse(arguments)) return 0;
    return check_command({scene.scene, scene.all_overrides(), scene.allowed_paths()});
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

int run_info(const Arguments& arguments) {
    Flags flags("info [options] FILE",
                "Prints what a mesh file (Wavefront OBJ) holds: triangles, components closed or open, open "
                "edges, bounding box in the file's own units, degenerate triangles.");
    std::string file;
    std::vector<std::string> allowed;
    InfoOptions options;
    flags.positional("FILE", file, "The mesh file.");
    flags.group("Input");
    flags.list("--allow-path", "DIR", allowed,
               "A folder besides the file's own that material files may lie in; may be given again.");
    flags.on_off("--allow-missing", options.allow_missing,
                 "Go on without material files that are not there.");
    if (!flags.parse(arguments)) return 0;
    options.file = file;
    options.allowed_paths = as_paths(allowed);
    return info_command(options);
}

int run_diff(const Arguments& arguments) {
    Flags flags("diff [options] A B",
                "Compares two PNG or two PFM files of the same size: prints the largest and mean difference, "
                "PSNR, SSIM and how many pixels differ. Differences are in codes 0 to 255 (PNG) or in the "
                "values of the file (PFM).");
    std::string a, b, picture;
    double fail = -1;
    bool overwrite = false;
    DiffOptions options;
    flags.positional("A", a, "The first picture.");
    flags.positional("B", b, "The second picture.");
    flags.group("Comparison");
    flags.number("--threshold", "DIFF", options.threshold, 0, 1e30, "Count the pixels that differ by more.",
                 "0");
    flags.number("--fail", "DIFF", fail, 0, 1e30, "Exit with 10 when the largest difference is above this.",
                 "never");
    flags.group("Output");
    flags.text("-o,--output", "FILE", picture, "Write a picture of the differences (.png).", "none");
    flags.on_off("--overwrite", overwrite, "Replace the picture when it exists.");
    if (!flags.parse(arguments)) return 0;
    options.a = a;
    options.b = b;
    options.picture = picture;
    if (fail >= 0) options.fail = fail;
    options.existing = overwrite ? Existing::replace : Existing::refuse;
    return diff_command(options);
}

int run_version(const Arguments& arguments) {
    Flags flags("version", "Prints version, compiler, instruction sets, threads and libraries.");
    if (!flags.parse(arguments)) return 0;
    return version_command();
}

}  // namespace obscura
