#include "hierarchy/codes/tree_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "core/mapped_file.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/codes/tree_file_format.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + tree_file_alignment - 1) / tree_file_alignment * tree_file_alignment;
}

/// Bytes from the first unit of one tree to that of the next.
constexpr std::uint64_t extent_of(std::uint64_t unit_bytes) {
    return aligned(unit_bytes + tree_file_slack);
}

constexpr std::uint64_t records_end(std::uint64_t trees) {
    return sizeof(TreeFileHeader) + trees * sizeof(TreeRecord);
}

template <class T>
T read_at(Bytes bytes, std::uint64_t position) {
    T value;
    std::memcpy(&value, bytes.data() + position, sizeof value);
    return value;
}

std::uint64_t checksum_of(TreeFileHeader header, Bytes records) {
    header.checksum = 0;
    return Hasher{}
        .value(bulk_hash(&header, sizeof header))
        .value(bulk_hash(records.data(), records.size()))
        .state;
}

// --- writing -----------------------------------------------------------------------------------------

TreeRecord record_of(const ShadowTree& tree, std::uint64_t first_byte) {
    const LightView& view = tree.view;
    const TreeCode& code = tree.code;
    CHECK(view.width == view.height && view.width == 1 << code.levels, "a tree's view has its texels");
    TreeRecord record;
    std::memcpy(record.to_map, view.to_map.m, sizeof record.to_map);
    record.near_w = view.near_w;
    record.first_byte = first_byte;
    record.bytes = tree.bytes;
    record.padding_bytes = tree.padding_bytes;
    record.full = tree.counts.full;
    record.empty = tree.counts.empty;
    record.leaf = tree.counts.leaf;
    record.content_hash = content_hash(tree);
    record.width = view.width;
    record.height = view.height;
    record.min_depth = view.min_depth;
    record.max_depth = view.max_depth;
    record.perspective = view.perspective ? 1 : 0;
    record.code = static_cast<std::uint32_t>(code.code);
    record.layout = static_cast<std::uint32_t>(code.layout);
    record.levels = code.levels;
    record.top_levels = code.top_levels;
    std::copy(std::begin(code.offset_scale), std::end(code.offset_scale), record.offset_scale);
    return record;
}

template <class T>
std::string_view as_text(const T* data, std::size_t count) {
    return {reinterpret_cast<const char*>(data), count * sizeof(T)};
}

// --- reading -----------------------------------------------------------------------------------------

/// Reads one file's bytes; every doubt is an InputError that names the file.
class Reader {
  public:
    Reader(Bytes bytes, std::shared_ptr<const void> owner, const std::string& name)
        : bytes_(bytes), owner_(std::move(owner)), name_(name) {}

    /// The version, of this kind of file at all.
    std::uint32_t version() const {
        const std::size_t known = std::min(bytes_.size(), sizeof tree_file_magic);
        if (bytes_.empty()) fail("is empty, not a file of shadow trees");
        if (std::memcmp(bytes_.data(), tree_file_magic, known) != 0) fail("is not a file of shadow trees");
        if (bytes_.size() < sizeof(TreeFileHeader)) fail("is cut short");
        return read_at<TreeFileHeader>(bytes_, 0).version;
    }

    /// The header, after which the records are as they were written.
    TreeFileHeader header() const {
        const std::uint32_t other = version();
        const auto header = read_at<TreeFileHeader>(bytes_, 0);
        if (header.byte_order != tree_file_byte_order) fail("was written with another order of bytes");
        if (other != tree_file_version) {
            fail(fmt::format("has version {} of the format; this program reads version {}", other,
                             tree_file_version));
        }
        if (header.file_bytes != bytes_.size()) {
            fail(fmt::format("has {} bytes instead of {}: cut short or altered", bytes_.size(),
                             header.file_bytes));
        }
        const std::uint64_t room = (bytes_.size() - sizeof header) / sizeof(TreeRecord);
        if (header.trees == 0 || header.trees > room) fail("states a number of trees that it cannot hold");
        const Bytes records = bytes_.subspan(sizeof header, header.trees * sizeof(TreeRecord));
        if (checksum_of(header, records) != header.checksum)
            fail("is altered: the header's checksum differs");
        if (header.reserved != 0) fail("has a header that means nothing");
        return header;
    }

    std::vector<ShadowTree> trees(const TreeFileHeader& header) const {
        std::vector<ShadowTree> trees;
        std::uint64_t end = records_end(header.trees);
        for (std::uint32_t i = 0; i < header.trees; ++i) {
            const auto record = read_at<TreeRecord>(bytes_, records_end(i));
            expect_zeros(end, aligned(end));
            if (record.first_byte != aligned(end)) fail(i, "does not begin where it should");
            trees.push_back(tree(i, record));
            end = record.first_byte + record.bytes;
            expect_zeros(end, record.first_byte + extent_of(record.bytes));
            end = record.first_byte + extent_of(record.bytes);
        }
        if (end != bytes_.size()) fail("has bytes that no tree owns");
        return trees;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError(name_, message); }
    [[noreturn]] void fail(std::uint32_t tree, const char* message) const {
        fail(fmt::format("shadow tree {}: {}", tree, message));
    }

    void expect_zeros(std::uint64_t from, std::uint64_t to) const {
        if (to > bytes_.size()) fail("is cut short");
        const Bytes gap = bytes_.subspan(from, to - from);
        if (std::any_of(gap.begin(), gap.end(), [](std::uint8_t b) { return b != 0; }))
            fail("is altered between its trees");
    }

