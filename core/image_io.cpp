// PNG pixels: stb inflates, deflates and unfilters; the chunk layer around it is png_container.
// stb ignores CRCs, grows its inflate buffer with whatever the stream says and writes files without checking;
// hence the order of the checks in decode_png(), and no file access here.

#include "core/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/png_container.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_NO_SIMD
#define STBI_MAX_DIMENSIONS (1 << 20)
#include <stb/stb_image.h>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace obscura {
namespace {

struct Free {
    void operator()(void* p) const { std::free(p); }
};
using StbBytes = std::unique_ptr<unsigned char, Free>;

/// Throws unless the pixel stream inflates to exactly the bytes that the header implies.
void check_pixel_stream(const PngFile& file, const std::string& name) {
    const auto expected = static_cast<std::size_t>(png_raw_size(file.header));
    std::vector<char> raw(expected);
    const int length =
        stbi_zlib_decode_buffer(raw.data(), static_cast<int>(expected), file.pixel_stream.data(),
                                static_cast<int>(file.pixel_stream.size()));
    if (length != static_cast<int>(expected)) {
        const std::string found = length < 0 ? "is damaged or longer" : fmt::format("has {}", length);
        throw InputError(name, fmt::format("PNG chunk IDAT: expected {} bytes of pixel rows, the stream {}",
                                           expected, found));
    }
}

/// One filtered row (clause 9.2): the type byte, then the bytes; `before` is the row above, `step` the bytes
/// per pixel. Returns the sum of absolute differences, small when the row will compress well.
long filter_row(int type, const unsigned char* row, const unsigned char* before, int count, int step,
                unsigned char* out) {
    long sum = 0;
    out[0] = static_cast<unsigned char>(type);
    for (int i = 0; i < count; ++i) {
        const int left = i >= step ? row[i - step] : 0;
        const int up = before ? before[i] : 0;
        const int corner = before && i >= step ? before[i - step] : 0;
        int guess = 0;
        switch (type) {
            case 1:
                guess = left;
                break;
            case 2:
                guess = up;
                break;
            case 3:
                guess = (left + up) / 2;
                break;
            case 4: {  // Paeth: whichever neighbour is nearest to left + up - corner
                const int a = std::abs(up - corner), b = std::abs(left - corner),
                          c = std::abs(left + up - 2 * corner);
                guess = a <= b && a <= c ? left : (b <= c ? up : corner);
                break;
            }
            default:
                break;
        }
        const auto difference = static_cast<unsigned char>(row[i] - guess);
        out[i + 1] = difference;
        sum += std::abs(static_cast<signed char>(difference));
    }
    return sum;
}

/// A whole file from rows of big-endian samples; `extra` are the chunks between IHDR and IDAT.
/// row(y) returns the bytes of row y, valid until the next call but one.
template <class Row>
std::string assemble_png(const PngHeader& header, int bytes_per_pixel, const std::string& extra, Row row) {
    const std::int64_t raw_size = png_raw_size(header);
    if (raw_size > std::numeric_limits<int>::max()) {
        throw LimitError(fmt::format(
            "a picture of {} x {} pixels does not fit in one PNG: {} bytes of rows, the limit is {}",
            header.width, header.height, raw_size, std::numeric_limits<int>::max()));
    }

    // Each row gets the filter with the smallest sum of absolute differences (clause 12.8).
    const int count = static_cast<int>(header.width) * bytes_per_pixel;
    std::vector<unsigned char> raw(static_cast<std::size_t>(raw_size));
    std::vector<unsigned char> trial(static_cast<std::size_t>(count) + 1);
    const unsigned char* before = nullptr;
    for (std::uint32_t y = 0; y < header.height; ++y) {
        const unsigned char* current = row(static_cast<int>(y));
        unsigned char* out = raw.data() + static_cast<std::size_t>(y) * trial.size();
        long best = filter_row(0, current, before, count, bytes_per_pixel, out);
        for (int type = 1; type <= 4; ++type) {
            const long sum = filter_row(type, current, before, count, bytes_per_pixel, trial.data());
            if (sum >= best) continue;
            best = sum;
            std::copy(trial.begin(), trial.end(), out);
        }
        before = current;
    }

    int length = 0;
    const StbBytes packed{stbi_zlib_compress(raw.data(), static_cast<int>(raw_size), &length, 8)};
    if (!packed) throw LimitError("out of memory while compressing a PNG");
    std::string file = begin_png(header);
    file += extra;
    append_png_chunk(file, "IDAT",
                     {reinterpret_cast<const char*>(packed.get()), static_cast<std::size_t>(length)});
    append_png_chunk(file, "IEND", {});
    return file;
}

PngHeader header_for(int width, int height, int bit_depth, int colour_type) {
    CHECK(width > 0 && height > 0, fmt::format("{} x {}", width, height));
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), bit_depth, colour_type,
            false};
}

