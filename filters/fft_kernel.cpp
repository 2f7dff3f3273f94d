// Fast Fourier transforms, sixteen at once: the passes of fft_ref.cpp, two at a time where both fit into the
// registers (a radix of 16), and depth first: a block is finished while it is in the cache.
//
// A twiddle is the same for all lanes: one scalar, broadcast by the load. Butterflies are written for one
// register; where sixteen lanes need several, these follow one another.

#include "core/simd.h"
#include "filters/fft.h"

namespace obscura::OBSCURA_ISA {
namespace {

using Reg = F32::Reg;

struct Complex {
    Reg re, im;
};
OBSCURA_INLINE Complex operator+(const Complex& a, const Complex& b) {
    return {a.re + b.re, a.im + b.im};
}
OBSCURA_INLINE Complex operator-(const Complex& a, const Complex& b) {
    return {a.re - b.re, a.im - b.im};
}
/// a + i b and a - i b.
OBSCURA_INLINE Complex plus_i(const Complex& a, const Complex& b) {
    return {a.re - b.im, a.im + b.re};
}
OBSCURA_INLINE Complex minus_i(const Complex& a, const Complex& b) {
    return {a.re + b.im, a.im - b.re};
}

struct Forward {
    static constexpr bool forward = true;
    OBSCURA_INLINE static Complex turned(const Complex& a, float re, float im) {
        const Reg c(re), s(im);
        return {a.re * c - a.im * s, a.re * s + a.im * c};
    }
    /// By an eighth of a turn, and by three.
    OBSCURA_INLINE static Complex eighth(const Complex& a) {
        const Reg h(fft_eighth);
        return {(a.re + a.im) * h, (a.im - a.re) * h};
    }
    OBSCURA_INLINE static Complex three_eighths(const Complex& a) {
        const Reg h(fft_eighth), minus_h(-fft_eighth);
        return {(a.im - a.re) * h, (a.re + a.im) * minus_h};
    }
    /// a + b turned by a quarter, and by three.
    OBSCURA_INLINE static Complex quarter(const Complex& a, const Complex& b) { return minus_i(a, b); }
    OBSCURA_INLINE static Complex three_quarters(const Complex& a, const Complex& b) { return plus_i(a, b); }
};
struct Backward {
    static constexpr bool forward = false;
    OBSCURA_INLINE static Complex turned(const Complex& a, float re, float im) {
        const Reg c(re), s(im);
        return {a.re * c + a.im * s, a.im * c - a.re * s};
    }
    OBSCURA_INLINE static Complex eighth(const Complex& a) {
        const Reg h(fft_eighth);
        return {(a.re - a.im) * h, (a.re + a.im) * h};
    }
    OBSCURA_INLINE static Complex three_eighths(const Complex& a) {
        const Reg h(fft_eighth), minus_h(-fft_eighth);
        return {(a.re + a.im) * minus_h, (a.re - a.im) * h};
    }
    OBSCURA_INLINE static Complex quarter(const Complex& a, const Complex& b) { return plus_i(a, b); }
    OBSCURA_INLINE static Complex three_quarters(const Complex& a, const Complex& b) { return minus_i(a, b); }
};

/// Four elements of the sequences, and how they turn.
struct Four {
    Complex x0, x1, x2, x3;
};

template <class Direction>
OBSCURA_INLINE void mix(Four& x) {
    const Complex a = x.x0 + x.x2, b = x.x0 - x.x2, c = x.x1 + x.x3, d = x.x1 - x.x3;
    x = {a + c, Direction::quarter(b, d), a - c, Direction::three_quarters(b, d)};
}

/// The same where x2 waits for a quarter turn.
template <class Direction>
OBSCURA_INLINE void mix_with_quarter(Four& x) {
    const Complex a = Direction::quarter(x.x0, x.x2), b = Direction::three_quarters(x.x0, x.x2);
    const Complex c = x.x1 + x.x3, d = x.x1 - x.x3;
    x = {a + c, Direction::quarter(b, d), a - c, Direction::three_quarters(b, d)};
}

struct Twiddles {
    const float *re, *im;
    OBSCURA_INLINE Twiddles at(std::ptrdiff_t k) const { return {re + 3 * k, im + 3 * k}; }
};
template <class Direction>
OBSCURA_INLINE void turn(Four& x, const Twiddles& w) {
    x.x1 = Direction::turned(x.x1, w.re[0], w.im[0]);
    x.x2 = Direction::turned(x.x2, w.re[1], w.im[1]);
    x.x3 = Direction::turned(x.x3, w.re[2], w.im[2]);
}
/// The turns of k = n/8, of which x2's quarter is left to the next step.
template <class Direction>
OBSCURA_INLINE void turn_by_eighths(Four& x) {
    x.x1 = Direction::eighth(x.x1);
    x.x3 = Direction::three_eighths(x.x3);
}
OBSCURA_INLINE Twiddles twiddles(const FftTable& table, int n) {
    return {table.re + fft_pass_offset(n), table.im + fft_pass_offset(n)};
}

/// Where a sequence's elements are, in one register of the sixteen lanes.
struct Block {
    float *re, *im;
    OBSCURA_INLINE Block from(std::ptrdiff_t k) const { return {re + lanes * k, im + lanes * k}; }
    OBSCURA_INLINE Block lane(int first) const { return {re + first, im + first}; }
    OBSCURA_INLINE Complex get(std::ptrdiff_t k) const {
        return {Reg::load_aligned(re + lanes * k), Reg::load_aligned(im + lanes * k)};
    }
    OBSCURA_INLINE void set(std::ptrdiff_t k, const Complex& z) const {
        z.re.store_aligned(re + lanes * k);
        z.im.store_aligned(im + lanes * k);
    }
    OBSCURA_INLINE Four get4(std::ptrdiff_t step) const {
        return {get(0), get(step), get(2 * step), get(3 * step)};
    }
    OBSCURA_INLINE void set4(std::ptrdiff_t step, const Four& x) const {
        set(0, x.x0);
        set(step, x.x1);
        set(2 * step, x.x2);
        set(3 * step, x.x3);
    }
};
/// Rows become columns.
OBSCURA_INLINE void transpose(Four& a, Four& b, Four& c, Four& d) {
    const Four a2{a.x0, b.x0, c.x0, d.x0}, b2{a.x1, b.x1, c.x1, d.x1}, c2{a.x2, b.x2, c.x2, d.x2},
        d2{a.x3, b.x3, c.x3, d.x3};
    a = a2, b = b2, c = c2, d = d2;
}

/// Calls fn(block) for every register of the sixteen lanes.
template <class Fn>
OBSCURA_INLINE void for_registers(const Block& x, const Fn& fn) {
    for (int r = 0; r < F32::regs; ++r)
        fn(x.lane(r * F32::width));
}

/// Two passes, of lengths n and n/4, on the elements 0, s, 2 s, ..., 15 s from x; s = n/16. `outer` and
/// `inner` are their twiddles at k; k = 0 (`first`) needs none of the inner.
template <bool first>
OBSCURA_INLINE void forward16(const Block& x, std::ptrdiff_t s, const Twiddles& outer,
                              const Twiddles& inner) {
    Four a = x.get4(4 * s);
    mix<Forward>(a);
    if (!first) turn<Forward>(a, outer);
    Four b = x.from(s).get4(4 * s);
    mix<Forward>(b);
    turn<Forward>(b, outer.at(s));
    Four c = x.from(2 * s).get4(4 * s);
    mix<Forward>(c);
    turn<Forward>(c, outer.at(2 * s));
    Four d = x.from(3 * s).get4(4 * s);
    mix<Forward>(d);
    turn<Forward>(d, outer.at(3 * s));
    transpose(a, b, c, d);
    const auto finish = [&](Four & row, std::ptrdiff_t at) __attribute__((always_inline)) {
        mix<Forward>(row);
        if (!first) turn<Forward>(row, inner);
        x.from(at).set4(s, row);
    };
    finish(a, 0);
    finish(b, 4 * s);
    finish(c, 8 * s);
    finish(d, 12 * s);
}

template <bool first>
OBSCURA_INLINE void backward16(const Block& x, std::ptrdiff_t s, const Twiddles& outer,
                               const Twiddles& inner) {
    const auto begin = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
        Four row = x.from(at).get4(s);
        if (!first) turn<Backward>(row, inner);
        mix<Backward>(row);
        return row;
    };
    Four a = begin(0), b = begin(4 * s), c = begin(8 * s), d = begin(12 * s);
    transpose(a, b, c, d);
    if (!first) turn<Backward>(a, outer);
    mix<Backward>(a);
    x.set4(4 * s, a);
    turn<Backward>(b, outer.at(s));
    mix<Backward>(b);
    x.from(s).set4(4 * s, b);
    turn<Backward>(c, outer.at(2 * s));
    mix<Backward>(c);
    x.from(2 * s).set4(4 * s, c);
    turn<Backward>(d, outer.at(3 * s));
    mix<Backward>(d);
    x.from(3 * s).set4(4 * s, d);
}

/// Both passes of a transform of length 16, where many turns are eighths.
OBSCURA_INLINE void forward_whole16(const Block& x, const Twiddles& w) {
    Four a = x.get4(4), b = x.from(1).get4(4), c = x.from(2).get4(4), d = x.from(3).get4(4);
    mix<Forward>(a);
    mix<Forward>(b);
    b = {b.x0, Forward::turned(b.x1, w.re[3], w.im[3]), Forward::eighth(b.x2),
         Forward::turned(b.x3, w.re[5], w.im[5])};
    mix<Forward>(c);
    turn_by_eighths<Forward>(c);
    mix<Forward>(d);
    d = {d.x0, Forward::turned(d.x1, w.re[9], w.im[9]), Forward::three_eighths(d.x2),
         Forward::turned(d.x3, w.re[11], w.im[11])};
    transpose(a, b, c, d);
    mix<Forward>(a);
    x.set4(1, a);
    mix<Forward>(b);
    x.from(4).set4(1, b);
    mix_with_quarter<Forward>(c);
    x.from(8).set4(1, c);
    mix<Forward>(d);
    x.from(12).set4(1, d);
}
OBSCURA_INLINE void backward_whole16(const Block& x, const Twiddles& w) {
    Four a = x.get4(1), b = x.from(4).get4(1), c = x.from(8).get4(1), d = x.from(12).get4(1);
    mix<Backward>(a);
    mix<Backward>(b);
    mix<Backward>(c);
    mix<Backward>(d);
    transpose(a, b, c, d);
    mix<Backward>(a);
    x.set4(4, a);
    b = {b.x0, Backward::turned(b.x1, w.re[3], w.im[3]), Backward::eighth(b.x2),
         Backward::turned(b.x3, w.re[5], w.im[5])};
    mix<Backward>(b);
    x.from(1).set4(4, b);
    turn_by_eighths<Backward>(c);
    mix_with_quarter<Backward>(c);
    x.from(2).set4(4, c);
    d = {d.x0, Backward::turned(d.x1, w.re[9], w.im[9]), Backward::three_eighths(d.x2),
         Backward::turned(d.x3, w.re[11], w.im[11])};
    mix<Backward>(d);
    x.from(3).set4(4, d);
}

/// A radix-4 pass and the radix-2 pass after it: a whole transform of length 8.
OBSCURA_INLINE void forward_whole8(const Block& x) {
    Four a = x.get4(2), b = x.from(1).get4(2);
    mix<Forward>(a);
    mix<Forward>(b);
    turn_by_eighths<Forward>(b);
    x.set4(2, {a.x0 + b.x0, a.x1 + b.x1, Forward::quarter(a.x2, b.x2), a.x3 + b.x3});
    x.from(1).set4(2, {a.x0 - b.x0, a.x1 - b.x1, Forward::three_quarters(a.x2, b.x2), a.x3 - b.x3});
}
OBSCURA_INLINE void backward_whole8(const Block& x) {
    const Four even = x.get4(2), odd = x.from(1).get4(2);
    Four a{even.x0 + odd.x0, even.x1 + odd.x1, even.x2 + odd.x2, even.x3 + odd.x3};
    Four b{even.x0 - odd.x0, even.x1 - odd.x1, even.x2 - odd.x2, even.x3 - odd.x3};
    turn_by_eighths<Backward>(b);
    mix<Backward>(a);
    mix_with_quarter<Backward>(b);
    x.set4(2, a);
    x.from(1).set4(2, b);
}
/// A whole transform of length 4, or 2.
template <class Direction>
OBSCURA_INLINE void whole4(const Block& x) {
    Four a = x.get4(1);
    mix<Direction>(a);
    x.set4(1, a);
}
OBSCURA_INLINE void whole2(const Block& x) {
    const Complex a = x.get(0), b = x.get(1);
    x.set(0, a + b);
    x.set(1, a - b);
}

/// One radix-4 pass of length n.
void forward_pass4(const Block& x, int n, const Twiddles& w) {
    for (int k = 0; k < n / 4; ++k) {
        for_registers(
            x.from(k), [&](const Block& y) __attribute__((always_inline)) {
                Four a = y.get4(n / 4);
                mix<Forward>(a);
                if (k > 0) turn<Forward>(a, w.at(k));
                y.set4(n / 4, a);
            });
    }
}
void backward_pass4(const Block& x, int n, const Twiddles& w) {
    for (int k = 0; k < n / 4; ++k) {
        for_registers(
            x.from(k), [&](const Block& y) __attribute__((always_inline)) {
                Four a = y.get4(n / 4);
                if (k > 0) turn<Backward>(a, w.at(k));
                mix<Backward>(a);
                y.set4(n / 4, a);
            });
    }
}
/// Two passes, of lengths n and n/4.
void forward_pass16(const Block& x, int n, const Twiddles& outer, const Twiddles& inner) {
    for_registers(
        x, [&](const Block& y) __attribute__((always_inline)) { forward16<true>(y, n / 16, outer, inner); });
    for (int k = 1; k < n / 16; ++k) {
        for_registers(
            x.from(k), [&](const Block& y) __attribute__((always_inline)) {
                forward16<false>(y, n / 16, outer.at(k), inner.at(k));
            });
    }
}
void backward_pass16(const Block& x, int n, const Twiddles& outer, const Twiddles& inner) {
    for_registers(
        x, [&](const Block& y) __attribute__((always_inline)) { backward16<true>(y, n / 16, outer, inner); });
    for (int k = 1; k < n / 16; ++k) {
        for_registers(
            x.from(k), [&](const Block& y) __attribute__((always_inline)) {
                backward16<false>(y, n / 16, outer.at(k), inner.at(k));
            });
    }
}

/// Blocks that no pass divides: lengths 1 to 16.
template <class Direction>
OBSCURA_INLINE void short_block(const FftTable& table, const Block& x, int log2_n) {
    constexpr bool forward = Direction::forward;
    for_registers(
        x, [&](const Block& y) __attribute__((always_inline)) {
            switch (log2_n) {
                case 1:
                    whole2(y);
                    break;
                case 2:
                    whole4<Direction>(y);
                    break;
                case 3:
                    forward ? forward_whole8(y) : backward_whole8(y);
                    break;
                case 4:
                    forward ? forward_whole16(y, twiddles(table, 16))
                            : backward_whole16(y, twiddles(table, 16));
                    break;
                default:
                    break;
            }
        });
}

/// Longer blocks: radix 16 where its 32 lines lie in different sets of the first cache (256 elements), else
/// radix 4. Powers of two apart, more lines would push each other out before they are written.
OBSCURA_INLINE int log2_radix(int log2_n) {
    return log2_n == 8 ? 4 : 2;
}

void forward_block(const FftTable& table, const Block& x, int log2_n) {
    if (log2_n <= 4) return short_block<Forward>(table, x, log2_n);
    const int n = 1 << log2_n, log2_part = log2_n - log2_radix(log2_n);
    if (log2_radix(log2_n) == 4) {
        forward_pass16(x, n, twiddles(table, n), twiddles(table, n / 4));
    } else {
        forward_pass4(x, n, twiddles(table, n));
    }
    for (int at = 0; at < n; at += 1 << log2_part)
        forward_block(table, x.from(at), log2_part);
}

void backward_block(const FftTable& table, const Block& x, int log2_n) {
    if (log2_n <= 4) return short_block<Backward>(table, x, log2_n);
    const int n = 1 << log2_n, log2_part = log2_n - log2_radix(log2_n);
    for (int at = 0; at < n; at += 1 << log2_part)
        backward_block(table, x.from(at), log2_part);
    if (log2_radix(log2_n) == 4) {
        backward_pass16(x, n, twiddles(table, n), twiddles(table, n / 4));
    } else {
        backward_pass4(x, n, twiddles(table, n));
    }
}

}  // namespace

void fft16_forward(const FftTable& table, float* re, float* im) noexcept {
    forward_block(table, {re, im}, table.log2_length);
}

void fft16_backward(const FftTable& table, float* re, float* im) noexcept {
    backward_block(table, {re, im}, table.log2_length);
}

}  // namespace obscura::OBSCURA_ISA
