// tinyobjloader 2.0rc10 reads OBJ trustingly: indices out of range, words instead of numbers, polygons of
// more than 255 corners and paths anywhere pass it without an error, and its numbers go through libm's pow,
// whose bits vary by CPU. So the text is read by app/models/obj_text and, for the few MTL
// statements that a Material can hold, here; the library is left with what it does well, the option syntax of
// texture statements.
#include "app/models/mtl_text.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "app/models/text_lines.h"
#include "core/error.h"

namespace obscura {
namespace {

/// The numbers of a newmtl block, as written.
struct Numbers {
    Vec3f kd{0.8f, 0.8f, 0.8f}, ke{0, 0, 0};
    std::optional<Vec3f> ks_given;
    std::optional<float> ns, pr, pm;
    std::set<std::string, std::less<>> given;  ///< keywords that are obeyed, met so far

    Vec3f ks() const { return ks_given.value_or(Vec3f{}); }
    std::optional<double> d, tr;  ///< opacity, and 1 less it
};

Vec3f parse_colour(std::string_view keyword, std::string_view rest, const TextPlace& place) {
    std::array<float, 3> c = {};
    std::size_t count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
        if (count == 0 && (word == "spectral" || word == "xyz")) {
            throw InputError(place.file, place.line, 0,
                             fmt::format("{} {} is not supported, only RGB", keyword, word));
        }
        const float value = parse_float(word, place);
        if (value < 0)
            throw InputError(place.file, place.line, 0, fmt::format("{} must not be negative", keyword));
        if (count < 3) c[count] = value;
    }
    // One number stands for all three channels.
    if (count == 1) return {c[0], c[0], c[0]};
    if (count != 3) {
        throw InputError(place.file, place.line, 0,
                         fmt::format("{} takes 3 numbers, found {}", keyword, count));
    }
    return {c[0], c[1], c[2]};
}

float parse_scalar(std::string_view keyword, std::string_view rest, float largest, const TextPlace& place) {
    const float value = parse_float(take_word(rest), place);
    if (!(value >= 0 && value <= largest)) {
        throw InputError(place.file, place.line, 0,
                         fmt::format("{} must be in [0, {}], not {}", keyword, largest, value));
    }
    return value;
}

/// A texture statement with all three numbers behind each -o, -s and -t, of which the manual lets the last
/// two stay away. The last word is the file, whatever it looks like.
std::string with_all_numbers(std::string_view statement) {
    const auto is_number = [](std::string_view word) {
        const std::size_t digit = word.find_first_of("0123456789");
        return digit != std::string_view::npos &&
               word.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
    };
    std::string out;
    std::string_view rest = statement;
    while (trimmed(rest).substr(0, 1) == "-") {
        const std::string_view option = take_name_word(rest);
        out += fmt::format("{} ", option);
        const bool vector = option == "-o" || option == "-s" || option == "-t";
        for (int i = 0; i < (vector ? 3 : option == "-mm" ? 2 : 1); ++i) {
            std::string_view behind = rest;
            const std::string_view word = take_name_word(behind);
            const bool given = (!vector || is_number(word)) && !trimmed(behind).empty();
            if (!given && !vector) return std::string(statement);
            // Left out: the offset stays, the scale is the default.
            out += given ? fmt::format("{} ", word) : option == "-s" ? "1 " : "0 ";
            if (given) rest = behind;
        }
    }
    return out + std::string(trimmed(rest));
}

void add_once(std::vector<std::string>& phrases, std::string phrase) {
    if (std::find(phrases.begin(), phrases.end(), phrase) == phrases.end())
        phrases.push_back(std::move(phrase));
}

/// Options of a statement with all its numbers that nobody obeys, unless they say what is done anyway.
void note_options(MtlEntry& entry, std::string_view statement) {
    struct Option {
        std::string_view name;
        bool (*as_done)(std::string_view value);
    };
    constexpr auto never = [](std::string_view) { return false; };
    constexpr auto on = [](std::string_view value) { return value == "on" || value == "1"; };
    constexpr auto off = [](std::string_view value) { return value == "off" || value == "0"; };
    constexpr auto srgb = [](std::string_view value) { return value == "sRGB" || value == "srgb"; };
    constexpr Option unread[] = {{"-blendu", on},    {"-blendv", on},     {"-cc", off},
                                 {"-boost", off},    {"-bm", on},         {"-type", never},
                                 {"-texres", never}, {"-imfchan", never}, {"-colorspace", srgb}};
    std::string_view rest = statement;
    for (std::string_view word = take_name_word(rest); !rest.empty(); word = take_name_word(rest)) {
        for (const Option& option : unread) {
            std::string_view behind = rest;
            if (word == option.name && !option.as_done(take_name_word(behind)))
                add_once(entry.changed, fmt::format("'{}' of map_Kd is not read", option.name));
        }
    }
}

std::string parse_texture(std::string_view rest, MtlEntry& entry, const TextPlace& place) {
    const auto fail = [&](const std::string& message) {
        throw InputError(place.file, place.line, 0, message);
    };
    std::string name;
    tinyobj::texture_option_t options = {};
    options.scale[0] = options.scale[1] = options.scale[2] = 1;
    options.contrast = 1;
    const std::string statement = with_all_numbers(trimmed(rest));
    if (!tinyobj::ParseTextureNameAndOption(&name, &options, statement.c_str()) || trimmed(name).empty()) {
        fail("map_Kd names no file");
    }
    const auto all = [](const float(&v)[3], float value) {
        return v[0] == value && v[1] == value && v[2] == value;
    };
    if (!all(options.scale, 1) || !all(options.origin_offset, 0) || !all(options.turbulence, 0) ||
        options.clamp || options.brightness != 0 || options.contrast != 1) {
        fail("map_Kd: scaling, moving, clamping or recolouring a texture is not supported");
    }
    note_options(entry, statement);
    return std::string(trimmed(name));
}

Vec3f clamped(Vec3f c) {
    return {std::min(c.x, 1.0f), std::min(c.y, 1.0f), std::min(c.z, 1.0f)};
}
bool black(Vec3f c) {
    return c.x <= 0 && c.y <= 0 && c.z <= 0;
}

/// Black in Kd and not in Ks: what mirrors is a metal.
bool is_metal(const Numbers& n, bool textured) {
    return !n.pm && black(n.kd) && !black(n.ks()) && !textured;
}

Material to_material(const std::string& name, const Numbers& n, bool textured) {
    Material m;
    m.name = name;
    const bool metal = is_metal(n, textured);
    m.base_color = clamped(metal ? n.ks() : n.kd);
    m.metallic = n.pm.value_or(metal ? 1.0f : 0.0f);
    m.emission = n.ke;
    float roughness = 1.0f;
    if (n.ns && !black(n.ks())) roughness = std::sqrt(std::sqrt(2.0f / (*n.ns + 2.0f)));
    m.roughness = std::clamp(n.pr.value_or(roughness), 0.02f, 1.0f);
    return m;
}

/// What of the numbers a Material cannot hold.
void note_changes(MtlEntry& entry, const Numbers& n) {
    const bool metal = is_metal(n, !entry.texture.empty());
    const Vec3f base = metal ? n.ks() : n.kd, ks = n.ks();
    if (std::max({base.x, base.y, base.z}) > 1)
        add_once(entry.changed, fmt::format("{} is above 1 and is cut to 1", metal ? "Ks" : "Kd"));
    if (!metal && (ks.x != ks.y || ks.y != ks.z))
        add_once(entry.changed, "the colour of Ks is not read beside Kd: highlights are white");
    if (n.ns && !n.ks_given && !n.pr) add_once(entry.changed, "Ns does nothing without Ks");
}

template <std::size_t n>
bool contains(const std::array<std::string_view, n>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// The first number of a statement that is not obeyed; `otherwise` when there is none to be read.
double loose_number(std::string_view rest, double otherwise, const TextPlace& place) {
    std::string_view word = take_word(rest);
    if (word == "-halo") word = take_word(rest);
    try {
        return parse_number(word, place);
    } catch (const InputError&) {
        return otherwise;
    }
}

/// What a statement that we do not obey would change, noted in the entry.
void note_unread(MtlEntry& entry, Numbers& numbers, std::string_view keyword, std::string_view rest,
                 const TextPlace& place) {
    // The light of the whole surroundings, and what shades nothing by itself.
    constexpr std::array<std::string_view, 4> of_no_account = {"Ka", "map_Ka", "Ni", "sharpness"};
    if (contains(of_no_account, keyword)) return;
    if (keyword == "d") {
        numbers.d = loose_number(rest, 0, place);
    } else if (keyword == "Tr") {
        numbers.tr = loose_number(rest, 1, place);
    } else if (keyword == "Tf") {
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
            entry.transparent |= loose_number(word, 0, place) < 1;
    } else if (keyword == "map_d" || keyword == "map_Tr" || keyword == "map_opacity") {
        entry.transparent = true;
    } else if (keyword == "illum") {
        const double model = loose_number(rest, 0, place);  // these four are called glass or refraction
        entry.transparent |= model == 4 || model == 6 || model == 7 || model == 9;
    } else if (std::find(entry.unread.begin(), entry.unread.end(), keyword) == entry.unread.end()) {
        entry.unread.emplace_back(keyword);
    }
}

/// Statements that a Material obeys.
constexpr std::array<std::string_view, 7> obeyed = {"Kd", "Ks", "Ke", "Ns", "Pr", "Pm", "map_Kd"};

/// One statement of the block of `entry`; false when it is none that a Material obeys.
bool read_statement(MtlEntry& entry, Numbers& numbers, std::string_view keyword, std::string_view rest,
                    const TextPlace& place) {
    if (contains(obeyed, keyword) && !numbers.given.emplace(keyword).second)
        add_once(entry.changed, fmt::format("{} is given more than once; the last counts", keyword));
    if (keyword == "Kd") {
        numbers.kd = parse_colour(keyword, rest, place);
    } else if (keyword == "Ks") {
        numbers.ks_given = parse_colour(keyword, rest, place);
    } else if (keyword == "Ke") {
        numbers.ke = parse_colour(keyword, rest, place);
    } else if (keyword == "Ns") {
        numbers.ns = parse_scalar(keyword, rest, 1e6f, place);
    } else if (keyword == "Pr") {
        numbers.pr = parse_scalar(keyword, rest, 1.0f, place);
    } else if (keyword == "Pm") {
        numbers.pm = parse_scalar(keyword, rest, 1.0f, place);
    } else if (keyword == "map_Kd") {
        entry.texture = parse_texture(rest, entry, place);
        entry.texture_line = place.line;
    } else {
        return false;
    }
    return true;
}

}  // namespace

std::vector<MtlEntry> parse_mtl_text(std::string_view text, const std::string& file) {
    std::vector<MtlEntry> entries;
    std::vector<Numbers> numbers;
    LineReader lines(text);
    while (lines.next()) {
        std::string_view rest = lines.line();
        const std::string_view keyword = take_word(rest);
        const TextPlace place{file, lines.number()};
        if (keyword.empty()) continue;
        if (keyword == "newmtl") {
            const std::string name(trimmed(rest));
            if (name.empty()) throw InputError(file, place.line, 0, "newmtl without a name");
            entries.emplace_back();
            entries.back().name = name;
            entries.back().file = file;
            numbers.emplace_back();
        } else if (entries.empty()) {
            if (contains(obeyed, keyword))
                throw InputError(file, place.line, 0, fmt::format("{} before any newmtl", keyword));
        } else if (!read_statement(entries.back(), numbers.back(), keyword, rest, place)) {
            note_unread(entries.back(), numbers.back(), keyword, rest, place);
        }
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
        MtlEntry& entry = entries[i];
        entry.material = to_material(entry.name, numbers[i], !entry.texture.empty());
        note_changes(entry, numbers[i]);
        // Some write Tr 1 beside d 1 and mean the same by both.
        entry.transparent |= numbers[i].d ? *numbers[i].d < 1 : numbers[i].tr.value_or(0) > 0;
    }
    return entries;
}

}  // namespace obscura
