#include "sphere_initial_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/core/random.hpp"
#include "geo/kernels/plates/plate_reconstruction.hpp"
#include "geo/kernels/plates/region_outline.hpp"
#include "geo/kernels/plates/sphere/sphere_boundaries.hpp"
#include "stages/plates/hypsography.hpp"

namespace geo {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// What is given as files lies on the planet as it is before a grid is turned over it: in the frame
// of the samples.

/// From where places are at the beginning to where they are in the outline of each plate: that of
/// today where a reconstruction drives it. Empty: they are where they are.
std::vector<Matrix3> ways_to_outlines(const Context& context) {
  std::vector<Matrix3> ways;
  if (!context.reconstruction) return ways;
  const PlateReconstruction& given = *context.reconstruction;
  for (const int number : given.first) {
    const Matrix3 there = given.rotations.at(number, given.start_ma).value().matrix();
    ways.push_back({{{there[0][0], there[1][0], there[2][0]},
                     {there[0][1], there[1][1], there[2][1]},
                     {there[0][2], there[1][2], there[2][2]}}});
  }
  return ways;
}

/// The plate of each sample: the last one whose outline holds it, in gaps the nearest.
std::vector<std::int16_t> plates_at_samples(const SphereMesh& mesh, Context& context) {
  const std::vector<PlateOutline>& outlines = context.plates;
  std::vector<RegionOutline> regions;
  regions.reserve(outlines.size());
  for (const PlateOutline& outline : outlines) regions.emplace_back(outline.rings);
  const std::vector<Matrix3> ways = ways_to_outlines(context);
  std::vector<std::int16_t> plate(mesh.size(), -1);
  std::int32_t shared = 0;
#pragma omp parallel for schedule(dynamic, 1024) reduction(+ : shared)
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    const Centre at = place_of(mesh.samples().position(i));
    int holding = 0;
    for (std::size_t p = 0; p < regions.size(); ++p) {
      const bool holds = regions[p].holds(
          ways.empty() ? at : place_of(times(ways[p], mesh.samples().position(i))));
      if (!holds) continue;
      plate[i] = static_cast<std::int16_t>(p);
      ++holding;
    }
    shared += holding > 1 ? 1 : 0;
  }
  std::vector<std::int32_t> within;
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    if (plate[i] >= 0) within.push_back(i);
  }
  if (within.empty()) throw InputError("plates: fields.plates: no outline holds any place");
  const auto percent = [&](double samples) { return 100.0 * samples / mesh.size(); };
  constexpr double kTold_percent = 0.1;
  if (const double gap = percent(mesh.size() - std::ssize(within)); gap > kTold_percent) {
    context.warnings.push_back(
        fmt::format("fields.plates: {:.1f} % of the planet lies within no outline and goes to the "
                    "nearest plate",
                    gap));
  }
  if (percent(shared) > kTold_percent) {
    context.warnings.push_back(
        fmt::format("fields.plates: {:.1f} % of the planet lies within several outlines and goes "
                    "to the last of them",
                    percent(shared)));
  }
  const auto nearest = nearest_samples(mesh, within, std::numbers::pi);
  for (std::int32_t i = 0; i < mesh.size(); ++i) plate[i] = plate[within[nearest[i]]];
  return plate;
}

void take_plates(const SphereMesh& mesh, Context& context, SphereStart& start) {
  start.plate = plates_at_samples(mesh, context);
  std::vector<std::int16_t> number(context.plates.size(), -1);
  for (const std::int16_t plate : start.plate) number[plate] = 0;
  for (std::size_t p = 0; p < number.size(); ++p) {
    const PlateOutline& outline = context.plates[p];
    if (number[p] < 0) {
      context.warnings.push_back(fmt::format(
          "fields.plates: {} is too small for plates.sphere.samples and left out", outline.name));
      continue;
    }
    number[p] = static_cast<std::int16_t>(start.rotation_rad_myr.size());
    start.rotation_rad_myr.push_back(
        scaled(unit_vector_of(outline.pole), outline.rate_deg_myr / kDegrees));
    if (context.reconstruction) start.driver.push_back(context.reconstruction->first[p]);
  }
  for (std::int16_t& plate : start.plate) plate = number[plate];
}

