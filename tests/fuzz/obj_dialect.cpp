#include "tests/fuzz/obj_dialect.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <iterator>
#include <set>
#include <vector>

namespace obscura {
namespace {

constexpr auto translated = QuirkEffect::translated;
constexpr auto left_out = QuirkEffect::one_thing_left_out;
constexpr auto not_compared = QuirkEffect::not_compared;

constexpr QuirkRow rows[] = {
    {"byte order mark", translated,
     "the library takes it for a part of the first keyword and drops the line"},
    {"joined lines", translated, "the library knows no backslash at the end of a line"},
    {"comment behind a face", translated, "the library reads # as index 0 and refuses the file"},
    {"empty slots", translated, "a corner as 1/1/ or 1//: the library reads index 0 and refuses the file"},
    {"other blanks", translated, "the library knows space and tab, not vertical tab and form feed"},
    {"blank in a name", translated, "usemtl takes one word, newmtl the line: such a material is never found"},
    {"elements we skip", translated, "one index 0 in an l or p, one joint below 0 in a vw: all is refused"},
    {"fo", translated, "the old keyword of a face: the library drops it"},
    {"mtllib lines", translated,
     "the library reads the first of several files, cuts names at blanks, eats backslashes, and knows no "
     "material above the mtllib"},
    {"colour of one number", translated, "the manual lets g and b equal r then; the library has them 0"},
    {"material defaults", translated,
     "what the file leaves open: Kd 0.8 with us; with the library 0, or 0.6 behind a map_Kd unless any "
     "material above had a Kd"},
    {"material twice", translated, "the manual is silent: we keep the last, the library the first"},
    {"more than 255 corners", left_out,
     "the library counts a face's corners in one byte: compared modulo 256"},
    {"o and g", left_out, "an object's name: o alone with us, the last of o and g with the library"},
    {"number out of range", not_compared,
     "300 digits or 10^300: the library multiplies by pow(5, n), 0e500 is NaN to it"},
    {"NUL byte", not_compared, "the library's lines end there"},
    {"comment behind a name", not_compared,
     "usemtl takes one word, newmtl and map_Kd the line: the library has the comment in the name"},
    {"short -o, -s or -t", not_compared,
     "the library wants three numbers and takes the file for one of them"},
};
static_assert(std::size(rows) == quirk_count);

void note(Quirks& found, Quirk quirk) {
    found.set(static_cast<std::size_t>(quirk));
}

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

std::vector<std::string> words(const std::string& text) {
    std::vector<std::string> list;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t begin = text.find_first_not_of(" \t", at);
        if (begin == std::string::npos) break;
        at = std::min(text.find_first_of(" \t", begin), text.size());
        list.push_back(text.substr(begin, at - begin));
    }
    return list;
}

/// Whether a name is followed by what may be a comment: # behind a blank.
bool has_comment(const std::string& name) {
    for (std::size_t i = 1; i < name.size(); ++i) {
        if (name[i] == '#' && is_blank(name[i - 1])) return true;
    }
    return false;
}

/// The text with LF alone between its lines.
std::string with_line_feeds(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool pair = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
        if (!pair) out += text[i] == '\r' ? '\n' : text[i];
    }
    return out;
}

/// The lines of a text after joining, with no blanks but spaces and tabs.
std::vector<std::string> logical_lines(std::string_view bytes, Quirks& found) {
    const std::string fed = with_line_feeds(bytes);
    std::string_view text = fed;
    if (text.find('\0') != std::string_view::npos) note(found, Quirk::nul_byte);
    if (text.substr(0, 3) == "\xEF\xBB\xBF") {
        note(found, Quirk::byte_order_mark);
        text.remove_prefix(3);
    }
    std::vector<std::string> lines;
    bool join = false;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.find_first_of("\v\f") != std::string::npos) note(found, Quirk::other_blanks);
        std::replace_if(
            line.begin(), line.end(), [](char c) { return c == '\v' || c == '\f'; }, ' ');
        if (join) {
            lines.back() += line;
        } else {
            lines.push_back(line);
        }
        std::string& whole = lines.back();
        const std::size_t last = whole.find_last_not_of(" \t");
        join = last != std::string::npos && whole[last] == '\\' && whole.find('#') == std::string::npos;
        if (join) {
            note(found, Quirk::joined_lines);
            whole[last] = ' ';
        }
    }
    return lines;
}

struct Statement {
    std::string keyword, rest;  ///< the rest without blanks around it
};

Statement split(const std::string& line) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos || line[begin] == '#') return {};
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    Statement s{line.substr(begin, end - begin), line.substr(end)};
    const std::size_t first = s.rest.find_first_not_of(" \t");
    s.rest =
        first == std::string::npos ? "" : s.rest.substr(first, s.rest.find_last_not_of(" \t") - first + 1);
    return s;
}

std::string without_comment(const std::string& rest, Quirks& found) {
    const std::size_t at = rest.find('#');
    if (at != std::string::npos) note(found, Quirk::comment_behind);
    return rest.substr(0, at);
}

/// Corners without the slashes behind their last index.
std::string without_empty_slots(const std::string& corners, Quirks& found) {
    std::string out;
    for (std::string word : words(corners)) {
        if (word.back() == '/') note(found, Quirk::empty_slots);
        out += word.substr(0, word.find_last_not_of('/') + 1) + " ";
    }
    return out;
}

