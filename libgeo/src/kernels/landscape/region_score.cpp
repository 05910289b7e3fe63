#include "geo/kernels/landscape/region_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/noise/noise.hpp"

namespace geo {
namespace {

constexpr std::array<int, 4> kCardinal{kNorth, kEast, kSouth, kWest};

/// Cells of a window, reaching equally far on both sides of its centre.
struct Reach {
  int columns, rows;  ///< on either side
};

Reach reach_at(const Grid& planet, int row, double width_m, double height_m) {
  const int most = (planet.nx() - 1) / 2;
  const double columns = 0.5 * (width_m / planet.spacing_east_m(row) - 1.0);
  const double rows = 0.5 * (height_m / planet.face_east_m(row) - 1.0);
  return {static_cast<int>(std::lround(std::clamp(columns, 0.0, static_cast<double>(most)))),
          static_cast<int>(
              std::lround(std::clamp(rows, 0.0, static_cast<double>((planet.ny() - 1) / 2))))};
}

/// A window that is chosen by its shores and its local relief is looked at with the cells around
/// it.
Reach with_surroundings(const Reach& reach) {
  return {std::max(1, reach.columns), std::max(1, reach.rows)};
}

/// Sums and extremes over the rows of a window, one entry per column.
struct ColumnSums {
  std::vector<double> land, coast, boundary;
  std::vector<float> lowest, highest;
  double area = 0.0;

  explicit ColumnSums(int nx) : land(nx), coast(nx), boundary(nx), lowest(nx), highest(nx) {}
};

bool is_coast(const Grid& planet, std::span<const float> z, int i, int j) {
  if (z[planet.cell(i, j)] < 0.0F) return false;
  return std::any_of(kCardinal.begin(), kCardinal.end(),
                     [&](int k) { return z[planet.neighbour(i, j, k)] < 0.0F; });
}

void add_rows(const Grid& planet, std::span<const float> z,
              std::span<const std::int8_t> boundary_type, int first, int last, int begin, int end,
              ColumnSums& sums) {
  for (int j = first; j <= last; ++j) {
    const double area = planet.area_m2(j);
    sums.area += area;
    for (int column = begin; column < end; ++column) {
      const int i = ((column % planet.nx()) + planet.nx()) % planet.nx();
      const std::size_t at = static_cast<std::size_t>(column - begin);
      const Index cell = planet.cell(i, j);
      if (z[cell] >= 0.0F) sums.land[at] += area;
      if (is_coast(planet, z, i, j)) sums.coast[at] += area;
      if (!boundary_type.empty() && boundary_type[cell] != 0) sums.boundary[at] += area;
      sums.lowest[at] = j == first ? z[cell] : std::min(sums.lowest[at], z[cell]);
      sums.highest[at] = j == first ? z[cell] : std::max(sums.highest[at], z[cell]);
    }
  }
}

/// Figures of the window of columns first .. first + count - 1, wrapping, whose middle row is
/// given.
RegionFigures figures_of(const Grid& planet, int middle, const ColumnSums& sums, int first,
                         int count) {
  const int nx = static_cast<int>(sums.land.size());
  RegionFigures figures;
  float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
  for (int k = 0; k < count; ++k) {
    const int i = ((first + k) % nx + nx) % nx;
    figures.land_fraction += sums.land[i];
    figures.coast_fraction += sums.coast[i];
    figures.boundary_fraction += sums.boundary[i];
    lowest = std::min(lowest, sums.lowest[i]);
    highest = std::max(highest, sums.highest[i]);
  }
  const double area = sums.area * count;
  const double width_m = count * planet.spacing_east_m(middle);
  figures.coast_share =
      figures.coast_fraction / planet.face_east_m(middle) / (2.0 * (width_m + area / width_m));
  figures.land_fraction /= area;
  figures.coast_fraction /= area;
  figures.boundary_fraction /= area;
  figures.elevation_range_m = highest - lowest;
  return figures;
}

void check_sphere(const Grid& planet) {
  if (planet.topology() == Topology::sphere) return;
  throw InputError("the choice of an island needs a whole planet, this grid is a part of one");
}

/// The land of a window in pieces that hang together within it.
class Pieces {
 public:
  Pieces(const Grid& planet, std::span<const float> z, Index centre, const Reach& reach)
      : stride_(std::max({1, reach.columns / 64, reach.rows / 64})),
        across_(2 * (reach.columns / stride_) + 1),
        up_(2 * (reach.rows / stride_) + 1),
        area_m2_(static_cast<std::size_t>(across_) * up_, 0.0),
        parent_(area_m2_.size(), -1),
        is_cut_(area_m2_.size(), 0) {
    for (int v = 0; v < up_; ++v) {
      const int j = planet.row(centre) + (v - up_ / 2) * stride_;
      if (j < 0 || j >= planet.ny()) continue;
      for (int u = 0; u < across_; ++u) {
        const int column = planet.column(centre) + (u - across_ / 2) * stride_;
        const int i = ((column % planet.nx()) + planet.nx()) % planet.nx();
        if (z[planet.cell(i, j)] >= 0.0F) add(u, v, planet.area_m2(j));
      }
    }
  }

