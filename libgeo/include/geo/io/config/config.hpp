#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/event.hpp"
#include "geo/core/parameter.hpp"

namespace geo::io {

/// Sets parameters from TOML text: key `k` of table `[s]` is the parameter `s.k`. Every error is a
/// ConfigurationError of one line that begins `source_name:line:`; it covers syntax, keys given
/// twice, unknown sections and keys (with the nearest known one), wrong types and values out of
/// range. Tables [[event]] replace `events`; without it they are unknown. Returns the names of the
/// parameters that were set, in the order of the text.
std::vector<std::string> apply_toml(std::string_view toml, const std::string& source_name,
                                    std::span<const Parameter> parameters,
                                    std::vector<Event>* events = nullptr);

/// The same from a file. IoError when it cannot be read.
std::vector<std::string> apply_config_file(const std::filesystem::path& path,
                                           std::span<const Parameter> parameters,
                                           std::vector<Event>* events = nullptr);

/// Sets one parameter from `section.key=value`, as `--set` gives it. Returns its name.
std::string apply_assignment(std::string_view assignment, std::span<const Parameter> parameters);

/// Every parameter with its present value as TOML, grouped by section, each under a comment with
/// its meaning, unit and range, then the events. Reading it back gives the same values bit for bit.
std::string write_config(std::span<const Parameter> parameters, std::string_view heading,
                         std::span<const Event> events = {});

/// Tables [[event]] with every key, as `apply_toml` reads them.
std::string write_events(std::span<const Event> events);

/// Names the first parameter whose value in the resolved configuration `before` differs from
/// `after`, as "section.key is X, was Y", or the first event that is another; empty when none is.
/// `sections` limits the comparison to these sections ("event" for the events) and single keys;
/// empty means all.
std::string first_difference(std::string_view before, std::string_view after,
                             std::span<const std::string> sections = {},
                             std::span<const std::string_view> ignored_names = {});

/// The string that a configuration holds under "section.key"; empty when it holds none.
std::string configured_text(std::string_view toml, std::string_view name);

/// Whether a configuration holds "section.key" and it is true.
bool configured_flag(std::string_view toml, std::string_view name);

/// Whole text of a file. IoError when it cannot be read.
std::string read_text(const std::filesystem::path& path);

/// `did you mean "x"?` with a leading separator, or nothing.
std::string suggestion(std::string_view word, std::span<const std::string_view> candidates,
                       std::string_view separator = "; ");

}  // namespace geo::io
