#include "geo/kernels/plates/growth/convergent_margins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "geo/core/array_sizes.hpp"
#include "geo/core/field.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/numerics/nearest_source.hpp"
#include "geo/kernels/numerics/shapes.hpp"

namespace geo {
namespace {

constexpr float kFar_km = 1e9F;
constexpr std::array<int, 4> kSides{kNorth, kEast, kSouth, kWest};

std::array<float, 3> position(const Grid& grid, Index cell) {
  const auto p = grid.unit_vector(grid.column(cell), grid.row(cell));
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

/// Points of a boundary and the cells nearest to them.
struct Sources {
  std::vector<std::array<float, 3>> position;
  std::vector<float> handicap_m;
  std::vector<Index> cell;
  std::vector<std::int32_t> nearest;

  explicit Sources(const Grid& grid) : nearest(grid.size(), -1) {}
  void add(const Grid& grid, Index at, double handicap) {
    nearest[at] = static_cast<std::int32_t>(position.size());
    position.push_back(geo::position(grid, at));
    handicap_m.push_back(static_cast<float>(handicap));
    cell.push_back(at);
  }
  void propagate(const Grid& grid) { nearest_sources(grid, position, handicap_m, nearest); }
  [[nodiscard]] double distance_km(const Grid& grid, Index at) const {
    return 1e-3 *
           distance_m(geo::position(grid, at), position[nearest[at]], grid.figure().radius_m);
  }
};

/// Length of a cell's sides towards other plates, in heights of a row.
double side_towards_others(const Grid& grid, std::span<const std::int16_t> plate, Index cell) {
  const double parallel = std::cos(grid.latitude_deg(grid.row(cell)) * std::numbers::pi / 180.0);
  const double width = 2.0 * parallel * grid.ny() / grid.nx();
  double length = 0.0;
  for (const int k : kSides) {
    if (plate[grid.neighbour(cell, k)] == plate[cell]) continue;
    length += k == kNorth || k == kSouth ? width : 1.0;
  }
  return length;
}

/// What one plate is like near a point of its boundary.
struct Side {
  std::int16_t plate = -1;
  double fraction = 0.0, floor_myr = 0.0, speed = 0.0;
  Vector3 centre{};
  Index nearest = 0;
  double weight = 0.0, floor_weight = 0.0;
};

/// A velocity along the ground, in the frame of the grid's axis.
Vector3 velocity(const Vector3& at, double east, double north) {
  const double level = std::hypot(at[0], at[1]);
  if (!(level > 0.0)) return {};
  const Vector3 to_east{-at[1] / level, at[0] / level, 0.0};
  return add(add({}, to_east, east), cross(at, to_east), north);
}

/// How fast two plates approach each other along the way between them, 0 where they part.
double closing_speed(const Grid& grid, const Side& own, const Side& other,
                     std::span<const float> east, std::span<const float> north) {
  const auto place = [&](Index cell) {
    return grid.to_axis(grid.unit_vector(grid.column(cell), grid.row(cell)));
  };
  const Vector3 here = place(own.nearest), there = place(other.nearest);
  const Vector3 way = grid.to_axis(add(other.centre, own.centre, -1.0));
  const Vector3 along = tangent(way, here);
  if (!(length(along) > 0.0)) return 0.0;
  const Vector3 relative = add(velocity(there, east[other.nearest], north[other.nearest]),
                               velocity(here, east[own.nearest], north[own.nearest]), -1.0);
  return std::max(0.0, -dot(relative, normalised(along)));
}

}  // namespace

double andean_thickening(double across_km, double strength) {
  const double inner = 250.0 + 250.0 * strength, outer = inner + 600.0;
  return std::pow(strength, 0.6) * smooth_step(50.0, 190.0, across_km) *
         (1.0 - smooth_step(inner, outer, across_km));
}

double himalayan_thickening(double across_km, double strength) {
  const double inner = 250.0 + 600.0 * strength, outer = inner + 750.0;
  return std::pow(strength, 0.5) * smooth_step(-110.0, 60.0, across_km) *
         (1.0 - smooth_step(inner, outer, across_km));
}

double island_arc(double across_km, double strength) {
  return std::pow(strength, 0.4) * bell(across_km, 165.0, 50.0);
}

double trench_m(double across_km, double strength) {
  return -(900.0 + 2100.0 * strength) * bell(across_km, -5.0, 36.0) +
         320.0 * bell(across_km, -170.0, 65.0);
}

double trench_share(double floor_myr, double closing_mm_yr) {
  constexpr double kMost = 1.2;  // 120 Myr, 120 mm/yr
  return std::sqrt(std::clamp(0.01 * floor_myr, 0.0, kMost) *
                   std::clamp(0.01 * closing_mm_yr, 0.0, kMost));
}

double bent_plate(double across_km) {
  // As deep at the trench as the plate is bent there.
  constexpr double kZero_km = 58.0, kToBulge_km = 55.0, kWall_km = 34.0;
  constexpr double kPerKm = 0.25 * std::numbers::pi / kToBulge_km, kYields = 0.53;
  const auto bent = [](double out_km) {
    const double t = kPerKm * (out_km - kZero_km);
    return (t > 0.0 ? kYields : 1.0) * std::exp(-t) * std::sin(t);
  };
  if (across_km > 0.0) return -bell(across_km, 0.0, kWall_km);
  return bent(-across_km) / -bent(0.0);
}

namespace {

/// Of a section whose integral is `width_km`, and of ranges about a place.
ShorteningDensity density(double section, double width_km, double from_ranges_km) {
  constexpr double kRanges_km = 90.0;
  const double integral_km = kRanges_km * std::sqrt(2.0 * std::numbers::pi);
  return {section / width_km, bell(from_ranges_km, 0.0, kRanges_km) / integral_km};
}

}  // namespace

ShorteningDensity andean_shortening(double across_km, double strength) {
  const double inner = 250.0 + 250.0 * strength, outer = inner + 600.0;
  const double section =
      smooth_step(50.0, 190.0, across_km) * (1.0 - smooth_step(inner, outer, across_km));
  return density(section, 0.5 * (inner + outer) - 120.0, across_km - 200.0);
}

ShorteningDensity himalayan_shortening(double across_km, double strength) {
  const double inner = 250.0 + 600.0 * strength, outer = inner + 750.0;
  const double section =
      smooth_step(-110.0, 60.0, across_km) * (1.0 - smooth_step(inner, outer, across_km));
  return density(section, 0.5 * (inner + outer) + 25.0, across_km - 40.0);
}

namespace {

/// What is known of plates on a grid.
struct PlateFields {
  std::span<const std::int16_t> plate;
  std::span<const float> continental_fraction, age_myr, east_mm_yr, north_mm_yr;
};

/// The cells within a distance of one, as many along a parallel as along a meridian, whatever the
/// latitude; on coarse grids those around it.
class Disc {
 public:
  Disc(const Grid& grid, Index centre, double reach_m)
      : grid_(grid),
        centre_(centre),
        reach_(std::max(reach_m / grid.figure().radius_m, 1.5 * std::numbers::pi / grid.ny())) {}

