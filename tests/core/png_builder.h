#pragma once
// PNG files from raw rows, made without the code under test: CRC bit by bit, zlib with stored blocks only.

#include <algorithm>
#include <cstdint>
#include <string>

namespace obscura {

inline void put_big_endian(std::string& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<char>(value >> shift & 0xff));
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
    std::uint32_t crc = 0xffffffffu;
    for (const char c : type + data) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    std::string out;
    put_big_endian(out, static_cast<std::uint32_t>(data.size()));
    out += type + data;
    put_big_endian(out, ~crc);
    return out;
}

/// RFC 1950 around stored blocks of RFC 1951.
inline std::string zlib_stored(const std::string& raw) {
    std::string out("\x78\x01", 2);
    std::size_t at = 0;
    do {
        const std::size_t size = std::min<std::size_t>(65535, raw.size() - at);
        out.push_back(at + size == raw.size() ? 1 : 0);
        for (const std::size_t word : {size, ~size}) {
            out.push_back(static_cast<char>(word & 0xff));
            out.push_back(static_cast<char>(word >> 8 & 0xff));
        }
        out.append(raw, at, size);
        at += size;
    } while (at < raw.size());
    std::uint32_t a = 1, b = 0;
    for (const char c : raw) {
        a = (a + static_cast<unsigned char>(c)) % 65521;
        b = (b + a) % 65521;
    }
    put_big_endian(out, b << 16 | a);
    return out;
}

inline std::string png_begin(std::uint32_t width, std::uint32_t height, int depth, int type,
                             bool interlaced) {
    std::string header;
    put_big_endian(header, width);
    put_big_endian(header, height);
    header += {static_cast<char>(depth), static_cast<char>(type), 0, 0, static_cast<char>(interlaced)};
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header);
}

inline std::string png_file(int width, int height, int depth, int type, bool interlaced,
                            const std::string& rows) {
    return png_begin(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), depth, type,
                     interlaced) +
           png_chunk("IDAT", zlib_stored(rows)) + png_chunk("IEND", "");
}

}  // namespace obscura
