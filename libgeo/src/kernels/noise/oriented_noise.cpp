#include "geo/kernels/noise/oriented_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/array_sizes.hpp"
#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "geo/core/random.hpp"
#include "geo/core/tangent_frame.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/numerics/shapes.hpp"
#include "geo/kernels/numerics/smoothing.hpp"
#include "geo/kernels/remapping/cubic_rows.hpp"
#include "geo/kernels/remapping/fibonacci_sphere.hpp"
#include "kernels/numerics/wide.hpp"
#include "kernels/remapping/sphere_rows.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

/// A group of crests, in the frame of the axis: its centre, and u and v in half extents per radian.
struct Group {
  std::array<float, 3> centre, u, v;
  float longitude, ring;  // of the centre; its distance from the axis
  float phase, weight;
};

// Without branches, so that the compiler vectorises what uses them.

/// cos(2 pi x) within 2e-4, for |x| below 2^20.
inline float cosine_of_turns(float x) {
  constexpr float kWhole = 12582912.0F;  // a sum with it is rounded to a whole number
  const float t = std::abs(x - ((x + kWhole) - kWhole)) - 0.25F;  // cos(2 pi x) = -sin(2 pi t)
  const float s = t * t;
  return -t * (6.2831853F + s * (-41.341702F + s * (81.605249F + s * -76.705860F)));
}
inline float positive_part(float x) { return 0.5F * (x + std::abs(x)); }
inline float between_0_and_1(float x) { return 0.5F * (1.0F + std::abs(x) - std::abs(x - 1.0F)); }

/// One row of the grid as groups see it: places, what is east and north there, and which way crests
/// run.
struct Row {
  explicit Row(int columns) : sum(columns) {
    for (auto* lines : {&place, &east, &north}) {
      for (auto& line : *lines) line.resize(columns);
    }
    for (auto& line : crest) line.resize(columns);
  }
  void stand_at(const Grid& grid, int j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const Vector3 at = grid.to_axis(grid.unit_vector(i, j));
      const TangentFrame frame = tangent_frame(at);
      for (int c = 0; c < 3; ++c) {
        place[c][i] = static_cast<float>(at[c]);
        east[c][i] = static_cast<float>(frame.east[c]);
        north[c][i] = static_cast<float>(frame.north[c]);
      }
    }
    std::fill(sum.begin(), sum.end(), 0.0F);
  }
  std::array<std::vector<float>, 3> place, east, north;
  std::array<std::vector<float>, 2> crest;  // cosine and sine of twice the angle
  std::vector<float> sum;
};

/// Adds a group to the columns from `first` up to, not including, `last`.
TERRANE_WIDE void add_group(Row& row, const Group& g, float waves, int first, int last) {
  const float *x = row.place[0].data(), *y = row.place[1].data(), *z = row.place[2].data();
  const float *ex = row.east[0].data(), *ey = row.east[1].data(), *ez = row.east[2].data();
  const float *nx = row.north[0].data(), *ny = row.north[1].data(), *nz = row.north[2].data();
  const float *cosine = row.crest[0].data(), *sine = row.crest[1].data();
  float* sum = row.sum.data();
  // No structured binding: clang's OpenMP regions know none before version 16.
  const float cx = g.centre[0], cy = g.centre[1], cz = g.centre[2];
  const float ux = g.u[0], uy = g.u[1], uz = g.u[2];
  const float vx = g.v[0], vy = g.v[1], vz = g.v[2];
  const float phase = g.phase, weight = g.weight;
#pragma omp simd
  for (int i = first; i < last; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    const float u = dx * ux + dy * uy + dz * uz;
    const float v = dx * vx + dy * vy + dz * vz;
    const float inside = positive_part(1.0F - u * u - v * v);
    // Crests here and there: the cosine of twice the angle between them.
    const float e = vx * ex[i] + vy * ey[i] + vz * ez[i];
    const float n = vx * nx[i] + vy * ny[i] + vz * nz[i];
    const float alike = ((e * e - n * n) * cosine[i] + 2.0F * e * n * sine[i]) / (e * e + n * n);
    const float like = between_0_and_1(1.6F * alike - 0.3F);
    sum[i] += weight * like * inside * inside * cosine_of_turns(waves * u + phase);
  }
}

