#include "described_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>

#include "apps/configuration.hpp"
#include "geo/core/field.hpp"
#include "geo/io/config/presets.hpp"
#include "geo/stages/stages.hpp"

namespace terrane {

DescribedCommand describe(const CLI::App& command) {
  DescribedCommand described{
      command.get_name(), command.get_description(), {}, command.get_footer()};
  for (const CLI::Option* option : command.get_options()) {
    DescribedOption row{{}, option->get_type_name(), option->get_description(), true};
    for (const auto& name : option->get_snames()) row.names.push_back("-" + name);
    for (const auto& name : option->get_lnames()) row.names.push_back("--" + name);
    if (row.names.empty()) row.argument = option->get_name(true);
    row.takes_value = row.names.empty() || option->get_type_size() != 0;
    described.options.push_back(std::move(row));
  }
  return described;
}

std::vector<DescribedCommand> describe_commands(const CLI::App& program) {
  std::vector<DescribedCommand> commands;
  for (const CLI::App* command : program.get_subcommands({})) {
    commands.push_back(describe(*command));
  }
  return commands;
}

std::vector<std::string> words_for(const DescribedOption& option) {
  const auto is = [&](std::string_view name) {
    return std::find(option.names.begin(), option.names.end(), name) != option.names.end();
  };
  std::vector<std::string> words;
  if (is("--preset")) {
    for (const auto& preset : geo::io::presets()) words.emplace_back(preset.name);
  } else if (is("--set")) {
    const Configuration configuration;
    for (const geo::Parameter& row : configuration.parameters()) {
      words.push_back(fmt::format("{}=", row.name));
    }
  } else if (is("--from") || is("--to")) {
    for (const geo::StageEntry& stage : geo::stage_table()) words.emplace_back(stage.name);
  } else if (is("--field")) {
    for (const geo::FieldSpec* spec : geo::field::all()) words.emplace_back(spec->name);
  }
  return words;
}

}  // namespace terrane
