#include "hierarchy/terrain/far_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/hash.h"
#include "core/mapped_file.h"
#include "hierarchy/terrain/far_file_format.h"

namespace obscura {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + far_file_alignment - 1) / far_file_alignment * far_file_alignment;
}

std::uint64_t index_end(const FarFileHeader& h) {
    return sizeof(FarFileHeader) + h.suns * sizeof(FarFileSun) + h.units * sizeof(FarUnit);
}

/// Of the header and all up to the units' bytes.
std::uint64_t checksum_of(FarFileHeader header, Bytes index) {
    header.checksum = 0;
    return Hasher{}
        .value(bulk_hash(&header, sizeof header))
        .value(bulk_hash(index.data(), index.size()))
        .state;
}

FarFileSun stored(const FarSun& s) {
    return {s.hour_h,
            s.hours,
            s.azimuth_deg,
            s.elevation_deg,
            s.direction.slope_q20,
            s.direction.rise_q36,
            s.direction.lines_are_columns ? 1 : 0,
            s.direction.step_line,
            s.direction.step_along,
            0};
}

/// Reads one file's bytes; every doubt is an InputError that names the file.
class Reader {
  public:
    Reader(Bytes bytes, std::shared_ptr<const void> owner, const std::string& name)
        : bytes_(bytes), owner_(std::move(owner)), name_(name) {}

    FarFile read() const {
        const FarFileHeader h = header();
        FarFile file{{h.key[0], h.key[1]}, {}};
        FarDay& day = file.day;
        day.grid = {h.width, h.height, h.cell_x_m, h.cell_y_m, static_cast<Diagonal>(h.diagonal)};
        day.params = {h.threshold, h.tile_side, h.suns_per_unit};
        take_suns(h, day);
        const std::uint64_t groups =
            (h.suns + std::uint64_t(h.suns_per_unit) - 1) / std::uint64_t(h.suns_per_unit);
        const std::uint64_t tiles = std::uint64_t(day.tiles_x()) * std::uint64_t(day.tiles_y());
        if (tiles * groups != h.units) fail("states another number of units than it has tiles and suns");
        take_units(h, day);
        return file;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError(name_, message); }

    FarFileHeader header() const {
        const std::size_t known = std::min(bytes_.size(), sizeof far_file_magic);
        if (bytes_.empty()) fail("is empty, not a file of far shadows");
        if (std::memcmp(bytes_.data(), far_file_magic, known) != 0) fail("is not a file of far shadows");
        if (bytes_.size() < sizeof(FarFileHeader)) fail("is cut short");
        FarFileHeader h;
        std::memcpy(&h, bytes_.data(), sizeof h);
        if (h.byte_order != far_file_byte_order) fail("was written with another order of bytes");
        if (h.version != far_file_version) {
            fail(fmt::format("has version {} of the format; this program reads version {}", h.version,
                             far_file_version));
        }
        if (h.file_bytes != bytes_.size()) {
            fail(
                fmt::format("has {} bytes instead of {}: cut short or altered", bytes_.size(), h.file_bytes));
        }
        const std::uint64_t first = aligned(index_end(h));
        if (first > bytes_.size() || h.unit_bytes != bytes_.size() - first)
            fail("has another size than its parts");
        if (checksum_of(h, bytes_.subspan(sizeof h, first - sizeof h)) != h.checksum)
            fail("is altered: the checksum of its index differs");
        check_numbers(h);
        return h;
    }

    /// Numbers that only a program gone wrong, or an adversary, can have written under a right checksum.
    void check_numbers(const FarFileHeader& h) const {
        const auto side = [](std::int32_t n) { return n >= 1 && n <= largest_height_field_side; };
        const auto size = [](double m) { return std::isfinite(m) && m > 0; };
        if (!side(h.width) || !side(h.height) || !size(h.cell_x_m) || !size(h.cell_y_m) || h.diagonal > 1)
            fail("has a grid that means nothing");
        if (h.threshold < 1 || h.tile_side < 64 || h.tile_side > largest_far_tile_side ||
            h.tile_side % 64 != 0 || h.suns_per_unit < 1 || h.suns_per_unit > 64)
            fail("has tiles that mean nothing");
    }

