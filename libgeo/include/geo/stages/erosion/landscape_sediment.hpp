#pragma once

// Landscape: where what rivers and ice take is laid down. Included by landscape.hpp.

#include <algorithm>
#include <utility>

#include "geo/kernels/landscape/deltas.hpp"
#include "geo/kernels/landscape/marine_deposition.hpp"
#include "geo/kernels/landscape/river_sediment.hpp"
#include "geo/stages/erosion/landscape.hpp"

namespace geo {

template <class V>
void Landscape<V>::carry(const FlowGraph& graph, const IceWork& ice,
                         const std::function<void()>& graph_done) {
  if constexpr (kRecords) {
    if (ice) return let_ice_work(graph, ice, graph_done);
  }
  std::vector<Number> volume_m3;
  if (deposits()) {
    volume_m3 = outflow(graph, before_, z_);
    record_layers();
    record_released(graph, volume_m3);
  }
  if (graph_done) graph_done();
  if (deposits()) spread_at_sea(volume_m3);
}

template <class V>
void Landscape<V>::let_ice_work(const FlowGraph& graph, const IceWork& ice,
                                const std::function<void()>& graph_done) {
  if (deposits()) record_layers();
  std::vector<V> before_rivers = std::exchange(before_, {z_.begin(), z_.end()});
  std::vector<SparseValues<double>> let_out = ice(z_, before_);
  rock_.eroded -= volume_since_before();
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid_.size(); ++cell) {
    if (outlets_[cell] == 0) records_.lowered_m[cell] += before_[cell] - z_[cell];
    records_.crust_change_m[cell] += Number(z_[cell]) - Number(before_[cell]);
  }
  if (deposits()) {
    WorkArray<double> let_out_m3(static_cast<std::size_t>(grid_.size()), 0.0);
    for (SparseValues<double>& part : let_out) {
      part.set()->visit([&](Index cell) { let_out_m3[cell] += part.of(cell); });
      part = {};
    }
    graph.accumulate(let_out_m3);
    std::vector<double> volume_m3 = outflow(graph, before_rivers, before_);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) volume_m3[cell] += let_out_m3[cell];
    let_out_m3 = {};
    record_layers();
    record_released(graph, volume_m3);
    if (graph_done) graph_done();
    before_.assign(z_.begin(), z_.end());
    spread_at_sea(volume_m3);
  }
  outlets_ = find_outlets(grid_, z_);
  before_ = std::move(before_rivers);
}

template <class V>
void Landscape<V>::spread_at_sea(std::vector<Number>& volume_m3) {
  WorkArray<std::uint8_t> sea(grid_.size());
  const Number wave_base_m = active_(p_.wave_base_m);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid_.size(); ++cell) {
    sea[cell] = outlets_[cell] != 0 && value_of(z_[cell]) < 0.0 ? 1 : 0;
  }
  build_at_mouths(sea, volume_m3);
  WorkArray<Number> room_m(grid_.size(), Number(0.0)), supply_m(grid_.size(), Number(0.0));
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid_.size(); ++cell) {
    if (sea[cell] == 0) continue;
    const Number up_to_m = is_landlocked(cell) ? Number(-kShallowest_m) : Number(-wave_base_m);
    room_m[cell] = greater(Number(up_to_m - Number(z_[cell])), Number(0.0));
    supply_m[cell] = volume_m3[cell] / grid_.area_m2(grid_.row(cell)) + unsettled_m_[cell];
  }
  rock_.over_edges += area_sum<Number>(grid_, [&](Index cell) {
    return outlets_[cell] != 0 && sea[cell] == 0 ? volume_m3[cell] / grid_.area_m2(grid_.row(cell))
                                                 : Number(0.0);
  });
  release(volume_m3);
  lay_at_sea<Number>(grid_, sea, 1e3 * active_(p_.dispersal_km), room_m, supply_m);
  room_m = {};
  WorkArray<V> laid_m(grid_.size(), V(0.0F));
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid_.size(); ++cell) {
    if (sea[cell] == 0) continue;
    const V floor = z_[cell];
    z_[cell] = lesser(V(Number(floor) + supply_m[cell]), greater(floor, V(-kShallowest_m)));
    laid_m[cell] = z_[cell] - floor;
    unsettled_m_[cell] = supply_m[cell] - (Number(z_[cell]) - Number(floor));
    if constexpr (kRecords) records_.crust_change_m[cell] += Number(z_[cell]) - Number(floor);
  }
  rock_.laid_at_sea += area_sum<Number>(grid_, [&](Index c) {
    return sea[c] != 0 ? Number(z_[c]) - Number(before_[c]) : Number(0.0);
  });
  record_at_sea(laid_m);
}

