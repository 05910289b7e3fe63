#include "geo/core/field.hpp"

#include <algorithm>
#include <array>

namespace geo::field {
namespace {

constexpr std::array kDirectionFlags{
    Flag{0, "none"},       Flag{1, "north"},      Flag{2, "north_east"},
    Flag{3, "east"},       Flag{4, "south_east"}, Flag{5, "south"},
    Flag{6, "south_west"}, Flag{7, "west"},       Flag{8, "north_west"}};

constexpr std::array kBoundaryFlags{Flag{0, "interior"}, Flag{1, "convergent"},
                                    Flag{2, "divergent"}, Flag{3, "transform"}};

constexpr std::array kOrogenyFlags{Flag{0, "none"}, Flag{1, "andean"}, Flag{2, "himalayan"}};

constexpr std::array kRockFlags{Flag{0, "basalt"},    Flag{1, "schist"},    Flag{2, "granite"},
                                Flag{3, "quartzite"}, Flag{4, "sandstone"}, Flag{5, "limestone"}};

constexpr std::array kBiomeFlags{Flag{0, "ocean"},
                                 Flag{1, "tundra"},
                                 Flag{2, "boreal_forest"},
                                 Flag{3, "temperate_forest"},
                                 Flag{4, "temperate_grassland"},
                                 Flag{5, "mediterranean_scrub"},
                                 Flag{6, "tropical_rainforest"},
                                 Flag{7, "tropical_savanna"},
                                 Flag{8, "hot_desert"},
                                 Flag{9, "subtropical_forest"},
                                 Flag{10, "alpine"},
                                 Flag{11, "steppe"}};

// Numbering and order as Beck et al. (2018); 0 is the sea.
constexpr std::array kKoppenFlags{
    Flag{0, "ocean"}, Flag{1, "Af"},   Flag{2, "Am"},   Flag{3, "Aw"},   Flag{4, "BWh"},
    Flag{5, "BWk"},   Flag{6, "BSh"},  Flag{7, "BSk"},  Flag{8, "Csa"},  Flag{9, "Csb"},
    Flag{10, "Csc"},  Flag{11, "Cwa"}, Flag{12, "Cwb"}, Flag{13, "Cwc"}, Flag{14, "Cfa"},
    Flag{15, "Cfb"},  Flag{16, "Cfc"}, Flag{17, "Dsa"}, Flag{18, "Dsb"}, Flag{19, "Dsc"},
    Flag{20, "Dsd"},  Flag{21, "Dwa"}, Flag{22, "Dwb"}, Flag{23, "Dwc"}, Flag{24, "Dwd"},
    Flag{25, "Dfa"},  Flag{26, "Dfb"}, Flag{27, "Dfc"}, Flag{28, "Dfd"}, Flag{29, "ET"},
    Flag{30, "EF"}};

}  // namespace

const Field<std::int16_t> plate_id{{"plate_id",
                                    "1",
                                    "",
                                    "number of the tectonic plate, from 0",
                                    Type::int16,
                                    {},
                                    -1,
                                    "area: point"}};
const Field<float> continental_fraction{{"continental_fraction", "1", "",
                                         "share of continental crust, 0 ocean floor to 1 continent",
                                         Type::float32}};
const Field<float> plate_velocity_east{
    {"plate_velocity_east", "mm yr-1", "", "eastward velocity of the plate", Type::float32}};
const Field<float> plate_velocity_north{
    {"plate_velocity_north", "mm yr-1", "", "northward velocity of the plate", Type::float32}};
const Field<std::int8_t> boundary_type{{"boundary_type", "", "",
                                        "what adjacent plates do to each other", Type::int8,
                                        kBoundaryFlags, -1, "area: point"}};
const Field<float> boundary_strength{
    {"boundary_strength", "1", "",
     "relative velocity across the plate boundary over the fastest on the planet", Type::float32}};
const Field<float> crust_age{{"crust_age", "Myr", "",
                              "age of the ocean floor, on continents of the last thermal event",
                              Type::float32}};
const Field<std::int8_t> orogeny_type{{"orogeny_type", "", "",
                                       "mountain building at the nearest convergent boundary",
                                       Type::int8, kOrogenyFlags, -1, "area: point"}};
const Field<float> heat_anomaly{
    {"heat_anomaly", "1", "", "heat of the mantle below against its mean, 0 to 1", Type::float32}};
const Field<float> crust_elevation{{"crust_elevation", "m", "",
                                    "height of the crust that the plates' history has made",
                                    Type::float32}};
const Field<float> orogeny_age{
    {"orogeny_age", "Myr", "", "time since continental crust was last folded", Type::float32}};
const Field<float> fold_direction_east{
    {"fold_direction_east", "1", "", "eastward part of the direction of folds", Type::float32}};
const Field<float> fold_direction_north{
    {"fold_direction_north", "1", "", "northward part of the direction of folds", Type::float32}};
const Field<float> ridge_direction_east{
    {"ridge_direction_east", "1", "",
     "eastward part of the direction of the ridge that made the floor", Type::float32}};
const Field<float> ridge_direction_north{
    {"ridge_direction_north", "1", "",
     "northward part of the direction of the ridge that made the floor", Type::float32}};
const Field<float> ranking{
    {"ranking", "1", "", "what orders places by height, in any unit", Type::float32}};
const Field<float> convergent_deformation{
    {"convergent_deformation", "1", "",
     "shortening of the crust near convergent boundaries, 0 to 1", Type::float32}};
const Field<float> divergent_deformation{
    {"divergent_deformation", "1", "", "stretching of the crust near divergent boundaries, 0 to 1",
     Type::float32}};
const Field<float> transform_deformation{{"transform_deformation", "1", "",
                                          "shear of the crust near transform boundaries, 0 to 1",
                                          Type::float32}};
const Field<float> lithospheric_weakness{
    {"lithospheric_weakness", "1", "",
     "weakness of the lithosphere, 1 at plate boundaries, 0 in cratons", Type::float32}};
const Field<float> crust_thickness{
    {"crust_thickness", "m", "", "thickness of the crystalline crust", Type::float32}};
const Field<float> crust_density{
    {"crust_density", "kg m-3", "", "mean density of the crust", Type::float32}};
const Field<std::int8_t> rock_type{
    {"rock_type", "", "", "rock at the surface", Type::int8, kRockFlags, -1, "area: point"}};
const Field<float> elevation{{"elevation", "m", "surface_altitude",
                              "elevation of the solid surface above the planet's sea level",
                              Type::float32}};
const Field<float> uplift_rate{{"uplift_rate", "m yr-1", "", "rock uplift rate", Type::float32}};
const Field<float> erosion_rate{
    {"erosion_rate", "m yr-1", "", "surface lowering by rivers and hillslopes", Type::float32}};
const Field<float> erodibility{{"erodibility", "yr-1", "",
                                "stream-power erodibility K, with m = 0.5 and n = 1",
                                Type::float32}};
const Field<double> drainage_area{{"drainage_area",
                                   "m2",
                                   "",
                                   "upstream area including the cell",
                                   Type::float64,
                                   {},
                                   -1,
                                   "area: point"}};
const Field<double> inflow_area{{"inflow_area",
                                 "m2",
                                 "",
                                 "drainage area beyond the edge whose water enters here",
                                 Type::float64,
                                 {},
                                 -1,
                                 "area: point"}};
const Field<float> inflow_discharge{{"inflow_discharge",
                                     "m3 s-1",
                                     "",
                                     "mean discharge that enters here from beyond the edge",
                                     Type::float32,
                                     {},
                                     -1,
                                     "area: point"}};
const Field<std::int32_t> flow_receiver{
    {"flow_receiver",
     "1",
     "",
     "flat index (row * nx + column) of the cell that takes the water",
     Type::int32,
     {},
     -1,
     "area: point"}};
const Field<std::int8_t> flow_direction{{"flow_direction", "", "",
                                         "direction in which the water leaves", Type::int8,
                                         kDirectionFlags, -1, "area: point"}};
const Field<float> temperature{{"temperature",
                                "degC",
                                "air_temperature",
                                "annual mean air temperature near the surface",
                                Type::float32,
                                {},
                                -1,
                                "area: mean time: mean"}};
const Field<float> temperature_range{
    {"temperature_range", "K", "", "warmest minus coldest month", Type::float32}};
const Field<float> precipitation{{"precipitation",
                                  "mm yr-1",
                                  "lwe_precipitation_rate",
                                  "annual precipitation",
                                  Type::float32,
                                  {},
                                  -1,
                                  "area: mean time: mean"}};
const Field<float> precipitation_seasonality{
    {"precipitation_seasonality", "1", "",
     "amplitude of the annual harmonic of precipitation over its mean, positive when the "
     "summer of the hemisphere is wet",
     Type::float32}};
const Field<float> wind_east{
    {"wind_east", "m s-1", "eastward_wind", "eastward wind near the surface", Type::float32}};
const Field<float> wind_north{
    {"wind_north", "m s-1", "northward_wind", "northward wind near the surface", Type::float32}};
const Field<float> distance_to_coast{{"distance_to_coast",
                                      "m",
                                      "",
                                      "distance to the nearest coast, on land and at sea",
                                      Type::float32,
                                      {},
                                      -1,
                                      "area: point"}};
const Field<float> potential_evaporation{
    {"potential_evaporation", "mm yr-1", "", "annual potential evaporation", Type::float32}};
const Field<float> slope{{"slope",
                          "m m-1",
                          "",
                          "steepest descent to any of the eight neighbours",
                          Type::float32,
                          {},
                          -1,
                          "area: point"}};
const Field<float> discharge{{"discharge",
                              "m3 s-1",
                              "water_volume_transport_in_river_channel",
                              "mean discharge out of the cell",
                              Type::float32,
                              {},
                              -1,
                              "area: point"}};
const Field<float> river_intensity{{"river_intensity",
                                    "1",
                                    "",
                                    "prominence of the river in the cell, 0 to 1",
                                    Type::float32,
                                    {},
                                    -1,
                                    "area: point"}};
const Field<float> lake_depth{
    {"lake_depth", "m", "", "depth of standing water above the solid surface", Type::float32}};
const Field<std::int32_t> lake_id{{"lake_id",
                                   "1",
                                   "",
                                   "number of the lake, 0 where there is none",
                                   Type::int32,
                                   {},
                                   -1,
                                   "area: point"}};
const Field<std::int32_t> basin_id{{"basin_id",
                                    "1",
                                    "",
                                    "number of the drainage basin, 1 the largest, 0 the sea",
                                    Type::int32,
                                    {},
                                    -1,
                                    "area: point"}};
const Field<std::int8_t> stream_order{
    {"stream_order", "1", "", "Strahler order of the river", Type::int8, {}, -1, "area: point"}};
const Field<std::int8_t> biome{
    {"biome", "", "", "biome after Whittaker", Type::int8, kBiomeFlags, -1, "area: point"}};
const Field<std::int8_t> koppen_class{{"koppen_class", "", "", "climate class after Köppen-Geiger",
                                       Type::int8, kKoppenFlags, -1, "area: point"}};
const Field<float> net_primary_productivity{{"net_primary_productivity", "g m-2 yr-1", "",
                                             "net primary productivity as dry matter (Miami model)",
                                             Type::float32}};
const Field<float> settlement_suitability{{"settlement_suitability", "1", "",
                                           "suitability for agriculture and settlement, 0 to 1",
                                           Type::float32}};

std::span<const FieldSpec* const> all() {
  static const std::array<const FieldSpec*, 51> kAll{&plate_id,
                                                     &continental_fraction,
                                                     &plate_velocity_east,
                                                     &plate_velocity_north,
                                                     &boundary_type,
                                                     &boundary_strength,
                                                     &crust_age,
                                                     &orogeny_type,
                                                     &heat_anomaly,
                                                     &crust_elevation,
                                                     &orogeny_age,
                                                     &fold_direction_east,
                                                     &fold_direction_north,
                                                     &ridge_direction_east,
                                                     &ridge_direction_north,
                                                     &ranking,
                                                     &convergent_deformation,
                                                     &divergent_deformation,
                                                     &transform_deformation,
                                                     &lithospheric_weakness,
                                                     &crust_thickness,
                                                     &crust_density,
                                                     &rock_type,
                                                     &elevation,
                                                     &erodibility,
                                                     &uplift_rate,
                                                     &erosion_rate,
                                                     &drainage_area,
                                                     &inflow_area,
                                                     &inflow_discharge,
                                                     &flow_receiver,
                                                     &flow_direction,
                                                     &temperature,
                                                     &temperature_range,
                                                     &precipitation,
                                                     &precipitation_seasonality,
                                                     &wind_east,
                                                     &wind_north,
                                                     &distance_to_coast,
                                                     &potential_evaporation,
                                                     &slope,
                                                     &discharge,
                                                     &river_intensity,
                                                     &lake_depth,
                                                     &lake_id,
                                                     &basin_id,
                                                     &stream_order,
                                                     &biome,
                                                     &koppen_class,
                                                     &net_primary_productivity,
                                                     &settlement_suitability};
  return kAll;
}

const FieldSpec* find(std::string_view name) {
  const auto fields = all();
  const auto at = std::find_if(fields.begin(), fields.end(),
                               [&](const FieldSpec* spec) { return spec->name == name; });
  return at == fields.end() ? nullptr : *at;
}

}  // namespace geo::field
