#pragma once

#include <vector>

#include "geo/core/planet.hpp"
#include "geo/io/config/run_settings.hpp"
#include "geo/stages/stages.hpp"

namespace geo::test {

/// Everything that can be configured, with the owners that the declarations point into.
struct Declarations {
  Planet planet;
  io::RunSettings settings;
  Pipeline pipeline = make_pipeline();

  [[nodiscard]] std::vector<Parameter> all() {
    std::vector<Parameter> rows;
    for (auto part : {settings.parameters(), planet.parameters(), pipeline.parameters()}) {
      rows.insert(rows.end(), part.begin(), part.end());
    }
    return rows;
  }
};

}  // namespace geo::test
