// GeoTIFF (OGC 19-008r4, "OGC GeoTIFF Standard", 2019; GDAL's tag 42113 for samples without a height), by
// libtiff.

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "app/elevation/raw_grid.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr std::uint32_t pixel_scale_tag = 33550, tie_points_tag = 33922, transformation_tag = 34264,
                        geo_keys_tag = 34735, nodata_tag = 42113;
// Keys of the geo key directory, and what they say.
constexpr int model_type_key = 1024, angular_unit_key = 2054, linear_unit_key = 3076,
              vertical_unit_key = 4099;
constexpr int projected = 1, geographic = 2, metre = 9001, foot = 9002, us_foot = 9003, degree = 9102;

/// A file in memory, as libtiff reads it, and the first thing that it found wrong.
struct Source {
    std::string_view bytes;
    std::uint64_t at = 0;
    std::string error;

    static tmsize_t read(thandle_t handle, void* to, tmsize_t count) {
        auto& s = *static_cast<Source*>(handle);
        const std::uint64_t left = s.at < s.bytes.size() ? s.bytes.size() - s.at : 0;
        const std::uint64_t n =
            std::min<std::uint64_t>(left, count > 0 ? static_cast<std::uint64_t>(count) : 0);
        if (n > 0) std::memcpy(to, s.bytes.data() + s.at, n);
        s.at += n;
        return static_cast<tmsize_t>(n);
    }
    static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
    static toff_t seek(thandle_t handle, toff_t offset, int whence) {
        auto& s = *static_cast<Source*>(handle);
        s.at = whence == SEEK_CUR ? s.at + offset : whence == SEEK_END ? s.bytes.size() + offset : offset;
        return s.at;
    }
    static int close(thandle_t) { return 0; }
    static toff_t size(thandle_t handle) { return static_cast<Source*>(handle)->bytes.size(); }
    static int map(thandle_t, void**, toff_t*) { return 0; }
    static void unmap(thandle_t, void*, toff_t) {}

    static int keep_error(TIFF*, void* user, const char*, const char* format, va_list values) {
        auto& s = *static_cast<Source*>(user);
        if (!s.error.empty()) return 1;
        char text[200];
        std::vsnprintf(text, sizeof text, format, values);
        s.error = text;
        for (char& c : s.error)
            c = c >= ' ' && c <= '~' ? c : '?';
        return 1;
    }
    static int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }
};

struct Closer {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

/// One file. Everything is asked of its first picture; others are overviews of it.
class Reader {
  public:
    Reader(std::string_view bytes, const std::string& name, const ElevationOptions& options)
        : name_(name), options_(options) {
        source_.bytes = bytes;
        TIFFOpenOptions* how = TIFFOpenOptionsAlloc();
        TIFFOpenOptionsSetErrorHandlerExtR(how, Source::keep_error, &source_);
        TIFFOpenOptionsSetWarningHandlerExtR(how, Source::ignore, nullptr);
        TIFFOpenOptionsSetMaxSingleMemAlloc(how, static_cast<tmsize_t>(options.max_bytes));
        tiff_.reset(TIFFClientOpenExt(name.c_str(), "rm", &source_, Source::read, Source::write, Source::seek,
                                      Source::close, Source::size, Source::map, Source::unmap, how));
        TIFFOpenOptionsFree(how);
        if (!tiff_) fail("is no TIFF that can be read");
    }

    RawGrid read() {
        take_layout();
        RawGrid grid;
        take_place(grid);
        grid.values = Image<double>(static_cast<int>(width_), static_cast<int>(height_));
        std::fill(grid.values.pixels.begin(), grid.values.pixels.end(), no_height);
        if (TIFFIsTiled(tiff_.get()) != 0) {
            read_tiles(grid.values);
        } else {
            read_strips(grid.values);
        }
        clear_holes(grid.values);
        return grid;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(name_, source_.error.empty() ? message : message + ": " + source_.error);
    }

    template <class T>
    T field(std::uint32_t tag, T otherwise) const {
        T value{};
        return TIFFGetFieldDefaulted(tiff_.get(), tag, &value) == 1 ? value : otherwise;
    }

    /// Values of a tag that libtiff does not know, of the type that it has to have; none where it is not
    /// there.
    template <class T>
    std::vector<T> values(std::uint32_t tag, TIFFDataType type) const {
        const TIFFField* known = TIFFFindField(tiff_.get(), tag, TIFF_ANY);
        std::uint32_t count = 0;
        const T* data = nullptr;
        if (known == nullptr || TIFFFieldPassCount(known) == 0) return {};
        if (TIFFFieldReadCount(known) != TIFF_VARIABLE2) return {};
        if (TIFFGetField(tiff_.get(), tag, &count, &data) != 1 || data == nullptr) return {};
        if (TIFFFieldDataType(known) != type) fail(fmt::format("has a tag {} of another type", tag));
        return std::vector<T>(data, data + count);
    }

