#include "exemplar_primitives.hpp"

#include <algorithm>
#include <numbers>

#include "geo/core/tangent_frame.hpp"

namespace geo {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

PrimitivePlaces::PrimitivePlaces(double planet_m, const PrimitiveSize& size)
    : shift_(0.5 * size.apart_m / planet_m) {
  const double hexagon_sr = 0.5 * std::sqrt(3.0) * std::pow(size.apart_m / planet_m, 2.0);
  count_ = static_cast<std::int64_t>(std::clamp(4.0 * kPi / hexagon_sr, 64.0, 4e9));
}

Vector3 PrimitivePlaces::lattice(std::int64_t number) const {
  const auto k = static_cast<double>(number);
  const double z = 1.0 - (2.0 * k + 1.0) / static_cast<double>(count_);
  const double turns = k / std::numbers::phi;
  const double longitude = 2.0 * kPi * (turns - std::floor(turns)), ring = std::sqrt(1.0 - z * z);
  return {ring * std::cos(longitude), ring * std::sin(longitude), z};
}

Vector3 PrimitivePlaces::shifted(std::int64_t number, const RandomStream& random) const {
  return normalised(
      geo::add(lattice(number), random.direction(static_cast<std::uint64_t>(number)), shift_));
}

Primitive draw_primitive(const RandomStream& random, std::int64_t at, const Vector3& centre,
                         double planet_m, const LocalTerrain& local,
                         std::span<const Texture> textures, const PrimitiveSize& size) {
  const auto number = static_cast<std::uint64_t>(at);
  const Texture& texture =
      choose(textures, local, random.uniform(number, 1), random.uniform(number, 2));
  const TangentFrame frame = tangent_frame(centre);
  // Turned to the fold, half of them the other way round and half of them mirrored.
  const double angle = local.fold_rad + (random.uniform(number, 3) < 0.5 ? 0.0 : kPi);
  const Vector3 along = add(scaled(frame.east, std::cos(angle)), frame.north, std::sin(angle));
  const double hand = random.uniform(number, 4) < 0.5 ? 1.0 : -1.0;
  const Vector3 across = scaled(cross(centre, along), hand);
  // The exemplar's own axes, so that its fold lies along `along`.
  const Vector3 u = add(scaled(along, texture.cosine), across, -texture.sine);
  const Vector3 v = add(scaled(along, texture.sine), across, texture.cosine);
  const auto shift = [&](int cells, std::uint64_t which) {
    const double extent_m = cells * texture.cell_m;
    const double margin_m = texture.periodic ? 0.0 : std::min(size.radius_m, 0.5 * extent_m);
    return random.uniform(number, which, margin_m, extent_m - margin_m);
  };
  return {.centre = centre,
          .u_m = scaled(u, planet_m),
          .v_m = scaled(v, planet_m),
          .along = scaled(along, planet_m / size.radius_m),
          .across = scaled(across, planet_m / size.narrow_m),
          .texture = &texture,
          .origin_x_m = shift(texture.nx, 5),
          .origin_y_m = shift(texture.ny, 6)};
}

std::span<Vector3> BlendedRow::begin() {
  std::fill(sum_.begin(), sum_.end(), 0.0);
  std::fill(squares_.begin(), squares_.end(), 0.0);
  return unit_;
}

void BlendedRow::add(const Primitive& p, int first, int last) {
  constexpr double kOverlap2 = PrimitiveSize::kOverlap * PrimitiveSize::kOverlap;
  for (int i = first; i < last; ++i) {
    const Vector3 away = geo::add(unit_[i], p.centre, -1.0);
    const double a = dot(away, p.along), b = dot(away, p.across);
    const double r2 = a * a + b * b, inside = 1.0 - r2;
    if (inside <= 0.0) continue;
    const double w = inside * inside * std::exp(-4.0 * kOverlap2 * r2);
    sum_[i] +=
        w * p.texture->sample(p.origin_x_m + dot(away, p.u_m), p.origin_y_m + dot(away, p.v_m));
    squares_[i] += w * w;
  }
}

}  // namespace geo
