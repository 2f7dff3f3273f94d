#include "core/isa.h"

#include <array>

namespace obscura {
namespace {

constexpr std::array<std::string_view, 4> names = {"ref", "sse2", "avx2", "avx512bw"};

}  // namespace

bool isa_supported(Isa isa) {
    // __builtin_cpu_supports also asks the operating system (XGETBV) for the wide register state.
    switch (isa) {
        case Isa::ref:
        case Isa::sse2:
            return true;
        case Isa::avx2:
            return __builtin_cpu_supports("avx2") != 0;
        case Isa::avx512bw:
            return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512cd") != 0 &&
                   __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
                   __builtin_cpu_supports("avx512vl") != 0;
    }
    return false;
}

Isa best_isa() {
    if (isa_supported(Isa::avx512bw)) return Isa::avx512bw;
    return isa_supported(Isa::avx2) ? Isa::avx2 : Isa::sse2;
}

std::vector<Isa> supported_isas() {
    std::vector<Isa> all;
    for (const Isa isa : {Isa::ref, Isa::sse2, Isa::avx2, Isa::avx512bw}) {
        if (isa_supported(isa)) all.push_back(isa);
    }
    return all;
}

std::string_view isa_name(Isa isa) {
    return names[static_cast<std::size_t>(isa)];
}

std::optional<Isa> parse_isa(std::string_view text) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == text) return static_cast<Isa>(i);
    }
    return std::nullopt;
}

}  // namespace obscura
