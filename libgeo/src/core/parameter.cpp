#include "geo/core/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "geo/core/error.hpp"

namespace geo {
namespace {

std::string shown(double number) { return fmt::format("{:g}", number); }

[[noreturn]] void refuse(const Parameter& parameter, const std::string& given,
                         std::string_view wanted) {
  throw ConfigurationError(fmt::format("{} = {}: must be {}", parameter.name, given, wanted));
}

void check_range(const Parameter& parameter, double number, const std::string& given) {
  if (!(number >= parameter.min && number <= parameter.max)) {
    const auto unit = parameter.units.empty() || parameter.units == "1"
                          ? std::string()
                          : fmt::format(" {}", parameter.units);
    refuse(parameter, given, fmt::format("in {}{}", parameter.range_text(), unit));
  }
}

/// A whole number with more digits than any integer parameter takes.
bool beyond_int64(std::string_view text) {
  std::int64_t whole = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, whole);
  return error == std::errc::result_out_of_range && stop == end;
}

}  // namespace

ParameterValue Parameter::value() const {
  return std::visit([](const auto* member) -> ParameterValue { return *member; }, storage);
}

std::string_view Parameter::type_name() const {
  constexpr std::string_view kNames[] = {"real", "integer", "boolean", "string"};
  return kNames[storage.index()];
}

std::string Parameter::range_text() const {
  if (!choices.empty()) return fmt::format("{{{}}}", fmt::join(choices, ", "));
  if (storage.index() > 1) return storage.index() == 2 ? "{true, false}" : "any";
  if (std::isinf(min) && std::isinf(max)) return "any";
  return fmt::format("[{}, {}]", shown(min), shown(max));
}

