#include "surface_sea.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "geo/core/parallel_errors.hpp"
#include "kernels/numerics/radix_sort.hpp"

namespace geo::detail {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// A place of the sea and how far the coast is. Keys ascend with the way, and with the place where
/// ways are equal; ways are not negative.
using Reached = std::uint64_t;
Reached reached(float way_m, std::int32_t place) {
  return (Reached{std::bit_cast<std::uint32_t>(way_m)} << 32U) | static_cast<std::uint32_t>(place);
}
std::int32_t place_of(Reached one) { return static_cast<std::int32_t>(one & 0xFFFFFFFFU); }
float way_m_of(Reached one) { return std::bit_cast<float>(static_cast<std::uint32_t>(one >> 32U)); }

/// Asks memory for the ways from places whose turn is soon: they lie anywhere.
void fetch_ways(const SurfaceGraph& graph, std::span<const Reached> places, std::size_t turn) {
  constexpr std::size_t kAhead = 8;
  if (turn + 2 * kAhead < places.size()) {
    __builtin_prefetch(&graph.first[place_of(places[turn + 2 * kAhead])]);
  }
  if (turn + kAhead >= places.size()) return;
  const std::int32_t first = graph.first[place_of(places[turn + kAhead])];
  __builtin_prefetch(graph.neighbour.data() + first);
  __builtin_prefetch(graph.distance_m.data() + first);
}

/// Places of the sea by the shortest way from those that rivers bring something to, up to a
/// farthest one, ring by ring, each about as wide as a place, so that what a ring reaches lies in
/// it seldom (delta-stepping, Meyer & Sanders 2003).
///
/// Threads go on from the places of a ring together. Which of them finds a way first changes
/// nothing: the shortest one is what remains of all.
class WaysFromCoast {
 public:
  WaysFromCoast(const SurfaceGraph& graph, std::span<const double> load_m3,
                std::span<const float> z, float farthest_m)
      : graph_(graph), farthest_m_(farthest_m), way_m_(z.size()) {
    constexpr double kMostRings = 4096.0;
    const double places = farthest_m / std::sqrt(graph_.area_m2);
    rings_.resize(1 + static_cast<std::size_t>(std::clamp(places, 1.0, kMostRings)));
    const std::int32_t n = graph_.size();
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < n; ++i) {
      way_m_[i] = load_m3[i] > 0.0 ? 0.0F : z[i] < 0.0F ? kFar : kLand;
    }
    for (std::int32_t i = 0; i < n; ++i) {
      if (load_m3[i] > 0.0) rings_[0].push_back(reached(0.0F, i));
    }
    for (std::size_t ring = 0; ring < rings_.size(); ++ring) go_on_from(ring);
    put_in_order();
  }
  /// Places of each ring, the nearest first.
  [[nodiscard]] const std::vector<std::vector<Reached>>& rings() const { return rings_; }
  /// Of each place; infinite where none is, less than 0 on land.
  [[nodiscard]] const std::vector<float>& way_m() const { return way_m_; }

 private:
  static constexpr float kLand = -1.0F;
  static constexpr std::size_t kChunk = 512;

