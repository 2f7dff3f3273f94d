// Wavefront OBJ, the polygonal part of "Object Files (.obj)", Advanced Visualizer manual, appendix B1.
#include "app/models/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include "app/models/text_lines.h"
#include "core/error.h"
#include "core/topology.h"

namespace obscura {
namespace {

constexpr std::array<std::string_view, 17> skipped_keywords = {
    "p",      "l",      "vp",         "vw",        "mg",    "bevel", "c_interp", "d_interp", "lod",
    "usemap", "maplib", "shadow_obj", "trace_obj", "ctech", "stech", "t",        "deg"};
constexpr std::array<std::string_view, 13> free_form_keywords = {
    "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end", "con", "cstype", "bmat", "step"};

template <std::size_t n>
bool contains(const std::array<std::string_view, n>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// Names in the order of their first use.
struct NameList {
    std::int32_t find_or_add(std::string_view name, int line) {
        const auto [at, added] =
            number.try_emplace(std::string(name), static_cast<std::int32_t>(names.size()));
        if (added) names.push_back({std::string(name), line});
        return at->second;
    }
    std::vector<NameInFile> names;
    std::map<std::string, std::int32_t, std::less<>> number;
};

class Parser {
  public:
    Parser(std::string_view text, const std::string& file, const Limits& limits)
        : lines_(text), file_(file), most_triangles_(most_triangles(limits)) {}

    ObjText run() {
        while (lines_.next()) {
            std::string_view rest = lines_.line();
            const std::string_view keyword = take_word(rest);
            if (!keyword.empty()) statement(keyword, rest);
        }
        check_indices();
        if (objects_.names.empty()) {
            objects_ = std::move(groups_);
            for (std::size_t f = 0; f < out_.faces.size(); ++f)
                out_.faces[f].object = group_of_face_[f];
        }
        out_.object_names = std::move(objects_.names);
        out_.material_names = std::move(materials_.names);
        return std::move(out_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(file_, lines_.number(), 0, message);
    }

    void statement(std::string_view keyword, std::string_view rest) {
        if (keyword == "v") {
            position(rest);
        } else if (keyword == "f" || keyword == "fo") {
            face(rest);
        } else if (keyword == "vt") {
            texture_coordinate(rest);
        } else if (keyword == "vn") {
            normal(rest);
        } else if (keyword == "o") {
            object_ = objects_.find_or_add(trimmed(rest), lines_.number());
        } else if (keyword == "g") {
            group_ = groups_.find_or_add(trimmed(rest), lines_.number());
        } else if (keyword == "s") {
            smoothing(rest);
        } else if (keyword == "usemtl") {
            material_ = materials_.find_or_add(trimmed(rest), lines_.number());
        } else if (keyword == "mtllib") {
            out_.libraries.push_back({std::string(trimmed(rest)), lines_.number()});
        } else if (contains(free_form_keywords, keyword)) {
            fail(fmt::format("'{}': free-form curves and surfaces are not supported", keyword));
        } else if (contains(skipped_keywords, keyword)) {
            skip(fmt::format("'{}'", keyword));
        } else {
            fail(fmt::format("unknown keyword '{}'", shown(keyword)));
        }
    }

    /// Up to `n` numbers; how many there were.
    template <class T, std::size_t n>
    std::size_t numbers(std::string_view rest, std::array<T, n>& values) const {
        std::size_t count = 0;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            const double value = parse_number(word, {file_, lines_.number()});
            if (count < n) values[count] = static_cast<T>(value);
            ++count;
        }
        return count;
    }

    /// Something that is read over: told once per kind.
    void skip(std::string_view what) {
        const auto known = std::find_if(out_.skipped.begin(), out_.skipped.end(),
                                        [&](const ObjSkipped& s) { return s.what == what; });
        if (known != out_.skipped.end()) {
            ++known->count;
        } else {
            out_.skipped.push_back({std::string(what), lines_.number(), 1});
        }
    }

    void check_vertex_limit(std::size_t count, std::string_view what) const {
        if (static_cast<std::int64_t>(count) >= 3 * most_triangles_) {
            throw LimitError(fmt::format("{}:{}: more than {} {}, three times limits.triangles", file_,
                                         lines_.number(), 3 * most_triangles_, what));
        }
    }

    void position(std::string_view rest) {
        std::array<double, 7> p = {};
        const std::size_t count = numbers(rest, p);
        // x y z, then a weight, a colour or both, which polygons do not use.
        if (count != 3 && count != 4 && count != 6 && count != 7) {
            fail(fmt::format("v takes 3 numbers (or 4, 6, 7 with weight and colour), found {}", count));
        }
        if (count >= 6) skip("colours of vertices");
        check_vertex_limit(out_.positions.size(), "positions");
        out_.positions.push_back({p[0], p[1], p[2]});
    }

    void texture_coordinate(std::string_view rest) {
        std::array<float, 3> t = {};
        const std::size_t count = numbers(rest, t);
        if (count < 1 || count > 3) fail(fmt::format("vt takes 1 to 3 numbers, found {}", count));
        check_vertex_limit(out_.uvs.size(), "texture coordinates");
        out_.uvs.push_back({t[0], t[1]});
    }

    void normal(std::string_view rest) {
        std::array<float, 3> n = {};
        const std::size_t count = numbers(rest, n);
        if (count != 3) fail(fmt::format("vn takes 3 numbers, found {}", count));
        check_vertex_limit(out_.normals.size(), "normals");
        out_.normals.push_back({n[0], n[1], n[2]});
    }

    void smoothing(std::string_view rest) {
        const std::string_view word = take_word(rest);
        if (word.empty()) return;  // says nothing, so the group stays
        if (word == "off" || word == "0") {
            smoothing_ = smooth_none;
        } else if (word == "on") {
            smoothing_ = 1;
        } else {
            std::uint32_t value = 0;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (error != std::errc() || end != word.data() + word.size() || value == smooth_by_angle) {
                fail(fmt::format("s takes a group number or off, found '{}'", shown(word)));
            }
            smoothing_ = value;
        }
    }

    /// "7", "-1": to an index from 0. Whether it points at something that exists is asked at the end.
    std::int32_t index(std::string_view digits, std::string_view word, std::size_t so_far) const {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (error == std::errc::result_out_of_range)
            fail(fmt::format("index {} is out of range", shown(digits)));
        if (error != std::errc() || end != digits.data() + digits.size()) {
            fail(fmt::format("'{}' is not a face corner (v, v/vt, v//vn or v/vt/vn)", shown(word)));
        }
        if (value == 0) fail(fmt::format("'{}': index 0; OBJ counts from 1", shown(word)));
        const std::int64_t from_zero = value > 0 ? value - 1 : static_cast<std::int64_t>(so_far) + value;
        if (from_zero < 0 || from_zero > INT32_MAX) {
            fail(fmt::format("'{}': index {} is out of range, there are {} so far", shown(word), value,
                             so_far));
        }
        return static_cast<std::int32_t>(from_zero);
    }

    FaceCorner corner(std::string_view word) const {
        FaceCorner c;
        const std::size_t slash = word.find('/');
        c.position = index(word.substr(0, slash), word, out_.positions.size());
        if (slash == std::string_view::npos) return c;
        const std::string_view tail = word.substr(slash + 1);
        const std::size_t second = tail.find('/');
        const std::string_view uv = tail.substr(0, second);
        if (!uv.empty()) c.uv = index(uv, word, out_.uvs.size());
        if (second == std::string_view::npos) return c;
        const std::string_view normal = tail.substr(second + 1);
        if (!normal.empty()) c.normal = index(normal, word, out_.normals.size());
        return c;
    }

    void face(std::string_view rest) {
        IndexedFace f;
        f.first_corner = static_cast<std::uint32_t>(out_.corners.size());
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            if (++f.corner_count > most_face_corners) {
                fail(fmt::format("a face of more than {} corners", most_face_corners));
            }
            out_.corners.push_back(corner(word));
        }
        if (f.corner_count < 3) fail(fmt::format("a face needs 3 corners or more, found {}", f.corner_count));
        out_.triangles += f.corner_count - 2;
        if (out_.triangles > most_triangles_) {
            throw LimitError(fmt::format("{}:{}: more than {} triangles (limits.triangles)", file_,
                                         lines_.number(), most_triangles_));
        }
        f.material = material_;
        f.object = object_;
        f.smoothing = smoothing_;
        f.line = lines_.number();
        out_.faces.push_back(f);
        group_of_face_.push_back(group_);
    }

    /// Positive indices may point ahead, so that they exist is known only now.
    void check_indices() const {
        const auto check = [&](std::int32_t index, std::size_t count, std::string_view what, int line) {
            if (index < static_cast<std::int64_t>(count)) return;
            throw InputError(file_, line, 0,
                             fmt::format("{} index {} is out of range, the file has {}", what,
                                         static_cast<std::int64_t>(index) + 1, count));
        };
        for (const IndexedFace& f : out_.faces) {
            for (std::uint32_t k = 0; k < f.corner_count; ++k) {
                const FaceCorner& c = out_.corners[f.first_corner + k];
                check(c.position, out_.positions.size(), "position", f.line);
                check(c.uv, out_.uvs.size(), "texture", f.line);
                check(c.normal, out_.normals.size(), "normal", f.line);
            }
        }
    }

    LineReader lines_;
    const std::string& file_;
    const std::int64_t most_triangles_;  ///< corners and vertices are counted in 32 bits
    ObjText out_;
    NameList materials_, objects_, groups_;
    std::vector<std::int32_t> group_of_face_;
    std::int32_t material_ = -1, object_ = -1, group_ = -1;
    std::uint32_t smoothing_ = smooth_by_angle;
};

}  // namespace

ObjText parse_obj_text(std::string_view text, const std::string& file, const Limits& limits) {
    return Parser(text, file, limits).run();
}

}  // namespace obscura
