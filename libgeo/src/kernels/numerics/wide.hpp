#pragma once

/// Marks a function whose loops the compiler vectorises: it is made twice, for processors with AVX2
/// and for any other, and the right one is chosen when the program starts. Neither fuses a product
/// with a sum (AVX2 without FMA), so both give the same bits. Elsewhere the mark does nothing.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TERRANE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define TERRANE_WIDE
#endif
