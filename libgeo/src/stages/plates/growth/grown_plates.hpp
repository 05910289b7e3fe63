#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/plates/growth/continents.hpp"
#include "geo/kernels/plates/growth/crust_age.hpp"
#include "geo/kernels/plates/growth/plate_evolution.hpp"
#include "geo/kernels/plates/growth/plate_growth.hpp"
#include "geo/kernels/plates/growth/plate_pieces.hpp"
#include "geo/kernels/plates/plate_boundaries.hpp"
#include "geo/kernels/plates/plate_motion.hpp"
#include "geo/kernels/remapping/cubed_sphere.hpp"
#include "geo/kernels/remapping/mesh_sampling.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// The planet's plates on the mesh.
class GrownPlates {
 public:
  GrownPlates(const PlatesParameters& parameters, double radius_km, std::uint64_t seed)
      : p_(parameters), radius_km_(radius_km), seed_(seed), mesh_(kEdge) {
    PlateGrowth growth = p_.growth;
    growth.radius_km = radius_km;
    plates_ = draw_plates(growth, seed);
    const bool has_cratons = p_.continents == "cratons";
    CratonNoise noise;
    ParallelErrors errors;
#pragma omp parallel sections
    {
#pragma omp section
      errors.guard([&] { plate_ = grow_plates(growth, mesh_, plates_, seed); });
#pragma omp section
      errors.guard([&] {
        if (has_cratons) noise = craton_noise(mesh_, seed);
      });
    }
    errors.rethrow();
    evolve(growth);
    boundaries_ = find_boundaries(mesh_, plate_, rotations(), growth.speed_cm_yr,
                                  p_.boundary_smoothing_km, radius_km);
    std::vector<std::int32_t> all, convergent;
    for (std::size_t k = 0; k < boundaries_.size(); ++k) {
      all.push_back(boundaries_[k].cell);
      if (boundaries_[k].type != BoundaryType::convergent) continue;
      convergent.push_back(boundaries_[k].cell);
      convergent_.push_back(static_cast<std::int32_t>(k));
    }
    Cratons cratons = p_.cratons;
    cratons.radius_km = radius_km_;
    Oceans oceans;
#pragma omp parallel sections
    {
#pragma omp section
      errors.guard(
          [&] { nearest_convergent_ = nearest_cells(mesh_, convergent, 2000.0 / radius_km); });
#pragma omp section
      errors.guard([&] {
        if (has_cratons) oceans = find_oceans(cratons, mesh_, boundaries_, plates_);
      });
#pragma omp section
      errors.guard([&] { nearest_ = nearest_cells(mesh_, all, 6.0 * mesh_.spacing()); });
    }
    errors.rethrow();
    if (has_cratons) {
      potential_ = craton_potential(cratons, mesh_, plate_, plates_, oceans, noise, seed_);
    }
    for (float& angle : nearest_convergent_.angle) angle = std::min(angle, 1.0F);
    age_myr_ =
        ocean_age_myr(mesh_, plate_, boundaries_, rotations(), p_.oldest_floor_myr, radius_km);
    heat_ = heat();
  }

  [[nodiscard]] const CubedSphere& mesh() const { return mesh_; }
  [[nodiscard]] const std::vector<Plate>& plates() const { return plates_; }
  [[nodiscard]] std::span<const std::int16_t> plate() const { return plate_; }
  [[nodiscard]] const std::vector<BoundaryPoint>& boundaries() const { return boundaries_; }
  [[nodiscard]] std::span<const float> potential() const { return potential_; }
  [[nodiscard]] std::span<const float> heat_anomaly() const { return heat_; }

  [[nodiscard]] bool near_boundary(std::int32_t cell) const { return nearest_.source[cell] >= 0; }

  /// The plate with the largest share of a stencil.
  [[nodiscard]] std::int16_t plate_at(const MeshStencil& stencil) const {
    std::int16_t best = plate_[stencil.cell[0]];
    double most = -1.0;
    for (std::size_t k = 0; k < stencil.cell.size(); ++k) {
      const std::int16_t candidate = plate_[stencil.cell[k]];
      double votes = 0.0;
      for (std::size_t other = 0; other < stencil.cell.size(); ++other) {
        if (plate_[stencil.cell[other]] == candidate) votes += stencil.weight[other];
      }
      if (votes > most || (votes == most && candidate < best)) {
        most = votes;
        best = candidate;
      }
    }
    return best;
  }

  /// The boundary nearest to a place on plate `own` and how far it is. Boundary cells of the own
  /// side lie half a cell before the line, those of the other side half a cell behind it.
  struct Near {
    const BoundaryPoint* point = nullptr;
    double distance_km = 1e9;
  };
  [[nodiscard]] Near boundary_near(const MeshStencil& stencil, const Vector3& at,
                                   std::int16_t own) const {
    const double half = 0.5 * mesh_.spacing();
    Near near;
    for (const std::int32_t cell : stencil.cell) {
      const std::int32_t source = nearest_.source[cell];
      if (source < 0) continue;
      const BoundaryPoint& point = boundaries_[source];
      const double far = length(add(mesh_.position(point.cell), at, -1.0));
      const double distance = radius_km_ * std::max(0.0, far + (point.plate == own ? half : -half));
      if (distance < near.distance_km) near = {&point, distance};
    }
    return near;
  }

