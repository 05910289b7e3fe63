#include "geo/core/array_sizes.hpp"

#include <string>

#include "geo/core/error.hpp"

namespace geo {

void check_sizes(std::string_view kernel, std::size_t wanted,
                 std::initializer_list<ArraySize> arrays) {
  for (const ArraySize& array : arrays) {
    if (array.size == wanted) continue;
    if (array.may == ArraySize::May::be_empty && array.size == 0) continue;
    if (array.may == ArraySize::May::be_single && array.size == 1) continue;
    throw Bug(std::string(kernel) + ": " + std::string(array.name) + " has " +
              std::to_string(array.size) + " values: must have " + std::to_string(wanted));
  }
}

}  // namespace geo
