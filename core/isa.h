#pragma once
// Which instruction set a hot loop runs on. Every value gives the same bits; `ref` is the scalar lesson.

#include <optional>
#include <string_view>
#include <vector>

namespace obscura {

enum class Isa { ref, sse2, avx2, avx512bw };

/// Best set this CPU and its operating system support (never `ref`).
Isa best_isa();
/// True when kernels of this set can run here.
bool isa_supported(Isa isa);
/// Every set that can run here, `ref` first.
std::vector<Isa> supported_isas();
std::string_view isa_name(Isa isa);
/// "ref", "sse2", "avx2", "avx512bw"; nothing for any other text.
std::optional<Isa> parse_isa(std::string_view text);

/// How to execute: passed explicitly, so that one process can sweep both. threads = 0: all of the machine.
struct Exec {
    Isa isa = best_isa();
    int threads = 0;
};

}  // namespace obscura

/// Calls the twin of a kernel that `exec_isa` asks for. FN is declared in ref::, sse2::, avx2:: and
/// avx512bw::.
#define OBSCURA_DISPATCH(exec_isa, FN, ...) \
    do {                                    \
        switch (exec_isa) {                 \
            case ::obscura::Isa::ref:       \
                ref::FN(__VA_ARGS__);       \
                break;                      \
            case ::obscura::Isa::sse2:      \
                sse2::FN(__VA_ARGS__);      \
                break;                      \
            case ::obscura::Isa::avx2:      \
                avx2::FN(__VA_ARGS__);      \
                break;                      \
            case ::obscura::Isa::avx512bw:  \
                avx512bw::FN(__VA_ARGS__);  \
                break;                      \
        }                                   \
    } while (false)