  /// Hands a cell on with its distance from the middle over the disc's radius, and the area that it
  /// stands for, in squares of a row's height.
  template <class Visit>
  void each(Visit&& visit) const {
    const int column = grid_.column(centre_), row = grid_.row(centre_);
    const double spacing = std::numbers::pi / grid_.ny();
    const int rows = std::max(1, static_cast<int>(reach_ / spacing));
    const Vector3 middle = grid_.unit_vector(column, row);
    for (int j = std::max(0, row - rows); j <= std::min(grid_.ny() - 1, row + rows); ++j) {
      const double wide = std::cos(grid_.latitude_deg(j) * std::numbers::pi / 180.0);
      const double step = 2.0 * std::numbers::pi * wide / grid_.nx();
      const int stride = std::clamp(static_cast<int>(spacing / step), 1, grid_.nx() / 3);
      const double area = stride * step / spacing;
      const int most = std::min((grid_.nx() - 1) / 2, static_cast<int>(2.0 * reach_ / step) + 1);
      for (int di = -(most / stride) * stride; di <= most; di += stride) {
        const int i = (column + di + grid_.nx()) % grid_.nx();
        const double far = length(add(grid_.unit_vector(i, j), middle, -1.0)) / reach_;
        if (far < 1.0) visit(grid_.cell(i, j), far, area);
      }
    }
  }

