// Noise::fbm at many positions: the steps of one octave, each over a block of positions, so that
// the compiler vectorises them. The same operations in the same order as at a single position,
// hence the same bits.
#include <algorithm>
#include <bit>
#include <cmath>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "kernels/numerics/wide.hpp"
#include "noise_lattice.hpp"

namespace geo {
namespace {

constexpr int kBlock = 64;
constexpr int kCorners = 8;  // x fastest

using Rotation = std::array<lattice::Position, 3>;
using Doubles = std::array<double, kBlock>;
using Floats = std::array<float, kBlock>;
using Words = std::array<std::uint32_t, kBlock>;

/// x and y of a gradient: one load. Its z follows from its number.
struct alignas(8) Level {
  float x, y;
};

using Levels = std::array<Level, kBlock>;

struct Block {
  alignas(64) std::array<Doubles, 3> place;  // turned with every octave
  std::array<Doubles, 3> in_lattice;
  Doubles sum;
  std::array<Floats, 3> offset;
  std::array<Words, 3> node;
  std::array<Words, kCorners> gradient;
  std::array<Levels, kCorners> level;
};

std::array<Level, 256> levels() {
  std::array<Level, 256> all{};
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& g = lattice::tables().gradient[k];
    all[k] = {g.x, g.y};
  }
  return all;
}

TERRANE_WIDE void turn(Block& block, const Rotation& by, const std::array<double, 3>& shift) {
  const auto [xx, xy, xz] = by[0];
  const auto [yx, yy, yz] = by[1];
  const auto [zx, zy, zz] = by[2];
  const auto [along_x, along_y, along_z] = shift;
  for (int k = 0; k < kBlock; ++k) {
    const double x = block.place[0][k], y = block.place[1][k], z = block.place[2][k];
    const double east = xx * x + xy * y + xz * z;
    const double north = yx * x + yy * y + yz * z;
    const double up = zx * x + zy * y + zz * z;
    block.in_lattice[0][k] = east + along_x;
    block.in_lattice[1][k] = north + along_y;
    block.in_lattice[2][k] = up + along_z;
    block.place[0][k] = 2.0 * east;
    block.place[1][k] = 2.0 * north;
    block.place[2][k] = 2.0 * up;
  }
}

TERRANE_WIDE void locate(const Doubles& place, Words& node, Floats& offset) {
  // A whole number below 2^51 stands in the lowest bits of its sum with this.
  constexpr double kWhole = 0x1.8p52;
  for (int k = 0; k < kBlock; ++k) {
    const double floor = std::floor(place[k]);
    offset[k] = static_cast<float>(place[k] - floor);
    node[k] = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(floor + kWhole));
  }
}

TERRANE_WIDE void choose_gradients(const std::array<Words, 3>& node, std::uint32_t key,
                                   std::array<Words, kCorners>& gradient) {
  using lattice::kStep, lattice::mixed_x, lattice::mixed_y, lattice::mixed_z;
  for (int k = 0; k < kBlock; ++k) {
    const std::uint32_t x = key + node[0][k] * kStep[0];
    const std::uint32_t y = node[1][k] * kStep[1];
    const std::uint32_t z = node[2][k] * kStep[2];
    const std::uint32_t west = mixed_x(x), east = mixed_x(x + kStep[0]);
    const std::uint32_t south_west = mixed_y(west + y), north_west = mixed_y(west + y + kStep[1]);
    const std::uint32_t south_east = mixed_y(east + y), north_east = mixed_y(east + y + kStep[1]);
    gradient[0][k] = mixed_z(south_west + z) >> 24;
    gradient[1][k] = mixed_z(south_east + z) >> 24;
    gradient[2][k] = mixed_z(north_west + z) >> 24;
    gradient[3][k] = mixed_z(north_east + z) >> 24;
    gradient[4][k] = mixed_z(south_west + z + kStep[2]) >> 24;
    gradient[5][k] = mixed_z(south_east + z + kStep[2]) >> 24;
    gradient[6][k] = mixed_z(north_west + z + kStep[2]) >> 24;
    gradient[7][k] = mixed_z(north_east + z + kStep[2]) >> 24;
  }
}

