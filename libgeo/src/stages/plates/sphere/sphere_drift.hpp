#pragma once

#include <functional>
#include <memory>

#include "geo/core/stage.hpp"
#include "geo/kernels/plates/sphere/sphere_tectonics.hpp"
#include "geo/stages/plates/plates.hpp"

namespace geo {

/// The crust that drifts, and the plates that lead it where they have samples of their own.
class SphereDrift {
 public:
  /// As it is drawn, or as the frame has it that the context goes on from. Throws InputError where
  /// that has other samples than the parameters ask for.
  SphereDrift(const PlatesParameters& parameters, const SphereSettings& settings, const StageIo& io,
              Context& context);
  ~SphereDrift();
  SphereDrift(const SphereDrift&) = delete;
  SphereDrift& operator=(const SphereDrift&) = delete;

  [[nodiscard]] SphereTectonics& crust();
  [[nodiscard]] SphereTectonics& plates();
  /// The plates where they have samples of their own, or null.
  [[nodiscard]] SphereTectonics* leader();

  void begin_step();
  void advance();
  /// Lets plates drift up to time 0, from which on their history is told: those that are there then
  /// are the first. Nothing where they begin there.
  void spin_up(const std::function<void(double time_myr)>& progress);

 private:
  struct SampledModel;
  std::unique_ptr<SampledModel> crust_, leader_;
};

}  // namespace geo
