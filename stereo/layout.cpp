// Layouts of a stereo pair; see layout.h.
//
// Anaglyphs mix light, so all matrices act on linear light and the sRGB curve comes after. Optimised one: E.
// Dubois, "A Projection Method to Generate Anaglyph Stereo Images", ICASSP 2001: the anaglyph
// whose spectra, seen through either filter, are nearest in the least-squares sense to those of the two
// pictures. The spectra of phosphors add up in linear light, so that is what its matrix assumes; many
// programs apply it to gamma-coded values. The entries are those of the paper's red-cyan filters and CRT
// phosphors (as W. Sanders and D. McAllister, "Producing Anaglyphs from Synthetic Images", SPIE 5006, 2003,
// compute them; our test does so again), each row scaled so that two white pictures give white.
// What falls out of [0, 1] is clipped.

#include "stereo/layout.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"

namespace obscura {
namespace {

constexpr std::array<std::pair<StereoLayout, std::string_view>, 12> names{{
    {StereoLayout::side_by_side, "side-by-side"},
    {StereoLayout::half_side_by_side, "half-side-by-side"},
    {StereoLayout::cross_eye, "cross-eye"},
    {StereoLayout::over_under, "over-under"},
    {StereoLayout::half_over_under, "half-over-under"},
    {StereoLayout::anaglyph, "anaglyph"},
    {StereoLayout::anaglyph_half, "anaglyph-half"},
    {StereoLayout::anaglyph_dubois, "anaglyph-dubois"},
    {StereoLayout::interlaced, "interlaced"},
    {StereoLayout::left, "left"},
    {StereoLayout::right, "right"},
    {StereoLayout::separate, "separate"},
}};

using Picture = Image<Vec3f>;

void paste(const Picture& from, Picture& to, int x0, int y0) {
    for (int y = 0; y < from.height; ++y)
        std::copy_n(from.row(y), from.width, to.row(y0 + y) + x0);
}

Picture beside(const Picture& a, const Picture& b) {
    Picture out(a.width + b.width, a.height);
    paste(a, out, 0, 0);
    paste(b, out, a.width, 0);
    return out;
}

Picture above(const Picture& a, const Picture& b) {
    Picture out(a.width, a.height + b.height);
    paste(a, out, 0, 0);
    paste(b, out, 0, a.height);
    return out;
}

/// Calls term(out, in, weight) for each output of a row of `size` samples resampled to `out_size` <= size by
/// an exact box: output i is the mean over [i, i + 1) * size / out_size. Weights of an output sum to 1.
template <class Term>
void box_terms(int size, int out_size, Term&& term) {
    for (int i = 0; i < out_size; ++i) {
        // In units of 1 / out_size of a sample, whole numbers: sample k covers [k, k + 1) * out_size.
        const std::int64_t begin = std::int64_t{i} * size, end = begin + size;
        for (std::int64_t k = begin / out_size; k * out_size < end; ++k) {
            const std::int64_t part = std::min((k + 1) * out_size, end) - std::max(k * out_size, begin);
            term(i, static_cast<int>(k), static_cast<double>(part) / size);
        }
    }
}

struct Sum {
    double x = 0, y = 0, z = 0;
    void add(const Vec3f& v, double weight) {
        x += weight * static_cast<double>(v.x);
        y += weight * static_cast<double>(v.y);
        z += weight * static_cast<double>(v.z);
    }
};

Picture narrowed(const Picture& in, int width) {
    Picture out(width, in.height);
    std::vector<Sum> sums(static_cast<std::size_t>(width));
    for (int y = 0; y < in.height; ++y) {
        std::fill(sums.begin(), sums.end(), Sum{});
        box_terms(in.width, width,
                  [&](int o, int i, double w) { sums[static_cast<std::size_t>(o)].add(in(i, y), w); });
        for (int x = 0; x < width; ++x) {
            const Sum& s = sums[static_cast<std::size_t>(x)];
            out(x, y) = to_float({s.x, s.y, s.z});
        }
    }
    return out;
}

Picture flattened(const Picture& in, int height) {
    Picture out(in.width, height);
    std::vector<Sum> sums(out.pixels.size());
    box_terms(in.height, height, [&](int o, int i, double w) {
        Sum* row = sums.data() + static_cast<std::ptrdiff_t>(o) * in.width;
        for (int x = 0; x < in.width; ++x)
            row[x].add(in(x, i), w);
    });
    for (std::size_t i = 0; i < sums.size(); ++i)
        out.pixels[i] = to_float({sums[i].x, sums[i].y, sums[i].z});
    return out;
}

template <class Mix>
Picture mixed(const Picture& left, const Picture& right, Mix&& mix) {
    Picture out(left.width, left.height);
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = mix(left.pixels[i], right.pixels[i]);
    return out;
}

/// Luminance of Rec. 709 primaries.
float luminance(const Vec3f& c) {
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

float dubois_row(const std::array<double, 6>& m, const Vec3d& l, const Vec3d& r) {
    const double sum = (m[0] * l.x + m[1] * l.y + m[2] * l.z) + (m[3] * r.x + m[4] * r.y + m[5] * r.z);
    return static_cast<float>(std::clamp(sum, 0.0, 1.0));
}

Vec3f dubois(const Vec3f& left, const Vec3f& right) {
    const Vec3d l = to_double(left), r = to_double(right);
    return {dubois_row(dubois_matrix[0], l, r), dubois_row(dubois_matrix[1], l, r),
            dubois_row(dubois_matrix[2], l, r)};
}

}  // namespace

std::optional<StereoLayout> parse_layout(std::string_view text) {
    for (const auto& [layout, name] : names)
        if (name == text) return layout;
    return std::nullopt;
}

std::string_view layout_name(StereoLayout layout) {
    return names[static_cast<std::size_t>(layout)].second;
}

std::vector<std::string_view> layout_names() {
    std::vector<std::string_view> all;
    all.reserve(names.size());
    for (const auto& [layout, name] : names)
        all.push_back(name);
    return all;
}

Image<Vec3f> lay_out(const Image<Vec3f>& left, const Image<Vec3f>& right, StereoLayout layout) {
    CHECK(left.width == right.width && left.height == right.height && left.width > 0 && left.height > 0);
    const int w = left.width, h = left.height;
    switch (layout) {
        case StereoLayout::side_by_side:
            return beside(left, right);
        case StereoLayout::cross_eye:
            return beside(right, left);
        case StereoLayout::half_side_by_side:
            if (w == 1) return left;
            return beside(narrowed(left, (w + 1) / 2), narrowed(right, w / 2));
        case StereoLayout::over_under:
            return above(left, right);
        case StereoLayout::half_over_under:
            if (h == 1) return left;
            return above(flattened(left, (h + 1) / 2), flattened(right, h / 2));
        case StereoLayout::anaglyph:
            return mixed(left, right, [](const Vec3f& l, const Vec3f& r) { return Vec3f{l.x, r.y, r.z}; });
        case StereoLayout::anaglyph_half:
            return mixed(left, right, [](const Vec3f& l, const Vec3f& r) {
                return Vec3f{luminance(l), r.y, r.z};
            });
        case StereoLayout::anaglyph_dubois:
            return mixed(left, right, dubois);
        case StereoLayout::interlaced: {
            Picture out = left;
            for (int y = 1; y < h; y += 2)
                std::copy_n(right.row(y), w, out.row(y));
            return out;
        }
        case StereoLayout::left:
            return left;
        case StereoLayout::right:
            return right;
        case StereoLayout::separate:
            break;
    }
    CHECK(layout != StereoLayout::separate, "two files are no one picture");
    return {};
}

}  // namespace obscura
