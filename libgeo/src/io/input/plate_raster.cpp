#include "geo/io/input/plate_raster.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geo/core/error.hpp"
#include "geo/io/input/plate_outlines.hpp"

namespace geo::io {
namespace {

/// Rectangles wider than this would leave it open which way round the planet their edges go.
constexpr double kWidest_deg = 90.0;

/// Where the table has what.
struct Columns {
  explicit Columns(const Table& table)
      : plate(table.column("plate_id", kNeeds)),
        latitude(table.column("pole_latitude_deg", kNeeds)),
        longitude(table.column("pole_longitude_deg", kNeeds)),
        rate(table.column("rate_deg_myr", kNeeds)) {}

  std::size_t plate, latitude, longitude, rate;

 private:
  static constexpr std::string_view kNeeds =
      ": needs plate_id, pole_latitude_deg, pole_longitude_deg, rate_deg_myr";
};

std::map<int, PlateOutline> motions_of(const Table& table) {
  const Columns columns(table);
  std::map<int, PlateOutline> motions;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double number = table.number(row, columns.plate);
    if (number != std::round(number) || std::abs(number) > kHighestPlateNumber) {
      table.refuse(row, "plate_id must be a whole number in [-32767, 32767]");
    }
    const Centre pole{table.number(row, columns.latitude), table.number(row, columns.longitude)};
    const double rate = table.number(row, columns.rate);
    if (std::abs(pole.latitude_deg) > 90.0 || std::abs(pole.longitude_deg) > 360.0) {
      table.refuse(row, "the pole must have a latitude in [-90, 90], a longitude in [-360, 360]");
    }
    if (std::abs(rate) > kFastestPlate_deg_myr) {
      table.refuse(row, "rate_deg_myr must be in [-100, 100]");
    }
    const int plate = static_cast<int>(number);
    motions[plate] = {fmt::to_string(plate), {}, pole, rate};
  }
  return motions;
}

std::vector<Centre> rectangle(double south, double north, double west, double east) {
  return {{south, west}, {south, east}, {north, east}, {north, west}, {south, west}};
}

/// The cells of one row, handed over as stretches of one value: f(value, first column, behind the
/// last).
template <class F>
void for_each_stretch(const Axis& columns, const float* values, F f) {
  for (int first = 0; first < columns.size();) {
    int end = first + 1;
    while (end < columns.size() && values[end] == values[first] &&
           columns.edges[end + 1] - columns.edges[first] <= kWidest_deg) {
      ++end;
    }
    f(values[first], first, end);
    first = end;
  }
}

}  // namespace

std::vector<PlateOutline> plates_of_raster(const Dem& numbers, const Table& rotations) {
  const bool is_grid = numbers.raster_m.empty();
  const Raster raster = is_grid ? raster_of(numbers.grid) : numbers.raster;
  const std::vector<float>& values = is_grid ? numbers.elevation_m : numbers.raster_m;
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("fields.plates: {}: {}", numbers.source, what));
  };
  const std::map<int, PlateOutline> motions = motions_of(rotations);
  std::map<int, PlateOutline> plates;
  const auto plate_of = [&](float value) -> PlateOutline& {
    if (value != std::round(value) || std::abs(value) > kHighestPlateNumber) {
      refuse(fmt::format("{:g} is no number of a plate", value));
    }
    const int number = static_cast<int>(value);
    if (const auto known = plates.find(number); known != plates.end()) return known->second;
    const auto motion = motions.find(number);
    if (motion == motions.end()) {
      refuse(fmt::format("plate {} has no row in fields.plate_rotations", number));
    }
    if (plates.size() == kMostPlates) {
      refuse(fmt::format("has more than {} plates", kMostPlates));
    }
    return plates.emplace(number, motion->second).first->second;
  };
  for (int j = 0; j < raster.rows.size(); ++j) {
    const double south = std::max(-90.0, raster.rows.edges[j]);
    const double north = std::min(90.0, raster.rows.edges[j + 1]);
    const float* row = values.data() + static_cast<std::size_t>(j) * raster.columns.size();
    for_each_stretch(raster.columns, row, [&](float value, int first, int end) {
      if (std::isnan(value)) return;
      plate_of(value).rings.push_back(
          rectangle(south, north, raster.columns.edges[first], raster.columns.edges[end]));
    });
  }
  if (plates.size() < 2) {
    refuse(fmt::format("has {} plate{}: must have 2 or more", plates.size(),
                       plates.size() == 1 ? "" : "s"));
  }
  std::vector<PlateOutline> outlines;
  outlines.reserve(plates.size());
  for (auto& [number, plate] : plates) outlines.push_back(std::move(plate));
  return outlines;
}

}  // namespace geo::io
