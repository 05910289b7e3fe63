#include "geo/kernels/exemplar_detail.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/field.hpp"
#include "geo/core/projection.hpp"
#include "geo/core/random.hpp"
#include "geo/core/vector3.hpp"
#include "geo/kernels/smoothing.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegrees = 180.0 / kPi;
/// Radius of a primitive over the distance between primitives.
constexpr double kOverlap = 1.5;

struct Frame {
  Vector3 east, north;
};

Frame frame_at(const Vector3& unit) {
  const double across = std::hypot(unit[0], unit[1]);
  const Vector3 east =
      across > 0.0 ? Vector3{-unit[1] / across, unit[0] / across, 0.0} : Vector3{0.0, 1.0, 0.0};
  return {east, cross(unit, east)};
}

Centre position_of(const Vector3& unit) {
  return {kDegrees * std::asin(std::clamp(unit[2], -1.0, 1.0)),
          kDegrees * std::atan2(unit[1], unit[0])};
}

Index cell_at(const Grid& planet, const Vector3& unit) {
  const Centre at = position_of(unit);
  const auto column = static_cast<int>((at.longitude_deg / 360.0 + 0.5) * planet.nx());
  const auto row = static_cast<int>((at.latitude_deg / 180.0 + 0.5) * planet.ny());
  return planet.cell(std::clamp(column, 0, planet.nx() - 1), std::clamp(row, 0, planet.ny() - 1));
}

/// 5 x 5 places a cell apart about one, and what weight each has.
constexpr int kAcross = 5, kPlaces = kAcross * kAcross;
constexpr double weight_of(int place) {
  constexpr std::array<double, kAcross> kBinomial{1.0, 4.0, 6.0, 4.0, 1.0};
  return kBinomial[place % kAcross] * kBinomial[place / kAcross] / 256.0;
}

Terrain terrain_of(const TerrainGuide& guide, Index cell, double slope) {
  if (slope < guide.plain_slope) return Terrain::plain;
  const auto type = guide.orogeny_type.empty() ? OrogenyType::none
                                               : static_cast<OrogenyType>(guide.orogeny_type[cell]);
  if (type == OrogenyType::none) return Terrain::old_mountains;
  // Not a number where nothing was ever folded.
  if (!guide.orogeny_age_myr.empty() && !(guide.orogeny_age_myr[cell] < guide.old_myr)) {
    return Terrain::old_mountains;
  }
  return type == OrogenyType::andean ? Terrain::andean : Terrain::himalayan;
}

/// Sums of cos and sin of twice an angle, and of the weights.
struct Doubled {
  double cosine = 0.0, sine = 0.0, weight = 0.0;
  void add(double east, double north, double w) {
    cosine += w * (east * east - north * north);
    sine += w * 2.0 * east * north;
    weight += w * (east * east + north * north);
  }
  [[nodiscard]] double strength() const {
    return weight > 0.0 ? std::hypot(cosine, sine) / weight : 0.0;
  }
  [[nodiscard]] double angle() const { return 0.5 * std::atan2(sine, cosine); }
};

/// An exemplar ready for use: high-passed, evened out, on cells no finer than they are looked at.
struct Texture {
  Terrain terrain;
  int nx, ny;
  double cell_m;
  bool periodic;
  double cosine, sine;  ///< of its fold direction
  double roughness_m;   ///< its own, before it was evened out
  std::vector<float> values;

  [[nodiscard]] float at(int column, int row) const {
    return values[static_cast<std::size_t>(row) * nx + column];
  }
  /// Catmull-Rom at a place in m from the south-western corner.
  [[nodiscard]] double sample(double x_m, double y_m) const;
};

