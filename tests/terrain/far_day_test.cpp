// A day's far shadows, with near ones, are the day's shadows; its file is whole or refused.

#include "hierarchy/terrain/far_day.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "core/hash.h"
#include "core/num.h"
#include "hierarchy/terrain/far_file.h"
#include "hierarchy/terrain/far_file_format.h"
#include "raster/heights/height_sweep.h"
#include "tests/heights/drawn_heights.h"
#include "tests/terrain/drawn_days.h"

namespace obscura {
namespace {

using drawn::hills;
using drawn::suns_over;

const FarDayParams params{4, 64, 8};

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / "obscura_far_day_test";
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
};

TEST(FarDay, FarAndNearAreTheWholeShadowOfEverySun) {
    const HeightField field = hills(203, 130);
    const std::vector<FarSun> suns = suns_over(field, 19);
    const FarDay day = make_far_day(field, suns, params, {});
    ASSERT_EQ(day.tiles(), 4 * 3);
    ASSERT_EQ(day.groups(), 3);
    ASSERT_EQ(day.units.size(), 36u);
    std::int64_t dark = 0, stored = 0;
    for (int group = 0; group < day.groups(); ++group) {
        const std::vector<ShadowBits> maps = far_maps(day, group, {});
        for (std::size_t i = 0; i < maps.size(); ++i) {
            const FarSun& sun = suns[static_cast<std::size_t>(day.suns_of(group).first) + i];
            const int thresholds[] = {0, params.threshold};
            const auto swept = sweep_shadows(field, sun.direction, thresholds);
            ASSERT_EQ(with_near_shadows(field, sun, maps[i], params.threshold), swept[0]);
            dark += count_of(swept[1]);
            stored += count_of(maps[i]);
        }
    }
    EXPECT_GT(dark, 19 * 203 * 130 / 50);
    EXPECT_NE(stored, dark) << "some bits are of no account, and not kept";
}

TEST(FarDay, OneBytesForAnyNumberOfThreads) {
    const HeightField field = hills(150, 130);
    const std::vector<FarSun> suns = suns_over(field, 11);
    const FarDay one = make_far_day(field, suns, params, {best_isa(), 1});
    const FarDay many = make_far_day(field, suns, params, {best_isa(), 5});
    EXPECT_EQ(one.units, many.units);
    EXPECT_TRUE(std::equal(one.bytes.begin(), one.bytes.end(), many.bytes.begin(), many.bytes.end()));
    // The bytes on any machine and compiler.
    EXPECT_EQ(hash_text(bulk_hash(one.bytes.data(), one.bytes.size())), "299eb35513bf4bf8");
}

TEST(FarDay, IsToldHowFarItIsAndStops) {
    const HeightField field = hills(70, 70);
    std::vector<int> told;
    FarDayWatch watch{[&](int suns) { told.push_back(suns); }, nullptr};
    make_far_day(field, suns_over(field, 19), params, {}, watch);
    EXPECT_EQ(told, (std::vector<int>{8, 16, 19}));
    std::atomic<bool> cancel{true};
    EXPECT_TRUE(make_far_day(field, suns_over(field, 19), params, {}, {nullptr, &cancel}).units.empty());
}

TEST(FarDay, GridsOfOneSampleAndNoSun) {
    for (const auto& [w, h] : {std::pair{1, 1}, std::pair{1, 90}, std::pair{90, 1}}) {
        const HeightField field = hills(w, h);
        const std::vector<FarSun> suns = suns_over(field, 3);
        const FarDay day = make_far_day(field, suns, params, {});
        const std::vector<ShadowBits> maps = far_maps(day, 0, {});
        for (std::size_t i = 0; i < suns.size(); ++i) {
            const int whole[] = {0};
            EXPECT_EQ(with_near_shadows(field, suns[i], maps[i], params.threshold),
                      sweep_shadows(field, suns[i].direction, whole)[0]);
        }
        EXPECT_TRUE(make_far_day(field, {}, params, {}).units.empty());
    }
}

TEST(FarFile, ComesBackAsItWas) {
    const Folder folder;
    const HeightField field = hills(150, 70);
    const FarDay day = make_far_day(field, suns_over(field, 11), params, {});
    write_far_file(folder.path / "day.far", day, {1, 2});
    const FarFile file = read_far_file(folder.path / "day.far");
    EXPECT_EQ(file.key, (TreeFileKey{1, 2}));
    EXPECT_EQ(file.day.grid, day.grid);
    EXPECT_EQ(file.day.params, day.params);
    EXPECT_EQ(file.day.suns, day.suns);
    EXPECT_EQ(file.day.units, day.units);
    EXPECT_TRUE(std::equal(day.bytes.begin(), day.bytes.end(), file.day.bytes.begin(), file.day.bytes.end()));
    // A tile by itself is what it is in the whole.
    const std::vector<ShadowBits> maps = far_maps(day, 1, {});
    for (int tile = 0; tile < day.tiles(); ++tile) {
        const std::vector<TileBits> alone = far_tile(file.day, 1, tile);
        for (std::size_t i = 0; i < alone.size(); ++i) {
            ShadowBits put = maps[i];
            put_tile(alone[i], day.area(tile), put);
            EXPECT_EQ(put, maps[i]);
        }
    }
}

/// Reads all of a file that may be anything.
void read_whole(const std::vector<std::uint8_t>& bytes) {
    const FarFile file = read_far_file(bytes, nullptr, "x");
    for (int group = 0; group < file.day.groups(); ++group)
        far_maps(file.day, group, {best_isa(), 1}, "x");
}

TEST(FarFile, AnyByteAlteredIsRefused) {
    const Folder folder;
    const HeightField field = hills(150, 70);
    write_far_file(folder.path / "day.far", make_far_day(field, suns_over(field, 11), params, {}), {1, 2});
    const std::vector<std::uint8_t> bytes = bytes_of(folder.path / "day.far");
    ASSERT_NO_THROW(read_whole(bytes));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (const int bit : {1, 128}) {
            std::vector<std::uint8_t> altered = bytes;
            altered[i] = static_cast<std::uint8_t>(altered[i] ^ bit);
            EXPECT_THROW(read_whole(altered), InputError) << "byte " << i;
        }
    }
    for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 7)
        EXPECT_THROW(read_whole({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}),
                     InputError)
            << size;
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_THROW(read_whole(longer), InputError);
}

