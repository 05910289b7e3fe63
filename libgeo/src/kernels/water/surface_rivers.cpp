#include "geo/kernels/water/surface_rivers.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <utility>

#include "geo/core/array_sizes.hpp"
#include "geo/core/parallel_errors.hpp"
#include "kernels/numerics/monotone_queue.hpp"

namespace geo {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Places of the sea: what lies below 0 and is not landlocked. Water is landlocked where no deep
/// floor, no open side and not most of the water is joined to it.
class SeaPlaces {
 public:
  SeaPlaces(const SurfaceGraph& graph, std::span<const float> z)
      : graph_(graph), z_(z), sea_(z.size(), 0) {}

  std::vector<std::uint8_t> find() {
    std::size_t joined = join_what_is_deep_or_open();
    std::vector<std::int32_t> largest;
    std::vector<std::uint8_t> seen = sea_;
    for (std::int32_t first = 0; first < graph_.size(); ++first) {
      if (seen[first] != 0 || !is_water(first)) continue;
      std::vector<std::int32_t> water{first};
      seen[first] = 1;
      spread(water, seen);
      if (water.size() > largest.size()) largest = std::move(water);
    }
    if (largest.size() > joined) {
      for (const std::int32_t i : largest) sea_[i] = 1;
    }
    return std::move(sea_);
  }

 private:
  static constexpr float kDeep_m = -1000.0F;

  [[nodiscard]] bool is_water(std::int32_t i) const {
    return graph_.is_there[i] != 0 && z_[i] < 0.0F;
  }
  /// Adds the water that is joined to some.
  void spread(std::vector<std::int32_t>& water, std::vector<std::uint8_t>& seen) const {
    for (std::size_t at = 0; at < water.size(); ++at) {
      const std::int32_t i = water[at];
      for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
        const std::int32_t j = graph_.neighbour[k];
        if (seen[j] != 0 || !is_water(j)) continue;
        seen[j] = 1;
        water.push_back(j);
      }
    }
  }
  /// Number of places. Of deep ones only those beside shallower water have anything to join.
  std::size_t join_what_is_deep_or_open() {
    std::vector<std::int32_t> edge;
    std::size_t deep = 0;
#pragma omp parallel for schedule(static) reduction(+ : deep)
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (!is_water(i) || (z_[i] >= kDeep_m && graph_.is_open[i] == 0)) continue;
      sea_[i] = 1;
      ++deep;
    }
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (sea_[i] != 0 || !is_water(i)) continue;
      for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
        if (sea_[graph_.neighbour[k]] == 0) continue;
        edge.push_back(i);
        break;
      }
    }
    for (const std::int32_t i : edge) sea_[i] = 1;
    spread(edge, sea_);
    return deep + edge.size();
  }

  const SurfaceGraph& graph_;
  std::span<const float> z_;
  std::vector<std::uint8_t> sea_;
};

/// Floods land from the coast inland.
class Flood {
 public:
  Flood(const SurfaceGraph& graph, std::span<const float> z)
      : graph_(graph), sea_(SeaPlaces(graph, z).find()), place_(z.size()) {
    for (std::size_t i = 0; i < z.size(); ++i) place_[i].z = z[i];
    out_.receiver.assign(z.size(), SurfaceRivers::kSink);
    out_.distance_m.assign(z.size(), 0.0F);
  }