/// Calls with the columns of a parallel that may lie within a group; `reach` is that of its ends,
/// radians.
template <class Action>
void each_span(const Parallel& row, const Group& g, double reach, Action&& action) {
  const double east = g.ring > 0.0F ? g.centre[0] / g.ring : 1.0;
  const double north = g.ring > 0.0F ? g.centre[1] / g.ring : 0.0;
  // u(t) = u0 + u1 t + O(t^2) along the parallel, t the longitude from the group's own.
  const auto expand = [&](const std::array<float, 3>& axis) {
    const double at_centre = axis[0] * g.centre[0] + axis[1] * g.centre[1] + axis[2] * g.centre[2];
    const double outward = row.cosine * (axis[0] * east + axis[1] * north);
    const double eastward = row.cosine * (axis[1] * east - axis[0] * north);
    return std::array<double, 3>{outward + row.sine * axis[2] - at_centre, eastward, outward};
  };
  const auto u = expand(g.u), v = expand(g.v);
  constexpr double kNear = 0.4;  // radians, up to which the series is good
  const double farthest = 1.1 * reach / std::max(row.cosine, 1e-6);
  if (farthest < kNear) {
    const double bend = 0.6 * farthest * farthest * std::hypot(u[2], v[2]) +
                        0.2 * farthest * farthest * farthest * std::hypot(u[1], v[1]);
    const double a = u[1] * u[1] + v[1] * v[1], b = u[0] * u[1] + v[0] * v[1];
    const double c = u[0] * u[0] + v[0] * v[0] - (1.0 + bend) * (1.0 + bend);
    const double root = b * b - a * c;
    if (root <= 0.0) return;
    const double half = std::sqrt(root) / a, middle = -b / a;
    return row.between(g.longitude, std::max(middle - half, -farthest),
                       std::min(middle + half, farthest), action);
  }
  row.within({g.longitude, g.ring, g.centre[2]}, reach, action);
}

/// What a grid's cells can show of a wavelength, 0 to 1.
double shown(const Grid& grid, double wavelength_km) {
  const double cells = 1e3 * wavelength_km / grid.spacing_north_m(grid.ny() / 2 - 1);
  return smooth_step(2.0, 3.0, cells);
}

std::vector<Group> draw_groups(const Grid& on, const Orientation& crests, const OrientedBand& band,
                               double radius_km, std::uint64_t seed, std::string_view stream) {
  const double ellipse_sr = kPi * band.width_km * band.length_km / (radius_km * radius_km);
  const double wanted = std::clamp(4.0 * kPi / ellipse_sr * band.overlap, 64.0, 4e6);
  const FibonacciSphere lattice(static_cast<std::int32_t>(wanted));
  const double overlap = lattice.size() * ellipse_sr / (4.0 * kPi);
  const RandomStream random(seed, stream);
  std::vector<Group> all(lattice.size());
#pragma omp parallel for schedule(static)
  for (std::int32_t k = 0; k < lattice.size(); ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    const Vector3 centre =
        normalised(add(lattice.position(k), random.direction(number), lattice.spacing()));
    const Vector3 at = on.to_axis(centre);
    const double x = (std::atan2(at[1], at[0]) / (2.0 * kPi) + 0.5) * on.nx();
    const double y = (std::asin(std::clamp(at[2], -1.0, 1.0)) / kPi + 0.5) * on.ny();
    const Index cell = on.cell(std::clamp(static_cast<int>(x), 0, on.nx() - 1),
                               std::clamp(static_cast<int>(y), 0, on.ny() - 1));
    const double c = crests.cosine[cell], s = crests.sine[cell];
    const double angle = 0.5 * std::atan2(s, c);
    const TangentFrame frame = tangent_frame(at);
    const Vector3 along = add(scaled(frame.east, std::cos(angle)), frame.north, std::sin(angle));
    const Vector3 aside = cross(at, along);
    Group& g = all[k];
    for (int i = 0; i < 3; ++i) {
      g.centre[i] = static_cast<float>(at[i]);
      g.u[i] = static_cast<float>(aside[i] * radius_km / band.width_km);
      g.v[i] = static_cast<float>(along[i] * radius_km / band.length_km);
    }
    g.longitude = static_cast<float>(std::atan2(at[1], at[0]));
    g.ring = static_cast<float>(std::hypot(at[0], at[1]));
    g.phase = static_cast<float>(random.uniform(number, 1));
    const double certain = std::min(1.0, std::hypot(c, s));
    g.weight = certain > 0.1 ? static_cast<float>(std::sqrt(10.0 / overlap) * certain) : 0.0F;
  }
  std::erase_if(all, [](const Group& g) { return g.weight == 0.0F; });
  return all;
}

}  // namespace

