#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geo/core/grid.hpp"
#include "geo/kernels/remapping/conservative_remapping.hpp"
#include "geo/stages/climate/climate.hpp"

namespace geo {

/// The two coarser grids that the climate is worked out on: the planet (about 2 degrees) for
/// everything that air mixes, the topography (about 20 km) for single ranges; and where the stage's
/// own cells lie on them.
class ClimateFrame {
 public:
  ClimateFrame(const Grid& grid, const ClimateParameters& parameters, const Planet& planet);

  [[nodiscard]] const Grid& planet() const { return *planet_; }
  [[nodiscard]] const std::shared_ptr<const Grid>& shared_planet() const { return planet_; }
  [[nodiscard]] const Grid& topography() const { return *topography_; }
  [[nodiscard]] const ConservativeRemapping& on_planet() const { return *on_planet_; }
  [[nodiscard]] const ConservativeRemapping& on_topography() const { return *on_topography_; }
  /// From the topography grid to the planet.
  [[nodiscard]] const ConservativeRemapping& topography_on_planet() const {
    return *topography_on_planet_;
  }
  [[nodiscard]] std::span<const double> latitudes_deg() const { return latitude_deg_; }
  [[nodiscard]] std::span<const double> planet_latitudes_deg() const {
    return planet_latitude_deg_;
  }
  [[nodiscard]] std::span<const double> topography_latitudes_deg() const {
    return topography_latitude_deg_;
  }

  /// Land fraction and mean height on the planet grid. Where the stage's grid is a part of the
  /// planet, its edge continues for about 1000 km (`surroundings` "edge") before the sea begins.
  void planet_topography(std::span<const float> elevation, std::span<float> land_fraction,
                         std::span<float> height_m) const;
  /// Share of each cell's land that ice covers, from its mean thickness; `land_fraction` as above.
  [[nodiscard]] std::vector<float> planet_glaciers(std::span<const float> ice_thickness_m,
                                                   std::span<const float> land_fraction) const;

 private:
  void continue_edge(std::span<float> coverage, std::span<float> land_fraction,
                     std::span<float> height_m) const;

  bool edge_continues_;
  std::shared_ptr<const Grid> planet_;
  std::unique_ptr<Grid> topography_;
  std::unique_ptr<ConservativeRemapping> on_planet_, on_topography_, topography_on_planet_;
  std::vector<double> latitude_deg_, planet_latitude_deg_, topography_latitude_deg_;
};

}  // namespace geo
