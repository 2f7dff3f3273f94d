#include "core/png_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/error.h"

namespace obscura {
namespace {

constexpr std::string_view signature{"\x89PNG\r\n\x1a\n", 8};
constexpr std::size_t chunk_overhead = 12;  // length, type, CRC

constexpr std::array<std::uint32_t, 256> make_crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t n = 0; n < 256; ++n) {
        std::uint32_t c = n;
        for (int bit = 0; bit < 8; ++bit)
            c = (c & 1) ? 0xedb88320u ^ (c >> 1) : c >> 1;
        table[n] = c;
    }
    return table;
}

std::uint32_t big_endian(std::string_view four) {
    std::uint32_t value = 0;
    for (const char c : four)
        value = value << 8 | static_cast<unsigned char>(c);
    return value;
}

void append_big_endian(std::string& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<char>(value >> shift & 0xff));
}

struct Chunk {
    std::string_view type, data;
    std::size_t offset = 0;  ///< of the length field
};

/// The chunk that starts at `offset`, complete and with a matching CRC.
Chunk read_chunk(std::string_view bytes, std::size_t offset, const std::string& name) {
    const std::size_t left = bytes.size() - offset;
    if (left < chunk_overhead) {
        throw InputError(name,
                         fmt::format("truncated PNG: the file ends at byte {} before IEND", bytes.size()));
    }
    const std::uint32_t length = big_endian(bytes.substr(offset, 4));
    const std::string_view type = bytes.substr(offset + 4, 4);
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    if (!std::all_of(type.begin(), type.end(), is_letter)) {
        throw InputError(name, fmt::format("no PNG chunk at byte {}: its type is not four letters", offset));
    }
    if (length > left - chunk_overhead) {
        throw InputError(
            name, fmt::format("truncated PNG: chunk {} at byte {} claims {} bytes, the file ends at byte {}",
                              type, offset, length, bytes.size()));
    }
    const std::uint32_t stored = big_endian(bytes.substr(offset + 8 + length, 4));
    const std::uint32_t actual = png_crc(bytes.substr(offset + 4, 4 + length));
    if (stored != actual) {
        throw InputError(name, fmt::format("PNG chunk {} at byte {} is damaged: CRC {:08x}, expected {:08x}",
                                           type, offset, actual, stored));
    }
    return {type, bytes.substr(offset + 8, length), offset};
}

/// Depths that a colour type may have, one bit per depth (table 11.1).
int allowed_depths(int colour_type) {
    switch (colour_type) {
        case 0:
            return 1 | 2 | 4 | 8 | 16;
        case 3:
            return 1 | 2 | 4 | 8;
        case 2:
        case 4:
        case 6:
            return 8 | 16;
        default:
            return 0;
    }
}

int samples_per_pixel(int colour_type) {
    constexpr int samples[7] = {1, 0, 3, 1, 2, 0, 4};
    return samples[colour_type];
}

PngHeader read_header(const Chunk& chunk, const std::string& name) {
    if (chunk.type != "IHDR" || chunk.data.size() != 13) {
        throw InputError(name, fmt::format("PNG chunk {} at byte {}: expected IHDR of 13 bytes", chunk.type,
                                           chunk.offset));
    }
    const auto byte = [&](std::size_t i) {
        return static_cast<int>(static_cast<unsigned char>(chunk.data[i]));
    };
    PngHeader h{big_endian(chunk.data.substr(0, 4)), big_endian(chunk.data.substr(4, 4)), byte(8), byte(9),
                byte(12) == 1};
    const bool power_of_two = h.bit_depth > 0 && (h.bit_depth & (h.bit_depth - 1)) == 0;
    if (!power_of_two || !(allowed_depths(h.colour_type) & h.bit_depth)) {
        throw InputError(name, fmt::format("PNG chunk IHDR at byte {}: no colour type {} with {} bits",
                                           chunk.offset, h.colour_type, h.bit_depth));
    }
    if (byte(10) != 0 || byte(11) != 0 || byte(12) > 1) {
        throw InputError(
            name, fmt::format("PNG chunk IHDR at byte {}: unknown compression {}, filter {} or interlace {}",
                              chunk.offset, byte(10), byte(11), byte(12)));
    }
    if (h.width == 0 || h.height == 0) {
        throw InputError(
            name, fmt::format("PNG chunk IHDR at byte {}: size {} x {}", chunk.offset, h.width, h.height));
    }
    return h;
}

void check_limits(const PngHeader& h, const std::string& name, const ImageFileLimits& limits,
                  std::int64_t pixel_bytes) {
    if (std::max(h.width, h.height) > limits.max_side_px) {
        throw LimitError(fmt::format("{}: PNG claims {} x {} pixels, the limit is {} a side", name, h.width,
                                     h.height, limits.max_side_px));
    }
    const std::int64_t decoded = pixel_bytes * h.width * h.height;
    const std::int64_t most = std::min<std::int64_t>(limits.max_bytes, std::numeric_limits<int>::max());
    if (std::max(decoded, png_raw_size(h)) > most) {
        throw LimitError(fmt::format("{}: PNG claims {} x {} pixels, {} bytes decoded, the limit is {}{}",
                                     name, h.width, h.height, std::max(decoded, png_raw_size(h)), most,
                                     limits.advice));
    }
}

