#include "icy_climate.hpp"

#include <memory>
#include <vector>

#include "climate_of_land.hpp"
#include "geo/kernels/remapping/resample.hpp"
#include "ice_age.hpp"

namespace geo {
namespace {

constexpr double kCoarser = 3.0;
/// Ice follows a climate for some rounds, then the climate follows the ice.
constexpr int kColdTurns = 3, kGrowing = 12, kWarmTurns = 2, kShrinking = 6;
/// Share of the cold times' cooling that is not the work of snow and ice, on the Earth's
/// topography.
constexpr double kForcedShare = 0.8;
/// Arctic summers of the last interglacial were 4 to 5 K warmer than today's (CAPE 2006), where
/// such departures are 1.6 times the planet's.
constexpr double kWarmest_k = 2.5;

/// Ice and climate of a planet on the grid that climates have within a run.
class IceAndAir {
 public:
  IceAndAir(const ErosionParameters& parameters, const Grid& grid,
            std::span<const float> elevation_m, Context& context)
      : context_(context),
        fine_(raster_of(grid)),
        grid_(std::make_shared<const Grid>(climate_grid(grid))),
        raster_(raster_of(*grid_)),
        ground_m_(static_cast<std::size_t>(grid_->size())),
        ice_m_(ground_m_.size()),
        ice_(parameters, *grid_, context.planet) {
    resample_raster(fine_, elevation_m, raster_, ground_m_, grid.figure());
  }

  /// Ice of the last cold time, and what the warmest since has left of it.
  void live(const ErosionParameters& parameters) {
    if (parameters.glacial_share > 0.0 && parameters.glacial_time_yr > 0.0) {
      for (int turn = 0; turn < kColdTurns; ++turn) {
        follow(kForcedShare * parameters.glacial_cooling_k, 0.0, kGrowing);
      }
    }
    for (int turn = 0; turn < kWarmTurns; ++turn) follow(0.0, kWarmest_k, kShrinking);
  }
  [[nodiscard]] std::vector<float> take_ice_m() { return std::move(ice_m_); }
  [[nodiscard]] LandClimate today() const {
    LandClimate climate_now = climate(0.0);
    climate_now.between = std::make_shared<const RowResampling>(raster_, fine_, grid_->figure());
    return climate_now;
  }

 private:
  void follow(double colder_k, double warmer_k, int rounds) {
    ice_.follow(climate(colder_k), warmer_k, rounds, ground_m_);
    ice_m_.assign(ice_.thickness_m().begin(), ice_.thickness_m().end());
  }
  [[nodiscard]] LandClimate climate(double colder_k) const {
    return climate_of_surface(grid_, ice_.surface_m(ground_m_), ice_m_, {kCoarser, colder_k},
                              context_);
  }

  Context& context_;
  Raster fine_;
  std::shared_ptr<const Grid> grid_;
  Raster raster_;
  std::vector<float> ground_m_, ice_m_;
  IceAge ice_;
};

double turn_seconds(std::span<const Parameter> configuration) {
  constexpr double kFields_s = 0.15;  // on the grid of climates, whatever that of the air
  return kFields_s + climate_of_land_seconds(configuration, {.coarser = kCoarser});
}

}  // namespace

LandClimate icy_climate(const ErosionParameters& parameters, const Grid& grid,
                        std::span<const float> elevation_m, Context& context) {
  IceAndAir both(parameters, grid, elevation_m, context);
  both.live(parameters);
  return both.today();
}

std::vector<float> living_ice_m(const ErosionParameters& parameters, const Grid& grid,
                                std::span<const float> elevation_m, Context& context) {
  IceAndAir both(parameters, grid, elevation_m, context);
  both.live(parameters);
  return both.take_ice_m();
}

double icy_climate_seconds(std::span<const Parameter> configuration) {
  return (kColdTurns + kWarmTurns + 1) * turn_seconds(configuration);
}

double warm_ice_seconds(std::span<const Parameter> configuration) {
  return kWarmTurns * turn_seconds(configuration);
}

}  // namespace geo
