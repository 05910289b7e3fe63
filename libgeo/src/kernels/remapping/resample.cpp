#include "geo/kernels/remapping/resample.hpp"

#include <GeographicLib/Ellipsoid.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"

namespace geo {
namespace {

/// Which source cells make up a target cell, and their shares, which add up to one. Cells are
/// consecutive; on an axis that wraps the first may be negative or the last beyond the end.
struct AxisShare {
  int first = 0;
  std::vector<double> weights;
};

/// Maps an axis so that equal lengths are equal areas.
using Measure = std::vector<double>;

Measure authalic_sines(std::span<const double> latitude_deg, const Ellipsoid& figure) {
  const GeographicLib::Ellipsoid ellipsoid(figure.radius_m, figure.flattening);
  Measure sines;
  for (const double latitude : latitude_deg) {
    sines.push_back(std::sin(ellipsoid.AuthalicLatitude(std::clamp(latitude, -90.0, 90.0)) *
                             std::numbers::pi / 180.0));
  }
  return sines;
}

/// Value of an ascending table at a cell number that may lie whole periods beyond it.
double unrolled(std::span<const double> table, int n, double period, int i) {
  if (period == 0.0) return table[i];
  const int turns = i >= 0 ? i / n : -((n - 1 - i) / n);
  return table[i - turns * n] + turns * period;
}

/// Shares of source cells in [low, high] by length of overlap.
AxisShare overlap_share(const Axis& axis, const Measure& edges, double low, double high) {
  const int n = axis.size();
  const auto edge = [&](int i) { return unrolled(edges, n, axis.period, i); };
  int first =
      static_cast<int>(std::upper_bound(edges.begin(), edges.end() - 1, low) - edges.begin()) - 1;
  if (first < 0) first = axis.period == 0.0 ? 0 : -1;
  while (axis.period != 0.0 && edge(first) > low) --first;
  while (edge(first + 1) <= low && (axis.period != 0.0 || first < n - 1)) ++first;
  AxisShare share{first, {}};
  double sum = 0.0;
  for (int i = first; axis.period != 0.0 || i < n; ++i) {
    if (edge(i) >= high && i > first) break;
    const double overlap = std::max(0.0, std::min(high, edge(i + 1)) - std::max(low, edge(i)));
    share.weights.push_back(overlap);
    sum += overlap;
  }
  if (!(sum > 0.0)) return {first, {1.0}};
  for (double& weight : share.weights) weight /= sum;
  return share;
}

/// Shares of the two source centres about a position.
AxisShare linear_share(const Axis& axis, double position) {
  const int n = axis.size();
  const auto centre = [&](int i) { return unrolled(axis.centres, n, axis.period, i); };
  int left = static_cast<int>(std::upper_bound(axis.centres.begin(), axis.centres.end(), position) -
                              axis.centres.begin()) -
             1;
  if (axis.period == 0.0) {
    if (left < 0) return {0, {1.0}};
    if (left >= n - 1) return {n - 1, {1.0}};
  } else {
    while (centre(left) > position) --left;
    while (centre(left + 1) <= position) ++left;
  }
  const double right = (position - centre(left)) / (centre(left + 1) - centre(left));
  return {left, {1.0 - right, right}};
}

double mean_step(const Axis& axis) {
  return (axis.edges.back() - axis.edges.front()) / axis.size();
}

/// `to_area` turns edges into a coordinate of equal areas.
template <class ToArea>
std::vector<AxisShare> shares_of(const Axis& source, const Axis& target, const ToArea& to_area) {
  // Half a millionth: steps that differ by rounding alone count as equal.
  const bool coarser = mean_step(target) >= mean_step(source) * (1.0 - 5e-7);
  std::vector<AxisShare> shares(target.size());
  const Measure source_edges = to_area(source.edges), target_edges = to_area(target.edges);
  for (int i = 0; i < target.size(); ++i) {
    shares[i] = coarser ? overlap_share(source, source_edges, target_edges[i], target_edges[i + 1])
                        : linear_share(source, target.centres[i]);
  }
  return shares;
}

void check_within(const Axis& source, const Axis& target, const char* what) {
  if (source.period != 0.0) return;
  const double slack = 1e-3 * std::min(mean_step(source), mean_step(target));
  if (target.edges.front() < source.edges.front() - slack ||
      target.edges.back() > source.edges.back() + slack) {
    throw InputError(
        std::string("the raster covers ") + what + " " + std::to_string(source.edges.front()) +
        " to " + std::to_string(source.edges.back()) + ", the grid wants " +
        std::to_string(target.edges.front()) + " to " + std::to_string(target.edges.back()));
  }
}

/// How much of a polar row's mean a latitude beyond it takes; the rest is the row itself, which
/// goes on half-way round.
double share_of_pole(const Axis& rows, double latitude_deg) {
  const double south = rows.centres.front(), north = rows.centres.back();
  if (latitude_deg < south && south > -90.0) return (south - latitude_deg) / (south + 90.0);
  if (latitude_deg > north && north < 90.0) return (latitude_deg - north) / (90.0 - north);
  return 0.0;
}

double row_mean(std::span<const float> row) {
  double sum = 0.0;
  for (const float value : row) sum += value;
  return sum / static_cast<double>(row.size());
}

Axis metric_axis(int n, double step_m) {
  Axis axis;
  for (int i = 0; i < n; ++i) axis.centres.push_back((i + 0.5 - 0.5 * n) * step_m);
  for (int i = 0; i <= n; ++i) axis.edges.push_back((i - 0.5 * n) * step_m);
  return axis;
}

Axis axis_between(double low, double high, std::vector<double> centres) {
  const int n = static_cast<int>(centres.size());
  const double middle = 0.5 * (low + high), step = (high - low) / n;
  Axis axis{std::move(centres), {}, 0.0};
  for (int i = 0; i <= n; ++i) axis.edges.push_back(middle + (i - 0.5 * n) * step);
  return axis;
}

}  // namespace

Raster metric_raster_of(const Grid& grid) {
  return {metric_axis(grid.ny(), grid.step_north_m()),
          metric_axis(grid.nx(), grid.spacing_east_m(0)), false};
}

Raster raster_of(const Grid& grid) {
  if (!grid.is_geographic()) return metric_raster_of(grid);
  std::vector<double> latitudes(grid.ny()), longitudes(grid.nx());
  for (int j = 0; j < grid.ny(); ++j) latitudes[j] = grid.latitude_deg(j);
  for (int i = 0; i < grid.nx(); ++i) longitudes[i] = grid.longitude_deg(i);
  Window window = grid.window();
  if (!grid.is_latitude_longitude()) {
    const double half_lat = 0.5 * (latitudes[1] - latitudes[0]);
    const double half_lon = 0.5 * (longitudes[1] - longitudes[0]);
    window = {latitudes.front() - half_lat, latitudes.back() + half_lat,
              longitudes.front() - half_lon, longitudes.back() + half_lon};
  }
  Raster raster{axis_between(window.south_deg, window.north_deg, std::move(latitudes)),
                axis_between(window.west_deg, window.east_deg, std::move(longitudes)), true};
  if (grid.topology() == Topology::sphere) raster.columns.period = 360.0;
  return raster;
}

RowResampling::RowResampling(const Raster& source, const Raster& target, const Ellipsoid& figure)
    : source_columns_(static_cast<std::size_t>(source.columns.size())) {
  const bool geographic = source.geographic;
  if (geographic != target.geographic) {
    throw InputError("raster and grid have no coordinates in common: one is in degrees, one in m");
  }
  check_within(source.rows, target.rows, geographic ? "latitudes" : "y");
  check_within(source.columns, target.columns, geographic ? "longitudes" : "x");
  const auto same = [](const std::vector<double>& edges) { return edges; };
  const auto sines = [&](const std::vector<double>& edges) {
    return geographic ? authalic_sines(edges, figure) : edges;
  };
  const int nx = source.columns.size();
  const auto keep = [&](const std::vector<AxisShare>& shares, std::vector<Share>& kept) {
    for (const AxisShare& share : shares) {
      kept.push_back({share.first, static_cast<int>(share.weights.size()), weights_.size()});
      weights_.insert(weights_.end(), share.weights.begin(), share.weights.end());
    }
  };
  keep(shares_of(source.rows, target.rows, sines), row_shares_);
  keep(shares_of(source.columns, target.columns, same), columns_);
  for (Share& share : columns_) share.first = (share.first % nx + nx) % nx;

  poles_.resize(target.rows.size());
  const bool round = source.columns.period != 0.0;
  if (!round || !(mean_step(target.rows) < mean_step(source.rows))) return;
  for (std::size_t j = 0; j < poles_.size(); ++j) {
    const double latitude_deg = target.rows.centres[j];
    const bool is_south = latitude_deg < source.rows.centres.front();
    poles_[j] = {share_of_pole(source.rows, latitude_deg), is_south ? 0 : source.rows.size() - 1};
  }
}

void RowResampling::row(std::span<const float> source, int j, std::span<float> out,
                        std::span<double> scratch) const {
  const std::size_t nx = source_columns_;
  const Share& rows = row_shares_[j];
  const std::span<double> blended = scratch.first(nx);
  std::fill(blended.begin(), blended.end(), 0.0);
  for (int k = 0; k < rows.count; ++k) {
    const double weight = weights_[rows.weights + k];
    const float* const from = source.data() + static_cast<std::size_t>(rows.first + k) * nx;
    for (std::size_t i = 0; i < nx; ++i) blended[i] += weight * from[i];
  }
  if (const PoleBlend& pole = poles_[j]; pole.share > 0.0) {
    const double mean = row_mean(source.subspan(static_cast<std::size_t>(pole.row) * nx, nx));
    for (double& value : blended) value += pole.share * (mean - value);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Share& share = columns_[i];
    auto from = static_cast<std::size_t>(share.first);
    double sum = 0.0;
    for (int k = 0; k < share.count; ++k) {
      sum += weights_[share.weights + k] * blended[from];
      if (++from == nx) from = 0;
    }
    out[i] = static_cast<float>(sum);
  }
}

void resample_raster(const Raster& source_raster, std::span<const float> source,
                     const Raster& target_raster, std::span<float> target,
                     const Ellipsoid& figure) {
  const RowResampling rows(source_raster, target_raster, figure);
  const auto target_nx = static_cast<std::size_t>(rows.columns());
  ParallelErrors errors;
#pragma omp parallel
  {
    auto scratch = errors.make<std::vector<double>>(rows.scratch_size());
#pragma omp for schedule(static)
    for (int j = 0; j < rows.rows(); ++j) {
      if (errors.any()) continue;
      rows.row(source, j, target.subspan(static_cast<std::size_t>(j) * target_nx, target_nx),
               scratch);
    }
  }
  errors.rethrow();
}

}  // namespace geo