void read_density(const Chunk& chunk, const std::string& name, PngFile& file) {
    if (chunk.data.size() != 9) {
        throw InputError(name, fmt::format("PNG chunk pHYs at byte {}: {} bytes instead of 9", chunk.offset,
                                           chunk.data.size()));
    }
    file.density_x = big_endian(chunk.data.substr(0, 4));
    file.density_y = big_endian(chunk.data.substr(4, 4));
}

bool is_critical(const Chunk& chunk) {
    return chunk.type[0] <= 'Z';
}

}  // namespace

std::uint32_t png_crc(std::string_view bytes) {
    static constexpr std::array<std::uint32_t, 256> table = make_crc_table();
    std::uint32_t c = 0xffffffffu;
    for (const char byte : bytes)
        c = table[(c ^ static_cast<unsigned char>(byte)) & 0xff] ^ (c >> 8);
    return c ^ 0xffffffffu;
}

bool is_png(std::string_view bytes) {
    return bytes.substr(0, signature.size()) == signature;
}

std::int64_t png_raw_size(const PngHeader& h) {
    // Seven passes of Adam7 (clause 8.2), or one pass over everything.
    struct Pass {
        std::int64_t x0, y0, dx, dy;
    };
    constexpr Pass adam7[7] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                               {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    constexpr Pass all{0, 0, 1, 1};
    const std::int64_t bits_per_pixel = std::int64_t{h.bit_depth} * samples_per_pixel(h.colour_type);
    std::int64_t bytes = 0;
    for (int i = 0; i < (h.interlaced ? 7 : 1); ++i) {
        const Pass& pass = h.interlaced ? adam7[i] : all;
        const std::int64_t columns = (h.width - pass.x0 + pass.dx - 1) / pass.dx;
        const std::int64_t rows = (h.height - pass.y0 + pass.dy - 1) / pass.dy;
        if (columns > 0 && rows > 0) bytes += rows * (1 + (columns * bits_per_pixel + 7) / 8);
    }
    return bytes;
}

PngFile walk_png(std::string_view bytes, const std::string& name, const ImageFileLimits& limits,
                 std::int64_t pixel_bytes) {
    if (!is_png(bytes)) throw InputError(name, "not a PNG file: wrong signature at byte 0");
    PngFile file;
    Chunk chunk = read_chunk(bytes, signature.size(), name);
    file.header = read_header(chunk, name);
    check_limits(file.header, name, limits, pixel_bytes);

    bool pixels_ended = false;
    while (chunk.type != "IEND") {
        const bool was_pixels = chunk.type == "IDAT";
        chunk = read_chunk(bytes, chunk.offset + chunk_overhead + chunk.data.size(), name);
        if (chunk.type == "IDAT") {
            if (pixels_ended) {
                throw InputError(
                    name, fmt::format("PNG chunk IDAT at byte {} is apart from the others", chunk.offset));
            }
            file.pixel_stream.append(chunk.data);
            continue;
        }
        pixels_ended = pixels_ended || was_pixels;
        if (chunk.type == "pHYs") read_density(chunk, name, file);
        if (is_critical(chunk) && chunk.type != "PLTE" && chunk.type != "IEND") {
            throw InputError(
                name, fmt::format("PNG chunk {} at byte {} is not understood", chunk.type, chunk.offset));
        }
    }
    const std::size_t end = chunk.offset + chunk_overhead + chunk.data.size();
    if (end != bytes.size()) {
        throw InputError(
            name, fmt::format("{} bytes follow the end of the PNG at byte {}", bytes.size() - end, end));
    }
    if (file.pixel_stream.empty()) throw InputError(name, "PNG without pixels: no IDAT chunk");
    return file;
}

std::string begin_png(const PngHeader& h) {
    std::string header;
    append_big_endian(header, h.width);
    append_big_endian(header, h.height);
    header.push_back(static_cast<char>(h.bit_depth));
    header.push_back(static_cast<char>(h.colour_type));
    header.append(3, '\0');  // deflate, the five filters, not interlaced
    std::string file{signature};
    append_png_chunk(file, "IHDR", header);
    return file;
}

void append_png_chunk(std::string& file, std::string_view type, std::string_view data) {
    append_big_endian(file, static_cast<std::uint32_t>(data.size()));
    const std::size_t start = file.size();
    file.append(type).append(data);
    append_big_endian(file, png_crc(std::string_view{file}.substr(start)));
}

}  // namespace obscura
