#include "geo/stages/erosion/drainage.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "geo/core/parallel_errors.hpp"
#include "geo/core/release.hpp"
#include "geo/core/work_array.hpp"
#include "geo/kernels/landscape/river_sediment.hpp"
#include "geo/kernels/water/depressions.hpp"
#include "geo/kernels/water/lakes.hpp"
#include "geo/kernels/water/multiple_flow.hpp"
#include "geo/kernels/water/water_balance.hpp"

namespace geo {
namespace {

/// Raises values of cells to at least so much for each square metre.
void keep_at_least(const Grid& grid, double least_per_m2, std::span<double> values) {
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    for (Index c = grid.cell(0, j); c < grid.cell(0, j) + grid.nx(); ++c) {
      values[c] = std::max(values[c], least_per_m2 * grid.area_m2(j));
    }
  }
}

/// Area whose water each cell sheds at the reference runoff, m2: negative where a lake loses more.
void shed_rain(const ErosionParameters& p, const Grid& grid, std::span<const float> elevation_m,
               std::span<const std::uint8_t> outlets, const LandClimate& climate,
               std::span<double> shed) {
  WorkArray<float> loss_m3_s(grid.size());
  WorkArray<std::uint8_t> sea(grid.size());
#pragma omp parallel for schedule(static)
  for (Index c = 0; c < grid.size(); ++c) sea[c] = elevation_m[c] < 0.0F ? 1 : 0;
  land_water(grid, sea, climate.on_cells(climate.precipitation_mm_yr, grid),
             climate.on_cells(climate.potential_mm_yr, grid), shed, loss_m3_s);
  const double m2_per_m3_s = kSecondsPerYear / (1e-3 * p.reference_runoff_mm_yr);
  const double least = p.least_runoff_mm_yr / p.reference_runoff_mm_yr / m2_per_m3_s;
  keep_at_least(grid, least, shed);
  WorkArray<Index> receiver(grid.size());
  steepest_receivers(grid, elevation_m, outlets, receiver);
  const auto hierarchy = build_depression_hierarchy(grid, elevation_m, outlets, receiver);
  receiver = {};
  const Lakes lakes = balance_lakes(grid, elevation_m, hierarchy, shed, loss_m3_s);
#pragma omp parallel for schedule(static)
  for (Index c = 0; c < grid.size(); ++c) shed[c] *= m2_per_m3_s;
  for (const Lake& lake : lakes.lakes) {
    shed[hierarchy.depressions[lake.depression].sill_inside] -= m2_per_m3_s * lake.loss_m3_s;
  }
}

/// Lakes whose water parts upstream may take more than comes.
void keep_some_water(const ErosionParameters& p, const Grid& grid, std::span<double> area_m2) {
  const double least = p.least_runoff_mm_yr / p.reference_runoff_mm_yr;
  keep_at_least(grid, least, area_m2);
}

}  // namespace

LandClimate::Reader::Reader(const LandClimate& climate, const Grid& grid,
                            const std::vector<float>& field)
    : between_(climate.between.get()), nx_(grid.nx()), field_(field) {
  if (between_ == nullptr) return;
  values_.resize(static_cast<std::size_t>(nx_));
  scratch_.resize(between_->scratch_size());
}

std::span<const float> LandClimate::Reader::row(int j) {
  const auto nx = static_cast<std::size_t>(nx_);
  if (between_ == nullptr) return field_.subspan(static_cast<std::size_t>(j) * nx, nx);
  between_->row(field_, j, values_, scratch_);
  return values_;
}

std::vector<float> LandClimate::on_cells(const std::vector<float>& field, const Grid& grid) const {
  std::vector<float> values(static_cast<std::size_t>(grid.size()));
  ParallelErrors errors;
#pragma omp parallel
  {
    auto reader = errors.make<std::optional<Reader>>(std::in_place, *this, grid, field);
#pragma omp for schedule(static)
    for (int j = 0; j < grid.ny(); ++j) {
      if (errors.any()) continue;
      const auto row = reader->row(j);
      std::copy(row.begin(), row.end(), values.begin() + grid.cell(0, j));
    }
  }
  errors.rethrow();
  return values;
}

void drain(const ErosionParameters& p, const Grid& grid, std::span<const float> elevation_m,
           std::span<const std::uint8_t> outlets, Drainage& drainage, const LandClimate* climate,
           std::span<const double> inflow_area_m2) {
  const bool spread = p.flow_routing == "mfd";
  FlowGraph& graph = drainage.graph;
  graph = {};
  release(drainage.flooded);
  std::vector<double>& area_m2 = drainage.area_m2;
  area_m2.resize(grid.size());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    std::fill_n(area_m2.begin() + grid.cell(0, j), grid.nx(), grid.area_m2(j));
  }
  if (climate != nullptr) shed_rain(p, grid, elevation_m, outlets, *climate, area_m2);
  Routing routing = route_unordered(grid, elevation_m, outlets, spread);
  graph = std::move(routing.graph);
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < inflow_area_m2.size(); ++c) area_m2[c] += inflow_area_m2[c];
  const auto put_in_order = [&] { graph.put_in_order(); };
  if (spread) {
    accumulate_flow(grid, routing.filled_m, graph.receiver, {FlowMethod::multiple, p.flow_exponent},
                    area_m2, put_in_order);
  } else {
    put_in_order();
    graph.accumulate(area_m2);
  }
  release(routing.filled_m);
  if (climate != nullptr) keep_some_water(p, grid, area_m2);
  if (p.deposits() && p.depressions == "fill") {
    drainage.flooded = flooded_cells(graph, elevation_m);
  }
}

}  // namespace geo