/// Means of cells over the samples that are nearest to them; a sample without cells takes the cell
/// that it lies in. NaN where the cells are.
std::vector<float> means_at_samples(const GivenElevation& given, const std::vector<float>& values,
                                    const SphereMesh& mesh) {
  const Grid& grid = given.grid;
  std::vector<std::int32_t> nearest(grid.size());
#pragma omp parallel for schedule(dynamic, 8)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      nearest[grid.cell(i, j)] = mesh.samples().nearest(unit_vector_of(grid.position(i, j)));
    }
  }
  std::vector<double> sum(mesh.size(), 0.0), area(mesh.size(), 0.0);
  for (Index cell = 0; cell < grid.size(); ++cell) {
    if (std::isnan(values[cell])) continue;
    const double weight = grid.area_m2(grid.row(cell));
    sum[nearest[cell]] += weight * values[cell];
    area[nearest[cell]] += weight;
  }
  std::vector<float> mean(mesh.size());
  for (std::int32_t i = 0; i < mesh.size(); ++i) {
    if (area[i] > 0.0) {
      mean[i] = static_cast<float>(sum[i] / area[i]);
      continue;
    }
    const Centre at = place_of(mesh.samples().position(i));
    const int column = static_cast<int>((at.longitude_deg / 360.0 + 0.5) * grid.nx());
    const int row = static_cast<int>((at.latitude_deg / 180.0 + 0.5) * grid.ny());
    mean[i] =
        values[grid.cell(std::clamp(column, 0, grid.nx() - 1), std::clamp(row, 0, grid.ny() - 1))];
  }
  return mean;
}

void take_elevation(const SphereMesh& mesh, const Context& context, SphereStart& start) {
  if (!context.initial_elevation) {
    throw InputError(
        "plates: plates.sphere.initial_elevation = given needs fields.initial_elevation, a NetCDF "
        "file of a planet's elevation");
  }
  const GivenElevation& given = *context.initial_elevation;
  start.real_floor = true;
  start.elevation_m = means_at_samples(given, given.elevation_m, mesh);
  if (given.age_myr.empty()) return;
  start.age_myr = means_at_samples(given, given.age_myr, mesh);
}

}  // namespace

Centre position_of(const Grid& grid, const Vector3& place) { return place_of(grid.to_axis(place)); }

Vector3 place_on(const Grid& grid, const Centre& place) {
  const Vector3 on_axis = unit_vector_of(place);
  Vector3 out{};
  for (int c = 0; c < 3; ++c) {
    Vector3 axis{};
    axis[c] = 1.0;
    out[c] = dot(grid.to_axis(axis), on_axis);
  }
  return out;
}

std::vector<SpherePlume> first_plumes(const PlatesParameters& parameters, std::uint64_t seed) {
  const RandomStream random(seed, "plates.plumes");
  std::vector<SpherePlume> plumes(static_cast<std::size_t>(std::lround(parameters.plumes)));
  for (std::size_t k = 0; k < plumes.size(); ++k) {
    plumes[k] = {.place = random.direction(k),
                 .growth_mm_yr = parameters.sphere.plume_mm_yr,
                 .number = static_cast<std::int64_t>(k)};
  }
  return plumes;
}

std::int64_t first_plates(const PlatesParameters& parameters, const Context& context) {
  return context.plates.empty() ? parameters.growth.count : std::ssize(context.plates);
}

SphereStart sphere_start(const PlatesParameters& parameters, const SphereMesh& mesh,
                         const StageIo& io, Context& context) {
  SphereStart start = parameters.start;
  start.plates = parameters.growth.count;
  start.continental_share = parameters.cratons.share;
  start.whole_plates = parameters.continents == "plates";
  start.oldest_floor_myr = parameters.oldest_floor_myr;
  start.supercontinent = parameters.initial_continents == "supercontinent";
  if (!context.plates.empty()) take_plates(mesh, context, start);
  if (parameters.initial_elevation == "hypsography") {
    start.elevation_m = hypsographic_heights_m(parameters, io, context, mesh.samples().positions());
  } else if (parameters.initial_elevation == "given") {
    take_elevation(mesh, context, start);
  }
  if (parameters.initial_elevation != "given" && context.initial_elevation) {
    context.warnings.push_back(
        "fields.initial_elevation is for plates.sphere.initial_elevation = given: not used");
  }
  return start;
}

}  // namespace geo
