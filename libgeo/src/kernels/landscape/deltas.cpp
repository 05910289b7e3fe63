#include "geo/kernels/landscape/deltas.hpp"

#include <algorithm>
#include <functional>
#include <map>

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
      if (volume_m3_[c] > 0.0 && may_fill(c) && volume_m3_[c] >= room_m3(c)) mouths.push_back(c);
    }
    std::stable_sort(mouths.begin(), mouths.end(),
                     [&](Index a, Index b) { return volume_m3_[a] > volume_m3_[b]; });
    return mouths;
  }
  /// Fills cell after cell, the nearest over shallow water first, as long as there is enough.
  void build(Index mouth) {
    if (laid_m_[mouth] > 0.0F) return;
    heap_.assign(1, {0.0, mouth});
    cost_ = {{mouth, 0.0}};
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const auto [way, cell] = heap_.back();
      heap_.pop_back();
      if (way > cost_.at(cell)) continue;
      if (laid_m_[cell] > 0.0F) continue;  // another river's, or reached before
      if (!may_fill(cell) || volume_m3_[mouth] < room_m3(cell)) return;
      volume_m3_[mouth] -= room_m3(cell);
      laid_m_[cell] = rise_m(cell);
      reach_beyond(cell, way);
    }
  }

 private:
  [[nodiscard]] float rise_m(Index c) const { return static_cast<float>(law_.top_m) - z_[c]; }
  [[nodiscard]] double room_m3(Index c) const {
    return static_cast<double>(rise_m(c)) * grid_.area_m2(grid_.row(c));
  }
  [[nodiscard]] bool may_fill(Index c) const {
    return sea_[c] != 0 && laid_m_[c] == 0.0F && z_[c] >= -law_.deepest_m;
  }
  void reach_beyond(Index cell, double way) {
    constexpr double kGentle_m = 10.0;
    const int i = grid_.column(cell), j = grid_.row(cell);
    for (int k = 0; k < kDirections; ++k) {
      const Index to = grid_.neighbour(i, j, k);
      if (to == kNoCell || sea_[to] == 0 || laid_m_[to] > 0.0F) continue;
      const double depth = std::max(0.0, -static_cast<double>(z_[to]));
      const double there = way + grid_.distances_m(j)[k] * (1.0 + depth / kGentle_m);
      const auto at = cost_.find(to);
      if (at != cost_.end() && at->second <= there) continue;
      cost_[to] = there;
      heap_.emplace_back(there, to);
      std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
  }

  const Grid& grid_;
  const DeltaLaw& law_;
  std::span<const std::uint8_t> sea_;
  std::span<const float> z_;
  std::span<double> volume_m3_;
  std::span<float> laid_m_;
  std::vector<std::pair<double, Index>> heap_;
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
