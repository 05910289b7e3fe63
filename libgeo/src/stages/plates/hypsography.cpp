#include "hypsography.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/kernels/crust/crust_columns.hpp"
#include "geo/kernels/crust/ocean_depth.hpp"
#include "geo/kernels/noise/great_circles.hpp"
#include "geo/kernels/noise/noise_row.hpp"
#include "geo/kernels/numerics/quantile_mapping.hpp"
#include "geo/kernels/numerics/quantiles.hpp"
#include "geo/kernels/numerics/smoothing.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// Octaves and their fall of the noise that orders places instead of circles.
constexpr int kOctaves = 11;
constexpr double kGain = 0.55;
/// A continent that has not been folded for as long as this counts as old.
constexpr float kContinent_myr = 1000.0F;

const Hypsography& target_of(const Context& context) {
  if (context.hypsography.fraction.empty()) {
    throw ConfigurationError("plates: heights by rank need fields.hypsography");
  }
  return context.hypsography;
}

template <class T>
void zero(std::span<T> field) {
  std::fill(field.begin(), field.end(), T{});
}

/// Steps so steep and so few that places between them would tie.
bool leaves_ties(const CircleCuts& cuts) {
  constexpr double kCrossings = 12.0, kReach = 8.7;  // of the circles that a place should feel
  return static_cast<double>(cuts.circles) * kReach / cuts.steepness < kCrossings;
}

/// Noise of unit deviation, more or less, in every cell.
void add_fbm(const Grid& grid, const Noise& noise, double frequency, double factor,
             std::span<float> values) {
  ParallelErrors errors;
#pragma omp parallel
  {
    NoiseRow row(grid);
    auto line = errors.make<std::vector<float>>(grid.nx());
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < grid.ny(); ++j) {
      errors.guard([&] {
        row.choose_all(j);
        row.fbm(noise, frequency, kOctaves, kGain, line);
        for (int i = 0; i < grid.nx(); ++i) {
          values[grid.cell(i, j)] += static_cast<float>(factor * line[i]);
        }
      });
    }
  }
  errors.rethrow();
}

class Order {
 public:
  Order(const PlatesParameters& parameters, const Grid& grid, std::uint64_t seed)
      : p_(parameters.ranking),
        circles_(p_.cuts, seed, "plates.circles"),
        noise_(seed, "plates.ranking"),
        frequency_(1e-3 * grid.figure().radius_m / parameters.start.continent_km) {}

  /// Of the cells of a grid.
  void draw(const Grid& grid, std::span<float> rank) const {
    if (p_.by == "fbm") return add_fbm(grid, noise_, frequency_, kNormal, rank);
    great_circle_noise(grid, circles_, rank);
    if (leaves_ties(p_.cuts)) add_fbm(grid, noise_, frequency_, kTie, rank);
  }
  /// Of places.
  [[nodiscard]] std::vector<float> at(std::span<const Vector3> places) const {
    if (p_.by == "fbm") return fbm_at(noise_, places, frequency_, kOctaves, kGain);
    std::vector<float> rank = great_circle_noise_at(circles_, places);
    if (!leaves_ties(p_.cuts)) return rank;
    const auto fine = fbm_at(noise_, places, frequency_, kOctaves, kGain);
    for (std::size_t k = 0; k < rank.size(); ++k) {
      rank[k] += static_cast<float>(kTie * fine[k]);
    }
    return rank;
  }

 private:
  static constexpr double kNormal = 6.2;  // fBm to unit deviation
  static constexpr double kTie = 0.02;    // less than a step of thousands of circles
  const HypsographicRanking& p_;
  GreatCircles circles_;
  Noise noise_;
  double frequency_;
};