void look_up(const std::array<Words, kCorners>& gradient, std::array<Levels, kCorners>& level) {
  static const auto kLevels = levels();
  for (int corner = 0; corner < kCorners; ++corner) {
    const Words& from = gradient[corner];
    Levels& to = level[corner];
#pragma GCC unroll 8
    for (int k = 0; k < kBlock; ++k) to[k] = kLevels[from[k]];
  }
}

TERRANE_WIDE void add_octave(Block& block, double amplitude) {
  const auto& g = block.gradient;
  for (int k = 0; k < kBlock; ++k) {
    const float x = block.offset[0][k], y = block.offset[1][k], z = block.offset[2][k];
    const float east = x - 1.0F, north = y - 1.0F, up = z - 1.0F;
    const auto corner = [&](int c, float dx, float dy, float dz) {
      // 1.5 (1 - (2 i + 1) / 256), exact in single precision.
      const float gz = static_cast<float>(255 - 2 * static_cast<int>(g[c][k])) * (1.5F / 256.0F);
      return block.level[c][k].x * dx + block.level[c][k].y * dy + gz * dz;
    };
    const float along_x = lattice::fade(x), along_y = lattice::fade(y), along_z = lattice::fade(z);
    const auto edge = [&](int c, float dx, float dy) {
      const float low = corner(c, dx, dy, z), high = corner(c + 4, dx, dy, up);
      return low + along_z * (high - low);
    };
    const float south_west = edge(0, x, y), south_east = edge(1, east, y);
    const float north_west = edge(2, x, north), north_east = edge(3, east, north);
    const float low = south_west + along_y * (north_west - south_west);
    const float high = south_east + along_y * (north_east - south_east);
    block.sum[k] += amplitude * static_cast<double>(low + along_x * (high - low));
  }
}

}  // namespace

void Noise::fbm(std::span<const std::array<double, 3>> positions, double frequency, int octaves,
                double gain, std::span<float> out) const {
  check_sizes("Noise::fbm", positions.size(), {{"out", out.size()}});
  const Rotation& rotation = lattice::tables().turn;
  Block block{};
  for (std::size_t first = 0; first < positions.size(); first += kBlock) {
    const std::size_t count = std::min<std::size_t>(kBlock, positions.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      for (int c = 0; c < 3; ++c) block.place[c][k] = positions[first + k][c] * frequency;
    }
    block.sum.fill(0.0);
    double amplitude = 1.0, total = 0.0;
    for (int octave = 0; octave < octaves; ++octave) {
      turn(block, rotation, shift_);
      for (int c = 0; c < 3; ++c) locate(block.in_lattice[c], block.node[c], block.offset[c]);
      choose_gradients(block.node, lattice::octave_key(key_[2], octave), block.gradient);
      look_up(block.gradient, block.level);
      add_octave(block, amplitude);
      total += amplitude;
      amplitude *= gain;
    }
    for (std::size_t k = 0; k < count; ++k) {
      out[first + k] = total > 0.0 ? static_cast<float>(block.sum[k] / total) : 0.0F;
    }
  }
}

std::vector<float> fbm_at(const Noise& noise, std::span<const std::array<double, 3>> positions,
                          double frequency, int octaves, double gain) {
  constexpr std::size_t kShare = 16 * kBlock;
  std::vector<float> values(positions.size());
  const std::size_t shares = (positions.size() + kShare - 1) / kShare;
#pragma omp parallel for schedule(static)
  for (std::size_t share = 0; share < shares; ++share) {
    const std::size_t first = share * kShare, count = std::min(kShare, positions.size() - first);
    noise.fbm(positions.subspan(first, count), frequency, octaves, gain,
              std::span(values).subspan(first, count));
  }
  return values;
}

}  // namespace geo
