#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/grid.hpp"

namespace geo::refused_arrays {

using Bytes = std::vector<std::uint8_t>;
using Floats = std::vector<float>;
using Doubles = std::vector<double>;

inline const Grid& planet() {
  static const Grid kGrid = Grid::sphere(12, 6);
  return kGrid;
}
inline std::size_t cells() { return planet().size(); }
inline std::size_t rows() { return planet().ny(); }

/// Hands out lengths of arrays, that of one of them a value too short.
class Lengths {
 public:
  explicit Lengths(int shorter) : left_(shorter) {}
  std::size_t operator()(std::size_t whole) { return whole - (left_-- == 0 ? 1 : 0); }

 private:
  int left_;
};

/// `call` makes `arrays` arrays with the lengths that it is handed and calls `kernel` with them.
/// Some entries have always refused input in place of reporting a bug; their headers say so.
inline void expect_refused(const std::string& kernel, int arrays,
                           const std::function<void(Lengths&)>& call,
                           ErrorKind kind = ErrorKind::bug) {
  for (int k = 0; k < arrays; ++k) {
    SCOPED_TRACE(kernel + ", array " + std::to_string(k));
    Lengths n(k);
    try {
      call(n);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      if (kind == ErrorKind::bug) {
        EXPECT_THAT(error.what(), testing::HasSubstr(kernel));
        EXPECT_THAT(error.what(), testing::HasSubstr(": must have "));
      }
    }
  }
}

}  // namespace geo::refused_arrays
