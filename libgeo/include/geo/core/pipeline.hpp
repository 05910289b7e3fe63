#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geo/core/stage.hpp"

namespace geo {

/// An ordered list of stages over one state.
class Pipeline {
 public:
  explicit Pipeline(std::vector<std::unique_ptr<Stage>> stages) : stages_(std::move(stages)) {}

  [[nodiscard]] std::span<const std::unique_ptr<Stage>> stages() const noexcept { return stages_; }
  /// Position of a stage, or -1.
  [[nodiscard]] int find(std::string_view name) const;
  /// All stages' declarations, in order.
  [[nodiscard]] std::vector<Parameter> parameters() const;

  /// Checks, before a cell is computed, that stages first..last (positions, inclusive) find every
  /// field they read in `initial` or in an earlier stage of that span, and that their parameters go
  /// together, and with the grid (Stage::check). Throws ConfigurationError that names the field,
  /// who wants it and who would write it, or what does not go together.
  void check(const Grid& grid, std::span<const FieldSpec* const> initial, int first,
             int last) const;

  /// Who watches a run: called before and after each stage (with the budgets it reported).
  struct Observer {
    std::function<void(int position)> before;
    std::function<void(int position, const State&, const Context&)> after;
    /// Whether a field that the next stage does not read, but a later one does, may leave memory
    /// until then: it can be had again. Empty: all stay.
    std::function<bool(const FieldSpec&)> can_park{};
    /// Puts such a field into the state again, before the stage that reads it.
    std::function<void(const FieldSpec&, State&)> fetch{};
  };
  /// Runs first..last. `after` gets what the stage made: the state, or that of its own grid. After
  /// each stage, fields that no later stage in the span reads leave the state, and those that are
  /// parked until then. Checks that a stage wrote what it declared (Bug otherwise).
  void run(State& state, Context& context, int first, int last, const Observer& observer) const;

 private:
  static constexpr int kNever = -1;
  /// The first stage behind `at` that reads the values that the field has now, or kNever.
  [[nodiscard]] int next_reader(const FieldSpec& spec, int at, int last) const;

  std::vector<std::unique_ptr<Stage>> stages_;
};

}  // namespace geo
