#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geo/kernels/remapping/resample.hpp"
#include "geo/kernels/water/flow_graph.hpp"
#include "geo/stages/erosion/erosion.hpp"

namespace geo {

/// What falls on a planet and what the air would take: one value per cell, or, where the air is
/// known on a coarser grid, per cell of that, and how rows of the planet lie between them.
struct LandClimate {
  std::vector<float> precipitation_mm_yr, potential_mm_yr;
  std::vector<float> sea_level_temperature_c;  ///< annual mean, brought down to the sea
  std::vector<float> range_k;                  ///< warmest less coldest month
  std::vector<float> summer_rain;  ///< how far precipitation follows temperature, as in SnowLaw
  /// Ice on the surface that this is the climate of, mean of the cell; empty: of bare ground.
  std::vector<float> ice_m{};
  std::shared_ptr<const RowResampling> between{};  ///< null: values are those of the cells

  /// What one thread reads the rows of a field with.
  class Reader {
   public:
    Reader(const LandClimate& climate, const Grid& grid, const std::vector<float>& field);
    /// Values of row j of the planet; they stay until the next are read.
    std::span<const float> row(int j);

   private:
    const RowResampling* between_;
    int nx_;
    std::span<const float> field_;
    std::vector<float> values_;
    std::vector<double> scratch_;
  };
  /// A field on all cells of the planet.
  [[nodiscard]] std::vector<float> on_cells(const std::vector<float>& field,
                                            const Grid& grid) const;
};

/// The drainage of a surface: receivers, their order, the area that drains through each
/// cell, and what lies under the water of depressions.
struct Drainage {
  FlowGraph graph;
  /// Drained by each cell; where rain is known, the area that would yield its discharge at the
  /// reference runoff.
  std::vector<double> area_m2;
  std::vector<std::uint8_t> flooded;  ///< lakes that catch sediment; empty where none do
};

/// Routes the water of a surface as erosion.flow_routing says, over the sills of all depressions.
/// With a climate each cell sheds its runoff (land_water), not less than `least_runoff_mm_yr`; what
/// lakes lose to the air (balance_lakes) is gone beyond their sills, in closed basins all of it: no
/// river cuts them open. `inflow_area_m2`: what enters a part of a planet drains so much, one value
/// per cell or none. `drainage` is replaced; what it held is released first: two would not fit
/// the memory budget.
void drain(const ErosionParameters& parameters, const Grid& grid,
           std::span<const float> elevation_m, std::span<const std::uint8_t> outlets,
           Drainage& drainage, const LandClimate* climate = nullptr,
           std::span<const double> inflow_area_m2 = {});

}  // namespace geo
