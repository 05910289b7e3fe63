#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/configuration.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/core/event.hpp"
#include "geo/io/config/config.hpp"

namespace terrane {
namespace {

using Rows = std::vector<geo::Parameter>;

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& letter : result) {
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return result;
}

/// Whether every word stands in a parameter's name, meaning, unit or choices.
bool speaks_of(const geo::Parameter& row, const std::vector<std::string>& words) {
  const std::string text =
      lower(fmt::format("{} {} {} {}", row.name, row.doc, row.units, row.range_text()));
  return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
    return text.find(lower(word)) != std::string::npos;
  });
}

/// The parameters of a section and those below it if the first word is its name, of these those
/// that speak of all other words; all without words.
Rows chosen_rows(const Rows& all, std::vector<std::string> words) {
  std::vector<std::string_view> sections;
  for (const geo::Parameter& parameter : all) {
    if (sections.empty() || sections.back() != parameter.section()) {
      sections.push_back(parameter.section());
    }
  }
  std::string section;
  if (!words.empty() && std::find(sections.begin(), sections.end(), words[0]) != sections.end()) {
    section = words[0];
    words.erase(words.begin());
  }
  Rows rows;
  for (const geo::Parameter& parameter : all) {
    if (!section.empty() && !geo::is_section_of(parameter.section(), section)) continue;
    if (speaks_of(parameter, words)) rows.push_back(parameter);
  }
  if (rows.empty()) {
    const std::string sought = fmt::format("{}", fmt::join(words, " "));
    if (const geo::Parameter* today = geo::find_renamed(all, sought)) {
      throw geo::ConfigurationError(fmt::format("{} is now {}", sought, today->name));
    }
    throw geo::ConfigurationError(
        section.empty()
            ? fmt::format(
                  "unknown stage {}, nor does any parameter speak of it: stages and sections "
                  "are {}{}",
                  sought, fmt::join(sections, ", "), geo::io::suggestion(words[0], sections))
            : fmt::format("no parameter of {} speaks of {}", section, sought));
  }
  return rows;
}

void print_table(const Rows& rows) {
  std::size_t name_width = 9;
  std::size_t value_width = 7;
  std::size_t unit_width = 4;
  std::size_t range_width = 5;
  for (const geo::Parameter& row : rows) {
    name_width = std::max(name_width, row.name.size());
    value_width = std::max(value_width, geo::to_toml(row.default_value).size());
    unit_width = std::max(unit_width, row.units.size());
    range_width = std::max(range_width, row.range_text().size());
  }
  const auto line = [&](std::string_view name, std::string_view value, std::string_view unit,
                        std::string_view range, std::string_view source, std::string_view doc) {
    fmt::print("{:<{}}  {:<{}}  {:<{}}  {:<{}}  {:<16}  {}\n", name, name_width, value, value_width,
               unit, unit_width, range, range_width, source, doc);
  };
  line("parameter", "default", "unit", "range", "source", "meaning");
  for (const geo::Parameter& row : rows) {
    line(row.name, geo::to_toml(row.default_value), row.units, row.range_text(), row.source,
         row.doc);
  }
}

nlohmann::ordered_json to_json(const Rows& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const geo::Parameter& row : rows) {
    nlohmann::ordered_json entry{{"name", row.name},
                                 {"type", row.type_name()},
                                 {"units", row.units},
                                 {"doc", row.doc},
                                 {"source", row.source}};
    std::visit([&](const auto& value) { entry["default"] = value; }, row.default_value);
    if (std::isfinite(row.min)) entry["min"] = row.min;
    if (std::isfinite(row.max)) entry["max"] = row.max;
    if (!row.choices.empty()) entry["choices"] = row.choices;
    list.push_back(entry);
  }
  return list;
}

/// The values that one key may have, as JSON Schema tells editors.
nlohmann::ordered_json schema_of(const geo::Parameter& row) {
  nlohmann::ordered_json schema;
  schema["description"] = row.units.empty() || row.units == "1"
                              ? std::string(row.doc)
                              : fmt::format("{}, {}", row.doc, row.units);
  const bool is_real = std::holds_alternative<double>(row.default_value);
  if (row.takes_list) {
    schema["type"] = {"string", "array"};
  } else {
    schema["type"] = is_real ? "number" : std::string(row.type_name());
  }
  std::visit([&](const auto& value) { schema["default"] = value; }, row.default_value);
  if (std::isfinite(row.min)) schema["minimum"] = row.min;
  if (std::isfinite(row.max)) schema["maximum"] = row.max;
  if (!row.choices.empty()) schema["enum"] = row.choices;
  return schema;
}

nlohmann::ordered_json table_schema() {
  return {{"type", "object"},
          {"additionalProperties", false},
          {"properties", nlohmann::ordered_json::object()}};
}

/// The table of a section; sections below it are tables in it.
nlohmann::ordered_json& table_of(nlohmann::ordered_json& root, std::string_view section) {
  nlohmann::ordered_json* table = &root;
  while (!section.empty()) {
    const auto dot = section.find('.');
    const std::string word(section.substr(0, dot));
    section.remove_prefix(dot == std::string_view::npos ? section.size() : dot + 1);
    auto& properties = (*table)["properties"];
    if (!properties.contains(word)) properties[word] = table_schema();
    table = &properties[word];
  }
  return *table;
}