/// Four cells round a place and their weights.
struct Taps {
  Taps(double place, int cells, bool periodic) {
    const double whole = std::floor(place), t = place - whole;
    weight = {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + t * t * (-2.5 + 1.5 * t),
              0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
    const int first = static_cast<int>(whole) - 1;
    for (int k = 0; k < 4; ++k) {
      const int c = first + k;
      cell[k] = periodic ? ((c % cells) + cells) % cells : std::clamp(c, 0, cells - 1);
    }
  }
  std::array<double, 4> weight;
  std::array<int, 4> cell;
};

double Texture::sample(double x_m, double y_m) const {
  const Taps x(x_m / cell_m - 0.5, nx, periodic), y(y_m / cell_m - 0.5, ny, periodic);
  double sum = 0.0;
  for (int j = 0; j < 4; ++j) {
    const float* const row = values.data() + static_cast<std::size_t>(y.cell[j]) * nx;
    double along = 0.0;
    for (int i = 0; i < 4; ++i) along += x.weight[i] * row[x.cell[i]];
    sum += y.weight[j] * along;
  }
  return sum;
}

/// Means over squares of `times` cells; what is left over at the edges is dropped.
Exemplar coarser(const Exemplar& fine, int times) {
  Exemplar e = fine;
  e.nx = fine.nx / times;
  e.ny = fine.ny / times;
  e.cell_m = fine.cell_m * times;
  e.periodic = fine.periodic && fine.nx % times == 0 && fine.ny % times == 0;
  e.elevation_m.assign(static_cast<std::size_t>(e.nx) * e.ny, 0.0F);
  for (int j = 0; j < e.ny; ++j) {
    for (int i = 0; i < e.nx; ++i) {
      double sum = 0.0;
      for (int b = 0; b < times; ++b) {
        for (int a = 0; a < times; ++a) {
          sum +=
              fine.elevation_m[static_cast<std::size_t>(j * times + b) * fine.nx + i * times + a];
        }
      }
      e.elevation_m[static_cast<std::size_t>(j) * e.nx + i] =
          static_cast<float>(sum / (static_cast<double>(times) * times));
    }
  }
  return e;
}

/// Radius of the discs that pieces of a library have: what fits into each with room for chance.
double disc_radius_m(const ExemplarLibrary& library) {
  constexpr double kRoom = 0.3;
  double radius_m = 1e300;
  for (const Exemplar& e : library.exemplars) {
    radius_m = std::min(radius_m, kRoom * std::min(e.nx, e.ny) * e.cell_m);
  }
  return radius_m;
}

/// How often a cell of an exemplar goes into one of those it is looked at with.
int times_coarser(const Exemplar& e, double fine_cell_m) {
  return std::max(1, static_cast<int>(fine_cell_m / e.cell_m + 0.05));
}

double deviation_of(std::span<const float> values) {
  double sum = 0.0, squares = 0.0;
  for (const float value : values) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  const auto count = static_cast<double>(values.size());
  return std::sqrt(std::max(1e-30, squares / count - sum * sum / (count * count)));
}

/// The octaves of a relief from the longest wave of the band to what its cells show, each the
/// difference of two Gaussian blurs; a blur halves the power of waves of four deviations.
std::vector<std::vector<float>> octaves_of(const Grid& grid, std::span<const float> z,
                                           double longest_m) {
  const double shortest_m = 2.5 * grid.spacing_east_m(0);
  std::vector<std::vector<float>> octaves;
  std::vector<float> low(z.begin(), z.end());
  smooth(grid, std::span<float>(low), 0.25 * longest_m);
  for (double wave_m = 0.5 * longest_m; !low.empty(); wave_m *= 0.5) {
    std::vector<float> higher(z.begin(), z.end());
    const bool last = wave_m < shortest_m;
    if (!last) smooth(grid, std::span<float>(higher), 0.25 * wave_m);
    std::vector<float> octave(z.size());
    for (std::size_t c = 0; c < z.size(); ++c) octave[c] = higher[c] - low[c];
    octaves.push_back(std::move(octave));
    low = last ? std::vector<float>{} : std::move(higher);
  }
  return octaves;
}

/// Sum of octaves whose deviations fall with the Hurst exponent.
std::vector<float> self_affine(const std::vector<std::vector<float>>& octaves, double hurst) {
  constexpr double kMost = 4.0;
  std::vector<double> excess;  // logarithms
  double mean = 0.0;
  for (std::size_t k = 0; k < octaves.size(); ++k) {
    excess.push_back(std::log(deviation_of(octaves[k])) +
                     hurst * static_cast<double>(k) * std::numbers::ln2);
    mean += excess.back() / static_cast<double>(octaves.size());
  }
  std::vector<float> sum(octaves.front().size());
  for (std::size_t k = 0; k < octaves.size(); ++k) {
    const auto factor =
        static_cast<float>(std::clamp(std::exp(mean - excess[k]), 1.0 / kMost, kMost));
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += factor * octaves[k][c];
  }
  return sum;
}

/// Forelands are not to leave holes in mountains: most of the variance is evened out.
void even_out(const Grid& grid, double longest_m, std::vector<float>& z) {
  constexpr double kEven = 0.75;
  const double variance = std::pow(deviation_of(z), 2.0);
  std::vector<float> local(z.size());
  for (std::size_t c = 0; c < z.size(); ++c) local[c] = z[c] * z[c];
  smooth(grid, std::span<float>(local), 0.4 * longest_m);
  double sum = 0.0;
  for (std::size_t c = 0; c < z.size(); ++c) {
    const double around = (1.0 - kEven) * variance + kEven * std::max(0.0F, local[c]);
    z[c] = static_cast<float>(z[c] / std::sqrt(around));
    sum += z[c];
  }
  const double mean = sum / static_cast<double>(z.size()), deviation = deviation_of(z);
  for (float& value : z) value = static_cast<float>((value - mean) / deviation);
}

Texture texture_of(const Exemplar& exemplar, const ExemplarBand& band, double fine_cell_m) {
  const int times = times_coarser(exemplar, fine_cell_m);
  const Exemplar e = times > 1 ? coarser(exemplar, times) : exemplar;
  const Grid grid = e.grid();
  const auto octaves = octaves_of(grid, e.elevation_m, band.longest_m);
  std::vector<float> all(e.elevation_m.size());
  for (const auto& octave : octaves) {
    for (std::size_t c = 0; c < all.size(); ++c) all[c] += octave[c];
  }
  Texture texture{e.terrain,
                  e.nx,
                  e.ny,
                  e.cell_m,
                  e.periodic,
                  std::cos(e.fold_rad),
                  std::sin(e.fold_rad),
                  deviation_of(all),
                  self_affine(octaves, band.hurst)};
  even_out(grid, band.longest_m, texture.values);
  return texture;
}

/// A disc of relief in the plane that touches the sphere at its centre.
struct Primitive {
  double x_m, y_m;   ///< of its centre on the fine grid's map
  Vector3 centre;    ///< unit vector
  Vector3 u_m, v_m;  ///< along and across its piece's rows, times the planet's radius
  const Texture* texture;
  double origin_x_m, origin_y_m;  ///< of its centre in the exemplar
};

/// Of the textures, one for a place: terrain by share, exemplar by likeness of roughness.
const Texture& choose(std::span<const Texture> textures, const LocalTerrain& local,
                      double by_terrain, double by_likeness) {
  const auto has = [&](Terrain terrain) {
    return std::any_of(textures.begin(), textures.end(),
                       [&](const Texture& t) { return t.terrain == terrain; });
  };
  std::array<double, kTerrains> share = local.share;
  double whole = 0.0;
  for (int t = 0; t < kTerrains; ++t) {
    if (!has(static_cast<Terrain>(t))) share[t] = 0.0;
    whole += share[t];
  }
  double left = by_terrain * whole;
  int terrain = -1;
  for (int t = 0; t < kTerrains && whole > 0.0; ++t) {
    if (share[t] <= 0.0) continue;
    terrain = t;
    left -= share[t];
    if (left < 0.0) break;
  }
  // Twofold roughness is one deviation of likeness.
  constexpr double kAlike = 0.7;
  std::vector<double> chance(textures.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < textures.size(); ++k) {
    if (terrain >= 0 && textures[k].terrain != static_cast<Terrain>(terrain)) continue;
    const double ratio =
        std::log(std::max(1.0, local.roughness_m) / std::max(1.0, textures[k].roughness_m));
    chance[k] = 0.05 + std::exp(-0.5 * ratio * ratio / (kAlike * kAlike));
    sum += chance[k];
  }
  left = by_likeness * sum;
  std::size_t chosen = 0;
  for (std::size_t k = 0; k < textures.size(); ++k) {
    if (chance[k] <= 0.0) continue;
    chosen = k;
    left -= chance[k];
    if (left < 0.0) break;
  }
  return textures[chosen];
}

/// Primitives whose discs may touch the fine grid, in the order of the lattice.
std::vector<Primitive> place_primitives(const Grid& planet, const TerrainGuide& guide,
                                        const Grid& fine, std::span<const Texture> textures,
                                        const ExemplarBand& band, double radius_m,
                                        std::uint64_t seed) {
  const double planet_m = fine.figure().radius_m, apart_m = radius_m / kOverlap;
  const double hexagon_sr = 0.5 * std::sqrt(3.0) * std::pow(apart_m / planet_m, 2.0);
  const auto points = static_cast<std::int64_t>(std::clamp(4.0 * kPi / hexagon_sr, 64.0, 4e9));
  const RandomStream random(seed, "exemplars");
  const EqualAreaProjection projection(*fine.centre(), fine.figure());
  const double half_x_m = 0.5 * fine.nx() * fine.spacing_east_m(0) + radius_m;
  const double half_y_m = 0.5 * fine.ny() * fine.step_north_m() + radius_m;

  // Points follow each other from north to south.
  const double reach_deg =
      std::min(180.0, kDegrees * 1.2 * (std::hypot(half_x_m, half_y_m) + radius_m) / planet_m);
  const auto index_at = [&](double latitude_deg) {
    const double z = std::sin(std::clamp(latitude_deg, -90.0, 90.0) / kDegrees);
    return static_cast<std::int64_t>(0.5 * (1.0 - z) * static_cast<double>(points));
  };
  const double latitude_deg = fine.centre()->latitude_deg;
  const std::int64_t first = std::max<std::int64_t>(0, index_at(latitude_deg + reach_deg));
  const std::int64_t last = std::min(points - 1, index_at(latitude_deg - reach_deg));

  std::vector<Primitive> primitives;
  for (std::int64_t k = first; k <= last; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / static_cast<double>(points);
    const double turns = static_cast<double>(k) / std::numbers::phi;
    const double longitude = 2.0 * kPi * (turns - std::floor(turns)), ring = std::sqrt(1.0 - z * z);
    const Vector3 lattice{ring * std::cos(longitude), ring * std::sin(longitude), z};
    // Too far from the grid even when shifted?
    const auto near = projection.project(position_of(lattice));
    if (!(std::abs(near[0]) < half_x_m + apart_m && std::abs(near[1]) < half_y_m + apart_m)) {
      continue;
    }
    const Vector3 centre =
        normalised(add(lattice, random.direction(number), 0.5 * apart_m / planet_m));
    const auto [x_m, y_m] = projection.project(position_of(centre));
    if (std::abs(x_m) > half_x_m || std::abs(y_m) > half_y_m) continue;

    const LocalTerrain local = look_around(planet, guide, centre, band.spacing_m);
    const Texture& texture =
        choose(textures, local, random.uniform(number, 1), random.uniform(number, 2));
    const Frame frame = frame_at(centre);
    // Turned to the fold, half of them the other way round and half of them mirrored.
    const double angle = local.fold_rad + (random.uniform(number, 3) < 0.5 ? 0.0 : kPi);
    const Vector3 along = add(scaled(frame.east, std::cos(angle)), frame.north, std::sin(angle));
    const double hand = random.uniform(number, 4) < 0.5 ? 1.0 : -1.0;
    const Vector3 across = scaled(cross(centre, along), hand);
    // The exemplar's own axes, so that its fold lies along `along`.
    const Vector3 u = add(scaled(along, texture.cosine), across, -texture.sine);
    const Vector3 v = add(scaled(along, texture.sine), across, texture.cosine);
    const auto shift = [&](int cells, std::uint64_t which) {
      const double extent_m = cells * texture.cell_m;
      const double margin_m = texture.periodic ? 0.0 : std::min(radius_m, 0.5 * extent_m);
      return random.uniform(number, which, margin_m, extent_m - margin_m);
    };
    primitives.push_back({x_m, y_m, centre, scaled(u, planet_m), scaled(v, planet_m), &texture,
                          shift(texture.nx, 5), shift(texture.ny, 6)});
  }
  return primitives;
}

}  // namespace

