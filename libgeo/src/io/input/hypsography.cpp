#include "geo/io/input/hypsography.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/io/files/embedded_data.hpp"

namespace geo::io {
namespace {

/// Share of the mixture of two normal distributions below an elevation.
double mixture_below(double elevation_m) {
  const auto normal = [&](double mean, double deviation) {
    return 0.5 * std::erfc((mean - elevation_m) / (deviation * std::numbers::sqrt2));
  };
  return 0.71 * normal(-4019.0, 1113.0) + 0.29 * normal(797.0, 1169.0);
}

Hypsography statistical_earth() {
  constexpr int kSteps = 2000;
  constexpr double kDeepest_m = -9000.0, kHighest_m = 6500.0;
  const double least = mixture_below(kDeepest_m), most = mixture_below(kHighest_m);
  Hypsography curve;
  for (int k = 0; k <= kSteps; ++k) {
    const double elevation_m = kDeepest_m + (kHighest_m - kDeepest_m) * k / kSteps;
    curve.elevation_m.push_back(elevation_m);
    curve.fraction.push_back((mixture_below(elevation_m) - least) / (most - least));
  }
  return curve;
}

Hypsography curve_of(const Table& table) {
  if (!table.has_columns({"quantile", "elevation_m"})) {
    table.refuse_header("must begin with the line quantile,elevation_m");
  }
  Hypsography curve;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double fraction = table.number(row, 0), elevation_m = table.number(row, 1);
    if (row == 0 && fraction != 0.0) table.refuse(row, "the first quantile must be 0");
    if (row > 0 && !(fraction > curve.fraction.back())) table.refuse(row, "quantiles must ascend");
    // Also when the curve is moved by as much.
    if (!(std::abs(elevation_m) <= 0.5 * std::numeric_limits<float>::max())) {
      table.refuse(row, "an elevation is beyond single precision");
    }
    if (row > 0 && elevation_m < curve.elevation_m.back()) {
      table.refuse(row, "elevations must not fall");
    }
    curve.fraction.push_back(fraction);
    curve.elevation_m.push_back(elevation_m);
  }
  if (curve.fraction.size() < 2 || curve.fraction.back() != 1.0) {
    table.refuse(table.rows() - 1, "the last quantile must be 1");
  }
  return curve;
}

/// Share of the area below 0 m, and the first entry of the curve that is not.
struct Shore {
  double share;
  std::size_t entry;
};

Shore shore_of(const Hypsography& curve) {
  std::size_t at = 0;
  while (at < curve.elevation_m.size() && curve.elevation_m[at] < 0.0) ++at;
  if (at == 0) return {0.0, 0};
  if (at == curve.elevation_m.size()) return {1.0, at};
  const double low = curve.elevation_m[at - 1], high = curve.elevation_m[at];
  return {std::lerp(curve.fraction[at - 1], curve.fraction[at], -low / (high - low)), at};
}

/// Moves a curve up or down so that a share of the area lies below 0.
void move_shore(Hypsography& curve, double share) {
  const auto above = std::upper_bound(curve.fraction.begin() + 1, curve.fraction.end() - 1, share);
  const auto k = above - curve.fraction.begin();
  const double level_m =
      std::lerp(curve.elevation_m[k - 1], curve.elevation_m[k],
                (share - curve.fraction[k - 1]) / (curve.fraction[k] - curve.fraction[k - 1]));
  for (double& height_m : curve.elevation_m) height_m -= level_m;
}

}  // namespace

double ocean_share_of(const Hypsography& curve) { return shore_of(curve).share; }

Hypsography with_ocean_share(Hypsography curve, double share) {
  const auto [below, entry] = shore_of(curve);
  if (below <= 0.0 || below >= 1.0) {
    if (share != below) move_shore(curve, share);
    return curve;
  }
  Hypsography mixed;
  const auto add = [&](double fraction, double elevation_m) {
    if (!mixed.fraction.empty() && fraction <= mixed.fraction.back()) return;
    mixed.fraction.push_back(fraction);
    mixed.elevation_m.push_back(elevation_m);
  };
  for (std::size_t k = 0; k < entry && share > 0.0; ++k) {
    add(curve.fraction[k] / below * share, curve.elevation_m[k]);
  }
  add(share, 0.0);
  for (std::size_t k = entry; k < curve.fraction.size() && share < 1.0; ++k) {
    add(1.0 - (1.0 - curve.fraction[k]) / (1.0 - below) * (1.0 - share), curve.elevation_m[k]);
  }
  return mixed;
}

Hypsography read_hypsography(const std::string& name_or_file) {
  if (name_or_file == "earth") return curve_of(embedded_table("targets/earth.csv"));
  if (name_or_file == "earth-statistical") return statistical_earth();
  if (!std::filesystem::exists(name_or_file)) {
    throw InputError(fmt::format(
        "fields.hypsography: {}: no such file; must be earth, earth-statistical or a CSV file",
        name_or_file));
  }
  return curve_of(Table::of_file(name_or_file));
}

}  // namespace geo::io
