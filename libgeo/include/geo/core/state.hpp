#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/field.hpp"
#include "geo/core/grid.hpp"

namespace geo {

/// Values of one field, one per cell. Shared and immutable once a stage has finished, so that a
/// writer can stream them to disk while the next stage computes.
using Values = std::variant<std::vector<float>, std::vector<double>, std::vector<std::int8_t>,
                            std::vector<std::int16_t>, std::vector<std::int32_t>>;

/// Named fields on one grid.
class State {
 public:
  explicit State(std::shared_ptr<const Grid> grid) : grid_(std::move(grid)) {}

  [[nodiscard]] const Grid& grid() const noexcept { return *grid_; }
  [[nodiscard]] const std::shared_ptr<const Grid>& shared_grid() const noexcept { return grid_; }

  [[nodiscard]] bool has(const FieldSpec& spec) const { return fields_.contains(spec.name); }

  /// Values of a present field; throws Bug that names the field when absent.
  template <class T>
  [[nodiscard]] std::span<const T> read(const Field<T>& spec) const {
    return std::get<std::vector<T>>(*values(spec));
  }
  /// A field to be filled: new and zero when absent; when present its own values. Copies first if
  /// somebody else still holds them.
  template <class T>
  [[nodiscard]] std::span<T> update(const Field<T>& spec) {
    auto& slot = fields_[spec.name];
    if (!slot.values) {
      slot = {&spec, std::make_shared<Values>(std::vector<T>(grid_->size()))};
    } else if (slot.values.use_count() > 1) {
      slot.values = std::make_shared<Values>(*slot.values);
    }
    return std::get<std::vector<T>>(*slot.values);
  }
  /// Takes over a whole array. Throws Bug if it does not fit the grid.
  template <class T>
  void set(const Field<T>& spec, std::vector<T> values) {
    if (values.size() != static_cast<std::size_t>(grid_->size())) {
      throw Bug("field " + std::string(spec.name) + ": array does not fit the grid");
    }
    fields_[spec.name] = {&spec, std::make_shared<Values>(std::move(values))};
  }
  void set(const FieldSpec& spec, Values values);
  /// The same of values that somebody else may hold too; then they are copied before a change.
  void share(const FieldSpec& spec, std::shared_ptr<const Values> values);

  void erase(const FieldSpec& spec) { fields_.erase(spec.name); }

  /// The shared values of a present field, for a writer that outlives the next stage.
  [[nodiscard]] std::shared_ptr<const Values> values(const FieldSpec& spec) const;
  /// Vocabulary rows of the fields that are present, in vocabulary order.
  [[nodiscard]] std::vector<const FieldSpec*> present() const;

 private:
  struct Slot {
    const FieldSpec* spec = nullptr;
    std::shared_ptr<Values> values;
  };
  std::shared_ptr<const Grid> grid_;
  std::map<std::string_view, Slot> fields_;
};

}  // namespace geo
