#include "geo/kernels/numerics/nearest_source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geo/core/error.hpp"

namespace geo {
namespace {

using Vector = std::array<float, 3>;

class Propagation {
 public:
  Propagation(const Grid& grid, std::span<const Vector> position, std::span<const float> handicap,
              std::span<std::int32_t> nearest)
      : grid_(grid),
        radius_m_(static_cast<float>(grid.figure().radius_m)),
        position_(position),
        handicap_(handicap),
        nearest_(nearest),
        cost_(nearest.size(), std::numeric_limits<float>::max()) {
    for (int j = 0; j < grid.ny(); ++j) {
      for (int i = 0; i < grid.nx(); ++i) {
        const Index cell = grid.cell(i, j);
        const std::int32_t source = nearest[cell];
        nearest[cell] = -1;
        if (source >= 0) offer(cell, here(i, j), source);
      }
    }
  }

  void sweep(bool northwards) {
    const int nx = grid_.nx(), ny = grid_.ny();
    std::vector<Vector> row(nx);
    for (int step = 0; step < ny; ++step) {
      const int j = northwards ? step : ny - 1 - step;
      for (int i = 0; i < nx; ++i) row[i] = here(i, j);
      const int behind = northwards ? j - 1 : j + 1;
      const bool over_pole = behind < 0 || behind >= ny;
      const Index from = grid_.cell(0, over_pole ? j : behind);
      const int shift = over_pole ? nx / 2 : 0;
      const Index first = grid_.cell(0, j);
      int west = shift == 0 ? nx - 1 : shift - 1, middle = shift;
      for (int i = 0; i < nx; ++i) {
        const int east = middle + 1 < nx ? middle + 1 : 0;
        for (const int k : {west, middle, east}) offer(first + i, row[i], nearest_[from + k]);
        west = middle;
        middle = east;
      }
      // Twice round, so that what comes in at the seam also passes on.
      for (int round = 0; round < 2; ++round) {
        offer(first, row[0], nearest_[first + nx - 1]);
        for (int i = 1; i < nx; ++i) offer(first + i, row[i], nearest_[first + i - 1]);
      }
      for (int round = 0; round < 2; ++round) {
        offer(first + nx - 1, row[nx - 1], nearest_[first]);
        for (int i = nx - 2; i >= 0; --i) offer(first + i, row[i], nearest_[first + i + 1]);
      }
    }
  }

 private:
  [[nodiscard]] Vector here(int i, int j) const {
    const auto p = grid_.unit_vector(i, j);
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  }
  void offer(Index cell, const Vector& at, std::int32_t source) {
    if (source < 0 || source == nearest_[cell]) return;
    const Vector& p = position_[source];
    const float x = p[0] - at[0], y = p[1] - at[1], z = p[2] - at[2];
    const float chord2 = x * x + y * y + z * z;
    // Chords alone decide between equal handicaps; the arc matters beside unequal ones.
    const float arc = std::sqrt(chord2) * (1.0F + chord2 * (1.0F / 24.0F + chord2 * 3.0F / 640.0F));
    const float cost = radius_m_ * arc + handicap_[source];
    if (cost >= cost_[cell]) return;
    cost_[cell] = cost;
    nearest_[cell] = source;
  }

  const Grid& grid_;
  float radius_m_;
  std::span<const Vector> position_;
  std::span<const float> handicap_;
  std::span<std::int32_t> nearest_;
  std::vector<float> cost_;
};

}  // namespace

double distance_m(const std::array<float, 3>& a, const std::array<float, 3>& b, double radius_m) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return 2.0 * radius_m * std::asin(std::min(1.0, 0.5 * std::sqrt(x * x + y * y + z * z)));
}

void nearest_sources(const Grid& grid, std::span<const std::array<float, 3>> unit_position,
                     std::span<const float> handicap_m, std::span<std::int32_t> nearest) {
  if (grid.topology() != Topology::sphere) {
    throw InputError("nearest sources: the grid must be a whole sphere");
  }
  if (nearest.size() != static_cast<std::size_t>(grid.size()) ||
      handicap_m.size() != unit_position.size()) {
    throw InputError("nearest sources: one entry per cell and one handicap per point are needed");
  }
  Propagation propagation(grid, unit_position, handicap_m, nearest);
  for (int turn = 0; turn < 2; ++turn) {
    propagation.sweep(true);
    propagation.sweep(false);
  }
}

}  // namespace geo
