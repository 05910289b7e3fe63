#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geo/core/checkpoint.hpp"
#include "geo/core/climatology.hpp"
#include "geo/core/event.hpp"
#include "geo/core/field.hpp"
#include "geo/core/initial_conditions.hpp"
#include "geo/core/parameter.hpp"
#include "geo/core/planet.hpp"
#include "geo/core/state.hpp"

namespace geo {

/// What a stage is, and which fields pass through it.
struct StageInfo {
  std::string_view name;
  std::string_view doc{};
  std::vector<const FieldSpec*> reads{};     ///< must be there before it runs
  std::vector<const FieldSpec*> optional{};  ///< used when there
  std::vector<const FieldSpec*> writes{};    ///< there afterwards, and in the stage's file
  /// A part of a planet seen closer: reads a whole planet, a sphere, and hands over a new state on
  /// a grid of its own. The planet's state stays as it is.
  bool own_grid = false;
  /// Whether `Context::events` change what it writes.
  bool feels_events = false;
};

/// Whether a field is one of those that a stage declares, or of any others.
[[nodiscard]] inline bool lists(std::span<const FieldSpec* const> specs, const FieldSpec& spec) {
  return std::any_of(specs.begin(), specs.end(),
                     [&](const FieldSpec* listed) { return listed->name == spec.name; });
}

/// Named sums that must close: rock, water. Written to the manifest.
using Budget = std::map<std::string, double>;

/// Numbers that a stage which runs through time tells after each of its steps: a row a step. Rows
/// may be shorter than there are columns, and NaN is nothing. Written beside its fields.
struct StepTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

/// What else a stage tells in words and numbers: written beside its fields as NN-STAGE-NAME.csv.
struct TextTable {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A distribution of elevations by its quantiles: `fraction` of the area below `elevation_m`, both
/// ascending, `fraction` strictly from 0 to 1.
struct Hypsography {
  std::vector<double> fraction, elevation_m;
};

struct ExemplarLibrary;      // kernels/exemplars/exemplar.hpp
struct PlateReconstruction;  // kernels/plates/plate_reconstruction.hpp

/// What a stage takes: processor time of one thread of the machine that costs were measured on
/// (an Intel Xeon at 2.5 GHz, planets of 128 x 64 to 1024 x 512 cells), and memory.
struct StageCost {
  double per_cell_ns = 500.0;  ///< time for each cell of its grid
  double fixed_s = 0.0;        ///< time whatever the grid
  double on_sphere_s = 0.0;    ///< the same, where the grid is no torus
  double cell_bytes = 150.0;   ///< memory per cell at its peak, all fields included
  double fixed_bytes = 0.0;    ///< memory whatever the grid
};

/// What a run gives a stage besides fields: the planet, the seed, and ways to be heard.
struct Context {
  Planet planet;
  std::uint64_t seed = 1;
  /// What hypsometry by rank aims at; empty unless asked for.
  Hypsography hypsography;
  /// Initial conditions of a history, plates and elevation; empty unless given.
  std::vector<PlateOutline> plates;
  std::shared_ptr<const GivenElevation> initial_elevation;
  /// Finite rotations that drive those plates, and plates that appear later; empty unless given.
  std::shared_ptr<const PlateReconstruction> reconstruction;
  /// What an island's terrain is made like, and a planet's, where exemplars are asked for; empty:
  /// stages grow their own.
  std::shared_ptr<const ExemplarLibrary> exemplars, planet_exemplars;
  /// Discrete events; empty unless asked for.
  std::vector<Event> events;
  /// Called with the fraction of the stage that is done; may be empty.
  std::function<void(double fraction)> on_progress;
  /// Called with each frame of a stage that runs through time; may be empty.
  std::function<void(Frame frame)> on_frame;
  /// What such a stage goes on from; empty: from its beginning.
  std::shared_ptr<const Checkpoint> checkpoint;
  /// What makes months on the state's grid, once a stage can; empty before.
  MonthlyFields monthly_fields;
  /// Set by a signal handler; stages look at it between steps.
  const std::atomic<bool>* stop = nullptr;
  /// Budgets of the stage that runs now.
  Budget budget;
  /// Its steps.
  StepTable steps;
  /// What events did in the stage that runs now.
  std::vector<EventRecord> event_records;
  /// Facts worth a warning to the user, one line each.
  std::vector<std::string> warnings;
  /// All declarations of the pipeline that runs, bound to the values of this run: a stage that runs
  /// others inside gives them the settings that their namesakes have outside.
  std::vector<Parameter> configuration;
  /// Tables that the stage that runs now writes beside its steps.
  std::vector<TextTable> tables;

