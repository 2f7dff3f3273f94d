// Far maps come back bit for bit where they count, and any bytes decode to something.

#include <gtest/gtest.h>

#include <random>

#include "hierarchy/terrain/far_code.h"
#include "hierarchy/terrain/range_coder.h"

namespace obscura {
namespace {

TEST(RangeCoder, BitsOfAnyLikelihoodComeBack) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 300; ++round) {
        // Rare, even and certain bits, in runs that carry far.
        const std::uint64_t rarity = std::uint64_t{1} << (random() % 16);
        const std::size_t count = random() % 3000;
        std::vector<int> bits(count);
        for (int& b : bits)
            b = random() % rarity == 0 ? 1 : 0;
        if (round % 3 == 0) {
            for (int& b : bits)
                b = 1 - b;
        }
        RangeEncoder encoder;
        BitModel models[2];
        for (std::size_t i = 0; i < count; ++i)
            encoder.code(models[i % 2], bits[i]);
        const std::vector<std::uint8_t> bytes = encoder.finish();
        RangeDecoder decoder(bytes);
        BitModel again[2];
        for (std::size_t i = 0; i < count; ++i)
            ASSERT_EQ(decoder.decode(again[i % 2]), bits[i]) << "round " << round << ", bit " << i;
        if (rarity == 1 << 15) {
            EXPECT_LT(bytes.size(), 3 + count / 100);
        }
    }
}

TEST(RangeCoder, LongRunsCostNextToNothing) {
    RangeEncoder encoder;
    BitModel model;
    for (int i = 0; i < 1'000'000; ++i)
        encoder.code(model, i == 777'777 ? 1 : 0);
    EXPECT_LT(encoder.finish().size(), 40u);
}

/// Half planes that move over the tile, as shadows do, with some noise.
std::vector<TileBits> moving_edges(const TileArea& area, int count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<TileBits> maps;
    for (int m = 0; m < count; ++m) {
        ShadowBits map(area.x + area.width, area.y + area.height);
        for (int y = 0; y < area.height; ++y) {
            for (int x = 0; x < area.width; ++x) {
                if (x * 3 + y < 20 * m || random() % 200 == 0) map.set(area.x + x, area.y + y);
            }
        }
        maps.push_back(tile_of(map, area));
    }
    return maps;
}

TEST(FarCode, IsLosslessWhereItMatters) {
    for (const TileArea area : {TileArea{0, 0, 1, 1}, TileArea{8, 3, 64, 64}, TileArea{64, 0, 77, 45}}) {
        for (const int count : {1, 2, 16}) {
            const std::vector<TileBits> maps = moving_edges(area, count, 3);
            std::vector<TileBits> all(maps.size(), TileBits(area)), some = all;
            std::mt19937_64 random(9);
            for (std::size_t m = 0; m < maps.size(); ++m) {
                for (std::size_t b = 0; b < maps[m].blocks.size(); ++b) {
                    all[m].blocks[b] = ~std::uint64_t{0};
                    some[m].blocks[b] = random() % 4 == 0 ? 0 : random() | random();
                }
            }
            for (const auto* cares : {&all, &some}) {
                const std::vector<std::uint8_t> bytes = encode_far_tile(maps, *cares);
                const std::vector<TileBits> back = decode_far_tile(bytes, area, count);
                ASSERT_EQ(back.size(), maps.size());
                for (std::size_t m = 0; m < maps.size(); ++m) {
                    for (std::size_t b = 0; b < maps[m].blocks.size(); ++b)
                        ASSERT_EQ((back[m].blocks[b] ^ maps[m].blocks[b]) & (*cares)[m].blocks[b], 0u);
                }
            }
        }
    }
}

TEST(FarCode, BitsThatDoNotMatterAreCheap) {
    const TileArea area{0, 0, 128, 128};
    std::vector<TileBits> noise(4, TileBits(area)), none = noise, left = noise;
    std::mt19937_64 random(2);
    for (TileBits& t : noise) {
        for (std::uint64_t& b : t.blocks)
            b = random();
    }
    for (TileBits& t : left) {
        for (std::uint64_t& b : t.blocks)
            b = 0x0f0f0f0f0f0f0f0f;
    }
    EXPECT_TRUE(encode_far_tile(noise, none).empty());
    const std::size_t half = 4 * 128 * 128 / 2 / 8, bytes = encode_far_tile(noise, left).size();
    EXPECT_GT(bytes, half) << "noise";
    EXPECT_LT(bytes, 2 * half);
}

TEST(FarCode, EmptyMapsTakeNoBytes) {
    const TileArea area{0, 0, 300, 200};
    const std::vector<TileBits> maps(16, TileBits(area));
    std::vector<TileBits> cares = maps;
    for (TileBits& t : cares)
        t.blocks.assign(t.blocks.size(), ~std::uint64_t{0});
    EXPECT_TRUE(encode_far_tile(maps, cares).empty());
    EXPECT_EQ(decode_far_tile({}, area, 16)[3].blocks, maps[3].blocks);
}

TEST(FarCode, AnyBytesDecode) {
    std::mt19937 random(5);
    for (int round = 0; round < 300; ++round) {
        std::vector<std::uint8_t> bytes(random() % 200);
        for (std::uint8_t& b : bytes)
            b = static_cast<std::uint8_t>(random());
        EXPECT_EQ(decode_far_tile(bytes, {0, 0, 70, 50}, 16).size(), 16u);
    }
}

TEST(TileBits, AreasOfMapsComeBack) {
    std::mt19937_64 random(11);
    ShadowBits map(203, 41);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            if (random() % 2 == 0) map.set(x, y);
        }
    }
    ShadowBits back(203, 41);
    for (const TileArea& area : {TileArea{0, 0, 64, 41}, TileArea{64, 0, 72, 20}, TileArea{64, 20, 72, 21},
                                 TileArea{136, 0, 67, 41}}) {
        put_tile(tile_of(map, area), area, back);
    }
    EXPECT_EQ(back, map);
}

}  // namespace
}  // namespace obscura