/// Whether a texture statement has an -o, -s or -t without all of its numbers.
bool has_short_option(const std::string& statement) {
    const std::vector<std::string> list = words(statement);
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i] != "-o" && list[i] != "-s" && list[i] != "-t") continue;
        for (std::size_t k = 1; k <= 3; ++k) {
            if (i + k + 1 >= list.size() ||
                list[i + k].find_first_not_of("+-.0123456789eE") != std::string::npos)
                return true;
        }
    }
    return false;
}

/// Notes a number that the library's arithmetic does not carry.
void check_range(const std::string& numbers, Quirks& found) {
    for (const std::string& word : words(numbers)) {
        const std::size_t e = word.find_first_of("eE");
        const long exponent = e == std::string::npos ? 0 : std::strtol(word.c_str() + e + 1, nullptr, 10);
        if (word.size() > 300 || exponent > 300 || exponent < -1'000'000'000)
            note(found, Quirk::number_range);
    }
}

std::string plain_name(const std::string& name, Quirks& found) {
    if (has_comment(name)) note(found, Quirk::name_comment);
    if (name.find_first_of(" \t") != std::string::npos) note(found, Quirk::blank_in_name);
    return obscura::plain_name(name);
}

bool is(const std::string& word, std::initializer_list<std::string_view> list) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// What mtllib and usemtl, o and g lines say together.
struct Order {
    int libraries = 0;
    bool used = false, object = false, group = false;
};

std::string plain_statement(const Statement& s, Order& order, Quirks& found) {
    if (is(s.keyword, {"v", "vt", "vn"})) {
        const std::string numbers = without_comment(s.rest, found);
        check_range(numbers, found);
        return s.keyword + " " + numbers + "\n";
    }
    if (is(s.keyword, {"f", "fo"})) {
        if (s.keyword == "fo") note(found, Quirk::old_face_keyword);
        const std::string corners = without_empty_slots(without_comment(s.rest, found), found);
        if (words(corners).size() > 255) note(found, Quirk::many_corners);
        return "f " + corners + "\n";
    }
    if (is(s.keyword, {"usemtl", "o", "g"})) {
        order.used |= s.keyword == "usemtl";
        order.object |= s.keyword == "o";
        order.group |= s.keyword == "g";
        return s.keyword + " " + plain_name(s.rest, found) + "\n";
    }
    if (s.keyword == "mtllib") {
        const bool plain = order.libraries++ == 0 && !order.used;
        if (!plain || s.rest.find_first_of(" \t\\#") != std::string::npos) note(found, Quirk::library_lines);
        return "";
    }
    // Smoothing groups are not compared; lines, points, weights and the like belong to no triangle.
    if (is(s.keyword, {"l", "p", "vw", "t"})) note(found, Quirk::unread_elements);
    return "";
}

}  // namespace

const QuirkRow& quirk_row(Quirk quirk) {
    return rows[static_cast<std::size_t>(quirk)];
}

bool keeps_from_comparing(const Quirks& quirks) {
    for (std::size_t i = 0; i < quirk_count; ++i) {
        if (quirks[i] && rows[i].effect == not_compared) return true;
    }
    return false;
}

std::string plain_name(std::string_view name) {
    std::string word(name);
    std::replace_if(
        word.begin(), word.end(), [](char c) { return is_blank(c) || c == '\v' || c == '\f'; }, '\x01');
    return word;
}

std::string plain_obj(std::string_view text, Quirks& found) {
    std::string body;
    Order order;
    for (const std::string& line : logical_lines(text, found)) {
        const Statement s = split(line);
        body += s.keyword.empty() ? line + "\n" : plain_statement(s, order, found);
    }
    if (order.object && order.group) note(found, Quirk::objects_and_groups);
    return order.libraries > 0 ? "mtllib all\n" + body : body;
}

std::string plain_mtl(std::string_view text, Quirks& found) {
    std::string body;
    std::set<std::string> names;
    bool has_kd = true;
    for (const std::string& line : logical_lines(text, found)) {
        const Statement s = split(line);
        if (s.keyword == "newmtl") {
            if (!has_kd) note(found, Quirk::material_defaults);
            has_kd = false;
            const std::string name = plain_name(s.rest, found);
            if (!names.insert(name).second) note(found, Quirk::material_twice);
            body += "newmtl " + name + "\nKd 0.8 0.8 0.8\nNs -1\nPr -1\nPm -1\n";
        } else if (is(s.keyword, {"Kd", "Ks", "Ke"})) {
            const std::string numbers = without_comment(s.rest, found);
            check_range(numbers, found);
            const std::vector<std::string> channel = words(numbers);
            if (channel.size() == 1) note(found, Quirk::one_number_colour);
            body += s.keyword + " " + numbers;
            for (std::size_t i = channel.size(); i < 3; ++i)
                body += " " + channel.front();
            body += "\n";
            has_kd |= s.keyword == "Kd";
        } else if (is(s.keyword, {"Ns", "Pr", "Pm"})) {
            check_range(s.rest, found);
            body += s.keyword + " " + s.rest + "\n";
        } else if (s.keyword == "map_Kd") {
            if (has_comment(s.rest)) note(found, Quirk::name_comment);
            if (has_short_option(s.rest)) note(found, Quirk::short_option);
            body += s.keyword + " " + s.rest + "\n";
        } else {
            body += line + "\n";
        }
    }
    if (!has_kd) note(found, Quirk::material_defaults);
    return body;
}

}  // namespace obscura
