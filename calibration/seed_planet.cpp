#include "calibration/seed_planet.hpp"

#include <algorithm>

#include "geo/core/stage.hpp"
#include "geo/stages/isostasy/sea_level.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo::calibration {
namespace {

Planet planet_of(std::span<const Parameter> configuration) {
  Planet planet;
  for (const Parameter& parameter : planet.parameters()) {
    parameter.set(find_parameter(configuration, parameter.name)->value());
  }
  return planet;
}

constexpr double kHalfWidth = 0.0025;  // share of the area on either side of the shore

/// A run takes the height of a cell for the level of the sea, and that cell is land. In double
/// precision the same cell may stand below what its height is rounded to; so its own height it is.
double level_of_cell_m(double level_m, std::span<const float> rounded_m,
                       std::span<const double> elevation_m) {
  double lowest_m = level_m;
  for (std::size_t c = 0; c < rounded_m.size(); ++c) {
    if (rounded_m[c] == level_m) lowest_m = std::min(lowest_m, elevation_m[c]);
  }
  return lowest_m;
}

State plates_of(std::span<const Parameter> configuration, std::uint64_t seed, int nx, int ny) {
  Context context;
  context.planet = planet_of(configuration);
  context.seed = seed;
  context.configuration.assign(configuration.begin(), configuration.end());
  State state(std::make_shared<const Grid>(Grid::sphere(nx, ny, context.planet.figure())));
  const auto plates = make_plates_stage();
  for (const Parameter& parameter : plates->parameters()) {
    parameter.set(find_parameter(configuration, parameter.name)->value());
  }
  StageIo io(state, plates->info());
  plates->run(io, context);
  return state;
}

}  // namespace

SeedPlanet::SeedPlanet(std::span<const Parameter> configuration, std::uint64_t seed, int nx, int ny,
                       bool sea_in_gap)
    : seed_(seed), state_(plates_of(configuration, seed, nx, ny)), coarse_(state_.grid()) {
  held_.sea.at_shore = sea_in_gap;
}

CrustInputs SeedPlanet::crust_inputs() const {
  return {.plate = state_.read(field::plate_id),
          .boundary_type = state_.read(field::boundary_type),
          .boundary_strength = state_.read(field::boundary_strength),
          .age_myr = state_.read(field::crust_age),
          .heat = state_.read(field::heat_anomaly),
          .velocity_east = state_.read(field::plate_velocity_east),
          .velocity_north = state_.read(field::plate_velocity_north)};
}

std::vector<float> SeedPlanet::find_straits(const ErosionParameters& p,
                                            const std::vector<float>& before,
                                            FrozenDrainage::Straits& straits) const {
  std::vector<float> after = before;
  straits.clear();
  if (p.steps > 0 && join_seas(p, grid(), after)) {
    for (Index c = 0; c < grid().size(); ++c) {
      if (after[c] != before[c]) straits.emplace_back(c, after[c]);
    }
  }
  return after;
}

FrozenDrainage::Coast SeedPlanet::find_coast(const ErosionParameters& p,
                                             const std::vector<float>& elevation_m,
                                             const std::vector<std::uint8_t>& before) const {
  std::vector<std::uint8_t> outlets = find_outlets(grid(), elevation_m);
  if (outlets == before) return {};
  return {true, std::move(outlets), landlocked_cells(p, grid(), elevation_m)};
}

FrozenDrainage::MovedSea SeedPlanet::find_moved_sea(const ErosionParameters& p,
                                                    const std::vector<float>& before,
                                                    double share) const {
  if (p.steps == 0) return {};
  FrozenDrainage::MovedSea sea{.level_m = moved_sea_level_m(p, grid(), before, share)};
  if (sea.level_m == 0.0F) return sea;
  const std::vector<double> heights_m(before.begin(), before.end());
  sea.ranking.emplace(grid(), heights_m);
  sea.window = sea.ranking->window(share, kHalfWidth);
  sea.mean_m = sea.ranking->mean(sea.window, std::span<const double>(heights_m));
  std::vector<float> after = before;
  keep_sea_share(p, grid(), after, share);
  for (Index c = 0; c < grid().size(); ++c) {
    if (after[c] != before[c] - sea.level_m) sea.flats.emplace_back(c, after[c]);
  }
  return sea;
}

void SeedPlanet::hold_frame(const IsostasyParameters& p, const CrustInputs& in) {
  if (held_.frame && held_.divergent_length_km == p.divergent_length_km &&
      held_.transform_length_km == p.transform_length_km) {
    return;
  }
  held_.frame = tectonic_frame(p, coarse_, in, continental_fraction(), seed_);
  held_.divergent_length_km = p.divergent_length_km;
  held_.transform_length_km = p.transform_length_km;
}

void SeedPlanet::find_sea(const Model& model, std::span<const double> elevation_m,
                          FrozenDrainage::Sea& sea) const {
  const Grid& grid = this->grid();
  sea = {.at_shore = sea.at_shore};
  const std::vector<float> values(elevation_m.begin(), elevation_m.end());
  sea.level_m = level_of_cell_m(sea_level_m(grid, values, model.planet), values, elevation_m);
  if (model.planet.sea_level == "volume") {
    sea.wet.resize(values.size());
    for (std::size_t c = 0; c < values.size(); ++c) sea.wet[c] = elevation_m[c] < sea.level_m;
    const double area =
        area_sum<double>(grid, [&](Index c) { return static_cast<double>(sea.wet[c]); });
    sea.mean_m =
        area_sum<double>(grid, [&](Index c) { return sea.wet[c] != 0 ? elevation_m[c] : 0.0; }) /
        area;
    sea.asked = model.planet.water_volume_km3;
    sea.rate = 1e9 / area;
    return;
  }
  const double share = model.planet.ocean_fraction;
  sea.ranking.emplace(grid, elevation_m);
  // The level is the height of a cell. In a gap somewhat lower it makes almost the same land, and
  // no cell stands at the bend between shelf and land, where nothing has a derivative.
  constexpr double kGap_m = 0.02;
  constexpr int kCells = 20;
  if (sea.at_shore) sea.level_m = sea.ranking->gap_below(sea.level_m, kGap_m, kCells);
  sea.window = sea.ranking->window(share, kHalfWidth);
  sea.mean_m = sea.ranking->mean(sea.window, elevation_m);
  sea.asked = share;
  sea.rate = 1.0 / sea.ranking->density(share, kHalfWidth);
}

}  // namespace geo::calibration
