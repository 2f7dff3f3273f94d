// ESRI ASCII grids (ArcGIS documentation, "Esri ASCII raster format").

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "app/elevation/raw_grid.h"
#include "core/error.h"

namespace obscura {
namespace {

/// Words, and the lines they stand on.
class Words {
  public:
    Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    [[noreturn]] void fail(const std::string& message) const { throw InputError(name_, line_, 0, message); }

    /// Empty at the end of the file.
    std::string_view next() {
        while (at_ < text_.size() && is_space(text_[at_]))
            line_ += text_[at_++] == '\n' ? 1 : 0;
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_space(text_[at_]))
            ++at_;
        return text_.substr(begin, at_ - begin);
    }

    double number(const std::string& what) {
        const std::string_view word = next();
        if (word.empty()) fail(fmt::format("the file ends before {}", what));
        return number_of(word, what);
    }

    double number_of(std::string_view word, const std::string& what) const {
        double value = 0;
        const char* begin = word.data() + (word[0] == '+' && word.size() > 1 ? 1 : 0);
        const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
            fail(fmt::format("{}: '{}' is not a number", what, word.substr(0, 40)));
        return value;
    }

  private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
    int line_ = 1;
};

std::string lower_case(std::string_view word) {
    std::string out(word);
    for (char& c : out)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    return out;
}

/// The keys in front; the first word that is none is the first height.
struct Header {
    std::map<std::string, double> keys;
    std::string_view first_value;

    bool has(const char* key) const { return keys.contains(key); }
    double at(const char* key, const Words& words) const {
        const auto found = keys.find(key);
        if (found == keys.end()) words.fail(fmt::format("the header has no {}", key));
        return found->second;
    }
};

Header read_header(Words& words) {
    static constexpr const char* known[] = {"ncols",     "nrows",       "xllcorner", "xllcenter",
                                            "yllcorner", "yllcenter",   "cellsize",  "dx",
                                            "dy",        "nodata_value"};
    Header header;
    while (true) {
        const std::string_view word = words.next();
        const bool letter =
            !word.empty() && ((word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z'));
        if (!letter) {
            header.first_value = word;
            return header;
        }
        const std::string key = lower_case(word);
        if (std::find(std::begin(known), std::end(known), key) == std::end(known))
            words.fail(fmt::format("'{}' is no key of an ESRI ASCII grid", word.substr(0, 40)));
        if (!header.keys.emplace(key, words.number(key)).second)
            words.fail(fmt::format("{} is said twice", key));
    }
}

/// The format has no unit. A grid that fits on the globe in degrees, with cells below one, may be in them;
/// one that begins beyond the globe is in metres.
void set_unit_of_cells(const Header& header, const Words& words, std::int64_t width, std::int64_t height,
                       RawGrid& grid) {
    const auto corner = [&](const char* corner_key, const char* centre_key) -> std::optional<double> {
        if (header.has(corner_key)) return header.at(corner_key, words);
        if (header.has(centre_key)) return header.at(centre_key, words);
        return {};
    };
    const std::optional<double> x = corner("xllcorner", "xllcenter"), y = corner("yllcorner", "yllcenter");
    if (!x || !y) return;
    // Longitudes count from -180 or from 0.
    constexpr double slack = 1;
    const auto on_globe = [](double east, double north) {
        return east >= -180 - slack && east <= 360 + slack && std::fabs(north) <= 90 + slack;
    };
    grid.metres = !on_globe(*x, *y);
    grid.degrees = *grid.cell_x < 1 && *grid.cell_y < 1 && on_globe(*x, *y) &&
                   on_globe(*x + static_cast<double>(width) * *grid.cell_x,
                            *y + static_cast<double>(height) * *grid.cell_y);
}

std::int64_t whole(double value, const char* key, const Words& words) {
    if (value != std::floor(value) || value < 1 || value > 1e9)
        words.fail(fmt::format("{} is {}, not a number of samples", key, value));
    return static_cast<std::int64_t>(value);
}

}  // namespace

RawGrid read_esri_grid(std::string_view bytes, const std::string& name, const ElevationOptions& options) {
    Words words(bytes, name);
    const Header header = read_header(words);
    const std::int64_t width = whole(header.at("ncols", words), "ncols", words);
    const std::int64_t height = whole(header.at("nrows", words), "nrows", words);
    check_grid_size(width, height, name, options);
    // A height is a digit and a blank at least, so the file's length bounds what it can hold.
    if (static_cast<std::int64_t>(bytes.size()) < 2 * width * height - 1)
        words.fail(fmt::format("{} by {} heights do not fit into {} bytes", width, height, bytes.size()));

    RawGrid grid;
    grid.z_step_m = 1;
    grid.cell_x = header.has("dx") ? header.at("dx", words) : header.at("cellsize", words);
    grid.cell_y = header.has("dy") ? header.at("dy", words) : header.at("cellsize", words);
    set_unit_of_cells(header, words, width, height, grid);

    // The format's default.
    const double hole = header.has("nodata_value") ? header.at("nodata_value", words) : -9999;
    grid.values = Image<double>(static_cast<int>(width), static_cast<int>(height));
    std::string_view word = header.first_value;
    for (std::size_t i = 0; i < grid.values.pixels.size(); ++i) {
        if (word.empty()) {
            words.fail(fmt::format("the file ends after {} of {} heights", i, grid.values.pixels.size()));
        }
        const double value = words.number_of(word, "a height");
        grid.values.pixels[i] = value == hole ? no_height : value;
        word = words.next();
    }
    if (!word.empty()) words.fail("more follows the last height");
    return grid;
}

}  // namespace obscura
