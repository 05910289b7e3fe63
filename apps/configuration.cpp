#include "configuration.hpp"

namespace terrane {

Configuration::Configuration() : pipeline(geo::make_pipeline()) {
  for (auto declarations : {settings.parameters(), planet.parameters(), pipeline.parameters()}) {
    parameters_.insert(parameters_.end(), declarations.begin(), declarations.end());
  }
  all_parameters_ = parameters_;
  const auto own = calibration.parameters();
  all_parameters_.insert(all_parameters_.end(), own.begin(), own.end());
}

std::vector<int> Configuration::stage_numbers() const {
  std::vector<int> numbers;
  for (const geo::StageEntry& entry : geo::stage_table()) numbers.push_back(entry.number);
  return numbers;
}

}  // namespace terrane
