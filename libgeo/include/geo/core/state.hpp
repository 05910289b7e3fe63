#pragma once

#include <atomic>
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

/// Values with a count of those who hold them. A holder on another thread gives them back when it
/// ends; what it read happened before `is_alone` becomes true, so that they may then be changed in
/// place. Several may read at the same time; a single holder is for one thread at a time.
class HeldValues {
 public:
  HeldValues() = default;
  explicit HeldValues(Values values)
      : block_(std::make_shared<Block>(std::move(values), nullptr, 1)) {}
  /// Values that somebody else may change or count: never to be changed here.
  explicit HeldValues(std::shared_ptr<const Values> foreign)
      : block_(std::make_shared<Block>(Values(), std::move(foreign), 1)) {}
  HeldValues(const HeldValues& other) : block_(other.block_) {
    if (block_) block_->holders.fetch_add(1, std::memory_order_relaxed);
  }
  HeldValues(HeldValues&& other) noexcept : block_(std::move(other.block_)) {}
  HeldValues& operator=(HeldValues other) noexcept {
    block_.swap(other.block_);
    return *this;
  }
  ~HeldValues() {
    if (block_) block_->holders.fetch_sub(1, std::memory_order_release);
  }

  [[nodiscard]] const Values& read() const {
    return block_->foreign ? *block_->foreign : block_->own;
  }
  /// Whether nobody else holds them, or ever will but through this.
  [[nodiscard]] bool is_alone() const {
    return !block_->foreign && block_->holders.load(std::memory_order_acquire) == 1;
  }
  /// The values to change; they are copied first unless `is_alone`.
  [[nodiscard]] Values& change() {
    if (!is_alone()) *this = HeldValues(Values(read()));
    return block_->own;
  }
  /// The same as a pointer that holds them until its last copy ends.
  [[nodiscard]] std::shared_ptr<const Values> lend() const {
    const auto holder = std::make_shared<const HeldValues>(*this);
    return {holder, &holder->read()};
  }

 private:
  struct Block {
    Block(Values values, std::shared_ptr<const Values> others, int count)
        : own(std::move(values)), foreign(std::move(others)), holders(count) {}
    Values own;
    std::shared_ptr<const Values> foreign;
    std::atomic<int> holders;
  };
  std::shared_ptr<Block> block_;
};

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
    return std::get<std::vector<T>>(held(spec).read());
  }
  /// A field to be filled: new and zero when absent; when present its own values. Copies first if
  /// somebody else still holds them.
  template <class T>
  [[nodiscard]] std::span<T> update(const Field<T>& spec) {
    auto at = fields_.find(spec.name);
    if (at == fields_.end()) {
      at = fields_.emplace(spec.name, Values(std::vector<T>(grid_->size()))).first;
    }
    return std::get<std::vector<T>>(at->second.change());
  }
  /// Takes over a whole array. Throws Bug if it does not fit the grid.
  template <class T>
  void set(const Field<T>& spec, std::vector<T> values) {
    if (values.size() != static_cast<std::size_t>(grid_->size())) {
      throw Bug("field " + std::string(spec.name) + ": array does not fit the grid");
    }
    fields_[spec.name] = HeldValues(Values(std::move(values)));
  }
  void set(const FieldSpec& spec, Values values);
  /// The same of values that somebody else holds: they are copied before a change.
  void share(const FieldSpec& spec, std::shared_ptr<const Values> values);

  void erase(const FieldSpec& spec) { fields_.erase(spec.name); }

  /// The shared values of a present field, for a writer that outlives the next stage: as long as
  /// the pointer or a copy of it is there, `update` copies them first.
  [[nodiscard]] std::shared_ptr<const Values> values(const FieldSpec& spec) const;
  /// Vocabulary rows of the fields that are present, in vocabulary order.
  [[nodiscard]] std::vector<const FieldSpec*> present() const;

 private:
  [[nodiscard]] const HeldValues& held(const FieldSpec& spec) const;
  void check_fits(const FieldSpec& spec, const Values& values) const;

  std::shared_ptr<const Grid> grid_;
  std::map<std::string_view, HeldValues> fields_;
};

}  // namespace geo
