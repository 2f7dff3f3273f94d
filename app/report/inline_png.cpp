#include "app/report/inline_png.h"

#include <cstdint>

#include <fmt/format.h>

#include "lessons/drawing/markup.h"

namespace obscura {

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t byte = i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
            group = group << 8 | byte;
        }
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return out;
}

std::string inline_png(std::string_view png, std::string_view alt) {
    return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\"/>", html_text(alt), base64(png));
}

}  // namespace obscura
