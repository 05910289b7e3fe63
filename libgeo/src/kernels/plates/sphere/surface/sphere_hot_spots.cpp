#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/core/random.hpp"
#include "kernels/plates/sphere/sphere_flood.hpp"
#include "kernels/plates/sphere/sphere_steps.hpp"

namespace geo {
namespace {

/// Most that a volcano brings forth before another one takes over: the largest of Hawaii's.
constexpr double kLargest_km3 = 75000.0;
/// Part of it that lies about the cone as its apron, and how much wider that is.
constexpr double kApron = 0.3, kApronWidth = 3.0;
/// Half widths at which cone and apron end.
constexpr double kReach = 2.5;
/// How far a volcano may stand beside the plume, in spacings.
constexpr double kAside = 0.35;
/// Parts of a step in which a plate goes no farther.
constexpr double kPart_km = 10.0;
constexpr int kMostParts = 64;

/// Any two directions that make a right-handed frame with one.
std::pair<Vector3, Vector3> across(const Vector3& at) {
  const Vector3 other = std::abs(at[2]) < 0.9 ? Vector3{0.0, 0.0, 1.0} : Vector3{1.0, 0.0, 0.0};
  const Vector3 first = normalised(cross(other, at));
  return {first, cross(at, first)};
}

struct Eruption {
  Vector3 place;
  double volume_km3;
};

/// Where a plume's melt of a step comes out and how much of it, as the plate lies after the step.
std::vector<Eruption> eruptions(const SphereTectonics& model, SpherePlume& plume,
                                const Vector3& rotation) {
  const SphereSettings& s = model.settings;
  const RandomStream random(model.seed, "plates.volcanoes");
  const double step_myr = s.law.step_myr;
  const double way_km = s.radius_km * length(cross(rotation, plume.place)) * step_myr;
  const int parts = std::clamp(static_cast<int>(std::ceil(way_km / kPart_km)), 1, kMostParts);
  // What a mound that halves at plume_km would take.
  const double volume_km3 = plume.growth_mm_yr * step_myr * std::numbers::pi * s.plume_km *
                            s.plume_km / std::numbers::ln2;
  if (length(plume.volcano) > 0.0) {
    plume.volcano = rotated(plume.volcano, scaled(rotation, step_myr));
  }
  std::vector<Eruption> found;
  for (int part = 0; part < parts; ++part) {
    const double later_myr = step_myr * (1.0 - (part + 0.5) / parts);
    const Vector3 above = rotated(plume.place, scaled(rotation, later_myr));
    const auto index = [&] {
      return (static_cast<std::uint64_t>(plume.number) << 32U) +
             static_cast<std::uint64_t>(plume.volcanoes);
    };
    const double spacing_km = s.volcano_spacing_km * random.uniform(index(), 0, 0.7, 1.3);
    const bool is_new = length(plume.volcano) == 0.0 || plume.volcano_km3 >= kLargest_km3 ||
                        s.radius_km * angle_between(plume.volcano, above) >= spacing_km;
    if (is_new) {
      ++plume.volcanoes;
      plume.volcano_km3 = 0.0;
      const double aside =
          kAside * s.volcano_spacing_km / s.radius_km * std::sqrt(random.uniform(index(), 1));
      const double angle = random.uniform(index(), 2, 0.0, 2.0 * std::numbers::pi);
      const auto [first, second] = across(above);
      plume.volcano = normalised(
          add(add(above, first, aside * std::cos(angle)), second, aside * std::sin(angle)));
    }
    if (is_new || found.empty()) found.push_back({plume.volcano, 0.0});
    found.back().volume_km3 += volume_km3 / parts;
    plume.volcano_km3 += volume_km3 / parts;
  }
  return found;
}

/// Lays a volume of lava on the ocean floor of a plate about a place, as a cone and its apron. What
/// a summit that is high enough has no room for goes to the apron.
void grow_volcano(SphereTectonics& model, int plate, const Vector3& place, double volume_km3) {
  SphereCrust& crust = model.state.crust;
  // A cone that samples can show.
  const double cone_km = std::max(model.settings.volcano_km,
                                  0.8 * model.settings.radius_km * model.mesh->samples().spacing());
  const auto top_m = static_cast<float>(1e3 * model.settings.plume_top_km);
  struct Slope {
    std::int32_t sample;
    double cone, apron;
  };
  std::vector<Slope> slopes;
  std::vector<std::uint8_t> seen(crust.plate.size());
  for (std::size_t p = 0; p < model.state.plates.size(); ++p) {
    if (!model.state.plates[p].alive || model.state.root(static_cast<int>(p)) != plate) continue;
    const Vector3 here = back(model.frame[p], place);
    const auto far_off = [&](std::int32_t i) {
      return model.settings.radius_km * angle_between(model.mesh->samples().position(i), here) /
             cone_km;
    };
    std::fill(seen.begin(), seen.end(), 0);
    for (const std::int32_t i :
         flooded_from(*model.mesh, model.mesh->samples().nearest(here), seen,
                      [&](std::int32_t j) { return far_off(j) <= kReach * kApronWidth; })) {
      const double far = far_off(i);
      if (crust.plate[i] != static_cast<std::int16_t>(p) || crust.continental[i] != 0 ||
          model.margins.hidden[i] != 0 || crust.elevation_m[i] >= top_m) {
        continue;
      }
      slopes.push_back({i, far > kReach ? 0.0 : std::exp2(-far * far),
                        std::exp2(-far * far / (kApronWidth * kApronWidth))});
    }
  }
  double cones = 0.0, aprons = 0.0;
  for (const Slope& slope : slopes) {
    cones += slope.cone;
    aprons += slope.apron;
  }
  if (aprons <= 0.0) return;
  const double height_m = 1e3 * volume_km3 / model.sample_km2();
  double left_m = cones > 0.0 ? 0.0 : (1.0 - kApron) * height_m;
  const auto pile = [&](std::int32_t i, double grown_m) {
    const double room_m = std::max(0.0, static_cast<double>(top_m) - crust.elevation_m[i]);
    const double piled_m = std::min(room_m, grown_m);
    crust.elevation_m[i] += static_cast<float>(piled_m);
    crust.thickness_m[i] += static_cast<float>(piled_m);
    model.budget.erupted_km3 += 1e-3 * model.sample_km2() * piled_m;
    return grown_m - piled_m;
  };
  if (cones > 0.0) {
    for (const Slope& slope : slopes) {
      left_m += pile(slope.sample, (1.0 - kApron) * height_m * slope.cone / cones);
    }
  }
  for (const Slope& slope : slopes) {
    pile(slope.sample, (kApron * height_m + left_m) * slope.apron / aprons);
  }
}

}  // namespace

/// The melt of a plume on the sea floor goes to one volcano until its plate has carried that away
/// or it is as large as volcanoes get; the next one stands where the plume is then: a chain of
/// islands and seamounts, the older the farther.
void erupt(SphereTectonics& model) {
  for (SpherePlume& plume : model.state.plumes) {
    const int plate = plume.growth_mm_yr > 0.0 ? plate_at(model, plume.place) : -1;
    if (plate < 0) {
      plume.volcano = {};
      continue;
    }
    for (const auto& [volcano, volume_km3] : eruptions(model, plume, model.rotation[plate])) {
      grow_volcano(model, plate, volcano, volume_km3);
    }
  }
}

}  // namespace geo
