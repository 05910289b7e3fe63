#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string_view>

#include "geo/core/state.hpp"
#include "geo/io/run/manifest.hpp"

namespace geo::io {

/// Fields of a run that wait in the files of their stages for a stage that reads them: memory holds
/// what the present stage works with.
class ParkedFields {
 public:
  /// `complete`: stages whose files are there when the run begins, which may have been given other
  /// values than theirs: those of `initial` count.
  ParkedFields(std::filesystem::path folder, std::span<const StageRecord> complete,
               const State& initial);

  /// A stage's file holds, or will hold when it is next asked for, the fields that it wrote.
  void add(const std::shared_ptr<const StageRecord>& record,
           std::span<const FieldSpec* const> written);
  /// Whether a file has the values that a field has now.
  [[nodiscard]] bool has(const FieldSpec& spec) const { return records_.contains(spec.name); }
  /// Reads a field back. Throws IoError where its file does not give what was written there.
  void fetch(const FieldSpec& spec, State& state) const;

 private:
  std::filesystem::path folder_;
  std::map<std::string_view, std::shared_ptr<const StageRecord>> records_;
};

}  // namespace geo::io
