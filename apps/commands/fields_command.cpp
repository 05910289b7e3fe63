#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/core/field.hpp"
#include "geo/io/config/config.hpp"
#include "geo/stages/stages.hpp"

namespace terrane {
namespace {

/// A row of the vocabulary with the stages that write it.
struct Row {
  const geo::FieldSpec* spec;
  std::vector<std::string_view> writers;
};

/// What a stage writes, whichever of its models runs.
std::vector<const geo::FieldSpec*> written_by(const geo::StageEntry& entry) {
  const auto stage = entry.make();
  std::vector<const geo::FieldSpec*> all = stage->info().writes;
  const auto parameters = stage->parameters();
  const auto* model =
      geo::find_parameter(parameters, fmt::format("{}.model", std::string_view(entry.name)));
  if (model == nullptr) return all;
  for (const std::string_view choice : model->choices) {
    model->set_text(choice);
    const auto& writes = stage->info().writes;
    all.insert(all.end(), writes.begin(), writes.end());
  }
  return all;
}

std::vector<Row> rows_of_vocabulary() {
  std::vector<Row> rows;
  for (const geo::FieldSpec* spec : geo::field::all()) rows.push_back({spec, {}});
  for (const geo::StageEntry& entry : geo::stage_table()) {
    const auto writes = written_by(entry);
    for (Row& row : rows) {
      if (std::find(writes.begin(), writes.end(), row.spec) != writes.end()) {
        row.writers.push_back(entry.name);
      }
    }
  }
  return rows;
}

std::string_view type_name(geo::Type type) {
  constexpr std::string_view kNames[] = {"float32", "float64", "int8", "int16", "int32"};
  return kNames[static_cast<int>(type)];
}

/// "0 none, 1 north, ..." of an enumeration.
std::string flags_text(const geo::FieldSpec& spec) {
  std::vector<std::string> flags;
  for (const geo::Flag& flag : spec.flags) {
    flags.push_back(fmt::format("{} {}", flag.value, flag.meaning));
  }
  return fmt::format("{}", fmt::join(flags, ", "));
}

/// "0 to 1", ">= 0" or nothing.
std::string bounds_text(const geo::FieldSpec& spec) {
  const bool low = std::isfinite(spec.least), high = std::isfinite(spec.most);
  if (low && high) return fmt::format("{:g} to {:g}", spec.least, spec.most);
  if (low) return fmt::format(">= {:g}", spec.least);
  return high ? fmt::format("<= {:g}", spec.most) : "";
}

void print_table(const std::vector<Row>& rows) {
  const auto line = [](std::string_view name, std::string_view type, std::string_view units,
                       std::string_view bounds, std::string_view writers, std::string_view doc) {
    fmt::print("{:<25}  {:<7}  {:<10}  {:<10}  {:<18}  {}\n", name, type, units, bounds, writers,
               doc);
  };
  line("field", "type", "unit", "range", "written by", "meaning");
  for (const Row& row : rows) {
    line(row.spec->name, type_name(row.spec->type), row.spec->units, bounds_text(*row.spec),
         fmt::format("{}", fmt::join(row.writers, " ")), row.spec->doc);
  }
}

void print_json(const std::vector<Row>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    nlohmann::ordered_json entry{{"name", row.spec->name},
                                 {"type", type_name(row.spec->type)},
                                 {"units", row.spec->units},
                                 {"standard_name", row.spec->standard_name},
                                 {"cell_methods", row.spec->cell_methods},
                                 {"written_by", row.writers},
                                 {"doc", row.spec->doc}};
    if (std::isfinite(row.spec->least)) entry["valid_min"] = row.spec->least;
    if (std::isfinite(row.spec->most)) entry["valid_max"] = row.spec->most;
    for (const geo::Flag& flag : row.spec->flags) {
      entry["flags"][std::to_string(flag.value)] = flag.meaning;
    }
    list.push_back(entry);
  }
  fmt::print("{}\n", list.dump(2));
}

void print_markdown(const std::vector<Row>& rows) {
  fmt::print("| field | type | unit | range | CF standard name | written by | meaning |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    fmt::print("| `{}` | {} | {} | {} | {} | {} | {} |\n", row.spec->name,
               type_name(row.spec->type), row.spec->units, bounds_text(*row.spec),
               row.spec->standard_name, fmt::join(row.writers, ", "), row.spec->doc);
  }
  for (const Row& row : rows) {
    if (row.spec->flags.empty()) continue;
    fmt::print("\nValues of `{}`: {}.\n", row.spec->name, flags_text(*row.spec));
  }
}

}  // namespace

void add_fields_command(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("fields", "Every field of the files: type, unit, stages, meaning");
  const auto format = std::make_shared<std::string>("table");
  command->add_option("--format", *format, "table, json or markdown")->type_name("FORMAT");
  command->callback([&action, format] {
    action = [format] {
      const auto rows = rows_of_vocabulary();
      constexpr std::string_view kFormats[] = {"table", "json", "markdown"};
      if (*format == "table") return print_table(rows);
      if (*format == "json") return print_json(rows);
      if (*format == "markdown") return print_markdown(rows);
      throw geo::ConfigurationError(fmt::format("--format {}: must be one of {}{}", *format,
                                                fmt::join(kFormats, ", "),
                                                geo::io::suggestion(*format, kFormats)));
    };
  });
}

}  // namespace terrane
