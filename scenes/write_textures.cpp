// obscura_textures FOLDER: writes the textures of the scenes as PNG files; FOLDER is scenes/.

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "core/file_output.h"
#include "core/image_io.h"
#include "scenes/patterns.h"
#include "scenes/ridges.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: obscura_textures FOLDER\n");
        return 2;
    }
    try {
        for (const obscura::Pattern& pattern : obscura::patterns()) {
            obscura::write_file_atomically(std::string(argv[1]) + "/" + pattern.file,
                                           obscura::encode_png(pattern.image.view()),
                                           obscura::Existing::replace);
        }
        const auto mountains = obscura::ridges(obscura::mountains_params());
        obscura::write_file_atomically(std::string(argv[1]) + "/textures/ridges.png",
                                       obscura::encode_png(mountains.view()), obscura::Existing::replace);
    } catch (const std::exception& error) {
        fmt::print(stderr, "obscura_textures: {}\n", error.what());
        return 5;
    }
    return 0;
}
