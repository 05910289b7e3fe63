#pragma once

#include <string>
#include <vector>

#include "calibration/result.hpp"

namespace geo::calibration {

/// A number for people: so many significant digits, a true minus, powers of ten written out, and a
/// dash for what is not determined.
std::string shown(double value, int digits = 3);

/// With a capital letter and a full stop.
std::string sentence(std::string text);

/// "1, 2, 5 to 8"
std::string seeds_in_words(const std::vector<SeedMisfit>& seeds);

/// The combination of parameters that a direction stands for: "isostasy.lithosphere up (0.81) with
/// erosion.erodibility_factor down (−0.58)", the heaviest first, those of little weight left out.
std::string combination_in_words(const Direction& direction,
                                 const std::vector<FittedParameter>& parameters);

/// What the least certain direction means for a reader, in a few sentences.
std::string weakest_in_words(const Result& result);

/// Standard deviation over seeds; NaN for fewer than two.
double spread(const std::vector<SeedMisfit>& seeds, double SeedMisfit::*figure);

}  // namespace geo::calibration