void Parameter::set(const ParameterValue& given) const {
  const std::string shown_value = to_toml(given);
  const auto article = [&] {
    return storage.index() == 1
               ? std::string("an integer")
               : "a " + std::string(type_name()) + (storage.index() == 0 ? " number" : "");
  };
  if (auto* const* number = std::get_if<double*>(&storage)) {
    double value = 0.0;
    if (const auto* real_value = std::get_if<double>(&given)) {
      value = *real_value;
    } else if (const auto* whole = std::get_if<std::int64_t>(&given)) {
      value = static_cast<double>(*whole);
    } else {
      refuse(*this, shown_value, article());
    }
    if (!std::isfinite(value)) refuse(*this, shown_value, "finite");
    check_range(*this, value, shown_value);
    **number = value;
  } else if (auto* const* whole = std::get_if<std::int64_t*>(&storage)) {
    const auto* value = std::get_if<std::int64_t>(&given);
    if (value == nullptr) refuse(*this, shown_value, article());
    check_range(*this, static_cast<double>(*value), shown_value);
    **whole = *value;
  } else if (auto* const* truth = std::get_if<bool*>(&storage)) {
    const auto* value = std::get_if<bool>(&given);
    if (value == nullptr) refuse(*this, shown_value, "true or false");
    **truth = *value;
  } else {
    const auto* value = std::get_if<std::string>(&given);
    if (value == nullptr) refuse(*this, shown_value, "a string");
    if (!choices.empty() && std::find(choices.begin(), choices.end(), *value) == choices.end()) {
      const std::string near = nearest_word(*value, choices);
      refuse(*this, shown_value,
             fmt::format("one of {}{}", range_text(),
                         near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
    }
    *std::get<std::string*>(storage) = *value;
  }
}

void Parameter::set_text(std::string_view text) const {
  const auto whole_text = [&](auto& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
  };
  if (storage.index() <= 1) {
    std::int64_t whole = 0;
    double number = 0.0;
    if (whole_text(whole)) return set(whole);
    if (storage.index() == 1 && beyond_int64(text)) {
      refuse(*this, std::string(text), fmt::format("in {}", range_text()));
    }
    if (whole_text(number)) return set(number);
  } else if (storage.index() == 2) {
    if (text == "true") return set(true);
    if (text == "false") return set(false);
  } else {
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
      text = text.substr(1, text.size() - 2);
    }
    return set(std::string(text));
  }
  set(std::string(text));  // wrong type: says so
}

Parameter real(std::string_view name, double& member, std::string_view units, double min,
               double max, std::string_view doc, std::string_view source) {
  return {name, units, min, max, doc, source, {}, &member, member};
}

Parameter integer(std::string_view name, std::int64_t& member, std::string_view units,
                  std::int64_t min, std::int64_t max, std::string_view doc,
                  std::string_view source) {
  return {name,    units, static_cast<double>(min), static_cast<double>(max), doc, source, {},
          &member, member};
}

Parameter flag(std::string_view name, bool& member, std::string_view doc, std::string_view source) {
  Parameter parameter{.name = name,
                      .units = "",
                      .doc = doc,
                      .source = source,
                      .choices = {},
                      .storage = &member,
                      .default_value = member};
  return parameter;
}

Parameter choice(std::string_view name, std::string& member, std::vector<std::string_view> choices,
                 std::string_view doc, std::string_view source) {
  return {.name = name,
          .units = "",
          .doc = doc,
          .source = source,
          .choices = std::move(choices),
          .storage = &member,
          .default_value = member};
}

Parameter text(std::string_view name, std::string& member, std::string_view doc,
               std::string_view source) {
  return choice(name, member, {}, doc, source);
}

Parameter list(std::string_view name, std::string& member, std::string_view doc,
               std::string_view source) {
  Parameter parameter = text(name, member, doc, source);
  parameter.takes_list = true;
  return parameter;
}

Parameter renamed(Parameter parameter, std::string_view former_name) {
  parameter.former_name = former_name;
  return parameter;
}

std::string to_toml(const ParameterValue& value) {
  struct Writer {
    std::string operator()(double number) const {
      std::string text = fmt::format("{}", number);
      if (text.find_first_of(".en") == std::string::npos) text += ".0";
      return text;
    }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(bool truth) const { return truth ? "true" : "false"; }
    std::string operator()(const std::string& words) const {
      std::string quoted = "\"";
      for (const char c : words) {
        if (c == '"' || c == '\\') {
          quoted += '\\';
          quoted += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
          quoted += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        } else {
          quoted += c;
        }
      }
      return quoted + '"';
    }
  };
  return std::visit(Writer{}, value);
}

const Parameter* find_parameter(std::span<const Parameter> parameters, std::string_view name) {
  const auto at = std::find_if(parameters.begin(), parameters.end(),
                               [&](const Parameter& p) { return p.name == name; });
  return at == parameters.end() ? nullptr : &*at;
}

void take_values(std::span<const Parameter> settings, std::span<const Parameter> from) {
  for (const Parameter& setting : settings) {
    if (const Parameter* namesake = find_parameter(from, setting.name)) {
      setting.set(namesake->value());
    }
  }
}

const Parameter* find_renamed(std::span<const Parameter> parameters, std::string_view name) {
  const std::string_view stage = section_of(name);
  const Parameter* model = find_parameter(parameters, fmt::format("{}.model", stage));
  const auto is_models_key = [&](const Parameter& p) {
    if (model == nullptr || p.key() != name.substr(name.rfind('.') + 1)) return false;
    return std::any_of(model->choices.begin(), model->choices.end(), [&](std::string_view word) {
      return p.section() == fmt::format("{}.{}", stage, word);
    });
  };
  const auto at = std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) {
    return !name.empty() && (p.former_name == name || is_models_key(p));
  });
  return at == parameters.end() ? nullptr : &*at;
}

std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
  std::vector<int> table;
  const auto distance = [&](std::string_view a, std::string_view b) {
    // Optimal string alignment: insertions, deletions, substitutions, neighbouring swaps.
    const std::size_t columns = b.size() + 1;
    table.resize((a.size() + 1) * columns);
    const auto at = [&](std::size_t i, std::size_t j) -> int& { return table[i * columns + j]; };
    for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = static_cast<int>(i);
    for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const int change = a[i - 1] == b[j - 1] ? 0 : 1;
        at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + change});
        if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
          at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
        }
      }
    }
    return at(a.size(), b.size());
  };
  std::string best;
  int least = static_cast<int>(word.size() / 3) + 2;
  for (const std::string_view candidate : candidates) {
    // As far apart as their lengths at least; long words need no table.
    const std::size_t longer = std::max(word.size(), candidate.size());
    if (longer - std::min(word.size(), candidate.size()) >= static_cast<std::size_t>(least)) {
      continue;
    }
    const int here = distance(word, candidate);
    if (here < least) {
      least = here;
      best = candidate;
    }
  }
  return best;
}

}  // namespace geo
