#include "geo/core/state.hpp"

namespace geo {

void State::check_fits(const FieldSpec& spec, const Values& values) const {
  const auto size = std::visit([](const auto& array) { return array.size(); }, values);
  if (size != static_cast<std::size_t>(grid_->size())) {
    throw Bug("field " + std::string(spec.name) + ": array does not fit the grid");
  }
  if (values.index() != static_cast<std::size_t>(spec.type)) {
    throw Bug("field " + std::string(spec.name) + ": array of another type");
  }
}

void State::set(const FieldSpec& spec, Values values) {
  check_fits(spec, values);
  fields_[spec.name] = HeldValues(std::move(values));
}

void State::share(const FieldSpec& spec, std::shared_ptr<const Values> values) {
  check_fits(spec, *values);
  fields_[spec.name] = HeldValues(std::move(values));
}

const HeldValues& State::held(const FieldSpec& spec) const {
  const auto at = fields_.find(spec.name);
  if (at == fields_.end()) throw Bug("field " + std::string(spec.name) + " is not there");
  return at->second;
}

std::shared_ptr<const Values> State::values(const FieldSpec& spec) const {
  return held(spec).lend();
}

std::vector<const FieldSpec*> State::present() const {
  std::vector<const FieldSpec*> specs;
  for (const FieldSpec* spec : field::all()) {
    if (has(*spec)) specs.push_back(spec);
  }
  return specs;
}

}  // namespace geo
