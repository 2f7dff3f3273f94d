#pragma once
// Image files: PNG (8-bit sRGB in and out, 16-bit codes in, 16-bit grey out) and PFM (linear float).
// Everything is decoded from and encoded to memory; file_output.h writes the bytes.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "core/image.h"
#include "core/pixel.h"
#include "core/vec.h"

namespace obscura {

/// Checked against what the file claims, before anything is allocated.
struct ImageFileLimits {
    std::int64_t max_side_px = 16384;
    std::int64_t max_bytes = std::int64_t{1} << 30;  ///< decoded, and of each buffer on the way
    std::string_view advice = {};  ///< follows that number in messages, like " (--limit raises it)"
};

/// PNG of any colour type, depth and interlacing as 8-bit RGBA (16-bit samples keep their upper byte).
/// `name` stands in messages. Stricter than most readers: every chunk lies inside the file with a matching
/// CRC, the pixel stream inflates to exactly the size that the header claims, nothing follows IEND. Throws
/// InputError with the chunk and byte offset, LimitError with the claimed size.
Image<Rgba8> decode_png(std::string_view bytes, const std::string& name, const ImageFileLimits& limits = {});

/// The same with 16-bit channels: samples of fewer bits are spread over all codes (255 of 255 is 65535).
Image<Rgba16> decode_png16(std::string_view bytes, const std::string& name,
                           const ImageFileLimits& limits = {});

/// Whether a PNG file says in front that its samples have 16 bits, which decode_png() would cut.
bool has_16_bit_samples(std::string_view bytes);

/// PNG files with an sRGB chunk (RGB, RGBA) or linear 16-bit samples (grey, with gAMA 1.0). The same pixels
/// give the same bytes everywhere. Throws LimitError when the raw pixels exceed 2^31 - 1 bytes.
std::string encode_png(ImageView<const Rgb8> image);
std::string encode_png(ImageView<const Rgba8> image);
std::string encode_png(ImageView<const std::uint16_t> image);

/// One or three channels of linear floats.
using FloatImage = std::variant<Image<float>, Image<Vec3f>>;

/// PFM, "Pf" or "PF" (P. Debevec; http://www.pauldebevec.com/Research/HDR/PFM/), rows bottom up in the file,
/// top down here. Both byte orders; values are multiplied by the magnitude of the scale, which is the unit of
/// the file's numbers. Throws InputError (line in the header, or byte offset) and LimitError.
FloatImage decode_pfm(std::string_view bytes, const std::string& name, const ImageFileLimits& limits = {});

/// Little-endian PFM with scale -1.
std::string encode_pfm(ImageView<const float> image);
std::string encode_pfm(ImageView<const Vec3f> image);

/// True when the bytes begin like a PNG.
bool is_png(std::string_view bytes);

}  // namespace obscura
