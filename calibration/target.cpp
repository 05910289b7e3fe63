#include "calibration/target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

#include "calibration/ranking.hpp"
#include "geo/core/error.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/input/hypsography.hpp"
#include "geo/io/input/table.hpp"

namespace geo::calibration {
namespace {

/// A curve through points, linear between them and flat beyond.
struct PiecewiseCurve {
  std::vector<double> share, elevation_m;

  [[nodiscard]] double at(double where) const {
    const auto above = std::lower_bound(share.begin(), share.end(), where);
    if (above == share.begin()) return elevation_m.front();
    if (above == share.end()) return elevation_m.back();
    const auto k = above - share.begin();
    const double t = (where - share[k - 1]) / (share[k] - share[k - 1]);
    return elevation_m[k - 1] + t * (elevation_m[k] - elevation_m[k - 1]);
  }
};

std::vector<double> middles(int bins) {
  std::vector<double> share(bins);
  for (int k = 0; k < bins; ++k) share[k] = (k + 0.5) / bins;
  return share;
}

/// Means of the fine bins, by eight points in each.
std::vector<double> fine_bins(const PiecewiseCurve& curve) {
  constexpr int kPoints = 8;
  std::vector<double> means(kFineBins, 0.0);
  for (int k = 0; k < kFineBins; ++k) {
    for (int i = 0; i < kPoints; ++i) {
      means[k] += curve.at((k + (i + 0.5) / kPoints) / kFineBins) / kPoints;
    }
  }
  return means;
}

/// How exactly the quantiles of a curve are to be matched; `at(share)` gives its elevation.
template <class At>
void add_deviations(Target& target, const Accuracy& accuracy, At&& at) {
  for (const double share : target.share) {
    const double from = std::max(target.share_from, share - accuracy.share);
    const double to = std::min(target.share_to, share + accuracy.share);
    const double slope_m = to > from ? (at(to) - at(from)) / (to - from) : 0.0;
    target.deviation_m.push_back(std::hypot(accuracy.deviation_m, accuracy.share * slope_m));
  }
  if (accuracy.error_m > 0.0) target.error_m.assign(target.share.size(), accuracy.error_m);
}

/// A curve at the middles of equal parts.
template <class At>
Target sampled(std::string name, const Accuracy& accuracy, std::vector<double> fine, At&& at) {
  Target target{.name = std::move(name),
                .share = middles(accuracy.bins),
                .elevation_m = {},
                .deviation_m = {},
                .error_m = {},
                .fine_bin_m = std::move(fine)};
  for (const double share : target.share) target.elevation_m.push_back(at(share));
  add_deviations(target, accuracy, at);
  return target;
}
Target sampled(std::string name, const Accuracy& accuracy, const PiecewiseCurve& curve) {
  return sampled(std::move(name), accuracy, fine_bins(curve),
                 [&](double share) { return curve.at(share); });
}

void check_rows(const io::Table& table) {
  if (table.rows() < 2) table.refuse(table.rows(), "must hold two rows of numbers at least");
}

Target from_quantiles(const io::Table& table, const std::string& path, const Accuracy& accuracy,
                      bool has_errors) {
  check_rows(table);
  PiecewiseCurve curve;
  Target target;
  target.name = path;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const double share = table.number(r, 0), elevation_m = table.number(r, 1);
    if (!(share >= 0.0 && share <= 1.0)) table.refuse(r, "a quantile must be within [0, 1]");
    if (r > 0 && !(share > curve.share.back())) table.refuse(r, "quantiles must ascend");
    if (r > 0 && elevation_m < curve.elevation_m.back()) {
      table.refuse(r, "elevations must not fall where quantiles ascend");
    }
    curve.share.push_back(share);
    curve.elevation_m.push_back(elevation_m);
    const double error_m = has_errors ? table.number(r, 2) : 1.0;
    if (!(error_m > 0.0)) table.refuse(r, "sigma_m must be positive");
    if (share == 0.0 || share == 1.0) continue;
    target.share.push_back(share);
    target.elevation_m.push_back(elevation_m);
    if (has_errors) target.error_m.push_back(error_m);
  }
  if (target.share.empty()) table.refuse(0, "must hold a quantile between 0 and 1");
  target.share_from = curve.share.front();
  target.share_to = curve.share.back();
  target.fine_bin_m = fine_bins(curve);
  if (has_errors) {
    target.deviation_m = target.error_m;
  } else {
    add_deviations(target, accuracy, [&](double share) { return curve.at(share); });
  }
  return target;
}

Target from_bins(const io::Table& table, const std::string& path, const Accuracy& accuracy) {
  check_rows(table);
  PiecewiseCurve curve;
  double sum = 0.0, top_m = 0.0;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const double lower = table.number(r, 0), upper = table.number(r, 1),
                 fraction = table.number(r, 2);
    if (!(upper > lower)) table.refuse(r, "upper_m must be above lower_m");
    if (r > 0 && std::abs(lower - top_m) > 1e-6 * (std::abs(lower) + 1.0)) {
      table.refuse(r, "a bin must begin where the one before it ends");
    }
    top_m = upper;
    if (!(fraction >= 0.0)) table.refuse(r, "a fraction must not be negative");
    if (fraction == 0.0) continue;
    // Equal shares may not follow each other: the curve jumps over empty bins.
    curve.share.push_back(curve.share.empty() ? 0.0 : sum + 1e-12);
    curve.elevation_m.push_back(lower);
    sum += fraction;
    curve.share.push_back(sum);
    curve.elevation_m.push_back(upper);
  }
  if (std::abs(sum - 1.0) > 1e-3) {
    table.refuse(table.rows() - 1, fmt::format("fractions sum to {:.6g}, must sum to 1", sum));
  }
  for (double& share : curve.share) share /= sum;
  return sampled(path, accuracy, curve);
}