Orientation across(Orientation orientation) {
  for (auto* part : {&orientation.cosine, &orientation.sine}) {
    for (float& value : *part) value = -value;
  }
  return orientation;
}

Orientation orientation_of(const Grid& grid, std::span<const float> east,
                           std::span<const float> north, double least) {
  check_sizes("orientation_of", grid.size(), {{"east", east.size()}, {"north", north.size()}});
  Orientation out{std::vector<float>(grid.size()), std::vector<float>(grid.size())};
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const double e = east[cell], n = north[cell], square = e * e + n * n;
    if (!(square > least * least)) continue;
    out.cosine[cell] = static_cast<float>((e * e - n * n) / square);
    out.sine[cell] = static_cast<float>(2.0 * e * n / square);
  }
  return out;
}

Orientation level_lines(const Grid& grid, std::span<const float> field) {
  check_sizes("level_lines", grid.size(), {{"field", field.size()}});
  std::vector<float> east(grid.size()), north(grid.size());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) {
      const auto at = [&](int k) { return field[grid.neighbour(i, j, k)]; };
      const Index cell = grid.cell(i, j);
      // Along the level: the gradient turned by a right angle.
      north[cell] = static_cast<float>((at(kEast) - at(kWest)) / (2.0 * grid.spacing_east_m(j)));
      east[cell] = static_cast<float>(-(at(kNorth) - at(kSouth)) /
                                      (grid.distances_m(j)[kNorth] + grid.distances_m(j)[kSouth]));
    }
  }
  return orientation_of(grid, east, north, 0.0);
}

void smooth(const Grid& grid, Orientation& orientation, double length_m) {
  smooth(grid, std::span<float>(orientation.cosine), length_m);
  smooth(grid, std::span<float>(orientation.sine), length_m);
}

void add_oriented_noise(const Grid& grid, const Grid& on, const Orientation& crests,
                        const OrientedBand& band, double factor, std::uint64_t seed,
                        std::string_view stream, std::span<float> values) {
  if (grid.topology() != Topology::sphere || on.topology() != Topology::sphere) {
    throw InputError("oriented noise: the grid must be a whole sphere");
  }
  check_sizes("add_oriented_noise", grid.size(), {{"values", values.size()}});
  check_sizes("add_oriented_noise", on.size(),
              {{"cosine", crests.cosine.size()}, {"sine", crests.sine.size()}});
  const double seen = factor * shown(grid, band.wavelength_km);
  if (seen == 0.0) return;
  const double radius_km = 1e-3 * grid.figure().radius_m;
  const std::vector<Group> groups = draw_groups(on, crests, band, radius_km, seed, stream);
  // u and v are measured in the plane that touches the sphere: a little more on the sphere.
  const double reach =
      1.02 * std::asin(std::min(0.9, std::max(band.width_km, band.length_km) / radius_km));
  const RowBands bands(grid, groups.size(), reach, [&](std::size_t g) -> double {
    return std::asin(std::clamp(groups[g].centre[2], -1.0F, 1.0F));
  });
  const auto waves = static_cast<float>(band.width_km / band.wavelength_km);
  const CubicRows rows(on, grid);
  ParallelErrors errors;
#pragma omp parallel
  {
    auto made = errors.make<Row>(grid.nx());
    std::vector<float> scratch;
#pragma omp for schedule(dynamic, 1)
    for (std::size_t b = 0; b < bands.size(); ++b) {
      errors.guard([&] {
        Row& row = *made;
        for (int j = bands.begin(b); j < bands.end(b); ++j) {
          rows.read(crests.cosine, j, std::span<float>(row.crest[0]), scratch);
          rows.read(crests.sine, j, std::span<float>(row.crest[1]), scratch);
          row.stand_at(grid, j);
          const Parallel parallel(grid, j);
          for (const std::int32_t number : bands[b]) {
            each_span(parallel, groups[number], reach, [&](int first, int last) {
              add_group(row, groups[number], waves, first, last);
            });
          }
          for (int i = 0; i < grid.nx(); ++i) {
            values[grid.cell(i, j)] += static_cast<float>(seen * row.sum[i]);
          }
        }
      });
    }
  }
  errors.rethrow();
}

}  // namespace geo
