#pragma once
// Sixteen lanes, on every machine: the vocabulary that kernels are written in.
//
// A kernel file is compiled once per instruction set with OBSCURA_ISA = sse2, avx2 or avx512bw (see
// add_simd_kernels). One logical vector of 16 lanes is 4, 2 or 1 registers, so tails and reductions have one
// order everywhere and the results are the same bits. Everything here has internal linkage: a wide object
// must leave no symbol that the linker could hand to code meant for a lesser machine.
//
// F32, I32, F64, I64: 16 lanes each. Mask: 16 booleans. min/max follow SSE: min(a, b) = a < b ? a : b, so
// with a NaN the second operand wins; the scalar twins in core/scalar_lanes.h agree.
//
// xsimd 8.1 has no bit mask of batch_bool, no gather and no 64-bit sign test; those are intrinsics below.
//
// One topic, one header: this one includes them all. They are the only door to xsimd and to wide intrinsics.

#include "core/simd_arithmetic.h"
#include "core/simd_compare.h"
#include "core/simd_convert.h"
#include "core/simd_gather.h"
#include "core/simd_lanes.h"
#include "core/simd_transpose.h"
