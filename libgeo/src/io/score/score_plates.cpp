// Figures of plates: sizes, speeds, boundaries.
#include <numeric>

#include "geo/kernels/figures/plate_figures.hpp"
#include "score_figures.hpp"

namespace geo::io {
namespace {

constexpr double kThousandKm = 1e6;  // m

void measure_boundary_lengths(const State& state, Figures& figures) {
  const auto boundaries = measure_boundaries(
      state.grid(),
      {state.read(field::plate_id), state.read(field::continental_fraction),
       state.read(field::plate_velocity_east), state.read(field::plate_velocity_north)});
  const auto length = [&](BoundaryKind kind) {
    return boundaries.length_m[static_cast<int>(kind)] / kThousandKm;
  };
  const auto opening = [&](BoundaryKind kind) {
    return boundaries.opening_mm_yr[static_cast<int>(kind)];
  };
  figures["boundaries"] = boundaries.total_m() / kThousandKm;
  figures["ridge_length"] = length(BoundaryKind::ocean_ridge);
  figures["ocean_transform_length"] = length(BoundaryKind::ocean_transform);
  figures["subduction_length"] = length(BoundaryKind::subduction);
  figures["rift_length"] = length(BoundaryKind::continental_rift);
  figures["continental_transform_length"] = length(BoundaryKind::continental_transform);
  figures["collision_length"] = length(BoundaryKind::collision);
  figures["ridge_opening"] = opening(BoundaryKind::ocean_ridge);
  figures["subduction_closing"] = -opening(BoundaryKind::subduction);
}

}  // namespace

void measure_plates(const State& state, Figures& figures) {
  if (state.has(field::plate_id)) {
    const auto shares = plate_shares(state.grid(), state.read(field::plate_id));
    constexpr std::size_t kLargest = 7;
    const auto end = shares.begin() + static_cast<long>(std::min(kLargest, shares.size()));
    figures["plates_7"] = 100.0 * std::accumulate(shares.begin(), end, 0.0);
  }
  if (!state.has(field::plate_velocity_east) || !state.has(field::plate_velocity_north)) return;
  figures["plate_speed"] =
      speed_without_net_rotation(state.grid(), state.read(field::plate_velocity_east),
                                 state.read(field::plate_velocity_north));
  if (state.has(field::plate_id) && state.has(field::continental_fraction)) {
    measure_boundary_lengths(state, figures);
  }
}

}  // namespace geo::io
