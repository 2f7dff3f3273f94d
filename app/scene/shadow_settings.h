#pragma once
// How the shadows of one light are made and filtered.

#include <optional>
#include <string>

#include "app/scene/words.h"
#include "hierarchy/tree_code.h"
#include "raster/intervals.h"

namespace obscura {

/// `map`: a dense shadow map. `compressed`: a multiresolution hierarchy of the same depth intervals. `exact`:
/// of the picture's own samples, without a map (raster/exact). `stack`: an octree of the maps of many points
/// of a light with a size (hierarchy/stack). `day`: far shadows of ground from a file for all suns of a day,
/// near ones by rays (hierarchy/terrain), and exact shadows of all else.
enum class ShadowMethod { none, map, compressed, exact, stack, day };
/// Which part of a compressed map is built: what the frame's lookups ask for, or everything.
enum class ShadowScope { frame, full };
/// `pcf`: a kernel of texels. `hierarchical`: of the squares that are as large as the pixel on the map.
enum class ShadowFilter { pcf, hierarchical };

inline constexpr Word<ShadowMethod> shadow_method_words[] = {
    {"none", ShadowMethod::none},   {"map", ShadowMethod::map},     {"compressed", ShadowMethod::compressed},
    {"exact", ShadowMethod::exact}, {"stack", ShadowMethod::stack}, {"day", ShadowMethod::day}};
inline constexpr Word<ShadowScope> shadow_scope_words[] = {{"frame", ShadowScope::frame},
                                                           {"full", ShadowScope::full}};
inline constexpr Word<ShadowFilter> shadow_filter_words[] = {{"pcf", ShadowFilter::pcf},
                                                             {"hierarchical", ShadowFilter::hierarchical}};
/// "auto", which is no code, and the codes.
struct ShadowCodeWords {
    Word<std::optional<ShadowCode>> all[1 + shadow_code_count] = {{"auto", std::nullopt}};
    constexpr ShadowCodeWords() {
        for (int i = 0; i < shadow_code_count; ++i)
            all[1 + i] = {shadow_code_names[i].name, shadow_code_names[i].code};
    }
};
inline constexpr ShadowCodeWords shadow_code_words;
struct TreeLayoutWords {
    Word<TreeLayout> all[tree_layout_count] = {};
    constexpr TreeLayoutWords() {
        for (int i = 0; i < tree_layout_count; ++i)
            all[i] = {tree_layouts[i].name, tree_layouts[i].layout};
    }
};
inline constexpr TreeLayoutWords tree_layout_words;
inline constexpr Word<Receivers> receivers_words[] = {{"any", Receivers::any},
                                                      {"static", Receivers::static_only}};

/// From how many frames on a tree of all that a light sees pays, when no method is asked for: building the
/// courtyard's takes as long as exact shadows take longer than lookups in so many frames
/// (raster/exact/README.md has the measurements).
constexpr int tree_break_even_frames = 50;

/// How many points of a light with a size are asked: as many as its widest penumbra needs; up to
/// most_auto_samples.
constexpr int auto_samples = 0, most_auto_samples = 256;

constexpr int auto_resolution = 0;
constexpr int least_map_resolution = 16, most_dense_resolution = 16384, most_map_resolution = 1 << 20;
/// Of stacks: what keys may ask for, and what "auto" finds at most, since all of a stack is built.
constexpr int most_stack_resolution = 1 << 16, most_auto_stack_resolution = 1 << 11;
/// Maps of a stack, when nothing is said.
constexpr int stack_samples = 64;
/// From how many frames on a stack pays, of a light that stands somewhere: each point of it has casters of
/// its own, which exact shadows put in order for every frame, and making its map takes about as long.
/// Parallel light, whose points share them, is no slower without (app/frame/README.md has the measurements).
constexpr int stack_break_even_frames = 2;

/// Auto resolution of scene files that say nothing: of a tree that has what one picture looks up, texels that
/// pixels ask one by one, so that their size is not seen. It has fewer nodes than one of texels as large as
/// pixels, and nine tenths of the wrong pixels are gone (hierarchy/limits.md). Pictures of more samples than
/// these would read more squares of the map than are collected; they, filters wider than 3 texels, which are
/// wanted soft, and hierarchical ones keep texels of a pixel.
constexpr double frame_magnification = 1.0 / 32;
constexpr std::int64_t most_fine_samples = std::int64_t{1} << 23;
constexpr std::int64_t most_fine_filter_px = 3;

struct ShadowSettings {
    /// Scene files that name none get one from the rules; see tree_break_even_frames.
    ShadowMethod method = ShadowMethod::compressed;
    /// Texels per side, a power of two from least_map_resolution to most_dense_resolution (map),
    /// most_map_resolution (compressed) or most_stack_resolution; or, but for maps, auto_resolution.
    int resolution = auto_resolution;
    int filter_px = 3;  ///< PCF kernel side in texels, odd: to 5 (map) or 15 (compressed)
    Receivers receivers = Receivers::static_only;
    double normal_offset_texels = 0;  ///< of receivers on open components only
    int samples = auto_samples;       ///< exact, stack: points of a light with a size, 1 or a power of four
    // Compressed; of these stacks have max_magnification and cache.
    ShadowScope scope = ShadowScope::frame;
    ShadowFilter filter = ShadowFilter::pcf;
    double max_magnification = 1.0;  ///< auto: pixels that a texel spans at most, the shorter way
    std::optional<ShadowCode> code = ShadowCode::mh;  ///< none: auto, see chosen_code()
    TreeLayout layout = TreeLayout::words24;          ///< mh only
    int top_levels = 6;                               ///< first levels that are kept as a table, in [0, 10]
    std::string day_file;                             ///< day: what `obscura terrain -o` wrote
    double max_sun_deg = 0.01;  ///< day: between the light and the sun of the file whose shadows it casts
    std::string cache;          ///< folder for finished maps of scope full, and stacks; empty: none
    friend bool operator==(const ShadowSettings&, const ShadowSettings&) = default;
};

/// Whether a light's shadow is made for one picture's lookups, and serves no other.
inline bool is_of_one_picture(const ShadowSettings& shadow) {
    return shadow.method == ShadowMethod::compressed && shadow.scope == ShadowScope::frame;
}

}  // namespace obscura
