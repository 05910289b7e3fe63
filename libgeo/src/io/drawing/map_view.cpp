#include "geo/io/drawing/map_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/parameter.hpp"
#include "geo/core/turn.hpp"

namespace geo::io {
namespace {

constexpr std::array kProjections{
    MapProjection{"equirectangular", "+proj=eqc",
                  "plate carrée; a part of the planet is true to scale along its middle parallel"},
    MapProjection{"robinson", "+proj=robin", "Robinson: a compromise for maps of the world"},
    MapProjection{"winkel-tripel", "+proj=wintri", "Winkel tripel: little distortion of shapes"},
    MapProjection{"equal-earth", "+proj=eqearth", "Equal Earth: areas are true"},
    MapProjection{"mollweide", "+proj=moll", "Mollweide: areas are true, the planet an ellipse"},
    MapProjection{"mercator", "+proj=merc", "Mercator: angles are true; to 80° north and south"},
    MapProjection{"orthographic", "+proj=ortho", "the hemisphere about the centre, as from space"},
    MapProjection{"stereographic", "+proj=stere",
                  "the hemisphere about the centre; angles are true"},
    MapProjection{"equal-area", "+proj=laea",
                  "Lambert's azimuthal: the hemisphere about the centre; areas are true"},
    MapProjection{"polar-north", "+proj=stere", "stereographic about the north pole, to 45° N"},
    MapProjection{"polar-south", "+proj=stere", "stereographic about the south pole, to 45° S"},
};

/// Numbers between commas; empty where it is anything else.
std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const char* first = text.data() + begin;
    const char* const last = text.data() + comma;
    while (first != last && *first == ' ') ++first;
    double value = 0.0;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc() || end != last || !std::isfinite(value)) return {};
    numbers.push_back(value);
    begin = comma + 1;
  }
  return numbers;
}

}  // namespace

std::span<const MapProjection> map_projections() { return kProjections; }

const MapProjection& find_projection(std::string_view name) {
  const auto at = std::find_if(kProjections.begin(), kProjections.end(),
                               [&](const MapProjection& each) { return each.name == name; });
  if (at != kProjections.end()) return *at;
  std::vector<std::string_view> names;
  for (const auto& each : kProjections) names.push_back(each.name);
  const std::string near = nearest_word(name, names);
  throw ConfigurationError(fmt::format("no map projection \"{}\"{}: must be one of {}", name,
                                       near.empty() ? "" : fmt::format(", perhaps {}", near),
                                       fmt::join(names, ", ")));
}

Centre parse_centre(std::string_view what, std::string_view text) {
  const auto numbers = numbers_of(text);
  if (numbers.size() != 2 || std::abs(numbers[0]) > 90.0 || std::abs(numbers[1]) > 360.0) {
    throw ConfigurationError(fmt::format(
        "{} {}: must be latitude and longitude in degrees, such as 45,-120", what, text));
  }
  return {numbers[0], std::remainder(numbers[1], 360.0)};
}

std::array<double, 3> parse_turn(std::string_view what, std::string_view text) {
  if (text.empty()) return {};
  const auto numbers = numbers_of(text);
  if (numbers.size() != 3 || std::abs(numbers[0]) > 90.0 || std::abs(numbers[1]) > 360.0 ||
      std::abs(numbers[2]) > 360.0) {
    throw ConfigurationError(
        fmt::format("{} {}: must be the latitude and longitude of the new pole and an angle, in "
                    "degrees, such as 35,-120,0",
                    what, text));
  }
  return turn_to_pole({numbers[0], numbers[1]}, numbers[2]);
}

Window parse_box(std::string_view what, std::string_view text) {
  const auto fail = [&](const char* why) {
    throw ConfigurationError(
        fmt::format("{} {}: {}; it is west, south, east, north in degrees, such as -20,30,45,70",
                    what, text, why));
  };
  const auto numbers = numbers_of(text);
  if (numbers.size() != 4) fail("must be four numbers");
  const double west = numbers[0], south = numbers[1], north = numbers[3];
  double east = numbers[2];
  if (std::abs(west) > 360.0 || std::abs(east) > 360.0) fail("longitudes must be within 360°");
  if (!(south >= -90.0 && south < north && north <= 90.0)) {
    fail("south must lie below north, both within 90°");
  }
  if (east <= west) east += 360.0;
  if (!(east > west && east - west <= 360.0)) fail("must be at most 360° wide");
  if (east - west < 0.01 || north - south < 0.01) fail("must be at least 0.01° wide and high");
  return {south, north, west, east};
}

}  // namespace geo::io
