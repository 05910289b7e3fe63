#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geo/core/field.hpp"
#include "geo/core/tangent_frame.hpp"
#include "geo/kernels/exemplars/exemplar_detail.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegrees = 180.0 / kPi;

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

/// The places about one, and the cells that they lie in.
struct Neighbourhood {
  TangentFrame frame;
  std::array<Index, kPlaces> cell;
  std::array<double, kPlaces> z_m;
};

Neighbourhood neighbourhood_of(const Grid& planet, const TerrainGuide& guide, const Vector3& unit,
                               double spacing_m) {
  Neighbourhood around;
  around.frame = tangent_frame(unit);
  const double step = spacing_m / planet.figure().radius_m;
  for (int k = 0; k < kPlaces; ++k) {
    const double east = step * (k % kAcross - kAcross / 2);
    const double north = step * (k / kAcross - kAcross / 2);
    around.cell[k] = cell_at(
        planet, normalised(add(add(unit, around.frame.east, east), around.frame.north, north)));
    around.z_m[k] = std::max(0.0, static_cast<double>(guide.elevation_m[around.cell[k]]));
  }
  return around;
}

/// How rough and steep the surface is, and along which direction it is level.
struct Shape {
  Doubled level;
  double roughness_m, slope;
};

Shape shape_of(const std::array<double, kPlaces>& z, double spacing_m) {
  Shape shape{};
  double bumps = 0.0, slopes = 0.0, weights = 0.0;
  for (int j = 1; j + 1 < kAcross; ++j) {
    for (int i = 1; i + 1 < kAcross; ++i) {
      const int k = j * kAcross + i;
      const double w = weight_of(k);
      const double gx = (z[k + 1] - z[k - 1]) / (2.0 * spacing_m);
      const double gy = (z[k + kAcross] - z[k - kAcross]) / (2.0 * spacing_m);
      const double bump_x = z[k] - 0.5 * (z[k + 1] + z[k - 1]);
      const double bump_y = z[k] - 0.5 * (z[k + kAcross] + z[k - kAcross]);
      shape.level.add(-gy, gx, w);
      slopes += w * (gx * gx + gy * gy);
      bumps += w * 0.5 * (bump_x * bump_x + bump_y * bump_y);
      weights += w;
    }
  }
  shape.roughness_m = std::sqrt(bumps / weights);
  shape.slope = std::sqrt(slopes / weights);
  return shape;
}

/// Directions of folds in those cells.
Doubled folds_of(const Grid& planet, const TerrainGuide& guide, const Neighbourhood& around) {
  Doubled folds;
  if (guide.fold_east.empty() || guide.fold_north.empty()) return folds;
  for (int k = 0; k < kPlaces; ++k) {
    const Index cell = around.cell[k];
    // East and north of the cell, seen from here: they turn near the poles.
    const Centre there = planet.position(planet.column(cell), planet.row(cell));
    const double longitude = there.longitude_deg / kDegrees,
                 latitude = there.latitude_deg / kDegrees;
    const TangentFrame other =
        tangent_frame({std::cos(latitude) * std::cos(longitude),
                       std::cos(latitude) * std::sin(longitude), std::sin(latitude)});
    const Vector3 fold =
        add(scaled(other.east, guide.fold_east[cell]), other.north, guide.fold_north[cell]);
    folds.add(dot(fold, around.frame.east), dot(fold, around.frame.north), weight_of(k));
  }
  return folds;
}

/// The direction along folds where they are sure, else that along which the surface is level.
double fold_direction_rad(const TerrainGuide& guide, const Doubled& folds, const Doubled& level) {
  constexpr double kSure = 0.3, kFolded = 0.05;
  if (!(folds.weight > kFolded && folds.strength() > kSure)) return level.angle();
  if (!(guide.level_weight > 0.0 && level.weight > 0.0)) return folds.angle();
  Doubled both = folds;
  const double weight = guide.level_weight * folds.weight / level.weight;
  both.cosine += weight * level.cosine;
  both.sine += weight * level.sine;
  return both.angle();
}

}  // namespace

LocalTerrain look_around(const Grid& planet, const TerrainGuide& guide, const Vector3& unit,
                         double spacing_m) {
  const Neighbourhood around = neighbourhood_of(planet, guide, unit, spacing_m);
  const Shape shape = shape_of(around.z_m, spacing_m);
  LocalTerrain local;
  local.roughness_m = shape.roughness_m;
  for (int k = 0; k < kPlaces; ++k) {
    const Terrain terrain = terrain_of(guide, around.cell[k], shape.slope);
    local.share[static_cast<std::size_t>(terrain)] += weight_of(k);
  }
  local.fold_rad = fold_direction_rad(guide, folds_of(planet, guide, around), shape.level);
  return local;
}

}  // namespace geo