 private:
  const Grid& grid_;
  Index centre_;
  double reach_;
};

/// The plates on both sides of a boundary at a cell of the first one, as means over a window; none
/// where no other plate is in it.
std::optional<std::array<Side, 2>> sides_at(const Grid& grid, const PlateFields& fields, Index cell,
                                            double reach_m) {
  const Disc disc(grid, cell, reach_m);
  std::array<Side, 2> sides;
  sides[0].plate = fields.plate[cell];
  sides[0].nearest = cell;
  double nearest = 1.0;
  disc.each([&](Index there, double far, double /*area*/) {
    if (fields.plate[there] == sides[0].plate || far >= nearest) return;
    nearest = far;
    sides[1].plate = fields.plate[there];
    sides[1].nearest = there;
  });
  if (sides[1].plate < 0) return std::nullopt;
  disc.each([&](Index there, double far, double area) {
    const double weight = area * (1.0 - far * far);
    for (Side& s : sides) {
      if (fields.plate[there] != s.plate) continue;
      s.weight += weight;
      s.fraction += weight * fields.continental_fraction[there];
      s.speed += weight * std::hypot(fields.east_mm_yr[there], fields.north_mm_yr[there]);
      s.centre = add(s.centre, grid.unit_vector(grid.column(there), grid.row(there)), weight);
      if (fields.continental_fraction[there] >= 0.5F) continue;  // of another age
      s.floor_myr += weight * fields.age_myr[there];
      s.floor_weight += weight;
    }
  });
  for (Side& s : sides) {
    s.fraction /= s.weight;
    if (s.floor_weight > 0.0) s.floor_myr /= s.floor_weight;
    s.speed /= s.weight;
    s.centre = add({}, s.centre, 1.0 / s.weight);
  }
  return sides;
}

/// What happens where two plates converge, and to which of them.
struct Subduction {
  Convergence kind;
  std::int16_t down;
  std::array<std::int16_t, 2> plates;
  std::array<double, 2> floor_myr;  // of the two
  double boundary = 0.0;            // its length there

  [[nodiscard]] double floor_down_myr() const { return floor_myr[down == plates[0] ? 0 : 1]; }
  /// Whether a plate subducts there. Another than the two is on the side of that of the place.
  [[nodiscard]] bool takes_down(std::int16_t plate) const {
    return down == (plate == plates[1] ? plate : plates[0]);
  }
};

/// Sea floor subducts below a continent, the older of two floors, the faster of two continents.
Subduction subduction_of(const std::array<Side, 2>& sides, double boundary) {
  constexpr double kContinental = 0.45;
  const Side &first = sides[0], &second = sides[1];
  const auto subducts = [&](bool is_first, Convergence kind) {
    return Subduction{kind,
                      is_first ? first.plate : second.plate,
                      {first.plate, second.plate},
                      {first.floor_myr, second.floor_myr},
                      boundary};
  };
  const auto decides = [&](double left, double right) {
    return left < right || (left == right && first.plate < second.plate);
  };
  const bool a = first.fraction > kContinental, b = second.fraction > kContinental;
  if (a != b) return subducts(b, Convergence::ocean_continent);
  if (a) return subducts(decides(second.speed, first.speed), Convergence::continents);
  return subducts(decides(second.floor_myr, first.floor_myr), Convergence::oceans);
}

/// Of every two plates that meet as oceans, the one whose floor is older on the mean along their
/// boundary subducts at all of it.
void hold_slabs_together(std::vector<Subduction>& subductions) {
  std::map<std::pair<std::int16_t, std::int16_t>, double> older_myr;  // the first of them
  const auto pair_of = [](const Subduction& s) { return std::minmax(s.plates[0], s.plates[1]); };
  for (const Subduction& s : subductions) {
    if (s.kind != Convergence::oceans) continue;
    const double by_myr = s.boundary * (s.floor_myr[0] - s.floor_myr[1]);
    older_myr[pair_of(s)] += s.plates[0] < s.plates[1] ? by_myr : -by_myr;
  }
  for (Subduction& s : subductions) {
    if (s.kind != Convergence::oceans) continue;
    const auto [low, high] = pair_of(s);
    s.down = older_myr[{low, high}] >= 0.0 ? low : high;
  }
}

}  // namespace

ConvergentMargins convergent_margins(const Grid& grid, std::span<const std::int16_t> plate,
                                     std::span<const std::int8_t> boundary_type,
                                     std::span<const float> boundary_strength,
                                     std::span<const float> continental_fraction,
                                     std::span<const float> age_myr,
                                     std::span<const float> east_mm_yr,
                                     std::span<const float> north_mm_yr, Polarity polarity) {
  check_sizes("convergent_margins", grid.size(),
              {{"plate", plate.size()},
               {"boundary_type", boundary_type.size()},
               {"boundary_strength", boundary_strength.size()},
               {"continental_fraction", continental_fraction.size()},
               {"age_myr", age_myr.size()},
               {"east_mm_yr", east_mm_yr.size()},
               {"north_mm_yr", north_mm_yr.size()}});
  constexpr auto kConvergent = static_cast<std::int8_t>(BoundaryType::convergent);
  constexpr double kWindow_m = 310e3, kWidest_rad = 0.35, kHandicap_m = 150e3;
  // On small planets a window of that width holds all plates.
  const double window_m = std::min(kWindow_m, kWidest_rad * grid.figure().radius_m);
  const PlateFields fields{plate, continental_fraction, age_myr, east_mm_yr, north_mm_yr};
  Sources sources(grid);
  std::vector<Subduction> subductions;
  std::vector<float> closing;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (boundary_type[cell] != kConvergent) continue;
    const double boundary = side_towards_others(grid, plate, cell);
    if (boundary == 0.0) continue;
    const auto sides = sides_at(grid, fields, cell, window_m);
    if (!sides) continue;
    subductions.push_back(subduction_of(*sides, boundary));
    closing.push_back(static_cast<float>(
        closing_speed(grid, sides->front(), sides->back(), east_mm_yr, north_mm_yr)));
    sources.add(grid, cell, kHandicap_m * (1.0 - boundary_strength[cell]));
  }
  if (polarity == Polarity::of_pair) hold_slabs_together(subductions);
  std::vector<std::uint8_t> ends(grid.size());
  for (Index cell = 0; cell < grid.size(); ++cell) {
    ends[cell] = boundary_type[cell] != 0 && boundary_type[cell] != kConvergent ? 1 : 0;
  }
  const std::vector<float> to_end_km = distance_to_marked_km(grid, ends);
  sources.propagate(grid);
  ConvergentMargins margins;
  margins.across_km.assign(grid.size(), kFar_km);
  margins.strength.assign(grid.size(), 0.0F);
  margins.kind.assign(grid.size(), Convergence::none);
  margins.closing_mm_yr.assign(grid.size(), 0.0F);
  margins.floor_myr.assign(grid.size(), 0.0F);
  margins.from_end_km.assign(grid.size(), kFar_km);
  if (sources.position.empty()) return margins;
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const std::int32_t source = sources.nearest[cell];
    const double side = subductions[source].takes_down(plate[cell]) ? -1.0 : 1.0;
    margins.across_km[cell] = static_cast<float>(side * sources.distance_km(grid, cell));
    margins.strength[cell] = boundary_strength[sources.cell[source]];
    margins.kind[cell] = subductions[source].kind;
    margins.closing_mm_yr[cell] = closing[source];
    margins.from_end_km[cell] = to_end_km[sources.cell[source]];
    if (subductions[source].kind == Convergence::continents) continue;
    margins.floor_myr[cell] = static_cast<float>(subductions[source].floor_down_myr());
  }
  return margins;
}

