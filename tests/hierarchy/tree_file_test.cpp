// Files of shadow trees: what is written is read; what is cut, altered, foreign or crafted is refused; what
// is merely made from something else is told apart.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "core/error.h"
#include "core/hash.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/codes/tree_file.h"
#include "hierarchy/codes/tree_file_format.h"
#include "hierarchy/tree_units.h"
#include "tests/core/temporary_folder.h"
#include "tests/fuzz/tree_fuzz.h"
#include "tests/hierarchy/crafted_tree_file.h"

namespace obscura {
namespace {

std::string refusal(const std::filesystem::path& path) {
    try {
        read_tree_file(path);
    } catch (const InputError& error) {
        EXPECT_EQ(error.file, path.string());
        return error.message;
    }
    return "accepted";
}

TEST(TreeFile, GivesBackWhatWasWritten) {
    const TemporaryFolder folder;
    std::vector<ShadowTree> trees;
    std::vector<MultiresTree> sources;
    for (const TreeSample& sample : tree_samples()) {
        for (const CodeCase& c : code_cases) {
            // Built from the top down, nodes have no intervals.
            if (row_of(c.code).wants_intervals && sample.tree.intervals.size() != sample.tree.nodes.size())
                continue;
            LightView view = any_view(sample.tree.levels);
            view.to_map.m[1][2] = 0.1 * static_cast<double>(trees.size());
            view.perspective = trees.size() % 2 == 1;
            view.near_w = 0.25;
            view.max_depth = 0.75f;
            trees.push_back(encode_tree(sample.tree, view, params_of(c, std::min(2, sample.tree.levels), 6)));
            sources.push_back(tree_behind(trees.back(), sample.tree));
        }
    }
    write_tree_file(folder.path / "trees", trees, key);
    TreeFile file = read_tree_file(folder.path / "trees");
    // The mapping outlives the name, and the trees outlive each other.
    std::filesystem::remove(folder.path / "trees");
    EXPECT_EQ(file.key, key);
    ASSERT_EQ(file.trees.size(), trees.size());
    for (std::size_t i = 0; i < trees.size(); ++i) {
        const ShadowTree a = file.trees[i];
        file.trees[i] = {};
        const ShadowTree& b = trees[i];
        EXPECT_EQ(a.view.to_map, b.view.to_map);
        EXPECT_EQ(a.view.width, b.view.width);
        EXPECT_EQ(a.view.height, b.view.height);
        EXPECT_EQ(a.view.perspective, b.view.perspective);
        EXPECT_EQ(a.view.near_w, b.view.near_w);
        EXPECT_EQ(a.view.min_depth, b.view.min_depth);
        EXPECT_EQ(a.view.max_depth, b.view.max_depth);
        EXPECT_EQ(a.code.code, b.code.code);
        EXPECT_EQ(a.code.layout, b.code.layout);
        EXPECT_EQ(a.counts, b.counts);
        EXPECT_EQ(a.bytes, b.bytes);
        EXPECT_EQ(a.padding_bytes, b.padding_bytes);
        EXPECT_EQ(a.code.top_levels, b.code.top_levels);
        EXPECT_EQ(content_hash(a), content_hash(b));
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(a.code.units) % 64, 0u);
        EXPECT_EQ(std::memcmp(a.code.units, b.code.units, b.bytes), 0);
        const std::uint32_t side = 1u << sources[i].levels;
        for (std::uint32_t y = 0; y < side; y += 3) {
            for (std::uint32_t x = 0; x < side; ++x) {
                ASSERT_EQ(tree_value(a.code, x, y), value_at(sources[i], x, y));
                if (a.code.top != nullptr) {
                    ASSERT_EQ(tree_value_from_top(a.code, x, y), value_at(sources[i], x, y));
                }
            }
        }
    }
}

TEST(TreeFile, EqualTreesGiveEqualFiles) {
    EXPECT_EQ(file_of({small_tree(), small_tree(TreeLayout::bytes16)}),
              file_of({small_tree(), small_tree(TreeLayout::bytes16)}));
}

TEST(TreeFile, TellsAnotherKeyFromABrokenFile) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path / "trees";
    EXPECT_EQ(read_cached_trees(path, key).state, CacheState::absent);
    write_tree_file(path, std::vector{small_tree()}, key);
    const CachedTrees usable = read_cached_trees(path, key);
    EXPECT_EQ(usable.state, CacheState::usable);
    EXPECT_EQ(usable.trees.size(), 1u);
    const CachedTrees other = read_cached_trees(path, {key.high, key.low + 1});
    EXPECT_EQ(other.state, CacheState::other_key);
    EXPECT_TRUE(other.trees.empty());

