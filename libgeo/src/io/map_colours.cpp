#include "map_colours.hpp"

#include <charconv>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/io/embedded_data.hpp"

namespace geo::io {

Rgb parse_colour(std::string_view hex) {
  unsigned value = 0;
  if (hex.size() != 7 || hex[0] != '#' ||
      std::from_chars(hex.data() + 1, hex.data() + 7, value, 16).ptr != hex.data() + 7) {
    throw Bug("colour \"" + std::string(hex) + "\" is not of the form #rrggbb");
  }
  const auto part = [&](int shift) {
    return static_cast<float>((value >> shift) & 0xFFU) / 255.0F;
  };
  return {part(16), part(8), part(0)};
}

ColourMap::ColourMap(std::string_view name) {
  for (const auto& row : table_rows(embedded_file("colour_maps/" + std::string(name) + ".csv"))) {
    stops_.push_back(
        {static_cast<float>(number(row.at(0))), parse_colour(row.at(1)), std::string(row.at(2))});
  }
  const auto descends = [](const Stop& a, const Stop& b) { return a.value >= b.value; };
  if (stops_.size() < 2 ||
      std::adjacent_find(stops_.begin(), stops_.end(), descends) != stops_.end()) {
    throw Bug("colour map " + std::string(name) + ": values must ascend");
  }
}

ColourMap ColourMap::spread_over(const std::vector<float>& values) const {
  ColourMap out;
  const auto last = static_cast<float>(stops_.size() - 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(values.size() - 1);
    out.stops_.push_back({values[i], at_position(share * last), ""});
  }
  return out;
}

float ColourMap::position(float value) const {
  if (!(value > stops_.front().value)) return 0.0F;
  const auto last = static_cast<float>(stops_.size() - 1);
  if (value >= stops_.back().value) return last;
  std::size_t i = 1;
  while (stops_[i].value < value) ++i;
  const float below = stops_[i - 1].value;
  return static_cast<float>(i - 1) + (value - below) / (stops_[i].value - below);
}

Rgb ColourMap::at_position(float position) const {
  const auto i = std::min(static_cast<std::size_t>(position), stops_.size() - 2);
  return mix(stops_[i].colour, stops_[i + 1].colour, position - static_cast<float>(i));
}

Rgb ColourMap::classed(float position, float blur) const {
  const int classes = static_cast<int>(stops_.size()) - 1;
  const int border = std::clamp(static_cast<int>(std::lround(position)), 1, classes - 1);
  const float across = (position - static_cast<float>(border)) / std::max(blur, 1e-3F) + 0.5F;
  const int i = std::clamp(static_cast<int>(position), 0, classes - 1);
  if (across <= 0.0F || across >= 1.0F) return class_colour(i);
  return mix(class_colour(border - 1), class_colour(border), across);
}

const ColourMap::Stop* ColourMap::category(int value) const {
  const auto at = std::find_if(stops_.begin(), stops_.end(), [&](const Stop& stop) {
    return static_cast<int>(stop.value) == value;
  });
  return at == stops_.end() ? nullptr : &*at;
}

}  // namespace geo::io
