#pragma once

#include <map>
#include <string>

#include "geo/core/error.hpp"
#include "geo/core/state.hpp"

namespace geo {

/// Named arrays from which a stage that runs through time goes on, bit for bit: what its fields on
/// the grid do not hold.
struct Checkpoint {
  double time_myr = 0.0;
  std::map<std::string, Values> arrays;

  /// Throws InputError when there is no such array or it holds another type.
  template <class T>
  [[nodiscard]] const std::vector<T>& get(const std::string& name) const {
    const auto found = arrays.find(name);
    if (found == arrays.end() || !std::holds_alternative<std::vector<T>>(found->second)) {
      throw InputError("the frame to go on from lacks " + name);
    }
    return std::get<std::vector<T>>(found->second);
  }
};

/// The planet at one time of a stage that runs through time.
struct Frame {
  State fields;           ///< all that the stage writes
  Checkpoint checkpoint;  ///< to go on from there
};

}  // namespace geo
