#include "geo/io/drawing/chart.hpp"

#include <algorithm>
#include <cmath>

#include "map_canvas.hpp"

namespace geo::io {
namespace {

/// 1, 2 and 5 times the powers of ten; only the powers where those alone are enough.
std::vector<double> logarithmic_ticks(double low, double high, int about) {
  const double first = std::floor(std::log10(low)), last = std::ceil(std::log10(high));
  const double decades = std::log10(high / low);
  const double every = std::max(1.0, std::round(decades / about));
  std::vector<double> values;
  for (double power = first; power <= last; power += every) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor > 1.0 && decades > 0.5 * about) continue;
      const double value = factor * std::pow(10.0, power);
      if (value >= low && value <= high) values.push_back(value);
    }
  }
  return values;
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `value`.
double round_up_nicely(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace

double Axis::position(double value) const {
  if (logarithmic) return std::log(value / low) / std::log(high / low);
  return (value - low) / (high - low);
}

std::vector<double> Axis::ticks(int about) const {
  if (logarithmic) {
    const auto values = logarithmic_ticks(low, high, about);
    if (values.size() >= 2) return values;
  }
  const double step = round_up_nicely((high - low) / about);
  std::vector<double> values;
  for (double at = std::ceil(low / step - 1e-9); at * step <= high + 1e-9 * step; ++at) {
    values.push_back(at == 0.0 ? 0.0 : at * step);
  }
  return values;
}

Axis axis_over(std::string title, const std::vector<std::vector<double>>& values,
               bool logarithmic) {
  double low = INFINITY, high = -INFINITY;
  for (const auto& part : values) {
    for (const double value : part) {
      if (!std::isfinite(value) || (logarithmic && value <= 0.0)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high) return {std::move(title), logarithmic ? 0.1 : 0.0, 1.0, logarithmic};
  if (logarithmic) {
    const double margin = std::max(std::pow(high / low, 0.06), 1.05);
    return {std::move(title), low / margin, high * margin, true};
  }
  const double margin = high > low ? 0.06 * (high - low) : std::max(0.1 * std::abs(high), 1e-6);
  return {std::move(title), low - margin, high + margin, false};
}

std::string tick_label(double value) {
  const double size = std::abs(value);
  if (size == 0.0 || (size >= 1e-3 && size < 1e6)) return label_of(value);
  const auto power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  const double factor = value / std::pow(10.0, power);
  std::string text = std::abs(factor - 1.0) < 1e-9 ? "10" : label_of(factor) + "\u00b710";
  const char* const digits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  for (const char letter : std::to_string(power)) {
    text += letter == '-' ? "\u207b" : digits[letter - '0'];
  }
  return text;
}

}  // namespace geo::io