  /// Reports progress and throws Interrupted if a signal came.
  void advance(double fraction) const;
};

/// A stage's only door to the state. Reading or writing what the stage did not declare throws Bug.
class StageIo {
 public:
  /// `stays`: whether a field that the stage is done with stays in the state, as others read it;
  /// empty: all do.
  StageIo(State& state, const StageInfo& info, std::function<bool(const FieldSpec&)> stays = {})
      : state_(state), info_(info), stays_(std::move(stays)) {}

  [[nodiscard]] const Grid& grid() const noexcept { return state_.grid(); }

  template <class T>
  [[nodiscard]] std::span<const T> read(const Field<T>& spec) const {
    check_readable(spec);
    return state_.read(spec);
  }
  /// Empty when the field is absent.
  template <class T>
  [[nodiscard]] std::span<const T> read_optional(const Field<T>& spec) const {
    check_readable(spec);
    return state_.has(spec) ? state_.read(spec) : std::span<const T>{};
  }
  /// An output: holds zeros, or the field's present values when the stage also reads it.
  template <class T>
  [[nodiscard]] std::span<T> write(const Field<T>& spec) {
    check_writable(spec);
    return state_.update(spec);
  }
  /// An output whose values the stage already has: they are taken over. Throws Bug where they do
  /// not fit the grid.
  template <class T>
  void write(const Field<T>& spec, std::vector<T> values) {
    check_writable(spec);
    state_.set(spec, std::move(values));
  }
  /// The stage reads a field no more: it leaves memory at once unless it has to stay. What
  /// `read` gave of it ends. Throws Bug where the stage writes it.
  void release(const FieldSpec& spec);
  /// The result of a stage with a grid of its own. Throws Bug unless it holds exactly the fields
  /// that the stage declared.
  void hand_over(State result);
  /// Where the stage's outputs are: what was handed over, or the state itself. Throws Bug when a
  /// stage with a grid of its own handed nothing over.
  [[nodiscard]] const State& result() const;

 private:
  void check_readable(const FieldSpec& spec) const;
  void check_writable(const FieldSpec& spec) const;
  State& state_;
  const StageInfo& info_;
  std::function<bool(const FieldSpec&)> stays_;
  std::optional<State> handed_over_;
};

/// One step of the pipeline: turns a state into a richer one.
class Stage {
 public:
  virtual ~Stage() = default;
  [[nodiscard]] virtual const StageInfo& info() const = 0;
  /// Declarations bound to this stage's own parameter struct; section = stage name.
  [[nodiscard]] virtual std::vector<Parameter> parameters() = 0;
  /// Computes. Every declared output is written or an Error thrown.
  virtual void run(StageIo& io, Context& context) const = 0;
  /// Whether its present parameters go together, with the grid and with the fields that there will
  /// be: before a cell is computed. Throws ConfigurationError that names what does not.
  virtual void check(const Grid& /*grid*/,
                     const std::function<bool(const FieldSpec&)>& /*has*/) const {}
  /// What that takes with its present parameters. `configuration` has those of the whole pipeline,
  /// as a stage may run others inside.
  [[nodiscard]] virtual StageCost cost(std::span<const Parameter> /*configuration*/) const {
    return {};
  }
};

}  // namespace geo
