#include "sphere_checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace geo {
namespace {

using Directions = std::vector<std::array<float, 3>>;

std::vector<float> flat(const Directions& directions) {
  std::vector<float> values;
  values.reserve(3 * directions.size());
  for (const auto& direction : directions) {
    values.insert(values.end(), direction.begin(), direction.end());
  }
  return values;
}

Directions directions(const std::vector<float>& values) {
  Directions all(values.size() / 3);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  }
  return all;
}

[[noreturn]] void refuse() {
  throw InputError("the frame to go on from is damaged: its arrays do not fit");
}

/// Refuses numbers that nothing could go on from: steps would never reach a time of them.
void check_numbers(const Checkpoint& from) {
  for (const char* name : {"plate_numbers", "clock", "kept_rotation_rad_myr", "plate_yielding",
                           "plumes", "volcanoes", "reconstruction_ma", "plate_chances", "water"}) {
    if (!from.arrays.contains(name)) continue;
    for (const double value : from.get<double>(name)) {
      if (!std::isfinite(value)) refuse();
    }
  }
  constexpr double kLongest_myr = 1e5, kMostSteps = 1e9;
  const auto& clock = from.get<double>("clock");
  if (clock.size() != 3 || clock[0] < 0.0 || clock[0] > kLongest_myr || clock[1] < 0.0 ||
      clock[1] > kMostSteps || clock[2] > clock[0]) {
    refuse();
  }
}

/// Whether each plate is carried by others, if by any, that end with one that none carries.
bool carriers_end(const std::vector<std::int16_t>& carrier) {
  for (std::size_t p = 0; p < carrier.size(); ++p) {
    std::size_t steps = 0;
    for (int at = carrier[p]; at >= 0; at = carrier[at]) {
      if (++steps > carrier.size()) return false;
    }
  }
  return true;
}

constexpr std::size_t kNumbers = 9;         // of a plate: turn, axis, speed, birth
constexpr std::size_t kVolcanoNumbers = 6;  // of a plume: number, volcanoes, place, volume
constexpr std::size_t kTurnNumbers = 4;
constexpr std::size_t kChanceNumbers = 6;  // of a plate: descent in two, hazards, events

using Arrays = std::map<std::string, Values>;

/// Which plate is which, and what has become of each there has been.
void put_lives(const SphereState& state, Arrays& to) {
  std::vector<std::int16_t> id, parent, joined;
  std::vector<std::int8_t> origin;
  std::vector<double> born, ended;
  for (const SpherePlate& plate : state.plates) id.push_back(plate.id);
  for (const PlateLife& life : state.lives) {
    origin.push_back(static_cast<std::int8_t>(life.origin));
    parent.push_back(life.parent);
    joined.push_back(life.joined);
    born.push_back(life.born_myr);
    ended.push_back(life.ended_myr);
  }
  to["plate_id"] = id;
  to["life_origin"] = origin;
  to["life_parent"] = parent;
  to["life_joined"] = joined;
  to["life_born_myr"] = born;
  to["life_ended_myr"] = ended;
}

void get_lives(const Checkpoint& from, SphereState& state) {
  const auto& id = from.get<std::int16_t>("plate_id");
  const auto& origin = from.get<std::int8_t>("life_origin");
  const auto& parent = from.get<std::int16_t>("life_parent");
  const auto& joined = from.get<std::int16_t>("life_joined");
  const auto& born = from.get<double>("life_born_myr");
  const auto& ended = from.get<double>("life_ended_myr");
  const auto lives = static_cast<std::int16_t>(origin.size());
  const auto is_life = [&](std::int16_t number) { return number >= -1 && number < lives; };
  bool fits = id.size() == state.plates.size() && std::ranges::all_of(id, is_life) &&
              std::ranges::all_of(parent, is_life) && std::ranges::all_of(joined, is_life);
  for (const std::size_t size : {parent.size(), joined.size(), born.size(), ended.size()}) {
    fits = fits && size == origin.size();
  }
  for (const std::int8_t word : origin) {
    fits = fits && word >= 0 && word <= static_cast<std::int8_t>(PlateLife::Origin::block);
  }
  if (!fits) refuse();
  for (std::size_t p = 0; p < id.size(); ++p) state.plates[p].id = id[p];
  for (std::size_t k = 0; k < origin.size(); ++k) {
    state.lives.push_back({.origin = static_cast<PlateLife::Origin>(origin[k]),
                           .parent = parent[k],
                           .born_myr = born[k],
                           .ended_myr = ended[k],
                           .joined = joined[k]});
  }
}

