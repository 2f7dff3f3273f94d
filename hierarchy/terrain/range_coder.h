#pragma once
// Bits to bytes by their probabilities, adapting on the way (Martin, "Range encoding", 1979; carries as in
// LZMA, I. Pavlov). Probabilities have 16 bits and ranges 56: with the usual 11 and 32, maps that hardly ever
// surprise would cost several times as much.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// How likely a bit is 0, learnt from those seen: the n-th moves it by about 1/n, later ones by 1/`slowest`.
struct BitModel {
    static constexpr int fractions = 16, slowest = 200;
    std::uint32_t zero = 1u << 31;  ///< probability of 0 in 2^-32
    std::uint32_t seen = 0;

    /// The same in 2^-16, neither never nor always.
    std::uint32_t zero_of() const { return std::clamp<std::uint32_t>(zero >> 16, 2, (1u << fractions) - 2); }
    void learn(int bit) {
        // The first bits say more than later ones (Krichevsky, Trofimov 1981: start as if half of each had
        // been seen).
        const std::uint32_t share = 2 * (1u << fractions) / (2 * seen + 3);
        if (bit == 0) {
            zero += static_cast<std::uint32_t>(std::uint64_t{~zero} * share >> fractions);
        } else {
            zero -= static_cast<std::uint32_t>(std::uint64_t{zero} * share >> fractions);
        }
        if (seen < slowest) ++seen;
    }
};

namespace range_coder {
constexpr std::uint64_t whole = std::uint64_t{1} << 56;
constexpr int top_shift = 48;
constexpr std::uint64_t least = std::uint64_t{1} << top_shift;
}  // namespace range_coder

class RangeEncoder {
  public:
    /// Codes `bit` and lets the model learn it.
    void code(BitModel& model, int bit) {
        const std::uint64_t bound = (range_ >> BitModel::fractions) * model.zero_of();
        if (bit == 0) {
            range_ = bound;
        } else {
            low_ += bound;
            range_ -= bound;
        }
        model.learn(bit);
        while (range_ < range_coder::least) {
            shift();
            range_ <<= 8;
        }
    }

    /// Ends the message: as few bytes as tell it from others, since decoders read zeros beyond the last.
    std::vector<std::uint8_t> finish() {
        for (int zeros = 56; zeros >= 0; zeros -= 8) {
            const std::uint64_t step = std::uint64_t{1} << zeros, rounded = (low_ + step - 1) / step * step;
            if (rounded >= low_ + range_) continue;
            low_ = rounded;
            break;
        }
        for (int i = 0; i < 8; ++i)
            shift();
        while (!bytes_.empty() && bytes_.back() == 0)
            bytes_.pop_back();
        return std::move(bytes_);
    }

  private:
    /// Moves out the top byte. It may still grow by a carry, and with it all bytes of 255 behind it.
    void shift() {
        const auto top = static_cast<unsigned>(low_ >> range_coder::top_shift);
        if (top != 255) {
            if (started_) bytes_.push_back(static_cast<std::uint8_t>(held_ + (top >> 8)));
            for (; waiting_ > 0; --waiting_)
                bytes_.push_back(static_cast<std::uint8_t>(255 + (top >> 8)));
            held_ = top & 255;
            started_ = true;
        } else {
            ++waiting_;
        }
        low_ = (low_ & (range_coder::least - 1)) << 8;
    }

    std::vector<std::uint8_t> bytes_;
    std::uint64_t low_ = 0, range_ = range_coder::whole - 1;
    unsigned held_ = 0;
    std::uint64_t waiting_ = 0;
    bool started_ = false;
};

class RangeDecoder {
  public:
    explicit RangeDecoder(std::span<const std::uint8_t> bytes)
        : next_(bytes.data()), end_(next_ + bytes.size()) {
        for (int i = 0; i < 7; ++i)
            code_ = code_ << 8 | byte();
    }

    int decode(BitModel& model) {
        const std::uint64_t bound = (range_ >> BitModel::fractions) * model.zero_of();
        const int bit = code_ < bound ? 0 : 1;
        if (bit == 0) {
            range_ = bound;
        } else {
            code_ -= bound;
            range_ -= bound;
        }
        model.learn(bit);
        while (range_ < range_coder::least) {
            range_ <<= 8;
            code_ = code_ << 8 | byte();
        }
        return bit;
    }

  private:
    std::uint64_t byte() { return next_ < end_ ? *next_++ : 0; }

    const std::uint8_t* next_;
    const std::uint8_t* end_;
    std::uint64_t code_ = 0, range_ = range_coder::whole - 1;
};

}  // namespace obscura
