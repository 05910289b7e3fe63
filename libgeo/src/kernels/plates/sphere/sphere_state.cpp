#include "geo/kernels/plates/sphere/sphere_state.hpp"

#include <algorithm>
#include <limits>

namespace geo {

void SphereCrust::resize(std::size_t samples) {
  plate.assign(samples, -1);
  continental.assign(samples, 0);
  orogeny.assign(samples, 0);
  thickness_m.assign(samples, 0.0F);
  elevation_m.assign(samples, 0.0F);
  sediment_m.assign(samples, 0.0F);
  age_myr.assign(samples, 0.0F);
  orogeny_age_myr.assign(samples, 0.0F);
  ridge.assign(samples, {});
  fold.assign(samples, {});
}

int SphereState::add_plate(const SpherePlate& plate) {
  for (std::size_t k = 0; k < plates.size(); ++k) {
    if (plates[k].alive) continue;
    plates[k] = plate;
    for (std::size_t other = 0; other < plates.size(); ++other) {
      if (other != k) pair(static_cast<int>(k), static_cast<int>(other)) = {};
    }
    return static_cast<int>(k);
  }
  const std::size_t count = plates.size();
  std::vector<PlatePair> grown((count + 1) * (count + 1));
  for (std::size_t a = 0; a < count && !pairs.empty(); ++a) {
    for (std::size_t b = 0; b < count; ++b) grown[a * (count + 1) + b] = pairs[a * count + b];
  }
  pairs = std::move(grown);
  plates.push_back(plate);
  return static_cast<int>(count);
}

std::int16_t SphereState::begin_life(PlateLife::Origin origin, std::int16_t parent) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<std::int16_t>::max()) + 1;
  const PlateLife life{.origin = origin, .parent = parent, .born_myr = time_myr};
  if (lives.size() < kMost) {
    lives.push_back(life);
    return static_cast<std::int16_t>(lives.size() - 1);
  }
  const auto first = std::min_element(
      lives.begin(), lives.end(),
      [](const PlateLife& a, const PlateLife& b) { return a.ended_myr < b.ended_myr; });
  *first = life;
  return static_cast<std::int16_t>(first - lives.begin());
}

void SphereState::end_life(std::int16_t id, std::int16_t joined) {
  if (id < 0 || lives[id].ended_myr < PlateLife::kLives) return;
  lives[id].ended_myr = time_myr;
  lives[id].joined = joined;
}

}  // namespace geo
