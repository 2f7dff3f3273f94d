// [render], [[output]], [limits]: the picture and its files.

#include "app/scene/aov.h"
#include "app/scene/build.h"
#include "app/scene/key_row.h"
#include "app/scene/keys.h"

namespace obscura {
namespace {

constexpr Word<ToneCurve> tones[] = {{"linear", ToneCurve::linear}, {"filmic", ToneCurve::filmic}};

/// size_px gives width and height.
const KeyRows<RenderSettings>& render_rows() {
    static const RenderSettings d;
    static const KeyRows<RenderSettings> rows{
        {size_key("size_px", "Width and height.").in({1, 1048576}).or_else(Size2{d.width, d.height}),
         [](const SceneValue& value, RenderSettings& to) {
             const auto& list = std::get<SceneList>(value.data);
             take(list.at(0), to.width);
             take(list.at(1), to.height);
         }},
        key_row(&RenderSettings::samples, integer_key("samples", "Samples per pixel.").one_of({1, 4, 16})),
        key_row(&RenderSettings::exposure_ev,
                number_key("exposure_ev", "Radiance is scaled by 2^exposure_ev.").in({-30, 30})),
        word_row(&RenderSettings::tone, tones, "tone", "Tone curve; linear clips at 1."),
        word_row(&RenderSettings::receivers, receivers_words, "receivers",
                 "Who receives shadows: \"static\", the scene's own surfaces, which is everyone in a "
                 "picture; or \"any\" point outside solids, for trees that are kept for receivers "
                 "which the scene does not have, such as moving objects added later. Of \"any\", a "
                 "map of open surfaces (a plane, leaves, scans) may take a node for every texel. What "
                 "lights use that do not say otherwise."),
    };
    return rows;
}

const KeyRows<Output>& output_rows() {
    static const KeyRows<Output> rows{
        word_row(
            &Output::aov, aov_words, "aov",
            "What to write. sun_hours: hours of direct sun over the path of the first sun (from, to); NaN "
            "where nothing is; as PNG coloured, from 160 pixels of width with a scale of 48 rows below."),
        key_row(
            &Output::file,
            file_key(
                "file",
                "Name ending in .png (8-bit sRGB) or .pfm (linear float), relative to the current folder and "
                "inside it; the last #### of the name stands for the frame number, padded to as many digits. "
                "A single # does only where the scene has several frames, and none does in a folder's name.")
                .as_result()
                .need()),
    };
    return rows;
}

const KeyRows<Limits>& limits_rows() {
    const auto limit = [](std::int64_t Limits::*member, const char* name, const char* doc) {
        return key_row(member, integer_key(name, doc).in({1, 1e12}));
    };
    static const KeyRows<Limits> rows{
        limit(&Limits::memory_mib, "memory_mib",
              "Estimated memory for meshes, textures, shadow maps and the frame."),
        limit(&Limits::triangles, "triangles", "Triangles of all meshes and instances together."),
        limit(&Limits::texture_px, "texture_px", "Longest side of a texture."),
        limit(&Limits::texture_mib, "texture_mib", "All decoded textures together."),
        limit(&Limits::frames, "frames", "Frames in the range."),
        limit(&Limits::image_px, "image_px", "Longest side of a frame."),
    };
    return rows;
}

template <class S>
S read(const KeyRows<S>& rows, const SceneTable& table) {
    S s;
    read_rows(rows, table, s);
    return s;
}

}  // namespace

const TableSpec& render_table() {
    static const TableSpec spec{"[render]", "The picture.", keys_of(render_rows()), "", {}};
    return spec;
}

const TableSpec& output_table() {
    static const TableSpec spec{"[[output]]", "A file to write per frame.", keys_of(output_rows()), "", {}};
    return spec;
}

const TableSpec& limits_table() {
    static const TableSpec spec{
        "[limits]",
        "Bounds that are checked before anything is allocated; beyond one, the program stops with exit code "
        "4.",
        keys_of(limits_rows()),
        "",
        {}};
    return spec;
}

RenderSettings render_settings_of(const SceneDocument& document) {
    return read(render_rows(), subtable(document.root, "render"));
}

std::vector<Output> outputs_of(const SceneDocument& document) {
    std::vector<Output> outputs;
    for (const SceneTable* output : subtables(document.root, "output"))
        outputs.push_back(read(output_rows(), *output));
    return outputs;
}

Limits limits_of(const SceneDocument& document) {
    return read(limits_rows(), subtable(document.root, "limits"));
}

}  // namespace obscura
