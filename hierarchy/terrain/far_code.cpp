// Maps are coded one after the other: a map of one value by a symbol, else its blocks of 8 x 8 in rows:
// blocks of one value by a symbol, else their samples. All symbols are binary, coded by how often each came
// about before in the same surroundings: of a block whether the blocks to the left, above and in the map
// before were lit, dark or mixed; of a sample the samples around it that are known, in its own map and in the
// one before, whose shadows lie nearly as this one's do.
//
// What Chajdas et al. (2014, section 3.1) code with a dictionary of 8 x 8 tiles and LZMA, each map by itself.

#include "hierarchy/terrain/far_code.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "hierarchy/terrain/range_coder.h"

namespace obscura {
namespace {

/// Bits that a symbol may have: one, the other or both.
enum Choice : int { only_0 = 1, only_1 = 2, either = 3 };

class Chooser {
  public:
    int code(BitModel& model, int choice) {
        const bool likely_1 = model.zero_of() < (1u << BitModel::fractions) / 2;
        const int bit = choice == only_1 || (choice == either && likely_1) ? 1 : 0;
        encoder_.code(model, bit);
        return bit;
    }
    std::vector<std::uint8_t> finish() { return encoder_.finish(); }

  private:
    RangeEncoder encoder_;
};

class Reader {
  public:
    explicit Reader(std::span<const std::uint8_t> bytes) : decoder_(bytes) {}
    int code(BitModel& model, int /*choice*/) { return decoder_.decode(model); }

  private:
    RangeDecoder decoder_;
};

enum State : int { lit, dark, mixed };
constexpr int states = 3;
constexpr std::uint64_t all_dark = ~std::uint64_t{0};

State state_of(std::uint64_t block) {
    return block == 0 ? lit : block == all_dark ? dark : mixed;
}

/// A symbol of three: mixed or not, and if not, which.
struct StateModel {
    BitModel is_mixed, is_dark;
};

/// What is learnt in a unit.
struct Models {
    std::array<StateModel, states> map;
    std::array<StateModel, states * states * states * states> block;
    std::array<BitModel, 64> first_sample;
    std::array<BitModel, 1024> sample;
};

/// What a symbol may be, from the bits that count.
struct Allowed {
    bool lit = true, dark = true;
    void add(std::uint64_t bits, std::uint64_t cares) {
        lit &= (bits & cares) == 0;
        dark &= (~bits & cares) == 0;
    }
};

template <class Coder>
State code_state(Coder& coder, StateModel& model, const Allowed& allowed) {
    if (coder.code(model.is_mixed, allowed.lit || allowed.dark ? only_0 : only_1) == 1) return mixed;
    const int choice = allowed.lit && allowed.dark ? either : allowed.lit ? only_0 : only_1;
    return coder.code(model.is_dark, choice) == 1 ? dark : lit;
}

/// Block (x, y), or 0 beyond the tile.
std::uint64_t block_at(const TileBits& t, int x, int y) {
    return x < 0 || y < 0 || x >= t.blocks_x || y >= t.blocks_y ? 0 : t(x, y);
}

/// Ten rows of ten bits: a block and a margin of one sample around it.
using Window = std::array<unsigned, 10>;

unsigned row_of(std::uint64_t left, std::uint64_t middle, std::uint64_t right, int y) {
    const auto row = [y](std::uint64_t block) { return static_cast<unsigned>(block >> (8 * y) & 0xff); };
    return row(left) >> 7 | row(middle) << 1 | (row(right) & 1) << 9;
}

Window window_of(const TileBits& t, int x, int y) {
    Window w{};
    w[0] = row_of(block_at(t, x - 1, y - 1), block_at(t, x, y - 1), block_at(t, x + 1, y - 1), 7);
    const std::uint64_t left = block_at(t, x - 1, y), middle = block_at(t, x, y),
                        right = block_at(t, x + 1, y);
    for (int r = 0; r < 8; ++r)
        w[static_cast<std::size_t>(r) + 1] = row_of(left, middle, right, r);
    w[9] = row_of(block_at(t, x - 1, y + 1), block_at(t, x, y + 1), block_at(t, x + 1, y + 1), 0);
    return w;
}

template <class Coder>
class Unit {
  public:
    explicit Unit(Coder& coder) : coder_(coder) {}

    /// Codes a map; `before` is null for the first. When decoding, `bits` is made and `cares` not looked at.
    void code_map(TileBits& bits, const TileBits* cares, const TileBits* before) {
        const State state =
            code_state(coder_, models_.map[static_cast<std::size_t>(last_state_)], allowed_of(bits, cares));
        last_state_ = state;
        if (state != mixed) {
            std::fill(bits.blocks.begin(), bits.blocks.end(), state == dark ? all_dark : 0);
            return;
        }
        for (int y = 0; y < bits.blocks_y; ++y) {
            for (int x = 0; x < bits.blocks_x; ++x)
                bits(x, y) = code_block(bits, cares, before, x, y);
        }
    }

  private:
    static Allowed allowed_of(const TileBits& bits, const TileBits* cares) {
        Allowed allowed;
        if (cares == nullptr) return allowed;
        for (std::size_t i = 0; i < bits.blocks.size() && (allowed.lit || allowed.dark); ++i)
            allowed.add(bits.blocks[i], cares->blocks[i]);
        return allowed;
    }

