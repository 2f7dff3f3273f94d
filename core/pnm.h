#pragma once
// Portable bit maps and grey maps (Netpbm; https://netpbm.sourceforge.net/doc/pbm.html and pgm.html).

#include <cstdint>
#include <string>
#include <string_view>

#include "core/image.h"
#include "core/image_io.h"

namespace obscura {

/// Codes 0 (black) to `white`; what they mean, the reader of the file decides.
struct GreyCodes {
    Image<std::uint16_t> codes;
    int white = 1;  ///< 1 to 65535
};

/// True when the bytes begin like any file of the family, "P1" to "P7".
bool is_pnm(std::string_view bytes);

/// One picture, plain (P1, P2) or raw (P4, P5), with comments. In a bit map bit 1 is black: code 0. Plain bit
/// maps need no white space between bits. Stricter than most readers: every code is at most `white`, nothing
/// but white space and comments follows plain pixels, nothing at all raw ones. Throws InputError (line in
/// text, or byte offset) and, before anything is allocated, LimitError.
GreyCodes decode_pnm(std::string_view bytes, const std::string& name, const ImageFileLimits& limits = {});

}  // namespace obscura
