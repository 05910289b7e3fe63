#include "geo/stages/stages.hpp"

#include <vector>

#if __has_include("geo/stages/erosion.hpp")
#include "geo/stages/erosion.hpp"
#define TERRANE_EROSION 1
#endif
#if __has_include("geo/stages/climate.hpp")
#include "geo/stages/climate.hpp"
#define TERRANE_CLIMATE 1
#endif
#if __has_include("geo/stages/hydrology.hpp")
#include "geo/stages/hydrology.hpp"
#define TERRANE_HYDROLOGY 1
#endif
#if __has_include("geo/stages/biomes.hpp")
#include "geo/stages/biomes.hpp"
#define TERRANE_BIOMES 1
#endif

namespace geo {

std::span<const StageEntry> stage_table() {
  static const std::vector<StageEntry> kStages{
#ifdef TERRANE_EROSION
      {3, "erosion", [] { return make_erosion_stage(); }},
#endif
#ifdef TERRANE_CLIMATE
      {4, "climate", [] { return make_climate_stage(); }},
#endif
#ifdef TERRANE_HYDROLOGY
      {5, "hydrology", [] { return make_hydrology_stage(); }},
#endif
#ifdef TERRANE_BIOMES
      {6, "biomes", [] { return make_biomes_stage(); }},
#endif
  };
  return kStages;
}

Pipeline make_pipeline() {
  std::vector<std::unique_ptr<Stage>> stages;
  for (const StageEntry& entry : stage_table()) stages.push_back(entry.make());
  return Pipeline(std::move(stages));
}

}  // namespace geo
