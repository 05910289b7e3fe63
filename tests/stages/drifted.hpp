#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "geo/stages/plates/plates.hpp"

namespace geo {

struct Drifted {
  State state;
  Budget budget;
};

inline PlatesParameters quick() {
  PlatesParameters p;
  p.model = "sphere";
  p.growth.count = 30;
  p.samples = 12000;
  p.time_myr = 120.0;
  p.ocean_floor = "age";
  return p;
}

inline Drifted drifted(int nx, std::uint64_t seed, const PlatesParameters& parameters) {
  Drifted out{State(std::make_shared<Grid>(Grid::sphere(nx, nx / 2))), {}};
  const auto stage = make_plates_stage(parameters);
  StageIo io(out.state, stage->info());
  Context context;
  context.seed = seed;
  stage->run(io, context);
  out.budget = context.budget;
  return out;
}

/// Runs the stage with frames every 20 Myr, from the beginning or from a checkpoint.
inline std::vector<Frame> frames_of(const PlatesParameters& parameters, State& state,
                                    std::shared_ptr<const Checkpoint> from,
                                    std::vector<Event> events = {}, Context* told = nullptr) {
  std::vector<Frame> frames;
  const auto stage = make_plates_stage(parameters);
  StageIo io(state, stage->info());
  Context context;
  context.seed = 6;
  context.events = std::move(events);
  context.checkpoint = std::move(from);
  context.on_frame = [&](Frame frame) { frames.push_back(std::move(frame)); };
  stage->run(io, context);
  if (told != nullptr) *told = context;
  return frames;
}

inline PlatesParameters with_frames() {
  PlatesParameters p = quick();
  p.samples = 6000;
  p.time_myr = 100.0;
  p.frames_myr = 20.0;
  p.sphere.rift_per_myr = 0.02;
  p.sphere.plume_mm_yr = 1.0;
  return p;
}

inline bool same_values(const State& a, const State& b) {
  bool same = a.present() == b.present();
  for (const FieldSpec* spec : a.present()) same = same && *a.values(*spec) == *b.values(*spec);
  return same;
}

}  // namespace geo
