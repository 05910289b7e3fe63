#include "geo/kernels/crust/volcanoes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "geo/core/tangent_frame.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/remapping/fibonacci_sphere.hpp"
#include "kernels/remapping/sphere_rows.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// Hot spots without a plume that heats the mantle about it: of 49 on the Earth all but some ten
/// (Courtillot et al. 2003). Their volcanoes are smaller. Their numbers follow those of any plumes.
constexpr std::uint64_t kMinorHotSpots = 38, kFirstMinor = 1000;
constexpr double kMinorSize = 0.75;

/// The cell in which a place in the frame of the axis lies.
Index cell_of(const Grid& grid, const Vector3& at) {
  const double x = (std::atan2(at[1], at[0]) / (2.0 * kPi) + 0.5) * grid.nx();
  const double y = (std::asin(std::clamp(at[2], -1.0, 1.0)) / kPi + 0.5) * grid.ny();
  return grid.cell(std::clamp(static_cast<int>(x), 0, grid.nx() - 1),
                   std::clamp(static_cast<int>(y), 0, grid.ny() - 1));
}

Vector3 place_of(const Grid& grid, Index cell) {
  return grid.to_axis(grid.unit_vector(grid.column(cell), grid.row(cell)));
}

Volcano volcano_at(const Vector3& place, const VolcanoSizes& sizes, double factor, double normal) {
  const double height_m =
      std::min(sizes.most_m, factor * sizes.median_m * std::exp(sizes.spread * normal));
  return {place, height_m, 1e-3 * height_m * sizes.radius_km_per_km};
}

/// Places where the heat is highest among the cells around and stands out from a ring, the hottest
/// first.
std::vector<Vector3> plumes(const Grid& grid, std::span<const float> heat) {
  constexpr double kRing_km = 600.0, kStandsOut = 0.2;
  constexpr int kPoints = 12;
  const double ring = 1e3 * kRing_km / grid.figure().radius_m;
  std::vector<Index> found;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    bool is_highest = true;
    for (int k = 0; k < kDirections && is_highest; ++k) {
      const Index beside = grid.neighbour(cell, k);
      is_highest = beside < cell ? heat[cell] > heat[beside] : heat[cell] >= heat[beside];
    }
    if (!is_highest) continue;
    const Vector3 at = place_of(grid, cell);
    const TangentFrame frame = tangent_frame(at);
    double around = 0.0;
    for (int k = 0; k < kPoints; ++k) {
      const double angle = 2.0 * kPi * k / kPoints;
      const Vector3 aside = add(scaled(frame.east, std::cos(angle)), frame.north, std::sin(angle));
      const Vector3 there = add(scaled(at, std::cos(ring)), aside, std::sin(ring));
      around += heat[cell_of(grid, there)] / kPoints;
    }
    if (heat[cell] - around > kStandsOut) found.push_back(cell);
  }
  std::stable_sort(found.begin(), found.end(), [&](Index a, Index b) { return heat[a] > heat[b]; });
  std::vector<Vector3> places;
  for (const Index cell : found) {
    const Vector3 at = place_of(grid, cell);
    const bool is_new = std::none_of(places.begin(), places.end(), [&](const Vector3& other) {
      return angle_between(at, other) < ring;
    });
    if (is_new) places.push_back(at);
  }
  return places;
}

/// Follows the plate above a plume back to where it has carried what grew there.
void follow(const Grid& grid, const MovingPlates& plates, const VolcanoSizes& sizes,
            const RandomStream& random, std::uint64_t plume, Vector3 at,
            std::vector<Volcano>& chain) {
  constexpr double kStep_myr = 0.25, kOldest_myr = 80.0, kSinks_myr = 150.0;
  constexpr double kNearest_km = 50.0, kFarthest_km = 130.0, kAside_km = 25.0;
  const double radius_km = 1e-3 * grid.figure().radius_m;
  const std::int16_t plate = plates.plate[cell_of(grid, at)];
  const double strength = std::exp(0.35 * random.normal(plume, 0));
  std::uint64_t number = 1;
  double to_next_km = 0.0;
  for (double t_myr = 0.0; t_myr < kOldest_myr; t_myr += kStep_myr) {
    const Index cell = cell_of(grid, at);
    if (plates.plate[cell] != plate || plates.continental_fraction[cell] > 0.3F ||
        plates.age_myr[cell] < t_myr) {
      return;
    }
    const TangentFrame frame = tangent_frame(at);
    const Vector3 velocity =
        add(scaled(frame.east, plates.east_mm_yr[cell]), frame.north, plates.north_mm_yr[cell]);
    if (to_next_km <= 0.0) {
      const Vector3 aside = normalised(cross(at, velocity));
      const double off_km = kAside_km * random.uniform(plume, 4 * number, -1.0, 1.0);
      chain.push_back(volcano_at(normalised(add(at, aside, off_km / radius_km)), sizes,
                                 strength * std::exp(-t_myr / kSinks_myr),
                                 random.normal(plume, 4 * number + 1)));
      to_next_km = random.uniform(plume, 4 * number + 2, kNearest_km, kFarthest_km);
      ++number;
    }
    // mm yr-1 are km Myr-1.
    to_next_km -= length(velocity) * kStep_myr;
    at = normalised(add(at, velocity, kStep_myr / radius_km));
  }
}

/// A cone by where it is found on a row of cells.
struct Cone {
  Volcano volcano;
  double longitude, ring, reach;
};

