#pragma once
// Apertures from pictures: PNG, PBM and PGM.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/image_io.h"
#include "optics/field/aperture.h"

namespace obscura {

/// How large a mask is; exactly one of the two.
struct ApertureScale {
    std::optional<double> pitch_m;     ///< side of a texel, metres
    std::optional<double> diameter_m;  ///< longer side of the rectangle around all open texels, metres
};

/// True when an argument means a file and no shape: it has a dot or a slash.
bool names_mask_file(std::string_view text);

/// White is open (1), black closed (0), grey the amplitude that passes: code / white, no transfer curve. In
/// bit maps bit 0 is white. PNG may be grey, RGB or palette as long as no pixel has a colour, of 8 or 16
/// bits. A mask that is open throughout is a box. `name` stands in messages. Throws InputError for
/// damaged files, colours, transparency, pixels that are not square, and when nothing is open; LimitError
/// when the picture exceeds `limits`.
Image<float> decode_mask(std::string_view bytes, const std::string& name, const ImageFileLimits& limits);

/// The same of a file, which is found already (see app/models/file_access.h).
Image<float> read_mask(const std::filesystem::path& file, const std::string& name,
                       const ImageFileLimits& limits);

/// What remains when borders that are closed throughout are cut off, in the middle of a square (closed where
/// it is larger than the opening): a mask that spans its pupil. The mask must not be closed.
Image<float> square_opening(ImageView<const float> mask);

/// Throws UsageError unless one scale is given, positive and finite.
Aperture scaled_aperture(Image<float> mask, const ApertureScale& scale);

}  // namespace obscura
