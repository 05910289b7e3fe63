#include "crust.hpp"

#include "geo/core/error.hpp"

namespace geo {
namespace {

std::span<const float> made_by_plates(const StageIo& io) {
  const auto elevation_m = io.read_optional(field::crust_elevation);
  const auto thickness_m = io.read_optional(field::crust_thickness);
  if (elevation_m.empty() || thickness_m.empty()) {
    throw InputError(
        "isostasy: crust = \"simulated\" needs crust_elevation and crust_thickness, which "
        "plates.model = \"sphere\" writes");
  }
  return elevation_m;
}

}  // namespace

Crust::Crust(const IsostasyParameters& settings, StageIo& io, const Context& context)
    : parameters(settings),
      planet(context.planet),
      seed(context.seed),
      grid(io.grid()),
      radius_km(1e-3 * io.grid().figure().radius_m),
      datum(settings.density),
      plate(io.read(field::plate_id)),
      boundary_type(io.read(field::boundary_type)),
      boundary_strength(io.read(field::boundary_strength)),
      age_myr(io.read(field::crust_age)),
      heat(io.read(field::heat_anomaly)),
      velocity_east(io.read(field::plate_velocity_east)),
      velocity_north(io.read(field::plate_velocity_north)),
      made_elevation_m(settings.crust == "simulated" ? made_by_plates(io)
                                                     : std::span<const float>{}),
      fraction(io.write(field::continental_fraction)),
      convergent(io.write(field::convergent_deformation)),
      divergent(io.write(field::divergent_deformation)),
      transform(io.write(field::transform_deformation)),
      weakness(io.write(field::lithospheric_weakness)),
      thickness_m(io.write(field::crust_thickness)),
      density(io.write(field::crust_density)),
      rock(io.write(field::rock_type)),
      erodibility(io.write(field::erodibility)),
      elevation_m(io.write(field::elevation)) {}

}  // namespace geo