/// A field that somebody gave: smoothed, and as rough as is wanted.
void take_given(const HypsographicRanking& p, const Grid& grid, std::span<const float> given,
                std::span<float> rank) {
  // Noise is there; what was given comes on top of it, in its own deviations.
  std::vector<float> field(given.begin(), given.end());
  if (p.smoothing_km > 0.0) smooth(grid, field, 1e3 * p.smoothing_km);
  const double mean = area_mean(grid, field);
  std::vector<float> square(field.size());
  for (std::size_t k = 0; k < field.size(); ++k) {
    square[k] = static_cast<float>((field[k] - mean) * (field[k] - mean));
  }
  const double deviation = std::sqrt(area_mean(grid, square));
  if (!(deviation > 0.0)) {
    throw InputError("plates: fields.ranking is the same everywhere: must differ between places");
  }
  for (std::size_t k = 0; k < field.size(); ++k) {
    rank[k] = static_cast<float>((field[k] - mean) / deviation + p.roughness * rank[k]);
  }
}

/// The order of the cells of a grid, in `rank`, which holds zeros.
void order_cells(const PlatesParameters& parameters, const StageIo& io, const Context& context,
                 std::span<float> rank) {
  const Grid& grid = io.grid();
  const auto given = io.read_optional(field::ranking);
  if (given.empty() || parameters.ranking.roughness > 0.0) {
    Order(parameters, grid, context.seed).draw(grid, rank);
  }
  if (!given.empty()) take_given(parameters.ranking, grid, given, rank);
}

/// The height below which a share of the area lies.
double height_at(const Hypsography& target, double share) {
  const auto above =
      std::upper_bound(target.fraction.begin() + 1, target.fraction.end() - 1, share);
  const auto k = above - target.fraction.begin();
  return std::lerp(
      target.elevation_m[k - 1], target.elevation_m[k],
      (share - target.fraction[k - 1]) / (target.fraction[k] - target.fraction[k - 1]));
}

/// Gives cells heights by their order. Ranks are those of the middles of cells: the lowest and the
/// highest are moved to the curve's ends.
void match(const Grid& grid, const Hypsography& target, std::span<float> rank) {
  const auto [least, most] = std::minmax_element(rank.begin(), rank.end());
  const auto whole_share = [&](auto at) {
    return grid.area_m2(grid.row(static_cast<Index>(at - rank.begin()))) / grid.total_area_m2();
  };
  constexpr double kMore = 0.6, kYetMore = 0.7;  // than half of a cell
  const double first = whole_share(least), last = whole_share(most);
  std::vector<double> fraction, value;
  const auto add = [&](double share, double height_m) {
    fraction.push_back(share);
    value.push_back(height_m);
  };
  const double low = kYetMore * first, high = 1.0 - kYetMore * last;
  add(0.0, target.elevation_m.front());
  add(kMore * first, target.elevation_m.front());
  add(low, height_at(target, low));
  for (std::size_t k = 0; k < target.fraction.size(); ++k) {
    if (target.fraction[k] > low && target.fraction[k] < high) {
      add(target.fraction[k], target.elevation_m[k]);
    }
  }
  add(high, height_at(target, high));
  add(1.0 - kMore * last, target.elevation_m.back());
  add(1.0, target.elevation_m.back());
  map_quantiles(grid, {fraction, value}, rank);
}

/// The field of the grid at a place, from the cell that holds it.
float seen_at(const Grid& grid, std::span<const float> values, const Vector3& place) {
  const Vector3 at = grid.to_axis(place);
  const double x = (std::atan2(at[1], at[0]) / (2.0 * kPi) + 0.5) * grid.nx();
  const double y = (std::asin(std::clamp(at[2], -1.0, 1.0)) / kPi + 0.5) * grid.ny();
  return values[grid.cell(std::clamp(static_cast<int>(x), 0, grid.nx() - 1),
                          std::clamp(static_cast<int>(y), 0, grid.ny() - 1))];
}

}  // namespace

