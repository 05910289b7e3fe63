#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geo/core/state.hpp"
#include "geo/io/maps/maps.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/score/scorecard.hpp"

namespace geo::io {

/// What a field holds, in three numbers. `mean` is weighted by true area; cells without a value do
/// not count. NaN when there is no value at all.
struct FieldFigures {
  std::string name, units, doc;
  double min = 0.0, mean = 0.0, max = 0.0;
};

/// Figures of the fields of a run from its manifest, in vocabulary order, each as the last stage
/// left it; enumerations and cell numbers, whose mean says nothing, are left out.
std::vector<FieldFigures> field_figures(const Manifest& manifest);

/// What a report shows.
struct Report {
  std::string title;  ///< "terrane: planet of seed 1"
  std::string introduction;
  std::string globe;  ///< markup of a globe, with its script; empty: none
  std::vector<MapFile> maps;
  std::optional<Scorecard> scorecard;  ///< whole planets have one
  std::vector<std::string> events;     ///< what struck the planet, a line each
  std::vector<FieldFigures> fields;
  std::string parameters;  ///< the resolved configuration, as text
  std::vector<std::pair<std::string, std::string>> provenance;  ///< ("seed", "1") …
};

/// Writes `folder`/report.html: one page that opens without a network; it has a script where it
/// has a globe. Pictures are referenced relative to the folder. Throws IoError. Returns its path.
std::filesystem::path write_report(const std::filesystem::path& folder, const Report& report);

}  // namespace geo::io
