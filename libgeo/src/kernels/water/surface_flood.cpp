#include "surface_flood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kernels/numerics/monotone_queue.hpp"

namespace geo::detail {
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
  [[nodiscard]] bool is_beside_sea(std::int32_t i) const {
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      if (sea_[graph_.neighbour[k]] != 0) return true;
    }
    return false;
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
    const std::int32_t n = graph_.size();
    std::vector<std::uint8_t> is_edge(sea_.size(), 0);
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < n; ++i) {
      is_edge[i] = sea_[i] == 0 && is_water(i) && is_beside_sea(i) ? 1 : 0;
    }
    for (std::int32_t i = 0; i < n; ++i) {
      if (is_edge[i] != 0) edge.push_back(i);
    }
    for (const std::int32_t i : edge) sea_[i] = 1;
    spread(edge, sea_);
    return deep + edge.size();
  }

  const SurfaceGraph& graph_;
  std::span<const float> z_;
  std::vector<std::uint8_t> sea_;
};

/// Places of land alone, in the order of the surface, and the ways between them: what the flood
/// asks for lies close together in memory.
struct LandGraph {
  static constexpr std::int32_t kSea = -1;
  struct Way {
    std::int32_t to;  ///< place of land, or kSea
    float distance_m;
  };

  std::vector<std::int32_t> place;  ///< of the surface
  std::vector<std::int32_t> first;  ///< of each place in way; one more at the end
  std::vector<Way> way;             ///< in the order of the surface's

  std::vector<std::uint8_t> is_coast;  ///< of each place: beside the sea

  LandGraph(const SurfaceGraph& graph, std::span<const std::uint8_t> is_sea) {
    const std::vector<std::int32_t> number = number_places(graph, is_sea);
    way.resize(first.back());
    is_coast.resize(place.size());
    const std::int32_t places = size();
#pragma omp parallel for schedule(static)
    for (std::int32_t p = 0; p < places; ++p) {
      std::int32_t at = graph.first[place[p]];
      for (std::int32_t k = first[p]; k < first[p + 1]; ++k, ++at) {
        way[k] = {number[graph.neighbour[at]], graph.distance_m[at]};
        if (way[k].to == kSea) is_coast[p] = 1;
      }
    }
  }
  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(place.size()); }

 private:
  /// Of each place of the surface, or kSea; `place` and `first` go with it.
  std::vector<std::int32_t> number_places(const SurfaceGraph& graph,
                                          std::span<const std::uint8_t> is_sea) {
    constexpr std::int32_t kBlock = 8192;
    struct Count {
      std::int32_t places = 0, ways = 0;
    };
    const std::int32_t n = graph.size(), blocks = (n + kBlock - 1) / kBlock;
    const auto over_block = [&](std::int32_t block, auto&& visit) {
      for (std::int32_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) {
        if (graph.is_there[i] != 0 && is_sea[i] == 0) visit(i, graph.first[i + 1] - graph.first[i]);
      }
    };
    std::vector<Count> before(blocks + 1);  // each block, once they are summed up
#pragma omp parallel for schedule(static)
    for (std::int32_t block = 0; block < blocks; ++block) {
      over_block(block, [&](std::int32_t, std::int32_t ways) {
        ++before[block + 1].places;
        before[block + 1].ways += ways;
      });
    }
    for (std::int32_t block = 0; block < blocks; ++block) {
      before[block + 1].places += before[block].places;
      before[block + 1].ways += before[block].ways;
    }
    place.resize(before.back().places);
    first.resize(place.size() + 1);
    first.back() = before.back().ways;
    std::vector<std::int32_t> number(is_sea.size(), kSea);
#pragma omp parallel for schedule(static)
    for (std::int32_t block = 0; block < blocks; ++block) {
      Count at = before[block];
      over_block(block, [&](std::int32_t i, std::int32_t ways) {
        number[i] = at.places;
        place[at.places] = i;
        first[at.places++] = at.ways;
        at.ways += ways;
      });
    }
    return number;
  }
};

/// Floods land from the coast inland. Numbers are those of the places of land, which ascend as
/// those of the surface do: the flood comes to places of one level in the same order.
class Flood {
 public:
  Flood(const SurfaceGraph& graph, std::span<const float> z)
      : graph_(graph), land_(graph, SeaPlaces(graph, z).find()), spot_(land_.place.size()) {
    const std::int32_t places = land_.size();
#pragma omp parallel for schedule(static)
    for (std::int32_t p = 0; p < places; ++p) spot_[p].z = z[land_.place[p]];
    order_.reserve(land_.place.size());
    down_.reserve(land_.place.size());
  }