Target from_any_table(const std::string& path, const Accuracy& accuracy) {
  const io::Table table = io::Table::of_file(path);
  if (table.has_columns({"quantile", "elevation_m"})) {
    return from_quantiles(table, path, accuracy, false);
  }
  if (table.has_columns({"quantile", "elevation_m", "sigma_m"})) {
    return from_quantiles(table, path, accuracy, true);
  }
  if (table.has_columns({"lower_m", "upper_m", "fraction"})) {
    return from_bins(table, path, accuracy);
  }
  table.refuse_header(
      "must be quantile,elevation_m or quantile,elevation_m,sigma_m or lower_m,upper_m,fraction");
}

/// Heights that no solid planet holds up are a wrong unit or a damaged file.
Target from_table(const std::string& path, const Accuracy& accuracy) {
  Target target = from_any_table(path, accuracy);
  constexpr double kMost_m = 100e3;
  for (const auto* heights_m : {&target.elevation_m, &target.fine_bin_m}) {
    for (const double height_m : *heights_m) {
      if (std::abs(height_m) <= kMost_m) continue;
      throw InputError(fmt::format("{}: holds an elevation of {:g} m: must lie within {:g} m", path,
                                   height_m, kMost_m));
    }
  }
  return target;
}

Target from_dem(const std::string& file, const Planet& planet, const Grid& grid,
                const Accuracy& accuracy) {
  io::Dem dem = io::read_dem(file, planet);
  const bool is_global = dem.grid.topology() == Topology::sphere;
  const bool is_finer = dem.grid.nx() > grid.nx() && dem.grid.ny() > grid.ny();
  const Grid& cells = is_global && is_finer ? grid : dem.grid;
  const std::vector<float> elevation_m =
      is_global && is_finer ? io::resample(dem, grid) : dem.elevation_m;
  const std::vector<double> values(elevation_m.begin(), elevation_m.end());
  const Ranking ranking(cells, values);
  return sampled(file, accuracy, ranking.bin_means(kFineBins),
                 [&](double share) { return ranking.quantile(share); });
}

}  // namespace

Target read_target(const std::string& name, const Planet& planet, const Grid& grid,
                   const Accuracy& accuracy) {
  if (name == "earth" || name == "earth-statistical") {
    const Hypsography curve = io::read_hypsography(name);
    return sampled(name, accuracy, {curve.fraction, curve.elevation_m});
  }
  const auto dot = name.find_last_of('.');
  if (dot != std::string::npos && name.substr(dot) == ".csv") return from_table(name, accuracy);
  if (name.find('.') == std::string::npos && !std::filesystem::exists(name)) {
    throw InputError(
        fmt::format("--target {}: no such file; must be earth, earth-statistical, a CSV file or a "
                    "NetCDF DEM",
                    name));
  }
  return from_dem(name, planet, grid, accuracy);
}

int Target::first_bin() const {
  const int inner = static_cast<int>(std::ceil(share_from * kFineBins - 1e-6));
  const int end = static_cast<int>(std::floor(share_to * kFineBins + 1e-6));
  return inner < end ? inner : static_cast<int>(share_from * kFineBins);
}

int Target::end_bin() const {
  const int end = static_cast<int>(std::floor(share_to * kFineBins + 1e-6));
  return std::max(end, first_bin() + 1);
}

double wasserstein_m(std::span<const double> fine_bins, const Target& target) {
  double sum = 0.0;
  for (int k = target.first_bin(); k < target.end_bin(); ++k) {
    sum += std::abs(fine_bins[k] - target.fine_bin_m[k]);
  }
  return sum / (target.end_bin() - target.first_bin());
}

double spread_m(const std::vector<std::vector<double>>& fine_bins, const Target& target) {
  const auto planets = static_cast<double>(fine_bins.size());
  if (fine_bins.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (int k = target.first_bin(); k < target.end_bin(); ++k) {
    double mean = 0.0, squares = 0.0;
    for (const auto& of_planet : fine_bins) mean += of_planet[k] / planets;
    for (const auto& of_planet : fine_bins) squares += std::pow(of_planet[k] - mean, 2);
    sum += std::sqrt(squares / (planets - 1.0));
  }
  return sum / (target.end_bin() - target.first_bin());
}

}  // namespace geo::calibration
