#pragma once

#include <optional>

#include "geo/core/state.hpp"
#include "io/drawing/map_colours.hpp"
#include "io/drawing/map_raster.hpp"

namespace geo::io {

/// What lies under every map of a state: where land is, how high, and how the light falls on it.
struct MapBase {
  Raster land_cover;  ///< share of the pixel that is land, 0 to 1
  Raster land_m;      ///< mean elevation of that land, at least 0; 0 where there is none
  Raster sea_m;       ///< mean elevation of the sea floor, at most 0; 0 where there is none
  Raster shade;       ///< -1 in deep shadow, 0 where flat, 1 facing the light
  Raster coast;       ///< strength of the coastline, 0 to 1
  Raster lake_cover;  ///< share of the pixel under lakes; empty when lakes are not known
};

/// Base of a state; flat land throughout when it has no elevation.
MapBase make_base(const MapFrame& frame, const State& state);

/// The colours of a row under the light, each as strongly as it says: white is mixed in where shade
/// > 0, a bluish dark where it is < 0. Flat ground keeps its colour.
void shade(ColourRow& row, const MapBase& base, int y);
/// A row with the coastline over it, and with lakes.
void draw_coast(ColourRow& row, const MapBase& base, int y, float strength);
void fill_lakes(ColourRow& row, const MapBase& base, int y);

inline constexpr Rgb kLake{0.49F, 0.68F, 0.82F};

}  // namespace geo::io
