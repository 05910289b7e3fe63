#pragma once

#include <cstdint>
#include <functional>

#include "geo/stages/erosion/drainage.hpp"
#include "geo/stages/erosion/erosion.hpp"
#include "geo/stages/erosion/landscape.hpp"

namespace geo {

/// What the steps of a landscape take from their surroundings. All but `route` may be empty.
struct Surroundings {
  /// The drainage of the surface as it stands before `step`; it stays until the next is asked for.
  std::function<const Drainage&(std::int64_t step)> route;
  /// What else happens before a step; returns whether it changed the surface.
  std::function<bool(std::int64_t step)> strike{};
  /// Tells land and sea apart on the surface that the step has raised; returns whether a coast has
  /// moved.
  std::function<bool(std::int64_t step)> coast{};
  /// The ice of a step, or none.
  std::function<IceWork(std::int64_t step)> ice{};
  /// Called after each step.
  std::function<void(std::int64_t step)> after{};
  /// See DrainageDone; `route` is asked again before the next step, or never.
  DrainageDone done{};
};

/// The steps of a landscape, for every planet, island and fit: each raises the surface, and then
/// wears it down. Water is routed again every `route_every` steps, and where events, ice or a moved
/// coast ask for it; depressions are then breached where they are to be. The last step builds
/// deltas.
template <class V>
void wear_down(const ErosionParameters& p, const Surroundings& around, Landscape<V>& landscape) {
  const Drainage* drainage = nullptr;
  bool coast_moved = false;
  for (std::int64_t step = 0; step < p.steps; ++step) {
    const bool struck = around.strike && around.strike(step);
    landscape.raise();
    coast_moved = (around.coast && around.coast(step)) || coast_moved;
    if (struck || coast_moved || step % p.route_every == 0) {
      drainage = &around.route(step);
      landscape.breach(*drainage);
    }
    const IceWork ice = around.ice ? around.ice(step) : IceWork{};
    const bool routed_again = ice || step + 1 == p.steps || (step + 1) % p.route_every == 0;
    landscape.step(*drainage, /*builds_deltas=*/step + 1 == p.steps, ice,
                   routed_again ? around.done : DrainageDone{});
    coast_moved = static_cast<bool>(ice);
    if (around.after) around.after(step);
  }
}

}  // namespace geo
