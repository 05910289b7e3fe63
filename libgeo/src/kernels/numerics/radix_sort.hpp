#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace geo {

/// Least-significant-digit radix sort: linear, and stable whatever the number of threads. Digits
/// that all keys have in common cost one pass over them.
inline void sort_keys(std::vector<std::uint64_t>& keys) {
  constexpr int kBits = 11, kBuckets = 1 << kBits;
  std::vector<std::uint64_t> other(keys.size());
  for (int shift = 0; shift < 64; shift += kBits) {
    std::array<std::size_t, kBuckets + 1> start{};
    for (const std::uint64_t key : keys) ++start[((key >> shift) & (kBuckets - 1)) + 1];
    if (std::find(start.begin(), start.end(), keys.size()) != start.end()) continue;
    for (int b = 0; b < kBuckets; ++b) start[b + 1] += start[b];
    for (const std::uint64_t key : keys) other[start[(key >> shift) & (kBuckets - 1)]++] = key;
    keys.swap(other);
  }
}

}  // namespace geo
