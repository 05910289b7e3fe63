#include "export_masks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>
#include <string_view>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"

namespace geo::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;

constexpr std::array<std::string_view, 5> kMaskNames{"biomes", "rivers", "lakes", "slope",
                                                     "wetness"};

std::span<const float> floats_of(const ExportSource& source, const FieldSpec& spec) {
  return std::get<std::vector<float>>(source.of(spec));
}

template <class Value>
std::vector<std::uint8_t> byte_layer(const ExportSource& source, const Value& value) {
  std::vector<std::uint8_t> layer(source.grid().size());
#pragma omp parallel for schedule(static)
  for (Index cell = 0; cell < source.grid().size(); ++cell) {
    layer[cell] = static_cast<std::uint8_t>(
        std::clamp(std::round(static_cast<double>(value(cell))), 0.0, 255.0));
  }
  return layer;
}

void require(const ExportSource& source, std::string_view mask,
             std::initializer_list<const FieldSpec*> fields) {
  for (const FieldSpec* spec : fields) {
    if (source.has(*spec)) continue;
    throw ConfigurationError(
        fmt::format("--masks {}: needs the field {}, which is not there", mask, spec->name));
  }
}

/// The number of each cell's biome, and for each biome that occurs a layer of its cells.
void add_biomes(const ExportSource& source, std::vector<ExportMask>& masks) {
  require(source, "biomes", {&field::biome});
  const auto& biome = std::get<std::vector<std::int8_t>>(source.of(field::biome));
  Json meanings = Json::object();
  for (const Flag& flag : field::biome.flags) {
    meanings[std::to_string(flag.value)] = std::string(flag.meaning);
  }
  constexpr double kNone = 255.0;
  masks.push_back({"biomes",
                   byte_layer(source, [&](Index i) { return biome[i] < 0 ? kNone : biome[i]; }),
                   {{"quantity", "biome"}, {"values", meanings}, {"missing", 255}}});
  for (const Flag& flag : field::biome.flags) {
    if (std::find(biome.begin(), biome.end(), flag.value) == biome.end()) continue;
    masks.push_back(
        {fmt::format("biome-{}", flag.meaning),
         byte_layer(source, [&](Index i) { return biome[i] == flag.value ? 255.0 : 0.0; }),
         {{"quantity", fmt::format("255 where the biome is {}", flag.meaning)}}});
  }
}

/// Topographic wetness index ln(a / tan b) (Beven & Kirkby 1979): a is the drainage area over the
/// width of the cell, b the slope.
ExportMask wetness(const ExportSource& source) {
  require(source, "wetness",
          {&field::drainage_area, &field::slope, &field::elevation, &field::lake_depth});
  // Slopes below this are less than relief resolves.
  constexpr double kLeastSlope = 1e-4, kDriest = 0.0, kWettest = 30.0;
  const auto& area = std::get<std::vector<double>>(source.of(field::drainage_area));
  const auto slope = floats_of(source, field::slope),
             elevation = floats_of(source, field::elevation);
  const auto lake = floats_of(source, field::lake_depth);
  const Grid& grid = source.grid();
  const auto value = [&](Index i) {
    if (elevation[i] < 0.0F || lake[i] > 0.0F) return 255.0;
    const double width = std::sqrt(grid.area_m2(grid.row(i)));
    const double index = std::log(std::max(area[i], width * width) / width /
                                  std::max<double>(slope[i], kLeastSlope));
    return 255.0 * (index - kDriest) / (kWettest - kDriest);
  };
  return {"wetness",
          byte_layer(source, value),
          {{"quantity", "topographic wetness index ln(a / tan b), a in m; seas and lakes 255"},
           {"offset", kDriest},
           {"scale", (kWettest - kDriest) / 255.0}}};
}

}  // namespace

std::vector<std::string_view> export_mask_names() { return {kMaskNames.begin(), kMaskNames.end()}; }

std::vector<ExportMask> masks_of(const ExportRequest& request, const ExportSource& source) {
  std::vector<ExportMask> masks;
  std::vector<std::string> names = request.masks;
  if (names == std::vector<std::string>{"all"}) names.assign(kMaskNames.begin(), kMaskNames.end());
  for (const std::string& name : names) {
    if (name == "biomes") {
      add_biomes(source, masks);
    } else if (name == "rivers") {
      require(source, name, {&field::river_intensity});
      const auto river = floats_of(source, field::river_intensity);
      masks.push_back({name,
                       byte_layer(source, [&](Index i) { return 255.0F * river[i]; }),
                       {{"quantity", "river_intensity"}, {"offset", 0.0}, {"scale", 1.0 / 255.0}}});
    } else if (name == "lakes") {
      require(source, name, {&field::lake_depth});
      const auto depth = floats_of(source, field::lake_depth);
      masks.push_back({name,
                       byte_layer(source, [&](Index i) { return depth[i] > 0.0F ? 255.0 : 0.0; }),
                       {{"quantity", "255 where a lake stands"}}});
    } else if (name == "slope") {
      require(source, name, {&field::slope});
      const auto slope = floats_of(source, field::slope);
      masks.push_back({name,
                       byte_layer(source,
                                  [&](Index i) {
                                    return std::atan(static_cast<double>(slope[i])) * kDegrees *
                                           255.0 / 90.0;
                                  }),
                       {{"quantity", "angle of the steepest descent"},
                        {"units", "degree"},
                        {"offset", 0.0},
                        {"scale", 90.0 / 255.0}}});
    } else if (name == "wetness") {
      masks.push_back(wetness(source));
    } else {
      throw ConfigurationError(fmt::format("--masks {}: must be all or some of {}{}", name,
                                           fmt::join(kMaskNames, ", "),
                                           suggestion(name, kMaskNames)));
    }
  }
  return masks;
}

}  // namespace geo::io