  /// Calls `take(area_m2, is_cut)` for each piece.
  template <class Take>
  void for_each(const Take& take) const {
    for (int at = 0; at < static_cast<int>(parent_.size()); ++at) {
      if (parent_[at] == at) take(area_m2_[at], is_cut_[at] != 0);
    }
  }

 private:
  void add(int u, int v, double area_m2) {
    const int at = v * across_ + u;
    parent_[at] = at;
    area_m2_[at] = area_m2;
    is_cut_[at] = u == 0 || v == 0 || u == across_ - 1 || v == up_ - 1 ? 1 : 0;
    if (u > 0) join(at, at - 1);
    for (int before = u - 1; v > 0 && before <= u + 1; ++before) {
      if (before >= 0 && before < across_) join(at, (v - 1) * across_ + before);
    }
  }
  int root(int at) {
    while (parent_[at] != at) at = parent_[at] = parent_[parent_[at]];
    return at;
  }
  void join(int at, int other) {
    if (parent_[other] < 0) return;
    const int a = root(at), b = root(other);
    if (a == b) return;
    const int first = std::min(a, b), second = std::max(a, b);
    parent_[second] = first;
    area_m2_[first] += area_m2_[second];
    is_cut_[first] |= is_cut_[second];
  }

  int stride_, across_, up_;
  std::vector<double> area_m2_;
  std::vector<int> parent_;
  std::vector<std::int8_t> is_cut_;
};

RegionLand land_of(const Pieces& pieces) {
  RegionLand land;
  double cut = 0.0;
  pieces.for_each([&](double area_m2, bool is_cut) {
    (is_cut ? cut : land.whole) += area_m2;
    if (is_cut) land.main = std::max(land.main, area_m2);
  });
  const double all = land.whole + cut;
  if (all == 0.0) return {};
  return {land.whole / all, land.main / all, (cut - land.main) / all};
}

/// A window that may be chosen.
struct Candidate {
  bool has_land;
  double score;
  Index cell;
};

bool is_better(const Candidate& a, const Candidate& b) {
  return std::tie(b.has_land, b.score, a.cell) < std::tie(a.has_land, a.score, b.cell);
}

void keep_best(std::vector<Candidate>& candidates) {
  constexpr std::size_t kMost = 64;
  const auto count = std::min(kMost, candidates.size());
  std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count),
                    candidates.end(), is_better);
  candidates.resize(count);
}

/// The best of windows, in the order of their scores, once scores are weighed by how whole their
/// land is. A weight is 1 at most.
Index wholest(std::span<const Candidate> candidates, const Grid& planet, std::span<const float> z,
              double width_m, double height_m) {
  Candidate best = candidates.front();
  best.score = -std::numeric_limits<double>::infinity();
  for (Candidate here : candidates) {
    if (here.has_land < best.has_land || here.score <= best.score) break;
    const Reach reach = reach_at(planet, planet.row(here.cell), width_m, height_m);
    const bool is_small = reach.columns < 1 || reach.rows < 1;
    if (here.score > 0.0 && !is_small) {
      here.score *= land_of(Pieces(planet, z, here.cell, reach)).weight();
    }
    if (here.score > best.score) best = here;
  }
  return best.cell;
}

/// What mix, relief and boundaries make of a window whatever its coasts.
double setting(const RegionFigures& figures) {
  const double mix = 1.0 - std::abs(figures.land_fraction - 0.4) * 2.5;
  const double range = std::min(figures.elevation_range_m / 5000.0, 1.0);
  const double boundary = 1.0 + 2.0 * std::min(figures.boundary_fraction, 0.5);
  return mix * range * boundary;
}

}  // namespace

double RegionFigures::score(double noise) const {
  return setting(*this) * coast_fraction + 0.3 * noise;
}