    ShadowTree tree(std::uint32_t i, const TreeRecord& record) const {
        check_record(i, record);
        ShadowTree tree;
        std::memcpy(tree.view.to_map.m, record.to_map, sizeof record.to_map);
        tree.view.near_w = record.near_w;
        tree.view.width = record.width;
        tree.view.height = record.height;
        tree.view.perspective = record.perspective != 0;
        tree.view.min_depth = record.min_depth;
        tree.view.max_depth = record.max_depth;
        tree.counts = {record.full, record.empty, record.leaf};
        tree.bytes = record.bytes;
        tree.padding_bytes = record.padding_bytes;
        tree.bits = owner_;
        tree.code.units = bytes_.data() + record.first_byte;
        tree.code.code = static_cast<ShadowCode>(record.code);
        tree.code.layout = static_cast<TreeLayout>(record.layout);
        tree.code.levels = record.levels;
        std::copy(std::begin(record.offset_scale), std::end(record.offset_scale), tree.code.offset_scale);

        if (content_hash(tree) != record.content_hash) fail(i, "is altered: its checksum differs");
        if (const char* fault = row_of(tree.code.code).fault_of(tree)) fail(i, fault);
        set_top_grid(tree, record.top_levels);
        return tree;
    }

    /// Numbers that only a program gone wrong, or an adversary, can have written under a right checksum.
    void check_record(std::uint32_t i, const TreeRecord& record) const {
        if (find_code(static_cast<ShadowCode>(record.code)) == nullptr) fail(i, "has an unknown code");
        if (record.levels < 0 || record.levels > max_tree_levels) fail(i, "has too many levels");
        if (record.top_levels < 0 || record.top_levels > std::min<int>(record.levels, max_top_levels))
            fail(i, "has too many levels in its top grid");
        if (record.width != 1 << record.levels || record.height != record.width)
            fail(i, "has a view of another size");
        const bool finite = std::all_of(std::begin(record.to_map), std::end(record.to_map),
                                        [](double m) { return std::isfinite(m); }) &&
                            std::isfinite(record.near_w) && std::isfinite(record.min_depth) &&
                            std::isfinite(record.max_depth);
        if (!finite || record.perspective > 1) fail(i, "has a view that means nothing");
        const auto in_range = [](std::uint32_t scale) { return scale <= max_tree_units; };
        if (!std::all_of(std::begin(record.offset_scale), std::end(record.offset_scale), in_range))
            fail(i, "has a scale that is too large");
        const std::uint64_t room = bytes_.size() - record.first_byte;
        if (record.bytes > room || extent_of(record.bytes) > room) fail(i, "is cut short");
    }

    Bytes bytes_;
    std::shared_ptr<const void> owner_;
    const std::string& name_;
};

}  // namespace

std::uint64_t content_hash(const ShadowTree& tree) {
    const TreeCode& code = tree.code;
    Hasher hasher;
    // mh was the only code once: its hashes are without a name.
    if (code.code != ShadowCode::mh) hasher.value(code.code);
    return hasher.value(static_cast<std::uint32_t>(code.layout))
        .value(code.levels)
        .value(code.offset_scale)
        .value(bulk_hash(code.units, static_cast<std::size_t>(tree.bytes)))
        .state;
}

void write_tree_file(const std::filesystem::path& path, std::span<const ShadowTree> trees,
                     const TreeFileKey& key, Existing existing) {
    CHECK(!trees.empty());
    std::vector<TreeRecord> records;
    std::uint64_t end = aligned(records_end(trees.size()));
    for (const ShadowTree& tree : trees) {
        records.push_back(record_of(tree, end));
        end += extent_of(tree.bytes);
    }

    TreeFileHeader header;
    std::copy(std::begin(tree_file_magic), std::end(tree_file_magic), header.magic);
    header.version = tree_file_version;
    header.byte_order = tree_file_byte_order;
    header.key[0] = key.high;
    header.key[1] = key.low;
    header.file_bytes = end;
    header.trees = static_cast<std::uint32_t>(trees.size());
    header.checksum = checksum_of(
        header, {reinterpret_cast<const std::uint8_t*>(records.data()), records.size() * sizeof(TreeRecord)});

    constexpr std::array<char, tree_file_alignment + tree_file_slack> zeros{};
    std::vector<std::string_view> parts{as_text(&header, 1), as_text(records.data(), records.size())};
    std::uint64_t written = records_end(trees.size());
    for (std::size_t i = 0; i <= trees.size(); ++i) {
        const std::uint64_t next = i < trees.size() ? records[i].first_byte : end;
        parts.push_back({zeros.data(), static_cast<std::size_t>(next - written)});
        if (i == trees.size()) break;
        parts.push_back(as_text(trees[i].code.units, static_cast<std::size_t>(trees[i].bytes)));
        written = next + trees[i].bytes;
    }
    write_file_atomically(path, parts, existing);
}

TreeFile read_tree_file(std::span<const std::uint8_t> bytes, std::shared_ptr<const void> owner,
                        const std::string& name) {
    const Reader reader(bytes, std::move(owner), name);
    const TreeFileHeader header = reader.header();
    return {{header.key[0], header.key[1]}, reader.trees(header)};
}

TreeFile read_tree_file(const std::filesystem::path& path) {
    const MappedFile file = map_file(path);
    return read_tree_file(file.bytes, file.owner, path.string());
}

CachedTrees read_cached_trees(const std::filesystem::path& path, const TreeFileKey& key) {
    std::error_code error;
    if (!std::filesystem::exists(path, error) && !error) return {CacheState::absent, {}};
    const MappedFile file = map_file(path);
    const std::string name = path.string();
    const Reader reader(file.bytes, file.owner, name);
    if (reader.version() != tree_file_version) return {CacheState::other_version, {}};
    const TreeFileHeader header = reader.header();
    if (TreeFileKey{header.key[0], header.key[1]} != key) return {CacheState::other_key, {}};
    return {CacheState::usable, reader.trees(header)};
}

}  // namespace obscura