LocalTerrain look_around(const Grid& planet, const TerrainGuide& guide, const Vector3& unit,
                         double spacing_m) {
  const Frame frame = frame_at(unit);
  const double step = spacing_m / planet.figure().radius_m;
  std::array<Index, kPlaces> cell;
  std::array<double, kPlaces> z;
  for (int k = 0; k < kPlaces; ++k) {
    const double east = step * (k % kAcross - kAcross / 2);
    const double north = step * (k / kAcross - kAcross / 2);
    cell[k] = cell_at(planet, normalised(add(add(unit, frame.east, east), frame.north, north)));
    z[k] = std::max(0.0, static_cast<double>(guide.elevation_m[cell[k]]));
  }
  Doubled level, folds;
  double bumps = 0.0, slopes = 0.0, weights = 0.0;
  for (int j = 1; j + 1 < kAcross; ++j) {
    for (int i = 1; i + 1 < kAcross; ++i) {
      const int k = j * kAcross + i;
      const double w = weight_of(k);
      const double gx = (z[k + 1] - z[k - 1]) / (2.0 * spacing_m);
      const double gy = (z[k + kAcross] - z[k - kAcross]) / (2.0 * spacing_m);
      const double bump_x = z[k] - 0.5 * (z[k + 1] + z[k - 1]);
      const double bump_y = z[k] - 0.5 * (z[k + kAcross] + z[k - kAcross]);
      level.add(-gy, gx, w);
      slopes += w * (gx * gx + gy * gy);
      bumps += w * 0.5 * (bump_x * bump_x + bump_y * bump_y);
      weights += w;
    }
  }
  LocalTerrain local;
  local.roughness_m = std::sqrt(bumps / weights);
  const double slope = std::sqrt(slopes / weights);
  const bool given = !guide.fold_east.empty() && !guide.fold_north.empty();
  for (int k = 0; k < kPlaces; ++k) {
    const double w = weight_of(k);
    local.share[static_cast<std::size_t>(terrain_of(guide, cell[k], slope))] += w;
    if (!given) continue;
    const double east = guide.fold_east[cell[k]], north = guide.fold_north[cell[k]];
    // East and north of the cell, seen from here: they turn near the poles.
    const Centre there = planet.position(planet.column(cell[k]), planet.row(cell[k]));
    const double longitude = there.longitude_deg / kDegrees,
                 latitude = there.latitude_deg / kDegrees;
    const Frame other = frame_at({std::cos(latitude) * std::cos(longitude),
                                  std::cos(latitude) * std::sin(longitude), std::sin(latitude)});
    const Vector3 fold = add(scaled(other.east, east), other.north, north);
    folds.add(dot(fold, frame.east), dot(fold, frame.north), w);
  }
  constexpr double kSure = 0.3, kFolded = 0.05;
  const bool sure = folds.weight > kFolded && folds.strength() > kSure;
  local.fold_rad = sure ? folds.angle() : level.angle();
  return local;
}

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
  if (library.exemplars.empty()) throw InputError("there is no exemplar");
  if (!fine.is_projected() || !fine.centre()) {
    throw InputError("exemplars need a plane that knows its place");
  }
  std::vector<Texture> textures;
  for (const Exemplar& e : library.exemplars) {
    textures.push_back(texture_of(e, band, fine.spacing_east_m(0)));
  }
  const double radius_m = disc_radius_m(library), apart_m = radius_m / kOverlap;
  const std::vector<Primitive> primitives =
      place_primitives(planet, guide, fine, textures, band, radius_m, seed);
  // The map stretches lengths a little.
  constexpr double kStretch = 1.02;
