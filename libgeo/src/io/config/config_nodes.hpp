#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/parameter.hpp"

namespace geo::io {

// What a configuration file's nodes have in common, whichever table they stand in.

[[nodiscard]] std::vector<std::string_view> sections_of(std::span<const Parameter> parameters);

/// The value of a node, or nothing where it is no plain value (array, table, date).
[[nodiscard]] std::optional<ParameterValue> plain_value(const toml::node& node);

/// Throws the ConfigurationError of a section or key that no parameter has: with its name of today
/// where earlier versions had it, otherwise with the nearest one.
/// `where` is "file:line: ".
[[noreturn]] void refuse_unknown(const std::string& where, std::string_view name,
                                 std::span<const Parameter> parameters);

/// Sets the parameter `name` from a node. Throws ConfigurationError.
void apply_node(const toml::node& node, const std::string& name, const std::string& where,
                std::span<const Parameter> parameters);

/// The present value of a parameter as a line of TOML under its comment: meaning, unit, range.
[[nodiscard]] std::string commented_line(const Parameter& parameter);

/// Keys in the order of the text, not of the alphabet.
template <class Visit>
void visit_in_text_order(const toml::table& table, Visit visit) {
  std::vector<std::pair<const toml::key*, const toml::node*>> entries;
  for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.first->source().begin < b.first->source().begin;
  });
  for (const auto& [key, node] : entries) visit(*key, *node);
}

}  // namespace geo::io
