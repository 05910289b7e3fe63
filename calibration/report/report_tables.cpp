#include "calibration/report/report_tables.hpp"

#include <fmt/format.h>

#include <cmath>

#include "calibration/report/report_markup.hpp"
#include "calibration/report/report_words.hpp"
#include "geo/io/drawing/chart.hpp"

namespace geo::calibration {
namespace {

using Rows = std::vector<std::vector<Cell>>;

std::string plus_minus(double mean, double deviation) {
  return fmt::format("{} ± {}", shown(mean), shown(deviation));
}

std::string unit_of(const std::string& units) { return units == "1" ? "" : units; }

double misfit(const Residual& residual, double value) {
  return (value - residual.target) / residual.deviation;
}

/// Marked where it is more than two deviations off.
Cell misfit_cell(double deviations) {
  return {shown(deviations, 2), std::abs(deviations) > 2.0 ? "number outside" : "number"};
}

std::vector<Cell> residual_row(const Residual& residual) {
  return {{residual.name},
          number_cell(residual.target, 4),
          number_cell(residual.before, 4),
          number_cell(residual.after, 4),
          number_cell(residual.deviation),
          {unit_of(residual.units)},
          misfit_cell(misfit(residual, residual.before)),
          misfit_cell(misfit(residual, residual.after))};
}

void add_residual_table(pugi::xml_node parent, const Rows& rows) {
  add_table(parent,
            {"statistic", "target", "before", "after", "deviation", "unit", "before, deviations",
             "after, deviations"},
            rows);
}

struct Group {
  std::string name, grid;
  const std::vector<SeedMisfit>& seeds;
  const SeedSpread& spread;
};

std::vector<Group> groups_of(const Result& result) {
  return {{"fitted", result.grid, result.fitted, result.fitted_spread},
          {"held out", result.grid, result.held_out, result.held_out_spread},
          {"held-out resolution", result.held_out_grid, result.held_out_resolution,
           result.held_out_resolution_spread}};
}

}  // namespace

void add_parameter_table(pugi::xml_node section, const Result& result) {
  Rows rows;
  for (const FittedParameter& parameter : result.parameters) {
    rows.push_back(
        {{parameter.name},
         number_cell(parameter.start, 4),
         number_cell(parameter.fitted, 4),
         number_cell(parameter.standard_error, 2),
         number_cell(parameter.seed_error, 2),
         {unit_of(parameter.units)},
         {fmt::format("{} to {}{}", io::tick_label(parameter.low), io::tick_label(parameter.high),
                      parameter.logarithmic ? ", log scale" : ""),
          "number"},
         {parameter.prior_deviation > 0.0
              ? fmt::format("{} ± {}", io::tick_label(parameter.prior_mean),
                            io::tick_label(parameter.prior_deviation))
              : "none",
          "number"},
         parameter.at_bound ? Cell{"✗ at its bound", "outside"} : Cell{"✓ inside", "within"}});
  }
  add_table(section,
            {"parameter", "start", "fitted", "standard error", "spread of seeds", "unit", "bounds",
             "prior", ""},
            rows);
  auto meanings = add_details(section, "What the parameters mean");
  auto list = add(meanings, "dl");
  for (const FittedParameter& parameter : result.parameters) {
    add(add(list, "dt"), "code", parameter.name);
    add(list, "dd", parameter.doc);
  }
}

void add_residual_tables(pugi::xml_node section, const Result& result) {
  Rows terms, curve;
  for (const Residual& residual : result.residuals) {
    (std::isfinite(residual.share) ? curve : terms).push_back(residual_row(residual));
  }
  if (!terms.empty()) add_residual_table(section, terms);
  if (curve.empty()) return;
  add_residual_table(
      add_details(section, fmt::format("The {} quantiles of the curve", curve.size())), curve);
}

void add_misfit_tables(pugi::xml_node section, const Result& result) {
  Rows means, seeds;
  for (const Group& group : groups_of(result)) {
    if (group.seeds.empty()) continue;
    means.push_back(
        {{group.name},
         {group.grid},
         {seeds_in_words(group.seeds)},
         {plus_minus(mean_before_m(group.seeds), spread(group.seeds, &SeedMisfit::before_m)),
          "number"},
         {plus_minus(mean_after_m(group.seeds), spread(group.seeds, &SeedMisfit::after_m)),
          "number"},
         {fmt::format("{} → {}", shown(group.spread.before_m), shown(group.spread.after_m)),
          has_collapsed(group.spread) ? "number outside" : "number"}});
    for (const SeedMisfit& seed : group.seeds) {
      const bool better = seed.after_m <= seed.before_m;
      seeds.push_back({{fmt::format("{}, seed {}", group.name, seed.seed)},
                       number_cell(seed.before_m),
                       number_cell(seed.after_m),
                       better ? Cell{"✓ better", "within"} : Cell{"✗ worse", "outside"}});
    }
  }
  add_table(section, {"planets", "grid", "seeds", "before, m", "after, m", "curves apart, m"},
            means);
  add_table(add_details(section, "Seed by seed"), {"planet", "before, m", "after, m", ""}, seeds);
}

void add_iteration_table(pugi::xml_node section, const Result& result) {
  std::vector<std::string> heads{"step", "cost", "distance, m", "largest change", ""};
  for (const FittedParameter& parameter : result.parameters) heads.push_back(parameter.name);
  Rows rows;
  for (const Iteration& iteration : result.iterations) {
    std::vector<Cell> row{
        {fmt::format("start {}, step {}", iteration.start + 1, iteration.number)},
        number_cell(iteration.cost, 5),
        number_cell(iteration.wasserstein_m),
        number_cell(iteration.step, 2),
        {iteration.accepted ? "✓ kept" : "✗ not kept", iteration.accepted ? "within" : "outside"}};
    for (const double value : iteration.values) row.push_back(number_cell(value, 4));
    rows.push_back(std::move(row));
  }
  add_table(add_details(section, "Step by step"), heads, rows);
}

void add_start_table(pugi::xml_node section, const Result& result) {
  std::vector<std::string> heads{"start", "cost", "steps", ""};
  for (const FittedParameter& parameter : result.parameters) {
    heads.push_back(parameter.name + ", from");
    heads.push_back("to");
  }
  Rows rows;
  for (std::size_t i = 0; i < result.starts.size(); ++i) {
    const Start& start = result.starts[i];
    std::vector<Cell> row{
        {fmt::format("{}", i + 1)},
        number_cell(start.cost, 5),
        {fmt::format("{}", start.iterations), "number"},
        start.converged ? Cell{"✓ converged", "within"} : Cell{"✗ not converged", "outside"}};
    for (std::size_t p = 0; p < start.from.size(); ++p) {
      row.push_back(number_cell(start.from[p], 4));
      row.push_back(number_cell(start.to[p], 4));
    }
    rows.push_back(std::move(row));
  }
  add_table(section, heads, rows);
}

void add_direction_table(pugi::xml_node section, const Result& result) {
  Rows rows;
  for (std::size_t i = 0; i < result.directions.size(); ++i) {
    const Direction& direction = result.directions[i];
    rows.push_back({{fmt::format("{}", i + 1)},
                    number_cell(direction.singular_value),
                    {combination_in_words(direction, result.parameters)}});
  }
  add_table(section, {"direction", "singular value", "combination"}, rows);
}

}  // namespace geo::calibration