#pragma omp parallel
  {
    std::vector<double> sum(fine.nx()), squares(fine.nx());
    std::vector<Vector3> unit(fine.nx());
#pragma omp for schedule(dynamic, 4)
    for (int j = 0; j < fine.ny(); ++j) {
      std::fill(sum.begin(), sum.end(), 0.0);
      std::fill(squares.begin(), squares.end(), 0.0);
      for (int i = 0; i < fine.nx(); ++i) {
        const Centre at = fine.position(i, j);
        const double latitude = at.latitude_deg / kDegrees, longitude = at.longitude_deg / kDegrees;
        unit[i] = {std::cos(latitude) * std::cos(longitude),
                   std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
      }
      for (const Primitive& p : primitives) {
        const double dy_m = fine.y_m(j) - p.y_m;
        const double chord2 = kStretch * kStretch * radius_m * radius_m - dy_m * dy_m;
        if (chord2 <= 0.0) continue;
        const double reach = std::sqrt(chord2) / fine.spacing_east_m(0);
        const double middle = p.x_m / fine.spacing_east_m(0) + 0.5 * fine.nx() - 0.5;
        const int begin = std::max(0, static_cast<int>(std::ceil(middle - reach)));
        const int end = std::min(fine.nx() - 1, static_cast<int>(std::floor(middle + reach)));
        for (int i = begin; i <= end; ++i) {
          const Vector3 away = add(unit[i], p.centre, -1.0);
          const double u = dot(away, p.u_m), v = dot(away, p.v_m);
          const double r2 = u * u + v * v, inside = 1.0 - r2 / (radius_m * radius_m);
          if (inside <= 0.0) continue;
          const double w = inside * inside * std::exp(-4.0 * r2 / (apart_m * apart_m));
          sum[i] += w * p.texture->sample(p.origin_x_m + u, p.origin_y_m + v);
          squares[i] += w * w;
        }
      }
      for (int i = 0; i < fine.nx(); ++i) {
        detail[fine.cell(i, j)] =
            squares[i] > 0.0 ? static_cast<float>(sum[i] / std::sqrt(squares[i])) : 0.0F;
      }
    }
  }
}

}  // namespace geo
