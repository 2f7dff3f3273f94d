// Rows of 16-bit floats, sixteen numbers at a time.

#include "core/simd.h"
#include "stereo/thesis/half_rows.h"

namespace obscura::OBSCURA_ISA {

void half_row(const float* x, int count, std::uint16_t* half) noexcept {
    const F32 most = splat(65504.0f), scale = splat(0x1p-112f);
    const I32 one = splat(1), below = splat(0xfff);
    for (int i = 0; i < count; i += lanes) {
        const F32 value = load(x + i);
        const I32 bits = bitcast_i32(min(abs(value), most) * scale);
        const I32 rounded = shift_right_logical<13>(bits + below + (shift_right_logical<13>(bits) & one));
        const I32 sign = shift_left<15>(shift_right_logical<31>(bitcast_i32(value)));
        alignas(64) std::int32_t lane[16];
        store(lane, rounded | sign);
        for (int l = 0; l < lanes; ++l)
            half[i + l] = static_cast<std::uint16_t>(lane[l]);
    }
}

void float_row(const std::uint16_t* half, int count, float* x) noexcept {
    const F32 scale = splat(0x1p112f);
    const I32 size_bits = splat(0x7fff), sign_bit = splat(0x8000);
    for (int i = 0; i < count; i += lanes) {
        alignas(64) std::int32_t lane[16];
        for (int l = 0; l < lanes; ++l)
            lane[l] = half[i + l];
        const I32 bits = load(lane);
        const F32 size = bitcast_f32(shift_left<13>(bits & size_bits)) * scale;
        store(x + i, bitcast_f32(bitcast_i32(size) | shift_left<16>(bits & sign_bit)));
    }
}

}  // namespace obscura::OBSCURA_ISA
