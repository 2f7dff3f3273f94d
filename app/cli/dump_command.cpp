#include "app/cli/dump_command.h"

#include <cstdio>

#include "app/scene/format_doc.h"
#include "app/scene/scene_file.h"

namespace obscura {

int dump_command(const DumpOptions& options) {
    const std::string text =
        options.format ? scene_format_doc() : dump_scene(read_scene(options.scene, options.overrides));
    std::fwrite(text.data(), 1, text.size(), stdout);
    return 0;
}

}  // namespace obscura
