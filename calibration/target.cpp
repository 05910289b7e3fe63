#include "calibration/target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "calibration/ranking.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config.hpp"
#include "geo/io/dem.hpp"
#include "geo/io/hypsography.hpp"

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

/// A curve at the middles of equal parts; `at(share)` gives its elevation.
template <class At>
Target sampled(std::string name, const Accuracy& accuracy, std::vector<double> fine, At&& at) {
  Target target{std::move(name), middles(accuracy.bins), {}, {}, std::move(fine)};
  for (const double share : target.share) {
    target.elevation_m.push_back(at(share));
    const double half = std::min({accuracy.share, share, 1.0 - share});
    const double slope_m = (at(share + half) - at(share - half)) / (2.0 * half);
    target.deviation_m.push_back(std::hypot(accuracy.deviation_m, accuracy.share * slope_m));
  }
  return target;
}
Target sampled(std::string name, const Accuracy& accuracy, const PiecewiseCurve& curve) {
  return sampled(std::move(name), accuracy, fine_bins(curve),
                 [&](double share) { return curve.at(share); });
}

/// Rows of numbers under a header line.
class Table {
 public:
  explicit Table(const std::string& path) : path_(path) {
    const std::string text = io::read_text(path);
    std::string_view rest = text;
    int number = 0;
    while (!rest.empty()) {
      ++number;
      const auto end = rest.find('\n');
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
      if (line.empty() || line.front() == '#') continue;
      if (header_.empty()) {
        header_ = line;
      } else {
        rows_.push_back(numbers(line, number));
        lines_.push_back(number);
      }
    }
  }
  [[nodiscard]] const std::string& header() const { return header_; }
  [[nodiscard]] const std::vector<std::vector<double>>& rows() const { return rows_; }
  [[noreturn]] void refuse(std::size_t row, std::string_view what) const {
    throw InputError(fmt::format("{}:{}: {}", path_, row < lines_.size() ? lines_[row] : 1, what));
  }
  void check_columns(std::size_t columns) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (rows_[r].size() != columns) refuse(r, fmt::format("must be {} numbers", columns));
    }
    if (rows_.size() < 2) refuse(lines_.size(), "must hold two rows of numbers at least");
  }

 private:
  [[nodiscard]] std::vector<double> numbers(std::string_view line, int number) const {
    std::vector<double> values;
    while (true) {
      while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
      double value = 0.0;
      const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), value);
      if (error != std::errc() || !std::isfinite(value)) {
        throw InputError(fmt::format("{}:{}: must be numbers with commas between", path_, number));
      }
      values.push_back(value);
      line.remove_prefix(stop - line.data());
      while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
      if (line.empty()) return values;
      if (line.front() != ',') {
        throw InputError(fmt::format("{}:{}: must be numbers with commas between", path_, number));
      }
      line.remove_prefix(1);
    }
  }

  std::string path_, header_;
  std::vector<std::vector<double>> rows_;
  std::vector<int> lines_;
};

Target from_quantiles(const Table& table, const std::string& path, bool with_deviation) {
  table.check_columns(with_deviation ? 3 : 2);
  PiecewiseCurve curve;
  Target target;
  target.name = path;
  const auto& rows = table.rows();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double share = rows[r][0], elevation_m = rows[r][1];
    if (!(share >= 0.0 && share <= 1.0)) table.refuse(r, "a quantile must be within [0, 1]");
    if (r > 0 && !(share > rows[r - 1][0])) table.refuse(r, "quantiles must ascend");
    curve.share.push_back(share);
    curve.elevation_m.push_back(elevation_m);
    if (with_deviation && !(rows[r][2] > 0.0)) table.refuse(r, "sigma_m must be positive");
    if (share == 0.0 || share == 1.0) continue;
    target.share.push_back(share);
    target.elevation_m.push_back(elevation_m);
    if (with_deviation) target.deviation_m.push_back(rows[r][2]);
  }
  if (target.share.empty()) table.refuse(0, "must hold a quantile between 0 and 1");
  if (curve.elevation_m.back() < curve.elevation_m.front()) {
    table.refuse(rows.size() - 1, "elevations must rise with the quantile");
  }
  target.fine_bin_m = fine_bins(curve);
  std::sort(target.fine_bin_m.begin(), target.fine_bin_m.end());
  return target;
}

Target from_bins(const Table& table, const std::string& path, const Accuracy& accuracy) {
  table.check_columns(3);
  PiecewiseCurve curve;
  double sum = 0.0;
  const auto& rows = table.rows();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double lower = rows[r][0], upper = rows[r][1], fraction = rows[r][2];
    if (!(upper > lower)) table.refuse(r, "upper_m must be above lower_m");
    if (r > 0 && std::abs(lower - rows[r - 1][1]) > 1e-6 * (std::abs(lower) + 1.0)) {
      table.refuse(r, "a bin must begin where the one before it ends");
    }
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
    table.refuse(rows.size() - 1, fmt::format("fractions sum to {:.6g}, must sum to 1", sum));
  }
  for (double& share : curve.share) share /= sum;
  return sampled(path, accuracy, curve);
}

Target from_any_table(const std::string& path, const Accuracy& accuracy) {
  const Table table(path);
  if (table.header() == "quantile,elevation_m") return from_quantiles(table, path, false);
  if (table.header() == "quantile,elevation_m,sigma_m") return from_quantiles(table, path, true);
  if (table.header() == "lower_m,upper_m,fraction") return from_bins(table, path, accuracy);
  throw InputError(
      fmt::format("{}:1: must be quantile,elevation_m or quantile,elevation_m,sigma_m or "
                  "lower_m,upper_m,fraction",
                  path));
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

Target from_relief(const std::string& file, const Planet& planet, const Grid& grid,
                   const Accuracy& accuracy) {
  io::Relief relief = io::read_relief(file, planet);
  const bool is_global = relief.grid.topology() == Topology::sphere;
  const bool is_finer = relief.grid.nx() > grid.nx() && relief.grid.ny() > grid.ny();
  const Grid& cells = is_global && is_finer ? grid : relief.grid;
  const std::vector<float> elevation_m =
      is_global && is_finer ? io::resample(relief, grid) : relief.elevation_m;
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
                    "NetCDF relief",
                    name));
  }
  return from_relief(name, planet, grid, accuracy);
}

}  // namespace geo::calibration
