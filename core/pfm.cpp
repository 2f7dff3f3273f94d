// Portable float map: a three-line header, then rows of raw floats from the bottom up.

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <span>

#include "core/error.h"
#include "core/image_io.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little, "PFM rows are copied as they are");
static_assert(sizeof(Vec3f) == 12);

/// Reads the words of the header one by one and knows the line it is on.
struct HeaderReader {
    std::string_view bytes;
    const std::string& name;
    std::size_t position = 0;
    int line = 1;

    [[noreturn]] void fail(const std::string& message) const { throw InputError(name, line, 0, message); }

    /// The next word; exactly one white-space character after it is consumed.
    std::string_view word(const char* what) {
        const std::size_t end = bytes.find_first_of(" \t\r\n", position);
        if (end == std::string_view::npos || end == position || end - position > 40) {
            fail(fmt::format("PFM header: no {} at byte {}", what, position));
        }
        const std::string_view found = bytes.substr(position, end - position);
        if (bytes[end] == '\n') ++line;
        position = end + 1;
        return found;
    }

    template <class T>
    T number(const char* what) {
        const int start_line = line;
        const std::string_view text = word(what);
        T value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size()) {
            throw InputError(name, start_line, 0,
                             fmt::format("PFM header: {} '{}' is not a number", what, text));
        }
        return value;
    }
};

/// Pixels are 1 or 3 floats; the rows come bottom up.
template <class Pixel>
Image<Pixel> read_rows(std::string_view data, int width, int height, bool big_endian) {
    Image<Pixel> image(width, height);
    const std::size_t row_bytes = static_cast<std::size_t>(width) * sizeof(Pixel);
    for (int y = 0; y < height; ++y) {
        std::memcpy(image.row(height - 1 - y), data.data() + static_cast<std::size_t>(y) * row_bytes,
                    row_bytes);
    }
    if (!big_endian) return image;
    auto* words = reinterpret_cast<unsigned char*>(image.pixels.data());
    for (std::size_t i = 0; i < image.pixels.size() * sizeof(Pixel); i += 4) {
        std::swap(words[i], words[i + 3]);
        std::swap(words[i + 1], words[i + 2]);
    }
    return image;
}

/// The unit of the numbers in the file, 1 nearly always.
void scale_by(double magnitude, std::span<float> values) {
    if (magnitude == 1) return;
    for (float& v : values)
        v = static_cast<float>(static_cast<double>(v) * magnitude);
}

FloatImage scaled(Image<float> image, double magnitude) {
    scale_by(magnitude, image.pixels);
    return image;
}

FloatImage scaled(Image<Vec3f> image, double magnitude) {
    for (Vec3f& p : image.pixels) {
        float values[] = {p.x, p.y, p.z};
        scale_by(magnitude, values);
        p = {values[0], values[1], values[2]};
    }
    return image;
}

template <class Pixel>
std::string write_rows(const char* magic, ImageView<const Pixel> image) {
    CHECK(image.width > 0 && image.height > 0, fmt::format("{} x {}", image.width, image.height));
    std::string file = fmt::format("{}\n{} {}\n-1.0\n", magic, image.width, image.height);
    const std::size_t row_bytes = static_cast<std::size_t>(image.width) * sizeof(Pixel);
    file.reserve(file.size() + row_bytes * static_cast<std::size_t>(image.height));
    for (int y = image.height - 1; y >= 0; --y)
        file.append(reinterpret_cast<const char*>(image.row(y)), row_bytes);
    return file;
}

}  // namespace

FloatImage decode_pfm(std::string_view bytes, const std::string& name, const ImageFileLimits& limits) {
    HeaderReader header{bytes, name};
    const std::string_view magic = header.word("magic");
    if (magic != "PF" && magic != "Pf") throw InputError(name, 1, 0, "not a PFM file: expected PF or Pf");
    const bool colour = magic == "PF";
    const auto width = header.number<std::int64_t>("width");
    const auto height = header.number<std::int64_t>("height");
    if (width <= 0 || height <= 0) header.fail(fmt::format("PFM header: size {} x {}", width, height));
    const auto scale = header.number<double>("scale");
    if (!std::isfinite(scale) || scale == 0) header.fail(fmt::format("PFM header: scale {}", scale));

    // The size decides before anything is allocated; both factors are small after the first test.
    if (width > limits.max_side_px || height > limits.max_side_px) {
        throw LimitError(fmt::format("{}: PFM claims {} x {} pixels, the limit is {} a side", name, width,
                                     height, limits.max_side_px));
    }
    const std::int64_t expected = width * height * (colour ? 12 : 4);
    if (expected > limits.max_bytes) {
        throw LimitError(fmt::format("{}: PFM claims {} x {} pixels, {} bytes, the limit is {}{}", name,
                                     width, height, expected, limits.max_bytes, limits.advice));
    }
    const std::string_view data = bytes.substr(header.position);
    if (static_cast<std::int64_t>(data.size()) != expected) {
        throw InputError(
            name, fmt::format("PFM of {} x {} pixels needs {} bytes from byte {} on, the file has {}", width,
                              height, expected, header.position, data.size()));
    }
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    const double magnitude = std::fabs(scale);
    if (colour) return scaled(read_rows<Vec3f>(data, w, h, scale > 0), magnitude);
    return scaled(read_rows<float>(data, w, h, scale > 0), magnitude);
}

std::string encode_pfm(ImageView<const float> image) {
    return write_rows("Pf", image);
}

std::string encode_pfm(ImageView<const Vec3f> image) {
    return write_rows("PF", image);
}

}  // namespace obscura
