#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace geo {

/// The section in a parameter's full name: all before its last dot.
constexpr std::string_view section_of(std::string_view name) {
  const auto dot = name.rfind('.');
  return name.substr(0, dot == std::string_view::npos ? name.size() : dot);
}
/// Whether a section is `of` itself or one below it: "plates.sphere" of "plates".
constexpr bool is_section_of(std::string_view section, std::string_view of) {
  return section.starts_with(of) && (section.size() == of.size() || section[of.size()] == '.');
}

using ParameterValue = std::variant<double, std::int64_t, bool, std::string>;

/// One declaration of one parameter. It lives beside the struct member that holds the value and
/// serves the configuration file, `--set`, `terrane params`, docs, file attributes and calibration.
struct Parameter {
  /// "section.key" or, for one model of a stage, "section.model.key"; the key ends in the unit
  /// where it has one.
  std::string_view name;
  std::string_view units;  ///< UDUNITS, "1" for pure numbers, "" for flags and choices
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string_view doc;
  std::string_view source;                ///< key in docs/references.bib, or "design"
  std::vector<std::string_view> choices;  ///< allowed words of a string parameter; empty: any
  std::variant<double*, std::int64_t*, bool*, std::string*> storage;
  ParameterValue default_value;
  bool takes_list = false;  ///< a text of entries with commas between, in TOML also an array
  std::string_view former_name = {};  ///< what earlier versions called it; empty: as today

  /// All before the last dot of the name, and what follows it.
  [[nodiscard]] std::string_view section() const { return section_of(name); }
  [[nodiscard]] std::string_view key() const { return name.substr(name.rfind('.') + 1); }
  [[nodiscard]] ParameterValue value() const;
  /// Checks type and range (NaN-safe) and stores. An integer is accepted where a real number is
  /// asked for. Throws ConfigurationError whose text names the key, the value and what is allowed.
  void set(const ParameterValue& value) const;
  /// The same from text, as `--set key=text` gives it.
  void set_text(std::string_view text) const;
  /// "real", "integer", "boolean" or "string".
  [[nodiscard]] std::string_view type_name() const;
  /// "[0, 1]", "{d8, mfd}" or "any".
  [[nodiscard]] std::string range_text() const;
};

/// Declarations; the member's present value becomes the default.
Parameter real(std::string_view name, double& member, std::string_view units, double min,
               double max, std::string_view doc, std::string_view source);
Parameter integer(std::string_view name, std::int64_t& member, std::string_view units,
                  std::int64_t min, std::int64_t max, std::string_view doc,
                  std::string_view source);
Parameter flag(std::string_view name, bool& member, std::string_view doc, std::string_view source);
Parameter choice(std::string_view name, std::string& member, std::vector<std::string_view> choices,
                 std::string_view doc, std::string_view source);
Parameter text(std::string_view name, std::string& member, std::string_view doc,
               std::string_view source);
/// Entries with commas between; in TOML an array of them.
Parameter list(std::string_view name, std::string& member, std::string_view doc,
               std::string_view source);

/// A declaration that earlier versions had under another name.
Parameter renamed(Parameter parameter, std::string_view former_name);

/// The rows of several tables of one struct, in their order.
template <class Settings>
std::vector<Parameter> joined(Settings& settings,
                              std::initializer_list<std::vector<Parameter> (*)(Settings&)> tables) {
  std::vector<Parameter> all;
  for (const auto& table : tables) {
    for (Parameter& row : table(settings)) all.push_back(std::move(row));
  }
  return all;
}

/// A value as TOML writes it; real numbers keep every bit.
std::string to_toml(const ParameterValue& value);

/// The parameter of that name, or nullptr.
const Parameter* find_parameter(std::span<const Parameter> parameters, std::string_view name);
/// Gives settings the values that their namesakes have elsewhere, where there are some.
void take_values(std::span<const Parameter> settings, std::span<const Parameter> from);
/// The parameter that earlier versions called `name`, or nullptr: the one that was renamed so, or
/// the one with that key in the section of a model, as those stood in their stage's own section.
const Parameter* find_renamed(std::span<const Parameter> parameters, std::string_view name);
/// The candidate nearest to a misspelt word (Damerau-Levenshtein), or empty if none is near.
std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace geo