/// The configuration file as a JSON Schema, by which editors complete and check it.
nlohmann::ordered_json schema_of(const Rows& rows, std::vector<geo::Event> events) {
  nlohmann::ordered_json schema = table_schema();
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "Configuration of terrane";
  for (const geo::Parameter& row : rows) {
    table_of(schema, row.section())["properties"][std::string(row.key())] = schema_of(row);
  }
  auto kinds = nlohmann::ordered_json::array();
  for (geo::Event& event : events) {
    auto table = table_schema();
    for (const geo::Parameter& row : event.declarations()) {
      table["properties"][std::string(row.key())] = schema_of(row);
    }
    const nlohmann::ordered_json place{{"type", "array"}, {"items", {{"type", "number"}}}};
    table["properties"]["name"] = {{"type", "string"}};
    table["properties"]["path_deg"] = {{"type", "array"}, {"items", place}};
    table["properties"]["kind"] = {{"const", event.kind()}};
    table["required"] = {"kind"};
    kinds.push_back(std::move(table));
  }
  schema["properties"]["event"] = {{"type", "array"}, {"items", {{"anyOf", kinds}}}};
  return schema;
}

void print_markdown(const Rows& rows, std::string_view heading = {}) {
  std::string_view section;
  for (const geo::Parameter& row : rows) {
    if (row.section() != section) {
      section = row.section();
      fmt::print("\n## {}\n\n| key | default | unit | range | meaning | source |\n",
                 heading.empty() ? fmt::format("[{}]", section) : heading);
      fmt::print("|---|---|---|---|---|---|\n");
    }
    // Other pages, and people, can point at each parameter.
    fmt::print("| <a id=\"{}\"></a>`{}` | `{}` | {} | {} | {} | {} |\n", row.name,
               row.name.substr(section.size() + 1), geo::to_toml(row.default_value), row.units,
               row.range_text(), row.doc, row.source);
  }
}

/// One event of each kind, as a table that gives nothing but its kind would make it.
std::vector<geo::Event> events_of_all_kinds() {
  return {{.name = "", .what = geo::Impact{}},
          {.name = "", .what = geo::Rift{.path = {{10.0, 35.0}, {-5.0, 30.0}}}},
          {.name = "", .what = geo::OceanShift{}},
          {.name = "", .what = geo::PlateMotion{}},
          {.name = "", .what = geo::PlateRift{}},
          {.name = "", .what = geo::CrustChange{}},
          {.name = "", .what = geo::PlumeChange{}}};
}

void print_events(const std::string& format) {
  if (format == "schema") {
    throw geo::ConfigurationError(
        "--format schema: describes whole configurations: give no word, or a section");
  }
  auto events = events_of_all_kinds();
  if (format == "toml") {
    fmt::print("# every kind of event with the defaults of its keys\n{}",
               geo::io::write_events(events));
    return;
  }
  auto json = nlohmann::ordered_json::array();
  for (geo::Event& event : events) {
    const auto heading = fmt::format("[[event]] of kind {}", event.kind());
    if (format == "markdown") {
      print_markdown(event.declarations(), heading);
    } else if (format == "table") {
      fmt::print("{}\n", heading);
      print_table(event.declarations());
    } else {
      json.push_back({{"kind", event.kind()}, {"keys", to_json(event.declarations())}});
    }
  }
  if (format == "json") fmt::print("{}\n", json.dump(2));
}

void check_format(const std::string& format) {
  constexpr std::string_view kFormats[] = {"table", "toml", "json", "markdown", "schema"};
  if (std::find(std::begin(kFormats), std::end(kFormats), format) != std::end(kFormats)) return;
  throw geo::ConfigurationError(fmt::format("--format {}: must be one of {}{}", format,
                                            fmt::join(kFormats, ", "),
                                            geo::io::suggestion(format, kFormats)));
}

}  // namespace

void add_params_command(CLI::App& program, Action& action) {
  struct Options {
    std::vector<std::string> words;
    std::string format = "table";
  };
  CLI::App* command =
      program.add_subcommand("params", "Every parameter: default, unit, range, source");
  const auto options = std::make_shared<Options>();
  command->add_option("STAGE_OR_WORDS", options->words,
                      "A stage or another section, or event; further words, or words alone, choose "
                      "the parameters that speak of all of them; all without any");
  command
      ->add_option("--format", options->format,
                   "table, toml, json, markdown, or schema: a JSON Schema for editors")
      ->type_name("FORMAT");
  command->callback([&action, options] {
    action = [options] {
      check_format(options->format);
      if (options->words == std::vector<std::string>{"event"}) return print_events(options->format);
      const Configuration configuration;
      const Rows rows = chosen_rows(configuration.all_parameters(), options->words);
      if (options->format == "table") return print_table(rows);
      if (options->format == "json") {
        fmt::print("{}\n", to_json(rows).dump(2));
        return;
      }
      if (options->format == "schema") {
        const auto events =
            options->words.empty() ? events_of_all_kinds() : std::vector<geo::Event>();
        fmt::print("{}\n", schema_of(rows, events).dump(2));
        return;
      }
      if (options->format == "toml") {
        fmt::print("{}", geo::io::write_config(rows, "every parameter with its default"));
        return;
      }
      print_markdown(rows);
      if (options->words.empty()) print_events("markdown");
    };
  });
}

}  // namespace terrane