/// How plates have turned since the last resampling. Those that are no more have stopped.
void put_past(const SphereState& state, Arrays& to) {
  std::vector<double> turns;
  for (const SpherePlate& plate : state.plates) {
    for (std::size_t k = 0; k < state.past_myr.size(); ++k) {
      const Quaternion turn = plate.alive ? plate.past[k] : Quaternion{};
      turns.insert(turns.end(), {turn.w, turn.v[0], turn.v[1], turn.v[2]});
    }
  }
  to["past_myr"] = state.past_myr;
  to["plate_past"] = turns;
}

void get_past(const Checkpoint& from, SphereState& state) {
  state.past_myr = from.get<double>("past_myr");
  const auto& turns = from.get<double>("plate_past");
  const std::size_t times = state.past_myr.size();
  if (turns.size() != kTurnNumbers * times * state.plates.size()) refuse();
  const double* at = turns.data();
  for (SpherePlate& plate : state.plates) {
    for (std::size_t k = 0; k < times; ++k, at += kTurnNumbers) {
      plate.past.push_back({at[0], {at[1], at[2], at[3]}});
    }
  }
}

void put_chances(const SphereState& state, Arrays& to) {
  std::vector<double> numbers;
  for (const SpherePlate& plate : state.plates) {
    const PlateChances& of = plate.chances;
    numbers.insert(numbers.end(), {static_cast<double>(of.descent >> 32U),
                                   static_cast<double>(of.descent & 0xFFFFFFFFU), of.rift_hazard,
                                   of.initiation_hazard, static_cast<double>(of.rifts),
                                   static_cast<double>(of.initiations)});
  }
  to["plate_chances"] = numbers;
}

void get_chances(const Checkpoint& from, SphereState& state) {
  const auto& numbers = from.get<double>("plate_chances");
  if (numbers.size() != kChanceNumbers * state.plates.size()) refuse();
  constexpr double kMost = 4294967295.0;
  for (std::size_t p = 0; p < state.plates.size(); ++p) {
    const double* at = numbers.data() + kChanceNumbers * p;
    for (std::size_t k : {0, 1, 4, 5}) {
      const double most = k < 2 ? kMost : 1e9;
      if (!(at[k] >= 0.0 && at[k] <= most)) refuse();
    }
    state.plates[p].chances = {
        .descent = (static_cast<std::uint64_t>(at[0]) << 32U) | static_cast<std::uint64_t>(at[1]),
        .rift_hazard = at[2],
        .initiation_hazard = at[3],
        .rifts = static_cast<std::int32_t>(at[4]),
        .initiations = static_cast<std::int32_t>(at[5])};
  }
}

void put_crust(const SphereCrust& crust, Arrays& to) {
  to["plate"] = crust.plate;
  to["continental"] = crust.continental;
  to["orogeny"] = crust.orogeny;
  to["thickness_m"] = crust.thickness_m;
  to["elevation_m"] = crust.elevation_m;
  to["sediment_m"] = crust.sediment_m;
  to["age_myr"] = crust.age_myr;
  to["orogeny_age_myr"] = crust.orogeny_age_myr;
  to["ridge"] = flat(crust.ridge);
  to["fold"] = flat(crust.fold);
}

