#pragma once
// OBJ and MTL in the words that tinyobjloader knows. The two readers differ where the format's manual is
// open, where the library reads less than it and where it is trusting; each such place is a row here, with
// its reason.

#include <bitset>
#include <cstddef>
#include <string>
#include <string_view>

namespace obscura {

enum class Quirk {
    // Said in other words, then compared.
    byte_order_mark,
    joined_lines,
    comment_behind,
    empty_slots,
    other_blanks,
    blank_in_name,
    unread_elements,
    old_face_keyword,
    library_lines,
    one_number_colour,
    material_defaults,
    material_twice,
    // Compared but for one thing.
    many_corners,
    objects_and_groups,
    // Not compared.
    number_range,
    nul_byte,
    name_comment,
    short_option,
};
constexpr std::size_t quirk_count = static_cast<std::size_t>(Quirk::short_option) + 1;
using Quirks = std::bitset<quirk_count>;

enum class QuirkEffect { translated, one_thing_left_out, not_compared };

struct QuirkRow {
    const char* name;
    QuirkEffect effect;
    const char* reason;
};
const QuirkRow& quirk_row(Quirk quirk);

/// True if a file with these is not fit for the library at all.
bool keeps_from_comparing(const Quirks& quirks);

/// The same statements, one to a line, in the library's words; `found` gains what was met. The text must be
/// one that our reader accepts. Written without our reader's own parts, so that a mistake there is seen.
std::string plain_obj(std::string_view text, Quirks& found);
/// Every material starts with our defaults; what the file does not say of Ns, Pr and Pm reads -1.
std::string plain_mtl(std::string_view text, Quirks& found);

/// A name as plain_obj() and plain_mtl() write it.
std::string plain_name(std::string_view name);

}  // namespace obscura
