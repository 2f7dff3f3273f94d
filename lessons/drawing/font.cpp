#include "lessons/drawing/font.h"

#include <algorithm>
#include <cstddef>

#include "core/error.h"

namespace obscura {
namespace {

/// A glyph is written like moves on a chessboard: a digit is x, a letter is y ('e' is the baseline, 'm' the
/// top of lower case, 'q' the top of capitals). A space lifts the pen; '~' marks the control point of a
/// quadratic curve from the point before it to the point after it.
struct Glyph {
    char32_t code;
    int width;
    const char* moves;
};

constexpr Glyph glyphs[] = {
    {U'A', 8, "0e4q8e 1h7h"},
    {U'B', 7, "0e0q3q~6q6n~6k3k0k 3k~7k7h~7e3e0e"},
    {U'C', 8, "8n~7q4q~0q0k~0e4e~7e8h"},
    {U'D', 8, "0e0q3q~8q8k~8e3e0e"},
    {U'E', 6, "6q0q0e6e 0k5k"},
    {U'F', 6, "6q0q0e 0k5k"},
    {U'G', 8, "8n~7q4q~0q0k~0e4e~8e8h8j5j"},
    {U'H', 7, "0e0q 7e7q 0k7k"},
    {U'I', 0, "0e0q"},
    {U'J', 5, "5q5h~5e2e~0e0h"},
    {U'K', 7, "0e0q 7q0i 3l7e"},
    {U'L', 6, "0q0e6e"},
    {U'M', 8, "0e0q4h8q8e"},
    {U'N', 7, "0e0q7e7q"},
    {U'O', 8, "4q~0q0k~0e4e~8e8k~8q4q"},
    {U'P', 7, "0e0q3q~7q7n~7k3k0k"},
    {U'Q', 8, "4q~0q0k~0e4e~8e8k~8q4q 5h8d"},
    {U'R', 7, "0e0q3q~7q7n~7k3k0k 3k7e"},
    {U'S', 6, "6o~6q3q~0q0n~0k3k~6k6h~6e3e~0e0g"},
    {U'T', 8, "0q8q 4q4e"},
    {U'U', 7, "0q0h~0e3e4e~7e7h7q"},
    {U'V', 8, "0q4e8q"},
    {U'W', 8, "0q2e4n6e8q"},
    {U'X', 7, "0e7q 0q7e"},
    {U'Y', 8, "0q4k8q 4k4e"},
    {U'Z', 7, "0q7q0e7e"},
    {U'a', 6, "6m6e 6j~6m3m~0m0i~0e3e~6e6h"},
    {U'b', 6, "0q0e 0j~0m3m~6m6i~6e3e~0e0h"},
    {U'c', 6, "6k~5m3m~0m0i~0e3e~5e6g"},
    {U'd', 6, "6q6e 6j~6m3m~0m0i~0e3e~6e6h"},
    {U'e', 6, "0i6i~6m3m~0m0i~0e3e~5e6g"},
    {U'f', 4, "4q~1q1n1e 0m4m"},
    {U'g', 6, "6m6d~6a3a~1a0b 6j~6m3m~0m0i~0e3e~6e6h"},
    {U'h', 6, "0q0e 0j~0m3m~6m6j6e"},
    {U'i', 0, "0e0m 0p"},
    {U'j', 2, "2m2c~2a0a 2p"},
    {U'k', 5, "0q0e 5m0h 2j5e"},
    {U'l', 2, "0q0g~0e2e"},
    {U'm', 8, "0m0e 0k~0m2m~4m4k4e 4k~4m6m~8m8k8e"},
    {U'n', 6, "0m0e 0j~0m3m~6m6j6e"},
    {U'o', 6, "3m~0m0i~0e3e~6e6i~6m3m"},
    {U'p', 6, "0m0a 0j~0m3m~6m6i~6e3e~0e0h"},
    {U'q', 6, "6m6a 6j~6m3m~0m0i~0e3e~6e6h"},
    {U'r', 4, "0m0e 0i~0m4m"},
    {U's', 5, "5l~4m3m~0m0k~0i3i~5i5g~5e2e~1e0f"},
    {U't', 4, "1p1g~1e3e4e 0m4m"},
    {U'u', 6, "0m0h~0e3e~6e6h 6m6e"},
    {U'v', 6, "0m3e6m"},
    {U'w', 8, "0m2e4l6e8m"},
    {U'x', 5, "0e5m 0m5e"},
    {U'y', 6, "0m3e 6m3e2c~1a0a"},
    {U'z', 5, "0m5m0e5e"},
    {U'0', 6, "3q~0q0k~0e3e~6e6k~6q3q"},
    {U'1', 6, "1n4q4e"},
    {U'2', 6, "0n~0q3q~6q6n~6k0e6e"},
    {U'3', 6, "0o~1q3q~6q6n~6k3k2k 3k~6k6h~6e3e~0e0g"},
    {U'4', 6, "5e5q0h6h"},
    {U'5', 6, "6q1q0k~1m3m~6m6i~6e3e~1e0g"},
    {U'6', 6, "5q~0n0i~0e3e~6e6i~6m3m~0m0i"},
    {U'7', 6, "0q6q2e"},
    {U'8', 6, "3k~0k0n~0q3q~6q6n~6k3k~0k0h~0e3e~6e6h~6k3k"},
    {U'9', 6, "1e~6h6m~6q3q~0q0m~0i3i~6i6m"},
    {U'.', 0, "0e"},
    {U',', 1, "1e0c"},
    {U':', 0, "0e 0l"},
    {U';', 1, "1e0c 1l"},
    {U'-', 4, "0i4i"},
    {U'+', 6, "0i6i 3f3l"},
    {U'=', 6, "0g6g 0k6k"},
    {U'(', 3, "3r~0o0j~0e3b"},
    {U')', 3, "0r~3o3j~3e0b"},
    {U'[', 2, "2r0r0b2b"},
    {U']', 2, "0r2r2b0b"},
    {U'/', 5, "0c5r"},
    {U'<', 6, "6l0i6f"},
    {U'>', 6, "0l6i0f"},
    {U'!', 0, "0q0h 0e"},
    {U'?', 5, "0n~0q3q~5q5n~5l2j2h 2e"},
    {U'\'', 0, "0q0n"},
    {U'"', 2, "0q0n 2q2n"},
    {U'*', 4, "2q2k 0p4l 4p0l"},
    {U'_', 6, "0d6d"},
    {U'#', 7, "1e3q 4e6q 0i6i 1m7m"},
    {U'%', 8, "1e7q 1q~0q0o~0m1m~2m2o~2q1q 7i~6i6g~6e7e~8e8g~8i7i"},
    {U'|', 0, "0r0b"},
    {U'·', 0, "0j"},
    {U'×', 5, "0f5k 0k5f"},
    {U'−', 6, "0i6i"},
    {U'~', 6, "0i~1l3j~5h6k"},
    {U'±', 6, "0j6j 3g3m 0e6e"},
    {U'≥', 6, "0n6k0h 0e6e"},
    {U'≤', 6, "6n0k6h 0e6e"},
    {U'²', 4, "0o~0q2q~4q4o~4n0k4k"},
    {U'ε', 5, "5l~4m3m~0m0k~0i3i 3i~0i0g~0e3e~4e5f"},
    {U'λ', 6, "0q~1q2o6e 3k0e"},
    {U'π', 7, "0k~0m2m7m 2m~2h1e 5m5g~5e7e"},
    {U'→', 9, "0i9i 6l9i6f"},
};

constexpr double gap = 3.0, space = 6.0;

const Glyph& glyph_of(char32_t code) {
    const auto* found =
        std::find_if(std::begin(glyphs), std::end(glyphs), [&](const Glyph& g) { return g.code == code; });
    CHECK(found != std::end(glyphs), "no glyph for code point " + std::to_string(std::uint32_t{code}));
    return *found;
}

/// Code points of well-formed UTF-8 (our own string literals).
std::u32string decode(std::string_view utf8) {
    std::u32string text;
    for (const char c : utf8) {
        const auto byte = static_cast<unsigned char>(c);
        if ((byte & 0xc0u) == 0x80u) {
            text.back() = (text.back() << 6) | (byte & 0x3fu);
        } else {
            text.push_back(byte < 0x80u ? byte : (byte < 0xe0u ? byte & 0x1fu : byte & 0x0fu));
        }
    }
    return text;
}

void add_strokes(const Glyph& glyph, double x, std::vector<std::vector<Vec2d>>& strokes) {
    constexpr int curve_steps = 8;
    const char* c = glyph.moves;
    const auto point = [&] {
        const Vec2d p{x + (c[0] - '0'), static_cast<double>(c[1] - 'e')};
        c += 2;
        return p;
    };
    strokes.push_back({point()});
    while (*c != '\0') {
        if (*c == ' ') {
            ++c;
            strokes.push_back({point()});
        } else if (*c == '~') {
            ++c;
            const Vec2d from = strokes.back().back(), control = point(), to = point();
            for (int i = 1; i <= curve_steps; ++i) {
                const double t = static_cast<double>(i) / curve_steps, s = 1 - t;
                strokes.back().push_back(from * (s * s) + control * (2 * s * t) + to * (t * t));
            }
        } else {
            strokes.back().push_back(point());
        }
    }
}

}  // namespace

TextStrokes text_strokes(std::string_view utf8) {
    TextStrokes text;
    for (const char32_t code : decode(utf8)) {
        if (code == U' ') {
            text.width += space;
            continue;
        }
        const Glyph& glyph = glyph_of(code);
        add_strokes(glyph, text.width + 0.5 * gap, text.strokes);
        text.width += glyph.width + gap;
    }
    return text;
}

}  // namespace obscura