SphereCrust get_crust(const Checkpoint& from) {
  SphereCrust crust;
  crust.plate = from.get<std::int16_t>("plate");
  crust.continental = from.get<std::int8_t>("continental");
  crust.orogeny = from.get<std::int8_t>("orogeny");
  crust.thickness_m = from.get<float>("thickness_m");
  crust.elevation_m = from.get<float>("elevation_m");
  crust.age_myr = from.get<float>("age_myr");
  crust.orogeny_age_myr = from.get<float>("orogeny_age_myr");
  crust.ridge = directions(from.get<float>("ridge"));
  crust.fold = directions(from.get<float>("fold"));
  const std::size_t samples = crust.plate.size();
  if (from.arrays.contains("sediment_m")) {
    crust.sediment_m = from.get<float>("sediment_m");
  } else {
    crust.sediment_m.assign(samples, 0.0F);  // a frame of a version that had none
  }
  for (const std::size_t size :
       {crust.continental.size(), crust.orogeny.size(), crust.thickness_m.size(),
        crust.elevation_m.size(), crust.sediment_m.size(), crust.age_myr.size(),
        crust.orogeny_age_myr.size(), crust.ridge.size(), crust.fold.size()}) {
    if (size != samples) refuse();
  }
  return crust;
}

void put_plates(const SphereState& state, Arrays& to) {
  std::vector<double> numbers, yielding;
  std::vector<std::int8_t> alive, held;
  std::vector<std::int16_t> carrier;
  for (const SpherePlate& plate : state.plates) {
    numbers.insert(numbers.end(),
                   {plate.turn.w, plate.turn.v[0], plate.turn.v[1], plate.turn.v[2], plate.axis[0],
                    plate.axis[1], plate.axis[2], plate.speed_rad_myr, plate.born_myr});
    yielding.insert(yielding.end(), plate.yielding.begin(), plate.yielding.end());
    alive.push_back(plate.alive ? 1 : 0);
    held.push_back(plate.is_held ? 1 : 0);
    carrier.push_back(plate.carrier);
  }
  to["plate_numbers"] = numbers;
  to["plate_yielding"] = yielding;
  to["plate_alive"] = alive;
  to["plate_held"] = held;
  to["plate_carrier"] = carrier;
}

std::vector<SpherePlate> get_plates(const Checkpoint& from) {
  const auto& numbers = from.get<double>("plate_numbers");
  const auto& alive = from.get<std::int8_t>("plate_alive");
  const auto& carrier = from.get<std::int16_t>("plate_carrier");
  const std::size_t plates = alive.size();
  bool fits = numbers.size() == kNumbers * plates && carrier.size() == plates;
  for (std::size_t p = 0; fits && p < plates; ++p) {
    fits = carrier[p] >= -1 && carrier[p] < static_cast<std::int16_t>(plates);
  }
  if (!fits || !carriers_end(carrier)) refuse();
  std::vector<SpherePlate> found;
  for (std::size_t p = 0; p < plates; ++p) {
    const double* at = numbers.data() + kNumbers * p;
    SpherePlate plate;
    plate.turn = {at[0], {at[1], at[2], at[3]}};
    plate.axis = {at[4], at[5], at[6]};
    plate.speed_rad_myr = at[7];
    plate.born_myr = at[8];
    plate.alive = alive[p] != 0;
    plate.carrier = carrier[p];
    found.push_back(plate);
  }
  return found;
}

void put_pairs(const SphereState& state, Arrays& to) {
  std::vector<std::int8_t> ocean, continent, is_final;
  std::vector<float> contact, parted, under;
  for (const PlatePair& pair : state.pairs) {
    ocean.push_back(pair.ocean_top);
    continent.push_back(pair.continent_top);
    is_final.push_back(pair.is_ocean_top_final ? 1 : 0);
    contact.push_back(pair.last_contact_myr);
    parted.push_back(pair.parted_myr);
    under.push_back(pair.under_km);
  }
  to["pair_ocean_top"] = ocean;
  to["pair_continent_top"] = continent;
  to["pair_ocean_top_final"] = is_final;
  to["pair_last_contact_myr"] = contact;
  to["pair_parted_myr"] = parted;
  to["pair_under_km"] = under;
}

std::vector<PlatePair> get_pairs(const Checkpoint& from, std::size_t plates) {
  const auto& ocean = from.get<std::int8_t>("pair_ocean_top");
  const auto& continent = from.get<std::int8_t>("pair_continent_top");
  const auto& contact = from.get<float>("pair_last_contact_myr");
  const std::size_t count = plates * plates;
  if (ocean.size() != count || continent.size() != count || contact.size() != count) refuse();
  std::vector<PlatePair> pairs;
  for (std::size_t k = 0; k < count; ++k) {
    pairs.push_back(
        {.ocean_top = ocean[k], .continent_top = continent[k], .last_contact_myr = contact[k]});
  }
  return pairs;
}

