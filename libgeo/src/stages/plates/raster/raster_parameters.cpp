#include "raster.hpp"

namespace geo {

namespace {

/// The map, its plates and their cycles.
std::vector<Parameter> world_rows(RasterParameters& p) {
  return {
      integer("plates.raster.map_columns", p.columns, "1", 16, 8192,
              "cells along the tile's width, or once round the planet's equator", "viitanen2012"),
      integer("plates.raster.map_rows", p.rows, "1", 16, 8192, "cells along a tile's height",
              "viitanen2012"),
      integer("plates.raster.map_plates", p.plates, "1", 2, 1000, "plates of each cycle",
              "viitanen2012"),
      real("plates.raster.first_sea", p.model.sea_share, "1", 0.0, 1.0,
           "share of the first map that is sea", "viitanen2012"),
      integer("plates.raster.cycles", p.cycles, "1", 1, 50,
              "times that the world is divided into plates", "viitanen2012"),
      integer("plates.raster.cycle_steps", p.cycle_steps, "1", 1, 10000, "most steps of a cycle",
              "viitanen2012"),
      integer("plates.raster.erosion_period", p.erosion_steps, "1", 0, 10000,
              "steps between erosions; 0: none", "viitanen2012"),
      real("plates.raster.levelling", p.model.erosion, "1", 0.0, 1.0,
           "share of the steps down to its four neighbours that an erosion moves", "viitanen2012"),
  };
}

/// What becomes of crust, and how tall it stands.
std::vector<Parameter> crust_rows(RasterParameters& p) {
  return {
      real("plates.raster.folding_ratio", p.model.folding_ratio, "1", 0.0, 1.0,
           "share of the smaller continent's crust that each step moves to the larger one "
           "where they overlap",
           "viitanen2012"),
      real("plates.raster.overlap_absolute", p.overlap_absolute, "1", 0.0, 1000.0,
           "overlap from which two continents become one, over the map's area", "viitanen2012"),
      real("plates.raster.overlap_relative", p.model.overlap_relative, "1", 0.0, 10.0,
           "the same over the smaller continent's area", "viitanen2012"),
      real("plates.raster.drift", p.drift, "1", 1e-5, 0.05,
           "what a new plate moves in a step, over the map's width", "viitanen2012"),
      real("plates.raster.drift_spread", p.model.speed_spread, "1", 0.0, 1.0,
           "relative spread of the speeds of new plates", "viitanen2012"),
      real("plates.raster.friction", p.model.friction, "1", 0.0, 100.0,
           "speed that a plate loses, in that of new ones, when it folds as much crust as "
           "it has",
           "viitanen2012"),
      real("plates.raster.ocean_crust", p.model.ocean_crust, "1", 0.01, 0.9,
           "height of new ocean floor, and most that subducts in a step; 1 is sea level",
           "viitanen2012"),
      real("plates.raster.melting_ratio", p.model.melting_ratio, "1", 0.0, 1.0,
           "share of crust gone down below deep sea that rises as magma", "viitanen2012"),
      real("plates.raster.arc_distance", p.arc_distance, "1", 0.0, 0.2,
           "how far inland it rises, over the map's width, for a new plate's speed",
           "viitanen2012"),
      real("plates.raster.restart_speed", p.model.restart_speed, "1", 0.0, 1.0,
           "mean speed, in that of new plates, below which a cycle ends", "viitanen2012"),
      real("plates.raster.restart_momentum", p.model.restart_momentum, "1", 0.0, 1.0,
           "share of the largest sum of momenta below which a cycle ends", "viitanen2012"),
      integer("plates.raster.restart_quiet", p.restart_quiet, "1", 1, 100000,
              "steps without meeting continents after which a cycle ends", "viitanen2012"),
      real("plates.raster.spin_deg_myr", p.spin_deg_myr, "degree Myr-1", 0.0, 1.0,
           "fastest turn of a plate about its middle, with its path; 0: none", "viitanen2012"),
      real("plates.raster.curve_deg_myr", p.curve_deg_myr, "degree Myr-1", 0.0, 1.0,
           "fastest turn of a plate's path alone; 0: straight", "viitanen2012"),
      list("plates.raster.plate_speed", p.plate_speed,
           "speeds of plates 0, 1 and on over the common one", "viitanen2012"),
      list("plates.raster.plate_folding", p.plate_folding, "folding ratios of plates 0, 1 and on",
           "viitanen2012"),
      list("plates.raster.plate_overlap", p.plate_overlap,
           "relative overlaps of plates 0, 1 and on", "viitanen2012"),
      list("plates.raster.plate_erosion", p.plate_erosion, "erosion periods of plates 0, 1 and on",
           "viitanen2012"),
      real("plates.raster.median_land_m", p.median_land_m, "m", 10.0, 5000.0,
           "median elevation of land, which gives heights their metres", "design"),
  };
}

}  // namespace

std::vector<Parameter> raster_declarations(RasterParameters& p) {
  return joined(p, {world_rows, crust_rows});
}

}  // namespace geo
