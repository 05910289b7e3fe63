#include "geo/kernels/water/surface_rivers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "surface_flood.hpp"
#include "surface_sea.hpp"

namespace geo {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
/// Receiver of water that goes to the sea.
constexpr std::int32_t kToSea = -3;

float lowest_neighbour_m(const SurfaceGraph& graph, std::span<const float> z, std::int32_t i) {
  float lowest = kFar;
  for (std::int32_t k = graph.first[i]; k < graph.first[i + 1]; ++k) {
    lowest = std::min(lowest, z[graph.neighbour[k]]);
  }
  return lowest == kFar ? z[i] : lowest;
}

/// Where water goes from each place of land, by the order: its receiver's number in it, or how it
/// leaves the land.
std::vector<std::int32_t> receivers_in_order(const SurfaceRivers& rivers) {
  const auto places = static_cast<std::int32_t>(rivers.order.size());
  std::vector<std::int32_t> number(rivers.receiver.size(), kToSea), to(rivers.order.size());
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (std::int32_t p = 0; p < places; ++p) number[rivers.order[p]] = p;
#pragma omp for schedule(static)
    for (std::int32_t p = 0; p < places; ++p) {
      const std::int32_t receiver = rivers.receiver[rivers.order[p]];
      to[p] = receiver >= 0 ? number[receiver] : receiver;
    }
  }
  return to;
}

/// The elimination of the law on land. Volumes are in metres of the surface on one place. Places go
/// by their number in the order, each behind its receiver.
class LandStep {
 public:
  LandStep(const SurfaceGraph& graph, const SurfaceRivers& rivers, const RiverLaw& law,
           std::span<const std::int8_t> is_rock, std::span<const float> erodibility,
           std::span<const float> z)
      : graph_(graph),
        law_(law),
        order_(rivers.order),
        z_(z),
        to_(receivers_in_order(rivers)),
        place_(order_.size()) {
    const std::int32_t places = size();
#pragma omp parallel for schedule(static)
    for (std::int32_t p = 0; p < places; ++p) {
      const std::int32_t i = order_[p];
      place_[p].z = z[i];
      if (is_rock[i] == 0) continue;
      const double of_rock = erodibility.empty() ? 1.0 : erodibility[i];
      const double per_step = of_rock * law.erodibility_yr / law.rebound * law.dt_yr;
      place_[p].factor =
          per_step * std::pow(rivers.area_m2[i], law.area_exponent) / rivers.distance_m[i];
    }
    for (std::int32_t p = 0; p < places; ++p) {
      place_[p].level_m = std::max(place_[p].z, static_cast<float>(base_m(p)));
    }
    for (std::int32_t p = places; p-- > 0;) {
      if (to_[p] >= 0) place_[to_[p]].drained += place_[p].drained;
    }
  }

  /// How far each place sinks in the step.
  void solve() {
    eliminate();
    substitute();
  }
  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(order_.size()); }
  [[nodiscard]] float after_m(std::int32_t p) const {
    return static_cast<float>(place_[p].z - place_[p].lowering_m);
  }
  [[nodiscard]] const std::vector<std::int32_t>& to() const { return to_; }

 private:
  struct Place {
    float z = 0.0F;
    float level_m = 0.0F;  ///< of the water; that of the sea is 0
    double factor = 0.0;   ///< of the slope in what a step cuts
    double drained = 1.0;  ///< places that drain through it
    double lowering_m = 0.0, follows = 0.0;
  };

  /// Lakes, and places without a way out, which hold what comes.
  [[nodiscard]] bool is_basin(std::int32_t p) const {
    return place_[p].level_m > place_[p].z || to_[p] == SurfaceRivers::kSink;
  }
  [[nodiscard]] bool moves(std::int32_t p) const { return p >= 0 && !is_basin(p); }
  /// Of the water that a place drains to.
  [[nodiscard]] double base_m(std::int32_t p) const {
    const std::int32_t to = to_[p];
    return to >= 0 ? place_[to].level_m : to == SurfaceRivers::kSink ? place_[p].z : 0.0;
  }
  [[nodiscard]] double room_m(std::int32_t p) const {
    const float full_m = to_[p] == SurfaceRivers::kSink ? lowest_neighbour_m(graph_, z_, order_[p])
                                                        : place_[p].level_m;
    return std::max(0.0, static_cast<double>(full_m) - place_[p].z);
  }

  /// Down the rivers: lowering e = lowering + follows e_receiver. Until its turn a place holds what
  /// its donors bring, lowering + follows e of its own.
  void eliminate() {
    for (std::int32_t p = size(); p-- > 0;) {
      Place& at = place_[p];
      const double brought = at.lowering_m, more = at.follows;
      double out = 0.0, out_follows = 0.0;
      if (is_basin(p)) {
        const double laid = std::clamp(brought, 0.0, room_m(p));
        at.lowering_m = -laid;
        at.follows = 0.0;
        out = brought - laid;
      } else {
        const double settles = law_.deposition / at.drained;
        const double total = 1.0 + at.factor + settles * (1.0 + more);
        at.lowering_m = (at.factor * (at.z - base_m(p)) - settles * brought) / total;
        at.follows = moves(to_[p]) ? at.factor / total : 0.0;
        out = brought + (1.0 + more) * at.lowering_m;
        out_follows = (1.0 + more) * at.follows;
      }
      if (to_[p] < 0) continue;
      place_[to_[p]].lowering_m += out;
      place_[to_[p]].follows += out_follows;
    }
  }
  /// Up the rivers. What lies below its receiver is not cut, and keeps what settles on it.
  void substitute() {
    for (std::int32_t p = 0; p < size(); ++p) {
      if (is_basin(p)) continue;
      Place& at = place_[p];
      const double sinks_m = moves(to_[p]) ? place_[to_[p]].lowering_m : 0.0;
      double& e = at.lowering_m;
      e += at.follows * sinks_m;
      const double drop_m = at.z - base_m(p) - e + sinks_m;
      if (drop_m < 0.0) e = std::min(e - at.factor * drop_m, 0.0);
    }
  }

  const SurfaceGraph& graph_;
  const RiverLaw& law_;
  std::span<const std::int32_t> order_;
  std::span<const float> z_;
  std::vector<std::int32_t> to_;
  std::vector<Place> place_;
};

}  // namespace