/// Motions that are held, that yield, and how far continents have gone under: frames of older
/// versions have none of these.
void get_later_additions(const Checkpoint& from, SphereState& state) {
  const std::size_t plates = state.plates.size();
  if (from.arrays.contains("plate_held")) {
    const auto& held = from.get<std::int8_t>("plate_held");
    const auto& kept = from.get<double>("kept_rotation_rad_myr");
    if (held.size() != plates || kept.size() != 3) refuse();
    for (std::size_t p = 0; p < plates; ++p) state.plates[p].is_held = held[p] != 0;
    state.kept_rotation_rad_myr = {kept[0], kept[1], kept[2]};
  }
  if (from.arrays.contains("plate_yielding")) {
    const auto& yielding = from.get<double>("plate_yielding");
    const auto& parted = from.get<float>("pair_parted_myr");
    if (yielding.size() != 3 * plates || parted.size() != state.pairs.size()) refuse();
    for (std::size_t p = 0; p < plates; ++p) {
      const double* at = yielding.data() + 3 * p;
      state.plates[p].yielding = {at[0], at[1], at[2]};
    }
    for (std::size_t k = 0; k < parted.size(); ++k) state.pairs[k].parted_myr = parted[k];
  }
  for (std::size_t p = 0; p < plates; ++p) state.plates[p].chances.descent = p;
  if (from.arrays.contains("plate_chances")) {
    get_chances(from, state);
    const auto& is_final = from.get<std::int8_t>("pair_ocean_top_final");
    if (is_final.size() != state.pairs.size()) refuse();
    for (std::size_t k = 0; k < is_final.size(); ++k) {
      state.pairs[k].is_ocean_top_final = is_final[k] != 0;
    }
  }
  if (from.arrays.contains("pair_under_km")) {
    const auto& under = from.get<float>("pair_under_km");
    if (under.size() != state.pairs.size()) refuse();
    for (std::size_t k = 0; k < under.size(); ++k) state.pairs[k].under_km = under[k];
  }
}

/// Which plates a reconstruction drives, where one does.
void put_drivers(const SphereState& state, Arrays& to) {
  if (!state.reconstruction_ma) return;
  std::vector<std::int32_t> driver;
  for (const SpherePlate& plate : state.plates) driver.push_back(plate.driver);
  to["plate_driver"] = driver;
  to["reconstruction_ma"] = std::vector<double>{*state.reconstruction_ma};
}

void get_drivers(const Checkpoint& from, SphereState& state) {
  if (!from.arrays.contains("plate_driver")) return;
  const auto& driver = from.get<std::int32_t>("plate_driver");
  const auto& start_ma = from.get<double>("reconstruction_ma");
  if (driver.size() != state.plates.size() || start_ma.size() != 1) refuse();
  for (std::size_t p = 0; p < driver.size(); ++p) state.plates[p].driver = driver[p];
  state.reconstruction_ma = start_ma[0];
}

/// The climate that rivers know and the water of the sea, where there is one.
void put_landscape(const SphereState& state, Arrays& to) {
  if (state.runoff.empty()) return;
  to["runoff"] = state.runoff;
  to["water"] = std::vector<double>{state.water_km3, state.ice_km3, state.sea_level_m};
}

void get_landscape(const Checkpoint& from, SphereState& state) {
  if (!from.arrays.contains("runoff")) return;
  state.runoff = from.get<float>("runoff");
  const auto& water = from.get<double>("water");
  if (state.runoff.size() != state.crust.plate.size() || water.size() != 3) refuse();
  for (const float share : state.runoff) {
    if (!(share >= 0.0F && std::isfinite(share))) refuse();
  }
  state.water_km3 = water[0];
  state.ice_km3 = water[1];
  state.sea_level_m = water[2];
}

void put_plumes(const SphereState& state, Arrays& to) {
  std::vector<double> plumes, volcanoes;
  for (const SpherePlume& plume : state.plumes) {
    plumes.insert(plumes.end(),
                  {plume.place[0], plume.place[1], plume.place[2], plume.growth_mm_yr});
    volcanoes.insert(volcanoes.end(),
                     {static_cast<double>(plume.number), static_cast<double>(plume.volcanoes),
                      plume.volcano[0], plume.volcano[1], plume.volcano[2], plume.volcano_km3});
  }
  to["plumes"] = plumes;
  to["volcanoes"] = volcanoes;
}

