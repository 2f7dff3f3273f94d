// Files of stacks: what is written is read; what is cut, altered or crafted is refused; what is made from
// something else is told apart.

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "core/error.h"
#include "core/hash.h"
#include "hierarchy/stack/encode.h"
#include "hierarchy/stack/stack_check.h"
#include "hierarchy/stack/stack_file.h"
#include "hierarchy/stack/stack_file_format.h"
#include "tests/core/temporary_folder.h"
#include "tests/stack/stack_scenes.h"

namespace obscura {
namespace {

constexpr TreeFileKey key{0x0123456789abcdefu, 42};

ShadowStack small_stack(StackLayout layout = StackLayout::narrow) {
    const Mesh mesh = lit::scene(1, false);
    StackBuildParams params;
    params.tree.anisotropies = {1};
    ShadowStack stack = build_stack(
        mesh, focused_views(mesh, lit::samples_of(lit::Lamp::tilted, 4), lit::focus(16)), params, Exec{});
    StackEncodeParams encode;
    encode.layout = layout;
    const StackTree tree{stack.code.shape, decode_stack(stack)};
    encode_stack(tree, encode, stack);
    return stack;
}

std::vector<std::uint8_t> file_of(const ShadowStack& stack) {
    const TemporaryFolder folder;
    write_stack_file(folder.path / "stack", stack, key);
    std::ifstream in(folder.path / "stack", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads bytes from a block of exactly their size, and looks everything up. Whether they were accepted.
bool accepted(const std::vector<std::uint8_t>& bytes) {
    struct Aligned {
        explicit Aligned(std::size_t n)
            : data(static_cast<std::uint8_t*>(::operator new (n, std::align_val_t{64}))) {}
        ~Aligned() { ::operator delete (data, std::align_val_t{64}); }
        std::uint8_t* data;
    };
    const auto block = std::make_shared<Aligned>(bytes.size() + 1);
    std::copy(bytes.begin(), bytes.end(), block->data);
    try {
        const StackFile file = read_stack_file({block->data, bytes.size()}, block, "bytes");
        const lit::Points points = lit::ground_points(9, 10);
        const StackLookup lookup = stack_lookup(file.stack, {0, 0, 0});
        for (const Isa isa : {Isa::ref, best_isa()}) {
            StackWork work;
            std::vector<std::uint16_t> lit(points.px.size());
            OBSCURA_DISPATCH(isa, lit_samples, lookup, points.view(), lit.data(), work);
            OBSCURA_DISPATCH(isa, lit_of_subset, lookup, points.view(), lookup.slices, lit.data(), work);
        }
        return true;
    } catch (const InputError&) {
        return false;
    }
}

/// Makes hashes right again.
void seal(std::vector<std::uint8_t>& bytes) {
    StackFileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::uint64_t end = sizeof header + std::uint64_t{header.slices} * sizeof(SliceView);
    if (end > bytes.size()) return;
    ShadowStack stack;
    std::vector<SliceView> slices(header.slices);
    std::memcpy(slices.data(), bytes.data() + sizeof header, slices.size() * sizeof(SliceView));
    stack.slices = std::make_shared<const std::vector<SliceView>>(slices);
    stack.frame = header.frame;
    stack.code.layout = static_cast<StackLayout>(header.layout);
    stack.code.shape = {header.map_levels, header.slice_levels, header.anisotropy};
    std::copy(std::begin(header.offset_scale), std::end(header.offset_scale), stack.code.offset_scale);
    const std::uint64_t first = (end + 63) / 64 * 64;
    if (first <= bytes.size() && header.bytes <= bytes.size() - first) {
        std::vector<std::uint32_t> words(header.bytes / 4 + 1);
        std::memcpy(words.data(), bytes.data() + first, header.bytes);
        stack.code.words = words.data();
        stack.bytes = header.bytes;
        header.content_hash = content_hash(stack);
    }
    header.file_bytes = bytes.size();
    header.checksum = 0;
    header.checksum = Hasher{}
                          .value(bulk_hash(&header, sizeof header))
                          .value(bulk_hash(slices.data(), slices.size() * sizeof(SliceView)))
                          .state;
    std::memcpy(bytes.data(), &header, sizeof header);
}

TEST(StackFile, GivesBackWhatWasWritten) {
    const TemporaryFolder folder;
    for (const StackLayout layout : {StackLayout::narrow, StackLayout::wide}) {
        const ShadowStack stack = small_stack(layout);
        write_stack_file(folder.path / "stack", stack, key);
        const StackFile file = read_stack_file(folder.path / "stack");
        std::filesystem::remove(folder.path / "stack");
        EXPECT_EQ(file.key, key);
        EXPECT_EQ(content_hash(file.stack), content_hash(stack));
        EXPECT_EQ(file.stack.frame, stack.frame);
        EXPECT_EQ(*file.stack.slices, *stack.slices);
        EXPECT_EQ(file.stack.counts, stack.counts);
        EXPECT_EQ(file.stack.bytes, stack.bytes);
        EXPECT_EQ(file.stack.padding_bytes, stack.padding_bytes);
        const lit::Points points = lit::ground_points(40, 12);
        EXPECT_EQ(visible_share(stack_lookup(file.stack, {0, 0, 0}), points.view(), 0, Exec{}),
                  visible_share(stack_lookup(stack, {0, 0, 0}), points.view(), 0, Exec{}));
    }
}

TEST(StackFile, TellsWhatIsNotUsable) {
    const TemporaryFolder folder;
    const auto path = folder.path / "stack";
    EXPECT_EQ(read_cached_stack(path, key).state, CacheState::absent);
    write_stack_file(path, small_stack(), key);
    EXPECT_EQ(read_cached_stack(path, key).state, CacheState::usable);
    EXPECT_EQ(read_cached_stack(path, {1, 2}).state, CacheState::other_key);
    EXPECT_FALSE(read_cached_stack(path, {1, 2}).stack.has_value());
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).seekp(8).put(9);
    EXPECT_EQ(read_cached_stack(path, key).state, CacheState::other_version);
    EXPECT_THROW(read_stack_file(path), InputError);
    EXPECT_THROW(read_stack_file(folder.path / "none"), InputError);
}

TEST(StackFile, EveryAlteredByteIsRefused) {
    const std::vector<std::uint8_t> bytes = file_of(small_stack());
    ASSERT_TRUE(accepted(bytes));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::vector<std::uint8_t> altered = bytes;
        altered[i] ^= static_cast<std::uint8_t>(1u << (i % 8));
        EXPECT_FALSE(accepted(altered)) << i;
    }
    for (std::size_t size = 0; size < bytes.size(); size += 13)
        EXPECT_FALSE(accepted({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
}

/// Under right hashes: accepted or refused, but no lookup leads outside (sanitizers watch), and the walk
/// ends.
TEST(StackFile, NothingCraftedLeadsOutside) {
    for (const StackLayout layout : {StackLayout::narrow, StackLayout::wide}) {
        const std::vector<std::uint8_t> bytes = file_of(small_stack(layout));
        std::mt19937 rng(1);
        int refused = 0, taken = 0;
        for (int round = 0; round < 3000; ++round) {
            std::vector<std::uint8_t> crafted = bytes;
            const std::size_t from = round % 3 == 0 ? 24 : sizeof(StackFileHeader);
            for (int n = 0; n <= round % 3; ++n)
                crafted[from + rng() % (bytes.size() - from)] = static_cast<std::uint8_t>(rng());
            seal(crafted);
            ++(accepted(crafted) ? taken : refused);
        }
        EXPECT_GT(refused, 300);
        EXPECT_GT(taken, 100) << "values and views may be others";
    }
}

TEST(StackFile, FaultsAreNamed) {
    ShadowStack stack = small_stack();
    std::vector<std::uint32_t> words(stack.code.words, stack.code.words + stack.bytes / 4);
    stack.code.words = words.data();
    EXPECT_EQ(fault_of(stack.code, words.size(), stack.counts), nullptr);
    const std::uint32_t root = words[0];
    words[0] = root | 0xff00u;
    EXPECT_STREQ(fault_of(stack.code, words.size(), stack.counts), "a child on an axis that is not divided");
    words[0] = root & 0xffffu;
    EXPECT_STREQ(fault_of(stack.code, words.size(), stack.counts), "children do not follow their parent");
    words[0] = root | 0xffff0000u;
    EXPECT_STREQ(fault_of(stack.code, words.size(), stack.counts), "children lie outside the octree");
    words[0] = root;
    words[1] = 0x40000000u;
    EXPECT_STREQ(fault_of(stack.code, words.size(), stack.counts), "a value is not a depth in [0, 1]");
    EXPECT_STREQ(fault_of(StackShape{4, 2, 5}), "an anisotropy that its maps have no room for");
    EXPECT_STREQ(fault_of(StackShape{16, 10, 12}), "too many levels");
}

}  // namespace
}  // namespace obscura
