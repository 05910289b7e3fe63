#pragma once

#include <vector>

namespace geo {

/// Empties an array and gives its memory back, which `= {}` and `clear` keep.
template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace geo
