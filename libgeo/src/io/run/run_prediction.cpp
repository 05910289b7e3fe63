#include "geo/io/run/run_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace geo::io {
namespace {

/// Costs of a stage: time of one thread per cell, and memory per cell at its peak, fields included.
struct StageCost {
  std::string_view stage;
  double nanoseconds;
  double memory_bytes;
};

// Measured on default planets of 128 x 64 to 1024 x 512 cells, processor time of one thread on an
// Intel Xeon at 2.5 GHz; memory on larger ones and on Earth's topography at 5'.
constexpr StageCost kStageCosts[] = {
    {"plates", 500.0, 60.0},   {"isostasy", 1950.0, 115.0}, {"erosion", 0.0, 170.0},  // by the step
    {"climate", 300.0, 110.0}, {"hydrology", 100.0, 150.0}, {"biomes", 70.0, 130.0},
    {"island", 2500.0, 400.0},  // per cell of its own
};
constexpr StageCost kUnknownStage{"", 500.0, 150.0};

constexpr double kErosionStep_ns = 259.0;  // per cell
constexpr double kIce_ns = 2000.0;         // per cell: cold and warm times, and today
constexpr double kClimate_s = 2.0;         // air at 2 degrees
constexpr double kClimateAir_deg = 2.0;
constexpr double kClimateGrowth = 2.3;  // power of one over the air's resolution
constexpr double kMesh_s = 0.45;        // plates that grow, on a mesh of their own
constexpr double kDrift_ns = 190.0;     // per sample and million years
constexpr double kRasterPlates_s = 3.0;

constexpr double kBaseMemory_bytes = 120e6;  // program and libraries
constexpr double kWriting_ns = 15.0;         // per value: what is not written beside the stages
constexpr double kLastWriting_ns = 55.0;     // of the last stage: nothing is beside it
constexpr double kCompression = 0.55;        // NetCDF values after deflate
constexpr double kVtkCompression = 0.51;     // the same without shuffling, in VTK files
constexpr double kMaps_s = 1.3;              // all maps at their default width, one thread
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

/// What the parameters say; nothing where a pipeline lacks the one that is asked for.
class Settings {
 public:
  explicit Settings(const Pipeline& pipeline) : parameters_(pipeline.parameters()) {}
  [[nodiscard]] double number(std::string_view name) const {
    const ParameterValue value = value_of(name);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    if (const auto* real = std::get_if<double>(&value)) return *real;
    return 0.0;
  }
  [[nodiscard]] bool is(std::string_view name, std::string_view word) const {
    const ParameterValue value = value_of(name);
    const auto* text = std::get_if<std::string>(&value);
    return text != nullptr && *text == word;
  }

 private:
  [[nodiscard]] ParameterValue value_of(std::string_view name) const {
    const Parameter* row = find_parameter(parameters_, name);
    return row == nullptr ? ParameterValue{} : row->value();
  }
  std::vector<Parameter> parameters_;
};

/// One climate: of the air on its own grid.
double climate_seconds(const Settings& settings) {
  const double resolution_deg = settings.number("climate.resolution_deg");
  if (resolution_deg <= 0.0 || settings.is("climate.model", "blueprint")) return 0.0;
  return kClimate_s * std::pow(kClimateAir_deg / resolution_deg, kClimateGrowth);
}

double plates_seconds(const Settings& settings) {
  if (settings.is("plates.model", "sphere")) {
    return 1e-9 * kDrift_ns * settings.number("plates.sphere.samples") *
           settings.number("plates.sphere.time_myr");
  }
  if (settings.is("plates.model", "raster")) return kRasterPlates_s;
  return settings.is("plates.model", "growth") ? kMesh_s : 0.0;
}

double erosion_seconds(const Settings& settings, double cells) {
  const double steps = settings.number("erosion.steps");
  const double rivers_s = 1e-9 * kErosionStep_ns * steps * cells;
  if (!settings.is("erosion.discharge", "rain") || steps <= 0.0) return rivers_s;
  const double ice_ns = settings.is("erosion.ice.model", "plastic") ? kIce_ns : 0.0;
  return std::min(settings.number("erosion.climates"), steps) * climate_seconds(settings) +
         rivers_s + 1e-9 * ice_ns * cells;
}

/// What a stage takes besides its cost per cell.
double own_seconds(std::string_view stage, const Settings& settings, double cells) {
  if (stage == "plates") return plates_seconds(settings);
  if (stage == "erosion") return erosion_seconds(settings, cells);
  return stage == "climate" ? climate_seconds(settings) : 0.0;
}

}  // namespace

double share_of_vtk(int compression) { return compression > 0 ? kVtkCompression : 1.0; }

Prediction predict(const Pipeline& pipeline, int first, int last, double cells,
                   const MachineSpeed& speed, double vtk_share, double map_width_px) {
  Prediction sum;
  const Settings settings(pipeline);
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
    const double writing_ns =
        (at == last ? kLastWriting_ns : kWriting_ns) * static_cast<double>(info.writes.size());
    sum.seconds += own_seconds(info.name, settings, own_cells) +
                   (cost->nanoseconds + writing_ns) * 1e-9 * own_cells;
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
