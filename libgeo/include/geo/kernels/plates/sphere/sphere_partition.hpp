#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/kernels/plates/sphere/sphere_mesh.hpp"
#include "geo/kernels/plates/sphere/sphere_state.hpp"

namespace geo {

/// Which samples belong to which plate, in blocks that are compact on the sphere, and a cheap
/// answer to whether a plate may hold something near a place of its frame.
class SpherePartition {
 public:
  explicit SpherePartition(const SphereMesh& mesh);

  /// After samples have changed their plates.
  void rebuild(const SphereState& state);

  /// After samples have become continental.
  void count_continents(const SphereState& state);

  /// Samples of one plate around one coarse place.
  struct Block {
    std::int16_t plate;
    std::int16_t coarse;
    std::int32_t first, count;  ///< in samples()
  };
  [[nodiscard]] const std::vector<Block>& blocks() const noexcept { return blocks_; }
  [[nodiscard]] std::span<const std::int32_t> samples(const Block& block) const {
    return std::span(order_).subspan(block.first, block.count);
  }
  /// Centre of a block in the frame of its plate, unit vector.
  [[nodiscard]] const Vector3& centre(std::int32_t coarse) const {
    return coarse_.position(coarse);
  }
  [[nodiscard]] const FibonacciSphere& coarse() const noexcept { return coarse_; }
  /// Coarse place nearest to each sample.
  [[nodiscard]] std::span<const std::int16_t> coarse_of() const noexcept { return coarse_of_; }
  /// Samples around each coarse place, whatever their plate: first number in by_place().
  [[nodiscard]] std::span<const std::int32_t> samples_at(std::int32_t coarse) const {
    return std::span(by_place_).subspan(place_first_[coarse],
                                        place_first_[coarse + 1] - place_first_[coarse]);
  }
  /// Whether a plate may hold anything within a block whose centre lies at `unit` in its frame.
  [[nodiscard]] bool may_hold(int plate, const Vector3& unit) const {
    if (dot(cap_[plate].centre, unit) < cap_[plate].cos_radius) return false;
    return near_[static_cast<std::size_t>(plate) * coarse_.size() + coarse_.nearest(unit)] != 0;
  }

  /// Sums over a plate, in its frame.
  struct Cap {
    Vector3 centre{};         ///< direction of the mean position of its samples
    double cos_radius = 2.0;  ///< of a cap about the centre that holds all its blocks
    std::int32_t samples = 0, continental = 0;
    Matrix3 inertia{};  ///< sum of (1 - r r^T) over its samples
  };
  [[nodiscard]] const Cap& cap(int plate) const { return cap_[plate]; }
  /// Plates that there were when it was rebuilt.
  [[nodiscard]] int plates() const noexcept { return static_cast<int>(cap_.size()); }

 private:
  [[nodiscard]] std::span<const Block> blocks_of(int plate) const;
  void measure(int plate);

  const SphereMesh* mesh_;
  FibonacciSphere coarse_;
  double reach_;  // how far a sample may be from the coarse places asked for it, radians
  std::vector<std::int16_t> coarse_of_;
  std::vector<std::int32_t> place_first_, by_place_;  // samples by coarse place
  std::vector<std::int32_t> around_first_, around_;   // coarse places within reach
  std::vector<std::int32_t> order_;
  std::vector<Block> blocks_;
  std::vector<std::uint8_t> near_;
  std::vector<Cap> cap_;
};

}  // namespace geo
