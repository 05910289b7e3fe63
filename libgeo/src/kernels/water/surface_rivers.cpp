#include "geo/kernels/water/surface_rivers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geo/core/array_sizes.hpp"
#include "kernels/numerics/monotone_queue.hpp"

namespace geo {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Places of the sea: what lies below 0 and is not landlocked. Water is landlocked where no deep
/// floor, no open side and not most of the water is joined to it.
std::vector<std::uint8_t> sea_of(const SurfaceGraph& graph, std::span<const float> z) {
  constexpr float kDeep_m = -1000.0F;
  const auto is_water = [&](std::int32_t i) { return graph.is_there[i] != 0 && z[i] < 0.0F; };
  std::vector<std::uint8_t> sea(z.size(), 0), seen(z.size(), 0);
  std::vector<std::int32_t> water, largest;
  const auto become_sea = [&](const std::vector<std::int32_t>& places) {
    for (const std::int32_t i : places) sea[i] = 1;
  };
  for (std::int32_t first = 0; first < graph.size(); ++first) {
    if (seen[first] != 0 || !is_water(first)) continue;
    water.assign(1, first);
    seen[first] = 1;
    bool is_joined = false;
    for (std::size_t at = 0; at < water.size(); ++at) {
      const std::int32_t i = water[at];
      is_joined = is_joined || z[i] < kDeep_m || graph.is_open[i] != 0;
      for (std::int32_t k = graph.first[i]; k < graph.first[i + 1]; ++k) {
        const std::int32_t j = graph.neighbour[k];
        if (seen[j] != 0 || !is_water(j)) continue;
        seen[j] = 1;
        water.push_back(j);
      }
    }
    if (is_joined) become_sea(water);
    if (water.size() > largest.size()) largest = water;
  }
  become_sea(largest);
  return sea;
}

/// Floods land from the coast inland.
class Flood {
 public:
  Flood(const SurfaceGraph& graph, std::span<const float> z)
      : graph_(graph),
        z_(z),
        sea_(sea_of(graph, z)),
        level_(z.size(), kFar),
        from_(z.size(), SurfaceRivers::kSink) {
    out_.receiver.assign(z.size(), SurfaceRivers::kSink);
    out_.distance_m.assign(z.size(), 0.0F);
  }

  SurfaceRivers run() {
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (graph_.is_there[i] == 0) continue;
      if (sea_[i] != 0) {
        level_[i] = 0.0F;
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
  void reach(std::int32_t i, float level, std::int32_t from) {
    level_[i] = std::max(z_[i], level);
    from_[i] = from;
    queue_.push(level_[i], i);
  }
  void spread_from(std::int32_t i) {
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      const std::int32_t j = graph_.neighbour[k];
      if (level_[j] == kFar) reach(j, level_[i], i);
    }
  }
  void rise() {
    while (!queue_.empty()) {
      const std::int32_t i = queue_.pop().second;
      settle(i);
      spread_from(i);
    }
  }
  [[nodiscard]] bool is_settled(std::int32_t i) const {
    return sea_[i] != 0 || out_.distance_m[i] > 0.0F;
  }
  void settle(std::int32_t i) {
    out_.order.push_back(i);
    // An outlet of its own: half a place's width from the water.
    const auto half_m = static_cast<float>(0.5 * std::sqrt(graph_.area_m2));
    std::int32_t to = from_[i];
    float steepest = from_[i] == SurfaceRivers::kOpen ? level_[i] / half_m : 0.0F;
    float way_m = half_m;
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      const std::int32_t j = graph_.neighbour[k];
      if (j == from_[i]) way_m = graph_.distance_m[k];
      if (!is_settled(j)) continue;
      const float slope = (level_[i] - level_[j]) / graph_.distance_m[k];
      if (slope <= steepest) continue;
      steepest = slope;
      to = j;
    }
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      if (graph_.neighbour[k] == to) way_m = graph_.distance_m[k];
    }
    out_.receiver[i] = to;
    out_.distance_m[i] = way_m;
  }
  /// Land that no sea borders drains to its lowest place, landlocked water on it stands at 0.
  void seed_enclosed() {
    std::vector<std::pair<float, std::int32_t>> dry;
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (graph_.is_there[i] != 0 && level_[i] == kFar) dry.emplace_back(z_[i], i);
    }
    std::sort(dry.begin(), dry.end());
    for (const auto& [level, i] : dry) {
      if (level_[i] != kFar) continue;
      reach(i, std::max(level, 0.0F), SurfaceRivers::kSink);
      rise();
    }
  }

  const SurfaceGraph& graph_;
  std::span<const float> z_;
  std::vector<std::uint8_t> sea_;
  std::vector<float> level_;
  std::vector<std::int32_t> from_;
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
    for (const std::int32_t i : order_) {
      if (load_m3_[i] > 0.0) pass_on(i, lay(i, share * load_m3_[i]));
    }
    settle_evenly();
    return laid_m3_;
  }

 private:
  static constexpr float kLengths = 6.0F;  // farther off, what is left is everywhere

  void order_by_way_from_coast() {
    const float farthest = kLengths * static_cast<float>(1e3 * law_.settling_km);
    way_m_.assign(z_.size(), kFar);
    MonotoneQueue queue;
    for (std::int32_t i = 0; i < graph_.size(); ++i) {
      if (load_m3_[i] <= 0.0) continue;
      way_m_[i] = 0.0F;
      queue.push(0.0F, i);
    }
    while (!queue.empty()) {
      const auto [way, i] = queue.pop();
      if (way > way_m_[i]) continue;
      order_.push_back(i);
      for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
        const std::int32_t j = graph_.neighbour[k];
        const float next = way + graph_.distance_m[k];
        if (z_[j] >= 0.0F || next >= way_m_[j] || next > farthest) continue;
        way_m_[j] = next;
        queue.push(next, j);
      }
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
    double sum = 0.0;
    for (const int pass : {0, 1}) {
      for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
        const std::int32_t j = graph_.neighbour[k];
        if (!(way_m_[j] > way_m_[i]) || way_m_[j] == kFar) continue;
        const double weight = (way_m_[j] - way_m_[i]) / graph_.distance_m[k];
        if (pass == 0) {
          sum += weight;
        } else {
          load_m3_[j] += m3 * weight / sum;
        }
      }
      if (sum == 0.0) {
        rest_m3_ += m3;
        return;
      }
    }
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
  std::vector<std::int32_t> order_;
  double rest_m3_ = 0.0, laid_m3_ = 0.0;
};

}  // namespace

SurfaceRivers route_rivers(const SurfaceGraph& graph, std::span<const float> elevation_m,
                           std::span<const float> runoff) {
  check_sizes(
      "route_rivers", graph.is_there.size(),
      {{"elevation_m", elevation_m.size()}, {"runoff", runoff.size(), ArraySize::May::be_empty}});
  SurfaceRivers rivers = Flood(graph, elevation_m).run();
  rivers.area_m2.assign(elevation_m.size(), graph.area_m2);
  for (std::size_t i = 0; i < runoff.size(); ++i) rivers.area_m2[i] *= runoff[i];
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