/// Mean of exp(-x^2 / 2 s^2) over a cell of a width about x.
double mean_of_bell(double x_m, double width_m, double radius_m) {
  const double scale = std::numbers::sqrt2 * radius_m, half_m = 0.5 * width_m;
  return 0.5 * std::sqrt(kPi) * scale / width_m *
         (std::erf((x_m + half_m) / scale) - std::erf((x_m - half_m) / scale));
}

/// A row of cells, each with the directions by which it measures how far a volcano is.
struct Row {
  Row(const Grid& grid, int j) : east_m(grid.spacing_east_m(j)), cells(grid.nx()) {
    north_m = grid.area_m2(j) / east_m;
    for (int i = 0; i < grid.nx(); ++i) {
      cells[i].place = place_of(grid, grid.cell(i, j));
      cells[i].frame = tangent_frame(cells[i].place);
    }
  }
  /// Mean height of a volcano over a cell.
  [[nodiscard]] double height_m(int i, const Volcano& v, double planet_m) const {
    const Vector3 way = add(cells[i].place, v.place, -1.0);
    const double radius_m = 1e3 * v.radius_km;
    return v.height_m * mean_of_bell(planet_m * dot(way, cells[i].frame.east), east_m, radius_m) *
           mean_of_bell(planet_m * dot(way, cells[i].frame.north), north_m, radius_m);
  }
  struct Cell {
    Vector3 place;
    TangentFrame frame;
  };
  double east_m, north_m;
  std::vector<Cell> cells;
};

}  // namespace

void pile_volcanoes(const Grid& grid, std::span<const Volcano> volcanoes,
                    std::span<float> height_m) {
  check_sizes("pile_volcanoes", grid.size(), {{"height_m", height_m.size()}});
  if (grid.topology() != Topology::sphere) {
    throw InputError("volcanoes: the grid must be a whole sphere");
  }
  constexpr double kReach = 4.0, kCells = 1.0;  // radii and cells
  const double planet_m = grid.figure().radius_m;
  const double cell_m = grid.spacing_north_m(grid.ny() / 2 - 1);
  std::vector<Cone> cones;
  cones.reserve(volcanoes.size());
  double farthest = 0.0;
  for (const Volcano& v : volcanoes) {
    const double reach = std::min(1.0, (kReach * 1e3 * v.radius_km + kCells * cell_m) / planet_m);
    farthest = std::max(farthest, reach);
    cones.push_back(
        {v, std::atan2(v.place[1], v.place[0]), std::hypot(v.place[0], v.place[1]), reach});
  }
  const RowBands bands(grid, cones.size(), farthest, [&](std::size_t k) -> double {
    return std::asin(std::clamp(cones[k].volcano.place[2], -1.0, 1.0));
  });
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t b = 0; b < bands.size(); ++b) {
    errors.guard([&] {
      for (int j = bands.begin(b); j < bands.end(b) && !bands[b].empty(); ++j) {
        const Row row(grid, j);
        const Parallel parallel(grid, j);
        for (const std::int32_t number : bands[b]) {
          const Cone& cone = cones[number];
          parallel.within({cone.longitude, cone.ring, cone.volcano.place[2]}, cone.reach,
                          [&](int first, int last) {
                            for (int i = first; i < last; ++i) {
                              height_m[grid.cell(i, j)] +=
                                  static_cast<float>(row.height_m(i, cone.volcano, planet_m));
                            }
                          });
        }
      }
    });
  }
  errors.rethrow();
}

std::vector<Volcano> scatter_volcanoes(const Grid& grid, double spacing_km,
                                       const VolcanoSizes& sizes, std::uint64_t seed,
                                       std::string_view stream,
                                       const std::function<bool(Index)>& grows) {
  const double spacing = 1e3 * spacing_km / grid.figure().radius_m;
  const FibonacciSphere lattice(
      static_cast<std::int32_t>(std::clamp(4.0 * kPi / (spacing * spacing), 32.0, 4e6)));
  const RandomStream random(seed, stream);
  std::vector<Volcano> all;
  for (std::int32_t k = 0; k < lattice.size(); ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    const Vector3 place = grid.to_axis(
        normalised(add(lattice.position(k), random.direction(number), 0.6 * lattice.spacing())));
    if (!grows(cell_of(grid, place))) continue;
    all.push_back(volcano_at(place, sizes, 1.0, random.normal(number, 1)));
  }
  return all;
}

std::vector<Volcano> plume_trails(const Grid& grid, const MovingPlates& plates,
                                  const VolcanoSizes& sizes, std::uint64_t seed) {
  check_sizes("plume_trails", grid.size(),
              {{"plate", plates.plate.size()},
               {"east_mm_yr", plates.east_mm_yr.size()},
               {"north_mm_yr", plates.north_mm_yr.size()},
               {"age_myr", plates.age_myr.size()},
               {"continental_fraction", plates.continental_fraction.size()},
               {"heat", plates.heat.size()}});
  const RandomStream random(seed, "isostasy.trails"), minor(seed, "isostasy.hot_spots");
  std::vector<Volcano> all;
  std::uint64_t number = 0;
  for (const Vector3& plume : plumes(grid, plates.heat)) {
    follow(grid, plates, sizes, random, number++, plume, all);
  }
  VolcanoSizes smaller = sizes;
  smaller.median_m *= kMinorSize;
  for (std::uint64_t k = 0; k < kMinorHotSpots; ++k) {
    follow(grid, plates, smaller, random, kFirstMinor + k, grid.to_axis(minor.direction(k)), all);
  }
  return all;
}

}  // namespace geo
