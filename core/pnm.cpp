#include "core/pnm.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace obscura {
namespace {

constexpr int largest_white = 65535;

bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Reads words and knows the line it is on. A comment runs from # to the end of its line.
struct TextReader {
    std::string_view bytes;
    const std::string& name;
    std::size_t position = 2;
    int line = 1;

    [[noreturn]] void fail(const std::string& message) const { throw InputError(name, line, 0, message); }

    bool at_end() const { return position >= bytes.size(); }

    void skip_space() {
        for (bool comment = false; !at_end(); ++position) {
            const char c = bytes[position];
            if (c == '\n' || c == '\r') comment = false;
            if (c == '#') comment = true;
            if (!comment && !is_space(c)) return;
            if (c == '\n') ++line;
        }
    }

    /// The next digits; numbers beyond a thousand million all read as one that no limit allows.
    std::int64_t number(const char* what) {
        skip_space();
        if (at_end()) fail(fmt::format("truncated: the file ends at byte {} before the {}", position, what));
        if (!is_digit(bytes[position])) fail(fmt::format("byte {}: the {} is not a number", position, what));
        std::int64_t value = 0;
        for (; !at_end() && is_digit(bytes[position]); ++position)
            value = std::min<std::int64_t>(1'000'000'000'000, value * 10 + (bytes[position] - '0'));
        return value;
    }

    /// The next 0 or 1, whatever follows it.
    bool bit() {
        skip_space();
        if (at_end())
            fail(fmt::format("truncated: the file ends at byte {} before the last pixel", position));
        const char c = bytes[position];
        if (c != '0' && c != '1') fail(fmt::format("byte {}: a bit is neither 0 nor 1", position));
        ++position;
        return c == '1';
    }

    void expect_end() {
        skip_space();
        if (!at_end()) fail(fmt::format("byte {}: more follows the last pixel", position));
    }
};

struct Header {
    bool bits = false, raw = false;
    int width = 0, height = 0, white = 1;
};

Header read_header(TextReader& text, const ImageFileLimits& limits) {
    const char kind = text.bytes.size() < 2 || text.bytes[0] != 'P' ? ' ' : text.bytes[1];
    if (kind == '3' || kind == '6')
        text.fail(
            fmt::format("P{} is a colour picture; a grey one is wanted (P2, P5) or bits (P1, P4)", kind));
    if (kind != '1' && kind != '2' && kind != '4' && kind != '5')
        text.fail("not a PBM or PGM file: expected P1, P2, P4 or P5");
    Header header;
    header.bits = kind == '1' || kind == '4';
    header.raw = kind >= '4';
    if (!text.at_end() && !is_space(text.bytes[2]) && text.bytes[2] != '#')
        text.fail(fmt::format("no white space after P{}", kind));
    const std::int64_t width = text.number("width"), height = text.number("height");
    if (width == 0 || height == 0) text.fail(fmt::format("size {} x {}: there are no pixels", width, height));
    // The size decides before anything is allocated; both factors are small after the first test.
    if (width > limits.max_side_px || height > limits.max_side_px) {
        throw LimitError(fmt::format("{}: claims {} x {} pixels, the limit is {} a side", text.name, width,
                                     height, limits.max_side_px));
    }
    const std::int64_t decoded = width * height * std::int64_t{sizeof(std::uint16_t)};
    if (decoded > limits.max_bytes) {
        throw LimitError(fmt::format("{}: claims {} x {} pixels, {} bytes, the limit is {}{}", text.name,
                                     width, height, decoded, limits.max_bytes, limits.advice));
    }
    header.width = static_cast<int>(width);
    header.height = static_cast<int>(height);
    if (header.bits) return header;
    const std::int64_t white = text.number("largest value");
    if (white < 1 || white > largest_white)
        text.fail(fmt::format("largest value {} is not from 1 to {}", white, largest_white));
    header.white = static_cast<int>(white);
    return header;
}

GreyCodes read_plain(const Header& header, TextReader& text) {
    // Every pixel takes a byte at least: a short file cannot make us allocate for a long one.
    const std::size_t pixels =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
    if (text.bytes.size() - text.position < pixels) {
        throw InputError(text.name, fmt::format("truncated: {} x {} pixels do not fit into {} bytes",
                                                header.width, header.height, text.bytes.size()));
    }
    GreyCodes image{Image<std::uint16_t>(header.width, header.height), header.white};
    for (std::uint16_t& code : image.codes.pixels) {
        if (header.bits) {
            code = text.bit() ? 0 : 1;
            continue;
        }
        const std::int64_t value = text.number("pixel");
        if (value > header.white)
            text.fail(fmt::format("byte {}: pixel {} above the largest value, {}", text.position, value,
                                  header.white));
        code = static_cast<std::uint16_t>(value);
        if (!text.at_end() && !is_space(text.bytes[text.position]) && text.bytes[text.position] != '#')
            text.fail(fmt::format("byte {}: a pixel is not a number", text.position));
    }
    text.expect_end();
    return image;
}

/// Rows of whole bytes: bits from the highest on, or codes of one byte, or of two, the high one first.
GreyCodes read_raw(const Header& header, TextReader& text) {
    if (text.at_end() || !is_space(text.bytes[text.position]))
        text.fail(fmt::format("byte {}: one white space must follow the header", text.position));
    const std::size_t first = text.position + 1;
    const auto width = static_cast<std::size_t>(header.width),
               height = static_cast<std::size_t>(header.height);
    const std::size_t pixel_bytes = header.white > 255 ? 2 : 1;
    const std::size_t row_bytes = header.bits ? (width + 7) / 8 : width * pixel_bytes;
    if (text.bytes.size() - first != row_bytes * height) {
        throw InputError(text.name,
                         fmt::format("{} x {} pixels need {} bytes from byte {} on, the file has {}", width,
                                     height, row_bytes * height, first, text.bytes.size() - first));
    }
    GreyCodes image{Image<std::uint16_t>(header.width, header.height), header.white};
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t at = first + y * row_bytes + (header.bits ? x / 8 : x * pixel_bytes);
            int code = static_cast<unsigned char>(text.bytes[at]);
            if (header.bits) code = (code >> (7 - x % 8) & 1) == 1 ? 0 : 1;
            if (pixel_bytes == 2) code = code << 8 | static_cast<unsigned char>(text.bytes[at + 1]);
            if (code > header.white) {
                throw InputError(text.name, fmt::format("byte {}: pixel {} above the largest value, {}", at,
                                                        code, header.white));
            }
            image.codes.pixels[y * width + x] = static_cast<std::uint16_t>(code);
        }
    }
    return image;
}

}  // namespace

bool is_pnm(std::string_view bytes) {
    return bytes.size() >= 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7';
}

GreyCodes decode_pnm(std::string_view bytes, const std::string& name, const ImageFileLimits& limits) {
    TextReader text{bytes, name};
    const Header header = read_header(text, limits);
    return header.raw ? read_raw(header, text) : read_plain(header, text);
}

}  // namespace obscura
