#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace geo {

/// A surface as places of one area and the ways between neighbours, each way known at both ends.
struct SurfaceGraph {
  std::vector<std::int32_t> first;  ///< of each place in neighbour; one more at the end
  std::vector<std::int32_t> neighbour;
  std::vector<float> distance_m;       ///< of each way
  std::vector<std::uint8_t> is_there;  ///< places that are not there are left alone
  std::vector<std::uint8_t> is_open;   ///< beside water that no place stands for
  double area_m2 = 0.0;

  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(is_there.size()); }
};

struct RiverLaw {
  double erodibility_yr = 1e-7;  ///< K, m^(1 - 2m) yr-1
  double area_exponent = 0.5;    ///< m
  double deposition = 0.0;       ///< G: 0 is detachment-limited
  double dt_yr = 2e6;
  double rebound = 6.6;  ///< rock that goes for each metre by which land sinks: local isostasy
  double settling_km = 300.0;  ///< e-folding length of what the sea carries away from a coast
  double shelf_m = 150.0;      ///< depth up to which sediment fills the sea
  double load = 0.35;          ///< by which the sea floor rises for each metre laid on it
};

/// Drainage on land. Sea is what lies below 0, but for landlocked water: it is a lake, which
/// overflows at its sill.
struct SurfaceRivers {
  static constexpr std::int32_t kOpen = -1;  ///< water goes where no place stands for the sea
  static constexpr std::int32_t kSink = -2;  ///< the lowest place of land that no sea borders
  std::vector<std::int32_t> order;           ///< land, each place behind its receiver
  std::vector<std::int32_t> receiver;        ///< of each place; kSink off the land
  std::vector<float> distance_m;             ///< to the receiver
  std::vector<double> area_m2;  ///< that land drains, the place itself included, times runoff
};

/// Steepest descent over filled ground: land is flooded from the coast inland, lowest first (Barnes
/// et al. 2014); of the neighbours that water has reached before it, a place drains to the one to
/// which its level falls most steeply, in a lake to that from which the flood came. No cycles, no
/// place left out. `runoff` weighs the area of each place of land, asked for by several threads, so
/// that area is discharge over a reference runoff; without it all weigh 1. Cost n log n in places
/// of land. Throws Bug unless there is one elevation per place.
SurfaceRivers route_rivers(const SurfaceGraph& graph, std::span<const float> elevation_m,
                           const std::function<double(std::int32_t place)>& runoff = {});

/// What a step of rivers moved, m3 of rock.
struct RiverWork {
  double eroded_m3 = 0.0, on_land_m3 = 0.0, in_sea_m3 = 0.0;
};

/// One step of rivers that erode and deposit at once:
///
///   dz/dt = -(K / rebound) A^m S + (G / A*) Q,
///
/// with Q what leaves a place, as a rate of lowering times area, and A* the area that it comes from
/// (Davy & Lague 2009; Yuan et al. 2019). Implicit in one sweep down the rivers and one up
/// (Hergarten 2020), as `incise_and_deposit` for n = 1, unconditionally stable; the sea and the
/// level of lakes are its base. What rivers bring to lakes fills them up to their level; the rest
/// spreads in the sea away from the coast, falls by 1/e over settling_km and fills no place above
/// the shelf's depth. What finds no room settles evenly on all deep floor. Nothing is lost where
/// there is any: eroded = on land + in the sea.
///
/// `is_rock`: places that rivers erode; `erodibility`: K of each over that of the law, or empty: 1.
/// `elevation_m` in and out; `rock_m`: change of the thickness of rock and sediment. Cost linear
/// but for the order of places off the coast, found in rings (Meyer & Sanders 2003), each sorted by
/// digits.
/// Arrays have one value per place; Bug otherwise.
RiverWork run_rivers(const SurfaceGraph& graph, const SurfaceRivers& rivers, const RiverLaw& law,
                     std::span<const std::int8_t> is_rock, std::span<float> elevation_m,
                     std::span<float> rock_m, std::span<const float> erodibility = {});

}  // namespace geo
