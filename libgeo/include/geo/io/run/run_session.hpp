#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geo/core/pipeline.hpp"
#include "geo/io/files/background_writer.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/run_events.hpp"
#include "geo/io/run/run_folder.hpp"
#include "geo/io/run/run_inputs.hpp"
#include "geo/io/run/run_pictures.hpp"
#include "geo/io/run/run_plan.hpp"
#include "geo/io/run/run_prediction.hpp"
#include "geo/io/run/run_request.hpp"
#include "geo/io/run/run_resume.hpp"

namespace geo::io {

class FrameFiles;
class ParkedFields;

/// One run of a pipeline into a folder: configuration, DEM, stages, files.
///
/// A stage is complete when its files are there whole and the manifest has its entry; the manifest
/// is replaced after each stage. So whatever ends a run, the folder holds complete stages and
/// nothing that only looks like one, and `resume` goes on behind them with the same bits.
class RunSession {
 public:
  /// `numbers` are the places of the pipeline's stages in the full order.
  RunSession(RunConfiguration run, std::vector<int> numbers, RunRequest request);

  /// Checks everything that can be checked before a cell is computed, and reads the input: names of
  /// stages, the folder, the DEM, the wiring, room on the disk. Writes nothing. Throws
  /// ConfigurationError, InputError, IoError.
  void prepare();
  /// What the prepared run will take on a machine of some speed.
  [[nodiscard]] Prediction prediction(const MachineSpeed& speed) const {
    return prediction_on(static_cast<double>(grid().size()), speed);
  }
  /// What it would take on another grid, of so many cells.
  [[nodiscard]] Prediction prediction_on(double cells, const MachineSpeed& speed) const {
    return predict(run_, plan_, cells, speed);
  }
  /// Names of the stages that are still to be computed.
  [[nodiscard]] std::vector<std::string_view> stages_to_run() const;
  [[nodiscard]] const Grid& grid() const { return inputs_.state->grid(); }

  /// Computes and writes. Throws Interrupted when `events.stop` was set: the files of finished
  /// stages are whole then.
  void execute(const RunEvents& events);

 private:
  [[nodiscard]] StageFolder stage_folder() const { return {folder_, run_, numbers_}; }
  void open_folder();
  void compute(const RunEvents& events);
  void write_stage(BackgroundWriter& writer, FrameFiles& frames, ParkedFields& parked, int position,
                   const State& state, const Context& context, double seconds);
  void keep_for_pictures(int position, const State& state);
  void write_summaries(const RunEvents& events);
  void write_collections();

  RunConfiguration run_;
  std::vector<int> numbers_;
  RunRequest request_;
  RunFolder folder_;
  Manifest manifest_;

  RunPlan plan_;
  RunInputs inputs_;
  std::string config_;
  FieldsAtHand at_hand_;
};

}  // namespace geo::io
