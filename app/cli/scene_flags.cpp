#include "app/cli/scene_flags.h"

#include <fmt/format.h>

#include "app/cli/flag_values.h"
#include "core/error.h"

namespace obscura {

void SceneFlags::add_to(Flags& flags) {
    flags.positional("SCENE", scene, "The scene file (TOML).");
    flags.group("Scene");
    flags.list("-D,--define", "KEY=VALUE", overrides,
               "Replace a value of the scene: a dotted key, lists by an element's id or number, the value in "
               "TOML; may be given again. Example: -D camera.vfov_deg=30");
    flags.text("--size", "WxH", size, "Size of the picture in pixels.", "the scene's");
    flags.whole("--samples", "N", samples, 1, 16, "Samples per pixel: 1, 4 or 16.", "the scene's");
    flags.list("--allow-path", "DIR", allowed,
               "A folder besides the scene's own that its files may lie in; may be given again.");
    flags.on_off("--allow-missing", allow_missing,
                 "Go on without materials and textures of mesh files that are not there: grey, and a note.");
    flags.whole("--limit-memory", "MIB", memory_mib, 1, 1'000'000'000,
                "Refuse to start when the estimate is above this, in MiB.", "the scene's, 4096");
}

std::vector<std::string> SceneFlags::all_overrides() const {
    std::vector<std::string> all = overrides;
    if (!size.empty()) {
        const Size2 s = size_value("--size", size);
        all.push_back(fmt::format("render.size_px=[{},{}]", s.width, s.height));
    }
    if (samples != 0) {
        if (samples != 1 && samples != 4 && samples != 16) {
            throw UsageError(fmt::format("--samples: '{}' is not 1, 4 or 16", samples));
        }
        all.push_back(fmt::format("render.samples={}", samples));
    }
    if (memory_mib != 0) all.push_back(fmt::format("limits.memory_mib={}", memory_mib));
    return all;
}

void RunFlags::add_frames_to(Flags& flags) {
    flags.on_off("--overwrite", run.overwrite, "Replace files that exist; otherwise they are an error.");
    flags.text("--frames", "RANGE", run.frames, "Frames to render: 1-48x2 or 1,5,9-12.", "all of the scene");
}

void RunFlags::add_execution_to(Flags& flags, const std::string& statistics) {
    add_exec_flags(flags, threads, isa);
    flags.group("Messages");
    flags.on_off("-q,--quiet", run.quiet, "Say nothing but errors.");
    flags.counted("-v,--verbose", run.verbosity, "Say what each stage took.");
    flags.text("--stats-json", "FILE", stats, statistics + " - is standard output.", "none");
}

SceneRun RunFlags::value() const {
    SceneRun out = run;
    out.scene = scene.scene;
    out.overrides = scene.all_overrides();
    out.allowed_paths = scene.allowed_paths();
    out.allow_missing = scene.allow_missing;
    out.stats_json = stats;
    return out;
}

Exec RunFlags::exec() const {
    return {isa_value("--isa", isa), static_cast<int>(threads)};
}

}  // namespace obscura
