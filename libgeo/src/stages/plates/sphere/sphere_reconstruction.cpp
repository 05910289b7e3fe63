#include "sphere_reconstruction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/kernels/plates/region_outline.hpp"

namespace geo {
namespace {

constexpr double kSameTime_myr = 1e-6;

double age_ma(const PlateReconstruction& given, const SphereTectonics& model) {
  return given.start_ma - model.state.time_myr;
}

/// 1 for the samples whose crust lies within an outline of today.
std::vector<std::uint8_t> samples_within(const LaterPlate& plate, const Quaternion& since,
                                         const SphereTectonics& model) {
  const RegionOutline region(plate.outline.rings);
  const Matrix3 there = since.matrix();
  std::vector<std::uint8_t> within(model.mesh->size(), 0);
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    const std::int16_t p = model.state.crust.plate[i];
    if (p < 0) continue;
    const Vector3 at = times(model.frame[p], model.mesh->samples().position(i));
    within[i] = region.holds(place_of(back(there, at))) ? 1 : 0;
  }
  return within;
}

/// The plate on which most of some samples lie, and how many; bodies that others carry stay whole.
std::pair<int, std::int32_t> plate_of_most(const SphereTectonics& model,
                                           const std::vector<std::uint8_t>& within) {
  std::vector<std::int32_t> count(model.state.plates.size(), 0);
  for (std::int32_t i = 0; i < model.mesh->size(); ++i) {
    if (within[i] != 0) ++count[model.state.crust.plate[i]];
  }
  for (std::size_t p = 0; p < count.size(); ++p) {
    if (model.state.plates[p].carrier >= 0) count[p] = 0;
  }
  const auto most = std::max_element(count.begin(), count.end());
  return {static_cast<int>(most - count.begin()), *most};
}

void cut_out(const LaterPlate& plate, const PlateReconstruction& given, SphereTectonics& model,
             Context& context) {
  // Rotations may begin with the outline, within the step.
  const Quaternion since = given.rotations.at(plate.number, age_ma(given, model))
                               .value_or(given.rotations.at(plate.number, plate.from_ma).value());
  const auto within = samples_within(plate, since, model);
  const auto [whole, inside] = plate_of_most(model, within);
  if (inside == 0) {
    context.warnings.push_back(
        fmt::format("fields.plates: no crust lies within {} when it appears, at {:g} Ma: left out",
                    plate.outline.name, plate.from_ma));
    return;
  }
  constexpr double kAlmostWhole = 0.95;
  if (inside >= kAlmostWhole * model.partition.cap(whole).samples) {
    model.state.plates[whole].driver = plate.number;
    return;
  }
  const std::int32_t driver = model.state.plates[whole].driver;
  const std::int16_t id = model.state.plates[whole].id;
  const auto parts = split_plate(model, whole, within);
  if (!parts) return;
  SpherePlate& rest = model.state.plates[parts->first];
  SpherePlate& part = model.state.plates[parts->second];
  rest.driver = driver;
  part.driver = plate.number;
  // The number stays with the rotations, however much of the plate goes.
  if (rest.id == id) return;
  std::swap(rest.id, part.id);
  std::swap(rest.born_myr, part.born_myr);
}

}  // namespace

void let_rotations_lead(SphereSettings& settings) {
  settings.no_net_rotation = false;
  settings.hold_motions = true;
  settings.rift_per_myr = 0.0;
}

void check_reconstruction(const PlateReconstruction& given, const SphereState& state) {
  if (!state.reconstruction_ma) {
    throw InputError(fmt::format(
        "fields.plate_rotations = {}: the plates of the frame to go on from were not driven by "
        "rotations: must be empty",
        given.source));
  }
  if (std::abs(*state.reconstruction_ma - given.start_ma) < kSameTime_myr) return;
  throw InputError(
      fmt::format("fields.rotations_age_myr: the drift of the frame to go on from began at {:g} "
                  "Ma: must be that, not {:g}",
                  *state.reconstruction_ma, given.start_ma));
}

void drive_plates(const PlateReconstruction& given, SphereTectonics& model, Context& context) {
  const double from_ma = age_ma(given, model);
  // Steps that do not divide the drift may end beyond the last rotation.
  const double to_ma = std::max(from_ma - model.settings.law.step_myr, given.youngest_ma);
  if (from_ma - to_ma < kSameTime_myr) return;
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    SpherePlate& plate = model.state.plates[p];
    if (!plate.alive || plate.carrier >= 0 || plate.driver < 0) continue;
    const auto rotation = given.rotations.stage_rad_myr(plate.driver, from_ma, to_ma);
    if (rotation) {
      guide_plate(model, static_cast<int>(p), *rotation);
      continue;
    }
    context.warnings.push_back(fmt::format(
        "fields.plate_rotations: plate {} has no rotation from {:g} to {:g} Ma: it moves on as it "
        "did",
        plate.driver, from_ma, to_ma));
    plate.driver = -1;
  }
}

void follow_reconstruction(const PlateReconstruction& given, SphereTectonics& model,
                           Context& context) {
  const double from_ma = age_ma(given, model);
  const double to_ma = from_ma - model.settings.law.step_myr;
  for (const LaterPlate& plate : given.later) {
    if (plate.from_ma > from_ma + kSameTime_myr || plate.from_ma <= to_ma + kSameTime_myr) continue;
    cut_out(plate, given, model, context);
  }
  drive_plates(given, model, context);
}

}  // namespace geo
