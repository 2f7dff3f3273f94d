#pragma once
// The chunk layer of PNG (ISO/IEC 15948:2004): everything around the compressed pixels.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/image_io.h"

namespace obscura {

struct PngHeader {
    std::uint32_t width = 0, height = 0;
    int bit_depth = 8;    ///< per sample: 1, 2, 4, 8 or 16
    int colour_type = 2;  ///< 0 grey, 2 RGB, 3 palette, 4 grey + alpha, 6 RGBA
    bool interlaced = false;
};

struct PngFile {
    PngHeader header;
    std::string pixel_stream;  ///< the IDAT chunks joined: a zlib stream of filtered rows
    /// Pixels per unit of length as chunk pHYs has them; square when there is none.
    std::uint32_t density_x = 1, density_y = 1;
};

/// Walks all chunks: signature, lengths, CRCs, order, header values, limits, IEND at the very end.
/// Throws InputError with chunk and byte offset, LimitError with the claimed size, of pixels that take
/// `pixel_bytes` when decoded.
PngFile walk_png(std::string_view bytes, const std::string& name, const ImageFileLimits& limits,
                 std::int64_t pixel_bytes = 4);

/// Bytes that the pixel stream inflates to: filtered rows of all passes.
std::int64_t png_raw_size(const PngHeader& header);

/// Signature and IHDR of a file that is not interlaced.
std::string begin_png(const PngHeader& header);
/// `type` has four letters.
void append_png_chunk(std::string& file, std::string_view type, std::string_view data);

/// CRC-32 of ISO 3309 as PNG uses it (annex D).
std::uint32_t png_crc(std::string_view bytes);

}  // namespace obscura