void get_plumes(const Checkpoint& from, SphereState& state) {
  if (from.arrays.contains("plumes")) {
    const auto& plumes = from.get<double>("plumes");
    if (plumes.size() % 4 != 0) refuse();
    for (std::size_t k = 0; k < plumes.size(); k += 4) {
      state.plumes.push_back({.place = {plumes[k], plumes[k + 1], plumes[k + 2]},
                              .growth_mm_yr = plumes[k + 3],
                              .number = static_cast<std::int64_t>(k / 4)});
    }
  }
  if (!from.arrays.contains("volcanoes")) return;
  const auto& volcanoes = from.get<double>("volcanoes");
  if (volcanoes.size() != kVolcanoNumbers * state.plumes.size()) refuse();
  for (std::size_t k = 0; k < state.plumes.size(); ++k) {
    const double* at = volcanoes.data() + kVolcanoNumbers * k;
    SpherePlume& plume = state.plumes[k];
    plume.number = static_cast<std::int64_t>(at[0]);
    plume.volcanoes = static_cast<std::int64_t>(at[1]);
    plume.volcano = {at[2], at[3], at[4]};
    plume.volcano_km3 = at[5];
  }
}

}  // namespace

namespace {

constexpr std::string_view kLeading = "leading_";

}  // namespace

void add_leader(const SphereState& leader, Checkpoint& to) {
  Checkpoint own = checkpoint_of(leader);
  for (auto& [name, values] : own.arrays) {
    to.arrays[std::string(kLeading) + name] = std::move(values);
  }
}

bool has_leader(const Checkpoint& from) {
  return from.arrays.contains(std::string(kLeading) + "plate");
}

SphereState leader_of(const Checkpoint& from) {
  Checkpoint own;
  own.time_myr = from.time_myr;
  for (const auto& [name, values] : from.arrays) {
    if (name.starts_with(kLeading)) own.arrays[name.substr(kLeading.size())] = values;
  }
  return state_of(own);
}

Checkpoint checkpoint_of(const SphereState& state) {
  Checkpoint out;
  out.time_myr = state.time_myr;
  put_crust(state.crust, out.arrays);
  put_plates(state, out.arrays);
  put_pairs(state, out.arrays);
  put_plumes(state, out.arrays);
  put_lives(state, out.arrays);
  put_past(state, out.arrays);
  put_chances(state, out.arrays);
  put_drivers(state, out.arrays);
  put_landscape(state, out.arrays);
  const Vector3& kept = state.kept_rotation_rad_myr;
  out.arrays["kept_rotation_rad_myr"] = std::vector<double>{kept[0], kept[1], kept[2]};
  out.arrays["clock"] =
      std::vector<double>{state.time_myr, static_cast<double>(state.steps), state.resampled_myr};
  return out;
}

SphereState state_of(const Checkpoint& from) {
  check_numbers(from);
  SphereState state;
  state.crust = get_crust(from);
  state.plates = get_plates(from);
  state.pairs = get_pairs(from, state.plates.size());
  const auto last = static_cast<std::int16_t>(state.plates.size());
  for (const std::int16_t plate : state.crust.plate) {
    if (plate < -1 || plate >= last) refuse();
  }
  const auto& clock = from.get<double>("clock");

  state.time_myr = clock[0];
  state.steps = static_cast<std::int64_t>(clock[1]);
  state.resampled_myr = clock[2];
  get_later_additions(from, state);
  get_drivers(from, state);
  get_landscape(from, state);
  get_plumes(from, state);
  if (from.arrays.contains("plate_id")) get_lives(from, state);
  if (from.arrays.contains("plate_past")) {
    get_past(from, state);
  } else if (state.resampled_myr < state.time_myr) {
    state.past_myr = {state.resampled_myr};
    for (SpherePlate& plate : state.plates) plate.past.emplace_back();
  }
  return state;
}

}  // namespace geo