/// The chunk that calls the samples sRGB (clause 11.3.3.5), perceptual intent.
std::string srgb_chunk() {
    std::string chunk;
    append_png_chunk(chunk, "sRGB", std::string_view{"\0", 1});
    return chunk;
}

/// Four channels of every pixel by stb's `load`, which has been handed nothing that it could trip over.
template <class Pixel, class Load>
Image<Pixel> decode_as(std::string_view bytes, const std::string& name, const ImageFileLimits& limits,
                       Load load) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw LimitError(fmt::format("{}: a PNG file of {} bytes, the limit is {}", name, bytes.size(),
                                     std::numeric_limits<int>::max()));
    }
    const PngFile file = walk_png(bytes, name, limits, sizeof(Pixel));
    check_pixel_stream(file, name);

    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<void, Free> decoded{load(reinterpret_cast<const unsigned char*>(bytes.data()),
                                                   static_cast<int>(bytes.size()), &width, &height, &channels,
                                                   4)};
    if (!decoded) throw InputError(name, fmt::format("PNG cannot be decoded: {}", stbi_failure_reason()));
    CHECK(static_cast<std::uint32_t>(width) == file.header.width &&
          static_cast<std::uint32_t>(height) == file.header.height);
    Image<Pixel> image(width, height);
    std::memcpy(image.pixels.data(), decoded.get(), image.pixels.size() * sizeof(Pixel));
    return image;
}
static_assert(sizeof(Rgba8) == 4 && sizeof(Rgba16) == 8);

}  // namespace

Image<Rgba8> decode_png(std::string_view bytes, const std::string& name, const ImageFileLimits& limits) {
    return decode_as<Rgba8>(bytes, name, limits, stbi_load_from_memory);
}

Image<Rgba16> decode_png16(std::string_view bytes, const std::string& name, const ImageFileLimits& limits) {
    return decode_as<Rgba16>(bytes, name, limits, stbi_load_16_from_memory);
}

bool has_16_bit_samples(std::string_view bytes) {
    constexpr std::size_t bit_depth = 24;  // behind signature, length and type of IHDR, width and height
    return is_png(bytes) && bytes.size() > bit_depth && bytes[bit_depth] == 16;
}

std::string encode_png(ImageView<const Rgb8> image) {
    static_assert(sizeof(Rgb8) == 3);
    return assemble_png(header_for(image.width, image.height, 8, 2), 3, srgb_chunk(),
                        [&](int y) { return reinterpret_cast<const unsigned char*>(image.row(y)); });
}

std::string encode_png(ImageView<const Rgba8> image) {
    return assemble_png(header_for(image.width, image.height, 8, 6), 4, srgb_chunk(),
                        [&](int y) { return reinterpret_cast<const unsigned char*>(image.row(y)); });
}

std::string encode_png(ImageView<const std::uint16_t> image) {
    std::string linear;
    append_png_chunk(linear, "gAMA", std::string_view{"\x00\x01\x86\xa0", 4});  // 100000: gamma 1

    // Samples are big-endian: two rows by turns, since a filter looks at the row above.
    std::vector<unsigned char> rows[2];
    return assemble_png(header_for(image.width, image.height, 16, 0), 2, linear, [&](int y) {
        std::vector<unsigned char>& out = rows[y & 1];
        out.clear();
        for (int x = 0; x < image.width; ++x) {
            out.push_back(static_cast<unsigned char>(image(x, y) >> 8));
            out.push_back(static_cast<unsigned char>(image(x, y) & 0xff));
        }
        return static_cast<const unsigned char*>(out.data());
    });
}

}  // namespace obscura
