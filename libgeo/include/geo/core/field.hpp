#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace geo {

/// Value types that fields are stored in.
enum class Type : std::uint8_t { float32, float64, int8, int16, int32 };

template <class T>
constexpr Type type_of() {
  if constexpr (std::is_same_v<T, float>) return Type::float32;
  if constexpr (std::is_same_v<T, double>) return Type::float64;
  if constexpr (std::is_same_v<T, std::int8_t>) return Type::int8;
  if constexpr (std::is_same_v<T, std::int16_t>) return Type::int16;
  if constexpr (std::is_same_v<T, std::int32_t>) return Type::int32;
}

/// One value of an enumeration, as CF `flag_values` and `flag_meanings` have it. The meaning is
/// one word (underscores for blanks).
struct Flag {
  int value;
  std::string_view meaning;
};

/// One row of the field vocabulary: everything that files, maps and docs need to know about a
/// named quantity. Names equal NetCDF variable names.
struct FieldSpec {
  std::string_view name;
  std::string_view units;  ///< as UDUNITS reads them; "1" for pure numbers, "" for flags
  std::string_view standard_name = {};  ///< CF standard name, or empty where CF has none
  std::string_view doc;                 ///< one phrase, becomes `long_name`
  Type type;
  std::span<const Flag> flags = {};
  /// Value of cells where the quantity does not exist (CF `_FillValue` of integer fields);
  /// floating-point fields use NaN.
  int missing = -1;
  /// How the value stands for the cell: "area: mean", "area: point", "area: sum"; empty: mean.
  std::string_view cell_methods = "area: mean";
  /// What no value falls short of or exceeds, by what the quantity is; infinite without a bound.
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// A row of the vocabulary with the type of its values, so that access is checked by the compiler.
template <class T>
struct Field : FieldSpec {
  using value_type = T;
};

/// The vocabulary: every field that any stage may read or write.
namespace field {
extern const Field<std::int16_t> plate_id;
extern const Field<float> continental_fraction, plate_velocity_east, plate_velocity_north;
extern const Field<std::int8_t> boundary_type;
extern const Field<float> boundary_strength;
extern const Field<std::int8_t> subduction_polarity;
extern const Field<float> crust_age;
extern const Field<std::int8_t> orogeny_type;
extern const Field<float> heat_anomaly, crust_elevation, orogeny_age;
extern const Field<float> fold_direction_east, fold_direction_north;
extern const Field<float> ridge_direction_east, ridge_direction_north;
extern const Field<float> ranking;
extern const Field<float> convergent_deformation, divergent_deformation, transform_deformation;
extern const Field<float> lithospheric_weakness, crust_thickness, crust_density;
extern const Field<std::int8_t> rock_type;
extern const Field<float> elevation;
extern const Field<float> uplift_rate, erosion_rate, erodibility;
extern const Field<float> sediment_thickness, deposition_rate, sediment_flux;
extern const Field<float> ice_thickness, glacial_erosion;
extern const Field<float> thickening_rate, crust_thickness_change;
extern const Field<double> drainage_area, inflow_area;
extern const Field<float> inflow_discharge;
extern const Field<std::int32_t> flow_receiver;
extern const Field<std::int8_t> flow_direction;
extern const Field<float> temperature, temperature_range, precipitation, precipitation_seasonality;
extern const Field<float> wind_east, wind_north, distance_to_coast, potential_evapotranspiration;
extern const Field<float> sea_ice_area_fraction, ocean_current_east, ocean_current_north;
extern const Field<float> slope, discharge, river_intensity, lake_depth;
extern const Field<std::int32_t> lake_id, basin_id;
extern const Field<std::int8_t> stream_order;
extern const Field<std::int8_t> biome, koppen_class;
extern const Field<float> net_primary_productivity, settlement_suitability;

/// Twelve rasters each, never in a state: made month by month as they are written.
extern const Field<float> temperature_monthly, precipitation_monthly;
extern const Field<float> wind_east_monthly, wind_north_monthly;
/// These four.
std::span<const FieldSpec* const> monthly();
/// All that come before, in the order in which files list them.
std::span<const FieldSpec* const> all();
/// The row of that name, or nullptr.
const FieldSpec* find(std::string_view name);
}  // namespace field

/// What the nearest plates do to each other.
enum class BoundaryType : std::int8_t { interior, convergent, divergent, transform };

/// Mountain building at a convergent boundary: ocean under continent, or continent against
/// continent.
enum class OrogenyType : std::int8_t { none, andean, himalayan };

/// What the ground is made of, as far as it decides how fast rivers incise.
enum class RockType : std::int8_t { basalt, schist, granite, quartzite, sandstone, limestone };

/// Biomes 0..11 (Whittaker 1975), colours aside.
enum class Biome : std::int8_t {
  ocean,
  tundra,
  boreal_forest,
  temperate_forest,
  temperate_grassland,
  mediterranean_scrub,
  tropical_rainforest,
  tropical_savanna,
  hot_desert,
  subtropical_forest,
  alpine,
  steppe,
};
inline constexpr int kBiomes = 12;

}  // namespace geo
