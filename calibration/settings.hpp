#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geo/core/parameter.hpp"

namespace geo::calibration {

/// What a calibration does, section [calibration]. Lists are arrays in TOML, or words with commas
/// between.
struct Settings {
  std::string free = "auto";  ///< six that shape such a planet
  std::string bounds, priors, terms;
  std::string seeds = "1-8";
  std::string held_out = "9-16";
  std::string grid = "512x256";
  std::string held_out_grid = "1024x512";
  std::string objective = "mean";
  std::int64_t bins = 100;
  double deviation_m = 50.0;
  double deviation_share = 0.005;
  double error_m = 0.0;  ///< 0: not known
  std::int64_t starts = 1;
  std::int64_t iterations = 20;
  double tolerance = 1e-3;
  bool profiles = true;

  [[nodiscard]] std::vector<Parameter> parameters();
};

/// A number with its standard deviation, "NAME = 0.29 +- 0.01".
struct Estimate {
  std::string name;
  double mean = 0.0, deviation = 0.0;
};
/// "NAME = 0.01 .. 1".
struct Range {
  std::string name;
  double low = 0.0, high = 0.0;
};

// Each throws ConfigurationError that names the key and the word that cannot be read.
[[nodiscard]] std::vector<std::string> read_names(const std::string& key, const std::string& text);
[[nodiscard]] std::vector<Estimate> read_estimates(const std::string& key, const std::string& text);
[[nodiscard]] std::vector<Range> read_ranges(const std::string& key, const std::string& text);
/// "1-8, 12": whole numbers that are not negative, each once.
[[nodiscard]] std::vector<std::int64_t> read_seeds(const std::string& key, const std::string& text);

}  // namespace geo::calibration
