#pragma once
// Panels of lesson 19: the light's grid with samples, casters and their boxes on it, one triangle against one
// bunch, and how far samples lie from the planes that could darken them.

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/types.h"
#include "lessons/drawing/figure.h"
#include "raster/exact/exact_shadow.h"

namespace obscura {

/// A part of the light's view, in texels of a map with the same axes.
struct MapWindow {
    Box box;
    double x0 = 0, y0 = 0, texels = 1;  ///< upper left corner; across
    double px() const { return box.w / texels; }
    Vec2d at(Vec2d texel) const { return {box.x + (texel.x - x0) * px(), box.y + (texel.y - y0) * px()}; }
    bool holds(Vec2d texel, double margin_px = 0) const;
};

/// From the grid of exact shadows to the texels of `map`, a view of the same light: they differ by a stretch
/// and a shift along each axis.
struct GridOnMap {
    double stretch_x = 1, stretch_y = 1, shift_x = 0, shift_y = 0;
    Vec2d at(std::int32_t x, std::int32_t y) const {
        return {stretch_x * x + shift_x, stretch_y * y + shift_y};
    }
};

/// What exact shadows of one picture were, ready to be drawn and asked.
struct SampledPicture {
    const ExactLight& light;
    const ExactView& view;
    const ExactPoints points;
    const ExactSamples& samples;
    std::span<const std::uint32_t> order;
    const std::vector<std::uint32_t>& lit;
    GridOnMap on_map;

    Vec2d place(std::uint32_t sample) const { return on_map.at(samples.x[sample], samples.y[sample]); }
    bool is_lit(std::uint32_t sample) const {
        const std::uint32_t i = samples.point[sample];
        return (lit[i / 16] >> (i % 16) & 1u) != 0;
    }
    std::size_t bunches() const { return order.size() / 16; }
    std::span<const std::uint32_t> bunch(std::size_t i) const { return order.subspan(16 * i, 16); }
};

/// Of the last call of `work`; `map` is a view of the same light. All must outlive it.
SampledPicture exact_picture(const ExactLight& light, const ExactPoints& points, const ExactWork& work,
                             const std::vector<std::uint32_t>& lit, const LightView& map);

constexpr Rgb8 lit_color = ink::orange, dark_color = ink::blue;
constexpr Rgb8 rounding_color = ink::purple, snapping_color = ink::yellow;

/// Samples as dots, lit or dark. With `grid`: the texels between them, and the place where each is sampled.
void draw_samples(Figure& f, const SampledPicture& picture, const MapWindow& window, double dot_px,
                  bool grid);

/// Bunches of sixteen samples, each in one colour and joined in their order; over them triangles, and the
/// boxes of sixteen of them that are smaller than the window and reach into it.
void draw_sixteens(Figure& f, const SampledPicture& picture, const MapWindow& window);

/// How many samples fall into each of a map's texels.
Image<int> samples_per_texel(const SampledPicture& picture, int texels);

/// Whether the sample is inside edge k, inside all; and its height over the plane, metres, below 0 behind it.
bool inside_edge(const CasterTriangle& t, int k, const SampledPicture& picture, std::uint32_t sample);
bool covered_by(const CasterTriangle& t, const SampledPicture& picture, std::uint32_t sample);
double height_over(const CasterTriangle& t, const SampledPicture& picture, std::uint32_t sample);

/// A triangle and a bunch that lies on both sides of each of its edges, and not far beyond them.
struct TellingPair {
    std::size_t triangle = 0, bunch = 0;
    int covered = 0;  ///< of the sixteen
};
TellingPair telling_pair(const SampledPicture& picture);
void draw_pair(Figure& f, const SampledPicture& picture, const TellingPair& pair, const Box& box);

/// From least to most.
struct ErrorRange {
    double low = 1e9, high = 0;
    void add(double v) {
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
};

/// How many samples lie how far from the planes of triangles, of other faces, that cover them.
struct PlaneDistances {
    static constexpr int decades = 9, bins = 2 * decades;  ///< two to a power of ten, from 1e-8 m on
    int before[bins] = {}, same[bins] = {},
        behind[bins] = {};          ///< same: behind, but by too little to be dark
    ErrorRange rounding, snapping;  ///< of samples: what one depth may mean, and 1/256 pixel
    double nearest_dark = 1e9;      ///< least distance behind a plane of those that it darkens
    double farthest_same = 0;       ///< most distance behind a plane of those that are too near to be dark
};
PlaneDistances plane_distances(const SampledPicture& picture);
void draw_distances(Figure& f, const PlaneDistances& distances, const Box& box);

}  // namespace obscura
