#include "calibration/report/report_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geo/io/drawing/chart.hpp"

namespace geo::calibration {
namespace {

/// Weights below this say little about a combination of unit length.
constexpr double kLightWeight = 0.15;
/// From this weight on, a direction is one parameter rather than a combination.
constexpr double kHeavyWeight = 0.95;

/// Positions of the weights, the heaviest first.
std::vector<std::size_t> by_weight(const Direction& direction) {
  std::vector<std::size_t> order(direction.weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(direction.weights[a]) > std::abs(direction.weights[b]);
  });
  return order;
}

}  // namespace

std::string shown(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  const double size = std::abs(value);
  std::string text;
  if (size != 0.0 && (size < 1e-3 || size >= 1e6)) {
    const double power = std::pow(10.0, std::floor(std::log10(size)) - digits + 1);
    return io::tick_label(std::round(value / power) * power);
  }
  const int before_point = size == 0.0 ? 1 : static_cast<int>(std::floor(std::log10(size))) + 1;
  text = fmt::format("{:.{}f}", size, std::clamp(digits - before_point, 0, 8));
  return (value < 0.0 && text.find_first_not_of("0.") != std::string::npos ? "\u2212" : "") + text;
}

std::string sentence(std::string text) {
  if (text.empty()) return text;
  // A name of a parameter keeps its letters.
  const bool is_word = text.substr(0, text.find(' ')).find('.') == std::string::npos;
  if (is_word && text.front() >= 'a' && text.front() <= 'z') {
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  }
  if (text.back() != '.') text += '.';
  return text;
}

std::string seeds_in_words(const std::vector<SeedMisfit>& seeds) {
  std::string words;
  for (std::size_t i = 0; i < seeds.size();) {
    std::size_t last = i;
    while (last + 1 < seeds.size() && seeds[last + 1].seed - 1 == seeds[last].seed) ++last;
    if (!words.empty()) words += ", ";
    words += fmt::format("{}", seeds[i].seed);
    if (last > i) words += fmt::format("{}{}", last > i + 1 ? " to " : ", ", seeds[last].seed);
    i = last + 1;
  }
  return words;
}

std::string combination_in_words(const Direction& direction,
                                 const std::vector<FittedParameter>& parameters) {
  std::string words;
  for (const std::size_t at : by_weight(direction)) {
    const double weight = direction.weights[at];
    if (std::abs(weight) < kLightWeight && !words.empty()) break;
    words += fmt::format("{}{} {} ({})", words.empty() ? "" : " with ", parameters[at].name,
                         weight < 0.0 ? "down" : "up", shown(weight, 2));
  }
  return words;
}

std::string weakest_in_words(const Result& result) {
  if (result.directions.empty() || result.parameters.empty()) return {};
  const Direction& weakest = result.directions.back();
  const std::size_t heaviest = by_weight(weakest).front();
  const bool alone = std::abs(weakest.weights[heaviest]) >= kHeavyWeight;
  std::string words = fmt::format(
      "The data say least about {}: ",
      alone ? result.parameters[heaviest].name : combination_in_words(weakest, result.parameters));
  words += alone ? "moving it hardly changes what is fitted. "
                 : "moved together like this, their effects nearly cancel. ";
  if (weakest.singular_value > 0.0 && std::isfinite(result.condition)) {
    words += fmt::format(
        "A step along it changes the misfit {} times less than the same step along the best "
        "determined direction.",
        shown(result.condition));
  } else {
    words += "A small step along it changes nothing at all: it cannot be found from this target.";
  }
  return words;
}

double spread(const std::vector<SeedMisfit>& seeds, double SeedMisfit::*figure) {
  if (seeds.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0, squares = 0.0;
  for (const SeedMisfit& seed : seeds) sum += seed.*figure;
  const double mean = sum / static_cast<double>(seeds.size());
  for (const SeedMisfit& seed : seeds) squares += std::pow(seed.*figure - mean, 2);
  return std::sqrt(squares / static_cast<double>(seeds.size() - 1));
}

}  // namespace geo::calibration
