#include "app/models/stl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "app/models/faces_mesh.h"
#include "app/models/file_access.h"
#include "app/models/point_index.h"
#include "app/models/text_lines.h"
#include "core/count_text.h"
#include "core/error.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t head_bytes = 84, facet_bytes = 50;

/// Triangles whose equal corners become one.
class StlFaces {
  public:
    StlFaces(const std::string& file, const Limits& limits) : file_(file), limits_(limits) {}

    void add(const std::array<Vec3f, 3>& corner, std::int32_t object, int line) {
        if (++faces.triangles > most_triangles(limits_)) {
            throw LimitError(
                fmt::format("{}: has more than limits.triangles = {} triangles", file_, limits_.triangles));
        }
        IndexedFace face;
        face.first_corner = static_cast<std::uint32_t>(faces.corners.size());
        face.corner_count = 3;
        face.object = object;
        face.line = line;
        for (const Vec3f& p : corner)
            faces.corners.push_back({known_.index_of(to_double(p), faces.positions), -1, -1});
        faces.faces.push_back(face);
    }

    IndexedFaces faces;

  private:
    const std::string& file_;
    const Limits& limits_;
    PointIndex known_;
};

std::uint32_t facets_of(std::string_view bytes) {
    std::uint32_t count = 0;
    if (bytes.size() >= head_bytes) std::memcpy(&count, bytes.data() + head_bytes - 4, 4);
    return count;
}

/// A text has no byte 0, which the numbers of a binary file have.
bool is_text(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || bytes.find('\0') != std::string_view::npos) return false;
    const std::string_view word = bytes.substr(first, 5);
    return word == "solid" || word == "SOLID" || word == "Solid";
}

bool is_binary(std::string_view bytes) {
    return bytes.size() >= head_bytes &&
           bytes.size() == head_bytes + facet_bytes * std::uint64_t{facets_of(bytes)};
}

/// Notes of what is left out are added.
IndexedFaces read_binary(std::string_view bytes, const std::string& file, const Limits& limits,
                         std::vector<std::string>& notes) {
    StlFaces out(file, limits);
    std::size_t coloured = 0;
    for (std::uint32_t i = 0; i < facets_of(bytes); ++i) {
        const char* at = bytes.data() + head_bytes + facet_bytes * std::size_t{i};
        float number[9];
        std::memcpy(number, at + 12, sizeof number);  // behind the normal
        std::uint16_t attribute = 0;
        std::memcpy(&attribute, at + 48, 2);
        coloured += attribute != 0;
        for (const float v : number) {
            if (!std::isfinite(v))
                throw InputError(file, fmt::format("triangle {}: a coordinate is not finite", i));
        }
        out.add({Vec3f{number[0], number[1], number[2]}, Vec3f{number[3], number[4], number[5]},
                 Vec3f{number[6], number[7], number[8]}},
                -1, static_cast<int>(i));
    }
    if (coloured > 0) {
        notes.push_back(fmt::format("{}: attributes (colours) of {} are not read", file,
                                    count_text(coloured, "triangle")));
    }
    return std::move(out.faces);
}

class TextReader {
  public:
    TextReader(std::string_view text, const std::string& file, const Limits& limits)
        : text_(text), file_(file), out_(file, limits) {}

    IndexedFaces run() {
        while (next()) {
            expect("solid");
            begin_solid(trimmed(rest_));
            for (;;) {
                need("'facet' or 'endsolid'");
                if (is(word_, "endsolid")) break;
                read_facet();
            }
        }
        return std::move(out_.faces);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, line_, 0, message); }

    /// The next line that is not empty, and its first word.
    bool next() {
        do {
            if (text_.empty()) return false;
            const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
            rest_ = text_.substr(0, end);
            text_.remove_prefix(std::min(end + (text_.substr(end, 2) == "\r\n" ? 2 : 1), text_.size()));
            ++line_;
            word_ = take_name_word(rest_);
        } while (word_.empty());
        return true;
    }

    /// Keywords may be written large.
    static bool is(std::string_view word, std::string_view keyword) {
        return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(), [](char a, char b) {
            return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
        });
    }

    void need(const char* what) {
        if (!next()) fail(fmt::format("the file ends where {} is expected", what));
    }

    void expect(std::string_view word) const {
        if (!is(word_, word)) fail(fmt::format("expected '{}', not '{}'", word, shown(word_)));
    }

    void expect_next(std::string_view word) {
        need(fmt::format("'{}'", word).c_str());
        expect(word);
    }

    void expect_end() {
        if (const std::string_view more = take_name_word(rest_); !more.empty())
            fail(fmt::format("'{}' is too much here", shown(more)));
    }

    Vec3f numbers() {
        float v[3];
        for (float& x : v) {
            const std::string_view number = take_name_word(rest_);
            if (number.empty()) fail("three numbers are expected");
            x = parse_float(number, {file_, line_});
        }
        expect_end();
        return {v[0], v[1], v[2]};
    }

    void begin_solid(std::string_view name) {
        object_ = -1;
        if (name.empty()) return;
        auto& names = out_.faces.object_names;
        const auto [at, is_new] =
            objects_.try_emplace(std::string(name), static_cast<std::int32_t>(names.size()));
        if (is_new) names.push_back({at->first, line_});
        object_ = at->second;
    }

    void read_facet() {
        expect("facet");
        const int line = line_;
        if (!is(take_name_word(rest_), "normal")) fail("expected 'facet normal'");
        read_normal();
        expect_next("outer");
        if (!is(take_name_word(rest_), "loop")) fail("expected 'outer loop'");
        expect_end();
        std::array<Vec3f, 3> corner;
        for (Vec3f& p : corner) {
            expect_next("vertex");
            p = numbers();
        }
        need("'endloop'");
        if (is(word_, "vertex")) fail("a facet of more than three corners");
        expect("endloop");
        expect_next("endfacet");
        out_.add(corner, object_, line);
    }

    /// Not used, and of degenerate triangles often no number at all.
    void read_normal() {
        for (int k = 0; k < 3; ++k)
            if (take_name_word(rest_).empty()) fail("three numbers are expected");
        expect_end();
    }

    std::string_view text_;
    int line_ = 0;
    const std::string& file_;
    StlFaces out_;
    std::string_view rest_, word_;
    std::int32_t object_ = -1;
    std::map<std::string, std::int32_t> objects_;
};

}  // namespace

Model stl_from_bytes(std::string_view bytes, const std::string& file, const Limits& limits,
                     const ModelOptions& options) {
    std::vector<std::string> notes;
    IndexedFaces faces;
    if (is_binary(bytes)) {
        faces = read_binary(bytes, file, limits, notes);
    } else if (is_text(bytes)) {
        faces = TextReader(bytes, file, limits).run();
    } else if (bytes.size() < head_bytes) {
        throw InputError(file,
                         fmt::format("is no STL file: {} and no 'solid'", count_text(bytes.size(), "byte")));
    } else {
        throw InputError(
            file, fmt::format("is no STL file, or cut: a binary one of {} has {} bytes, not {}",
                              count_text(std::int64_t{facets_of(bytes)}, "triangle"),
                              head_bytes + facet_bytes * std::uint64_t{facets_of(bytes)}, bytes.size()));
    }
    Model model = model_of_faces(faces, file, options.crease_angle_deg);
    model.notes.insert(model.notes.begin(), notes.begin(), notes.end());
    return model;
}

Model load_stl(const std::filesystem::path& file, const Limits& limits, const ModelOptions& options) {
    return stl_from_bytes(read_model_bytes(file, limits), file.string(), limits, options);
}

}  // namespace obscura
