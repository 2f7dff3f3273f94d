#include "hierarchy/stack/stack_file.h"

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
#include "hierarchy/stack/stack_check.h"
#include "hierarchy/stack/stack_file_format.h"
#include "hierarchy/stack/stack_units.h"

namespace obscura {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t aligned(std::uint64_t bytes) {
    return (bytes + stack_file_alignment - 1) / stack_file_alignment * stack_file_alignment;
}

constexpr std::uint64_t slices_end(std::uint64_t slices) {
    return sizeof(StackFileHeader) + slices * sizeof(SliceView);
}

std::uint64_t checksum_of(StackFileHeader header, const void* slices) {
    header.checksum = 0;
    return Hasher{}
        .value(bulk_hash(&header, sizeof header))
        .value(bulk_hash(slices, header.slices * sizeof(SliceView)))
        .state;
}

StackFileHeader header_of(const ShadowStack& stack, const TreeFileKey& key) {
    StackFileHeader header;
    std::copy(std::begin(stack_file_magic), std::end(stack_file_magic), header.magic);
    header.version = stack_file_version;
    header.byte_order = stack_file_byte_order;
    header.key[0] = key.high;
    header.key[1] = key.low;
    header.bytes = stack.bytes;
    header.padding_bytes = stack.padding_bytes;
    header.full = stack.counts.full;
    header.empty = stack.counts.empty;
    header.leaf = stack.counts.leaf;
    header.content_hash = content_hash(stack);
    header.frame = stack.frame;
    header.map_levels = stack.code.shape.map_levels;
    header.slice_levels = stack.code.shape.slice_levels;
    header.anisotropy = stack.code.shape.anisotropy;
    header.slices = static_cast<std::uint32_t>(stack.slices->size());
    header.layout = static_cast<std::uint32_t>(stack.code.layout);
    std::copy(std::begin(stack.code.offset_scale), std::end(stack.code.offset_scale), header.offset_scale);
    header.file_bytes = aligned(aligned(slices_end(header.slices)) + header.bytes);
    header.checksum = checksum_of(header, stack.slices->data());
    return header;
}

bool all_finite(const StackFrame& f) {
    for (const auto* row : {&f.a, &f.b, &f.h}) {
        if (!std::all_of(std::begin(*row), std::end(*row), [](double v) { return std::isfinite(v); }))
            return false;
    }
    return std::isfinite(f.depth_top) && std::isfinite(f.depth_per_m) && std::fabs(f.near_h) <= 3e38;
}

/// Reads one file's bytes; every doubt is an InputError that names the file.
class Reader {
  public:
    Reader(Bytes bytes, std::shared_ptr<const void> owner, const std::string& name)
        : bytes_(bytes), owner_(std::move(owner)), name_(name) {}

    /// The version, of this kind of file at all.
    std::uint32_t version() const {
        const std::size_t known = std::min(bytes_.size(), sizeof stack_file_magic);
        if (bytes_.empty()) fail("is empty, not a file of a stack of shadow maps");
        if (std::memcmp(bytes_.data(), stack_file_magic, known) != 0)
            fail("is not a file of a stack of shadow maps");
        if (bytes_.size() < sizeof(StackFileHeader)) fail("is cut short");
        return read_header().version;
    }

    /// The header, after which it and the slices are as they were written.
    StackFileHeader header() const {
        const std::uint32_t other = version();
        const StackFileHeader header = read_header();
        if (header.byte_order != stack_file_byte_order) fail("was written with another order of bytes");
        if (other != stack_file_version) {
            fail(fmt::format("has version {} of the format; this program reads version {}", other,
                             stack_file_version));
        }
        if (header.file_bytes != bytes_.size()) {
            fail(fmt::format("has {} bytes instead of {}: cut short or altered", bytes_.size(),
                             header.file_bytes));
        }
        if (header.slices == 0 || slices_end(header.slices) > bytes_.size())
            fail("states a number of maps that it cannot hold");
        if (checksum_of(header, bytes_.data() + sizeof header) != header.checksum)
            fail("is altered: the header's checksum differs");
        return header;
    }

    ShadowStack stack(const StackFileHeader& header) const {
        const std::uint64_t first = check_header(header), end = first + header.bytes;
        expect_zeros(slices_end(header.slices), first);
        expect_zeros(end, bytes_.size());
        ShadowStack stack;
        stack.frame = header.frame;
        stack.code.shape = {header.map_levels, header.slice_levels, header.anisotropy};
        stack.code.layout = static_cast<StackLayout>(header.layout);
        stack.code.words = reinterpret_cast<const std::uint32_t*>(bytes_.data() + first);
        std::copy(std::begin(header.offset_scale), std::end(header.offset_scale), stack.code.offset_scale);
        stack.counts = {header.full, header.empty, header.leaf};
        stack.bytes = header.bytes;
        stack.padding_bytes = header.padding_bytes;
        stack.bits = owner_;
        take_slices(header, stack);

        if (content_hash(stack) != header.content_hash) fail("is altered: its checksum differs");
        const std::uint64_t words = header.bytes / sizeof(std::uint32_t);
        if (const char* fault = fault_of(stack.code, words, stack.counts)) fail(fault);
        // Counts are true now, so nothing overflows here.
        const std::uint64_t padding = words - node_units(stack.code.layout, stack.counts);
        if (padding * sizeof(std::uint32_t) != header.padding_bytes) fail("has other padding than stated");
        return stack;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError(name_, message); }

