#include "geo/io/run/run_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace geo::io {
namespace {

constexpr double kBaseMemory_bytes = 75e6;    // program and libraries
constexpr double kBesideIsland_bytes = 65.0;  // per cell of a planet while an island is made
constexpr double kWriting_ns = 11.0;          // per value: what is not written beside the stages
constexpr double kLastWriting_ns = 40.0;      // of the last stage: nothing is beside it
constexpr double kCompression = 0.55;         // NetCDF values after deflate
constexpr double kVtkCompression = 0.51;      // the same without shuffling, in VTK files
constexpr double kMaps_s = 3.0;               // all maps at their default width, one thread
constexpr double kMaps_bytes = 12e6;
constexpr double kMapWidth_px = 1800.0;
constexpr double kPictures_bytes = 90e6;        // memory of all maps at that width, drawn at once
constexpr double kPicturesOfCell_bytes = 90.0;  // of the fields that they are drawn from
constexpr double kPicturesOfIsland_bytes = 200.0;  // the same per cell of an island
constexpr double kParallelShare = 0.75;            // of the time, Amdahl
constexpr double kReference_s = 0.0075;  // MachineSpeed::one_thread_s where the costs were measured

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

/// `vtk_share` is 0 where no VTK files are written, else share_of_vtk.
Prediction predict_with(double vtk_share, const RunConfiguration& run, const RunPlan& plan,
                        double cells, const MachineSpeed& speed) {
  const Pipeline& pipeline = run.pipeline;
  const int first = plan.first, last = plan.last;
  const double map_width_px =
      run.settings.maps ? static_cast<double>(run.settings.map_width_px) : 0.0;
  const bool on_sphere = run.settings.topology == "sphere";
  Prediction sum;
  double pictures_bytes =
      kPictures_bytes * std::pow(map_width_px / kMapWidth_px, 2) + kPicturesOfCell_bytes * cells;
  const std::vector<Parameter> configuration = pipeline.parameters();
  for (int at = first; at <= last; ++at) {
    const StageInfo& info = pipeline.stages()[at]->info();
    const StageCost cost = pipeline.stages()[at]->cost(configuration);
    const double own_cells =
        info.own_grid ? cells_of_own_grid(*pipeline.stages()[at]).value_or(cells) : cells;
    const double beside_bytes = info.own_grid ? kBesideIsland_bytes * cells : 0.0;
    if (info.own_grid) pictures_bytes += kPicturesOfIsland_bytes * own_cells;
    sum.memory_bytes =
        std::max(sum.memory_bytes, cost.fixed_bytes + cost.cell_bytes * own_cells + beside_bytes);
    double bytes = 0.0;
    for (const FieldSpec* spec : info.writes) bytes += value_bytes(*spec);
    const double writing_ns =
        (at == last ? kLastWriting_ns : kWriting_ns) * static_cast<double>(info.writes.size());
    sum.seconds += cost.fixed_s + (on_sphere ? cost.on_sphere_s : 0.0) +
                   (cost.per_cell_ns + writing_ns) * 1e-9 * own_cells;
    sum.disk_bytes += bytes * own_cells * (kCompression + vtk_share);
  }
  const double map_area = std::pow(map_width_px / kMapWidth_px, 2);
  sum.seconds += map_area * kMaps_s;
  sum.disk_bytes += map_area * kMaps_bytes;
  sum.seconds *=
      ((1.0 - kParallelShare) * speed.one_thread_s + kParallelShare * speed.all_threads_s) /
      kReference_s;
  if (map_area > 0.0) {
    sum.memory_bytes = std::max(sum.memory_bytes, pictures_bytes);
  }
  sum.memory_bytes += kBaseMemory_bytes;
  return sum;
}

}  // namespace

double share_of_vtk(int compression) { return compression > 0 ? kVtkCompression : 1.0; }

Prediction predict(const RunConfiguration& run, const RunPlan& plan, double cells,
                   const MachineSpeed& speed) {
  const RunSettings& settings = run.settings;
  const double vtk_share = share_of_vtk(static_cast<int>(settings.vtk_compression));
  const auto predicted = [&](bool vtk) {
    return predict_with(vtk ? vtk_share : 0.0, run, plan, cells, speed);
  };
  Prediction sum = predicted(settings.vtk);
  if (settings.globe) {
    constexpr double kSurface_bytes = 36.0;  // of a cell: corners and faces
    sum.disk_bytes += predicted(true).disk_bytes - predicted(false).disk_bytes +
                      vtk_share * kSurface_bytes * cells * (plan.last - plan.first + 1);
  }
  return sum;
}

}  // namespace geo::io
