#include "geo/io/run/run_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

namespace geo::io {
namespace {

/// Costs of a stage: time on one thread, whatever the grid and per cell, and memory per cell at its
/// peak, fields included.
struct StageCost {
  std::string_view stage;
  double seconds;
  double nanoseconds;
  double memory_bytes;
};

// Measured on default planets of 512 x 256 and 2048 x 1024 cells, one core of an AMD EPYC; memory
// on larger ones and on Earth's relief at 5'.
constexpr StageCost kStageCosts[] = {
    {"plates", 0.8, 710.0, 60.0},     {"isostasy", 0.3, 1100.0, 115.0},
    {"erosion", 0.0, 1770.0, 170.0},  {"climate", 1.1, 360.0, 110.0},
    {"hydrology", 0.0, 140.0, 150.0}, {"biomes", 0.0, 50.0, 130.0},
    {"island", 0.0, 4400.0, 400.0},  // per cell of its own
};
constexpr StageCost kUnknownStage{"", 0.0, 500.0, 150.0};

constexpr double kBaseMemory_bytes = 120e6;  // program and libraries
constexpr double kWriting_ns = 15.0;         // per value: what is not written beside the stages
constexpr double kCompression = 0.55;        // NetCDF values after deflate
constexpr double kVtkCompression = 0.51;     // the same without shuffling, in VTK files
constexpr double kMaps_s = 2.6;              // all maps at their default width, one thread
constexpr double kMaps_bytes = 12e6;
constexpr double kMapWidth_px = 1800.0;
constexpr double kParallelShare = 0.67;  // of the time, Amdahl
constexpr double kReference_s = 0.0102;  // MachineSpeed::one_thread_s where the costs were measured

double value_bytes(const FieldSpec& spec) {
  switch (spec.type) {
    case Type::float64:
      return 8.0;
    case Type::int16:
      return 2.0;
    case Type::int8:
      return 1.0;
    default:
      return 4.0;
  }
}

/// Columns times rows of a stage that has a grid of its own, as its parameters nx and ny say.
std::optional<double> cells_of_own_grid(Stage& stage) {
  const auto parameters = stage.parameters();
  double cells = 1.0;
  for (const std::string_view side : {"nx", "ny"}) {
    const auto* row =
        find_parameter(parameters, std::string(stage.info().name) + "." + std::string(side));
    const auto value = row == nullptr ? ParameterValue{} : row->value();
    if (!std::holds_alternative<std::int64_t>(value)) return {};
    cells *= static_cast<double>(std::get<std::int64_t>(value));
  }
  return cells;
}

}  // namespace

double share_of_vtk(int compression) { return compression > 0 ? kVtkCompression : 1.0; }

Prediction predict(const Pipeline& pipeline, int first, int last, double cells,
                   const MachineSpeed& speed, double vtk_share, double map_width_px) {
  Prediction sum;
  for (int at = first; at <= last; ++at) {
    const StageInfo& info = pipeline.stages()[at]->info();
    const auto* cost = std::find_if(std::begin(kStageCosts), std::end(kStageCosts),
                                    [&](const StageCost& row) { return row.stage == info.name; });
    if (cost == std::end(kStageCosts)) cost = &kUnknownStage;
    const double own_cells =
        info.own_grid ? cells_of_own_grid(*pipeline.stages()[at]).value_or(cells) : cells;
    sum.memory_bytes = std::max(sum.memory_bytes, cost->memory_bytes * own_cells);
    double bytes = 0.0;
    for (const FieldSpec* spec : info.writes) bytes += value_bytes(*spec);
    const double writing_ns = kWriting_ns * static_cast<double>(info.writes.size());
    sum.seconds += cost->seconds + (cost->nanoseconds + writing_ns) * 1e-9 * own_cells;
    sum.disk_bytes += bytes * own_cells * (kCompression + vtk_share);
  }
  const double map_area = std::pow(map_width_px / kMapWidth_px, 2);
  sum.seconds += map_area * kMaps_s;
  sum.disk_bytes += map_area * kMaps_bytes;
  sum.seconds *=
      ((1.0 - kParallelShare) * speed.one_thread_s + kParallelShare * speed.all_threads_s) /
      kReference_s;
  sum.memory_bytes += kBaseMemory_bytes;
  return sum;
}

}  // namespace geo::io
