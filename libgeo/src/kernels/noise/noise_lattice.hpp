#pragma once

#include <array>
#include <cstdint>

namespace geo::lattice {

using Position = std::array<double, 3>;

/// Turns of the lattice from octave to octave, and what is found at its nodes.
struct Tables {
  /// A turn about (1, 2, 3) by 65 degrees: no row is near a coordinate axis, and no power of it
  /// that an fbm could reach comes back to the identity.
  std::array<Position, 3> turn;
  struct alignas(16) Gradient {
    float x, y, z, unused;
  };
  std::array<Gradient, 256> gradient;
};
const Tables& tables();

inline Position turned(const Position& p, const std::array<Position, 3>& turn) {
  Position out{};
  for (int i = 0; i < 3; ++i) out[i] = turn[i][0] * p[0] + turn[i][1] * p[1] + turn[i][2] * p[2];
  return out;
}

// The hash of a node mixes each coordinate before the next is added, so that no displacement of the
// lattice repeats the pattern; the last rounds are the "lowbias32" finaliser (Wellons 2018).
constexpr std::array<std::uint32_t, 3> kStep{0x9e3779b1U, 0x85ebca77U, 0xc2b2ae3dU};

inline std::uint32_t mixed_x(std::uint32_t h) {
  h ^= h >> 15;
  return h * 0x2c1b3c6dU;
}
inline std::uint32_t mixed_y(std::uint32_t h) {
  h ^= h >> 13;
  return h * 0x297a2d39U;
}
inline std::uint32_t mixed_z(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352dU;
  h ^= h >> 15;
  h *= 0x846ca68bU;
  return h ^ h >> 16;
}

inline float fade(float t) { return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F); }

/// Key of one octave of an fbm.
inline std::uint32_t octave_key(std::uint32_t key, int octave) {
  return key + static_cast<std::uint32_t>(octave) * 0x9e3779b9U;
}

}  // namespace geo::lattice