/// A header that its checksum belongs to, with other numbers.
TEST(FarFile, ForgedNumbersAreRefused) {
    const Folder folder;
    const HeightField field = hills(150, 70);
    write_far_file(folder.path / "day.far", make_far_day(field, suns_over(field, 11), params, {}), {1, 2});
    const std::vector<std::uint8_t> bytes = bytes_of(folder.path / "day.far");
    const auto forged = [&](auto&& change) {
        std::vector<std::uint8_t> out = bytes;
        FarFileHeader h;
        std::memcpy(&h, out.data(), sizeof h);
        const std::uint64_t first = h.file_bytes - h.unit_bytes;
        change(h, out);
        h.checksum = 0;
        h.checksum = Hasher{}
                         .value(bulk_hash(&h, sizeof h))
                         .value(bulk_hash(out.data() + sizeof h, first - sizeof h))
                         .state;
        std::memcpy(out.data(), &h, sizeof h);
        return out;
    };
    using Header = FarFileHeader;
    using Data = std::vector<std::uint8_t>;
    ASSERT_NO_THROW(read_whole(forged([](Header&, Data&) {})));
    const std::function<void(Header&, Data&)> changes[] = {
        [](Header& h, Data&) { h.width = 0; },
        [](Header& h, Data&) { h.height = 1 << 21; },
        [](Header& h, Data&) { h.width = 500; },
        [](Header& h, Data&) { h.cell_x_m = -1; },
        [](Header& h, Data&) { h.diagonal = 2; },
        [](Header& h, Data&) { h.threshold = 0; },
        [](Header& h, Data&) { h.tile_side = 100; },
        [](Header& h, Data&) { h.tile_side = 1 << 20; },
        [](Header& h, Data&) { h.suns_per_unit = 0; },
        [](Header& h, Data&) { h.suns_per_unit = 4; },
        [](Header& h, Data&) { h.version = 2; },
        // The first sun's slope, and the first unit's place.
        [](Header& h, Data& d) { d[sizeof h + 32 + 7] = 0x7f; },
        [](Header& h, Data& d) { d[sizeof h + 11 * sizeof(FarFileSun)] = 1; },
    };
    for (std::size_t i = 0; i < std::size(changes); ++i)
        EXPECT_THROW(read_whole(forged(changes[i])), InputError) << "change " << i;
}

}  // namespace
}  // namespace obscura
