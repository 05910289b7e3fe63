#include "geo/io/score/scorecard.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "geo/core/error.hpp"
#include "geo/core/stage.hpp"
#include "geo/io/files/embedded_data.hpp"
#include "score_figures.hpp"

namespace geo::io {
namespace {

/// A row of the table: a line without its value, and the fields that the value is measured from.
struct Target {
  ScoreLine line;
  std::vector<const FieldSpec*> needs;
};

std::vector<const FieldSpec*> fields_named(std::string_view names) {
  std::vector<const FieldSpec*> fields;
  while (!names.empty()) {
    const auto end = std::min(names.find(' '), names.size());
    const FieldSpec* const spec = field::find(names.substr(0, end));
    if (spec == nullptr) throw Bug(fmt::format("scorecard: no field {}", names.substr(0, end)));
    fields.push_back(spec);
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return fields;
}

std::vector<Target> targets() {
  std::vector<Target> all;
  const Table table = embedded_table("targets/earth_scorecard.csv");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Target target;
    target.line = {table.text(row, 0), table.text(row, 1), table.text(row, 2), table.text(row, 3),
                   table.text(row, 8)};
    target.line.earth = table.number(row, 4);
    target.line.tolerance = table.number(row, 5);
    target.line.judged = table.text(row, 6) == "judged";
    target.needs = fields_named(table.text(row, 7));
    all.push_back(std::move(target));
  }
  return all;
}

/// "without crust_age, elevation: 7 figures (…)" for figures with the same reason.
class Reasons {
 public:
  void add(const std::string& reason, const std::string& name) {
    const auto at = std::find_if(reasons_.begin(), reasons_.end(),
                                 [&](const auto& entry) { return entry.first == reason; });
    (at == reasons_.end() ? reasons_.emplace_back(reason, std::vector<std::string>{}) : *at)
        .second.push_back(name);
  }
  [[nodiscard]] std::vector<std::string> sentences() const {
    std::vector<std::string> all;
    for (const auto& [reason, names] : reasons_) {
      all.push_back(fmt::format("{}: {}", reason, fmt::join(names, ", ")));
    }
    return all;
  }

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> reasons_;
};

}  // namespace

bool ScoreLine::within() const { return std::abs(value - earth) <= tolerance; }

int Scorecard::count_within() const {
  return static_cast<int>(std::count_if(lines.begin(), lines.end(),
                                        [](const ScoreLine& line) { return line.within(); }));
}

std::vector<const FieldSpec*> ScoreInParts::fields(Part part) {
  if (part == Part::crust) {
    return {&field::elevation,
            &field::crust_thickness,
            &field::crust_thickness_change,  // where crust has grown or worn, it is measured so
            &field::crust_age,
            &field::continental_fraction,
            &field::plate_id,
            &field::plate_velocity_east,
            &field::plate_velocity_north};
  }
  const auto crust = fields(Part::crust);
  std::vector<const FieldSpec*> others{&field::elevation};
  for (const Target& target : targets()) {
    for (const FieldSpec* spec : target.needs) {
      if (!lists(crust, *spec) && !lists(others, *spec)) others.push_back(spec);
    }
  }
  return others;
}

void ScoreInParts::measure(Part part, const State& state) {
  if (state.grid().topology() != Topology::sphere) {
    throw InputError("scorecard: the grid covers a part of a planet, must be the whole");
  }
  for (const FieldSpec* spec : fields(part)) {
    if (state.has(*spec)) present_.insert(spec->name);
  }
  using Measure = void (*)(const State&, Figures&);
  const auto measures = part == Part::crust
                            ? std::vector<Measure>{measure_relief, measure_crust, measure_plates}
                            : std::vector<Measure>{measure_climate, measure_life, measure_rivers};
  for (const Measure measure : measures) measure(state, figures_);
}

Scorecard ScoreInParts::card() const {
  Scorecard card;
  Reasons reasons;
  for (Target& target : targets()) {
    std::vector<std::string_view> absent;
    for (const FieldSpec* spec : target.needs) {
      if (!present_.contains(spec->name)) absent.push_back(spec->name);
    }
    if (!absent.empty()) {
      reasons.add(fmt::format("no {}", fmt::join(absent, ", ")), target.line.name);
      continue;
    }
    const auto figure = figures_.find(target.line.name);
    if (figure == figures_.end() || !std::isfinite(figure->second)) {
      reasons.add("nothing to measure on this planet", target.line.name);
      continue;
    }
    target.line.value = figure->second;
    card.lines.push_back(std::move(target.line));
  }
  card.left_out = reasons.sentences();
  return card;
}

Scorecard score_planet(const State& state) {
  ScoreInParts score;
  for (const auto part : {ScoreInParts::Part::crust, ScoreInParts::Part::surface}) {
    score.measure(part, state);
  }
  return score.card();
}

std::vector<const FieldSpec*> scorecard_fields() {
  auto fields = ScoreInParts::fields(ScoreInParts::Part::crust);
  for (const FieldSpec* spec : ScoreInParts::fields(ScoreInParts::Part::surface)) {
    if (!lists(fields, *spec)) fields.push_back(spec);
  }
  return fields;
}

}  // namespace geo::io