  void go_on_from(std::size_t ring) {
    std::size_t done = 0;
    while (done < rings_[ring].size()) {
      const std::size_t from = done, chunks = (rings_[ring].size() - from + kChunk - 1) / kChunk;
      done = rings_[ring].size();
      found_.resize(std::max(found_.size(), chunks));
      ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1) if (chunks > 1)
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        errors.guard([&] {
          const std::size_t first = from + chunk * kChunk;
          const auto part = std::span(rings_[ring]).subspan(first, std::min(kChunk, done - first));
          for (std::size_t k = 0; k < part.size(); ++k) {
            fetch_ways(graph_, part, k);
            if (!is_beaten(part[k])) reach_on(part[k], found_[chunk]);
          }
        });
      }
      errors.rethrow();
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        for (const Reached one : found_[chunk]) rings_[ring_of(one)].push_back(one);
        found_[chunk].clear();
      }
    }
  }
  [[nodiscard]] std::size_t ring_of(Reached one) const {
    const float rings_per_m = static_cast<float>(rings_.size() - 1) / farthest_m_;
    return static_cast<std::size_t>(way_m_of(one) * rings_per_m);
  }
  /// By a shorter way to the same place.
  [[nodiscard]] bool is_beaten(Reached one) {
    return way_m_of(one) > way_to(place_of(one)).load(kRelaxed);
  }
  void reach_on(Reached from, std::vector<Reached>& found) {
    const std::int32_t i = place_of(from);
    for (std::int32_t k = graph_.first[i]; k < graph_.first[i + 1]; ++k) {
      const std::int32_t j = graph_.neighbour[k];
      const float next_m = way_m_of(from) + graph_.distance_m[k];
      if (next_m <= farthest_m_ && shorten(j, next_m)) found.push_back(reached(next_m, j));
    }
  }
  /// Whether no way as short was known.
  bool shorten(std::int32_t place, float way_m) {
    const auto known = way_to(place);
    float before_m = known.load(kRelaxed);
    while (way_m < before_m) {
      if (known.compare_exchange_weak(before_m, way_m, kRelaxed)) return true;
    }
    return false;
  }
  [[nodiscard]] std::atomic_ref<float> way_to(std::int32_t place) {
    return std::atomic_ref<float>(way_m_[place]);
  }
  void put_in_order() {
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t ring = 0; ring < rings_.size(); ++ring) {
      errors.guard([&] {
        std::erase_if(rings_[ring], [&](Reached one) { return is_beaten(one); });
        sort_keys(rings_[ring]);
      });
    }
    errors.rethrow();
  }

  static constexpr auto kRelaxed = std::memory_order_relaxed;

  const SurfaceGraph& graph_;
  float farthest_m_;
  std::vector<float> way_m_;
  std::vector<std::vector<Reached>> rings_, found_;  ///< found: by each chunk of places
};

/// Lays what rivers bring, from the coast outwards. Ranks of places are those of their ways.
class SeaFloor {
 public:
  SeaFloor(const SurfaceGraph& graph, const RiverLaw& law, std::span<float> z,
           std::span<float> rock_m)
      : graph_(graph), law_(law), z_(z), rock_m_(rock_m) {}

  double settle(const SeaLoad& load) {
    rest_m3_ = load.rest_m3;
    spread(load.at_place_m3);
    settle_evenly();
    return laid_m3_;
  }

 private:
  static constexpr float kLengths = 6.0F;  // farther off, what is left is everywhere

  /// A place that lies farther from the coast, and by how much.
  struct Farther {
    std::int32_t rank;
    float slope;
  };
  /// What a ring asks of its places.
  struct Ring {
    std::vector<double> room_m3;
    std::vector<std::int32_t> first, end;  ///< of each in farther
    std::vector<Farther> farther;
  };

