#include "geo/io/build_info.hpp"

#include "terrane_commit.hpp"

namespace geo::io {

const BuildInfo& build_info() {
  static const BuildInfo kInfo{TERRANE_VERSION, TERRANE_COMMIT, TERRANE_COMPILER};
  return kInfo;
}

}  // namespace geo::io
