#include "geo/io/config/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "config_events.hpp"
#include "config_nodes.hpp"
#include "geo/core/error.hpp"

namespace geo::io {
namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  return text;
}

toml::table parse(std::string_view text, const std::string& source_name) {
  try {
    return toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    throw ConfigurationError(fmt::format("{}:{}: {}", source_name, error.source().begin.line,
                                         one_line(std::string(error.description()))));
  }
}

/// The parameter that has `key` in some section; empty when none has.
std::string_view home_of(std::string_view key, std::span<const Parameter> parameters) {
  for (const Parameter& parameter : parameters) {
    if (parameter.key() == key) return parameter.name;
  }
  return {};
}

bool has_section(std::string_view section, std::span<const Parameter> parameters) {
  return std::any_of(parameters.begin(), parameters.end(), [&](const Parameter& parameter) {
    return is_section_of(parameter.section(), section);
  });
}

/// Keys of a section and of those below it, each with its full name. What is a table without being
/// a section is handed on as a key.
template <class Visit>
void visit_keys(const toml::table& table, const std::string& section,
                std::span<const Parameter> parameters, const Visit& visit) {
  visit_in_text_order(table, [&](const toml::key& key, const toml::node& value) {
    const std::string name = fmt::format("{}.{}", section, key.str());
    if (value.is_table() && has_section(name, parameters)) {
      visit_keys(*value.as_table(), name, parameters, visit);
    } else {
      visit(name, key, value);
    }
  });
}

/// All keys of a configuration that a run has written, with their full names: its tables are its
/// sections.
template <class Visit>
void visit_all_keys(const toml::table& table, const std::string& section, const Visit& visit) {
  visit_in_text_order(table, [&](const toml::key& key, const toml::node& value) {
    const std::string name =
        section.empty() ? std::string(key.str()) : fmt::format("{}.{}", section, key.str());
    if (value.is_table()) {
      visit_all_keys(*value.as_table(), name, visit);
    } else if (!section.empty()) {
      visit(name, value);
    }
  });
}

/// "event 2 is another, or absent"; empty when all are the same.
std::string differing_event(const toml::table& before, const toml::table& after) {
  const auto written = [](const toml::table& root, std::size_t at) {
    const toml::node* node = root[kEventKey][at].node();
    std::ostringstream text;
    if (node != nullptr) text << toml::default_formatter(*node);
    return text.str();
  };
  const auto count = [](const toml::table& root) {
    const auto* events = root[kEventKey].as_array();
    return events == nullptr ? 0 : events->size();
  };
  for (std::size_t at = 0; at < std::max(count(before), count(after)); ++at) {
    if (at >= count(after)) return fmt::format("event {} is absent", at + 1);
    if (at >= count(before)) return fmt::format("event {} was absent", at + 1);
    if (written(before, at) != written(after, at))
      return fmt::format("event {} is another", at + 1);
  }
  return {};
}

}  // namespace

std::string suggestion(std::string_view word, std::span<const std::string_view> candidates,
                       std::string_view separator) {
  const std::string near = nearest_word(word, candidates);
  return near.empty() ? std::string() : fmt::format("{}did you mean {}?", separator, near);
}

std::vector<std::string> apply_toml(std::string_view text, const std::string& source_name,
                                    std::span<const Parameter> parameters,
                                    std::vector<Event>* events) {
  const toml::table root = parse(text, source_name);
  std::vector<std::string> applied;
  const auto where_of = [&](const toml::key& key) {
    return fmt::format("{}:{}: ", source_name, key.source().begin.line);
  };
  visit_in_text_order(root, [&](const toml::key& section, const toml::node& node) {
    if (events != nullptr && section.str() == kEventKey) {
      *events = events_from_toml(node, source_name);
      return;
    }
    const auto* table = node.as_table();
    if (table == nullptr) {
      const auto home = home_of(section.str(), parameters);
      throw ConfigurationError(
          fmt::format("{}key {} must stand in a section{}", where_of(section), section.str(),
                      home.empty() ? "" : fmt::format("; did you mean [{}]?", section_of(home))));
    }
    if (!has_section(section.str(), parameters)) {
      refuse_unknown(where_of(section), fmt::format("{}.", section.str()), parameters);
    }
    visit_keys(*table, std::string(section.str()), parameters,
               [&](const std::string& name, const toml::key& key, const toml::node& value) {
                 if (value.is_table() && find_parameter(parameters, name) == nullptr) {
                   refuse_unknown(where_of(key), fmt::format("{}.", name), parameters);
                 }
                 apply_node(value, name, where_of(key), parameters);
                 applied.push_back(name);
               });
  });
  return applied;
}

