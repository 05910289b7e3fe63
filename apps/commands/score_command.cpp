#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/memory_option.hpp"
#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/netcdf/planet_file.hpp"
#include "geo/io/score/scorecard.hpp"

namespace terrane {
namespace {

void print_table(const geo::io::Scorecard& card) {
  std::string group;
  for (const auto& line : card.lines) {
    if (line.group != group) {
      group = line.group;
      fmt::print("{}{:<45} {:>10} {:>10} {:>10}  {}\n", &line == card.lines.data() ? "" : "\n",
                 group, "value", "Earth", "+-", "unit");
    }
    fmt::print("{} {:<43} {:>10.4g} {:>10.4g} {:>9.3g}{}  {}\n", line.within() ? ' ' : '!',
               line.words, line.value, line.earth, line.tolerance, line.judged ? 'j' : ' ',
               line.unit);
  }
  fmt::print("\n{} of {} figures within tolerance (! outside; j tolerance is our judgement)\n",
             card.count_within(), card.lines.size());
  for (const auto& sentence : card.left_out) fmt::print("left out, {}\n", sentence);
}

void print_json(const std::string& place, const geo::State& state, const geo::io::Scorecard& card) {
  auto figures = nlohmann::ordered_json::array();
  for (const auto& line : card.lines) {
    figures.push_back({{"group", line.group},
                       {"name", line.name},
                       {"words", line.words},
                       {"unit", line.unit},
                       {"value", line.value},
                       {"target", line.earth},
                       {"tolerance", line.tolerance},
                       {"judged", line.judged},
                       {"source", line.source},
                       {"within", line.within()}});
  }
  const nlohmann::ordered_json json{
      {"planet", place},
      {"nx", state.grid().nx()},
      {"ny", state.grid().ny()},
      {"figures", figures},
      {"left_out", card.left_out},
      {"totals", {{"figures", card.lines.size()}, {"within", card.count_within()}}}};
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace

void add_score_command(CLI::App& program, Action& action) {
  struct Options {
    std::string place;
    MemoryOption memory;
    bool json = false;
  };
  CLI::App* command =
      program.add_subcommand("score", "Measures a planet and prints its figures beside Earth's");
  const auto options = std::make_shared<Options>();
  command->add_option("DIR_OR_FILE", options->place,
                      "Folder of a run, a stage file, or an elevation NetCDF FILE[:VARIABLE]");
  command->add_flag("--json", options->json, "As JSON");
  add_memory_options(*command, options->memory, "the measuring");
  command->callback([&action, options] {
    action = [options] {
      if (options->place.empty()) {
        throw geo::ConfigurationError(
            "score: which planet? Give the folder of a run or an elevation file");
      }
      use_threads();
      const auto cap = options->memory.cap(".");
      const auto state = geo::io::read_planet_or_dem(options->place, geo::io::scorecard_fields());
      const auto card = geo::io::score_planet(state);
      options->json ? print_json(options->place, state, card) : print_table(card);
    };
  });
}

}  // namespace terrane
