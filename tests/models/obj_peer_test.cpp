// Our OBJ reader against tinyobjloader: what we accept, the library must read alike (tests/fuzz/obj_peer.h).
// The places where the two are known to differ are rows of a table (tests/fuzz/obj_dialect.h); the tests
// print how often each was met and prove that each is still true of the library.
#include "tests/fuzz/obj_peer.h"
#include "tests/core/shared_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <vector>

#include "app/models/file_access.h"
#include "core/error.h"
#include "tests/models/obj_writer.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// Counts what was read by both, and prints it with the rows that were met.
struct Tally {
    std::size_t accepted = 0, refused = 0, compared = 0, triangles = 0;
    std::array<std::size_t, quirk_count> met{};

    void add(std::string_view obj, std::string_view mtl) {
        try {
            Limits limits;
            limits.triangles = 3'000'000;
            const PeerResult peer = read_by_both(obj, mtl, limits);
            EXPECT_EQ(peer.difference, "");
            ++accepted;
            compared += peer.compared;
            triangles += peer.compared ? peer.triangles : 0;
            for (std::size_t i = 0; i < quirk_count; ++i)
                met[i] += peer.quirks[i];
        } catch (const InputError&) {
            ++refused;
        }
    }

    void print() const {
        constexpr std::array effects = {"reworded", "but one thing", "left out"};
        fmt::print("{} files accepted, {} refused; {} compared, {} triangles\n", accepted, refused, compared,
                   triangles);
        for (std::size_t i = 0; i < quirk_count; ++i) {
            if (met[i] == 0) continue;
            const QuirkRow& row = quirk_row(static_cast<Quirk>(i));
            fmt::print("{:6}  {:13}  {:22}  {}\n", met[i], effects[static_cast<std::size_t>(row.effect)],
                       row.name, row.reason);
        }
    }
};

std::vector<fs::path> obj_files(const fs::path& folder) {
    std::vector<fs::path> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".obj") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string read_text(const fs::path& file) {
    return read_file(file, std::size_t{1} << 28);
}

/// All files that the mtllib lines of a text name and that exist, one behind the other.
std::string materials_of(const fs::path& file, const std::string& obj) {
    std::string mtl;
    std::istringstream lines(obj);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("mtllib ", 0) != 0) continue;
        std::istringstream names(line.substr(7));
        for (std::string name; names >> name;) {
            if (fs::is_regular_file(file.parent_path() / name))
                mtl += read_text(file.parent_path() / name) + "\n";
        }
    }
    return mtl;
}

void add_file(Tally& tally, const fs::path& file) {
    SCOPED_TRACE(file);
    const std::string obj = read_text(file);
    tally.add(obj, materials_of(file, obj));
}

TEST(ObjPeer, Corpus) {
    Tally tally;
    for (const fs::path& file : obj_files(OBSCURA_SOURCE_DIR "/tests/fuzz/corpus_obj")) {
        SCOPED_TRACE(file);
        const std::string bytes = read_text(file);
        // As the fuzzer has it: the MTL stands behind the first NUL byte.
        const std::size_t cut = std::min(bytes.find('\0'), bytes.size());
        tally.add(bytes.substr(0, cut), bytes.substr(std::min(cut + 1, bytes.size())));
    }
    for (const fs::path& file : obj_files(OBSCURA_SOURCE_DIR "/scenes"))
        add_file(tally, file);
    tally.print();
    EXPECT_GE(tally.compared, 12u);
}

class FilesByChance : public testing::TestWithParam<int> {};

TEST_P(FilesByChance, AreReadAlike) {
    Tally tally;
    const auto first = static_cast<std::uint64_t>(500 * GetParam() + 1);
    for (std::uint64_t seed = first; seed < first + 500 && !testing::Test::HasFailure(); ++seed) {
        const WrittenObj written = write_obj(seed);
        SCOPED_TRACE(fmt::format("seed {}:\n{}", seed, written.obj + written.mtl));
        tally.add(written.obj, written.mtl);
    }
    tally.print();
    EXPECT_EQ(tally.refused, 0u);
    EXPECT_EQ(tally.compared, tally.accepted);
}

INSTANTIATE_TEST_SUITE_P(ObjPeer, FilesByChance, testing::Range(0, 4));

constexpr std::uintmax_t large_file = 4'000'000;

void compare_shared(const char* name, bool large) {
    const fs::path folder = shared_folder(name);
    SKIP_WITHOUT(folder);
    Tally tally;
    for (const fs::path& file : obj_files(folder)) {
        if ((fs::file_size(file) > large_file) == large) add_file(tally, file);
    }
    tally.print();
    EXPECT_GE(tally.compared, 1u);
}

TEST(ObjPeer, FilesThatFailed) {
    compare_shared("cases", false);
}

