#include <cmath>

#include "sphere_steps.hpp"

namespace geo {

std::uint64_t descent_from(const SphereTectonics& model, const PlateChances& parent, Descent kind,
                           std::uint64_t number) {
  constexpr std::uint64_t kKinds = 3;
  const auto word = RandomStream(model.seed, "plates.descent")
                        .words(parent.descent, kKinds * number + static_cast<std::uint64_t>(kind));
  return (static_cast<std::uint64_t>(word[0]) << 32U) | word[1];
}

bool is_struck(double& hazard, double expected, const RandomStream& random, const PlateChances& of,
               std::int32_t event) {
  hazard += expected;
  return hazard > -std::log1p(-random.uniform(of.descent, draw_of(event, 0)));
}

DrawnPlaces::DrawnPlaces(const RandomStream& random, const PlateChances& of, std::int32_t event)
    : random_(&random) {
  const auto word = random.words(of.descent, draw_of(event, 15));
  first_ = (static_cast<std::uint64_t>(word[0]) << 32U) | (word[1] & 0xFFFF0000U);
}

}  // namespace geo
