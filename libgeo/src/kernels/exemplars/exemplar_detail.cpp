#include "geo/kernels/exemplars/exemplar_detail.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exemplar_primitives.hpp"
#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/projection.hpp"
#include "kernels/remapping/sphere_rows.hpp"

namespace geo {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

Centre position_of(const Vector3& unit) {
  return {kDegrees * std::asin(std::clamp(unit[2], -1.0, 1.0)),
          kDegrees * std::atan2(unit[1], unit[0])};
}

std::vector<Texture> textures_of(const ExemplarLibrary& library, const ExemplarBand& band,
                                 double cell_m) {
  if (library.exemplars.empty()) throw InputError("there is no exemplar");
  std::vector<Texture> textures;
  for (const Exemplar& e : library.exemplars) textures.push_back(texture_of(e, band, cell_m));
  return textures;
}

/// A primitive and where its centre is on a map.
struct OnMap {
  double x_m, y_m;
  Primitive primitive;
};

/// Primitives whose discs may touch the fine grid, in the order of the lattice.
std::vector<OnMap> primitives_on(const Grid& fine, const Grid& planet, const TerrainGuide& guide,
                                 std::span<const Texture> textures, const ExemplarBand& band,
                                 const PrimitiveSize& size, std::uint64_t seed) {
  const double planet_m = fine.figure().radius_m;
  const PrimitivePlaces places(planet_m, size);
  const RandomStream random(seed, "exemplars");
  const EqualAreaProjection projection(*fine.centre(), fine.figure());
  const double half_x_m = 0.5 * fine.nx() * fine.spacing_east_m(0) + size.radius_m;
  const double half_y_m = 0.5 * fine.ny() * fine.step_north_m() + size.radius_m;

  const double reach_deg =
      std::min(180.0, kDegrees * 1.2 * (std::hypot(half_x_m, half_y_m) + size.radius_m) / planet_m);
  const auto index_at = [&](double latitude_deg) {
    const double z = std::sin(std::clamp(latitude_deg, -90.0, 90.0) / kDegrees);
    return static_cast<std::int64_t>(0.5 * (1.0 - z) * static_cast<double>(places.count()));
  };
  const double latitude_deg = fine.centre()->latitude_deg;
  const std::int64_t first = std::max<std::int64_t>(0, index_at(latitude_deg + reach_deg));
  const std::int64_t last = std::min(places.count() - 1, index_at(latitude_deg - reach_deg));

  std::vector<OnMap> primitives;
  for (std::int64_t k = first; k <= last; ++k) {
    // Too far from the grid even when shifted?
    const auto near = projection.project(position_of(places.lattice(k)));
    if (!(std::abs(near[0]) < half_x_m + size.apart_m &&
          std::abs(near[1]) < half_y_m + size.apart_m)) {
      continue;
    }
    const Vector3 centre = places.shifted(k, random);
    const auto [x_m, y_m] = projection.project(position_of(centre));
    if (std::abs(x_m) > half_x_m || std::abs(y_m) > half_y_m) continue;
    const LocalTerrain local = look_around(planet, guide, centre, band.spacing_m);
    primitives.push_back(
        {x_m, y_m, draw_primitive(random, k, centre, planet_m, local, textures, size)});
  }
  return primitives;
}

/// Blends primitives along a row of a sphere, in the columns that are wanted.
void blend(const Grid& grid, int j, std::span<const std::uint8_t> wanted,
           std::span<const Primitive> primitives, std::span<const std::int32_t> numbers,
           double reach, BlendedRow& row) {
  const std::span<Vector3> unit = row.begin();
  for (int i = 0; i < grid.nx(); ++i) unit[i] = grid.to_axis(grid.unit_vector(i, j));
  const Parallel parallel(grid, j);
  const auto is_wanted = [&](int i) { return wanted.empty() || wanted[grid.cell(i, j)] != 0; };
  for (const std::int32_t number : numbers) {
    const Primitive& p = primitives[number];
    const Vector3& at = p.centre;
    parallel.within({std::atan2(at[1], at[0]), std::hypot(at[0], at[1]), at[2]}, reach,
                    [&](int first, int last) {
                      for (int begin = first; begin < last; ++begin) {
                        if (!is_wanted(begin)) continue;
                        int end = begin + 1;
                        while (end < last && is_wanted(end)) ++end;
                        row.add(p, begin, end);
                        begin = end;
                      }
                    });
  }
}

void check_guide(std::string_view kernel, const Grid& planet, const TerrainGuide& guide) {
  using enum ArraySize::May;
  check_sizes(kernel, planet.size(),
              {{"elevation_m", guide.elevation_m.size()},
               {"orogeny_type", guide.orogeny_type.size(), be_empty},
               {"orogeny_age_myr", guide.orogeny_age_myr.size(), be_empty},
               {"fold_east", guide.fold_east.size(), be_empty},
               {"fold_north", guide.fold_north.size(), be_empty}});
}

}  // namespace

ExemplarBand exemplar_band(const ExemplarLibrary& library, double spacing_m, double fine_cell_m,
                           double hurst) {
  if (library.exemplars.empty()) throw InputError("there is no exemplar");
  ExemplarBand band{spacing_m, 0.0, 0.0, hurst};
  for (const Exemplar& e : library.exemplars) {
    band.shortest_m = std::max(band.shortest_m, 2.0 * e.cell_m * times_coarser(e, fine_cell_m));
  }
  band.longest_m = std::min(2.5 * spacing_m, 2.0 * disc_radius_m(library));
  return band;
}

