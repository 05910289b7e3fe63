#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace geo {

/// Coherent noise in three dimensions: a function of position and seed alone, the same at any
/// resolution, on any thread, in any order.
///
/// The cubic lattice is turned and shifted against the axes of the caller, so that neither the
/// plane z = 0 nor the poles lie along it; each octave of `fbm` turns and shifts it anew, so that
/// lattices of different octaves never coincide. A node's gradient or value is an integer hash of
/// (node, key), with the key and the shift drawn from RandomStream(seed, stream). Gradients are
/// 256 directions spread evenly over the sphere, where Perlin (2002) has the twelve edges of a
/// cube, which favours the axes.
///
/// Positions must be finite and below about 1e12. Nodes are found in double precision, so detail
/// stays clean at frequencies far above what a float could resolve.
class Noise {
 public:
  Noise(std::uint64_t seed, std::string_view stream);

  /// Gradient noise (Perlin 2002, quintic fade), about [-1, 1], zero mean, standard deviation
  /// 0.29, wavelength about 1. Smooth: first and second derivatives are continuous.
  [[nodiscard]] float gradient(float x, float y, float z) const;
  /// Value noise, quintic interpolation of uniform lattice values, within [-1, 1], zero mean,
  /// standard deviation 0.40.
  [[nodiscard]] float value(float x, float y, float z) const;
  /// The same at a position times a frequency.
  [[nodiscard]] float value(const std::array<double, 3>& position, double frequency) const {
    return value(static_cast<float>(position[0] * frequency),
                 static_cast<float>(position[1] * frequency),
                 static_cast<float>(position[2] * frequency));
  }
  /// Fractional Brownian motion: sum of `octaves` of gradient noise, frequency doubled and
  /// amplitude times `gain` each (gain = 2^-H), divided by the sum of amplitudes. About [-1, 1]
  /// and of zero mean for any `octaves` >= 0; no octaves give 0.
  [[nodiscard]] float fbm(const std::array<double, 3>& position, double frequency, int octaves,
                          double gain = 0.5) const;
  /// The same bits at many positions, in a third of the time. `out` has one value for each, Bug
  /// otherwise.
  void fbm(std::span<const std::array<double, 3>> positions, double frequency, int octaves,
           double gain, std::span<float> out) const;

 private:
  std::array<std::uint32_t, 4> key_;
  std::array<double, 3> shift_;
};

/// Noise::fbm at many positions, on all threads.
[[nodiscard]] std::vector<float> fbm_at(const Noise& noise,
                                        std::span<const std::array<double, 3>> positions,
                                        double frequency, int octaves, double gain = 0.5);

}  // namespace geo