SurfaceRivers route_rivers(const SurfaceGraph& graph, std::span<const float> elevation_m,
                           const std::function<double(std::int32_t place)>& runoff) {
  check_sizes("route_rivers", graph.is_there.size(), {{"elevation_m", elevation_m.size()}});
  SurfaceRivers rivers = detail::flood_land(graph, elevation_m);
  rivers.area_m2.assign(elevation_m.size(), graph.area_m2);
  if (runoff) {
    const auto places = static_cast<std::ptrdiff_t>(rivers.order.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t at = 0; at < places; ++at) {
      const std::int32_t i = rivers.order[at];
      rivers.area_m2[i] *= runoff(i);
    }
  }
  for (auto at = rivers.order.rbegin(); at != rivers.order.rend(); ++at) {
    const std::int32_t to = rivers.receiver[*at];
    if (to >= 0) rivers.area_m2[to] += rivers.area_m2[*at];
  }
  return rivers;
}

RiverWork run_rivers(const SurfaceGraph& graph, const SurfaceRivers& rivers, const RiverLaw& law,
                     std::span<const std::int8_t> is_rock, std::span<float> elevation_m,
                     std::span<float> rock_m, std::span<const float> erodibility) {
  check_sizes("run_rivers", elevation_m.size(),
              {{"receiver", rivers.receiver.size()},
               {"is_rock", is_rock.size()},
               {"rock_m", rock_m.size()},
               {"erodibility", erodibility.size(), ArraySize::May::be_empty}});
  std::fill(rock_m.begin(), rock_m.end(), 0.0F);
  LandStep land(graph, rivers, law, is_rock, erodibility, elevation_m);
  land.solve();
  const std::int32_t places = land.size();
  std::vector<double> gone_m(rivers.order.size());
#pragma omp parallel for schedule(static)
  for (std::int32_t p = 0; p < places; ++p) {
    const std::int32_t i = rivers.order[p];
    const float after_m = land.after_m(p);
    gone_m[p] = law.rebound * (static_cast<double>(elevation_m[i]) - after_m);
    elevation_m[i] = after_m;
    rock_m[i] = static_cast<float>(-gone_m[p]);
  }
  RiverWork work;
  std::vector<double> load_m3(rivers.order.size(), 0.0);
  detail::SeaLoad sea{std::vector<double>(elevation_m.size(), 0.0)};
  for (std::int32_t p = places; p-- > 0;) {
    (gone_m[p] > 0.0 ? work.eroded_m3 : work.on_land_m3) += std::abs(gone_m[p]) * graph.area_m2;
    load_m3[p] += gone_m[p] * graph.area_m2;
    const std::int32_t to = land.to()[p];
    if (to >= 0) {
      load_m3[to] += load_m3[p];
    } else if (to != kToSea || load_m3[p] < 0.0) {  // what has settled on land beyond what came
      sea.rest_m3 += load_m3[p];
    } else {
      sea.at_place_m3[rivers.receiver[rivers.order[p]]] += load_m3[p];
    }
  }
  work.in_sea_m3 = detail::settle_in_sea(graph, law, sea, elevation_m, rock_m);
  return work;
}

}  // namespace geo
