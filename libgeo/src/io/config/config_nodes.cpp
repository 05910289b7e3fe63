#include "config_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"

namespace geo::io {
namespace {

std::string_view kind_of(const toml::node& node) {
  if (node.is_array()) return "an array";
  if (node.is_table()) return "a table";
  return "a date or time";
}

/// A list of words as one text, commas between.
std::optional<ParameterValue> list_value(const toml::node& node) {
  const auto* list = node.as_array();
  if (list == nullptr) return std::nullopt;
  std::string joined;
  for (const toml::node& entry : *list) {
    std::string word;
    if (const auto* words = entry.as_string()) {
      word = words->get();
    } else if (const auto* whole = entry.as_integer()) {
      word = std::to_string(whole->get());
    } else {
      return std::nullopt;
    }
    joined += (joined.empty() ? "" : ", ") + word;
  }
  return ParameterValue(joined);
}

}  // namespace

std::vector<std::string_view> sections_of(std::span<const Parameter> parameters) {
  std::vector<std::string_view> sections;
  for (const Parameter& parameter : parameters) {
    const auto section = parameter.section();
    if (std::find(sections.begin(), sections.end(), section) == sections.end()) {
      sections.push_back(section);
    }
  }
  return sections;
}

std::optional<ParameterValue> plain_value(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return ParameterValue(whole->get());
  if (const auto* number = node.as_floating_point()) return ParameterValue(number->get());
  if (const auto* truth = node.as_boolean()) return ParameterValue(truth->get());
  if (const auto* words = node.as_string()) return ParameterValue(words->get());
  return std::nullopt;
}

void refuse_unknown(const std::string& where, std::string_view name,
                    std::span<const Parameter> parameters) {
  if (const Parameter* today = find_renamed(parameters, name)) {
    throw ConfigurationError(fmt::format("{}{} is now {}", where, name, today->name));
  }
  const auto section = section_of(name);
  const auto sections = sections_of(parameters);
  if (std::find(sections.begin(), sections.end(), section) == sections.end()) {
    throw ConfigurationError(
        fmt::format("{}unknown section [{}]{}", where, section, suggestion(section, sections)));
  }
  // Of the same stage: a key that stands in the section of another model, or is misspelt.
  const std::string_view key = name.substr(name.rfind('.') + 1);
  const std::string_view stage = name.substr(0, name.find('.'));
  std::vector<std::string_view> keys, full_names;
  for (const Parameter& other : parameters) {
    if (!is_section_of(other.section(), stage)) continue;
    keys.push_back(other.key());
    full_names.push_back(other.name);
  }
  std::string hint;
  if (const auto near = nearest_word(key, keys); !near.empty()) {
    const auto at = std::find(keys.begin(), keys.end(), near) - keys.begin();
    hint = fmt::format("; did you mean {}?", full_names[at]);
  }
  if (hint.empty()) hint = fmt::format("; terrane params {} lists what there is", section);
  throw ConfigurationError(fmt::format("{}unknown key {}{}", where, name, hint));
}

void apply_node(const toml::node& node, const std::string& name, const std::string& where,
                std::span<const Parameter> parameters) {
  const Parameter* parameter = find_parameter(parameters, name);
  if (parameter == nullptr) refuse_unknown(where, name, parameters);
  auto value = plain_value(node);
  if (!value && parameter->takes_list) value = list_value(node);
  if (!value) {
    throw ConfigurationError(fmt::format("{}{}: is {}, must be a plain {} value", where, name,
                                         kind_of(node), parameter->type_name()));
  }
  try {
    parameter->set(*value);
  } catch (const ConfigurationError& error) {
    throw ConfigurationError(where + error.what());
  }
}

std::string commented_line(const Parameter& parameter) {
  const bool has_unit = !parameter.units.empty() && parameter.units != "1";
  const std::string range = parameter.range_text();
  return fmt::format("# {}; {}{}{}\n{} = {}\n", parameter.doc, parameter.type_name(),
                     has_unit ? fmt::format(" in {}", parameter.units) : "",
                     range == "any" ? "" : fmt::format(", {}", range), parameter.key(),
                     to_toml(parameter.value()));
}

}  // namespace geo::io
