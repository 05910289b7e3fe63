#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

namespace geo {

/// Number of values that an array handed to a kernel has, and what it may have beside that of all.
struct ArraySize {
  enum class May : unsigned char { be_whole, be_empty, be_single };
  std::string_view name;
  std::size_t size;
  May may = May::be_whole;
};

/// Throws Bug unless all arrays have `wanted` values, those that may be empty or single aside:
///
///   check_sizes("incise", grid.size(), {{"area_m2", area_m2.size()}});
///
/// The message names the kernel, the array and both numbers. Arrays "per cell" are in the order of
/// Grid::cell: row by row from the southernmost, columns from west to east. Arrays "per row" are
/// from south to north.
void check_sizes(std::string_view kernel, std::size_t wanted,
                 std::initializer_list<ArraySize> arrays);

}  // namespace geo
