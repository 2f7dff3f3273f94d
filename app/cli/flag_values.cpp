#include "app/cli/flag_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/scene/aov.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr int largest_side = 1 << 20;

[[noreturn]] void reject(const std::string& flag, std::string_view text, const std::string& expected) {
    throw UsageError(fmt::format("{}: '{}' is not {}", flag, text, expected));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

template <class T>
bool read_whole(std::string_view text, T& value) {
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && stop == end && !text.empty();
}

std::string range_text(const FrameRange& r) {
    if (r.first == r.last) return fmt::format("{}", r.first);
    return r.step == 1 ? fmt::format("{}-{}", r.first, r.last)
                       : fmt::format("{}-{}x{}", r.first, r.last, r.step);
}

}  // namespace

std::int64_t whole_number(const std::string& flag, std::string_view text, std::int64_t low,
                          std::int64_t high) {
    std::int64_t value = 0;
    if (!read_whole(text, value) || value < low || value > high) {
        reject(flag, text, fmt::format("a whole number from {} to {}", low, high));
    }
    return value;
}

double real_number(const std::string& flag, std::string_view text, double low, double high) {
    double value = 0;
    if (!read_whole(text, value) || !std::isfinite(value) || value < low || value > high) {
        reject(flag, text, fmt::format("a number from {} to {}", low, high));
    }
    return value;
}

Size2 size_value(const std::string& flag, std::string_view text) {
    const auto parts = split(text, 'x');
    Size2 size;
    if (parts.size() != 2 || !read_whole(parts[0], size.width) || !read_whole(parts[1], size.height) ||
        size.width < 1 || size.height < 1 || size.width > largest_side || size.height > largest_side) {
        reject(flag, text, "a size in pixels like 960x540");
    }
    return size;
}

Region crop_value(const std::string& flag, std::string_view text, int width, int height) {
    const auto parts = split(text, ',');
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    if (parts.size() != 4 || !read_whole(parts[0], x0) || !read_whole(parts[1], y0) ||
        !read_whole(parts[2], x1) || !read_whole(parts[3], y1)) {
        reject(flag, text, "a rectangle in pixels like 0,0,320,200 (x0,y0,x1,y1; the last two outside)");
    }
    if (x0 < 0 || y0 < 0 || x1 <= x0 || y1 <= y0 || x1 > width || y1 > height) {
        reject(flag, text,
               fmt::format("a rectangle x0 < x1, y0 < y1 inside the {} x {} picture", width, height));
    }
    return {x0, y0, x1 - x0, y1 - y0};
}

PixelPlace pixel_value(const std::string& flag, std::string_view text, int width, int height) {
    const auto parts = split(text, ',');
    PixelPlace p;
    if (parts.size() != 2 || !read_whole(parts[0], p.x) || !read_whole(parts[1], p.y)) {
        reject(flag, text, "a pixel like 10,20 (x,y from the upper left)");
    }
    if (p.x < 0 || p.y < 0 || p.x >= width || p.y >= height) {
        reject(flag, text, fmt::format("inside the {} x {} picture", width, height));
    }
    return p;
}

Isa isa_value(const std::string& flag, std::string_view text) {
    if (text == "auto") return best_isa();
    const std::optional<Isa> isa = parse_isa(text);
    if (!isa) reject(flag, text, "one of auto, ref, sse2, avx2, avx512bw");
    if (!isa_supported(*isa)) {
        throw UsageError(fmt::format("{}: this machine does not run {}; it runs up to {}", flag, text,
                                     isa_name(best_isa())));
    }
    return *isa;
}

std::vector<Aov> aov_values(const std::string& flag, std::string_view text) {
    std::vector<Aov> aovs;
    for (const std::string_view part : split(text, ',')) {
        // Beauty is always written.
        std::vector<std::string> names = names_of(aov_words);
        names.erase(names.begin());
        if (std::find(names.begin(), names.end(), part) == names.end())
            reject(flag, part, "one of depth, normal, albedo, object, shadow, sun_hours" + hint(part, names));
        const Aov aov = value_named(aov_words, part);
        if (std::find(aovs.begin(), aovs.end(), aov) == aovs.end()) aovs.push_back(aov);
    }
    return aovs;
}

std::vector<std::filesystem::path> folder_values(const std::string& flag,
                                                 const std::vector<std::string>& names) {
    std::vector<std::filesystem::path> folders(names.begin(), names.end());
    for (const std::filesystem::path& folder : folders) {
        std::error_code error;
        if (!std::filesystem::is_directory(folder, error))
            throw UsageError(fmt::format("{}: '{}' is no folder", flag, folder.string()));
    }
    return folders;
}

std::vector<int> frame_values(const std::string& flag, std::string_view text, const FrameRange& scene) {
    std::vector<int> frames;
    for (const std::string_view part : split(text, ',')) {
        const std::optional<FrameRange> range = parse_frame_range(part);
        if (!range) reject(flag, part, "a frame or range like 7, 1-48 or 1-48x2");
        const auto judge = [&](int frame) {
            if (scene.contains(frame)) return frame;
            throw UsageError(fmt::format("{}: frame {} is not one of the scene's frames ({})", flag, frame,
                                         range_text(scene)));
        };
        // The end is judged before the range is spelled out: it may name billions of frames.
        judge(range->last - (range->last - range->first) % range->step);
        for (std::int64_t f = range->first; f <= range->last; f += range->step)
            frames.push_back(judge(static_cast<int>(f)));
    }
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

}  // namespace obscura
