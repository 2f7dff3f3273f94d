// Flags of `obscura render`.

#include <string>

#include "app/cli/commands.h"
#include "app/cli/flag_values.h"
#include "app/cli/flags.h"
#include "app/cli/render_command.h"
#include "app/cli/scene_flags.h"
#include "core/error.h"

namespace obscura {
namespace {

FileKind kind_value(const std::string& flag, const std::string& text) {
    if (text == "png") return FileKind::png;
    if (text == "pfm") return FileKind::pfm;
    throw UsageError(flag + ": '" + text + "' is not png or pfm");
}

}  // namespace

int run_render(const Arguments& arguments) {
    Flags flags("render [options] SCENE", "Renders a scene file to pictures.");
    SceneFlags scene;
    RenderOptions options;
    std::string aovs, aov_kind = "pfm", isa = "auto", stats;
    std::int64_t threads = 0;

    scene.add_to(flags);
    flags.group("Pictures");
    flags.text("-o,--output", "FILE", options.output,
               "Where the picture goes: .png (8-bit sRGB, exposure and tone curve applied) or .pfm (linear "
               "float radiance); #### stands for the frame number and pads it.",
               "the scene's list, else SCENE.png in the current folder");
    flags.on_off("--overwrite", options.overwrite, "Replace files that exist; otherwise they are an error.");
    flags.text("--frames", "RANGE", options.frames, "Frames to render: 1-48x2 or 1,5,9-12.",
               "all of the scene");
    flags.text("--crop", "X0,Y0,X1,Y1", options.crop,
               "Render only these pixels of the whole picture, row 0 on top; X1 and Y1 lie outside.",
               "everything");
    flags.text(
        "--aov", "NAMES", aovs,
        "Further pictures beside the first, NAME.depth.pfm and so on: depth (m), normal, albedo, object, "
        "shadow; separated by commas.",
        "none");
    flags.text("--aov-format", "KIND", aov_kind, "pfm (numbers as they are) or png (mapped to look at).",
               "pfm");
    flags.text("--pixel", "X,Y", options.pixel,
               "Print every number that made this pixel of the first frame, and write nothing.", "off");
    add_exec_flags(flags, threads, isa);
    flags.group("Messages");
    flags.on_off("-q,--quiet", options.quiet, "Say nothing but errors.");
    flags.counted("-v,--verbose", options.verbosity, "Say what each stage took.");
    flags.text("--stats-json", "FILE", stats, "Write times (s), counts and memory (bytes) as JSON.", "none");
    if (!flags.parse(arguments)) return 0;

    options.scene = scene.scene;
    options.overrides = scene.all_overrides();
    options.allowed_paths = scene.allowed_paths();
    if (!aovs.empty()) options.aovs = aov_values("--aov", aovs);
    options.aov_kind = kind_value("--aov-format", aov_kind);
    options.exec = {isa_value("--isa", isa), static_cast<int>(threads)};
    options.stats_json = stats;
    return render_command(options);
}

}  // namespace obscura
