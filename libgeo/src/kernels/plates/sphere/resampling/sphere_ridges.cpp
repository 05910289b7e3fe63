#include "geo/kernels/plates/sphere/resampling/sphere_ridges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geo/core/array_sizes.hpp"

namespace geo {
namespace {

/// A gap whose places lie farther from its middle than this in longitude has no unique order.
constexpr double kWidest_rad = 2.5;

/// Least share of its places, weighed by their widths, at which a gap must have opened.
constexpr double kMostlyOpen = 0.2;

/// Places of one gap, between the same two plates and connected: numbers of places.
struct Gap {
  std::int16_t first, second;  // plates
  std::vector<std::int32_t> members;
};

/// Weighted sums of a longitude, from which the cost of any run of rows follows.
struct Sums {
  double weight = 0.0, first = 0.0, second = 0.0;

  [[nodiscard]] Sums operator-(const Sums& o) const {
    return {weight - o.weight, first - o.first, second - o.second};
  }
  [[nodiscard]] double mean() const { return first / weight; }
  [[nodiscard]] double deviation() const {
    return weight > 0.0 ? std::max(0.0, second - first * first / weight) : 0.0;
  }
};

/// Piecewise constant approximation of rows with weights: the segment of each row, as its mean.
std::vector<double> segment_means(const std::vector<Sums>& up_to, double cost_of_segment) {
  const std::size_t rows = up_to.size() - 1;
  std::vector<double> least(rows + 1, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> from(rows + 1, 0);
  least[0] = 0.0;
  for (std::size_t end = 1; end <= rows; ++end) {
    for (std::size_t start = 0; start < end; ++start) {
      const double cost = least[start] + cost_of_segment + (up_to[end] - up_to[start]).deviation();
      if (cost >= least[end]) continue;
      least[end] = cost;
      from[end] = start;
    }
  }
  std::vector<double> mean(rows, 0.0);
  for (std::size_t end = rows; end > 0; end = from[end]) {
    const Sums all = up_to[end] - up_to[from[end]];
    std::fill(mean.begin() + static_cast<std::ptrdiff_t>(from[end]),
              mean.begin() + static_cast<std::ptrdiff_t>(end), all.weight > 0.0 ? all.mean() : 0.0);
  }
  return mean;
}

/// A gap as the pole of its opening sees it.
class OpeningFrame {
 public:
  /// Nothing to be seen when the second plate has not moved beside the first.
  OpeningFrame(const SpherePlate& first, const SpherePlate& second, const Vector3& middle) {
    const Quaternion back{first.turn.w, scaled(first.turn.v, -1.0)};
    const Quaternion opened = second.turn.after(back);
    pole_ = normalised(scaled(opened.v, opened.w < 0.0 ? -1.0 : 1.0));
    zero_ = normalised(tangent(middle, pole_));
    is_valid_ = length(opened.v) > 0.0 && length(zero_) > 0.0;
    quarter_ = cross(pole_, zero_);
  }
  [[nodiscard]] bool is_valid() const { return is_valid_; }
  [[nodiscard]] double distance_rad(const Vector3& at) const { return angle_between(at, pole_); }
  [[nodiscard]] double longitude(const Vector3& at) const {
    return std::atan2(dot(at, quarter_), dot(at, zero_));
  }
  /// To the pole.
  [[nodiscard]] Vector3 meridian(const Vector3& at) const { return normalised(tangent(pole_, at)); }

 private:
  Vector3 pole_{}, zero_{}, quarter_{};
  bool is_valid_ = false;
};

class Ridges {
 public:
  Ridges(const SphereTectonics& model, const OpenGaps& gaps)
      : m_(model),
        gaps_(gaps),
        spacing_rad_(model.mesh->samples().spacing()),
        found_(gaps.places.size()) {}

  std::vector<RidgePlace> place() {
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < found_.size(); ++k) found_[k] = half_way(k);
    if (m_.settings.ridge_segment_km > 0.0) {
      for (const Gap& gap : connected_gaps()) cut_into_segments(gap);
    }
    return std::move(found_);
  }

 private:
  /// What lies at one distance from the pole.
  struct Row {
    double west = std::numeric_limits<double>::infinity(), east = -west;  // of its places
    double scale = 0.0;                                                   // sine of the distance
    [[nodiscard]] bool is_empty() const { return east < west; }
    [[nodiscard]] double middle() const { return 0.5 * (west + east); }
  };

  [[nodiscard]] const Vector3& at(std::size_t k) const {
    return m_.mesh->samples().position(gaps_.places[k]);
  }
  [[nodiscard]] std::int16_t plate(std::size_t k, int side) const {
    return gaps_.owner[gaps_.sides[k].source[side]];
  }
  [[nodiscard]] double to_side_km(std::size_t k, int side) const {
    return m_.distance_km(gaps_.places[k], gaps_.sides[k].source[side]);
  }
  [[nodiscard]] RidgePlace half_way(std::size_t k) const {
    const auto [first, second] = gaps_.sides[k].source;
    const double near_km = to_side_km(k, 0);
    if (second < 0) return {.ridge_km = 0.0, .edge_km = near_km};
    const FibonacciSphere& samples = m_.mesh->samples();
    const Vector3 across = add(samples.position(first), samples.position(second), -1.0);
    return {.ridge_km = 0.5 * (to_side_km(k, 1) - near_km),
            .edge_km = near_km,
            .along = normalised(cross(across, at(k)))};
  }
  /// Where the margin of a continent that has broken grows, part of that continent.
  [[nodiscard]] bool is_margin(std::size_t k) const {
    return gaps_.continental[gaps_.sides[k].source[0]] != 0 &&
           to_side_km(k, 0) <= m_.settings.margin_km;
  }

  [[nodiscard]] std::vector<Gap> connected_gaps() const {
    std::vector<std::int32_t> number(m_.mesh->size(), -1);
    for (std::size_t k = 0; k < found_.size(); ++k) {
      if (gaps_.sides[k].source[1] >= 0) number[gaps_.places[k]] = static_cast<std::int32_t>(k);
    }
    const auto plates = [&](std::int32_t k) { return std::minmax({plate(k, 0), plate(k, 1)}); };
    std::vector<std::uint8_t> seen(found_.size(), 0);
    std::vector<Gap> all;
    for (std::size_t k = 0; k < found_.size(); ++k) {
      if (seen[k] != 0 || gaps_.sides[k].source[1] < 0) continue;
      seen[k] = 1;
      const auto pair = plates(static_cast<std::int32_t>(k));
      Gap gap{pair.first, pair.second, {static_cast<std::int32_t>(k)}};
      for (std::size_t next = 0; next < gap.members.size(); ++next) {
        for (const std::int32_t j : m_.mesh->neighbours(gaps_.places[gap.members[next]])) {
          const std::int32_t other = number[j];
          if (other < 0 || seen[other] != 0 || plates(other) != pair) continue;
          seen[other] = 1;
          gap.members.push_back(other);
        }
      }
      all.push_back(std::move(gap));
    }
    return all;
  }

  void cut_into_segments(const Gap& gap) {
    Vector3 sum{};
    for (const std::int32_t k : gap.members) sum = add(sum, at(k));
    const OpeningFrame frame(m_.state.plates[gap.first], m_.state.plates[gap.second], sum);
    if (!frame.is_valid() || !opens_eastwards(gap, frame)) return;
    const std::vector<Row> rows = rows_of(gap, frame);
    if (rows.empty()) return;
    const std::vector<double> ridge = ridge_of(rows);
    const double radius_km = m_.settings.radius_km;
    for (const std::int32_t k : gap.members) {
      const Row& row = rows[row_of(frame, at(k))];
      if (row.scale * radius_km < m_.settings.ridge_segment_km || is_margin(k)) continue;
      const double u = frame.longitude(at(k)), mean = ridge[row_of(frame, at(k))];
      const bool is_west = u < mean;
      const double beyond = 0.5 * spacing_rad_ / row.scale;
      const double edge = is_west ? row.west - beyond : row.east + beyond;
      found_[k] = {.side = plate(k, 0) == (is_west ? gap.first : gap.second) ? 0 : 1,
                   .ridge_km = std::abs(u - mean) * row.scale * radius_km,
                   .edge_km = std::abs(edge - u) * row.scale * radius_km,
                   .along = frame.meridian(at(k))};
    }
  }
  /// Whether the second plate, which has moved eastwards, lies in the east: plates have parted
  /// there, and not passed each other.
  [[nodiscard]] bool opens_eastwards(const Gap& gap, const OpeningFrame& frame) const {
    double sum = 0.0, all = 0.0;
    for (const std::int32_t k : gap.members) {
      const int west = plate(k, 0) == gap.first ? 0 : 1;
      const auto& source = gaps_.sides[k].source;
      const FibonacciSphere& samples = m_.mesh->samples();
      const double way = frame.longitude(samples.position(source[1 - west])) -
                         frame.longitude(samples.position(source[west]));
      if (std::abs(way) > kWidest_rad) return false;
      sum += way;
      all += std::abs(way);
    }
    return sum > kMostlyOpen * all;
  }
  [[nodiscard]] std::size_t row_of(const OpeningFrame& frame, const Vector3& place) const {
    return static_cast<std::size_t>(frame.distance_rad(place) / spacing_rad_);
  }
  /// From the pole on; none where longitudes cannot be told apart.
  [[nodiscard]] std::vector<Row> rows_of(const Gap& gap, const OpeningFrame& frame) const {
    std::vector<Row> rows(static_cast<std::size_t>(std::numbers::pi / spacing_rad_) + 2);
    for (const std::int32_t k : gap.members) {
      const double u = frame.longitude(at(k));
      if (std::abs(u) > kWidest_rad) return {};
      Row& row = rows[row_of(frame, at(k))];
      row.west = std::min(row.west, u);
      row.east = std::max(row.east, u);
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      rows[r].scale =
          std::sin(std::min(std::numbers::pi, (static_cast<double>(r) + 0.5) * spacing_rad_));
    }
    return rows;
  }
  /// Longitude of the ridge at each row from the first that the gap reaches to the last.
  [[nodiscard]] std::vector<double> ridge_of(const std::vector<Row>& rows) const {
    const auto is_reached = [](const Row& row) { return !row.is_empty(); };
    const auto first = std::ranges::find_if(rows, is_reached);
    const auto last = std::find_if(rows.rbegin(), rows.rend(), is_reached).base();
    std::vector<Sums> up_to(1);
    for (const Row& row : std::span(first, last)) {
      Sums next = up_to.back();
      if (!row.is_empty()) {
        const double weight = spacing_rad_ * row.scale * row.scale, u = row.middle();
        next = {next.weight + weight, next.first + weight * u, next.second + weight * u * u};
      }
      up_to.push_back(next);
    }
    std::vector<double> ridge(static_cast<std::size_t>(first - rows.begin()), 0.0);
    const std::vector<double> means = segment_means(
        up_to, std::pow(m_.settings.ridge_segment_km / m_.settings.radius_km, 3) / 6.0);
    ridge.insert(ridge.end(), means.begin(), means.end());
    return ridge;
  }

  const SphereTectonics& m_;
  const OpenGaps& gaps_;
  double spacing_rad_;
  std::vector<RidgePlace> found_;
};

}  // namespace

std::vector<RidgePlace> place_ridges(const SphereTectonics& model, const OpenGaps& gaps) {
  check_sizes("place_ridges", model.state.crust.plate.size(),
              {{"owner", gaps.owner.size()}, {"continental", gaps.continental.size()}});
  check_sizes("place_ridges", gaps.places.size(), {{"sides", gaps.sides.size()}});
  return Ridges(model, gaps).place();
}

}  // namespace geo
