#include "bench/stereo/memory_pass.h"

#include <emmintrin.h>

#include <new>

#include "core/parallel.h"

namespace obscura {
namespace {

constexpr std::size_t block_floats = std::size_t{1} << 15;

template <class Store>
void pass(const float* a, const float* b, const float* c, float* d, std::size_t begin, std::size_t end,
          Store&& store) {
    const __m128 share = _mm_set1_ps(0.75f);
    for (std::size_t i = begin; i < end; i += 16) {
        for (std::size_t j = i; j < i + 16; j += 4) {
            const __m128 change = _mm_sub_ps(_mm_load_ps(b + j), _mm_load_ps(c + j));
            store(d + j, _mm_add_ps(_mm_load_ps(a + j), _mm_mul_ps(share, change)));
        }
    }
}

}  // namespace

void MemoryPass::FreeAligned::operator()(float* p) const {
    _mm_free(p);
}

MemoryPass::MemoryPass(std::size_t count) : count_((count + 15) / 16 * 16) {
    for (int k = 0; k < 4; ++k) {
        arrays_[k].reset(static_cast<float*>(_mm_malloc(count_ * sizeof(float), 64)));
        if (arrays_[k] == nullptr) throw std::bad_alloc();
        for (std::size_t i = 0; i < count_; ++i)
            arrays_[k].get()[i] = static_cast<float>(k + 1);
    }
}

void MemoryPass::run(bool streaming, const Exec& exec) {
    parallel_blocks(count_, block_floats, exec, [&](std::size_t begin, std::size_t end) {
        const float *a = arrays_[0].get(), *b = arrays_[1].get(), *c = arrays_[2].get();
        float* const d = arrays_[3].get();
        if (streaming) {
            pass(a, b, c, d, begin, end, [](float* to, __m128 v) { _mm_stream_ps(to, v); });
            _mm_sfence();
        } else {
            pass(a, b, c, d, begin, end, [](float* to, __m128 v) { _mm_store_ps(to, v); });
        }
    });
}

}  // namespace obscura
