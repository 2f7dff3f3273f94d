#include "app/models/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "app/models/text_lines.h"
#include "core/error.h"

namespace obscura {
namespace {

struct TypeName {
    std::string_view name, other;  ///< both are in use
    PlyType type;
    int bytes;
};
constexpr TypeName types[] = {
    {"char", "int8", PlyType::int8, 1},        {"uchar", "uint8", PlyType::uint8, 1},
    {"short", "int16", PlyType::int16, 2},     {"ushort", "uint16", PlyType::uint16, 2},
    {"int", "int32", PlyType::int32, 4},       {"uint", "uint32", PlyType::uint32, 4},
    {"float", "float32", PlyType::float32, 4}, {"double", "float64", PlyType::float64, 8},
};

class HeaderReader {
  public:
    HeaderReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    PlyHeader run() {
        if (next_line() != "ply") fail("is no PLY file: its first line is not 'ply'");
        read_format();
        for (;;) {
            std::string_view rest = next_line();
            const std::string_view word = take(rest);
            if (word == "end_header") break;
            if (word == "comment" && take(rest) == "TextureFile") out_.textures.emplace_back(trimmed(rest));
            if (word == "comment" || word == "obj_info" || word.empty()) continue;
            if (word == "element") {
                read_element(rest);
            } else if (word == "property") {
                read_property(rest);
            } else {
                fail(fmt::format("unknown word '{}' in the header", shown(word)));
            }
        }
        out_.body = at_;
        out_.lines = line_;
        check_lengths();
        return std::move(out_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, line_, 0, message); }

    /// Lines end with LF, CRLF or CR.
    std::string_view next_line() {
        ++line_;
        // A file ends its lines as it ends the first, so that what follows may begin with any byte.
        if (line_ == 1) {
            const std::size_t first = bytes_.find_first_of("\r\n");
            if (first == std::string_view::npos) fail("ends within its header");
            ending_ = bytes_.substr(first, bytes_.substr(first, 2) == "\r\n" ? 2 : 1);
        }
        const std::size_t end = bytes_.find(ending_, at_);
        if (end == std::string_view::npos) fail("ends within its header");
        const std::string_view line = bytes_.substr(at_, end - at_);
        at_ = end + ending_.size();
        return trimmed(line);
    }

    static std::string_view take(std::string_view& rest) {
        rest = trimmed(rest);
        const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
        const std::string_view word = rest.substr(0, end);
        rest = rest.substr(end);
        return word;
    }

    void read_format() {
        std::string_view rest;
        do {
            rest = next_line();
        } while (rest.starts_with("comment") || rest.starts_with("obj_info"));
        if (take(rest) != "format") fail("expected 'format'");
        const std::string_view format = take(rest), version = take(rest);
        if (format == "ascii") {
            out_.format = PlyFormat::ascii;
        } else if (format == "binary_little_endian") {
            out_.format = PlyFormat::little_endian;
        } else if (format == "binary_big_endian") {
            out_.format = PlyFormat::big_endian;
        } else {
            fail(fmt::format("unknown format '{}'", shown(format)));
        }
        if (version != "1.0") fail(fmt::format("version '{}' is not read, 1.0 is", shown(version)));
        expect_end(rest);
    }

    void expect_end(std::string_view rest) const {
        if (rest = trimmed(rest); !rest.empty()) fail(fmt::format("'{}' is too much here", shown(rest)));
    }

    void read_element(std::string_view rest) {
        PlyElement element;
        element.name = take(rest);
        element.line = line_;
        const std::string_view count = take(rest);
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc{} || end != count.data() + count.size() || element.count < 0)
            fail(fmt::format("'{}' is no number of elements", shown(count)));
        expect_end(rest);
        if (!elements_.insert(element.name).second)
            fail(fmt::format("a second element '{}'", shown(element.name)));
        properties_.clear();
        out_.elements.push_back(std::move(element));
    }

    PlyType type(std::string_view word) const {
        for (const TypeName& t : types)
            if (word == t.name || word == t.other) return t.type;
        fail(fmt::format("unknown type '{}'", shown(word)));
    }

    void read_property(std::string_view rest) {
        if (out_.elements.empty()) fail("a property before any element");
        PlyProperty p;
        std::string_view word = take(rest);
        if (word == "list") {
            p.is_list = true;
            p.count_type = type(take(rest));
            if (p.count_type == PlyType::float32 || p.count_type == PlyType::float64)
                fail("a list's length must be an integer");
            word = take(rest);
        }
        p.type = type(word);
        p.name = take(rest);
        if (p.name.empty()) fail("a property without a name");
        expect_end(rest);
        if (!properties_.insert(p.name).second) fail(fmt::format("a second property '{}'", shown(p.name)));
        out_.elements.back().properties.push_back(std::move(p));
    }

    void check_lengths() const {
        auto left = static_cast<std::int64_t>(bytes_.size() - at_);
        // The last line of a text may lack its end.
        if (out_.format == PlyFormat::ascii) ++left;
        for (const PlyElement& element : out_.elements) {
            const std::int64_t row = element.least_bytes(out_.format);
            if (row == 0 && element.count > 0) {
                throw InputError(file_, element.line, 0,
                                 fmt::format("element '{}' has no properties", shown(element.name)));
            }
            if (element.count > 0 && element.count > left / row) {
                throw InputError(file_, element.line, 0,
                                 fmt::format("{} elements '{}' do not fit into the {} bytes that follow",
                                             element.count, shown(element.name), bytes_.size() - at_));
            }
            left -= element.count * row;
        }
    }

    std::string_view bytes_;
    const std::string& file_;
    std::string_view ending_;
    std::size_t at_ = 0;
    int line_ = 0;
    std::set<std::string> elements_, properties_;
    PlyHeader out_;
};

}  // namespace

int ply_size(PlyType type) {
    return types[static_cast<std::size_t>(type)].bytes;
}

std::int64_t PlyElement::least_bytes(PlyFormat format) const {
    std::int64_t bytes = 0;
    for (const PlyProperty& p : properties)
        bytes += format == PlyFormat::ascii ? 2 : ply_size(p.is_list ? p.count_type : p.type);
    return bytes;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& file) {
    return HeaderReader(bytes, file).run();
}

}  // namespace obscura
