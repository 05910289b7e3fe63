#pragma once

#include <string>

#include "calibration/result.hpp"
#include "geo/io/drawing/chart.hpp"

namespace geo::calibration {

/// Mean distance between two curves of as many bins: the Wasserstein-1 distance of the two
/// distributions of elevation, to the width of a bin.
double curve_distance_m(const Curve& a, const Curve& b);

/// The share of the area that lies higher, over the part that the target tells of, %.
io::Axis area_axis(const Curve& target);

/// Text of hypsometry.csv: quantile,target_m,before_m,after_m at the middle of each bin.
std::string curves_csv(const Result& result);

/// Target, before and after by share of the area, and below them the distances to the target.
io::Chart curves_chart(const Result& result);

}  // namespace geo::calibration
