#include "calibration/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "geo/core/error.hpp"

namespace geo::calibration {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

std::vector<std::string_view> entries(std::string_view text) {
  std::vector<std::string_view> all;
  while (!text.empty()) {
    const auto end = std::min(text.find(','), text.size());
    if (const auto entry = trimmed(text.substr(0, end)); !entry.empty()) all.push_back(entry);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return all;
}

template <class Number>
std::optional<Number> number(std::string_view text) {
  text = trimmed(text);
  Number value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const std::string& key, std::string_view entry, std::string_view wanted) {
  throw ConfigurationError(fmt::format("{}: {}: must be {}", key, entry, wanted));
}

/// NAME = A mark B.
struct Triple {
  std::string name;
  double first, second;
};
Triple read_triple(const std::string& key, std::string_view entry, std::string_view mark,
                   std::string_view wanted) {
  const auto equals = entry.find('='), middle = entry.find(mark);
  if (equals == std::string_view::npos || middle == std::string_view::npos || middle < equals) {
    refuse(key, entry, wanted);
  }
  const auto first = number<double>(entry.substr(equals + 1, middle - equals - 1));
  const auto second = number<double>(entry.substr(middle + mark.size()));
  const auto name = trimmed(entry.substr(0, equals));
  if (!first || !second || name.empty() || !std::isfinite(*first) || !std::isfinite(*second)) {
    refuse(key, entry, wanted);
  }
  return {std::string(name), *first, *second};
}

}  // namespace

std::vector<Parameter> Settings::parameters() {
  return {
      list("calibration.free", free,
           "parameters of planet, isostasy and erosion to be fitted; auto: six of isostasy and "
           "erosion",
           "design"),
      list("calibration.bounds", bounds,
           "narrower bounds than a parameter's range, NAME = LOW .. HIGH each", "design"),
      list("calibration.priors", priors,
           "what is known of parameters beforehand, NAME = MEAN +- DEVIATION each", "design"),
      list("calibration.terms", terms,
           "further figures to match, NAME = VALUE +- DEVIATION each: land_fraction, "
           "water_volume_km3, erosion_rate_mm_yr, concavity, crust_thickness_qNN_km",
           "design"),
      list("calibration.seeds", seeds, "seeds of the planets that are fitted, as 1-8, 12",
           "design"),
      list("calibration.held_out", held_out,
           "seeds of planets that only judge the result; may be empty", "design"),
      text("calibration.grid", grid, "cells of the planets that are fitted", "design"),
      text("calibration.held_out_grid", held_out_grid,
           "cells on which the fitted seeds are judged once more; may be empty", "design"),
      choice("calibration.objective", objective, {"mean", "each"},
             "whether the mean curve of the planets is to match the target, or every one",
             "design"),
      integer("calibration.bins", bins, "1", 10, 1000,
              "quantiles that a target other than rows of a table is matched at", "design"),
      real("calibration.deviation_m", deviation_m, "m", 1e-3, 1e5,
           "how exactly a quantile is to be matched, in height", "design"),
      real("calibration.deviation_share", deviation_share, "1", 0.0, 0.5,
           "how exactly it is to be matched, in the share of the area below a height", "design"),
      real("calibration.error_m", error_m, "m", 0.0, 1e5,
           "standard deviation to which the target's quantiles are known, less than which no error "
           "of a parameter is derived from; 0: not known",
           "design"),
      integer("calibration.starts", starts, "1", 1, 100,
              "starting points: the configuration, and random ones within the bounds", "design"),
      integer("calibration.iterations", iterations, "1", 1, 1000,
              "most iterations from one starting point", "design"),
      real("calibration.tolerance", tolerance, "1", 1e-12, 0.5,
           "relative decrease of the cost below which the fit has converged", "design"),
      flag("calibration.profiles", profiles,
           "profile likelihoods of the best and the worst determined parameter", "design"),
  };
}

std::vector<std::string> read_names(const std::string& key, const std::string& text) {
  std::vector<std::string> names;
  for (const auto entry : entries(text)) {
    if (std::find(names.begin(), names.end(), entry) != names.end()) {
      refuse(key, entry, "named once");
    }
    names.emplace_back(entry);
  }
  return names;
}

std::vector<Estimate> read_estimates(const std::string& key, const std::string& text) {
  std::vector<Estimate> all;
  for (const auto entry : entries(text)) {
    constexpr std::string_view kWanted = "NAME = VALUE +- DEVIATION";
    const auto [name, mean, deviation] = read_triple(key, entry, "+-", kWanted);
    if (!(deviation > 0.0)) refuse(key, entry, "given a positive deviation");
    all.push_back({name, mean, deviation});
  }
  return all;
}

std::vector<Range> read_ranges(const std::string& key, const std::string& text) {
  std::vector<Range> all;
  for (const auto entry : entries(text)) {
    const auto [name, low, high] = read_triple(key, entry, "..", "NAME = LOW .. HIGH");
    if (!(high > low)) refuse(key, entry, "given a HIGH above its LOW");
    all.push_back({name, low, high});
  }
  return all;
}

std::vector<std::int64_t> read_seeds(const std::string& key, const std::string& text) {
  constexpr std::string_view kWanted = "whole numbers from 0 on, as 1-8, 12, each once";
  constexpr std::int64_t kMost = 1000;
  std::vector<std::int64_t> seeds;
  for (const auto entry : entries(text)) {
    const auto dash = entry.find('-');
    const auto first = number<std::int64_t>(entry.substr(0, dash));
    const auto last =
        dash == std::string_view::npos ? first : number<std::int64_t>(entry.substr(dash + 1));
    if (!first || !last || *first < 0 || *last < *first || *last - *first >= kMost) {
      refuse(key, entry, kWanted);
    }
    // Counted from the first: the last may be the largest number there is.
    for (std::int64_t after = 0; after <= *last - *first; ++after) {
      const std::int64_t seed = *first + after;
      if (std::find(seeds.begin(), seeds.end(), seed) != seeds.end()) refuse(key, entry, kWanted);
      seeds.push_back(seed);
    }
  }
  return seeds;
}

}  // namespace geo::calibration
