#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geo/core/stage.hpp"

namespace geo {

struct HydrologyParameters {
  double breach_depth_m = 100.0;
  double breach_length_km = 100.0;
  double closed_basin_km2 = 5000.0;
  double gorge_factor = 0.0;
  double gorge_length_km = 450.0;
  double channel_area_km2 = 5000.0;
  std::string rivers = "discharge";
  double river_threshold_m3_s = 100.0;
  double river_reference_m3_s = 20000.0;
  double carving = 1.0;
  std::int64_t carving_rounds = 1;
  double carving_runoff_mm_yr = 400.0;
  double valley_blend = 0.2;
  double valley_width_km = 10.0;
  double frozen_temperature_degc = -15.0;

  [[nodiscard]] std::vector<Parameter> declarations();
};

/// Where the rain goes: runoff after Budyko (1974), routing over a DEM freed of spurious
/// depressions of its resolution but for basins that keep their water as they are, lakes and
/// endorheic basins by the steady water balance, discharge, valleys carved by rivers (Leopold &
/// Maddock 1953), basins and stream orders.
///
/// Hollows that ice has scoured keep their sills when depressions are breached, and nothing is cut
/// into ice.
///
/// With `rivers = "area"` rivers show and carve by their drainage area, as in the Tectonica
/// blueprint: by 6.4 and 6.5, with the discharge of one runoff everywhere (6.6a).
///
/// Discharge is that which leaves the cell; on a lake it is the lake's outflow, on an endorheic
/// lake its inflow, at sea 0. Ice does not pond: where it is colder than `frozen_temperature_degc`
/// a full depression passes its water on without a lake. Budget (m3/s over land): precipitation,
/// evaporation of land and of lakes beside it, runoff to the sea (or over an open edge), and
/// the relative closing error.
///
/// Over an open edge water leaves at every cell but those of its inflow and those that `shut` (one
/// byte per cell, or none) marks: what is there flows on within the grid. `toughness`: factor of
/// what it costs to breach each cell, or none (breach_depressions).
std::unique_ptr<Stage> make_hydrology_stage(HydrologyParameters parameters = {},
                                            std::vector<std::uint8_t> shut = {},
                                            std::vector<float> toughness = {});

}  // namespace geo
