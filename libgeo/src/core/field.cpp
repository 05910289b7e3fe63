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

constexpr std::array kPolarityFlags{Flag{0, "none"}, Flag{1, "overriding"}, Flag{2, "subducting"}};

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

const Field<std::int16_t> plate_id{{.name = "plate_id",
                                    .units = "1",
                                    .doc = "number of the tectonic plate, from 0",
                                    .type = Type::int16,
                                    .cell_methods = "area: point",
                                    .least = 0.0}};
const Field<float> continental_fraction{
    {.name = "continental_fraction",
     .units = "1",
     .doc = "share of continental crust, 0 ocean floor to 1 continent",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};
const Field<float> plate_velocity_east{{.name = "plate_velocity_east",
                                        .units = "mm yr-1",
                                        .doc = "eastward velocity of the plate",
                                        .type = Type::float32}};
const Field<float> plate_velocity_north{{.name = "plate_velocity_north",
                                         .units = "mm yr-1",
                                         .doc = "northward velocity of the plate",
                                         .type = Type::float32}};
const Field<std::int8_t> boundary_type{
    {.name = "boundary_type",
     .units = "",
     .doc = "relative motion of adjacent plates at their boundary",
     .type = Type::int8,
     .flags = kBoundaryFlags,
     .cell_methods = "area: point"}};
const Field<float> boundary_strength{
    {.name = "boundary_strength",
     .units = "1",
     .doc = "relative velocity across the plate boundary over the fastest on the planet",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};
const Field<std::int8_t> subduction_polarity{
    {.name = "subduction_polarity",
     .units = "",
     .doc = "at convergent boundaries, whether the plate here overrides the other or subducts",
     .type = Type::int8,
     .flags = kPolarityFlags,
     .cell_methods = "area: point"}};
const Field<float> crust_age{
    {.name = "crust_age",
     .units = "Myr",
     .doc = "age of the ocean floor, on continents of the last thermal event",
     .type = Type::float32,
     .least = 0.0}};
const Field<std::int8_t> orogeny_type{
    {.name = "orogeny_type",
     .units = "",
     .doc = "mountain building at the nearest convergent boundary",
     .type = Type::int8,
     .flags = kOrogenyFlags,
     .cell_methods = "area: point"}};
const Field<float> heat_anomaly{{.name = "heat_anomaly",
                                 .units = "1",
                                 .doc = "heat of the mantle below against its mean, 0 to 1",
                                 .type = Type::float32,
                                 .least = 0.0,
                                 .most = 1.0}};
const Field<float> crust_elevation{{.name = "crust_elevation",
                                    .units = "m",
                                    .doc = "elevation of the crust after the plates' history",
                                    .type = Type::float32}};
const Field<float> orogeny_age{{.name = "orogeny_age",
                                .units = "Myr",
                                .doc = "time since continental crust was last folded",
                                .type = Type::float32,
                                .least = 0.0}};
const Field<float> fold_direction_east{{.name = "fold_direction_east",
                                        .units = "1",
                                        .doc = "eastward component of the direction of folds",
                                        .type = Type::float32,
                                        .least = -1.0,
                                        .most = 1.0}};
const Field<float> fold_direction_north{{.name = "fold_direction_north",
                                         .units = "1",
                                         .doc = "northward component of the direction of folds",
                                         .type = Type::float32,
                                         .least = -1.0,
                                         .most = 1.0}};
const Field<float> ridge_direction_east{
    {.name = "ridge_direction_east",
     .units = "1",
     .doc = "eastward component of the direction of the ridge that made the floor",
     .type = Type::float32,
     .least = -1.0,
     .most = 1.0}};
const Field<float> ridge_direction_north{
    {.name = "ridge_direction_north",
     .units = "1",
     .doc = "northward component of the direction of the ridge that made the floor",
     .type = Type::float32,
     .least = -1.0,
     .most = 1.0}};
const Field<float> ranking{{.name = "ranking",
                            .units = "1",
                            .doc = "quantity that ranks places by height, in any unit",
                            .type = Type::float32}};
const Field<float> convergent_deformation{
    {.name = "convergent_deformation",
     .units = "1",
     .doc = "shortening of the crust near convergent boundaries, 0 to 1",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};
const Field<float> divergent_deformation{
    {.name = "divergent_deformation",
     .units = "1",
     .doc = "stretching of the crust near divergent boundaries, 0 to 1",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};
const Field<float> transform_deformation{
    {.name = "transform_deformation",
     .units = "1",
     .doc = "shear of the crust near transform boundaries, 0 to 1",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};
const Field<float> lithospheric_weakness{
    {.name = "lithospheric_weakness",
     .units = "1",
     .doc = "weakness of the lithosphere, 1 at plate boundaries, 0 in cratons",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};
const Field<float> crust_thickness{{.name = "crust_thickness",
                                    .units = "m",
                                    .doc = "thickness of the crystalline crust",
                                    .type = Type::float32,
                                    .least = 0.0}};
const Field<float> crust_density{{.name = "crust_density",
                                  .units = "kg m-3",
                                  .doc = "mean density of the crust",
                                  .type = Type::float32,
                                  .least = 0.0}};
const Field<std::int8_t> rock_type{{.name = "rock_type",
                                    .units = "",
                                    .doc = "rock at the surface",
                                    .type = Type::int8,
                                    .flags = kRockFlags,
                                    .cell_methods = "area: point"}};
const Field<float> thickening_rate{{.name = "thickening_rate",
                                    .units = "m yr-1",
                                    .doc = "rate at which shortening thickens the crust of belts",
                                    .type = Type::float32,
                                    .least = 0.0}};
const Field<float> elevation{{.name = "elevation",
                              .units = "m",
                              .standard_name = "height_above_mean_sea_level",
                              .doc = "elevation of the solid surface above the planet's sea level",
                              .type = Type::float32}};
const Field<float> uplift_rate{
    {.name = "uplift_rate", .units = "m yr-1", .doc = "rock uplift rate", .type = Type::float32}};
const Field<float> erosion_rate{{.name = "erosion_rate",
                                 .units = "m yr-1",
                                 .doc = "surface lowering by rivers and hillslopes",
                                 .type = Type::float32}};
const Field<float> sediment_thickness{{.name = "sediment_thickness",
                                       .units = "m",
                                       .doc = "sediment on land and at sea, as rock without pores",
                                       .type = Type::float32,
                                       .least = 0.0}};
const Field<float> crust_thickness_change{{.name = "crust_thickness_change",
                                           .units = "m",
                                           .doc = "change of the crust's thickness by shortening, "
                                                  "deposition and erosion since stage isostasy",
                                           .type = Type::float32}};
const Field<float> deposition_rate{{.name = "deposition_rate",
                                    .units = "m yr-1",
                                    .doc = "deposition rate of sediment on land and at sea",
                                    .type = Type::float32,
                                    .least = 0.0}};
const Field<float> sediment_flux{{.name = "sediment_flux",
                                  .units = "m3 yr-1",
                                  .doc = "sediment that leaves the cell with its river, or reaches "
                                         "the sea there, as rock without pores",
                                  .type = Type::float32,
                                  .cell_methods = "area: point",
                                  .least = 0.0}};
const Field<float> ice_thickness{
    {.name = "ice_thickness",
     .units = "m",
     .standard_name = "land_ice_thickness",
     .doc = "ice of glaciers and ice sheets, mean of the cell; elevation is their surface",
     .type = Type::float32,
     .least = 0.0}};
const Field<float> glacial_erosion{
    {.name = "glacial_erosion",
     .units = "m",
     .doc = "rock that ice has eroded from the bed, less what it has deposited there",
     .type = Type::float32}};
const Field<float> erodibility{{.name = "erodibility",
                                .units = "yr-1",
                                .doc = "stream-power erodibility K, with m = 0.5 and n = 1",
                                .type = Type::float32,
                                .least = 0.0}};
const Field<double> drainage_area{{.name = "drainage_area",
                                   .units = "m2",
                                   .doc = "upstream area including the cell",
                                   .type = Type::float64,
                                   .cell_methods = "area: point",
                                   .least = 0.0}};
const Field<double> inflow_area{{.name = "inflow_area",
                                 .units = "m2",
                                 .doc = "drainage area beyond the edge whose water enters here",
                                 .type = Type::float64,
                                 .cell_methods = "area: point",
                                 .least = 0.0}};
const Field<float> inflow_discharge{{.name = "inflow_discharge",
                                     .units = "m3 s-1",
                                     .doc = "mean discharge that enters here from beyond the edge",
                                     .type = Type::float32,
                                     .cell_methods = "area: point",
                                     .least = 0.0}};
const Field<std::int32_t> flow_receiver{
    {.name = "flow_receiver",
     .units = "1",
     .doc = "flat index (row * nx + column) of the cell that takes the water",
     .type = Type::int32,
     .cell_methods = "area: point",
     .least = 0.0}};
const Field<std::int8_t> flow_direction{{.name = "flow_direction",
                                         .units = "",
                                         .doc = "direction in which the water leaves",
                                         .type = Type::int8,
                                         .flags = kDirectionFlags,
                                         .cell_methods = "area: point"}};
const Field<float> temperature{{.name = "temperature",
                                .units = "degC",
                                .standard_name = "air_temperature",
                                .doc = "annual mean air temperature near the surface",
                                .type = Type::float32,
                                .cell_methods = "area: mean time: mean",
                                .least = -273.15}};
const Field<float> temperature_range{{.name = "temperature_range",
                                      .units = "K",
                                      .doc = "warmest minus coldest month",
                                      .type = Type::float32,
                                      .least = 0.0}};
const Field<float> precipitation{{.name = "precipitation",
                                  .units = "mm yr-1",
                                  .standard_name = "lwe_precipitation_rate",
                                  .doc = "annual precipitation",
                                  .type = Type::float32,
                                  .cell_methods = "area: mean time: mean",
                                  .least = 0.0}};
const Field<float> precipitation_seasonality{
    {.name = "precipitation_seasonality",
     .units = "1",
     .doc = "amplitude of the annual harmonic of precipitation over its mean, positive when the "
            "summer of the hemisphere is wet",
     .type = Type::float32,
     .least = -2.0,
     .most = 2.0}};
const Field<float> wind_east{{.name = "wind_east",
                              .units = "m s-1",
                              .standard_name = "eastward_wind",
                              .doc = "eastward wind near the surface",
                              .type = Type::float32}};
const Field<float> wind_north{{.name = "wind_north",
                               .units = "m s-1",
                               .standard_name = "northward_wind",
                               .doc = "northward wind near the surface",
                               .type = Type::float32}};
const Field<float> distance_to_coast{{.name = "distance_to_coast",
                                      .units = "m",
                                      .doc = "distance to the nearest coast, on land and at sea",
                                      .type = Type::float32,
                                      .cell_methods = "area: point"}};
const Field<float> potential_evapotranspiration{{.name = "potential_evapotranspiration",
                                                 .units = "mm yr-1",
                                                 .doc = "annual potential evapotranspiration",
                                                 .type = Type::float32,
                                                 .least = 0.0}};
const Field<float> slope{{.name = "slope",
                          .units = "m m-1",
                          .doc = "steepest descent to any of the eight neighbours",
                          .type = Type::float32,
                          .cell_methods = "area: point",
                          .least = 0.0}};
const Field<float> discharge{{.name = "discharge",
                              .units = "m3 s-1",
                              .standard_name = "water_volume_transport_in_river_channel",
                              .doc = "mean discharge out of the cell",
                              .type = Type::float32,
                              .cell_methods = "area: point",
                              .least = 0.0}};
const Field<float> river_intensity{{.name = "river_intensity",
                                    .units = "1",
                                    .doc = "prominence of the river in the cell, 0 to 1",
                                    .type = Type::float32,
                                    .cell_methods = "area: point",
                                    .least = 0.0,
                                    .most = 1.0}};
const Field<float> lake_depth{{.name = "lake_depth",
                               .units = "m",
                               .doc = "depth of standing water above the solid surface",
                               .type = Type::float32,
                               .least = 0.0}};
const Field<std::int32_t> lake_id{{.name = "lake_id",
                                   .units = "1",
                                   .doc = "number of the lake, 0 where there is none",
                                   .type = Type::int32,
                                   .cell_methods = "area: point",
                                   .least = 0.0}};
const Field<std::int32_t> basin_id{{.name = "basin_id",
                                    .units = "1",
                                    .doc = "number of the drainage basin, 1 the largest, 0 the sea",
                                    .type = Type::int32,
                                    .cell_methods = "area: point",
                                    .least = 0.0}};
const Field<std::int8_t> stream_order{{.name = "stream_order",
                                       .units = "1",
                                       .doc = "Strahler order of the river",
                                       .type = Type::int8,
                                       .cell_methods = "area: point",
                                       .least = 0.0}};
const Field<std::int8_t> biome{{.name = "biome",
                                .units = "",
                                .doc = "biome after Whittaker",
                                .type = Type::int8,
                                .flags = kBiomeFlags,
                                .cell_methods = "area: point"}};
const Field<float> sea_ice_area_fraction{
    {.name = "sea_ice_area_fraction",
     .units = "1",
     .standard_name = "sea_ice_area_fraction",
     .doc = "share of the sea's surface under ice, annual mean",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};
const Field<float> ocean_current_east{{.name = "ocean_current_east",
                                       .units = "m s-1",
                                       .standard_name = "eastward_sea_water_velocity",
                                       .doc = "eastward velocity of wind-driven currents, annual "
                                              "mean, 0 on land and on parts of a planet",
                                       .type = Type::float32}};
const Field<float> ocean_current_north{{.name = "ocean_current_north",
                                        .units = "m s-1",
                                        .standard_name = "northward_sea_water_velocity",
                                        .doc = "northward velocity of wind-driven currents, annual "
                                               "mean, 0 on land and on parts of a planet",
                                        .type = Type::float32}};
const Field<std::int8_t> koppen_class{{.name = "koppen_class",
                                       .units = "",
                                       .doc = "climate class after Köppen-Geiger",
                                       .type = Type::int8,
                                       .flags = kKoppenFlags,
                                       .cell_methods = "area: point"}};
const Field<float> net_primary_productivity{
    {.name = "net_primary_productivity",
     .units = "g m-2 yr-1",
     .doc = "net primary productivity as dry matter (Miami model)",
     .type = Type::float32,
     .least = 0.0}};
const Field<float> settlement_suitability{
    {.name = "settlement_suitability",
     .units = "1",
     .doc = "suitability for agriculture and settlement, 0 to 1",
     .type = Type::float32,
     .least = 0.0,
     .most = 1.0}};

const Field<float> temperature_monthly{{.name = "temperature_monthly",
                                        .units = "degC",
                                        .standard_name = "air_temperature",
                                        .doc = "mean temperature near the ground of each month",
                                        .type = Type::float32}};
const Field<float> precipitation_monthly{{.name = "precipitation_monthly",
                                          .units = "mm month-1",
                                          .doc = "precipitation of each month",
                                          .type = Type::float32,
                                          .least = 0}};
const Field<float> wind_east_monthly{{.name = "wind_east_monthly",
                                      .units = "m s-1",
                                      .standard_name = "eastward_wind",
                                      .doc = "eastward wind near the ground of each month",
                                      .type = Type::float32}};
const Field<float> wind_north_monthly{{.name = "wind_north_monthly",
                                       .units = "m s-1",
                                       .standard_name = "northward_wind",
                                       .doc = "northward wind near the ground of each month",
                                       .type = Type::float32}};

std::span<const FieldSpec* const> monthly() {
  static constexpr std::array<const FieldSpec*, 4> kMonthly{
      &temperature_monthly, &precipitation_monthly, &wind_east_monthly, &wind_north_monthly};
  return kMonthly;
}

std::span<const FieldSpec* const> all() {
  static const auto kAll = std::to_array<const FieldSpec*>({&plate_id,
                                                            &continental_fraction,
                                                            &plate_velocity_east,
                                                            &plate_velocity_north,
                                                            &boundary_type,
                                                            &boundary_strength,
                                                            &subduction_polarity,
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
                                                            &thickening_rate,
                                                            &uplift_rate,
                                                            &erosion_rate,
                                                            &sediment_thickness,
                                                            &deposition_rate,
                                                            &sediment_flux,
                                                            &ice_thickness,
                                                            &glacial_erosion,
                                                            &crust_thickness_change,
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
                                                            &potential_evapotranspiration,
                                                            &slope,
                                                            &discharge,
                                                            &river_intensity,
                                                            &lake_depth,
                                                            &lake_id,
                                                            &basin_id,
                                                            &stream_order,
                                                            &biome,
                                                            &sea_ice_area_fraction,
                                                            &ocean_current_east,
                                                            &ocean_current_north,
                                                            &koppen_class,
                                                            &net_primary_productivity,
                                                            &settlement_suitability});
  return kAll;
}

const FieldSpec* find(std::string_view name) {
  const auto fields = all();
  const auto at = std::find_if(fields.begin(), fields.end(),
                               [&](const FieldSpec* spec) { return spec->name == name; });
  return at == fields.end() ? nullptr : *at;
}

}  // namespace geo::field
