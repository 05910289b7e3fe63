#include "geo/stages/stages.hpp"

#include <array>
#include <vector>

#include "geo/stages/biomes/biomes.hpp"
#include "geo/stages/climate/climate.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/hydrology/hydrology.hpp"
#include "geo/stages/island/island.hpp"
#include "geo/stages/isostasy/isostasy.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

std::span<const StageEntry> stage_table() {
  static constexpr auto kStages = std::to_array<StageEntry>({
      {1, "plates", [] { return make_plates_stage(); }},
      {2, "isostasy", [] { return make_isostasy_stage(); }},
      {3, "erosion", [] { return make_erosion_stage(); }},
      {4, "climate", [] { return make_climate_stage(); }},
      {5, "hydrology", [] { return make_hydrology_stage(); }},
      {6, "biomes", [] { return make_biomes_stage(); }},
      {7, "island", [] { return make_island_stage(); }},
  });
  return kStages;
}

Pipeline make_pipeline() {
  std::vector<std::unique_ptr<Stage>> stages;
  for (const StageEntry& entry : stage_table()) stages.push_back(entry.make());
  return Pipeline(std::move(stages));
}

}  // namespace geo
