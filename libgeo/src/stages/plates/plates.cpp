#include "geo/stages/plates.hpp"

#include "growth.hpp"

namespace geo {

std::vector<Parameter> PlatesParameters::declarations() {
  return {
      choice("plates.model", model, {"growth"}, "how plates come about", "tectonica2026"),
      integer("plates.count", growth.count, "1", 2, 100, "number of plates", "tectonica2026"),
      real("plates.speed_cm_yr", growth.speed_cm_yr, "cm yr-1", 0.1, 50.0,
           "middle of the plates' speeds", "tectonica2026"),
      real("plates.mantle_heat", growth.mantle_heat, "1", 0.0, 1.0,
           "how much hotter than the least the mantle below a plate may be", "tectonica2026"),
      real("plates.size_spread", growth.size_spread, "1", 0.0, 3.0,
           "standard deviation of the logarithm of the plates' bias in size", "bird2003"),
      real("plates.roughness", growth.roughness, "1", 0.0, 2.0,
           "roughness of the cost at which plates grow", "tectonica2026"),
      real("plates.structure_km", growth.structure_km, "km", 50.0, 20000.0,
           "wavelength of weak and strong zones that plates grow along and around",
           "tectonica2026"),
      real("plates.polar_resistance", growth.polar_resistance, "1", 0.0, 1.0,
           "extra cost of growth at the poles", "tectonica2026"),
      real("plates.smallest_part_km2", growth.smallest_part_km2, "km2", 0.0, 1e8,
           "smaller detached pieces of a plate join a neighbour", "tectonica2026"),
      flag("plates.no_net_rotation", no_net_rotation, "take the common rotation of all plates away",
           "bird2003"),
      integer("plates.evolution_steps", evolution_steps, "1", 0, 100,
              "steps of 0.9 to 3.4 Myr in which the grown plates move", "tectonica2026"),
      real("plates.boundary_smoothing_km", boundary_smoothing_km, "km", 50.0, 2000.0,
           "length over which direction and motion of a boundary are taken", "design"),
      real("plates.boundary_width_km", boundary_width_km, "km", 10.0, 200.0,
           "width of the band of cells that count as boundary", "tectonica2026"),
      real("plates.outline_bending_km", outline_bending_km, "km", 0.0, 200.0,
           "how far the outlines of plates bend below the resolution they grow at", "design"),
      choice("plates.continents", continents, {"cratons", "plates"},
             "continents grow together from cratons, or are whole plates", "tectonica2026"),
      real("plates.continental_share", cratons.share, "1", 0.0, 1.0,
           "share of the planet that is continental crust, with cratons", "cogley1984"),
      real("plates.land_buffer", land_buffer, "1", 0.0, 1.0,
           "share of continental crust beyond that of land, with whole plates", "tectonica2026"),
      real("plates.cratons_per_planet", cratons.per_sphere, "1", 1.0, 500.0,
           "number of cratons if every plate carried some", "design"),
      real("plates.craton_smallest_km", cratons.smallest_km, "km", 50.0, 5000.0,
           "least radius of a craton", "artemieva2001"),
      real("plates.craton_largest_km", cratons.largest_km, "km", 50.0, 5000.0,
           "largest radius of a craton", "artemieva2001"),
      real("plates.ridge_clearance_km", cratons.ridge_clearance_km, "km", 0.0, 5000.0,
           "length over which a spreading ridge thins out continents", "design"),
      real("plates.coast_roughness", coast_roughness, "1", 0.0, 5.0,
           "deviation of the noise that frays the continents' edges, in e-foldings of a craton",
           "design"),
      real("plates.coast_wavelength_km", coast_wavelength_km, "km", 50.0, 20000.0,
           "longest wavelength of that noise", "design"),
      real("plates.passive_margin_km", passive_margin_km, "km", 1.0, 2000.0,
           "width of a margin far from convergent boundaries", "watts2001"),
      real("plates.active_margin_km", active_margin_km, "km", 1.0, 2000.0,
           "width of a margin at a convergent boundary", "watts2001"),
      real("plates.oldest_floor_myr", oldest_floor_myr, "Myr", 1.0, 5000.0,
           "age that the sea floor approaches far from its ridge", "muller2008"),
      real("plates.plumes", plumes, "1", 0.0, 200.0, "number of mantle plumes", "design"),
      real("plates.orogeny_reach_km", orogeny_reach_km, "km", 0.0, 5000.0,
           "distance from a convergent boundary within which a continent belongs to its orogen",
           "england1982"),
  };
}

namespace {

class PlatesStage final : public Stage {
 public:
  explicit PlatesStage(PlatesParameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] const StageInfo& info() const override {
    static const StageInfo kInfo{
        "plates",
        "tectonic plates, their motion, boundaries, sea floor and continents",
        {},
        {},
        {&field::plate_id, &field::continental_fraction, &field::plate_velocity_east,
         &field::plate_velocity_north, &field::boundary_type, &field::boundary_strength,
         &field::crust_age, &field::orogeny_type, &field::heat_anomaly}};
    return kInfo;
  }
  [[nodiscard]] std::vector<Parameter> parameters() override { return parameters_.declarations(); }

  void run(StageIo& io, Context& context) const override { grow(parameters_, io, context); }

 private:
  PlatesParameters parameters_;
};

}  // namespace

std::unique_ptr<Stage> make_plates_stage(PlatesParameters parameters) {
  return std::make_unique<PlatesStage>(std::move(parameters));
}

}  // namespace geo
