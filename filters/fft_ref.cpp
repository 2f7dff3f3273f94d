// Fast Fourier transforms, one pass after the other: radix 4, and radix 2 where a factor of 2 remains.
//
// Forward, a pass of length n cuts x into four quarters. With t_j(k) = sum over m of x(k + m n/4) (-i)^(j m),
// the coefficients j, j + 4, j + 8, ... of x are the transform of t_j(k) w_n^(j k), w_n = e^(-2 pi i / n), of
// length n/4: decimation in frequency. Backward undoes the passes from the last to the first.

#include "filters/fft.h"

namespace obscura::ref {
namespace {

struct Complex {
    float re, im;
};
Complex operator+(Complex a, Complex b) {
    return {a.re + b.re, a.im + b.im};
}
Complex operator-(Complex a, Complex b) {
    return {a.re - b.re, a.im - b.im};
}
Complex operator*(Complex a, Complex w) {
    return {a.re * w.re - a.im * w.im, a.re * w.im + a.im * w.re};
}
/// a times the conjugate of w.
Complex times_conjugate(Complex a, Complex w) {
    return {a.re * w.re + a.im * w.im, a.im * w.re - a.re * w.im};
}
Complex times_i(Complex a) {
    return {-a.im, a.re};
}

/// The sixteen sequences.
struct Sequences {
    float *re, *im;
    Complex get(int k, int lane) const { return {re[16 * k + lane], im[16 * k + lane]}; }
    void set(int k, int lane, Complex z) const {
        re[16 * k + lane] = z.re;
        im[16 * k + lane] = z.im;
    }
};

/// w_n^(j k); j = 1, 2, 3.
Complex twiddle(const FftTable& table, int n, int j, int k) {
    const int at = fft_pass_offset(n) + 3 * k + j - 1;
    return {table.re[at], table.im[at]};
}
/// In short passes, eighths of a turn take two products instead of four: how many there are in w_n^(j k), or
/// -1.
int eighths(int n, int j, int k) {
    return n <= 16 && 8 * j * k % n == 0 ? 8 * j * k / n : -1;
}

/// z w_n^(j k).
Complex turned(Complex z, const FftTable& table, int n, int j, int k) {
    const float sum = z.re + z.im, difference = z.im - z.re, h = fft_eighth;
    switch (eighths(n, j, k)) {
        case 1:
            return {sum * h, difference * h};
        case 2:
            return {z.im, -z.re};
        case 3:
            return {difference * h, -sum * h};
        default:
            return z * twiddle(table, n, j, k);
    }
}
/// z over w_n^(j k).
Complex turned_back(Complex z, const FftTable& table, int n, int j, int k) {
    const float sum = z.re + z.im, difference = z.re - z.im, h = fft_eighth;
    switch (eighths(n, j, k)) {
        case 1:
            return {difference * h, sum * h};
        case 2:
            return {-z.im, z.re};
        case 3:
            return {-sum * h, difference * h};
        default:
            return times_conjugate(z, twiddle(table, n, j, k));
    }
}

/// One of the n/4 butterflies of a block that starts at `first`.
void forward4(const FftTable& table, const Sequences& x, int first, int n, int k, int lane) {
    const int q = n / 4, at = first + k;
    const Complex x0 = x.get(at, lane), x1 = x.get(at + q, lane);
    const Complex x2 = x.get(at + 2 * q, lane), x3 = x.get(at + 3 * q, lane);
    const Complex a = x0 + x2, b = x0 - x2, c = x1 + x3, d = times_i(x1 - x3);
    Complex t[4] = {a + c, b - d, a - c, b + d};
    for (int j = 1; j < 4 && k > 0; ++j)
        t[j] = turned(t[j], table, n, j, k);
    for (int j = 0; j < 4; ++j)
        x.set(at + j * q, lane, t[j]);
}

void backward4(const FftTable& table, const Sequences& x, int first, int n, int k, int lane) {
    const int q = n / 4, at = first + k;
    Complex t[4];
    for (int j = 0; j < 4; ++j)
        t[j] = x.get(at + j * q, lane);
    for (int j = 1; j < 4 && k > 0; ++j)
        t[j] = turned_back(t[j], table, n, j, k);
    const Complex a = t[0] + t[2], b = t[0] - t[2], c = t[1] + t[3], d = times_i(t[1] - t[3]);
    x.set(at, lane, a + c);
    x.set(at + q, lane, b + d);
    x.set(at + 2 * q, lane, a - c);
    x.set(at + 3 * q, lane, b - d);
}

/// Both directions: neighbours' sum and difference.
void pass2(const Sequences& x, int length) {
    for (int first = 0; first < length; first += 2) {
        for (int lane = 0; lane < 16; ++lane) {
            const Complex x0 = x.get(first, lane), x1 = x.get(first + 1, lane);
            x.set(first, lane, x0 + x1);
            x.set(first + 1, lane, x0 - x1);
        }
    }
}

using Butterfly = void (*)(const FftTable&, const Sequences&, int, int, int, int);

void pass4(const FftTable& table, const Sequences& x, int n, Butterfly butterfly) {
    for (int first = 0; first < 1 << table.log2_length; first += n) {
        for (int k = 0; k < n / 4; ++k) {
            for (int lane = 0; lane < 16; ++lane)
                butterfly(table, x, first, n, k, lane);
        }
    }
}

}  // namespace

void fft16_forward(const FftTable& table, float* re, float* im) noexcept {
    const int length = 1 << table.log2_length;
    const Sequences x{re, im};
    for (int n = length; n >= 4; n /= 4)
        pass4(table, x, n, forward4);
    if (table.log2_length % 2 == 1) pass2(x, length);
}

void fft16_backward(const FftTable& table, float* re, float* im) noexcept {
    const int length = 1 << table.log2_length;
    const Sequences x{re, im};
    if (table.log2_length % 2 == 1) pass2(x, length);
    for (int n = table.log2_length % 2 == 0 ? 4 : 8; n <= length; n *= 4)
        pass4(table, x, n, backward4);
}

}  // namespace obscura::ref