  /// Age of the floor between cells of one plate alone, so that it jumps where plates meet.
  [[nodiscard]] double age_myr(const MeshStencil& stencil, std::int16_t own) const {
    double sum = 0.0, weights = 0.0;
    for (std::size_t k = 0; k < stencil.cell.size(); ++k) {
      if (plate_[stencil.cell[k]] != own) continue;
      sum += stencil.weight[k] * age_myr_[stencil.cell[k]];
      weights += stencil.weight[k];
    }
    return weights > 0.0 ? sum / weights : age_myr_[stencil.cell[0]];
  }

  [[nodiscard]] double convergent_km(const MeshStencil& stencil) const {
    return radius_km_ * read(stencil, nearest_convergent_.angle);
  }
  /// Number in boundaries() of the nearest convergent point, or -1.
  [[nodiscard]] std::int32_t convergent_point(std::int32_t cell) const {
    const std::int32_t source = nearest_convergent_.source[cell];
    return source < 0 ? -1 : convergent_[source];
  }

  [[nodiscard]] std::vector<Vector3> rotations() const {
    std::vector<Vector3> all;
    for (const Plate& plate : plates_) all.push_back(plate.rotation_rad_myr);
    return all;
  }

 private:
  static constexpr int kEdge = 160;  // about 58 km on Earth
  static constexpr double kPi = std::numbers::pi;

  /// Section 2.3: the plates move for a while. Then each is what hangs together, and the last thing
  /// taken away is their common rotation.
  void evolve(const PlateGrowth& growth) {
    const RandomStream random(seed_, "plates.evolution");
    const double smallest_sr = growth.smallest_part_km2 / (radius_km_ * radius_km_);
    for (std::int64_t step = 0; step < p_.evolution_steps; ++step) {
      if (p_.no_net_rotation) subtract_net_rotation();
      const double age = static_cast<double>(step) / static_cast<double>(p_.evolution_steps);
      const double time_myr =
          random.uniform(static_cast<std::uint64_t>(step), 0, 0.9, 3.4) * (0.92 + 0.32 * age);
      move_plates(mesh_, plates_, time_myr, plate_);
      merge_small_pieces(mesh_, smallest_sr, plate_);
    }
    connect_plates(mesh_, plate_);
    if (p_.no_net_rotation) subtract_net_rotation();
  }
  void subtract_net_rotation() {
    std::vector<double> area_sr(mesh_.size());
    for (std::int32_t cell = 0; cell < mesh_.size(); ++cell) area_sr[cell] = mesh_.area_sr(cell);
    const Vector3 net = net_rotation(plate_, mesh_.positions(), area_sr, rotations());
    for (Plate& plate : plates_) plate.rotation_rad_myr = add(plate.rotation_rad_myr, net, -1.0);
  }
  /// Heat of the plates' mantle, blended over some hundred kilometres, with plumes on top; 0 to 1.
  [[nodiscard]] std::vector<float> heat() const {
    constexpr double kBlend_m = 500e3, kPlume_km = 260.0, kPlumeHeat = 0.5, kMost = 2.5;
    const Grid coarse = Grid::sphere(256, 128, {1000.0 * radius_km_, 0.0});
    std::vector<float> blended(coarse.size());
    for (int j = 0; j < coarse.ny(); ++j) {
      for (int i = 0; i < coarse.nx(); ++i) {
        const Plate& plate = plates_[plate_[mesh_.locate(coarse.unit_vector(i, j))]];
        blended[coarse.cell(i, j)] = static_cast<float>((plate.heat - 0.5) / kMost);
      }
    }
    smooth(coarse, blended, kBlend_m);
    const RandomStream random(seed_, "plates.plumes");
    std::vector<Vector3> plumes(static_cast<std::size_t>(std::lround(p_.plumes)));
    for (std::size_t k = 0; k < plumes.size(); ++k) plumes[k] = random.direction(k);
    std::vector<float> values(mesh_.size());
#pragma omp parallel for schedule(static)
    for (std::int32_t cell = 0; cell < mesh_.size(); ++cell) {
      const Vector3& at = mesh_.position(cell);
      double value = bilinear(coarse, blended, at);
      for (const Vector3& plume : plumes) {
        const double far = radius_km_ * length(add(plume, at, -1.0)) / kPlume_km;
        if (far < 5.0) value += kPlumeHeat * std::exp(-0.5 * far * far);
      }
      values[cell] = static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
    return values;
  }
  static double bilinear(const Grid& grid, std::span<const float> values, const Vector3& at) {
    const double x = (std::atan2(at[1], at[0]) / (2.0 * kPi) + 0.5) * grid.nx() - 0.5;
    const double y = (std::asin(std::clamp(at[2], -1.0, 1.0)) / kPi + 0.5) * grid.ny() - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto value = [&](int column, int row) {
      const bool over = row < 0 || row >= grid.ny();
      row = std::clamp(row, 0, grid.ny() - 1);
      column = (column + (over ? grid.nx() / 2 : 0) + grid.nx()) % grid.nx();
      return static_cast<double>(values[grid.cell(column, row)]);
    };
    const double u = x - i, v = y - j;
    return (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
           v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
  }

  const PlatesParameters& p_;
  double radius_km_;
  std::uint64_t seed_;
  CubedSphere mesh_;
  std::vector<Plate> plates_;
  std::vector<std::int16_t> plate_;
  std::vector<BoundaryPoint> boundaries_;
  std::vector<std::int32_t> convergent_;  // numbers of convergent boundary points
  NearestCells nearest_, nearest_convergent_;
  std::vector<float> age_myr_, heat_, potential_;
};

}  // namespace geo