    StackFileHeader read_header() const {
        StackFileHeader header;
        std::memcpy(&header, bytes_.data(), sizeof header);
        return header;
    }

    void expect_zeros(std::uint64_t from, std::uint64_t to) const {
        const Bytes gap = bytes_.subspan(from, to - from);
        if (std::any_of(gap.begin(), gap.end(), [](std::uint8_t b) { return b != 0; }))
            fail("is altered between its parts");
    }

    /// Numbers that only a program gone wrong, or an adversary, can have written under a right checksum.
    /// Returns where the octree begins.
    std::uint64_t check_header(const StackFileHeader& header) const {
        const StackShape shape{header.map_levels, header.slice_levels, header.anisotropy};
        if (const char* fault = fault_of(shape)) fail(fmt::format("has {}", fault));
        if (header.layout > static_cast<std::uint32_t>(StackLayout::wide)) fail("has an unknown layout");
        if (header.slices > 1u << header.slice_levels) fail("has more maps than its octree");
        if (!all_finite(header.frame)) fail("has views that mean nothing");
        for (const std::uint32_t scale : header.offset_scale) {
            if (scale > max_tree_units) fail("has a scale that is too large");
        }
        if (header.bytes % sizeof(std::uint32_t) != 0) fail("ends within a word");
        const std::uint64_t first = aligned(slices_end(header.slices));
        if (first > bytes_.size() || header.bytes > bytes_.size() - first ||
            aligned(first + header.bytes) != bytes_.size())
            fail("has another size than its parts");
        return first;
    }

    void take_slices(const StackFileHeader& header, ShadowStack& stack) const {
        std::vector<SliceView> slices(header.slices);
        std::memcpy(slices.data(), bytes_.data() + sizeof header, slices.size() * sizeof(SliceView));
        for (const SliceView& s : slices) {
            if (!std::isfinite(s.sigma_x) || !std::isfinite(s.sigma_y) || !std::isfinite(s.tau) || s.tau < 0)
                fail("has views that mean nothing");
        }
        stack.ranges =
            std::make_shared<const std::vector<SliceRange>>(slice_ranges(slices, header.slice_levels));
        stack.slices = std::make_shared<const std::vector<SliceView>>(std::move(slices));
    }

    Bytes bytes_;
    std::shared_ptr<const void> owner_;
    const std::string& name_;
};

std::string_view as_text(const void* data, std::size_t bytes) {
    return {static_cast<const char*>(data), bytes};
}

}  // namespace

std::uint64_t content_hash(const ShadowStack& stack) {
    return Hasher{}
        .value(stack.frame)
        .values(*stack.slices)
        .value(static_cast<std::uint32_t>(stack.code.layout))
        .value(stack.code.shape)
        .value(stack.code.offset_scale)
        .value(bulk_hash(stack.code.words, static_cast<std::size_t>(stack.bytes)))
        .state;
}

void write_stack_file(const std::filesystem::path& path, const ShadowStack& stack, const TreeFileKey& key,
                      Existing existing) {
    const StackFileHeader header = header_of(stack, key);
    constexpr std::array<char, stack_file_alignment> zeros{};
    const std::uint64_t end = slices_end(header.slices), first = aligned(end);
    write_file_atomically(
        path,
        std::vector<std::string_view>{
            as_text(&header, sizeof header),
            as_text(stack.slices->data(), stack.slices->size() * sizeof(SliceView)),
            as_text(zeros.data(), static_cast<std::size_t>(first - end)),
            as_text(stack.code.words, static_cast<std::size_t>(stack.bytes)),
            as_text(zeros.data(), static_cast<std::size_t>(header.file_bytes - first - stack.bytes))},
        existing);
}

StackFile read_stack_file(std::span<const std::uint8_t> bytes, std::shared_ptr<const void> owner,
                          const std::string& name) {
    const Reader reader(bytes, std::move(owner), name);
    const StackFileHeader header = reader.header();
    return {{header.key[0], header.key[1]}, reader.stack(header)};
}

StackFile read_stack_file(const std::filesystem::path& path) {
    const MappedFile file = map_file(path);
    return read_stack_file(file.bytes, file.owner, path.string());
}

CachedStack read_cached_stack(const std::filesystem::path& path, const TreeFileKey& key) {
    std::error_code error;
    if (!std::filesystem::exists(path, error) && !error) return {CacheState::absent, {}};
    const MappedFile file = map_file(path);
    const std::string name = path.string();
    const Reader reader(file.bytes, file.owner, name);
    if (reader.version() != stack_file_version) return {CacheState::other_version, {}};
    const StackFileHeader header = reader.header();
    if (TreeFileKey{header.key[0], header.key[1]} != key) return {CacheState::other_key, {}};
    return {CacheState::usable, reader.stack(header)};
}

}  // namespace obscura
