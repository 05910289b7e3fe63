#include "calibration/report/report_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/report/report_words.hpp"
#include "geo/core/error.hpp"

namespace geo::calibration {
namespace {

using io::Hue;
using io::Stroke;

/// The highest land on the left, as hypsographic curves are drawn.
std::vector<double> percent_higher(const Curve& curve) {
  std::vector<double> percent(curve.elevation_m.size());
  for (std::size_t k = 0; k < percent.size(); ++k) percent[k] = 100.0 * (1.0 - curve.share(k));
  return percent;
}

std::vector<double> distance_m(const Curve& curve, const Curve& target) {
  std::vector<double> distance(curve.elevation_m.size());
  for (std::size_t k = 0; k < distance.size(); ++k) {
    distance[k] = curve.elevation_m[k] - target.elevation_m[k];
  }
  return distance;
}

/// From and to round thousands, so that the ends of a curve stand free.
io::Axis elevation_axis(const Result& result) {
  double low = 0.0, high = 0.0;
  for (const Curve* curve : {&result.target, &result.before, &result.after}) {
    low = std::min(low, curve->elevation_m.front());
    high = std::max(high, curve->elevation_m.back());
  }
  const double span = high - low;
  const double step = span > 4000.0 ? 1000.0 : span > 400.0 ? 100.0 : 10.0;
  return {"elevation, m", std::floor(low / step - 0.2) * step, std::ceil(high / step + 0.2) * step};
}

std::vector<std::string> caption(const Result& result) {
  const Curve& target = result.target;
  const std::string where = target.is_whole()
                                ? ""
                                : fmt::format(" over quantiles {:.4g} to {:.4g}, which it tells of",
                                              target.share_from, target.share_to);
  std::vector<std::string> lines{fmt::format(
      "Wasserstein-1 distance of the mean curve to the target{}: {} m before, {} m after.", where,
      shown(curve_distance_m(result.before, result.target)),
      shown(curve_distance_m(result.after, result.target)))};
  std::string seeds =
      fmt::format("Mean over {} fitted seeds: {} m before, {} m after", result.fitted.size(),
                  shown(mean_before_m(result.fitted)), shown(mean_after_m(result.fitted)));
  if (!result.held_out.empty()) {
    seeds +=
        fmt::format("; over {} held-out seeds: {} m before, {} m after", result.held_out.size(),
                    shown(mean_before_m(result.held_out)), shown(mean_after_m(result.held_out)));
  }
  lines.push_back(seeds + ".");
  return lines;
}

}  // namespace

double curve_distance_m(const Curve& a, const Curve& b) {
  if (a.elevation_m.empty() || a.elevation_m.size() != b.elevation_m.size()) {
    throw Bug(fmt::format("curves of {} and {} bins cannot be compared", a.elevation_m.size(),
                          b.elevation_m.size()));
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < a.elevation_m.size(); ++k) {
    sum += std::abs(a.elevation_m[k] - b.elevation_m[k]);
  }
  return sum / static_cast<double>(a.elevation_m.size());
}

io::Axis area_axis(const Curve& target) {
  return {"% of the area lies higher", 100.0 * (1.0 - target.share_to),
          100.0 * (1.0 - target.share_from)};
}

std::string curves_csv(const Result& result) {
  std::string text = "quantile,target_m,before_m,after_m\n";
  for (std::size_t k = 0; k < result.target.elevation_m.size(); ++k) {
    text += fmt::format("{:.10g},{:.3f},{:.3f},{:.3f}\n", result.target.share(k),
                        result.target.elevation_m[k], result.before.elevation_m[k],
                        result.after.elevation_m[k]);
  }
  return text;
}

io::Chart curves_chart(const Result& result) {
  const auto percent = percent_higher(result.target);
  const io::Axis across = area_axis(result.target);
  const auto before = distance_m(result.before, result.target);
  const auto after = distance_m(result.after, result.target);
  const io::ChartPanel curves{
      across,
      elevation_axis(result),
      {{"target: " + result.target_name, percent, result.target.elevation_m, Hue::ink},
       {"before", percent, result.before.elevation_m, Hue::grey, Stroke::dashed},
       {"after", percent, result.after.elevation_m, Hue::red}},
      {{0.0, "sea level"}}};
  const io::ChartPanel distances{
      across,
      io::axis_over("planet \u2212 target, m", {before, after, {0.0}}),
      {{"", percent, before, Hue::grey, Stroke::dashed}, {"", percent, after, Hue::red}},
      {{0.0, ""}},
      0.42};
  return {"Hypsometry", caption(result), {curves, distances}};
}

}  // namespace geo::calibration
