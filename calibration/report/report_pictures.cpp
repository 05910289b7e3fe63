#include "calibration/report/report_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/report/report_curves.hpp"
#include "calibration/report/report_markup.hpp"
#include "calibration/report/report_words.hpp"
#include "calibration/report/svg_picture.hpp"

namespace geo::calibration {
namespace {

using io::Hue;
using io::Series;
using io::Stroke;

std::vector<std::string> numbered_names(const Result& result) {
  std::vector<std::string> names;
  for (const FittedParameter& parameter : result.parameters) {
    names.push_back(fmt::format("{}  {}", parameter.name, names.size() + 1));
  }
  return names;
}

/// Misfit of each bin of the curve in units of its deviation.
Series residual_series(const Result& result, double Residual::*value, Series series) {
  for (const Residual& residual : result.residuals) {
    if (!std::isfinite(residual.share)) continue;
    series.x.push_back(100.0 * (1.0 - residual.share));
    series.y.push_back((residual.*value - residual.target) / residual.deviation);
  }
  return series;
}

int best_start(const Result& result) {
  const auto best =
      std::min_element(result.starts.begin(), result.starts.end(),
                       [](const Start& a, const Start& b) { return a.cost < b.cost; });
  return static_cast<int>(best - result.starts.begin());
}

Series cost_of_start(const Result& result, int start, bool is_best) {
  Series series{"", {}, {}, is_best ? Hue::red : Hue::grey};
  if (is_best) series.name = "best start";
  for (const Iteration& iteration : result.iterations) {
    if (iteration.start != start) continue;
    series.x.push_back(iteration.number);
    series.y.push_back(iteration.cost);
  }
  return series;
}

/// An upright line across the whole panel.
Series upright(double x, const io::Axis& y) {
  return {"", {x, x}, {y.low, y.high}, Hue::grey, Stroke::dashed};
}

io::Chart profile_chart(const Result& result, const Profile& profile) {
  const auto parameter =
      std::find_if(result.parameters.begin(), result.parameters.end(),
                   [&](const FittedParameter& each) { return each.name == profile.name; });
  const bool is_parameter = parameter != result.parameters.end();
  const bool logarithmic = is_parameter && parameter->logarithmic;
  const bool has_unit = is_parameter && parameter->units != "1";
  io::ChartPanel panel;
  panel.x = io::axis_over(has_unit ? parameter->units : "", {profile.value}, logarithmic);
  panel.y = io::axis_over("cost", {profile.cost});
  if (is_parameter && std::isfinite(parameter->standard_error)) {
    for (const double side : {-1.0, 1.0}) {
      panel.series.push_back(
          upright(parameter->fitted + side * parameter->standard_error, panel.y));
    }
  }
  panel.series.push_back({"", profile.value, profile.cost, Hue::blue});
  panel.series.push_back({"", profile.value, profile.cost, Hue::blue, Stroke::dots});
  return {"Profile of " + profile.name, {}, {panel}};
}

}  // namespace

void add_curve_picture(pugi::xml_node section, const Result& result) {
  auto figure = add_figure(section, "Hypsometry.",
                           "Above: elevation of the mean curve over the fitted seeds. Below: its "
                           "distance to the target.");
  draw_chart(figure, curves_chart(result), kWideChart);
}

void add_residual_picture(pugi::xml_node section, const Result& result) {
  const Series before =
      residual_series(result, &Residual::before, {"before", {}, {}, Hue::grey, Stroke::dashed});
  const Series after = residual_series(result, &Residual::after, {"after", {}, {}, Hue::red});
  if (before.x.empty()) return;
  io::ChartPanel panel;
  panel.x = area_axis(result.target);
  panel.y = io::axis_over("deviations", {before.y, after.y, {0.0}});
  panel.series = {before, after};
  panel.levels = {{0.0, ""}};
  panel.height = 0.8;
  auto figure = add_figure(section, "Residuals of the curve.",
                           "Planet less target in each bin, in units of the deviation that the "
                           "fit gives that bin.");
  draw_chart(figure, {"Residuals of the curve", {}, {panel}}, kWideChart);
}

void add_convergence_picture(pugi::xml_node section, const Result& result) {
  if (result.iterations.empty()) return;
  const int best = best_start(result);
  int starts = 0;
  for (const Iteration& iteration : result.iterations) {
    starts = std::max(starts, iteration.start + 1);
  }
  io::ChartPanel panel;
  panel.height = 0.8;
  for (int start = 0; start < starts; ++start) {
    if (start != best) panel.series.push_back(cost_of_start(result, start, false));
  }
  if (!panel.series.empty()) panel.series.front().name = "other starts";
  panel.series.push_back(cost_of_start(result, best, true));
  Series rejected{"step not kept", {}, {}, Hue::ink, Stroke::dots};
  std::vector<std::vector<double>> steps, costs;
  for (const Iteration& iteration : result.iterations) {
    steps.push_back({static_cast<double>(iteration.number)});
    costs.push_back({iteration.cost});
    if (iteration.accepted) continue;
    rejected.x.push_back(iteration.number);
    rejected.y.push_back(iteration.cost);
  }
  if (!rejected.x.empty()) panel.series.push_back(rejected);
  panel.x = io::axis_over("step", steps);
  panel.y = io::axis_over("cost", costs, true);
  auto figure = add_figure(section, "Convergence.",
                           "Half the sum of squares after each step, with drainage rerouted.");
  draw_chart(figure, {"Convergence", {}, {panel}}, kWideChart);
}

void add_correlation_picture(pugi::xml_node section, const Result& result) {
  auto figure = add_figure(section, "Correlations.",
                           "Of the errors of the parameters: near 1 or −1, the data know the two "
                           "only together. Columns are numbered as the rows.");
  draw_matrix(figure, "Correlations of the parameters", numbered_names(result), result.correlation);
}

void add_direction_picture(pugi::xml_node section, const Result& result) {
  std::vector<std::string> rows;
  std::vector<std::vector<double>> weights;
  for (std::size_t p = 0; p < result.parameters.size(); ++p) {
    rows.push_back(result.parameters[p].name);
    weights.emplace_back();
    for (const Direction& direction : result.directions) {
      weights.back().push_back(direction.weights[p]);
    }
  }
  auto figure = add_figure(section, "Weights of the directions.",
                           "One column each, the best determined first.");
  draw_matrix(figure, "Weights of the directions", rows, weights);
}

void add_profile_pictures(pugi::xml_node section, const Result& result) {
  auto pictures = add(section, "div", {}, {{"class", "pictures"}});
  for (const Profile& profile : result.profiles) {
    if (profile.value.empty()) continue;
    auto figure = add_figure(pictures, profile.name, "");
    draw_chart(figure, profile_chart(result, profile), kSmallChart);
  }
}

}  // namespace geo::calibration