  SurfaceRivers run() {
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (graph_.is_there[i] == 0) continue;
      if (sea_[i] != 0) {
        place_[i].level = 0.0F;
        place_[i].is_settled = true;
      } else if (graph_.is_open[i] != 0) {
        reach(i, 0.0F, SurfaceRivers::kOpen);
      }
    }
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (sea_[i] != 0) spread_from(i);
    }
    rise();
    seed_enclosed();
    return std::move(out_);
  }

 private:
  /// What the flood asks of a neighbour, side by side in memory.
  struct Place {
    float z = 0.0F, level = kFar;
    std::int32_t from = SurfaceRivers::kSink;
    bool is_settled = false;
  };

  void reach(std::int32_t i, float level, std::int32_t from) {
    Place& place = place_[i];
    place.level = std::max(place.z, level);
    place.from = from;
    queue_.push(place.level, i);
  }
  void spread_from(std::int32_t i) {
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      const std::int32_t j = graph_.neighbour[k];
      if (place_[j].level == kFar) reach(j, place_[i].level, i);
    }
  }
  void rise() {
    while (!queue_.empty()) {
      const std::int32_t i = queue_.pop().second;
      settle(i);
      spread_from(i);
    }
  }
  void settle(std::int32_t i) {
    out_.order.push_back(i);
    Place& place = place_[i];
    // An outlet of its own: half a place's width from the water.
    const auto half_m = static_cast<float>(0.5 * std::sqrt(graph_.area_m2));
    std::int32_t to = place.from;
    float steepest = to == SurfaceRivers::kOpen ? place.level / half_m : 0.0F;
    float way_m = half_m;
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      const std::int32_t j = graph_.neighbour[k];
      if (j == place.from) way_m = graph_.distance_m[k];
      if (!place_[j].is_settled) continue;
      const float slope = (place.level - place_[j].level) / graph_.distance_m[k];
      if (slope <= steepest) continue;
      steepest = slope;
      to = j;
    }
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      if (graph_.neighbour[k] == to) way_m = graph_.distance_m[k];
    }
    out_.receiver[i] = to;
    out_.distance_m[i] = way_m;
    place.is_settled = true;
  }
  /// Land that no sea borders drains to its lowest place, landlocked water on it stands at 0.
  void seed_enclosed() {
    std::vector<std::pair<float, std::int32_t>> dry;
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (graph_.is_there[i] != 0 && place_[i].level == kFar) dry.emplace_back(place_[i].z, i);
    }
    std::sort(dry.begin(), dry.end());
    for (const auto& [level, i] : dry) {
      if (place_[i].level != kFar) continue;
      reach(i, std::max(level, 0.0F), SurfaceRivers::kSink);
      rise();
    }
  }

  const SurfaceGraph& graph_;
  std::vector<std::uint8_t> sea_;
  std::vector<Place> place_;
  MonotoneQueue queue_;
  SurfaceRivers out_;
};

float lowest_neighbour_m(const SurfaceGraph& graph, std::span<const float> z, std::int32_t i) {
  float lowest = kFar;
  for (std::int32_t k = graph.first[i]; k < graph.first[i + 1]; ++k) {
    lowest = std::min(lowest, z[graph.neighbour[k]]);
  }
  return lowest == kFar ? z[i] : lowest;
}

/// The elimination of the law on land. Volumes are in metres of the surface on one place.
class LandStep {
 public:
  LandStep(const SurfaceGraph& graph, const SurfaceRivers& rivers, const RiverLaw& law,
           std::span<const std::int8_t> is_rock, std::span<const float> erodibility,
           std::span<const float> z)
      : graph_(graph),
        rivers_(rivers),
        law_(law),
        is_rock_(is_rock),
        erodibility_(erodibility),
        z_(z) {
    level_m_.assign(z.size(), 0.0F);
    places_.assign(z.size(), 1.0);
    lowering_m_.assign(z.size(), 0.0);
    follows_.assign(z.size(), 0.0);
    for (const std::int32_t i : rivers_.order) {
      level_m_[i] = std::max(z_[i], static_cast<float>(base_m(i)));
    }
    for (auto at = rivers_.order.rbegin(); at != rivers_.order.rend(); ++at) {
      const std::int32_t to = rivers_.receiver[*at];
      if (to >= 0) places_[to] += places_[*at];
    }
  }

  /// Elevations after the step; those off the land are as they were.
  std::vector<float> solve() {
    eliminate();
    substitute();
    std::vector<float> after(z_.begin(), z_.end());
    for (const std::int32_t i : rivers_.order) {
      after[i] = static_cast<float>(z_[i] - lowering_m_[i]);
    }
    return after;
  }

 private:
  [[nodiscard]] bool is_land(std::int32_t i) const {
    return i >= 0 && rivers_.distance_m[i] > 0.0F;
  }
  /// Lakes, and places without a way out, which hold what comes.
  [[nodiscard]] bool is_basin(std::int32_t i) const {
    return level_m_[i] > z_[i] || rivers_.receiver[i] == SurfaceRivers::kSink;
  }
  [[nodiscard]] bool moves(std::int32_t i) const { return is_land(i) && !is_basin(i); }
  /// Of the water that a place drains to.
  [[nodiscard]] double base_m(std::int32_t i) const {
    const std::int32_t to = rivers_.receiver[i];
    return to >= 0 ? level_m_[to] : to == SurfaceRivers::kOpen ? 0.0 : z_[i];
  }
  [[nodiscard]] double factor(std::int32_t i) const {
    if (is_rock_[i] == 0) return 0.0;
    const double of_rock = erodibility_.empty() ? 1.0 : erodibility_[i];
    const double per_step = of_rock * law_.erodibility_yr / law_.rebound * law_.dt_yr;
    return per_step * std::pow(rivers_.area_m2[i], law_.area_exponent) / rivers_.distance_m[i];
  }
  [[nodiscard]] double room_m(std::int32_t i) const {
    const float full_m = rivers_.receiver[i] == SurfaceRivers::kSink
                             ? lowest_neighbour_m(graph_, z_, i)
                             : level_m_[i];
    return std::max(0.0, static_cast<double>(full_m) - z_[i]);
  }

