#include "geo/kernels/landscape/straits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/noise/noise.hpp"
#include "geo/kernels/water/sea_parts.hpp"

namespace geo {
namespace {

class Search {
 public:
  Search(const Grid& grid, const StraitLaw& law, std::span<float> z)
      : grid_(grid), law_(law), z_(z) {
    NumberedSeas seas = number_seas(grid, z);
    parts_ = std::move(seas.parts);
    part_of_ = std::move(seas.part_of_cell);
    joined_.assign(parts_.size(), 0);
  }

  int run() {
    if (parts_.empty()) return 0;
    joined_.front() = 1;
    int ways = 0;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      if (parts_[part].area_m2 < law_.least_m2) break;
      if (joined_[part] == 0 && join(static_cast<std::int32_t>(part))) ++ways;
    }
    return ways;
  }

 private:
  struct Seen {
    double cost, land_m;
    Index from;
  };
  struct Entry {
    double cost;
    Index cell;
    bool operator>(const Entry& other) const {
      return cost != other.cost ? cost > other.cost : cell > other.cell;
    }
  };
  // A way over the sea itself costs next to nothing.
  static constexpr double kHeight_m = 20.0, kAtSea = 1e-3;

  /// Of rock, by place: over plains a way that costs least by its height alone is a ruler's.
  [[nodiscard]] double resistance(Index cell) const {
    constexpr double kBends = 16.0, kContrast = 3.0;  // 400 km on the Earth
    constexpr int kOctaves = 4;
    const auto place = grid_.unit_vector(grid_.column(cell), grid_.row(cell));
    return std::exp(kContrast * rock_.fbm(place, kBends, kOctaves));
  }
  bool join(std::int32_t part) {
    seen_.clear();
    heap_.clear();
    add_part(part);
    const double sill_m = std::max(law_.sill_m, -law_.drawdown * parts_[part].deepest_m);
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const Entry entry = heap_.back();
      heap_.pop_back();
      const Seen here = seen_.at(entry.cell);
      if (entry.cost > here.cost) continue;
      const std::int32_t sea = part_of_[entry.cell];
      if (sea >= 0 && joined_[sea] != 0) {
        cut(entry.cell);
        return true;
      }
      const int i = grid_.column(entry.cell), j = grid_.row(entry.cell);
      for (int k = 0; k < kDirections; ++k) {
        const Index to = grid_.neighbour(i, j, k);
        if (to == kNoCell || z_[to] > sill_m) continue;
        const double step = grid_.distances_m(j)[k];
        const bool land = !(z_[to] < 0.0F);
        const double land_m = here.land_m + (land ? step : 0.0);
        if (land_m > law_.land_m) continue;
        const double cost =
            here.cost + step * (land ? (kHeight_m + z_[to]) * resistance(to) : kAtSea);
        const auto at = seen_.find(to);
        if (at != seen_.end() && at->second.cost <= cost) continue;
        seen_[to] = {cost, land_m, entry.cell};
        push({cost, to});
      }
    }
    return false;
  }
  /// All of it is where the way may begin.
  void add_part(std::int32_t part) {
    std::vector<Index> front{parts_[part].first};
    seen_[front[0]] = {0.0, 0.0, kNoCell};
    while (!front.empty()) {
      const Index cell = front.back();
      front.pop_back();
      bool shore = false;
      for (int k = 0; k < kDirections; ++k) {
        const Index to = grid_.neighbour(cell, k);
        if (to == kNoCell) continue;
        if (part_of_[to] != part) {
          shore = true;
        } else if (seen_.emplace(to, Seen{0.0, 0.0, kNoCell}).second) {
          front.push_back(to);
        }
      }
      if (shore) push({0.0, cell});
    }
  }
  void push(const Entry& entry) {
    heap_.push_back(entry);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  void cut(Index end) {
    std::vector<Index> way;
    for (Index at = end; at != kNoCell; at = seen_.at(at).from) {
      if (part_of_[at] >= 0) {
        joined_[part_of_[at]] = 1;
      } else {
        way.push_back(at);
      }
    }
    // Distances from the way, over neighbours.
    std::unordered_map<Index, double> beside;
    heap_.clear();
    for (const Index cell : way) {
      beside[cell] = 0.0;
      push({0.0, cell});
    }
    const double half_m = 0.5 * law_.width_m;
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const Entry entry = heap_.back();
      heap_.pop_back();
      if (entry.cost > beside.at(entry.cell)) continue;
      const double c = std::cos(0.5 * std::numbers::pi * entry.cost / half_m);
      z_[entry.cell] = std::min(z_[entry.cell], static_cast<float>(-law_.depth_m * c * c));
      const int i = grid_.column(entry.cell), j = grid_.row(entry.cell);
      for (int k = 0; k < kDirections; ++k) {
        const Index to = grid_.neighbour(i, j, k);
        if (to == kNoCell) continue;
        const double away = entry.cost + grid_.distances_m(j)[k];
        if (away >= half_m) continue;
        const auto at = beside.find(to);
        if (at != beside.end() && at->second <= away) continue;
        beside[to] = away;
        push({away, to});
      }
    }
  }

  const Grid& grid_;
  const StraitLaw& law_;
  std::span<float> z_;
  const Noise rock_{0, "straits.rock"};
  std::vector<std::int32_t> part_of_;  ///< -1 on land
  std::vector<SeaPart> parts_;         ///< the largest first
  std::vector<std::uint8_t> joined_;
  std::unordered_map<Index, Seen> seen_;
  std::vector<Entry> heap_;
};

}  // namespace

int open_straits(const Grid& grid, const StraitLaw& law, std::span<float> elevation_m) {
  check_sizes("open_straits", grid.size(), {{"elevation_m", elevation_m.size()}});
  return Search(grid, law, elevation_m).run();
}

}  // namespace geo