  SurfaceRivers run() {
    for (std::int32_t p = 0; p < land_.size(); ++p) {
      if (graph_.is_open[land_.place[p]] != 0) {
        reach(p, 0.0F, kOpen);
      } else if (land_.is_coast[p] != 0) {
        reach(p, 0.0F, kSea);
      }
    }
    rise();
    seed_enclosed();
    return rivers();
  }

 private:
  // Where the flood can come from beside places of land.
  static constexpr std::int32_t kOpen = SurfaceRivers::kOpen, kSink = SurfaceRivers::kSink,
                                kSea = -3;

  /// What the flood asks of a neighbour, side by side in memory.
  struct Spot {
    float z = 0.0F, level = kFar;
    std::int32_t from = kSink;
    bool is_settled = false;
  };

  void reach(std::int32_t p, float level, std::int32_t from) {
    Spot& spot = spot_[p];
    spot.level = std::max(spot.z, level);
    spot.from = from;
    queue_.push(spot.level, p);
  }
  void rise() {
    while (!queue_.empty()) {
      const auto p = static_cast<std::int32_t>(queue_.pop().second);
      order_.push_back(p);
      down_.push_back(way_down_and_on(p));
      spot_[p].is_settled = true;
    }
  }
  /// The steepest way from a place to water that has been there before, or -1, and the flood goes
  /// on to where none has.
  std::int32_t way_down_and_on(std::int32_t p) {
    const float level = spot_[p].level;
    float steepest = spot_[p].from == kOpen ? level / half_m_ : 0.0F;
    std::int32_t down = -1;
    for (std::int32_t k = land_.first[p]; k < land_.first[p + 1]; ++k) {
      const auto [to, distance_m] = land_.way[k];
      const bool is_sea = to == LandGraph::kSea;
      if (is_sea || spot_[to].is_settled) {
        const float slope = (level - (is_sea ? 0.0F : spot_[to].level)) / distance_m;
        if (slope <= steepest) continue;
        steepest = slope;
        down = k;
      } else if (spot_[to].level == kFar) {
        reach(to, level, p);
      }
    }
    return down >= 0 ? down : way_back(p);
  }
  /// The way from which the flood came, or -1 where that is none between places: of several to the
  /// sea that to its first place.
  [[nodiscard]] std::int32_t way_back(std::int32_t p) const {
    const std::int32_t from = spot_[p].from;
    std::int32_t back = -1;
    if (from == kOpen || from == kSink) return back;
    for (std::int32_t k = land_.first[p]; k < land_.first[p + 1]; ++k) {
      if (land_.way[k].to != (from == kSea ? LandGraph::kSea : from)) continue;
      if (back < 0 || neighbour(p, k) < neighbour(p, back)) back = k;
    }
    return back;
  }
  [[nodiscard]] std::int32_t neighbour(std::int32_t p, std::int32_t way) const {
    return graph_.neighbour[graph_.first[land_.place[p]] + way - land_.first[p]];
  }
  [[nodiscard]] SurfaceRivers rivers() const {
    SurfaceRivers out;
    out.receiver.assign(static_cast<std::size_t>(graph_.size()), kSink);
    out.distance_m.assign(out.receiver.size(), 0.0F);
    out.order.resize(order_.size());
    const auto places = static_cast<std::int32_t>(order_.size());
#pragma omp parallel for schedule(static)
    for (std::int32_t at = 0; at < places; ++at) {
      const std::int32_t p = order_[at], way = down_[at], i = land_.place[p];
      out.order[at] = i;
      out.receiver[i] = way >= 0 ? neighbour(p, way) : spot_[p].from;
      // An outlet of its own: half a place's width from the water.
      out.distance_m[i] = way >= 0 ? land_.way[way].distance_m : half_m_;
    }
    return out;
  }
  /// Land that no sea borders drains to its lowest place, landlocked water on it stands at 0.
  void seed_enclosed() {
    std::vector<std::pair<float, std::int32_t>> dry;
    for (std::int32_t p = 0; p < land_.size(); ++p) {
      if (spot_[p].level == kFar) dry.emplace_back(spot_[p].z, p);
    }
    std::sort(dry.begin(), dry.end());
    for (const auto& [level, p] : dry) {
      if (spot_[p].level != kFar) continue;
      reach(p, std::max(level, 0.0F), kSink);
      rise();
    }
  }

  const SurfaceGraph& graph_;
  LandGraph land_;
  std::vector<Spot> spot_;
  float half_m_ = static_cast<float>(0.5 * std::sqrt(graph_.area_m2));
  MonotoneQueue queue_;
  std::vector<std::int32_t> order_, down_;  ///< places as the flood comes, and their ways down
};

}  // namespace

SurfaceRivers flood_land(const SurfaceGraph& graph, std::span<const float> z) {
  return Flood(graph, z).run();
}

}  // namespace geo::detail
