#include "app/scene/dirt_rows.h"

namespace obscura {
namespace {

template <class T>
DirtRow dirt_row(T LensDirt::*member, const char* flag_value, const char* flag_doc, KeySpec key) {
    return {member, key_row(member, std::move(key)), flag_value, flag_doc};
}

DirtRow dirt_row(Occluder LensDirt::*member, const char* flag_value, const char* flag_doc,
                 const KeySpec& key) {
    return {member, word_row(member, occluder_words, key.name, key.doc), flag_value, flag_doc};
}

}  // namespace

const std::vector<DirtRow>& dirt_rows() {
    static const std::vector<DirtRow> rows{
        dirt_row(&LensDirt::seed, "N", "Where whatever is random lies.",
                 integer_key("seed", "Where noise, dust, scratches and eyelashes are follows from it.")
                     .in({0, 4294967295.0})),
        dirt_row(
            &LensDirt::noise, "SHARE", "Smears: most amplitude they take away.",
            number_key("noise", "Smears: most of the amplitude that they take away; half of it on average.")
                .in({0, 1})),
        dirt_row(
            &LensDirt::noise_cell, "SHARE", "Size of the largest.",
            number_key("noise_cell", "Size of the largest smears, share of the lens.").in({1.0 / 1024, 1})),
        dirt_row(&LensDirt::noise_stretch, "RATIO", "Their length / width.",
                 number_key("noise_stretch", "Length / width of smears.").in({1, 64})),
        dirt_row(&LensDirt::noise_angle_deg, "DEG", "Direction of their length, clockwise from the right.",
                 number_key("noise_angle_deg", "Direction of their length, clockwise from the right.")
                     .in({-36000, 36000})),
        dirt_row(&LensDirt::dust, "N", "Grains.",
                 integer_key("dust",
                             "Grains on the lens. Dirt makes the pattern as coarse as mask_px: it fades out "
                             "near a third of a "
                             "cycle per texel.")
                     .in({0, 10000})),
        dirt_row(&LensDirt::dust_radius, "SHARE", "Of the largest.",
                 number_key("dust_radius", "Of the largest, share of the lens.").in({0, 0.5, true})),
        dirt_row(&LensDirt::dust_softness, "SHARE", "0 hard edges, 1 soft ones.",
                 number_key("dust_softness", "0: hard edges, 1: they fade from the middle on.").in({0, 1})),
        dirt_row(&LensDirt::scratches, "N", "Dark lines.",
                 integer_key("scratches", "Dark lines, slightly curved.").in({0, 10000})),
        dirt_row(&LensDirt::scratch_width, "SHARE", "Of the widest.",
                 number_key("scratch_width", "Of the widest, share of the lens.").in({0, 0.1, true})),
        dirt_row(&LensDirt::scratch_length, "SHARE", "Of the longest.",
                 number_key("scratch_length", "Of the longest, share of the lens.").in({0, 2, true})),
        dirt_row(
            &LensDirt::scratch_spread_deg, "DEG", "Their directions lie this far around the vertical.",
            number_key("scratch_spread_deg", "Their directions lie this far around the vertical; 180: all.")
                .in({0, 180})),
        dirt_row(&LensDirt::eyelashes, "N", "Hairs that hang from the upper side.",
                 integer_key("eyelashes", "Hairs that hang down before the lens.").in({0, 1000})),
        dirt_row(&LensDirt::eyelash_width, "SHARE", "At the root.",
                 number_key("eyelash_width", "At the root, share of the lens.").in({0, 0.1, true})),
        dirt_row(&LensDirt::eyelash_length, "SHARE", "Of the longest.",
                 number_key("eyelash_length", "Of the longest, share of the lens.").in({0, 2, true})),
        dirt_row(
            &LensDirt::occluder, "KIND",
            "A circle moved over the opening: housing (light passes inside only) or disc (outside only).",
            choice_key("occluder", names_of(occluder_words),
                       "A circle moved over the opening: light passes inside it only (housing: the lens's "
                       "barrel seen from the side, a cat's eye) or outside it only (disc).")),
        dirt_row(&LensDirt::occluder_diameter, "SHARE", "Its diameter.",
                 number_key("occluder_diameter", "Share of the lens.").in({0, 4, true}).animate()),
        dirt_row(&LensDirt::occluder_x, "SHARE", "Right of the mask's middle.",
                 number_key("occluder_x", "Of its middle, to the right of the lens's; share of the lens.")
                     .in({-2, 2})
                     .animate()),
        dirt_row(&LensDirt::occluder_y, "SHARE", "Below the mask's middle.",
                 number_key("occluder_y", "The same, down.").in({-2, 2}).animate()),
    };
    return rows;
}

}  // namespace obscura