void exemplar_detail(const Grid& planet, const TerrainGuide& guide, const Grid& fine,
                     const ExemplarLibrary& library, const ExemplarBand& band, std::uint64_t seed,
                     std::span<float> detail) {
  if (!fine.is_projected() || !fine.centre()) {
    throw InputError("exemplars need a plane that knows its place");
  }
  check_sizes("exemplar_detail", fine.size(), {{"detail", detail.size()}});
  check_guide("exemplar_detail", planet, guide);
  const std::vector<Texture> textures = textures_of(library, band, fine.spacing_east_m(0));
  const PrimitiveSize size(disc_radius_m(library));
  const std::vector<OnMap> primitives =
      primitives_on(fine, planet, guide, textures, band, size, seed);
  // The map stretches lengths a little.
  constexpr double kStretch = 1.02;
  const double reach_m = kStretch * size.radius_m;
  ParallelErrors errors;
#pragma omp parallel
  {
    auto made = errors.make<BlendedRow>(fine.nx());
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < fine.ny(); ++j) {
      if (errors.any()) continue;
      BlendedRow& row = *made;
      const std::span<Vector3> unit = row.begin();
      for (int i = 0; i < fine.nx(); ++i) {
        const Centre at = fine.position(i, j);
        const double latitude = at.latitude_deg / kDegrees, longitude = at.longitude_deg / kDegrees;
        unit[i] = {std::cos(latitude) * std::cos(longitude),
                   std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
      }
      for (const auto& [x_m, y_m, primitive] : primitives) {
        const double dy_m = fine.y_m(j) - y_m;
        const double chord2 = reach_m * reach_m - dy_m * dy_m;
        if (chord2 <= 0.0) continue;
        const double reach = std::sqrt(chord2) / fine.spacing_east_m(0);
        const double middle = x_m / fine.spacing_east_m(0) + 0.5 * fine.nx() - 0.5;
        row.add(primitive, std::max(0, static_cast<int>(std::ceil(middle - reach))),
                std::min(fine.nx(), static_cast<int>(std::floor(middle + reach)) + 1));
      }
      for (int i = 0; i < fine.nx(); ++i) detail[fine.cell(i, j)] = row[i];
    }
  }
  errors.rethrow();
}

double least_side_m(double longest_m) { return longest_m / kDiscShare; }

bool holds_waves(const Exemplar& e, double longest_m) {
  constexpr double kCells = 12.0, kRounding = 1e-9;
  return std::min(e.nx, e.ny) * e.cell_m >= (1.0 - kRounding) * least_side_m(longest_m) &&
         kCells * e.cell_m <= longest_m;
}

ExemplarBand planetary_band(const ExemplarLibrary& library, double longest_m) {
  if (library.exemplars.empty()) throw InputError("there is no exemplar");
  const double held_m = std::min(longest_m, 2.0 * disc_radius_m(library));
  return {.spacing_m = held_m / 3.0, .longest_m = held_m, .shortest_m = held_m / 64.0};
}

void exemplar_detail_on_sphere(const Grid& grid, std::span<const std::uint8_t> wanted,
                               const Grid& on, const TerrainGuide& guide,
                               const ExemplarLibrary& library, const ExemplarBand& band,
                               std::uint64_t seed, std::span<float> detail) {
  if (grid.topology() != Topology::sphere || on.topology() != Topology::sphere) {
    throw InputError("exemplars on a planet: the grid must be a whole sphere");
  }
  check_sizes("exemplar_detail_on_sphere", grid.size(),
              {{"detail", detail.size()}, {"wanted", wanted.size(), ArraySize::May::be_empty}});
  check_guide("exemplar_detail_on_sphere", on, guide);
  std::vector<Texture> textures = textures_of(library, band, band.shortest_m);
  const double cell_m = grid.spacing_north_m(grid.ny() / 2 - 1);
  // Unit variance is that of waves which cells of this share of the longest show.
  constexpr double kReference = 1.0 / 16.0;
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < textures.size(); ++k) {
    errors.guard([&] {
      rescale(kReference * band.longest_m, textures[k]);
      blur_for(cell_m, textures[k]);
    });
  }
  errors.rethrow();

  const double planet_m = grid.figure().radius_m;
  constexpr double kElongation = 2.0;
  const PrimitiveSize size(disc_radius_m(library), kElongation);
  const PrimitivePlaces places(planet_m, size);
  const RandomStream random(seed, "exemplars.planet");
  std::vector<Primitive> primitives(places.count());
#pragma omp parallel for schedule(static)
  for (std::int64_t k = 0; k < places.count(); ++k) {
    errors.guard([&] {
      const Vector3 centre = on.to_axis(places.shifted(k, random));
      const LocalTerrain local = look_around(on, guide, centre, band.spacing_m);
      primitives[k] = draw_primitive(random, k, centre, planet_m, local, textures, size);
    });
  }
  errors.rethrow();
  // Discs are measured in the plane that touches the sphere: they reach a little further on it.
  const double reach = 1.02 * std::asin(std::min(0.9, size.radius_m / planet_m));
  const RowBands bands(grid, primitives.size(), reach, [&](std::size_t k) {
    return std::asin(std::clamp(primitives[k].centre[2], -1.0, 1.0));
  });
#pragma omp parallel
  {
    auto made = errors.make<BlendedRow>(grid.nx());
#pragma omp for schedule(dynamic, 1)
    for (std::size_t b = 0; b < bands.size(); ++b) {
      if (errors.any()) continue;
      BlendedRow& row = *made;
      for (int j = bands.begin(b); j < bands.end(b); ++j) {
        blend(grid, j, wanted, primitives, bands[b], reach, row);
        for (int i = 0; i < grid.nx(); ++i) detail[grid.cell(i, j)] = row[i];
      }
    }
  }
  errors.rethrow();
}

}  // namespace geo
