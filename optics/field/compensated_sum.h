#pragma once
// Long sums of floats. Equal terms round alike, so that a plain sum of a thousand is wrong by more than 1e-6.

namespace obscura {
namespace {

/// W. Kahan: Further remarks on reducing truncation errors, 1965. `lost` is what the sum has too much; T is a
/// float or sixteen of them.
template <class T>
inline __attribute__((always_inline)) void add_compensated(const T& term, T& sum, T& lost) {
    const T rest = term - lost;
    const T next = sum + rest;
    lost = (next - sum) - rest;
    sum = next;
}

}  // namespace
}  // namespace obscura
