#include "geo/stages/island/island.hpp"

namespace geo {

namespace {

std::vector<Parameter> place_rows(IslandParameters& p) {
  return {
      text("island.center", p.center,
           "LAT,LON of the island's centre in degrees; auto takes the best score of the planet",
           "tectonica2026"),
      choice("island.choose_by", p.choose_by, {"whole", "figures"},
             "what auto looks for: windows that hold islands whole or one coast, of those the best "
             "land, coast, local relief and boundaries; or these figures alone",
             "tectonica2026"),
      integer("island.nx", p.nx, "1", 32, 8192, "columns of the island's grid", "tectonica2026"),
      integer("island.ny", p.ny, "1", 32, 8192, "rows of the island's grid", "tectonica2026"),
      real("island.cell_m", p.cell_m, "m", 10.0, 20000.0, "size of the island's cells",
           "tectonica2026"),
  };
}

std::vector<Parameter> detail_rows(IslandParameters& p) {
  return {
      choice("island.detail", p.detail, {"roughness", "height", "exemplars"},
             "fractal detail that continues the spectrum and the roughness of the planet's surface "
             "around it, or whose amplitude follows height; or terrain of exemplars, chosen by "
             "kind, aligned with folds and as rough",
             "cortial2019"),
      real("island.detail_amplitude", p.detail_amplitude, "1", 0.0, 10.0,
           "standard deviation of detail over the roughness of the planet's cells", "huang1989"),
      real("island.detail_hurst", p.detail_hurst, "1", 0.0, 1.0,
           "Hurst exponent of detail that follows roughness", "huang1989"),
      real("island.least_roughness_m", p.least_roughness_m, "m", 0.0, 1000.0,
           "roughness below 10 km that even plains and flat shores have", "design"),
      real(
          "island.coast_fray", p.coast_fray, "1", 0.0, 1.0,
          "standard deviation by which bays and headlands displace a coast, in cells of the planet",
          "design"),
      real("island.old_orogeny_myr", p.old_orogeny_myr, "Myr", 0.0, 5000.0,
           "age from which mountains look like exemplars of old ones", "cortial2019"),
      real("island.plain_slope", p.plain_slope, "1", 0.0, 1.0,
           "slope of the planet's surface below which a place looks like exemplars of plains",
           "design"),
      real("island.height_amplitude", p.height_amplitude, "1", 0.0, 1.0,
           "amplitude of detail over height, where it follows height", "tectonica2026"),
      real("island.height_frequency", p.height_frequency, "1", 0.1, 1000.0,
           "waves of that detail over the width of the island", "tectonica2026"),
      integer("island.height_octaves", p.height_octaves, "1", 0, 16, "octaves of that detail",
              "tectonica2026"),
  };
}

std::vector<Parameter> edges_rows(IslandParameters& p) {
  return {
      flag("island.edge_fade", p.edge_fade,
           "sink the edges to 500 m below the sea, which makes an island of any place",
           "tectonica2026"),
      real("island.edge_margin", p.edge_margin, "1", 0.0, 0.5,
           "width of the sinking edge over that of the island", "tectonica2026"),
  };
}

std::vector<Parameter> fine_erosion_rows(IslandParameters& p) {
  return {
      integer("island.erosion_steps", p.erosion_steps, "1", 0, 10000, "fine steps of erosion",
              "tectonica2026"),
      real("island.time_step_yr", p.time_step_yr, "yr", 1.0, 1e9, "length of a fine step",
           "tectonica2026"),
      choice("island.erodibility", p.erodibility, {"planet", "boundary"},
             "erodibility of the fine steps: the planet's, or by the nearest plate boundary",
             "tectonica2026"),
      real("island.convergent_erodibility_yr", p.convergent_erodibility_yr, "yr-1", 0.0, 1.0,
           "erodibility near convergent and transform boundaries", "tectonica2026"),
      real("island.divergent_erodibility_yr", p.divergent_erodibility_yr, "yr-1", 0.0, 1.0,
           "erodibility near divergent boundaries", "tectonica2026"),
      real("island.interior_erodibility_yr", p.interior_erodibility_yr, "yr-1", 0.0, 1.0,
           "erodibility away from boundaries", "tectonica2026"),
      flag("island.keep_means", p.keep_means,
           "let the ground rise by as much as the fine steps take away, so that mean heights over "
           "the planet's cells stay",
           "design"),
  };
}

std::vector<Parameter> water_and_life_rows(IslandParameters& p) {
  return {
      real("island.river_threshold_m3_s", p.river_threshold_m3_s, "m3 s-1", 0.0, 1e7,
           "discharge from which a river shows and carves", "design"),
      real("island.river_reference_m3_s", p.river_reference_m3_s, "m3 s-1", 1.0, 1e8,
           "discharge of a river as prominent as rivers get", "design"),
      real("island.channel_area_km2", p.channel_area_km2, "km2", 0.0, 1e8,
           "drainage area from which a channel has a stream order", "design"),
      real("island.lift_reach_km", p.lift_reach_km, "km", 0.1, 1000.0,
           "e-folding distance over which air remembers the fine topography that it crossed",
           "smith1979"),
      real("island.climate_smoothing_km", p.climate_smoothing_km, "km", 0.0, 1000.0,
           "length over which temperature and precipitation are smoothed", "tectonica2026"),
      real("island.biome_smoothing_km", p.biome_smoothing_km, "km", 0.0, 1000.0,
           "patches of biome smaller than this merge into their surroundings", "tectonica2026"),
      real("island.river_weight", p.river_weight, "1", 0.0, 1.0,
           "what a navigable river adds to the suitability for settlement", "diamond1997"),
      real("island.coast_weight", p.coast_weight, "1", 0.0, 1.0,
           "what the sea shore adds to the suitability for settlement", "diamond1997"),
  };
}

}  // namespace

std::vector<Parameter> IslandParameters::declarations() {
  return joined(*this,
                {place_rows, detail_rows, edges_rows, fine_erosion_rows, water_and_life_rows});
}

}  // namespace geo
