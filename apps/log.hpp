#pragma once

#include <string>
#include <string_view>

namespace terrane {

/// How the program speaks on stderr.
struct LogStyle {
  bool json = false;   ///< one JSON object a line
  bool quiet = false;  ///< warnings and errors only
};

/// Sets the style; until then plain text.
void set_log_style(LogStyle style);
/// Whether lines are JSON.
[[nodiscard]] bool logs_json();

void log_info(std::string_view message);
void log_warning(std::string_view message);
/// The one line with which a failed program ends: "terrane: error: …".
void log_error(std::string_view message);

/// Rounds for people: "1.3 GB", "640 MB".
std::string shown_bytes(double bytes);
/// "0.4 s", "12 s", "3 min 20 s".
std::string shown_seconds(double seconds);

}  // namespace terrane