double RegionFigures::appeal(double noise) const {
  constexpr double kBetweenEquals = 1e-3;
  return setting(*this) * std::min(coast_share, 1.0) * (1.0 + 0.3 * noise) + kBetweenEquals * noise;
}

RegionFigures region_figures(const Grid& planet, std::span<const float> elevation_m,
                             std::span<const std::int8_t> boundary_type, Index centre,
                             double width_m, double height_m) {
  check_sizes("region_figures", planet.size(),
              {{"elevation_m", elevation_m.size()},
               {"boundary_type", boundary_type.size(), ArraySize::May::be_empty}});
  check_sphere(planet);
  const int i = planet.column(centre), j = planet.row(centre);
  const Reach reach = reach_at(planet, j, width_m, height_m);
  const int count = 2 * reach.columns + 1;
  ColumnSums sums(count);
  add_rows(planet, elevation_m, boundary_type, std::max(0, j - reach.rows),
           std::min(planet.ny() - 1, j + reach.rows), i - reach.columns, i + reach.columns + 1,
           sums);
  return figures_of(planet, j, sums, 0, count);
}

double region_noise(const Grid& planet, Index centre, double width_m, std::uint64_t seed) {
  const Noise noise(seed, "island.region");
  const auto p = planet.unit_vector(planet.column(centre), planet.row(centre));
  const double frequency = planet.figure().radius_m / width_m;
  return 0.5 + 0.5 * noise.value(static_cast<float>(p[0] * frequency),
                                 static_cast<float>(p[1] * frequency),
                                 static_cast<float>(p[2] * frequency));
}

double RegionLand::weight() const {
  constexpr double kCut = 0.4, kOthers = 3.0;
  return std::clamp(1.0 - kCut * main - kOthers * others, 0.0, 1.0);
}

RegionLand region_land(const Grid& planet, std::span<const float> elevation_m, Index centre,
                       double width_m, double height_m) {
  check_sizes("region_land", planet.size(), {{"elevation_m", elevation_m.size()}});
  check_sphere(planet);
  return land_of(
      Pieces(planet, elevation_m, centre, reach_at(planet, planet.row(centre), width_m, height_m)));
}

Index best_region(const Grid& planet, std::span<const float> elevation_m,
                  std::span<const std::int8_t> boundary_type, double width_m, double height_m,
                  std::uint64_t seed, RegionRule rule) {
  check_sizes("best_region", planet.size(),
              {{"elevation_m", elevation_m.size()},
               {"boundary_type", boundary_type.size(), ArraySize::May::be_empty}});
  check_sphere(planet);
  const int ny = planet.ny(), middle = ny / 2;
  const int tenth = static_cast<int>(std::ceil(0.1 * ny));
  const int row_reach = with_surroundings(reach_at(planet, middle, width_m, height_m)).rows;
  std::vector<int> rows;
  for (int j = tenth + row_reach; j + row_reach < ny - tenth;
       j += std::max(1, (2 * row_reach + 1) / 8)) {
    rows.push_back(j);
  }
  if (rows.empty()) rows.push_back(middle);

  std::vector<std::vector<Candidate>> of_row(rows.size());
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t at = 0; at < rows.size(); ++at) {
    errors.guard([&] {
      const int j = rows[at];
      const Reach reach = with_surroundings(reach_at(planet, j, width_m, height_m));
      ColumnSums sums(planet.nx());
      add_rows(planet, elevation_m, boundary_type, std::max(0, j - reach.rows),
               std::min(ny - 1, j + reach.rows), 0, planet.nx(), sums);
      const int count = 2 * reach.columns + 1;
      std::vector<Candidate>& candidates = of_row[at];
      for (int i = 0; i < planet.nx(); i += std::max(1, count / 8)) {
        const Index cell = planet.cell(i, j);
        const RegionFigures figures = figures_of(planet, j, sums, i - reach.columns, count);
        const bool is_small = reach.columns == 1 || reach.rows == 1;
        const double noise = region_noise(planet, cell, width_m, seed);
        candidates.push_back(
            {is_small ? elevation_m[cell] >= 0.0F : figures.land_fraction > 0.0,
             rule == RegionRule::figures ? figures.score(noise) : figures.appeal(noise), cell});
      }
      keep_best(candidates);
    });
  }
  errors.rethrow();
  std::vector<Candidate> all;
  for (const auto& candidates : of_row) all.insert(all.end(), candidates.begin(), candidates.end());
  std::sort(all.begin(), all.end(), is_better);
  return rule == RegionRule::figures ? all.front().cell
                                     : wholest(all, planet, elevation_m, width_m, height_m);
}

}  // namespace geo
