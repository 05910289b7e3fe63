#include "geo/kernels/noise/noise.hpp"

#include <cmath>
#include <numbers>

#include "geo/core/random.hpp"
#include "noise_lattice.hpp"

namespace geo {
namespace lattice {
namespace {

std::array<Position, 3> rotation() {
  const double angle = 65.0 * std::numbers::pi / 180.0;
  const double length = std::sqrt(14.0);
  const Position u{1.0 / length, 2.0 / length, 3.0 / length};
  const double c = std::cos(angle), s = std::sin(angle), v = 1.0 - c;
  return {Position{c + u[0] * u[0] * v, u[0] * u[1] * v - u[2] * s, u[0] * u[2] * v + u[1] * s},
          Position{u[1] * u[0] * v + u[2] * s, c + u[1] * u[1] * v, u[1] * u[2] * v - u[0] * s},
          Position{u[2] * u[0] * v - u[1] * s, u[2] * u[1] * v + u[0] * s, c + u[2] * u[2] * v}};
}

// Length that brings the noise to about [-1, 1].
constexpr double kGradientLength = 1.5;

// Fibonacci lattice on the sphere.
std::array<Tables::Gradient, 256> spread_gradients() {
  std::array<Tables::Gradient, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double z = 1.0 - (2 * i + 1) / 256.0;
    const double r = std::sqrt(1.0 - z * z) * kGradientLength;
    const double angle = 2.0 * std::numbers::pi * i / std::numbers::phi;
    table[i] = {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)),
                static_cast<float>(z * kGradientLength), 0.0F};
  }
  return table;
}

}  // namespace

const Tables& tables() {
  static const Tables kTables{rotation(), spread_gradients()};
  return kTables;
}

}  // namespace lattice

namespace {

using lattice::Position;
using lattice::Tables;
using lattice::tables;
using lattice::turned;

Position shift(const Position& p, const Position& by) {
  return {p[0] + by[0], p[1] + by[1], p[2] + by[2]};
}

// The cell of the lattice that holds a position, and where in the cell.
struct Cell {
  std::array<std::uint32_t, 3> node;
  std::array<float, 3> offset;
};

Cell locate(const Position& p) {
  Cell cell{};
  for (int i = 0; i < 3; ++i) {
    const double floor = std::floor(p[i]);
    cell.node[i] = static_cast<std::uint32_t>(static_cast<std::int64_t>(floor));
    cell.offset[i] = static_cast<float>(p[i] - floor);
  }
  return cell;
}

// Hashes of the eight corners, x fastest.
std::array<std::uint32_t, 8> hash_corners(const std::array<std::uint32_t, 3>& node,
                                          std::uint32_t key) {
  std::array<std::uint32_t, 8> hash{};
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    std::uint32_t h = lattice::mixed_x(key + (node[0] + (corner & 1U)) * lattice::kStep[0]);
    h = lattice::mixed_y(h + (node[1] + (corner >> 1 & 1U)) * lattice::kStep[1]);
    hash[corner] = lattice::mixed_z(h + (node[2] + (corner >> 2)) * lattice::kStep[2]);
  }
  return hash;
}

float interpolate(const std::array<float, 8>& v, const std::array<float, 3>& offset) {
  const float along_x = lattice::fade(offset[0]), along_y = lattice::fade(offset[1]),
              along_z = lattice::fade(offset[2]);
  std::array<float, 4> face{};
  for (int i = 0; i < 4; ++i) face[i] = v[i] + along_z * (v[i + 4] - v[i]);
  const float low = face[0] + along_y * (face[2] - face[0]);
  const float high = face[1] + along_y * (face[3] - face[1]);
  return low + along_x * (high - low);
}

float gradient_noise(const Position& p, std::uint32_t key, const Tables& table) {
  const Cell cell = locate(p);
  const auto hash = hash_corners(cell.node, key);
  const auto [x, y, z] = cell.offset;
  std::array<float, 8> corner_value{};
  for (int c = 0; c < 8; ++c) {
    const Tables::Gradient& g = table.gradient[hash[c] >> 24];
    corner_value[c] = g.x * (x - static_cast<float>(c & 1)) +
                      g.y * (y - static_cast<float>(c >> 1 & 1)) +
                      g.z * (z - static_cast<float>(c >> 2));
  }
  return interpolate(corner_value, cell.offset);
}

}  // namespace

Noise::Noise(std::uint64_t seed, std::string_view stream) {
  const RandomStream random(seed, stream);
  key_ = random.words(0);
  for (int i = 0; i < 3; ++i) shift_[i] = random.uniform(1, i, 0.0, 1024.0);
}

float Noise::gradient(float x, float y, float z) const {
  const Tables& table = tables();
  return gradient_noise(shift(turned({x, y, z}, table.turn), shift_), key_[0], table);
}

float Noise::value(float x, float y, float z) const {
  const Cell cell = locate(shift(turned({x, y, z}, tables().turn), shift_));
  const auto hash = hash_corners(cell.node, key_[1]);
  std::array<float, 8> corner_value{};
  for (int c = 0; c < 8; ++c) {
    corner_value[c] = static_cast<float>(static_cast<std::int32_t>(hash[c])) * 0x1.0p-31F;
  }
  return interpolate(corner_value, cell.offset);
}

float Noise::fbm(const std::array<double, 3>& position, double frequency, int octaves,
                 double gain) const {
  const Tables& table = tables();
  Position p{position[0] * frequency, position[1] * frequency, position[2] * frequency};
  double sum = 0.0, amplitude = 1.0, total = 0.0;
  for (int octave = 0; octave < octaves; ++octave) {
    p = turned(p, table.turn);
    sum +=
        amplitude * gradient_noise(shift(p, shift_), lattice::octave_key(key_[2], octave), table);
    total += amplitude;
    amplitude *= gain;
    for (double& coordinate : p) coordinate *= 2.0;
  }
  return total > 0.0 ? static_cast<float>(sum / total) : 0.0F;
}

}  // namespace geo