template <class V>
void Landscape<V>::build_at_mouths(std::span<const std::uint8_t> sea,
                                   std::vector<Number>& volume_m3) {
  if constexpr (kRecords) {
    if (!builds_deltas_ || p_.highstand_yr <= 0.0) return;
    const double share = std::min(1.0, p_.highstand_yr / p_.time_step_yr);
    const auto brought_m3 = [&](Index cell) {
      return sea[cell] != 0 ? std::max(0.0, share * volume_m3[cell]) : 0.0;
    };
    WorkArray<float> laid_m(grid_.size());
    WorkArray<double> left_m3(grid_.size());
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) left_m3[cell] = brought_m3(cell);
    build_deltas(grid_, {}, sea, z_, left_m3, laid_m);
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      volume_m3[cell] -= brought_m3(cell) - left_m3[cell];
    }
    left_m3 = {};
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      if (laid_m[cell] == 0.0F) continue;
      const float floor = z_[cell];
      z_[cell] += laid_m[cell];
      records_.crust_change_m[cell] += Number(z_[cell]) - Number(floor);
      // What rounding to the height of the plain took or gave.
      unsettled_m_[cell] += Number(laid_m[cell]) - (Number(z_[cell]) - Number(floor));
    }
    record_at_sea(laid_m);
  }
}

template <class V>
void Landscape<V>::record_layers() {
  if constexpr (kRecords) {
    on_land([&](Index cell) {
      const float rise_m = z_[cell] - before_[cell];
      float& thickness_m = records_.sediment.thickness_m[cell];
      thickness_m = std::max(0.0F, thickness_m + rise_m);
      records_.sediment.laid_m[cell] += std::max(0.0F, rise_m);
    });
  }
  rock_.laid_on_land += area_sum<Number>(grid_, [&](Index c) {
    return outlets_[c] == 0 ? greater(Number(Number(z_[c]) - Number(before_[c])), Number(0.0))
                            : Number(0.0);
  });
}

template <class V>
void Landscape<V>::record_released(const FlowGraph& graph, const std::vector<Number>& volume_m3) {
  if constexpr (kRecords) {
    std::vector<float>& released = records_.sediment.released_m3_yr;
    released.resize(grid_.size());
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      released[cell] = static_cast<float>(volume_m3[cell] / p_.time_step_yr);
    }
    // Less what comes from above: by donors in their order, so that sums are the same always.
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      const Index to = graph.receiver[cell];
      if (to != cell) released[to] -= static_cast<float>(volume_m3[cell] / p_.time_step_yr);
    }
  }
}

template <class V>
void Landscape<V>::record_at_sea(std::span<const V> laid_m) {
  if constexpr (kRecords) {
#pragma omp parallel for schedule(static)
    for (Index cell = 0; cell < grid_.size(); ++cell) {
      // What heights round away may be taken off again.
      float& thickness_m = records_.sediment.thickness_m[cell];
      thickness_m = std::max(0.0F, thickness_m + laid_m[cell]);
      records_.sediment.laid_m[cell] += std::max(0.0F, laid_m[cell]);
    }
  }
}

}  // namespace geo
