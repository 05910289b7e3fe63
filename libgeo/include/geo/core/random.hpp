#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace geo {

/// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, Random123) keyed by the seed
/// and a stream name. A number depends on (seed, stream, index) alone, never on what was drawn
/// before or on which thread draws, so results are the same for any number of threads.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Four independent 32-bit words.
  [[nodiscard]] std::array<std::uint32_t, 4> words(std::uint64_t index,
                                                   std::uint64_t sub_index = 0) const;
  /// Uniform in [0, 1) with 53 bits.
  [[nodiscard]] double uniform(std::uint64_t index, std::uint64_t sub_index = 0) const;
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(std::uint64_t index, std::uint64_t sub_index, double low,
                               double high) const {
    return low + (high - low) * uniform(index, sub_index);
  }
  /// Standard normal deviate (Box-Muller).
  [[nodiscard]] double normal(std::uint64_t index, std::uint64_t sub_index = 0) const;
  /// Uniform on the unit sphere.
  [[nodiscard]] std::array<double, 3> direction(std::uint64_t index) const;

 private:
  std::array<std::uint32_t, 2> key_;
};

}  // namespace geo