    void take_suns(const FarFileHeader& h, FarDay& day) const {
        for (std::uint32_t i = 0; i < h.suns; ++i) {
            FarFileSun s;
            std::memcpy(&s, bytes_.data() + sizeof h + i * sizeof s, sizeof s);
            const auto sign = [](std::int32_t v) { return v == 1 || v == -1; };
            const bool sound =
                std::isfinite(s.hour_h) && std::isfinite(s.hours) && std::isfinite(s.azimuth_deg) &&
                std::isfinite(s.elevation_deg) && s.slope_q20 >= 0 && s.slope_q20 <= cell_q20 &&
                s.rise_q36 >= 1 && s.rise_q36 <= std::int64_t{1} << 53 && s.lines_are_columns >= 0 &&
                s.lines_are_columns <= 1 && sign(s.step_line) && sign(s.step_along) && s.padding == 0;
            if (!sound) fail(fmt::format("has a sun that means nothing, number {}", i));
            day.suns.push_back({s.hour_h,
                                s.hours,
                                s.azimuth_deg,
                                s.elevation_deg,
                                {s.lines_are_columns == 1, static_cast<std::int8_t>(s.step_line),
                                 static_cast<std::int8_t>(s.step_along), s.slope_q20, s.rise_q36}});
        }
    }

    void take_units(const FarFileHeader& h, FarDay& day) const {
        day.units.resize(h.units);
        std::memcpy(day.units.data(), bytes_.data() + sizeof h + h.suns * sizeof(FarFileSun),
                    h.units * sizeof(FarUnit));
        std::uint64_t offset = 0;
        for (const FarUnit& unit : day.units) {
            if (unit.offset != offset || unit.bytes > h.unit_bytes - offset)
                fail("has units that do not follow each other");
            offset += unit.bytes;
        }
        if (offset != h.unit_bytes) fail("has more bytes than its units");
        day.bytes = bytes_.subspan(aligned(index_end(h)));
        day.owner = owner_;
    }

    Bytes bytes_;
    std::shared_ptr<const void> owner_;
    const std::string& name_;
};

void append(std::vector<std::uint8_t>& to, const void* data, std::size_t bytes) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    to.insert(to.end(), from, from + bytes);
}

std::string_view as_text(const void* data, std::size_t bytes) {
    return {static_cast<const char*>(data), bytes};
}

}  // namespace

void write_far_file(const std::filesystem::path& path, const FarDay& day, const TreeFileKey& key,
                    Existing existing) {
    FarFileHeader h;
    std::copy(std::begin(far_file_magic), std::end(far_file_magic), h.magic);
    h.version = far_file_version;
    h.byte_order = far_file_byte_order;
    h.key[0] = key.high;
    h.key[1] = key.low;
    h.unit_bytes = day.bytes.size();
    h.cell_x_m = day.grid.cell_x_m;
    h.cell_y_m = day.grid.cell_y_m;
    h.width = day.grid.width;
    h.height = day.grid.height;
    h.diagonal = static_cast<std::uint32_t>(day.grid.diagonal);
    h.threshold = day.params.threshold;
    h.tile_side = day.params.tile_side;
    h.suns_per_unit = day.params.suns_per_unit;
    h.suns = static_cast<std::uint32_t>(day.suns.size());
    h.units = static_cast<std::uint32_t>(day.units.size());
    const std::uint64_t first = aligned(index_end(h));
    h.file_bytes = first + h.unit_bytes;

    std::vector<std::uint8_t> index;
    for (const FarSun& sun : day.suns) {
        const FarFileSun s = stored(sun);
        append(index, &s, sizeof s);
    }
    append(index, day.units.data(), day.units.size() * sizeof(FarUnit));
    index.resize(first - sizeof h);
    h.checksum = checksum_of(h, index);
    write_file_atomically(
        path,
        std::vector<std::string_view>{as_text(&h, sizeof h), as_text(index.data(), index.size()),
                                      as_text(day.bytes.data(), day.bytes.size())},
        existing);
}

FarFile read_far_file(std::span<const std::uint8_t> bytes, std::shared_ptr<const void> owner,
                      const std::string& name) {
    return Reader(bytes, std::move(owner), name).read();
}

FarFile read_far_file(const std::filesystem::path& path) {
    const MappedFile file = map_file(path);
    const std::string name = path.string();
    return read_far_file(file.bytes, file.owner, name);
}

}  // namespace obscura
