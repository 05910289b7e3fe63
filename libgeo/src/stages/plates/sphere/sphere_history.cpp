#include "sphere_history.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string_view>

namespace geo {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string_view word_for(PlateLife::Origin origin) {
  switch (origin) {
    case PlateLife::Origin::first:
      return "first";
    case PlateLife::Origin::rift:
      return "rift";
    case PlateLife::Origin::subduction_initiation:
      return "subduction-initiation";
    case PlateLife::Origin::piece:
      return "piece";
    case PlateLife::Origin::terrane:
      return "terrane";
    case PlateLife::Origin::back_arc:
      return "back-arc";
    case PlateLife::Origin::block:
      return "block";
  }
  return "";
}

std::string_view end_of(const PlateLife& life) {
  if (life.ended_myr == PlateLife::kLives) return "";
  return life.joined < 0 ? "subducted" : "merged";
}

}  // namespace

void SphereHistory::enter(const SphereTectonics& model) {
  const SphereState& state = model.state;
  for (std::size_t p = 0; p < state.plates.size(); ++p) {
    const SpherePlate& plate = state.plates[p];
    if (!plate.alive || plate.id < 0) continue;
    turns_.push_back({plate.id, state.time_myr, state.time_myr + model.settings.law.step_myr,
                      grid_->to_axis(model.rotation[p])});
  }
}

TextTable SphereHistory::rotations(const SphereState& end) const {
  TextTable table{
      "rotations",
      {"from_myr", "to_myr", "plate_id", "pole_latitude_deg", "pole_longitude_deg", "rate_deg_myr"},
      {}};
  std::vector<Turn> turns = turns_;
  std::vector<std::uint8_t> has_moved(end.lives.size(), 0);
  for (const Turn& turn : turns_) has_moved[turn.plate] = 1;
  // Plates that the last step has made are told how they would go on.
  for (const SpherePlate& plate : end.plates) {
    if (!plate.alive || plate.carrier >= 0 || plate.id < 0 || has_moved[plate.id] != 0) continue;
    const Vector3 rotation = add(scaled(plate.axis, plate.speed_rad_myr), plate.yielding);
    turns.push_back({plate.id, end.time_myr, end.time_myr, grid_->to_axis(rotation)});
  }
  for (const Turn& turn : turns) {
    // Once it has collided a plate turns as the one does that it has joined.
    if (turn.from_myr >= end.lives[turn.plate].ended_myr) continue;
    const Vector3& w = turn.rotation_rad_myr;
    const double rate = length(w);
    const double latitude = rate > 0.0 ? std::atan2(w[2], std::hypot(w[0], w[1])) * kDegrees : 90.0;
    const double longitude = rate > 0.0 ? std::atan2(w[1], w[0]) * kDegrees : 0.0;
    table.rows.push_back({fmt::to_string(turn.from_myr), fmt::to_string(turn.to_myr),
                          fmt::to_string(turn.plate), fmt::to_string(latitude),
                          fmt::to_string(longitude), fmt::to_string(rate * kDegrees)});
  }
  return table;
}

TextTable SphereHistory::lives(const SphereState& end) {
  TextTable table{"lives",
                  {"plate_id", "origin", "parent_id", "born_myr", "ended_myr", "joined_id", "end"},
                  {}};
  const auto number = [](std::int16_t id) { return id < 0 ? std::string() : fmt::to_string(id); };
  for (std::size_t id = 0; id < end.lives.size(); ++id) {
    const PlateLife& life = end.lives[id];
    const bool lives = life.ended_myr == PlateLife::kLives;
    table.rows.push_back({fmt::to_string(id), std::string(word_for(life.origin)),
                          number(life.parent), fmt::to_string(life.born_myr),
                          lives ? std::string() : fmt::to_string(life.ended_myr),
                          number(life.joined), std::string(end_of(life))});
  }
  return table;
}

}  // namespace geo