std::vector<Parameter> hypsography_parameters(PlatesParameters& p) {
  return {
      renamed(choice("plates.sphere.initial_elevation", p.initial_elevation,
                     {"noise", "hypsography", "given"},
                     "initial elevation: continents from noise, crust as the model hypsography "
                     "makes it, or that of fields.initial_elevation",
                     "davidson2013"),
              "plates.first_relief"),
      choice("plates.hypsography.ranking", p.ranking.by, {"great-circles", "fbm"},
             "the noise that orders places by height, unless fields.ranking does", "davidson2013"),
      integer("plates.hypsography.circles", p.ranking.cuts.circles, "1", 1, 100'000,
              "great circles along which the ground rises", "davidson2013"),
      real("plates.hypsography.circle_steepness", p.ranking.cuts.steepness, "1", 0.1, 1e5,
           "how steeply it rises, per radian", "davidson2013"),
      real("plates.hypsography.circle_offset", p.ranking.cuts.offset, "1", 0.0, 1.0,
           "most that circles lie off the planet's centre, in radii; with 0 all "
           "land has the deepest sea at its antipodes",
           "davidson2013"),
      real("plates.hypsography.ranking_smoothing_km", p.ranking.smoothing_km, "km", 0.0, 5000.0,
           "length over which a given ranking is smoothed", "design"),
      real("plates.hypsography.ranking_roughness", p.ranking.roughness, "1", 0.0, 10.0,
           "noise on a given ranking, in its deviations; settles ties", "design"),
  };
}

void draw_hypsography(const PlatesParameters& parameters, StageIo& io, Context& context) {
  const Grid& grid = io.grid();
  if (grid.topology() != Topology::sphere) {
    throw InputError("plates: the grid must be a whole sphere");
  }
  context.advance(0.0);
  const Hypsography& target = target_of(context);
  const auto elevation = io.write(field::crust_elevation);
  zero(elevation);
  order_cells(parameters, io, context, elevation);
  context.advance(0.6);
  match(grid, target, elevation);
  context.advance(0.9);

  const auto thickness = io.write(field::crust_thickness);
  const auto density = io.write(field::crust_density);
  const auto fraction = io.write(field::continental_fraction);
  const auto age = io.write(field::crust_age);
  const auto orogeny_age = io.write(field::orogeny_age);
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const CrustColumn column = crust_column(elevation[cell]);
    const double share = continental_share_of(column);
    thickness[cell] = static_cast<float>(column.thickness_m);
    density[cell] = static_cast<float>(column.density_kg_m3);
    fraction[cell] = static_cast<float>(share);
    const bool is_continent = share >= 0.5;
    age[cell] = is_continent ? kContinent_myr
                             : static_cast<float>(ocean_age_of_depth_myr(
                                   -elevation[cell], parameters.oldest_floor_myr));
    orogeny_age[cell] = is_continent ? kContinent_myr : 0.0F;
  }
  // One plate at rest: no boundary, no orogeny, no heat but the mantle's own, no direction.
  zero(io.write(field::plate_id));
  zero(io.write(field::boundary_type));
  zero(io.write(field::orogeny_type));
  for (const auto* still :
       {&field::plate_velocity_east, &field::plate_velocity_north, &field::boundary_strength,
        &field::heat_anomaly, &field::fold_direction_east, &field::fold_direction_north,
        &field::ridge_direction_east, &field::ridge_direction_north}) {
    zero(io.write(*still));
  }
  context.budget["plates"] = 1;
}

std::vector<float> hypsographic_heights_m(const PlatesParameters& parameters, const StageIo& io,
                                          const Context& context, std::span<const Vector3> places) {
  const Hypsography& target = target_of(context);
  std::vector<float> height;
  if (io.read_optional(field::ranking).empty()) {
    height = Order(parameters, io.grid(), context.seed).at(places);
  } else {
    std::vector<float> rank(io.grid().size(), 0.0F);
    order_cells(parameters, io, context, rank);
    height.resize(places.size());
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < places.size(); ++k) {
      height[k] = seen_at(io.grid(), rank, places[k]);
    }
  }
  std::vector<std::int32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return height[a] < height[b]; });
  const double last = std::max(1.0, static_cast<double>(places.size()) - 1.0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    height[order[k]] = static_cast<float>(height_at(target, static_cast<double>(k) / last));
  }
  return height;
}

}  // namespace geo