    // A key that was altered is not a key.
    std::vector<std::uint8_t> bytes = bytes_of(path);
    bytes[offsetof(TreeFileHeader, key)] ^= 1;
    folder.write("altered", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    EXPECT_THROW(read_cached_trees(folder.path / "altered", key), InputError);

    bytes = bytes_of(path);
    bytes[offsetof(TreeFileHeader, version)] = 2;
    folder.write("later", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    EXPECT_EQ(read_cached_trees(folder.path / "later", key).state, CacheState::other_version);
    EXPECT_EQ(refusal(folder.path / "later"), "has version 2 of the format; this program reads version 1");
}

TEST(TreeFile, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    EXPECT_EQ(refusal(folder.path / "none"), "cannot be opened: No such file or directory");
    EXPECT_EQ(refusal(folder.path), "is not a regular file");
    EXPECT_EQ(refusal(folder.write("empty", "")), "is empty, not a file of shadow trees");
    EXPECT_EQ(refusal(folder.write("png", "\x89PNG and more")), "is not a file of shadow trees");
    EXPECT_EQ(refusal(folder.write("start", "OBSC")), "is cut short");
    ASSERT_EQ(::mkfifo((folder.path / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(refusal(folder.path / "pipe"), "is not a regular file");

    write_tree_file(folder.path / "trees", std::vector{small_tree()}, key);
    const std::vector<std::uint8_t> good = bytes_of(folder.path / "trees");
    const auto altered = [&](std::size_t at) {
        std::vector<std::uint8_t> bytes = good;
        bytes[at] ^= 0x10;
        return refusal(folder.write("altered", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
    };
    EXPECT_EQ(altered(sizeof(TreeFileHeader) + 5), "is altered: the header's checksum differs");
    EXPECT_EQ(altered(384 + 9), "shadow tree 0: is altered: its checksum differs");
    EXPECT_EQ(altered(good.size() - 1), "is altered between its trees");
}

TEST(TreeFile, RefusesEveryAlteredByteAndEveryLength) {
    const std::vector<std::uint8_t> good =
        file_of({small_tree(), small_tree(TreeLayout::bytes16), small_tree(merged_case),
                 small_tree(merged_bits_case), small_tree(dag_case), small_tree(dag_bits_case),
                 small_tree(packed_case), small_tree(packed_low_case)});
    ASSERT_LT(good.size(), 12000u);
    EXPECT_TRUE(try_trees(good, false));
    std::vector<std::uint8_t> bytes = good;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            bytes[i] = static_cast<std::uint8_t>(good[i] ^ flip);
            EXPECT_FALSE(try_trees(bytes, false)) << "byte " << i << " ^ " << flip;
        }
        bytes[i] = good[i];
        EXPECT_FALSE(try_trees(std::span(good).first(i), false)) << "first " << i << " bytes";
    }
    bytes.push_back(0);
    EXPECT_FALSE(try_trees(bytes, false));
}

// --- files with right checksums -------------------------------------------------------------------------

TEST(TreeFile, RefusesCraftedTrees) {
    const ShadowTree tree = small_tree();
    const auto unchanged = [](TreeRecord&, std::uint8_t*) {};
    EXPECT_EQ(crafted(tree, unchanged), "accepted");

    const auto far_away = [](TreeRecord&, std::uint8_t* units) {
        set_word(units, 0, word_at(units, 0) | 0xffffff00u);
    };
    EXPECT_EQ(crafted(tree, far_away), "shadow tree 0: children lie outside the tree");
    EXPECT_EQ(crafted(small_tree(TreeLayout::words16), far_away),
              "shadow tree 0: an offset has too many bits");
    const auto scaled = [](TreeRecord& record, std::uint8_t*) { record.offset_scale[3] = 0x80000000u; };
    EXPECT_EQ(crafted(tree, scaled), "shadow tree 0: children lie outside the tree");
    const auto own_child = [](TreeRecord& record, std::uint8_t*) { record.offset_scale[3] = 0; };
    EXPECT_EQ(crafted(tree, own_child), "shadow tree 0: children do not follow their parent");
    const auto too_low = [](TreeRecord& record, std::uint8_t*) {
        record.levels = record.top_levels = 2;
        record.width = record.height = 4;
    };
    EXPECT_EQ(crafted(tree, too_low), "shadow tree 0: an inner node at the height of texels");
    const auto no_depth = [](TreeRecord&, std::uint8_t* units) { set_word(units, 1, 0x7fc00000u); };
    EXPECT_EQ(crafted(tree, no_depth), "shadow tree 0: a value is not a depth in [0, 1]");
    const auto miscounted = [](TreeRecord& record, std::uint8_t*) { ++record.leaf; };
    EXPECT_EQ(crafted(tree, miscounted), "shadow tree 0: the number of nodes is not the one stated");
    const auto overcounted = [](TreeRecord& record, std::uint8_t*) { record.leaf = ~std::uint64_t{0}; };
    EXPECT_EQ(crafted(tree, overcounted), "shadow tree 0: the number of nodes is not the one stated");
    const auto padded = [](TreeRecord& record, std::uint8_t*) { record.padding_bytes += 4; };
    EXPECT_EQ(crafted(tree, padded), "shadow tree 0: has other padding than stated");
    const auto endless = [](TreeRecord& record, std::uint8_t*) { record.bytes = ~std::uint64_t{0} - 3; };
    EXPECT_EQ(crafted(tree, endless), "shadow tree 0: is cut short");
    const auto top = [](TreeRecord& record, std::uint8_t*) { record.top_levels = 4; };
    EXPECT_EQ(crafted(tree, top), "shadow tree 0: has too many levels in its top grid");
    const auto view = [](TreeRecord& record, std::uint8_t*) { record.width = 1 << 20; };
    EXPECT_EQ(crafted(tree, view), "shadow tree 0: has a view of another size");
    const auto matrix = [](TreeRecord& record, std::uint8_t*) { record.to_map[7] = HUGE_VAL; };
    EXPECT_EQ(crafted(tree, matrix), "shadow tree 0: has a view that means nothing");
    const auto moved = [](TreeRecord& record, std::uint8_t*) { record.first_byte += 4; };
    EXPECT_EQ(crafted(tree, moved), "shadow tree 0: does not begin where it should");
}

TEST(TreeFile, RefusesBytesThatNoTreeOwns) {
    std::vector<std::uint8_t> bytes = file_of({small_tree()});
    EXPECT_TRUE(try_trees(bytes, true));
    bytes.resize(bytes.size() + 64);
    EXPECT_FALSE(try_trees(bytes, true));
}

TEST(TreeFile, ReadsFilesOfBefore) {
    // Seeds of the fuzzer, and a promise: files of this version stay readable.
    int files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(OBSCURA_SOURCE_DIR "/tests/fuzz/corpus_tree")) {
        SCOPED_TRACE(entry.path().filename());
        EXPECT_FALSE(read_tree_file(entry.path()).trees.empty());
        EXPECT_TRUE(try_trees(bytes_of(entry.path()), false));
        ++files;
    }
    EXPECT_EQ(files, 23);
}

TEST(TreeFile, RefusesTreesThatShareChildren) {
    // Twenty levels in which all four children of a node are full and have the same children: walks meet
    // 4^20 nodes in a file of 200 words.
    std::vector<std::uint32_t> words(10 * 20);
    words[0] = 0xffu | 2u << 8;
    for (std::size_t level = 1; level < 20; ++level) {
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t node = 2 + 8 * (level - 1) + 2 * i;
            const auto distance = static_cast<std::uint32_t>(8 - 2 * i);
            words[node] = (level < 19 ? 0xffu : 0x55u) | distance << 8;
        }
    }
    ShadowTree bomb;
    bomb.view = any_view(20);
    bomb.bytes = words.size() * 4;
    bomb.counts = {60, 0, 60};
    bomb.code.units = reinterpret_cast<const std::uint8_t*>(words.data());
    bomb.code.levels = 20;
    std::fill(std::begin(bomb.code.offset_scale), std::end(bomb.code.offset_scale), 1u);
    const std::vector<std::uint8_t> bytes = file_of({bomb});
    EXPECT_FALSE(try_trees(bytes, false));
}

TEST(TreeFile, CraftedFilesLeadNoLookupOutside) {
    // Random damage under right checksums: refused, or harmless. Run under sanitizers to see it fail.
    std::mt19937 rng(11);
    int read = 0, refused = 0;
    for (const CodeCase& c : code_cases) {
        const std::vector<std::uint8_t> good = file_of({small_tree(c), small_tree(c, 0)});
        for (int round = 0; round < 4000; ++round) {
            std::vector<std::uint8_t> bytes = good;
            for (int change = 0; change <= round % 4; ++change) {
                // Records and units alike; headers are covered above.
                const std::size_t at =
                    sizeof(TreeFileHeader) + rng() % (bytes.size() - sizeof(TreeFileHeader));
                bytes[at] = static_cast<std::uint8_t>(round % 3 == 0 ? rng() : bytes[at] ^ 1u << rng() % 8);
            }
            ++(try_trees(bytes, true) ? read : refused);
        }
    }
    EXPECT_GT(read, 100);
    EXPECT_GT(refused, 1000);
}

TEST(BulkHash, ChangesWithEveryBitAndLength) {
    std::vector<std::uint8_t> bytes(100);
    std::vector<std::uint64_t> hashes;
    for (std::size_t size = 0; size <= bytes.size(); ++size)
        hashes.push_back(bulk_hash(bytes.data(), size));
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
        hashes.push_back(bulk_hash(bytes.data(), bytes.size()));
        // The same bit in the next word of the lane must not undo it.
        if (bit / 8 + 32 < bytes.size()) {
            bytes[bit / 8 + 32] ^= static_cast<std::uint8_t>(1u << bit % 8);
            hashes.push_back(bulk_hash(bytes.data(), bytes.size()));
            bytes[bit / 8 + 32] = 0;
        }
        bytes[bit / 8] = 0;
    }
    std::sort(hashes.begin(), hashes.end());
    EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

}  // namespace
}  // namespace obscura
