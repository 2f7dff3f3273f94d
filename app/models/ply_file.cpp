#include "app/models/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "app/models/faces_mesh.h"
#include "app/models/file_access.h"
#include "app/models/ply_header.h"
#include "app/models/text_lines.h"
#include "core/count_text.h"
#include "core/error.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little);

struct IntegerRange {
    double low, high;
};

std::optional<IntegerRange> integers_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
            return IntegerRange{-128, 127};
        case PlyType::uint8:
            return IntegerRange{0, 255};
        case PlyType::int16:
            return IntegerRange{-32768, 32767};
        case PlyType::uint16:
            return IntegerRange{0, 65535};
        case PlyType::int32:
            return IntegerRange{-2147483648.0, 2147483647.0};
        case PlyType::uint32:
            return IntegerRange{0, 4294967295.0};
        case PlyType::float32:
        case PlyType::float64:
            return {};
    }
    return {};
}

/// Values in the order of the file, and where they stand for messages: a line of a text, or an element.
class ValueReader {
  public:
    ValueReader(std::string_view bytes, const PlyHeader& header, const std::string& file)
        : body_(bytes.substr(header.body)), format_(header.format), file_(file), line_(header.lines) {}

    void begin_row(const PlyElement& element, std::int64_t row) {
        element_ = &element;
        row_ = row;
        if (format_ != PlyFormat::ascii) return;
        do {
            if (body_.empty()) fail("the file ends");
            const std::size_t end = std::min(body_.find_first_of("\r\n"), body_.size());
            text_ = trimmed(body_.substr(0, end));
            body_.remove_prefix(std::min(end + (body_.substr(end, 2) == "\r\n" ? 2 : 1), body_.size()));
            ++line_;
        } while (text_.empty());
    }

    void end_row() const {
        if (format_ == PlyFormat::ascii && !text_.empty())
            fail(fmt::format("'{}' is more than the header announces", shown(text_)));
    }

    double next(PlyType type) { return format_ == PlyFormat::ascii ? next_word(type) : next_bytes(type); }

    /// Skips a value that is not read, which may be anything.
    void skip(PlyType type) {
        if (format_ == PlyFormat::ascii)
            take_word();
        else
            next_bytes(type);
    }

    bool words_left() const { return body_.find_first_not_of(" \t\r\n") != std::string_view::npos; }
    std::size_t bytes_left() const { return body_.size(); }

    [[noreturn]] void fail(const std::string& message) const {
        if (format_ == PlyFormat::ascii) throw InputError(file_, line_, 0, message);
        throw InputError(file_, fmt::format("{} {}: {}", element_->name, row_, message));
    }

  private:
    std::string_view take_word() {
        const std::size_t end = std::min(text_.find_first_of(" \t"), text_.size());
        const std::string_view word = text_.substr(0, end);
        if (word.empty()) fail("the line has fewer values than the header announces");
        text_ = trimmed(text_.substr(end));
        return word;
    }

    double next_word(PlyType type) {
        const std::string_view word = take_word();
        const double value = parse_number(word, {file_, line_});
        if (const auto range = integers_of(type);
            range && !(value >= range->low && value <= range->high && value == std::floor(value)))
            fail(fmt::format("'{}' is no integer of the property's type", shown(word)));
        return value;
    }

    template <class T>
    T raw() {
        if (body_.size() < sizeof(T)) fail("the file ends");
        char bytes[sizeof(T)];
        std::memcpy(bytes, body_.data(), sizeof(T));
        body_.remove_prefix(sizeof(T));
        if (format_ == PlyFormat::big_endian) std::reverse(bytes, bytes + sizeof(T));
        return std::bit_cast<T>(bytes);
    }

    double next_bytes(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return raw<std::int8_t>();
            case PlyType::uint8:
                return raw<std::uint8_t>();
            case PlyType::int16:
                return raw<std::int16_t>();
            case PlyType::uint16:
                return raw<std::uint16_t>();
            case PlyType::int32:
                return raw<std::int32_t>();
            case PlyType::uint32:
                return raw<std::uint32_t>();
            case PlyType::float32:
                return static_cast<double>(raw<float>());
            case PlyType::float64:
                return raw<double>();
        }
        return 0;
    }

    std::string_view body_, text_;
    PlyFormat format_;
    const std::string& file_;
    int line_;
    const PlyElement* element_ = nullptr;
    std::int64_t row_ = 0;
};

