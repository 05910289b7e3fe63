#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geo/core/stage.hpp"
#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/erosion/landscape.hpp"
#include "ice_age.hpp"
#include "surface_events.hpp"

namespace geo {

/// The parameters of a run. Throws ConfigurationError where they do not go together.
const ErosionParameters& checked(const ErosionParameters& p);

/// One run of the erosion stage: a planet's landscape, and the water, the climate, the ice and the
/// events that work on it. `wear`, then `finish`, then `write`.
class ErosionRun {
 public:
  ErosionRun(const ErosionParameters& parameters, StageIo& io, Context& context);

  /// The steps, between the straits that the sea cuts before and after them.
  void wear();
  /// What shapes the land once rivers have: noise, warping, hypsometry, the sea's share, events of
  /// today, and the weight of today's ice.
  void finish();
  /// Fields, budgets, and the ice on the finished bed.
  void write();

 private:
  const Drainage& route();
  bool strike(std::int64_t step);
  [[nodiscard]] IceWork ice_of(std::int64_t step);
  bool move_coast();
  void turn_climate(std::int64_t step);
  template <class Change>
  bool reshape(Change&& change);
  void cut_last_sills();
  [[nodiscard]] bool lay_ice();
  void drain_surface(bool iced);
  void write_sediment_flux(std::vector<float>& carried_m3_yr) const;
  void write_drainage();
  void write_incision_rate() const;
  void write_erosion_rate(std::vector<float>& lowered_m) const;
  void write_crust(std::vector<double>& change_m) const;
  void write_sediment(SedimentRecord& sediment) const;
  void write_rock_uplift(const std::vector<float>& raised_m) const;
  void add_uniform_uplift() const;
  void report() const;

  const ErosionParameters& p_;
  StageIo& io_;
  Context& context_;
  const Grid& grid_;
  std::span<float> elevation_m_;
  bool grows_;  ///< whether belts thicken while the landscape runs
  std::span<float> uplift_m_yr_;
  std::vector<float> erodibility_;
  Landscape<float> landscape_;
  Drainage drainage_;
  bool is_routed_ = false;  ///< along the finished bed
  SurfaceEvents events_;
  bool follows_rain_;
  std::optional<LandClimate> climate_;
  std::optional<IceAge> ice_;
  std::span<float> scoured_m_;
  double sea_share_;
};

}  // namespace geo
