#include "map_colours.hpp"

#include <charconv>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/files/embedded_data.hpp"

namespace geo::io {

void mix_in(ColourRow& row, Rgb colour, const float* share, float scale) {
  float *const r = row.r.data(), *const g = row.g.data(), *const b = row.b.data();
#pragma omp simd
  for (std::size_t x = 0; x < row.r.size(); ++x) {
    const float t = scale * share[x];
    r[x] += t * (colour.r - r[x]);
    g[x] += t * (colour.g - g[x]);
    b[x] += t * (colour.b - b[x]);
  }
}

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

namespace {

std::vector<ColourMap::Stop> stops_named(std::string_view name) {
  std::vector<ColourMap::Stop> stops;
  const Table table = embedded_table("colour_maps/" + std::string(name) + ".csv");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    stops.push_back({static_cast<float>(table.number(row, 0)), parse_colour(table.text(row, 1)),
                     table.text(row, 2)});
  }
  const auto descends = [](const auto& a, const auto& b) { return a.value >= b.value; };
  if (stops.size() < 2 || std::adjacent_find(stops.begin(), stops.end(), descends) != stops.end()) {
    throw Bug("colour map " + std::string(name) + ": values must ascend");
  }
  return stops;
}

}  // namespace

ColourMap::ColourMap(std::string_view name) : ColourMap(stops_named(name)) {}

ColourMap::ColourMap(std::vector<Stop> stops) : stops_(std::move(stops)) {
  for (const Stop& stop : stops_) {
    values_.push_back(stop.value);
    colours_.push_back(stop.colour);
  }
  for (std::size_t i = 0; i + 1 < colours_.size(); ++i) {
    classes_.push_back(mix(colours_[i], colours_[i + 1], 0.5F));
  }
  const float range = values_.back() - values_.front();
  bins_per_unit_ = kBins / range;
  // A part begins one part early, for its edges are rounded.
  std::size_t i = 1;
  for (int bin = 0; bin <= kBins; ++bin) {
    const float low = values_.front() + range * static_cast<float>(bin - 1) / kBins;
    while (i + 1 < values_.size() && values_[i] < low) ++i;
    first_[bin] = static_cast<std::uint32_t>(i);
  }
}

ColourMap ColourMap::spread_over(const std::vector<float>& values) const {
  std::vector<Stop> stops;
  const auto last = static_cast<float>(stops_.size() - 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(values.size() - 1);
    stops.push_back({values[i], at_position(share * last), ""});
  }
  return ColourMap(std::move(stops));
}

const ColourMap::Stop* ColourMap::category(int value) const {
  const auto at = std::find_if(stops_.begin(), stops_.end(), [&](const Stop& stop) {
    return static_cast<int>(stop.value) == value;
  });
  return at == stops_.end() ? nullptr : &*at;
}

}  // namespace geo::io