    std::uint64_t code_block(const TileBits& bits, const TileBits* cares, const TileBits* before, int x,
                             int y) {
        const std::uint64_t wanted = bits(x, y), care = cares != nullptr ? (*cares)(x, y) : 0;
        const State earlier = before != nullptr ? state_of((*before)(x, y)) : mixed;
        const State further =
            before != nullptr && x + 1 < bits.blocks_x ? state_of((*before)(x + 1, y)) : earlier;
        const int surroundings =
            ((state_of(block_at(bits, x - 1, y)) * states + state_of(block_at(bits, x, y - 1))) * states +
             earlier) *
                states +
            further;
        Allowed allowed;
        allowed.add(wanted, care);
        const State state =
            code_state(coder_, models_.block[static_cast<std::size_t>(surroundings)], allowed);
        if (state != mixed) return state == dark ? all_dark : 0;
        return before != nullptr ? code_samples(bits, wanted, care, *before, x, y)
                                 : code_first_samples(bits, wanted, care, x, y);
    }

    static int choice(std::uint64_t wanted, std::uint64_t care, int i) {
        if ((care >> i & 1) == 0) return either;
        return (wanted >> i & 1) != 0 ? only_1 : only_0;
    }

    /// Samples of a map that follows another.
    std::uint64_t code_samples(const TileBits& bits, std::uint64_t wanted, std::uint64_t care,
                               const TileBits& before, int bx, int by) {
        Window w = window_of(bits, bx, by);
        const Window p = window_of(before, bx, by);
        std::uint64_t block = 0;
        for (std::size_t y = 1; y <= 8; ++y) {
            w[y] &= 1;
            for (int x = 1; x <= 8; ++x) {
                const unsigned above = w[y - 1] >> (x - 1) & 7, left = w[y] >> (x - 1) & 1;
                const unsigned then = p[y] >> (x - 1) & 7;
                const unsigned up = p[y - 1] >> x & 1, down = p[y + 1] >> x & 1;
                const unsigned context = above | left << 3 | then << 4 | up << 7 | down << 8;
                const int i = static_cast<int>(8 * (y - 1)) + x - 1;
                const auto bit =
                    static_cast<unsigned>(coder_.code(models_.sample[context], choice(wanted, care, i)));
                w[y] |= bit << x;
                block |= std::uint64_t{bit} << i;
            }
            w[y] |= (w[y - 1] >> 9 & 1) << 9;
        }
        return block;
    }

    /// Samples of the unit's first map: those around it in its own map alone.
    std::uint64_t code_first_samples(const TileBits& bits, std::uint64_t wanted, std::uint64_t care, int bx,
                                     int by) {
        Window w = window_of(bits, bx, by);
        std::uint64_t block = 0;
        for (std::size_t y = 1; y <= 8; ++y) {
            w[y] &= 1;
            for (int x = 1; x <= 8; ++x) {
                const unsigned above = w[y - 1] >> (x - 1) & 7, left = w[y] >> (x - 1) & 1;
                const unsigned left2 = x >= 2 ? w[y] >> (x - 2) & 1 : left;
                const unsigned above2 = y >= 2 ? w[y - 2] >> x & 1 : above >> 1 & 1;
                const unsigned context = above | left << 3 | left2 << 4 | above2 << 5;
                const int i = static_cast<int>(8 * (y - 1)) + x - 1;
                const auto bit = static_cast<unsigned>(
                    coder_.code(models_.first_sample[context], choice(wanted, care, i)));
                w[y] |= bit << x;
                block |= std::uint64_t{bit} << i;
            }
            w[y] |= (w[y - 1] >> 9 & 1) << 9;
        }
        return block;
    }

    Coder& coder_;
    Models models_;
    State last_state_ = lit;
};

}  // namespace

std::vector<std::uint8_t> encode_far_tile(const std::vector<TileBits>& maps,
                                          const std::vector<TileBits>& cares) {
    CHECK(maps.size() == cares.size());
    Chooser coder;
    Unit<Chooser> unit(coder);
    std::vector<TileBits> coded = maps;
    for (std::size_t i = 0; i < coded.size(); ++i)
        unit.code_map(coded[i], &cares[i], i > 0 ? &coded[i - 1] : nullptr);
    const bool empty = std::all_of(coded.begin(), coded.end(), [](const TileBits& t) {
        return std::all_of(t.blocks.begin(), t.blocks.end(), [](std::uint64_t b) { return b == 0; });
    });
    return empty ? std::vector<std::uint8_t>{} : coder.finish();
}

std::vector<TileBits> decode_far_tile(std::span<const std::uint8_t> bytes, const TileArea& area, int count) {
    std::vector<TileBits> maps(static_cast<std::size_t>(count), TileBits(area));
    if (bytes.empty()) return maps;
    Reader coder(bytes);
    Unit<Reader> unit(coder);
    for (std::size_t i = 0; i < maps.size(); ++i)
        unit.code_map(maps[i], nullptr, i > 0 ? &maps[i - 1] : nullptr);
    return maps;
}

}  // namespace obscura
