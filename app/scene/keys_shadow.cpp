// Keys of shadows.

#include "app/scene/build.h"
#include "app/scene/key_row.h"
#include "app/scene/keys.h"

namespace obscura {

KeySpec shadow_cache_key() {
    return file_key(
               "cache",
               "Compressed with scope \"full\", and stack: folder, relative to the scene file, in which "
               "finished maps are kept, one file LIGHT.shadowtree or LIGHT.shadowstack per light. It is made "
               "when it is not there.")
        .as_folder();
}

namespace {

/// Without method = "compressed" the rules keep its keys out; with it they supply what is not given.
const KeyRows<ShadowSettings>& shadow_rows() {
    static const KeyRows<ShadowSettings> rows{
        word_row_if_given(
            &ShadowSettings::method, shadow_method_words, "method",
            "none: the light passes through everything. exact: what casts shadows is rasterized onto the "
            "picture's own samples; no texels, no filter, edges as sharp as the samples. map: a dense map. "
            "compressed: a tree of depth intervals, which gives a map's shadows at resolutions far beyond. "
            "stack: for a light with a size, an octree of the maps of many of its points, built once for all "
            "frames in which the light stands still. day: of a light far away, whose suns `obscura terrain` "
            "has made far shadows of ground for; rays of a few samples add near ones, and all that is not "
            "that ground casts exact shadows, hard ones all: those of the light's middle. When not given: "
            "day where day_file is given; compressed where a key that only maps have is given, or where the "
            "light has no keyframes and there are 50 frames or more, which is when a tree pays; else exact. "
            "`obscura check` tells which, and why."),
        count_or_word_row(
            &ShadowSettings::resolution, "auto", auto_resolution,
            integer_key(
                "resolution",
                "Maps: texels per side, at most 16384 with method \"map\", whose default is 4096, and 65536 "
                "with \"stack\"; points use six maps. \"auto\", the default otherwise: the smallest that the "
                "picture needs, at most 2048 with \"stack\". The map of a parallel light covers the whole "
                "scene; `obscura check` tells the size "
                "of a texel.")
                .one_of({16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 65536, 131072,
                         262144, 524288, 1048576})),
        key_row_if_given(&ShadowSettings::filter_px,
                         integer_key("filter_px",
                                     "Maps: side of the percentage-closer filter, in texels; with method "
                                     "\"map\" 1, 3 or 5. 3 when not given.")
                             .one_of({1, 3, 5, 7, 9, 11, 13, 15})),
        key_row_if_given(
            &ShadowSettings::normal_offset_texels,
            number_key("normal_offset_texels",
                       "Maps: moves receivers on open surfaces towards the light; only receivers "
                       "= \"any\" may need it. 0 when not given.")
                .in({0, 100})),
        count_or_word_row(
            &ShadowSettings::samples, "auto", auto_samples,
            integer_key(
                "samples",
                "Exact, of a light with a size: how many points of it each pixel asks, shared out among "
                "the pixel's own samples; 1 is its middle, whose shadow is hard. \"auto\", the default: "
                "as many as the widest penumbra in the picture is pixels wide, 256 at most. Stack: how many "
                "maps it has, all of which each sample asks; at least 4, 64 when not given.")
                .one_of({1, 4, 16, 64, 256, 1024})),
        word_row_if_given(&ShadowSettings::receivers, receivers_words, "receivers",
                          "As in [render], whose value is the default."),
        word_row_if_given(
            &ShadowSettings::scope, shadow_scope_words, "scope",
            "Compressed: build what the frame's pixels look up, or everything, to be kept while only "
            "the camera moves. \"full\" where there is a cache or a code that needs it, else \"frame\"."),
        word_row_if_given(
            &ShadowSettings::filter, shadow_filter_words, "filter",
            "Compressed: filter texels, or squares of texels as large as the pixel is on the map, which "
            "keeps distant shadows still when the camera moves; what is thinner than a square, as the "
            "bars of a distant fence, then casts less of a shadow or none. A larger filter_px, whose "
            "squares are smaller, keeps more of it. \"pcf\" when not given."),
        key_row_if_given(
            &ShadowSettings::max_magnification,
            number_key(
                "max_magnification",
                "Compressed and stack, resolution \"auto\": how many pixels the side of a texel may "
                "span at most, across its shorter direction, anywhere in the picture. When not given: "
                "1/32 for compressed ones with scope \"frame\", filter \"pcf\" and a filter_px of at most "
                "3, up to 8388608 samples of the picture; else 1.")
                .in({0.01, 100})),
        word_row_if_given(
            &ShadowSettings::code, shadow_code_words.all, "code",
            "Compressed: how the tree is written. mh: by itself. The others, scope \"full\" alone, take more "
            "off the bytes than they keep. mmh: parts of it that can be one are, which takes seconds to "
            "find; lookups read as many nodes. dag: structure and depths apart, all that is alike in "
            "either written once; lookups read several times as much. facet: leaves hold planes and edges of "
            "the mesh, so "
            "that it grows by half when the side is four times as long, where surfaces meet at edges of the "
            "mesh alone, and three times where they pierce each other. auto: the smallest that is as fast as "
            "mh and is waited for once: mmh with scope \"full\", a cache, filter_px 1 and at least 6 "
            "top_levels, else mh; `obscura check` tells which, and why. \"mh\" when not given."),
        word_row_if_given(&ShadowSettings::layout, tree_layout_words.all, "layout",
                          "Compressed, code \"mh\": how nodes are written. bytes16 is about a tenth smaller "
                          "and slower to look up, words16 about as large as words24. \"words24\" when not "
                          "given."),
        key_row_if_given(
            &ShadowSettings::top_levels,
            integer_key(
                "top_levels",
                "Compressed: how many of the first levels are kept as a table, which saves lookups that "
                "many steps; 6 when not given.")
                .in({0, 10})),
        key_row_if_given(
            &ShadowSettings::day_file,
            file_key("day_file",
                     "Day: the file that `obscura terrain -o` wrote for a [[terrain]] of the scene. It "
                     "has to be of the same ground, to the last sample.")),
        key_row_if_given(
            &ShadowSettings::max_sun_deg,
            number_key(
                "max_sun_deg",
                "Day: how far the light may stand from the nearest sun of the file, whose shadows are taken; "
                "further off is an error. `obscura terrain --list` tells when the suns stand where. 0.01 "
                "when not given.")
                .in({1e-6, 10})),
        key_row_if_given(&ShadowSettings::cache, shadow_cache_key()),
    };
    return rows;
}

}  // namespace

const TableSpec& shadow_table() {
    static const TableSpec spec{
        "[shadow.LIGHT]",
        "How the light with the id LIGHT casts shadows. The same keys may stand in the light itself, as "
        "`shadow = {...}` or [light.shadow]. `cache` may also stand in [shadow], for all lights.",
        keys_of(shadow_rows()),
        "",
        {}};
    return spec;
}

ShadowSettings shadow_settings_of(const SceneTable& table) {
    ShadowSettings settings;
    read_rows(shadow_rows(), table, settings);
    return settings;
}

}  // namespace obscura
