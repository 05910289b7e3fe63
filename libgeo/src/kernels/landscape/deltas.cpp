#include "geo/kernels/landscape/deltas.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "geo/core/array_sizes.hpp"

namespace geo {
namespace {

/// Land that rivers lay before their mouths, one mouth after the other.
class Deltas {
 public:
  Deltas(const Grid& grid, const DeltaLaw& law, std::span<const std::uint8_t> sea,
         std::span<const float> elevation_m, std::span<double> volume_m3, std::span<float> laid_m)
      : grid_(grid),
        law_(law),
        sea_(sea),
        z_(elevation_m),
        volume_m3_(volume_m3),
        laid_m_(laid_m) {}

  /// Those that bring enough to fill their own cell, the largest first.
  [[nodiscard]] std::vector<Index> mouths() const {
    std::vector<Index> mouths;
    for (Index c = 0; c < grid_.size(); ++c) {
      if (!(volume_m3_[c] > 0.0) || !may_fill(c)) continue;
      const double room_m3 =
          static_cast<double>(rise_m(c, law_.front_m)) * grid_.area_m2(grid_.row(c));
      if (volume_m3_[c] >= room_m3) mouths.push_back(c);
    }
    std::stable_sort(mouths.begin(), mouths.end(),
                     [&](Index a, Index b) { return volume_m3_[a] > volume_m3_[b]; });
    return mouths;
  }
  void build(Index mouth) {
    if (laid_m_[mouth] > 0.0F) return;
    constexpr int kFillings = 3;
    const double highest_m = height_beside(mouth);
    Delta delta{mouth, highest_m, 0.0};
    for (int filling = 0; filling < kFillings; ++filling) delta.length_m = fill(delta);
    fill(delta);
    for (const auto& [cell, rise_m] : filled_) {
      volume_m3_[mouth] -= static_cast<double>(rise_m) * grid_.area_m2(grid_.row(cell));
      laid_m_[cell] = rise_m;
    }
  }

 private:
  struct Delta {
    Index mouth;
    double highest_m;  ///< of its plain
    double length_m;   ///< from the mouth to the shore
  };
  /// A cell to be filled, in the order of `cost`.
  struct Next {
    double cost, way_m;
    Index cell;
    bool operator>(const Next& other) const {
      return std::tie(cost, cell) > std::tie(other.cost, other.cell);
    }
  };
  struct Filled {
    Index cell;
    float rise_m;
  };

  /// Fills cell after cell, the nearest over shallow water first, as long as there is enough.
  /// Returns the longest way from the mouth.
  double fill(const Delta& delta) {
    filled_.clear();
    heap_.assign(1, {0.0, 0.0, delta.mouth});
    cost_ = {{delta.mouth, 0.0}};
    double left_m3 = volume_m3_[delta.mouth], longest_m = 0.0;
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const Next next = heap_.back();
      heap_.pop_back();
      if (next.cost > cost_.at(next.cell)) continue;
      const float rise = rise_m(next.cell, plain_m(delta, next.way_m));
      const double room_m3 = static_cast<double>(rise) * grid_.area_m2(grid_.row(next.cell));
      if (!may_fill(next.cell) || left_m3 < room_m3) break;
      left_m3 -= room_m3;
      filled_.push_back({next.cell, rise});
      longest_m = std::max(longest_m, next.way_m);
      reach_beyond(next);
    }
    return longest_m;
  }
  [[nodiscard]] double plain_m(const Delta& delta, double way_m) const {
    const double up_m = law_.slope * std::max(0.0, delta.length_m - way_m);
    return law_.front_m + std::clamp(delta.highest_m - law_.front_m, 0.0, up_m);
  }
  [[nodiscard]] double height_beside(Index mouth) const {
    double lowest_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kDirections; ++k) {
      const Index beside = grid_.neighbour(mouth, k);
      if (beside != kNoCell && sea_[beside] == 0) {
        lowest_m = std::min(lowest_m, static_cast<double>(z_[beside]));
      }
    }
    return std::isfinite(lowest_m) ? lowest_m : law_.front_m;
  }
  [[nodiscard]] float rise_m(Index c, double plain_m) const {
    return static_cast<float>(plain_m) - z_[c];
  }
  [[nodiscard]] bool may_fill(Index c) const {
    return sea_[c] != 0 && laid_m_[c] == 0.0F && z_[c] >= -law_.deepest_m;
  }
  void reach_beyond(const Next& from) {
    constexpr double kGentle_m = 10.0;
    const int i = grid_.column(from.cell), j = grid_.row(from.cell);
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid_.neighbour(i, j, k);
      if (to == kNoCell || sea_[to] == 0 || laid_m_[to] > 0.0F) continue;
      const double depth = std::max(0.0, -static_cast<double>(z_[to]));
      const double step_m = grid_.distances_m(j)[k];
      const double there = from.cost + step_m * (1.0 + depth / kGentle_m);
      const auto at = cost_.find(to);
      if (at != cost_.end() && at->second <= there) continue;
      cost_[to] = there;
      heap_.push_back({there, from.way_m + step_m, to});
      std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
  }

  const Grid& grid_;
  const DeltaLaw& law_;
  std::span<const std::uint8_t> sea_;
  std::span<const float> z_;
  std::span<double> volume_m3_;
  std::span<float> laid_m_;
  std::vector<Next> heap_;
  std::vector<Filled> filled_;
  std::map<Index, double> cost_;
};

}  // namespace

void build_deltas(const Grid& grid, const DeltaLaw& law, std::span<const std::uint8_t> sea,
                  std::span<const float> elevation_m, std::span<double> volume_m3,
                  std::span<float> laid_m) {
  check_sizes("build_deltas", grid.size(),
              {{"sea", sea.size()},
               {"elevation_m", elevation_m.size()},
               {"volume_m3", volume_m3.size()},
               {"laid_m", laid_m.size()}});
  Deltas deltas(grid, law, sea, elevation_m, volume_m3, laid_m);
  for (const Index mouth : deltas.mouths()) deltas.build(mouth);
}

}  // namespace geo
