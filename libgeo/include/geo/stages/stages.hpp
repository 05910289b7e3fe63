#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "geo/core/pipeline.hpp"

namespace geo {

/// One row of the table of stages: its place in the full order, which also begins its file names
/// ("03-erosion.nc"), and how to make one with default parameters.
struct StageEntry {
  int number;
  std::string_view name;
  std::unique_ptr<Stage> (*make)();
};

/// The stages of this version, in the order in which they run.
std::span<const StageEntry> stage_table();

/// A pipeline of all of them with default parameters.
Pipeline make_pipeline();

}  // namespace geo