std::string read_text(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    throw IoError(fmt::format("{}: is a folder, must be a file", path.string()));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad())
    throw IoError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  return text.str();
}

std::vector<std::string> apply_config_file(const std::filesystem::path& path,
                                           std::span<const Parameter> parameters,
                                           std::vector<Event>* events) {
  return apply_toml(read_text(path), path.string(), parameters, events);
}

std::string apply_assignment(std::string_view assignment, std::span<const Parameter> parameters) {
  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw ConfigurationError(
        fmt::format("--set {}: must be section.key=value", one_line(std::string(assignment))));
  }
  const auto trimmed = [](std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return std::string_view();
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
  };
  const auto name = trimmed(assignment.substr(0, equals));
  if (section_of(name) == kEventKey) {
    throw ConfigurationError(
        fmt::format("--set {}: events are tables [[event]] of a configuration file", assignment));
  }
  const Parameter* parameter = find_parameter(parameters, name);
  if (parameter == nullptr && name.find('.') == std::string_view::npos) {
    const auto home = home_of(name, parameters);
    throw ConfigurationError(
        fmt::format("--set {}: must be section.key=value{}", assignment,
                    home.empty() ? "" : fmt::format("; did you mean {}?", home)));
  }
  if (parameter == nullptr) refuse_unknown("--set: ", name, parameters);
  try {
    parameter->set_text(trimmed(assignment.substr(equals + 1)));
  } catch (const ConfigurationError& error) {
    throw ConfigurationError(fmt::format("--set: {}", error.what()));
  }
  return std::string(name);
}

std::string write_config(std::span<const Parameter> parameters, std::string_view heading,
                         std::span<const Event> events) {
  std::string text = fmt::format("# {}\n", heading);
  for (const auto section : sections_of(parameters)) {
    text += fmt::format("\n[{}]\n", section);
    for (const Parameter& parameter : parameters) {
      if (parameter.section() != section) continue;
      text += commented_line(parameter);
    }
  }
  return text + write_events(events);
}

std::string configured_text(std::string_view toml, std::string_view name) {
  const toml::table root = parse(toml, "config.toml");
  return root.at_path(name).value_or(std::string());
}

bool configured_flag(std::string_view toml, std::string_view name) {
  const toml::table root = parse(toml, "config.toml");
  return root.at_path(name).value_or(false);
}

std::string first_difference(std::string_view before, std::string_view after,
                             std::span<const std::string> sections,
                             std::span<const std::string_view> ignored_names) {
  const toml::table old_root = parse(before, "config.toml");
  const toml::table new_root = parse(after, "the present configuration");
  std::string found;
  const auto is_listed = [&](std::string_view name) {
    return std::find(sections.begin(), sections.end(), name) != sections.end();
  };
  const auto is_compared = [&](std::string_view section) {
    return sections.empty() ||
           std::any_of(sections.begin(), sections.end(),
                       [&](const auto& listed) { return is_section_of(section, listed); });
  };
  const auto compare = [&](const toml::table& from, const toml::table& other, bool forward) {
    visit_all_keys(from, {}, [&](const std::string& name, const toml::node& here) {
      if (!found.empty() || !(is_compared(section_of(name)) || is_listed(name)) ||
          std::find(ignored_names.begin(), ignored_names.end(), name) != ignored_names.end()) {
        return;
      }
      const toml::node* there = other.at_path(name).node();
      const auto shown = [](const toml::node* value) {
        const auto plain = value == nullptr ? std::nullopt : plain_value(*value);
        return plain ? to_toml(*plain) : std::string("absent");
      };
      const std::string one = shown(&here);
      const std::string two = shown(there);
      if (one != two) {
        found = fmt::format("{} is {}, was {}", name, forward ? one : two, forward ? two : one);
      }
    });
  };
  compare(new_root, old_root, true);
  if (found.empty()) compare(old_root, new_root, false);
  if (found.empty() && is_compared(kEventKey)) found = differing_event(old_root, new_root);
  return found;
}

}  // namespace geo::io