    void take_layout() {
        width_ = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
        height_ = field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
        bits_ = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 0);
        format_ = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
        check_grid_size(width_, height_, name_, options_, bits_ / 8);
        const auto bands = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
        if (bands != 1) fail(fmt::format("has {} bands: heights are one", bands));
        const auto photometric = field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        if (photometric != PHOTOMETRIC_MINISBLACK)
            fail(
                fmt::format("has samples that mean colours (photometric {}): heights are grey", photometric));
        const bool is_float = format_ == SAMPLEFORMAT_IEEEFP;
        const bool known = format_ == SAMPLEFORMAT_UINT || format_ == SAMPLEFORMAT_INT || is_float;
        if (!known || !(is_float ? bits_ == 32 || bits_ == 64 : bits_ == 16 || bits_ == 32)) {
            fail(fmt::format("has samples of {} bits, format {}: heights have 16 or 32 bits, or are floats",
                             bits_, format_));
        }
        const auto code = field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
        constexpr std::uint16_t codes[] = {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
                                           COMPRESSION_DEFLATE, COMPRESSION_PACKBITS};
        if (std::find(std::begin(codes), std::end(codes), code) == std::end(codes) ||
            TIFFIsCODECConfigured(code) == 0)
            fail(fmt::format("is compressed by method {}: none, LZW, deflate and PackBits are read", code));
        if (field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) != ORIENTATION_TOPLEFT)
            fail("does not begin in the north-west (orientation)");
    }

    /// The value of a geo key that stands in the directory itself; 0 where it is not there.
    static int geo_key(const std::vector<std::uint16_t>& keys, int key) {
        for (std::size_t i = 4; i + 3 < keys.size(); i += 4)
            if (keys[i] == key && keys[i + 1] == 0) return keys[i + 3];
        return 0;
    }

    double unit_m(int unit, const char* of) const {
        if (unit == 0 || unit == metre) return 1;
        if (unit == foot) return 0.3048;
        if (unit == us_foot) return 1200.0 / 3937;
        fail(fmt::format("has {} in unit {}: metres and feet are read", of, unit));
    }

    /// Cells, their unit, and that of heights.
    void take_place(RawGrid& grid) {
        const std::vector<std::uint16_t> keys = values<std::uint16_t>(geo_keys_tag, TIFF_SHORT);
        grid.z_step_m = unit_m(geo_key(keys, vertical_unit_key), "heights");
        std::optional<double> north;  // of the picture's upper edge
        take_cells(grid, north);
        if (!grid.cell_x) return;
        for (const double cell : {*grid.cell_x, *grid.cell_y}) {
            if (!std::isfinite(cell) || cell <= 0) fail(fmt::format("has cells of {}", cell));
        }
        const int model = geo_key(keys, model_type_key);
        if (model == projected) {
            const double unit = unit_m(geo_key(keys, linear_unit_key), "cells");
            *grid.cell_x *= unit;
            *grid.cell_y *= unit;
            grid.metres = true;
        } else if (model == geographic) {
            const int unit = geo_key(keys, angular_unit_key);
            if (unit != 0 && unit != degree)
                fail(fmt::format("has cells in unit {}: degrees are read", unit));
            grid.degrees = true;
            if (north) grid.latitude_deg = *north - 0.5 * height_ * *grid.cell_y;
            if (grid.latitude_deg && !(std::fabs(*grid.latitude_deg) <= 90))
                fail(fmt::format("lies at a latitude of {}", *grid.latitude_deg));
        } else {
            // It does not say. Degrees are taken for such where they can be, as in ESRI's grids.
            grid.degrees = *grid.cell_x < 1 && *grid.cell_y < 1;
        }
    }

    void take_cells(RawGrid& grid, std::optional<double>& north) {
        const std::vector<double> scale = values<double>(pixel_scale_tag, TIFF_DOUBLE);
        const std::vector<double> tie = values<double>(tie_points_tag, TIFF_DOUBLE);
        const std::vector<double> map = values<double>(transformation_tag, TIFF_DOUBLE);
        if (scale.size() >= 2) {
            grid.cell_x = scale[0];
            grid.cell_y = scale[1];
            if (tie.size() >= 6) north = tie[4] + tie[1] * scale[1];
        } else if (map.size() >= 16) {
            if (map[1] != 0 || map[4] != 0)
                fail("is turned against the north: its rows do not run from west to east");
            if (map[5] > 0) fail("has its first row in the south");
            grid.cell_x = map[0];
            grid.cell_y = -map[5];
            north = map[7];
        }
    }

    void read_strips(Image<double>& to) {
        const std::uint32_t rows = std::min(field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, height_), height_);
        if (rows == 0) fail("has strips of no rows");
        const std::uint32_t strips = TIFFNumberOfStrips(tiff_.get());
        std::vector<std::uint8_t> part(std::size_t{rows} * width_ * (bits_ / 8u));
        for (std::uint32_t strip = 0; std::uint64_t{strip} * rows < height_; ++strip) {
            if (strip >= strips) fail(fmt::format("ends before its row {}", std::uint64_t{strip} * rows));
            const std::uint32_t y0 = strip * rows, count = std::min(rows, height_ - y0);
            // What GDAL leaves out has no heights.
            if (TIFFGetStrileByteCount(tiff_.get(), strip) == 0) continue;
            const auto bytes = static_cast<tmsize_t>(std::size_t{count} * width_ * (bits_ / 8u));
            if (TIFFReadEncodedStrip(tiff_.get(), strip, part.data(), bytes) != bytes)
                fail(fmt::format("cannot be decoded from row {} on", y0));
            put(part, width_, 0, y0, width_, count, to);
        }
    }

    void read_tiles(Image<double>& to) {
        const auto side_x = field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0),
                   side_y = field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
        constexpr std::uint32_t most = 1 << 14;
        if (side_x == 0 || side_y == 0 || side_x > most || side_y > most)
            fail(fmt::format("has tiles of {} x {}: a side has 1 to {} samples", side_x, side_y, most));
        const std::size_t bytes = std::size_t{side_x} * side_y * (bits_ / 8u);
        if (static_cast<std::int64_t>(bytes) > options_.max_bytes)
            throw LimitError(fmt::format("{}: a tile takes {} MiB, more than {} MiB{}", name_, bytes >> 20,
                                         options_.max_bytes >> 20, options_.advice));
        std::vector<std::uint8_t> part(bytes);
        for (std::uint32_t y = 0; y < height_; y += side_y) {
            for (std::uint32_t x = 0; x < width_; x += side_x) {
                const std::uint32_t tile = TIFFComputeTile(tiff_.get(), x, y, 0, 0);
                if (tile >= TIFFNumberOfTiles(tiff_.get())) fail("has fewer tiles than its size asks for");
                if (TIFFGetStrileByteCount(tiff_.get(), tile) == 0) continue;
                if (TIFFReadEncodedTile(tiff_.get(), tile, part.data(), static_cast<tmsize_t>(bytes)) !=
                    static_cast<tmsize_t>(bytes))
                    fail(fmt::format("cannot be decoded at column {}, row {}", x, y));
                put(part, side_x, x, y, std::min(side_x, width_ - x), std::min(side_y, height_ - y), to);
            }
        }
    }

    template <class T>
    static double number_at(const std::uint8_t* at) {
        T value;
        std::memcpy(&value, at, sizeof value);
        return static_cast<double>(value);
    }

    double sample(const std::uint8_t* at) const {
        if (format_ == SAMPLEFORMAT_IEEEFP) return bits_ == 32 ? number_at<float>(at) : number_at<double>(at);
        if (format_ == SAMPLEFORMAT_INT)
            return bits_ == 16 ? number_at<std::int16_t>(at) : number_at<std::int32_t>(at);
        return bits_ == 16 ? number_at<std::uint16_t>(at) : number_at<std::uint32_t>(at);
    }

    /// Rows of `stride` samples, of which the first width x height go to (x0, y0).
    void put(const std::vector<std::uint8_t>& part, std::uint32_t stride, std::uint32_t x0, std::uint32_t y0,
             std::uint32_t width, std::uint32_t height, Image<double>& to) const {
        const std::size_t size = bits_ / 8u;
        for (std::uint32_t y = 0; y < height; ++y) {
            const std::uint8_t* from = part.data() + std::size_t{y} * stride * size;
            for (std::uint32_t x = 0; x < width; ++x)
                to(static_cast<int>(x0 + x), static_cast<int>(y0 + y)) = sample(from + x * size);
        }
    }

    /// The value that GDAL declares for samples without a height; NaN is always one.
    void clear_holes(Image<double>& samples) const {
        const std::vector<char> letters = values<char>(nodata_tag, TIFF_ASCII);
        std::string_view text(letters.data(), letters.size());
        text = text.substr(0, text.find('\0'));
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
        text = text.substr(0, text.find_last_not_of(' ') + 1);
        if (text.empty()) return;
        double hole = 0;
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), end, hole);
        if (error != std::errc{} || rest != end)
            fail(fmt::format("declares samples without a height by '{}', which is no number",
                             text.substr(0, 40)));
        if (bits_ == 32 && format_ == SAMPLEFORMAT_IEEEFP)
            hole = static_cast<double>(static_cast<float>(hole));
        for (double& v : samples.pixels)
            v = v == hole ? no_height : v;
    }

    const std::string& name_;
    const ElevationOptions& options_;
    Source source_;
    std::unique_ptr<TIFF, Closer> tiff_;
    std::uint32_t width_ = 0, height_ = 0;
    std::uint16_t bits_ = 0, format_ = 0;
};

}  // namespace

RawGrid read_geotiff_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options) {
    return Reader(bytes, name, options).read();
}

}  // namespace obscura