/// What a vertex's property is.
enum class VertexPart { x, y, z, nx, ny, nz, u, v, other };
constexpr int vertex_parts = 8;

VertexPart part_of(const PlyProperty& p) {
    constexpr std::pair<std::string_view, VertexPart> names[] = {
        {"x", VertexPart::x},   {"y", VertexPart::y},         {"z", VertexPart::z},
        {"nx", VertexPart::nx}, {"ny", VertexPart::ny},       {"nz", VertexPart::nz},
        {"u", VertexPart::u},   {"v", VertexPart::v},         {"s", VertexPart::u},
        {"t", VertexPart::v},   {"texture_u", VertexPart::u}, {"texture_v", VertexPart::v},
    };
    if (p.is_list) return VertexPart::other;
    for (const auto& [name, part] : names)
        if (p.name == name) return part;
    return VertexPart::other;
}

class PlyReader {
  public:
    PlyReader(std::string_view bytes, const std::string& file, const Limits& limits)
        : header_(parse_ply_header(bytes, file)),
          values_(bytes, header_, file),
          file_(file),
          limits_(limits) {}

    IndexedFaces run() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face") {
                read_faces(element);
            } else {
                skip_element(element);
            }
        }
        check_indices();
        for (const std::string& texture : header_.textures)
            notes.push_back(fmt::format("{}: texture '{}' of a comment is not read", file_, shown(texture)));
        if (header_.format != PlyFormat::ascii && values_.bytes_left() > 0) {
            notes.push_back(fmt::format("{}: {} after the last element are not read", file_,
                                        count_text(values_.bytes_left(), "byte")));
        }
        if (header_.format == PlyFormat::ascii && values_.words_left())
            notes.push_back(fmt::format("{}: lines after the last element are not read", file_));
        return std::move(out_);
    }

    std::vector<std::string> notes;

  private:
    void skip(const PlyProperty& p) {
        const auto count = p.is_list ? length(p) : 1;
        for (std::int64_t i = 0; i < count; ++i)
            values_.skip(p.type);
    }

    std::int64_t length(const PlyProperty& p) {
        const double count = values_.next(p.count_type);
        if (count < 0) values_.fail(fmt::format("{} is no length of a list", count));
        return static_cast<std::int64_t>(count);
    }

    void note_property(const PlyElement& element, const PlyProperty& p) {
        notes.push_back(fmt::format("{}: property '{}' of element '{}' is not read", file_, shown(p.name),
                                    shown(element.name)));
    }

    void skip_element(const PlyElement& element) {
        if (element.count == 0) return;
        if (element.name == "tristrips") {
            throw InputError(file_, element.line, 0,
                             "triangle strips are not read; write the model as faces");
        }
        notes.push_back(fmt::format("{}: {} '{}' {} not read", file_, count_text(element.count, "element"),
                                    shown(element.name), element.count == 1 ? "is" : "are"));
        for (std::int64_t row = 0; row < element.count; ++row) {
            values_.begin_row(element, row);
            for (const PlyProperty& p : element.properties)
                skip(p);
            values_.end_row();
        }
    }

    void read_vertices(const PlyElement& element) {
        if (element.count > most_vertices(limits_)) {
            throw LimitError(fmt::format("{}: has {} vertices, more than three times limits.triangles = {}",
                                         file_, element.count, limits_.triangles));
        }
        bool has[vertex_parts] = {};
        for (const PlyProperty& p : element.properties)
            if (part_of(p) != VertexPart::other) has[static_cast<int>(part_of(p))] = true;
        const bool normals = has[3] && has[4] && has[5], uvs = has[6] && has[7];
        std::vector<VertexPart> parts;
        bool seen[vertex_parts] = {};
        for (const PlyProperty& p : element.properties) {
            VertexPart part = part_of(p);
            const int k = static_cast<int>(part);
            // Of two names for one thing the first counts; of a normal or a place in a texture all or
            // nothing.
            if (part != VertexPart::other && (seen[k] || (k >= 3 && k < 6 && !normals) || (k >= 6 && !uvs)))
                part = VertexPart::other;
            if (part == VertexPart::other)
                note_property(element, p);
            else
                seen[k] = true;
            parts.push_back(part);
        }
        for (int k = 0; k < 3; ++k) {
            if (!has[k]) {
                throw InputError(file_, element.line, 0,
                                 fmt::format("vertices have no property '{}'", "xyz"[k]));
            }
        }
        for (std::int64_t row = 0; row < element.count; ++row) {
            values_.begin_row(element, row);
            double value[vertex_parts + 1] = {};
            for (std::size_t k = 0; k < parts.size(); ++k) {
                if (parts[k] == VertexPart::other)
                    skip(element.properties[k]);
                else
                    value[static_cast<int>(parts[k])] = number(element.properties[k]);
            }
            values_.end_row();
            out_.positions.push_back({value[0], value[1], value[2]});
            if (normals) out_.normals.push_back(to_float(Vec3d{value[3], value[4], value[5]}));
            if (uvs) out_.uvs.push_back({static_cast<float>(value[6]), static_cast<float>(value[7])});
        }
    }

    double number(const PlyProperty& p) {
        const double value = values_.next(p.type);
        if (!(std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
            values_.fail(
                fmt::format("property '{}' is no finite number within the range of floats", shown(p.name)));
        return value;
    }

    void read_faces(const PlyElement& element) {
        const PlyProperty* list = nullptr;
        for (const PlyProperty& p : element.properties) {
            const bool is_corners = p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
            if (is_corners && list == nullptr)
                list = &p;
            else
                note_property(element, p);
        }
        if (list == nullptr && element.count > 0)
            throw InputError(file_, element.line, 0, "faces have no list 'vertex_indices'");
        for (std::int64_t row = 0; row < element.count; ++row) {
            values_.begin_row(element, row);
            for (const PlyProperty& p : element.properties) {
                if (&p == list)
                    read_face(p, row);
                else
                    skip(p);
            }
            values_.end_row();
        }
    }

    void read_face(const PlyProperty& p, std::int64_t row) {
        const std::int64_t corners = length(p);
        if (corners < 3) values_.fail(fmt::format("a face of {}", count_text(corners, "corner")));
        if (corners > most_face_corners)
            values_.fail(fmt::format("a face of more than {} corners", most_face_corners));
        out_.triangles += corners - 2;
        if (out_.triangles > most_triangles(limits_)) {
            throw LimitError(
                fmt::format("{}: has more than limits.triangles = {} triangles", file_, limits_.triangles));
        }
        IndexedFace face;
        face.first_corner = static_cast<std::uint32_t>(out_.corners.size());
        face.corner_count = static_cast<std::uint32_t>(corners);
        face.line = static_cast<std::int32_t>(row);
        for (std::int64_t k = 0; k < corners; ++k) {
            const double index = values_.next(p.type);
            if (!(index >= 0 && index <= std::numeric_limits<std::int32_t>::max() &&
                  index == std::floor(index)))
                values_.fail(fmt::format("{} is no index of a vertex", index));
            const auto at = static_cast<std::int32_t>(index);
            out_.corners.push_back({at, at, at});
        }
        out_.faces.push_back(face);
    }

    /// Vertices may follow the faces.
    void check_indices() {
        const auto vertices = static_cast<std::int64_t>(out_.positions.size());
        for (const IndexedFace& face : out_.faces) {
            for (std::uint32_t k = 0; k < face.corner_count; ++k) {
                FaceCorner& corner = out_.corners[face.first_corner + k];
                if (corner.position >= vertices) {
                    throw InputError(file_, fmt::format("face {}: there is no vertex {}, the last is {}",
                                                        face.line, corner.position, vertices - 1));
                }
                if (out_.normals.empty()) corner.normal = -1;
                if (out_.uvs.empty()) corner.uv = -1;
            }
        }
    }

    PlyHeader header_;
    ValueReader values_;
    const std::string& file_;
    const Limits& limits_;
    IndexedFaces out_;
};

}  // namespace

Model ply_from_bytes(std::string_view bytes, const std::string& file, const Limits& limits,
                     const ModelOptions& options) {
    PlyReader reader(bytes, file, limits);
    const IndexedFaces faces = reader.run();
    Model model = model_of_faces(faces, file, options.crease_angle_deg);
    model.notes.insert(model.notes.begin(), reader.notes.begin(), reader.notes.end());
    keep_few(model.notes, file);
    return model;
}

Model load_ply(const std::filesystem::path& file, const Limits& limits, const ModelOptions& options) {
    return ply_from_bytes(read_model_bytes(file, limits), file.string(), limits, options);
}

}  // namespace obscura