  /// Down the rivers: lowering e = lowering + follows e_receiver. Until its turn a place holds what
  /// its donors bring, lowering + follows e of its own.
  void eliminate() {
    for (auto at = rivers_.order.rbegin(); at != rivers_.order.rend(); ++at) {
      const std::int32_t i = *at, to = rivers_.receiver[i];
      const double brought = lowering_m_[i], more = follows_[i];
      double out = 0.0, out_follows = 0.0;
      if (is_basin(i)) {
        const double laid = std::clamp(brought, 0.0, room_m(i));
        lowering_m_[i] = -laid;
        follows_[i] = 0.0;
        out = brought - laid;
      } else {
        const double settles = law_.deposition / places_[i], f = factor(i);
        const double total = 1.0 + f + settles * (1.0 + more);
        lowering_m_[i] = (f * (z_[i] - base_m(i)) - settles * brought) / total;
        follows_[i] = moves(to) ? f / total : 0.0;
        out = brought + (1.0 + more) * lowering_m_[i];
        out_follows = (1.0 + more) * follows_[i];
      }
      if (!is_land(to)) continue;
      lowering_m_[to] += out;
      follows_[to] += out_follows;
    }
  }
  /// Up the rivers. What lies below its receiver is not cut, and keeps what settles on it.
  void substitute() {
    for (const std::int32_t i : rivers_.order) {
      if (is_basin(i)) continue;
      const std::int32_t to = rivers_.receiver[i];
      const double sinks_m = moves(to) ? lowering_m_[to] : 0.0;
      double& e = lowering_m_[i];
      e += follows_[i] * sinks_m;
      const double drop_m = z_[i] - base_m(i) - e + sinks_m;
      if (drop_m < 0.0) e = std::min(e - factor(i) * drop_m, 0.0);
    }
  }

  const SurfaceGraph& graph_;
  const SurfaceRivers& rivers_;
  const RiverLaw& law_;
  std::span<const std::int8_t> is_rock_;
  std::span<const float> erodibility_, z_;
  std::vector<float> level_m_;  ///< of the water at each place; that of the sea is 0
  std::vector<double> places_;  ///< that drain through each
  std::vector<double> lowering_m_, follows_;
};

/// Lays what rivers bring to the sea.
class Sea {
 public:
  Sea(const SurfaceGraph& graph, const RiverLaw& law, std::span<float> z, std::span<float> rock_m)
      : graph_(graph), law_(law), z_(z), rock_m_(rock_m), load_m3_(z.size(), 0.0) {}

  void take(std::int32_t place, double m3) {
    if (place < 0 || m3 < 0.0) {  // what has settled on land beyond what came
      rest_m3_ += m3;
    } else {
      load_m3_[place] += m3;
    }
  }
  /// Volume laid.
  double settle() {
    order_by_way_from_coast();
    const double share = -std::expm1(-std::sqrt(graph_.area_m2) / (1e3 * law_.settling_km));
    for (const auto& ring : rings_) {
      for (const auto& [way_m, i] : ring) {
        if (load_m3_[i] > 0.0) pass_on(i, lay(i, share * load_m3_[i]));
      }
    }
    settle_evenly();
    return laid_m3_;
  }

 private:
  static constexpr float kLengths = 6.0F;  // farther off, what is left is everywhere
  static constexpr float kLand = -1.0F;

  /// A place that a way leads to.
  struct Reached {
    float way_m;
    std::int32_t place;

    auto operator<=>(const Reached&) const = default;
  };

