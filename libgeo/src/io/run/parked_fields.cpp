#include "parked_fields.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "geo/core/error.hpp"
#include "geo/io/run/recorded_file.hpp"

namespace geo::io {

ParkedFields::ParkedFields(std::filesystem::path folder, std::span<const StageRecord> complete,
                           const State& initial)
    : folder_(std::move(folder)) {
  for (const StageRecord& stage : complete) {
    if (stage.own_grid) continue;
    const auto record = std::make_shared<const StageRecord>(stage);
    for (const FieldSpec* spec : initial.present()) {
      const bool is_its_own = disagreement(stage, *spec, *initial.values(*spec)).empty();
      if (is_its_own) add(record, std::array{spec});
    }
  }
}

void ParkedFields::add(const std::shared_ptr<const StageRecord>& record,
                       std::span<const FieldSpec* const> written) {
  for (const FieldSpec* spec : written) records_[spec->name] = record;
}

void ParkedFields::fetch(const FieldSpec& spec, State& state) const {
  try {
    const Snapshot snapshot =
        read_recorded(folder_, *records_.at(spec.name),
                      [&](const FieldSpec& field) { return field.name == spec.name; });
    for (const auto& [held, values] : snapshot.fields) state.share(*held, values);
  } catch (const InputError& error) {
    throw IoError(error.what());
  }
  if (!state.has(spec)) {
    throw IoError(fmt::format("{}: {} is no longer there", folder_.string(), spec.name));
  }
}

}  // namespace geo::io
