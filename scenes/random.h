#pragma once
// The generators' only source of chance: SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number
// generators", OOPSLA 2014; constants of Vigna's public-domain splitmix64.c). One 64-bit state, integers
// only, so a seed means the same city on every machine.

#include <cstdint>

namespace obscura {

struct Random {
    std::uint64_t state = 0;

    explicit Random(std::uint64_t seed) : state(seed) {}

    std::uint64_t next() {
        state += 0x9e3779b97f4a7c15u;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// Uniform in [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    /// Uniform in [low, high).
    double range(double low, double high) { return low + (high - low) * uniform(); }
    /// Uniform in 0 .. count - 1; count > 0. (The bias of the plain remainder is below 2^-32 here.)
    int index(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
    /// True with the given probability.
    bool chance(double probability) { return uniform() < probability; }
    /// An independent stream, named by `tag`: what one part draws does not move another part's dice.
    Random fork(std::uint64_t tag) const {
        Random child(state ^ (tag * 0xd1342543de82ef95u + 0x2545f4914f6cdd1du));
        child.next();
        return child;
    }
};

}  // namespace obscura