TEST(ObjPeer, RealMeshes) {
    compare_shared("data", false);
}

TEST(ObjPeer, LargeRealMeshes) {
    const char *ci = std::getenv("CI"), *slow = std::getenv("OBSCURA_SLOW_TESTS");
    if ((ci == nullptr || std::strcmp(ci, "true") != 0) && (slow == nullptr || std::strcmp(slow, "1") != 0))
        GTEST_SKIP() << "files of more than " << large_file << " bytes: set OBSCURA_SLOW_TESTS=1";
    compare_shared("data", true);
}

/// A text that shows a row: the library, given it as it stands, reads something else.
struct Witness {
    Quirk quirk;
    std::string obj, mtl;
};

const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string face = "f 1 2 3\n";
const std::string library = "mtllib a.mtl\n";
const std::string rest_of_mtl = "Ns 10\nPr 0.5\nPm 0.5\n";
const std::string red = "newmtl m\nKd 1 0 0\n" + rest_of_mtl;

std::string polygon_of(int n) {
    std::string text = corners + "f";
    for (int i = 0; i < n; ++i)
        text += fmt::format(" {}", 1 + i % 3);
    return text + "\n";
}

std::vector<Witness> witnesses() {
    const std::string used = library + corners + "usemtl m\n" + face;
    return {
        {Quirk::byte_order_mark, "\xEF\xBB\xBF" + corners + face, ""},
        {Quirk::joined_lines, corners + "f 1 \\\n2 3\n", ""},
        {Quirk::comment_behind, corners + "f 1 2 3 # door\n", ""},
        {Quirk::empty_slots, corners + "f 1// 2// 3//\n", ""},
        {Quirk::other_blanks, corners + "f 1\v2\f3\n", ""},
        {Quirk::blank_in_name, library + corners + "usemtl m n\n" + face,
         "newmtl m n\nKd 1 0 0\n" + rest_of_mtl},
        {Quirk::unread_elements, corners + "l 0 1\n" + face, ""},
        {Quirk::old_face_keyword, corners + "fo 1 2 3\n", ""},
        {Quirk::library_lines, corners + "usemtl m\n" + face + library, red},
        {Quirk::one_number_colour, used, "newmtl m\nKd 0.5\n" + rest_of_mtl},
        {Quirk::material_defaults, used, "newmtl m\n" + rest_of_mtl},
        {Quirk::material_twice, used, red + "newmtl m\nKd 0 1 0\n" + rest_of_mtl},
        {Quirk::objects_and_groups, "o house\ng roof\n" + corners + face, ""},
        {Quirk::number_range, "v 0 0 0e500\nv 1 0 0\nv 0 1 0\n" + face, ""},
        {Quirk::nul_byte, corners + face + std::string("o a\0b\n", 6) + face, ""},
        {Quirk::name_comment, used, "newmtl m # paint\nKd 1 0 0\n" + rest_of_mtl},
        {Quirk::short_option, used, red + "map_Kd -s 1 -o 0 0 t.png\n"},
    };
}

TEST(ObjPeer, TheLibraryStillDiffersWhereTheTableSaysSo) {
    EXPECT_EQ(read_by_both(library + corners + "usemtl m\n" + face, red, Limits{}, Feed::raw).difference, "");
    Quirks shown;
    shown.set(static_cast<std::size_t>(Quirk::many_corners));  // below
    for (const Witness& witness : witnesses()) {
        SCOPED_TRACE(quirk_row(witness.quirk).name);
        const PeerResult raw = read_by_both(witness.obj, witness.mtl, Limits{}, Feed::raw);
        EXPECT_NE(raw.difference, "") << "the library is better than the table says: delete the row";
        EXPECT_TRUE(raw.quirks[static_cast<std::size_t>(witness.quirk)]);
        const PeerResult peer = read_by_both(witness.obj, witness.mtl, Limits{});
        EXPECT_EQ(peer.difference, "");
        EXPECT_EQ(peer.compared, !keeps_from_comparing(peer.quirks));
        EXPECT_EQ(peer.compared, quirk_row(witness.quirk).effect != QuirkEffect::not_compared);
        fmt::print("{:24}  {}\n", quirk_row(witness.quirk).name, raw.difference);
        shown |= raw.quirks;
    }
    EXPECT_TRUE(shown.all()) << "a row without a witness";
}

TEST(ObjPeer, CountsOfCornersAreOneByteInTheLibrary) {
    for (const int n : {255, 256, 300, 1000}) {
        const PeerResult peer = read_by_both(polygon_of(n), "", Limits{});
        EXPECT_EQ(peer.difference, "") << n;
        EXPECT_EQ(peer.quirks[static_cast<std::size_t>(Quirk::many_corners)], n > 255) << n;
    }
}

}  // namespace
}  // namespace obscura