  void spread(std::span<const double> at_place_m3) {
    const WaysFromCoast ways(graph_, at_place_m3, z_,
                             kLengths * static_cast<float>(1e3 * law_.settling_km));
    rank_.resize(z_.size());
    std::size_t places = 0;
    for (const auto& ring : ways.rings()) places += ring.size();
    load_m3_.resize(places);
    std::int32_t first = 0;
    for (const auto& ring : ways.rings()) {
      const auto count = static_cast<std::int32_t>(ring.size());
#pragma omp parallel for schedule(static)
      for (std::int32_t k = 0; k < count; ++k) {
        rank_[place_of(ring[k])] = first + k;
        load_m3_[first + k] = at_place_m3[place_of(ring[k])];
      }
      first += count;
    }
    first = 0;
    for (const auto& ring : ways.rings()) {
      look_farther(ring, ways.way_m());
      pass_over(first, static_cast<std::int32_t>(ring.size()));
      add(ring, first);
      first += static_cast<std::int32_t>(ring.size());
    }
  }
  void look_farther(const std::vector<Reached>& ring, const std::vector<float>& way_m) {
    const auto count = static_cast<std::int32_t>(ring.size());
    ring_.room_m3.resize(count);
    ring_.first.resize(count + 1);
    ring_.end.resize(count);
    for (std::int32_t k = 0; k < count; ++k) {
      const std::int32_t i = place_of(ring[k]);
      ring_.first[k + 1] = ring_.first[k] + graph_.first[i + 1] - graph_.first[i];
    }
    ring_.farther.resize(ring_.first[count]);
#pragma omp parallel for schedule(static)
    for (std::int32_t k = 0; k < count; ++k) {
      fetch_ways(graph_, ring, k);
      const std::int32_t i = place_of(ring[k]);
      ring_.room_m3[k] = std::max(0.0, -law_.shelf_m - z_[i]) / law_.load * graph_.area_m2;
      std::int32_t end = ring_.first[k];
      for (std::int32_t way = graph_.first[i]; way < graph_.first[i + 1]; ++way) {
        const std::int32_t j = graph_.neighbour[way];
        if (!(way_m[j] > way_m[i]) || way_m[j] == kFar) continue;
        ring_.farther[end++] = {rank_[j], (way_m[j] - way_m[i]) / graph_.distance_m[way]};
      }
      ring_.end[k] = end;
    }
  }
  /// Of the places of a ring each lays a share of its load, as far as there is room, and passes the
  /// rest on. What it has laid stands where its load was.
  void pass_over(std::int32_t first, std::int32_t count) {
    const double share = -std::expm1(-std::sqrt(graph_.area_m2) / (1e3 * law_.settling_km));
    for (std::int32_t k = 0; k < count; ++k) {
      double& load_m3 = load_m3_[first + k];
      if (load_m3 <= 0.0) {
        load_m3 = 0.0;
        continue;
      }
      const double laid_m3 = std::min(share * load_m3, ring_.room_m3[k]);
      pass_on(k, load_m3 - laid_m3);
      load_m3 = laid_m3;
      laid_m3_ += laid_m3;
    }
  }
  /// To all neighbours that lie farther from the coast, by how much farther.
  void pass_on(std::int32_t k, double m3) {
    const auto farther =
        std::span(ring_.farther).subspan(ring_.first[k], ring_.end[k] - ring_.first[k]);
    if (farther.empty()) rest_m3_ += m3;
    double sum = 0.0;
    for (const Farther& one : farther) sum += one.slope;
    for (const Farther& one : farther) load_m3_[one.rank] += m3 * one.slope / sum;
  }
  void add(const std::vector<Reached>& ring, std::int32_t first) {
    const auto count = static_cast<std::int32_t>(ring.size());
#pragma omp parallel for schedule(static)
    for (std::int32_t k = 0; k < count; ++k) add(place_of(ring[k]), load_m3_[first + k]);
  }
  void add(std::int32_t i, double m3) {
    const double thick_m = m3 / graph_.area_m2;
    z_[i] += static_cast<float>(law_.load * thick_m);
    rock_m_[i] += static_cast<float>(thick_m);
  }
  void settle_evenly() {
    if (rest_m3_ == 0.0) return;
    const auto is_deep = [&](std::int32_t i) {
      return graph_.is_there[i] != 0 && z_[i] < -law_.shelf_m;
    };
    const std::int32_t n = graph_.size();
    std::int32_t places = 0;
#pragma omp parallel for schedule(static) reduction(+ : places)
    for (std::int32_t i = 0; i < n; ++i) places += is_deep(i) ? 1 : 0;
    const double each_m3 = rest_m3_ / std::max(1, places);
    laid_m3_ += each_m3 * places;
#pragma omp parallel for schedule(static)
    for (std::int32_t i = 0; i < n; ++i) {
      if (is_deep(i)) add(i, each_m3);
    }
  }

  const SurfaceGraph& graph_;
  const RiverLaw& law_;
  std::span<float> z_, rock_m_;
  std::vector<std::int32_t> rank_;  ///< of each place
  std::vector<double> load_m3_;     ///< by rank
  Ring ring_;
  double rest_m3_ = 0.0, laid_m3_ = 0.0;
};

}  // namespace

double settle_in_sea(const SurfaceGraph& graph, const RiverLaw& law, const SeaLoad& load,
                     std::span<float> z, std::span<float> rock_m) {
  return SeaFloor(graph, law, z, rock_m).settle(load);
}

}  // namespace geo::detail
