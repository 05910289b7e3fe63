#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/stages.hpp"

namespace geo {

/// The erosion stage on a planet of three continents that reach from pole to pole. They rise from
/// their shores by `rise_m` a cell.
inline State erode_three_continents(float rise_m,
                                    const std::map<std::string, std::string>& settings,
                                    Budget& budget) {
  const Pipeline pipeline = make_pipeline();
  auto stage = make_erosion_stage();
  const auto own = stage->parameters();
  for (const auto& [key, text] : settings) find_parameter(own, key)->set_text(text);
  State state(std::make_shared<const Grid>(Grid::sphere(72, 36)));
  const Grid& grid = state.grid();
  const auto z = state.update(field::elevation);
  for (Index c = 0; c < grid.size(); ++c) {
    const int across = grid.column(c) % 24;
    z[c] = across < 10 ? rise_m * static_cast<float>(std::min(across, 9 - across) + 1) : -4000.0F;
  }
  Context context;
  context.configuration = pipeline.parameters();
  StageIo io(state, stage->info());
  stage->run(io, context);
  budget = context.budget;
  return state;
}

}  // namespace geo