  /// Ring by ring, each about as wide as a place, so that what a ring reaches lies in it seldom
  /// (delta-stepping, Meyer & Sanders 2003); then each is put in order.
  void order_by_way_from_coast() {
    constexpr double kMostRings = 4096.0;
    const float farthest_m = kLengths * static_cast<float>(1e3 * law_.settling_km);
    const double places = farthest_m / std::sqrt(graph_.area_m2);
    const int rings = static_cast<int>(std::clamp(places, 1.0, kMostRings));
    rings_.resize(rings + 1);
    way_m_.resize(z_.size());
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      way_m_[i] = z_[i] < 0.0F ? kFar : kLand;
      if (load_m3_[i] <= 0.0) continue;
      way_m_[i] = 0.0F;
      rings_[0].push_back({0.0F, i});
    }
    for (auto& ring : rings_) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        if (!is_beaten(ring[k])) reach_on(ring[k], farthest_m);
      }
    }
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
    for (int at = 0; at <= rings; ++at) {
      errors.guard([&] {
        std::erase_if(rings_[at], [&](const Reached& place) { return is_beaten(place); });
        std::sort(rings_[at].begin(), rings_[at].end());
      });
    }
    errors.rethrow();
  }
  /// By a shorter way to the same place.
  [[nodiscard]] bool is_beaten(const Reached& one) const { return one.way_m > way_m_[one.place]; }
  void reach_on(const Reached from, float farthest_m) {
    const float rings_per_m = static_cast<float>(rings_.size() - 1) / farthest_m;
    for (std::int32_t k = graph_.first[from.place]; k < graph_.first[from.place + 1]; ++k) {
      const std::int32_t j = graph_.neighbour[k];
      const float next_m = from.way_m + graph_.distance_m[k];
      if (next_m >= way_m_[j] || next_m > farthest_m) continue;
      way_m_[j] = next_m;
      rings_[static_cast<std::size_t>(next_m * rings_per_m)].push_back({next_m, j});
    }
  }
  /// Up to a volume on a place, as far as there is room; the rest of its load.
  double lay(std::int32_t i, double m3) {
    const double room_m3 = std::max(0.0, -law_.shelf_m - z_[i]) / law_.load * graph_.area_m2;
    const double laid_m3 = std::min(m3, room_m3);
    add(i, laid_m3);
    return load_m3_[i] - laid_m3;
  }
  void add(std::int32_t i, double m3) {
    const double thick_m = m3 / graph_.area_m2;
    z_[i] += static_cast<float>(law_.load * thick_m);
    rock_m_[i] += static_cast<float>(thick_m);
    laid_m3_ += m3;
  }
  /// To all neighbours that lie farther from the coast, by how much farther.
  void pass_on(std::int32_t i, double m3) {
    farther_.clear();
    double sum = 0.0;
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      const std::int32_t j = graph_.neighbour[k];
      if (!(way_m_[j] > way_m_[i]) || way_m_[j] == kFar) continue;
      farther_.emplace_back(j, (way_m_[j] - way_m_[i]) / graph_.distance_m[k]);
      sum += farther_.back().second;
    }
    if (farther_.empty()) rest_m3_ += m3;
    for (const auto& [j, weight] : farther_) load_m3_[j] += m3 * weight / sum;
  }
  void settle_evenly() {
    if (rest_m3_ == 0.0) return;
    const auto is_deep = [&](std::int32_t i) {
      return graph_.is_there[i] != 0 && z_[i] < -law_.shelf_m;
    };
    double places = 0.0;
    for (std::int32_t i = 0; i < graph_.size(); ++i) places += is_deep(i) ? 1.0 : 0.0;
    const double each_m3 = rest_m3_ / std::max(1.0, places);
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (is_deep(i)) add(i, each_m3);
    }
  }

  const SurfaceGraph& graph_;
  const RiverLaw& law_;
  std::span<float> z_, rock_m_;
  std::vector<double> load_m3_;
  std::vector<float> way_m_;
  std::vector<std::vector<Reached>> rings_;               ///< of places by their way, ascending
  std::vector<std::pair<std::int32_t, double>> farther_;  ///< than the place whose turn it is
  double rest_m3_ = 0.0, laid_m3_ = 0.0;
};

}  // namespace

SurfaceRivers route_rivers(const SurfaceGraph& graph, std::span<const float> elevation_m,
                           const std::function<double(std::int32_t place)>& runoff) {
  check_sizes("route_rivers", graph.is_there.size(), {{"elevation_m", elevation_m.size()}});
  SurfaceRivers rivers = Flood(graph, elevation_m).run();
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
  const std::vector<float> land_m =
      LandStep(graph, rivers, law, is_rock, erodibility, elevation_m).solve();
  RiverWork work;
  std::vector<double> load_m3(elevation_m.size(), 0.0);
  Sea sea(graph, law, elevation_m, rock_m);
  for (auto at = rivers.order.rbegin(); at != rivers.order.rend(); ++at) {
    const std::int32_t i = *at, to = rivers.receiver[i];
    const double gone_m = law.rebound * (static_cast<double>(elevation_m[i]) - land_m[i]);
    elevation_m[i] = land_m[i];
    rock_m[i] = static_cast<float>(-gone_m);
    (gone_m > 0.0 ? work.eroded_m3 : work.on_land_m3) += std::abs(gone_m) * graph.area_m2;
    load_m3[i] += gone_m * graph.area_m2;
    if (to >= 0 && rivers.distance_m[to] > 0.0F) {
      load_m3[to] += load_m3[i];
    } else {
      sea.take(to, load_m3[i]);
    }
  }
  work.in_sea_m3 = sea.settle();
  return work;
}

}  // namespace geo