DeformationSources deformation_sources(const Grid& grid, std::span<const std::int8_t> boundary_type,
                                       std::span<const float> boundary_strength, std::int8_t type,
                                       double length_km) {
  check_sizes(
      "deformation_sources", grid.size(),
      {{"boundary_type", boundary_type.size()}, {"boundary_strength", boundary_strength.size()}});
  Sources sources(grid);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (boundary_type[cell] != type || boundary_strength[cell] <= 0.0F) continue;
    // The largest strength exp(-d / L) is the least d - L ln strength.
    sources.add(grid, cell, -1e3 * length_km * std::log(boundary_strength[cell]));
  }
  sources.propagate(grid);
  DeformationSources found{std::vector<float>(grid.size(), 0.0F),
                           std::vector<double>(grid.size(), 0.0)};
  if (sources.position.empty()) return found;
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    found.strength[cell] = boundary_strength[sources.cell[sources.nearest[cell]]];
    found.distance_km[cell] = sources.distance_km(grid, cell);
  }
  return found;
}

std::vector<float> propagated_deformation(const Grid& grid,
                                          std::span<const std::int8_t> boundary_type,
                                          std::span<const float> boundary_strength,
                                          std::int8_t type, double length_km) {
  const DeformationSources sources =
      deformation_sources(grid, boundary_type, boundary_strength, type, length_km);
  std::vector<float> deformation(sources.strength);
  for (std::size_t cell = 0; cell < deformation.size(); ++cell) {
    deformation[cell] *= static_cast<float>(std::exp(-sources.distance_km[cell] / length_km));
  }
  return deformation;
}

std::vector<float> distance_to_marked_km(const Grid& grid, std::span<const std::uint8_t> marked) {
  check_sizes("distance_to_marked_km", grid.size(), {{"marked", marked.size()}});
  Sources sources(grid);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (marked[cell] != 0) sources.add(grid, cell, 0.0);
  }
  sources.propagate(grid);
  std::vector<float> distance(grid.size(), kFar_km);
  if (sources.position.empty()) return distance;
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    distance[cell] = static_cast<float>(sources.distance_km(grid, cell));
  }
  return distance;
}

}  // namespace geo
